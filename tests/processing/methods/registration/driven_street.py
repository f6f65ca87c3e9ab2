"""A street driven both ways by construction: planes and paint, and a trajectory that is off.

Points lie exactly where beams of a spinning head would meet a road, two house fronts with
pilasters, and a pole; what is delivered is moved by known errors of place, attitude and mounting.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np

from processing.core.arrays import Floats
from processing.recording.vehicle_path.trajectory import Trajectory

ORIGIN = np.array([-11_000.0, -35_000.0, 20.0])
START_S = 3.8e8
_SPEED_M_S, _TURNS_PER_S, _PULSES = 8.13, 150.0, 370
_HIGH_M, _HALF_WIDTH_M, _PILASTER_M = 2.0, 6.0, 0.25
_PAINT_M = (0.15, 2.0)
"""Width and length of the dashes, every four metres along the middle."""


@dataclass(frozen=True)
class Errors:
    """What is wrong with what is delivered.

    Attributes
    ----------
    shift_m : (3,) float64
        Of the positions, at the beginning of a pass.
    drift_m : (3,) float64
        More of it at its end.
    turned_deg : (3,) float64
        About forward, left and up, all the way.
    """

    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    drift_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turned_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class DrivenPass:
    """One pass: true points, and the files that tell them wrong."""

    points: Path
    trajectory: Path
    true_xyz: Floats


def drive_street(
    folder: Path, number: int, errors: Errors, *, length_m: float = 60.0, seed: int = 1
) -> DrivenPass:
    """Write a pass: odd ones drive back on the other side."""
    random = np.random.default_rng((seed, number))
    duration = length_m / _SPEED_M_S
    pulse = np.arange(int(duration * _TURNS_PER_S * _PULSES))
    time = pulse / (_TURNS_PER_S * _PULSES)
    sign = -1.0 if number % 2 else 1.0
    north = sign * _SPEED_M_S * time + (length_m if sign < 0 else 0.0)
    at = np.column_stack([np.full(time.size, sign * 1.7), north, np.full(time.size, _HIGH_M)])
    # No scanner turns in step with its pulses: beams of two turns never lie side by side.
    turn = random.uniform(0.0, 1.0, int(pulse[-1]) // _PULSES + 1)[pulse // _PULSES]
    xyz, tone = _met(at, sign, 2 * np.pi * (pulse % _PULSES + turn) / _PULSES)
    kept = np.isfinite(xyz).all(axis=1)
    xyz, tone, time, at = xyz[kept], tone[kept], time[kept], at[kept]
    xyz += random.normal(0.0, 0.002, xyz.shape)
    start = START_S + 900.0 * number
    axes = np.array([[0.0, -sign, 0.0], [sign, 0.0, 0.0], [0.0, 0.0, 1.0]])
    turned = np.cross(np.radians(errors.turned_deg), (xyz - at) @ axes) @ axes.T
    off = np.array(errors.shift_m) + np.array(errors.drift_m) * (time / duration)[:, None]
    name = folder / f"pass{number + 1}"
    points = name.with_suffix(".las")
    _write_points(points, xyz + turned + off + ORIGIN, tone, start + time, number)
    records = np.arange(0.0, duration, 0.02)
    place = np.column_stack(
        [
            np.full(records.size, sign * 1.7),
            sign * _SPEED_M_S * records + (length_m if sign < 0 else 0.0),
            np.full(records.size, _HIGH_M),
        ]
    )
    place += ORIGIN + errors.shift_m + np.array(errors.drift_m) * (records / duration)[:, None]
    heading = np.full(records.size, 180.0 if sign < 0 else 0.0)
    flat = np.zeros(records.size)
    trajectory = name.with_suffix(".csv")
    np.savetxt(
        trajectory,
        np.column_stack([start + records, place, flat, flat, heading]),
        fmt="%.6f",
        delimiter=",",
        comments="",
        header="time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg",
    )
    return DrivenPass(points, trajectory, xyz + ORIGIN)


def straight_trajectory(length_m: float = 60.0) -> Trajectory:
    """Of the first pass, without errors."""
    time = np.arange(0.0, length_m / _SPEED_M_S, 0.02)
    xyz = np.column_stack([np.full(time.size, 1.7), _SPEED_M_S * time, np.full(time.size, _HIGH_M)])
    return Trajectory(START_S + time, xyz + ORIGIN, np.zeros((time.size, 3)), has_attitude=True)


def _met(at: Floats, sign: float, angle: Floats) -> tuple[Floats, Floats]:
    """Where beams from a head that looks 45° aside meet the street: (n, 3), NaN for none."""
    # The scan plane holds up and a level direction at 45° between right and ahead.
    level = np.array([sign * np.sqrt(0.5), sign * np.sqrt(0.5), 0.0])
    beam = np.cos(angle)[:, None] * level + np.sin(angle)[:, None] * np.array([0.0, 0.0, 1.0])
    with np.errstate(divide="ignore", invalid="ignore"):
        down = np.where(beam[:, 2] < 0, -at[:, 2] / beam[:, 2], np.inf)
        side = np.where(
            beam[:, 0] > 0,
            (_HALF_WIDTH_M - at[:, 0]) / beam[:, 0],
            (-_HALF_WIDTH_M - at[:, 0]) / beam[:, 0],
        )
        side = np.where(np.abs(beam[:, 0]) > 1e-9, side, np.inf)
        north = at[:, 1] + side * beam[:, 1]
        ahead = np.mod(north, 5.0) < 1.0
        nearer = side - _PILASTER_M / np.abs(beam[:, 0])
        # A pilaster's front, or the cheek of one on the way to the wall behind it.
        cheek = (np.floor(north / 5.0) * 5.0 + 1.0 - at[:, 1]) / beam[:, 1]
        east = at[:, 0] + cheek * beam[:, 0]
        meets = (beam[:, 1] < 0) & (cheek < side) & (np.abs(east) > _HALF_WIDTH_M - _PILASTER_M)
        side = np.where(ahead, nearer, np.where(meets, cheek, side))
    reach = np.minimum(down, side)
    reach[reach > 25.0] = np.nan
    xyz = at + reach[:, None] * beam
    xyz[xyz[:, 2] > 6.0] = np.nan
    on_road = np.abs(xyz[:, 2]) < 1e-6
    is_paint = (
        on_road & (np.abs(xyz[:, 0]) < _PAINT_M[0] / 2) & (np.mod(xyz[:, 1], 4.0) < _PAINT_M[1])
    )
    return xyz, np.where(is_paint, 30_000, 8_000)


def _write_points(path: Path, xyz: Floats, tone: Floats, time: Floats, number: int) -> None:
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.0005), ORIGIN
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    header.global_encoding.wkt = True
    las = laspy.LasData(header)
    las.xyz = xyz
    las.gps_time, las.intensity = time, tone.astype(np.uint16)
    las.return_number = np.ones(time.size, np.uint8)
    las.number_of_returns = np.ones(time.size, np.uint8)
    las.point_source_id = np.full(time.size, number + 1, np.uint16)
    las.write(path)
