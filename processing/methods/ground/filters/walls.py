"""Faces of steps and walls: columns of points with ground at their foot and ground at their top."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.morphology import nearest_known

_LOWEST_FACE_M = 0.25
_SHORTEST_M = 5.0
_FEET = 0.2
_HEADS = 0.3
_LONG_M = 15.0
_HEADS_OF_LONG = 0.12
_REACH_M = 8.0
_SIDES = 5
_OPPOSITE = 0.25
_FEW_HEADS = 0.25
_CREST_CELLS = 7
_CREST_M = 3.0
_JOIN_CELLS = 3


def column_tops(bins: NDArray[np.uint64]) -> NDArray[np.float32]:
    """How far up the points of a cell go from the ground without a gap: (rows, columns), m.

    Parameters
    ----------
    bins : (rows, columns) uint64
        Bit ``k`` is set where a point lies ``k`` to ``k + 1`` tenths of a metre above the ground.
    """
    tops = np.zeros(bins.shape, np.float32)
    _tops_kernel(bins, tops)
    return tops


def faces(
    surface: NDArray[np.float32],
    ground: NDArray[np.bool_],
    tops: NDArray[np.float32],
    size_m: float,
) -> NDArray[np.float32]:
    """Height that a step's or a wall's face reaches in a cell: (rows, columns), m; −inf without.

    Parameters
    ----------
    surface : (rows, columns) float32
        Ground, m.
    ground : (rows, columns) bool
        Where it was measured.
    tops : (rows, columns) float32
        Height of the column of points that stands on it, m.

    Notes
    -----
    A face has measured ground near its foot on one side and near its top on the other; a fence or
    a machine has ground near its foot on both, also where it touches a face: that is asked of all
    columns within three metres. A face goes up to
    its crest near by, behind which the ground may lie in shadow, and no higher than the ground
    measured at its top near by: what goes on above that stands on the crest.
    """
    import cv2

    column = tops > max(_LOWEST_FACE_M, size_m)
    free = ground & ~column
    count, found, boxes, _ = cv2.connectedComponentsWithStats(
        cv2.dilate(column.astype(np.uint8), np.ones((_JOIN_CELLS, _JOIN_CELLS), np.uint8)),
        connectivity=8,
    )
    labels: NDArray[np.int32] = np.where(column, found, 0).astype(np.int32)
    if count < 2 or not free.any():
        return np.full(column.shape, -np.inf, np.float32)
    reach = max(2, round(_REACH_M / size_m))
    upper = np.where(column, surface + tops, -np.inf).astype(np.float32)
    crest = np.full(column.shape, -np.inf, np.float32)
    rim, feet, heads = np.zeros(count), np.zeros(count), np.zeros(count)
    sides = np.zeros((_SIDES, *column.shape), np.uint8)
    _sides_kernel(labels, surface, free, tops, reach, (rim, feet, heads), (upper, crest, sides))
    length = size_m * np.hypot(boxes[:, cv2.CC_STAT_WIDTH], boxes[:, cv2.CC_STAT_HEIGHT])
    needed = np.where(length >= _LONG_M, _HEADS_OF_LONG, _HEADS)
    face = (length >= _SHORTEST_M) & (feet >= _FEET * rim) & (heads >= needed * rim) & (rim > 0)
    face[0] = False
    upper[~face[labels] | _stands_free(sides, size_m)] = -np.inf
    upper = _below_crest(upper, crest, labels, size_m)
    near = cv2.dilate(upper, np.ones((3, 3), np.uint8)).astype(np.float32)
    highest = cv2.dilate(upper, np.ones((_CREST_CELLS, _CREST_CELLS), np.uint8)).astype(np.float32)
    return np.where(np.isfinite(near), highest, near)


def _stands_free(sides: NDArray[np.uint8], size_m: float) -> NDArray[np.bool_]:
    """Columns along which ground at the foot lies on both sides: a fence that meets a face."""
    import cv2

    side = 2 * max(1, round(_CREST_M / size_m)) + 1
    down, up, right, left, heads = (
        cv2.boxFilter(one, cv2.CV_32F, (side, side), normalize=False) for one in sides
    )
    feet = down + up + right + left
    opposite = np.minimum(down, up) + np.minimum(right, left)
    free: NDArray[np.bool_] = (opposite > _OPPOSITE * feet) & (heads < _FEW_HEADS * feet)
    return free


def _below_crest(
    upper: NDArray[np.float32],
    crest: NDArray[np.float32],
    labels: NDArray[np.int32],
    size_m: float,
) -> NDArray[np.float32]:
    """Let no column of a face go higher than the ground found at the top of that face near by.

    With the ground behind in shadow some heights are those of ledges in the face: the highest
    within a few metres is the crest.
    """
    import cv2

    found = np.isfinite(crest) & np.isfinite(upper)
    if not found.any():
        return upper
    side = 2 * max(1, round(_CREST_M / size_m)) + 1
    element = np.ones((side, side), np.uint8)
    around = cv2.dilate(np.where(found, crest, np.float32(-np.inf)), element)
    nearest = nearest_known(found)
    same = labels.reshape(-1)[nearest] == labels
    highest = np.where(same, around.reshape(-1)[nearest], np.float32(np.inf))
    return np.minimum(upper, highest).astype(np.float32)


@kernel
def _tops_kernel(bins: NDArray[np.uint64], tops: NDArray[np.float32]) -> None:
    for row in range(bins.shape[0]):
        for column in range(bins.shape[1]):
            empty = 0
            for k in range(64):
                if (bins[row, column] >> np.uint64(k)) & np.uint64(1):
                    tops[row, column] = 0.1 * (k + 1)
                    empty = 0
                else:
                    empty += 1
                    if empty > 3:
                        break


@kernel
def _first_free(
    labels: NDArray[np.int32], free: NDArray[np.bool_], cell: int, side: int, reach: int
) -> int:
    """The first cell to one side that is open ground: −1 where the same column comes first."""
    rows, columns = labels.shape
    row, column = cell // columns, cell % columns
    down = (side == 0) - (side == 1)
    right = (side == 2) - (side == 3)
    for step in range(1, reach + 1):
        r, c = row + step * down, column + step * right
        if r < 0 or c < 0 or r >= rows or c >= columns or labels[r, c] == labels[row, column]:
            return -1
        if free[r, c]:
            return int(r * columns + c)
    return -1


@kernel
def _sides_kernel(
    labels: NDArray[np.int32],
    surface: NDArray[np.float32],
    free: NDArray[np.bool_],
    tops: NDArray[np.float32],
    reach: int,
    counts: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    found: tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint8]],
) -> None:
    rim, feet, heads = counts
    upper, crest, sides = found
    rows, columns = labels.shape
    for row in range(rows):
        for column in range(columns):
            label = labels[row, column]
            if label == 0:
                continue
            low_sides = 0
            for side in range(4):
                beside = _first_free(labels, free, row * columns + column, side, reach)
                if beside < 0:
                    continue
                height = surface[beside // columns, beside % columns]
                beyond = height - surface[row, column]
                rim[label] += 1.0
                if beyond < 0.25 * tops[row, column]:
                    feet[label] += 1.0
                    low_sides |= 1 << side
                    sides[side, row, column] = 1
                elif beyond > 0.65 * tops[row, column]:
                    heads[label] += 1.0
                    sides[4, row, column] += 1
                    upper[row, column] = max(upper[row, column], height)
                    crest[row, column] = max(crest[row, column], height)
            if low_sides & 3 == 3 or low_sides & 12 == 12:
                upper[row, column] = -np.inf


def warm_up() -> None:
    """Compile the kernels of this file."""
    surface = np.zeros((4, 4), np.float32)
    bins = np.zeros((4, 4), np.uint64)
    bins[1] = 63
    faces(surface, np.ones((4, 4), np.bool_), column_tops(bins), 0.2)
