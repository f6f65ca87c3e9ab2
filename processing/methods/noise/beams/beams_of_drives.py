"""The beams of a drive's points: rows, columns and ranges from where each beam began."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.image.point_image import PointCloudImage
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.beam_origins import BeamOrigins
from processing.recording.drive import Drive

_NEAREST_M = 1e-3
"""Least range, so that a point at its own scanner divides nothing by zero."""

_SAMPLE = 20_000
"""Points or pairs whose median is taken: sure to a hundredth of their spread."""

_LEAST_STEP_RAD = 1e-6
"""From column to column, at least: far finer than scanners step."""


def along_rows(origins: BeamOrigins, row_starts: NDArray[np.int64]) -> NDArray[np.float64]:
    """(rows,) m: how far the scanner had come at the first point of each row."""
    firsts = np.minimum(row_starts[:-1], row_starts[-1] - 1)
    positions = origins.of(firsts)
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def beams_of(
    drive: Drive, image: PointCloudImage, rows: range, origins: BeamOrigins
) -> tuple[PointBeams, slice]:
    """The beams of a chunk of rows, and which points of the drive they are.

    Coordinates are relative to the middle of the chunk.
    """
    grid, points = image.grid(rows)
    xyz, positions = drive.xyz(points), origins.of(np.arange(points.start, points.stop))
    middle = np.median(xyz[:: max(1, xyz.shape[0] // _SAMPLE)], axis=0)
    ranges = np.empty(xyz.shape[0])
    _ranges_kernel(xyz, positions, middle, ranges)
    columns = np.ascontiguousarray(grid.columns)
    revolutions = drive.revolutions
    step_rad = (
        2 * np.pi / revolutions.pulses_per_revolution
        if revolutions is not None
        else _step_rad((xyz - positions) / ranges[:, None], columns, grid.width)
    )
    beams = PointBeams(
        xyz,
        positions,
        ranges,
        columns,
        np.ascontiguousarray(grid.row_starts),
        np.ascontiguousarray(grid.segments),
        step_rad,
    )
    return beams, points


def _step_rad(directions: NDArray[np.float64], columns: NDArray[np.int32], width: int) -> float:
    """Radians from column to column, measured between points of neighbouring columns."""
    firsts = np.flatnonzero(np.diff(columns) == 1)
    firsts = firsts[:: max(1, firsts.size // _SAMPLE)]
    if not firsts.size:
        return 2 * np.pi / max(width, 1)
    gaps = np.linalg.norm(directions[firsts + 1] - directions[firsts], axis=1)
    return float(max(np.median(gaps), _LEAST_STEP_RAD))


@kernel
def _ranges_kernel(
    xyz: NDArray[np.float64],
    positions: NDArray[np.float64],
    middle: NDArray[np.float64],
    ranges: NDArray[np.float64],
) -> None:
    """Bring points and the origins of their beams about ``middle``, and tell the ranges."""
    for point in range(xyz.shape[0]):
        square = 0.0
        for axis in range(3):
            xyz[point, axis] -= middle[axis]
            positions[point, axis] -= middle[axis]
            square += (xyz[point, axis] - positions[point, axis]) ** 2
        ranges[point] = max(math.sqrt(square), _NEAREST_M)


def warm_up() -> None:
    """Compile the kernel of this file."""
    one = np.zeros((1, 3))
    _ranges_kernel(one, one.copy(), np.zeros(3), np.empty(1))
