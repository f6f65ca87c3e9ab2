"""Synthetic recordings whose truth is known: what tests build drives from.

A vehicle drives along a road of constant curvature between two walls while one line scanner turns
on it. Every beam is intersected with the scene exactly, so each point's pulse, turn and column are
known by construction.

`simulated_drive` knows: ``pulses_per_revolution`` may be fractional, as real clocks are not locked
to the mirror; ``mount`` is the angle of the scan plane to the drive in plan; ``lost_share`` of the
pulses that hit something don't return, half of them in bursts; ``multi_return_share`` touch an edge
and return twice; ``rate_drift`` is the relative amplitude of a slow wander of the turn rate;
``time_quantum_s`` cuts times off; after ``stop_at`` metres the vehicle stands for ``stop_s`` and
the laser rests unless ``fires_at_stop``; ``curve`` is the road's curvature, 1/m, left positive.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.recording.vehicle_path.trajectory import Trajectory
from tests.street_scene import Rays, StreetScene

SCALE = (0.001, 0.001, 0.001)
OFFSET = (-11_000.0, -35_000.0, 100.0)
START = np.array([-11_030.0, -35_020.0, 125.0])
HEIGHT_M = 2.0
_RIG = {"left": (-0.5, 0.35, 0.5), "right": (-0.5, -0.35, 0.5)}
_WANDER_S = 4.0


@dataclass(frozen=True)
class SimulatedDrive:
    """One scanner's recording with its truth.

    Attributes
    ----------
    columns : dict of str to array
        ``xyz`` (n, 3) int32, ``time``, ``intensity``, ``return_number``, ``number_of_returns``,
        ``classification``, ``scanner``: as delivered, in acquisition order.
    scale, offset : tuple of float
        Metres = integers × scale + offset.
    origin : (n, 3) float64
        Where the scanner was at each point, m.
    scan_angle_deg : (n,) float32
        Mirror angle, as some files deliver it.
    trajectory : Trajectory
        Of the reference point, 200 Hz, half a second longer at both ends.
    pulse, turn, column : (n,) int64
        Truth: the pulse fired, the revolution counted below the vehicle, the pulse in it.
    surface : (n,) uint8
        0 road, 1 curb face, 2 sidewalk, 3 wall, 4 pole.
    fold_times : (turns + 1,) float64
        When each revolution passed below the trajectory.
    revolution_rate_hz, pulse_rate_hz, pulses_per_revolution : float
        Nominal.
    """

    columns: dict[str, NDArray[Any]]
    scale: tuple[float, float, float]
    offset: tuple[float, float, float]
    origin: Floats
    scan_angle_deg: NDArray[np.float32]
    trajectory: Trajectory
    pulse: NDArray[np.int64]
    turn: NDArray[np.int64]
    column: NDArray[np.int64]
    surface: NDArray[np.uint8]
    fold_times: Floats
    revolution_rate_hz: float
    pulse_rate_hz: float
    pulses_per_revolution: float

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.pulse.size)

    @property
    def xyz(self) -> Floats:
        """(n, 3) coordinates as delivered, m."""
        integers: NDArray[np.int32] = self.columns["xyz"]
        positions: Floats = integers * np.array(self.scale) + np.array(self.offset)
        return positions


def simulated_drive(
    seed: int = 0,
    *,
    revolution_rate_hz: float = 100.0,
    pulses_per_revolution: float = 400.0,
    mount: Literal["45", "90"] = "45",
    head: Literal["left", "right"] = "left",
    length_m: float = 10.0,
    speed_m_s: float = 8.0,
    lost_share: float = 0.02,
    multi_return_share: float = 0.0,
    rate_drift: float = 0.0,
    time_quantum_s: float = 0.0,
    stop_at: float | None = None,
    stop_s: float = 3.0,
    fires_at_stop: bool = False,
    curve: float = 0.0,
    start_time_s: float = 205_000.25,
    range_noise_m: float = 0.003,
) -> SimulatedDrive:
    """A recording of a street; the default has some 28,000 points."""
    random = np.random.default_rng(seed)
    pulse_rate_hz = revolution_rate_hz * pulses_per_revolution
    pause_s = stop_s if stop_at is not None else 0.0
    pause_from = np.inf if stop_at is None else stop_at / speed_m_s
    pulse = np.arange(int((length_m / speed_m_s + pause_s) * pulse_rate_hz), dtype=np.int64)
    time = pulse / pulse_rate_hz
    if not fires_at_stop:
        pulse = pulse[(time < pause_from) | (time >= pause_from + pause_s)]
        time = pulse / pulse_rate_hz
    road = _Road(curve, speed_m_s, pause_from, pause_s)
    phase = _phase_at(time, revolution_rate_hz, rate_drift, float(random.uniform(0, 2 * np.pi)))
    mounting = _Mounting(mount, head)
    rays = mounting.rays(phase, *road.pose_at(time))
    ranges, surface, intensity = StreetScene(curve, length_m).ranges(rays, random)
    ranges += random.normal(0.0, range_noise_m, ranges.size)
    hit = np.isfinite(ranges) & ~_lost(random, ranges.size, lost_share)
    returns = _returned(random, np.flatnonzero(hit), ranges, multi_return_share)
    shot = returns.shot
    revolutions = _revolutions_of(phase, time, mounting.fold_phase)
    local = rays.origin[shot] + returns.distance[:, None] * rays.direction[shot]
    delivered = _cut_off(start_time_s + time[shot], time_quantum_s)
    columns = _delivered_columns(local, delivered, returns, 1 if head == "left" else 2)
    columns["intensity"] = intensity[shot]
    return SimulatedDrive(
        columns=columns,
        scale=SCALE,
        offset=OFFSET,
        origin=rays.origin[shot] + START,
        scan_angle_deg=np.degrees(np.mod(phase[shot], 2 * np.pi)).astype(np.float32),
        trajectory=road.trajectory(float(time[-1]), start_time_s),
        pulse=pulse[shot],
        turn=revolutions.turn[shot],
        column=shot - revolutions.first_shot[revolutions.turn[shot]],
        surface=surface[shot],
        fold_times=start_time_s + revolutions.fold_times,
        revolution_rate_hz=revolution_rate_hz,
        pulse_rate_hz=pulse_rate_hz,
        pulses_per_revolution=pulses_per_revolution,
    )


def write_laz(drive: SimulatedDrive, path: Path, *, crs: str = "EPSG:6677") -> Path:
    """Write the points as LAZ 1.4, point format 6; LAS if the name says so."""
    import laspy
    from pyproj import CRS

    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.array(drive.scale), np.array(drive.offset)
    if crs:
        header.add_crs(CRS.from_user_input(crs))
    cloud = laspy.LasData(header)
    for axis, name in enumerate("XYZ"):
        cloud[name] = drive.columns["xyz"][:, axis]
    cloud.gps_time = drive.columns["time"]
    cloud.point_source_id = drive.columns["scanner"]
    for name in ("intensity", "return_number", "number_of_returns", "classification"):
        cloud[name] = drive.columns[name]
    cloud.write(str(path))
    return path


def write_trajectory_csv(drive: SimulatedDrive, path: Path) -> Path:
    """Write the trajectory with the contract's header."""
    road = drive.trajectory
    np.savetxt(
        path,
        np.column_stack([road.time, road.xyz, road.roll_pitch_heading_deg]),
        delimiter=",",
        comments="",
        header="time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg",
        fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
    )
    return path


class _Road:
    """Where the vehicle is: constant speed but for one pause, swaying a little."""

    def __init__(self, curve: float, speed_m_s: float, pause_from: float, pause_s: float) -> None:
        self._curve = curve
        self._speed_m_s = speed_m_s
        self._pause_from = pause_from
        self._pause_s = pause_s

    def pose_at(self, time: Floats) -> tuple[Floats, Floats]:
        """Positions (n, 3), and roll, pitch, heading (n, 3) in degrees."""
        waited = np.clip(time - self._pause_from, 0.0, self._pause_s)
        moved_s = time - waited
        along = self._speed_m_s * moved_s
        turned = self._curve * along
        if self._curve == 0.0:
            east, north = 0.0 * along, along
        else:
            east = -(1 - np.cos(turned)) / self._curve
            north = np.sin(turned) / self._curve
        # The lane lies half a metre left of the road's middle.
        east, north = east - 0.5 * np.cos(turned), north - 0.5 * np.sin(turned)
        height = HEIGHT_M + 0.01 * np.sin(3.0 * moved_s)
        angles = [0.4 * np.sin(2.0 * moved_s), 0.3 * np.sin(2.7 * moved_s), -np.degrees(turned)]
        return np.column_stack([east, north, height]), np.column_stack(angles)

    def trajectory(self, duration_s: float, start_time_s: float) -> Trajectory:
        """The records of the navigation system."""
        time = np.arange(-0.5, duration_s + 0.5, 0.005)
        xyz, angles = self.pose_at(time)
        angles[:, 2] %= 360.0
        return Trajectory(start_time_s + time, xyz + START, angles, has_attitude=True)


class _Mounting:
    """How the scanner sits on the vehicle and which way it turns."""

    def __init__(self, mount: str, head: str) -> None:
        side = 1.0 if head == "left" else -1.0
        yaw, pitch = np.radians((45.0 * side, 18.0) if mount == "45" else (0.0, 0.0))
        axis = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
        self._lever = np.array(_RIG[head])
        first = np.cross([0.0, 0.0, 1.0], axis)
        self._first = first / np.linalg.norm(first)
        self._second = np.cross(axis, self._first) * side
        self.fold_phase = self._phase_below()

    def rays(self, phase: Floats, position: Floats, angles_deg: Floats) -> Rays:
        """The beams of pulses, in metres about the start."""
        turn = _rotations(np.radians(angles_deg))
        beam = np.cos(phase)[:, None] * self._first + np.sin(phase)[:, None] * self._second
        origin = position + np.einsum("nij,j->ni", turn, self._lever)
        return Rays(origin, np.einsum("nij,nj->ni", turn, beam))

    def _phase_below(self) -> float:
        """The phase whose beam meets level ground on the trajectory's line."""
        ratio = self._lever[1] / (HEIGHT_M + self._lever[2])
        across = self._first[1] - ratio * self._first[2], self._second[1] - ratio * self._second[2]
        phase = float(np.arctan2(-across[0], across[1]))
        down = np.cos(phase) * self._first[2] + np.sin(phase) * self._second[2]
        return phase if down < 0 else phase + np.pi


def _rotations(angles: Floats) -> Floats:
    """(n, 3, 3): forward, left, up to east, north, up from roll, pitch, heading in rad."""
    roll, pitch, heading = angles.T
    forward = np.column_stack(
        [np.cos(pitch) * np.sin(heading), np.cos(pitch) * np.cos(heading), np.sin(pitch)]
    )
    level_left = np.column_stack([-np.cos(heading), np.sin(heading), 0.0 * heading])
    level_up = np.cross(forward, level_left)
    left = np.cos(roll)[:, None] * level_left + np.sin(roll)[:, None] * level_up
    return np.stack([forward, left, np.cross(forward, left)], axis=2)


def _phase_at(time: Floats, revolution_rate_hz: float, drift: float, start: float) -> Floats:
    wander = drift * _WANDER_S / (2 * np.pi) * (1 - np.cos(2 * np.pi * time / _WANDER_S))
    return start + 2 * np.pi * revolution_rate_hz * (time + wander)


def _cut_off(time: Floats, quantum_s: float) -> Floats:
    return time if quantum_s == 0 else np.floor(time / quantum_s) * quantum_s


def _lost(random: np.random.Generator, count: int, share: float) -> NDArray[np.bool_]:
    lost = random.uniform(size=count) < share / 2
    for start in random.integers(0, count, int(share / 2 * count / 30)):
        lost[start : start + 30] = True
    return lost


@dataclass(frozen=True)
class _Returns:
    """What came back: the shot, the distance, and which return of how many, per point."""

    shot: NDArray[np.int64]
    distance: Floats
    number: NDArray[np.uint8]
    of: NDArray[np.uint8]


def _returned(
    random: np.random.Generator, shots: NDArray[np.int64], ranges: Floats, share: float
) -> _Returns:
    times = 1 + (random.uniform(size=shots.size) < share).astype(np.int64)
    number = np.ones(times.sum(), dtype=np.uint8)
    number[np.cumsum(times) - 1] = times
    returns = np.repeat(times, times).astype(np.uint8)
    shot = np.repeat(shots, times)
    return _Returns(shot, ranges[shot] * np.where(number < returns, 0.7, 1.0), number, returns)


@dataclass(frozen=True)
class _Turns:
    """Turn of every shot, the first shot of every turn, and when turns began."""

    turn: NDArray[np.int64]
    first_shot: NDArray[np.int64]
    fold_times: Floats


def _revolutions_of(phase: Floats, time: Floats, fold_phase: float) -> _Turns:
    turn = np.floor((phase - fold_phase) / (2 * np.pi)).astype(np.int64)
    fold_phases = fold_phase + 2 * np.pi * np.arange(turn[0], turn[-1] + 2)
    return _Turns(
        turn=turn - turn[0],
        first_shot=np.searchsorted(phase, fold_phases[:-1]),
        fold_times=np.interp(fold_phases, phase, time, left=np.nan, right=np.nan),
    )


def _delivered_columns(
    local: Floats, time: Floats, returns: _Returns, scanner: int
) -> dict[str, NDArray[Any]]:
    return {
        "xyz": np.rint((local + START - OFFSET) / SCALE).astype(np.int32),
        "time": time,
        "return_number": returns.number,
        "number_of_returns": returns.of,
        "classification": np.zeros(time.size, dtype=np.uint8),
        "scanner": np.full(time.size, scanner, dtype=np.uint16),
    }
