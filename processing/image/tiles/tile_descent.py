"""The way down a pyramid from its one coarse tile, past all that a view doesn't need.

However many tiles there are, a view asks for few of them: only those that are seen and too coarse
lead on to finer ones.
"""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.image.tiles.tile_kernels import TILE

LINE, LEVEL, ROW, COLUMN, GAP_PX, PIXELS, FIRST, END = range(8)
"""Columns of what was met on the way down: its line in the pyramid's facts, the tile, how far its
points are apart on the screen, how many it has, and where its children begin and end in the same
list."""

MET_VALUES = 8

_SCALE, _IS_PARALLEL, _FINE_ENOUGH_PX, _WANTS_ALL = range(3, 7)
"""Of an eye, behind its position: pixels per metre one metre in front of it; whether it sees in
parallel; the gap that is fine enough; whether it wants points that no pixel shows."""

_DIRECTION, _RADIUS, _WIDENING, _LEAST_DEPTH = 3, 6, 7, 8
"""Of a ray, behind its beginning: where its direction begins; radius of the cone about it at its
beginning, m, and how much wider it gets with each metre; the least depth."""

_HIGHEST, _COUNT, _ROW_STEP, _COLUMN_STEP, _POINTS = 3, 6, 7, 8, 9
"""Of a box: where its highest corner begins, and its counts, as in `tile_kernels`."""

_MORE = 1.02
"""A tile has more points than pixels if there are so many times as many: for less a finer level is
not worth its loading. By trial; no measurement is recorded."""

_NEAREST_M, _LEAST_SLOPE = 1e-3, 1e-12
"""Guards of divisions: of an eye within a box, of a ray square to an axis."""


class TileAddress(NamedTuple):
    """A tile of the pyramid: its level, 0 the finest, and its row and column of tiles."""

    level: int
    row: int
    column: int


class SpendingLimits(NamedTuple):
    """The gap that is fine enough, px, and how many points may be spent on wider ones."""

    fine_enough_px: float
    most_points: float


@kernel
def descent_kernel(
    facts: NDArray[np.float64],
    shapes: NDArray[np.int64],
    eye: NDArray[np.float64],
    planes: NDArray[np.float64],
    met: NDArray[np.float64],
) -> int:
    """List the tiles that are seen, each before its children; says how many they are.

    ``shapes``: rows and columns of tiles and the first line in ``facts`` of each level. ``eye``:
    position, pixels per metre one metre in front of it, whether it sees in parallel, the gap that
    is fine enough, and whether it wants points that no pixel shows: below the finest tiles, as
    level −1, are then those with all their points. A tile is seen that isn't wholly beyond one of
    ``planes`` (a, b, c, d): where a·x + b·y + c·z ≤ d. ``met`` has room for all of them.
    """
    top = shapes.shape[0] - 1
    if not _is_seen(facts[shapes[top, 2]], planes):
        return 0
    count, at = 1, 0
    _put_tile(facts, shapes, eye, TileAddress(top, 0, 0), met[0])
    while at < count:
        level, row, column = int(met[at, LEVEL]), int(met[at, ROW]), int(met[at, COLUMN])
        met[at, FIRST] = count
        if level > 0 and met[at, GAP_PX] > eye[_FINE_ENOUGH_PX]:
            for i in range(2 * row, min(2 * row + 2, shapes[level - 1, 0])):
                for j in range(2 * column, min(2 * column + 2, shapes[level - 1, 1])):
                    line = shapes[level - 1, 2] + i * shapes[level - 1, 1] + j
                    if _is_seen(facts[line], planes):
                        _put_tile(facts, shapes, eye, TileAddress(level - 1, i, j), met[count])
                        count += 1
        if level == 0 and eye[_WANTS_ALL] and met[at, GAP_PX] > eye[_FINE_ENOUGH_PX]:
            count = _put_all(facts[int(met[at, LINE])], met, at, count)
        met[at, END] = count
        at += 1
    return count


@kernel
def choice_kernel(
    met: NDArray[np.float64],
    roots: NDArray[np.int64],
    is_shown: NDArray[np.bool_],
    limits: SpendingLimits,
    is_chosen: NDArray[np.bool_],
) -> None:
    """Choose tiles among those met: the widest gaps are filled first, until points run out."""
    spent = 0.0
    waiting = [(0.0, 0)]
    waiting.clear()
    for root in roots:
        if is_shown[root]:
            spent += met[root, PIXELS]
            heapq.heappush(waiting, (-met[root, GAP_PX], root))
    while len(waiting) > 0:
        gap, tile = heapq.heappop(waiting)
        more, children = -met[tile, PIXELS], 0
        for child in range(int(met[tile, FIRST]), int(met[tile, END])):
            if is_shown[child]:
                more += met[child, PIXELS]
                children += 1
        is_over = spent + more > limits.most_points
        if -gap <= limits.fine_enough_px or children == 0 or is_over:
            is_chosen[tile] = True
            continue
        spent += more
        for child in range(int(met[tile, FIRST]), int(met[tile, END])):
            if is_shown[child]:
                heapq.heappush(waiting, (-met[child, GAP_PX], child))


@kernel
def ray_kernel(
    facts: NDArray[np.float64],
    shapes: NDArray[np.int64],
    ray: NDArray[np.float64],
    met: NDArray[np.float64],
) -> int:
    """List the finest tiles that the cone about a ray meets, and where it enters them.

    ``ray``: where it begins, its direction so long that it goes one metre deep, the cone's radius
    at its beginning and how much wider it gets with each metre. ``met``: row, column, depth of
    the entry, which is never less than the least depth; each (tiles of the finest level).
    """
    waiting = [(shapes.shape[0] - 1, 0, 0)]
    count = 0
    while len(waiting) > 0:
        level, row, column = waiting.pop()
        line = shapes[level, 2] + row * shapes[level, 1] + column
        depth = entry_depth(facts[line], ray)
        if not np.isfinite(depth):
            continue
        if level == 0:
            met[count, 0], met[count, 1], met[count, 2] = row, column, depth
            count += 1
            continue
        for i in range(2 * row, min(2 * row + 2, shapes[level - 1, 0])):
            for j in range(2 * column, min(2 * column + 2, shapes[level - 1, 1])):
                waiting.append((level - 1, i, j))  # noqa: PERF401 - a kernel makes no lists
    return count


@kernel
def entry_depth(box: NDArray[np.float64], ray: NDArray[np.float64]) -> float:
    """Where a cone enters a box (lowest, highest corner); infinite where it misses it."""
    if box[0] > box[_HIGHEST]:
        return np.inf
    reach = 0.0
    for axis in range(3):
        reach += max(abs(box[axis] - ray[axis]), abs(box[_HIGHEST + axis] - ray[axis])) ** 2
    margin = ray[_RADIUS] + ray[_WIDENING] * np.sqrt(reach)
    enter, leave = -np.inf, np.inf
    for axis in range(3):
        direction = ray[_DIRECTION + axis]
        if abs(direction) < _LEAST_SLOPE:
            direction = _LEAST_SLOPE
        first = (box[axis] - margin - ray[axis]) / direction
        second = (box[_HIGHEST + axis] + margin - ray[axis]) / direction
        enter, leave = max(enter, min(first, second)), min(leave, max(first, second))
    if leave < enter or leave <= ray[_LEAST_DEPTH]:
        return np.inf
    return float(max(enter, ray[_LEAST_DEPTH]))


@kernel
def _is_seen(box: NDArray[np.float64], planes: NDArray[np.float64]) -> bool:
    """Whether a box that isn't empty has its most inward corner within each of the planes."""
    if box[0] > box[_HIGHEST]:
        return False
    for plane in range(planes.shape[0]):
        reached = 0.0
        for axis in range(3):
            normal = planes[plane, axis]
            reached += normal * (box[axis] if normal > 0 else box[_HIGHEST + axis])
        if reached > planes[plane, 3]:
            return False
    return True


@kernel
def _put_tile(
    facts: NDArray[np.float64],
    shapes: NDArray[np.int64],
    eye: NDArray[np.float64],
    tile: TileAddress,
    met: NDArray[np.float64],
) -> None:
    """What a view has to know of a tile."""
    level, row, column = tile
    line = shapes[level, 2] + row * shapes[level, 1] + column
    box = facts[line]
    away, size = 0.0, 0.0
    for axis in range(3):
        away += max(0.0, box[axis] - eye[axis], eye[axis] - box[_HIGHEST + axis]) ** 2
        size += (box[_HIGHEST + axis] - box[axis]) ** 2
    # Gaps across rows are the wider ones nearly everywhere, and the ones that show.
    spacing = max(box[_ROW_STEP], box[_COLUMN_STEP]) * 2.0**level
    if spacing == 0.0:
        spacing = np.sqrt(size) / TILE
    divisor = 1.0 if eye[_IS_PARALLEL] else max(np.sqrt(away), _NEAREST_M)
    met[LINE], met[LEVEL], met[ROW], met[COLUMN] = line, level, row, column
    met[PIXELS] = box[_COUNT]
    # A tile without points of its own may stand above some that have points.
    met[GAP_PX] = spacing * eye[_SCALE] / divisor if box[_COUNT] > 0 else np.inf
    if level == 0 and eye[_WANTS_ALL] and box[_COUNT] > 0:
        # Points stacked in a pixel are a surface on edge, whose gaps its neighbours don't tell.
        met[GAP_PX] *= box[_POINTS] / box[_COUNT]


@kernel
def _put_all(box: NDArray[np.float64], met: NDArray[np.float64], tile: int, count: int) -> int:
    """Below a tile itself with all its points, if those are more; says how many are met now."""
    if box[_POINTS] <= _MORE * box[_COUNT]:
        return count
    met[count] = met[tile]
    met[count, LEVEL], met[count, GAP_PX], met[count, PIXELS] = -1.0, 0.0, box[_POINTS]
    return count + 1


def warm_up() -> None:
    """Compile the kernels."""
    facts = np.zeros((1, 10))
    shapes = np.array([[1, 1, 0]])
    met = np.zeros((2, MET_VALUES))
    count = descent_kernel(facts, shapes, np.ones(7), np.zeros((1, 4)), met)
    flags = np.ones(count, np.bool_)
    choice_kernel(met, np.zeros(1, np.int64), flags, SpendingLimits(1.0, 1.0), flags)
    ray_kernel(facts, shapes, np.ones(9), met)
