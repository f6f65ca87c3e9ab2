"""Bodies of points over a road, and which of them hang there.

Vehicles and people stand on the road: somewhere they reach down to it. What hangs over the
carriageway can't come as low, or nobody could drive there. Over a walk poles, trunks and hedges
stand, and what hangs beside them is part of the same body; there single columns tell.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from processing.core.arrays import Flags, Floats, Integers
from processing.methods.road.clearance.points_over_road import PointsOverRoad
from processing.methods.road.surface.road_cells import CARRIAGEWAY, WALK, RoadCells

VOXEL_M = 0.3
"""Bodies whose cubes touch are one: scan lines on a vehicle lie as far apart or less."""

STANDING_M = 1.0
"""What comes lower over the carriageway stands there: guards of lorries hang 0.55 m over the road
at most (道路運送車両の保安基準 第18条の2), wheels touch it."""

INSIDE_M = 0.5
"""From the edge of the carriageway on nothing but vehicles stands: posts and hedges at the edge may
seem to stand a little inside."""

_FEWEST = 5
"""Of points of a body: drops, dust and mixed points come in twos and threes."""

_SHIFTS = np.array(
    [
        (i, j, k)
        for i in (-1, 0, 1)
        for j in (-1, 0, 1)
        for k in (-1, 0, 1)
        if (i, j, k) > (0, 0, 0)
    ],
    np.int64,
)


class HangingBody(NamedTuple):
    """Points that hang together.

    Attributes
    ----------
    lines : (n,) int64
        Of the points over the road.
    part : int
        Carriageway or walk.
    voxels : int
        Cubes of 0.3 m that they fill.
    """

    lines: Integers
    part: int
    voxels: int


def hanging_bodies(found: PointsOverRoad, road: RoadCells) -> Iterator[HangingBody]:
    """Bodies over carriageway and walks that don't stand there, of five points and more."""
    parts = road.part[found.cells]
    on_road = _not_standing(found, np.flatnonzero(parts == CARRIAGEWAY), road)
    for part, lines in ((CARRIAGEWAY, on_road), (WALK, np.flatnonzero(parts == WALK))):
        free = _beside_what_stands(found, lines)
        if free.size:
            yield from _bodies(found, free, part)


def _not_standing(found: PointsOverRoad, lines: Integers, road: RoadCells) -> Integers:
    """Points of bodies that nowhere come low over the inner carriageway."""
    keys, voxel = _voxels(found, lines)
    body = _linked(keys)[voxel]
    depth = road.depth[found.cells[lines]]
    stands = (found.over[lines] < STANDING_M) & (depth >= INSIDE_M)
    standing = np.zeros(int(body.max(initial=-1)) + 1, np.bool_)
    standing[body[stands]] = True
    return lines[~standing[body]]


def _beside_what_stands(found: PointsOverRoad, lines: Integers) -> Integers:
    """Points of columns of cubes that hold nothing low, nor do the columns next to them."""
    keys, voxel = _voxels(found, lines)
    columns, inverse = np.unique(keys[:, :2], axis=0, return_inverse=True)
    column = np.asarray(inverse).reshape(-1)[voxel]
    lowest = np.full(len(columns), np.inf)
    np.minimum.at(lowest, column, found.over[lines])
    low = columns[lowest < STANDING_M]
    return lines[~_is_beside(columns, low)[column]]


def _is_beside(columns: Integers, low: Integers) -> Flags:
    """Which columns of cubes are among some, or next to one of them."""
    if not len(low):
        return np.zeros(len(columns), np.bool_)
    beside = np.concatenate([low + np.array([i, j]) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    together = np.concatenate([np.unique(beside, axis=0), columns])
    _, first, inverse = np.unique(together, axis=0, return_index=True, return_inverse=True)
    taken = len(together) - len(columns)
    return np.asarray(first[np.asarray(inverse).reshape(-1)[taken:]] < taken)


def touching_cubes(places: Floats, width_m: float) -> Integers:
    """(n,) int64 which places (n, 3) belong together: those in cubes that touch."""
    cubes = np.floor(places / width_m).astype(np.int64)
    keys, inverse = np.unique(cubes.reshape(-1, 3), axis=0, return_inverse=True)
    return _linked(keys)[np.asarray(inverse).reshape(-1)]


def _voxels(found: PointsOverRoad, lines: Integers) -> tuple[Integers, Integers]:
    """The cubes that points fill, (k, 3), and the one of each."""
    places = np.column_stack([found.local[lines, :2], found.over[lines]])
    cubes = np.floor(places / VOXEL_M).astype(np.int64)
    keys, inverse = np.unique(cubes.reshape(-1, 3), axis=0, return_inverse=True)
    return keys, np.asarray(inverse).reshape(-1)


def _linked(keys: Integers) -> Integers:
    """Which body each cube belongs to: those that touch, at a corner even, are one."""
    if not len(keys):
        return np.empty(0, np.int64)
    span = np.ptp(keys, axis=0) + 3
    packed = _packed(keys - keys.min(axis=0) + 1, span)
    pairs = []
    for shift in _SHIFTS:
        asked = _packed(keys - keys.min(axis=0) + 1 + shift, span)
        at = np.clip(np.searchsorted(packed, asked), 0, len(packed) - 1)
        met = np.flatnonzero(packed[at] == asked)
        pairs.append(np.column_stack([met, at[met]]))
    both = np.concatenate(pairs)
    links = coo_array(
        (np.ones(len(both), np.bool_), (both[:, 0], both[:, 1])), shape=(len(keys), len(keys))
    )
    return np.asarray(connected_components(links, directed=False)[1], np.int64)


def _packed(keys: Integers, span: Integers) -> Integers:
    """One number a cube, rising as the cubes are ordered."""
    packed: Integers = (keys[:, 0] * span[1] + keys[:, 1]) * span[2] + keys[:, 2]
    return packed


def _bodies(found: PointsOverRoad, lines: Integers, part: int) -> Iterator[HangingBody]:
    keys, voxel = _voxels(found, lines)
    body = _linked(keys)[voxel]
    order = np.argsort(body, kind="stable")
    ends = np.flatnonzero(np.diff(body[order], append=-1)) + 1
    for mine in np.split(order, ends[:-1]):
        if mine.size >= _FEWEST:
            yield HangingBody(np.sort(lines[mine]), part, len(np.unique(voxel[mine])))
