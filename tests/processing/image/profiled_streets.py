"""Streets whose cross-section is known exactly, as a head at 45° would record them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.recording.columns.columns import ColumnWriter
from processing.recording.drive import Drive
from processing.recording.drive_info import DriveInfo, write_drive_info
from processing.recording.revolutions.revolutions_file import write_revolutions
from tests.processing.image.recordings import revolutions_of

START = np.array([-11_030.0, -35_020.0, 125.0])
SCALE = 0.0001
PULSES = 1_000
BEYOND_M = 3.0
"""Rows run at 45°; so much before and after the street is recorded, that all of it is seen."""

CURB = ((-2.5, 0.05), (0.0, 0.0), (0.02, 0.15), (1.5, 0.18))
"""Across the street and up, m: road, curb of 15 cm, sidewalk."""
LOWER, UPPER = np.array(CURB[1]), np.array(CURB[2])


@dataclass(frozen=True)
class ProfiledStreet:
    """How a street is recorded.

    Attributes
    ----------
    profile : points (across, up)
        Straight pieces between them.
    length_m, row_m, spacing_m : float
        Length; distance of rows along the street; of points along the profile.
    noise_m : float
        Standard deviation of points square to the surface, either way.
    curvature : float
        1/m, left positive; the profile keeps its distance from the curve.
    grade : float
        Rise per metre.
    heading_rad : float
        Counter-clockwise from the easting at the start.
    """

    profile: tuple[tuple[float, float], ...] = CURB
    length_m: float = 6.0
    row_m: float = 0.10
    spacing_m: float = 0.03
    noise_m: float = 0.003
    curvature: float = 0.0
    grade: float = 0.03
    heading_rad: float = 0.7

    def positions(self, along: Floats, across: Floats, up: Floats) -> Floats:
        """(n, 3) m: along the street, to its left, and above it."""
        turned = self.heading_rad + self.curvature * along
        if self.curvature:
            radius = 1 / self.curvature
            x = radius * (np.sin(turned) - np.sin(self.heading_rad))
            y = radius * (np.cos(self.heading_rad) - np.cos(turned))
        else:
            x, y = along * np.cos(turned), along * np.sin(turned)
        x, y = x - across * np.sin(turned), y + across * np.cos(turned)
        return np.asarray(START + np.column_stack([x, y, up + self.grade * along]))

    def edge(self, corner: NDArray[np.float64], step_m: float = 0.01) -> Floats:
        """(n, 3) a line along the street, densely."""
        along = np.arange(0.0, self.length_m, step_m)
        return self.positions(along, np.full_like(along, corner[0]), np.full_like(along, corner[1]))


def recorded(
    folder: Path,
    street: ProfiledStreet,
    *,
    seed: int = 0,
    hidden: tuple[float, float] | None = None,
) -> Drive:
    """The drive of a street; between two distances along it nothing was seen if so wished.

    Paint: a stripe 15 cm wide whose middle is 1 m to the right of the profile's origin.
    """
    random = np.random.default_rng(seed)
    rows = int((street.length_m + 2 * BEYOND_M) / street.row_m)
    columns = int(_length(street) / street.spacing_m)
    row = np.repeat(np.arange(rows), columns)
    column = np.tile(np.arange(columns), rows)
    jitter = random.uniform(0, street.spacing_m, rows)[row]
    u, v, normals = _on_profile(street, column * street.spacing_m + jitter)
    along = row * street.row_m - BEYOND_M + u
    noise = random.normal(0.0, street.noise_m, u.size)
    u, v = u + noise * normals[:, 0], v + noise * normals[:, 1]
    kept = np.ones(u.size, np.bool_)
    if hidden is not None:
        kept = (along < hidden[0]) | (along > hidden[1])
    intensity = np.where(np.abs(u + 1.0) < 0.075, 50_000, 9_000) + random.uniform(0, 2_000, u.size)
    xyz = street.positions(along, u, v)[kept]
    return _written(folder, xyz, (row * PULSES + column)[kept], intensity[kept], rows)


def off_line(xyz: Floats, line: Floats) -> Floats:
    """(n,) distances from points to a polyline of closely spaced vertices."""
    return np.asarray(np.linalg.norm(xyz[:, None] - line[None], axis=2).min(axis=1))


def _length(street: ProfiledStreet) -> float:
    return float(np.linalg.norm(np.diff(np.array(street.profile), axis=0), axis=1).sum())


def _on_profile(street: ProfiledStreet, s: Floats) -> tuple[Floats, Floats, Floats]:
    """Places at some ways along the profile, and normals there."""
    corners = np.array(street.profile)
    spans = np.diff(corners, axis=0)
    lengths = np.linalg.norm(spans, axis=1)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    across, up = np.interp(s, ends, corners[:, 0]), np.interp(s, ends, corners[:, 1])
    piece = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, spans.shape[0] - 1)
    normals = np.column_stack([-spans[:, 1], spans[:, 0]]) / lengths[:, None]
    return across, up, normals[piece]


def _written(
    folder: Path, xyz: Floats, pulse: NDArray[np.int64], intensity: Floats, rows: int
) -> Drive:
    folder.mkdir(parents=True)
    count, offset = xyz.shape[0], tuple(float(value) for value in START)
    with ColumnWriter(folder) as writer:
        writer.append(
            {
                "xyz": np.rint((xyz - START) / SCALE).astype(np.int32),
                "time": pulse / 100_000.0,
                "intensity": intensity.astype(np.uint16),
                "return_number": np.ones(count, np.uint8),
                "number_of_returns": np.ones(count, np.uint8),
                "classification": np.zeros(count, np.uint8),
                "pulse": pulse,
                "source_index": np.arange(count),
                "source_file": np.zeros(count),
            }
        )
    folds = np.arange(rows + 1, dtype=np.int64) * PULSES
    write_revolutions(folder, revolutions_of(folds, pulse_rate_hz=100_000.0))
    lowest, highest = xyz.min(axis=0), xyz.max(axis=0)
    write_drive_info(
        folder,
        DriveInfo(
            id=folder.name,
            name=folder.name,
            scanner=1,
            count=count,
            scale=(SCALE, SCALE, SCALE),
            offset=(offset[0], offset[1], offset[2]),
            lowest=(float(lowest[0]), float(lowest[1]), float(lowest[2])),
            highest=(float(highest[0]), float(highest[1]), float(highest[2])),
            crs="EPSG:6677",
            sources=(),
            clock_offset_s=0.0,
            rows_by="trajectory",
        ),
    )
    return Drive(folder)
