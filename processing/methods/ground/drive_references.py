"""The published method and the lowest points on drives recorded together, block by block."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.methods.ground.drive_points import Chunk, DrivePoints
from processing.methods.ground.filters.cell_positions import require_three_positions
from processing.methods.ground.filters.lowest_points import lowest_ground
from processing.methods.ground.filters.published_method import PublishedSteps, published_surface
from processing.methods.ground.ground_columns import GroundColumns

_FINDING_SHARE = 0.5
"""Of the progress bar, for the surface; the rest for comparing every point with it."""

ChunkClassifier = Callable[
    [Chunk, NDArray[np.float64]], tuple[NDArray[np.bool_], NDArray[np.float64]]
]


def published_ground_of(
    points: DrivePoints, steps: PublishedSteps, folders: Sequence[Path], monitor: Monitor
) -> None:
    """Columns as of `adaptive_ground`, by the published method.

    Raises
    ------
    OutOfRange
        As :func:`processing.methods.ground.filters.published_method.published_surface`.
    NoSpace, Cancelled
    """
    surface = published_surface(points.blocks, steps, PartMonitor(monitor, 0.0, _FINDING_SHARE))

    def judge(
        _chunk: Chunk, xyz: NDArray[np.float64]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        is_ground, above, _ = surface.judged(xyz)
        return is_ground, above

    _write(points, judge, folders, monitor)


def lowest_ground_of(
    points: DrivePoints,
    cell_m: float,
    tolerance_m: float,
    folders: Sequence[Path],
    monitor: Monitor,
) -> None:
    """Columns as :func:`published_ground_of`, by the lowest point of each cell.

    Raises
    ------
    OutOfRange
        Points that are no noise at fewer than three positions.
    NoSpace, Cancelled
    """
    require_three_positions(points.blocks)
    found = lowest_ground(points.blocks, cell_m, tolerance_m)

    def judge(
        chunk: Chunk, xyz: NDArray[np.float64]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        return found.is_ground(xyz, chunk.first), found.heights_above(xyz)

    _write(points, judge, folders, monitor)


def _write(
    points: DrivePoints, judge: ChunkClassifier, folders: Sequence[Path], monitor: Monitor
) -> None:
    done = 0
    with GroundColumns(points, folders, monitor) as columns:
        for chunk in points.chunks:
            monitor.check()
            is_ground, above = judge(chunk, points.measured_xyz(chunk))
            columns.put(chunk, np.ones(is_ground.shape, np.bool_), is_ground, above)
            done += chunk.stop - chunk.start
            monitor.report(_FINDING_SHARE + (1.0 - _FINDING_SHARE) * done / points.count)
