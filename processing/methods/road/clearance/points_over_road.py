"""The points in the room over a road, with their heights over its surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan, cell_of
from processing.methods.road.surface.road_cells import RoadCells
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive

LOWEST_M = 0.3
"""Below are curbs, the surface itself and what lies on it."""

_MOVING = 64
"""Code of vehicles, bicycles and people."""


class PointsOverRoad(NamedTuple):
    """Points, in the order of drives and points.

    Attributes
    ----------
    local : (n, 3) float64
        m about the plan's origin.
    over : (n,) float64
        Height over the road's surface below, m.
    cells : (n,) int64
        The cell below each.
    codes : (n,) uint8
        The class that counts; 0: none was told.
    drives, points : (n,) int64
    """

    local: Floats
    over: Floats
    cells: Integers
    codes: NDArray[np.uint8]
    drives: Integers
    points: Integers


def points_over_road(
    drives: Sequence[Drive],
    plan: SparsePlan,
    road: RoadCells,
    highest: Sequence[float],
    monitor: Monitor,
) -> PointsOverRoad:
    """All points over the cells of a road, without noise and what a class says to be moving.

    Parameters
    ----------
    highest : (float, float)
        Over carriageway and walks, up to which they are gathered, m.
    """
    limits = np.array([0.0, *highest])
    classes = [class_columns(drive.columns) for drive in drives]

    def gathered(chunk: DriveChunk) -> PointsOverRoad:
        over = np.empty(len(chunk.local))
        cells = np.empty(len(chunk.local), np.int64)
        over_kernel(chunk.local, plan.table, (road.surface, road.part), limits, (cells, over))
        over[chunk.is_noise] = np.nan
        kept = np.flatnonzero(np.isfinite(over))
        points = chunk.start + kept
        codes = classes[chunk.drive].codes_of(points)
        still = codes != _MOVING
        kept, points = kept[still], points[still]
        owner = np.full(kept.size, chunk.drive, np.int64)
        return PointsOverRoad(
            chunk.local[kept], over[kept], cells[kept], codes[still], owner, points
        )

    parts = list(in_order(gathered, chunks_of(drives, plan.origin, monitor)))
    empty = np.empty(0, np.int64)
    none = PointsOverRoad(np.empty((0, 3)), np.empty(0), empty, np.empty(0, np.uint8), empty, empty)
    return PointsOverRoad(*(np.concatenate(one) for one in zip(none, *parts, strict=True)))


@kernel
def over_kernel(
    local: Floats,
    table: NDArray[np.int32],
    road: tuple[NDArray[np.float32], NDArray[np.uint8]],
    limits: Floats,
    told: tuple[Integers, Floats],
) -> None:
    """The cell of each point and its height over the surface; NaN where that is out of the room.

    Parameters
    ----------
    road : (surface, part), each (cells,)
    limits : (3,) float64
        Heights up to which points count, by the part of the road.
    told : (cells, over), each (n,)
        Written.
    """
    surface, part = road
    cells, over = told
    for point in range(len(local)):
        cell = cell_of(local[point, 0], local[point, 1], table, TILE)
        cells[point] = cell
        over[point] = np.nan
        if cell < 0 or part[cell] == 0:
            continue
        above = local[point, 2] - surface[cell]
        if LOWEST_M < above < limits[part[cell]]:
            over[point] = above
