"""Faces of steps and walls: columns of points with ground at their foot and ground at their top.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated earthwork sites and on airborne samples of the ISPRS filter test.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.morphology import nearest_known

BIN_M = 0.1
"""Height of one bit of a column of points; thinner than what stands apart on a face."""

BINS = 64
"""Bits of a column: 6.4 m, what an unsigned 64-bit number holds. Faces above that are cut off."""

_EMPTY_BINS = 3
"""A column ends where more bits than these are empty, by trial: over a gap of 0.3 m begins another
thing, as a crown above a wall."""

_LOWEST_FACE_M = 0.25
"""Height from which a column may be a face, by trial; the face of a lower step lies between the
heights of its neighbours, which the band allows already."""

_SHORTEST_M = 5.0
"""Length in plan from which columns may be a face, by trial: shorter ones are rather the side of a
machine or of a stack."""

_FEET_SHARE, _HEADS_SHARE = 0.2, 0.3
"""Of the sides of a face's columns at which open ground is met: the share with ground at the foot,
and at the top. By trial; the rest lies in shadow or between."""

_LONG_M, _HEADS_SHARE_OF_LONG = 15.0, 0.12
"""From this length less ground at the top is enough: seen from below, much of the ground behind a
long face lies in its shadow, and nothing movable is as long. By trial."""

_REACH_M = 8.0
"""How far beside a column open ground is looked for, by trial: a face's shadow may be as wide."""

_FOOT_RISE_SHARE, _HEAD_RISE_SHARE = 0.25, 0.65
"""Rise to the ground beside as a share of the column's height: less is ground at the foot, more is
ground at the top, between them it says neither. By trial."""

_SIDES, _HEADS = 4, 4
"""Sides of a cell (down, up, right, left), and the layer after theirs that counts heads."""

_UP_AND_DOWN, _BESIDE = 0b0011, 0b1100
"""Bits of opposite sides."""

_OPPOSITE_SHARE, _FEW_HEADS_SHARE = 0.25, 0.25
"""Shares of the columns with ground at their foot: more of them with it on two opposite sides, and
fewer with ground at their top, are a fence or a wall that stands free. By trial, on a fence of 15 m
that met a wall and had been taken for its face."""

_CREST_CELLS = 7
"""Side of the window through which a face goes up to its crest: three cells to every side.
By trial."""

_CREST_M = 3.0
"""How far around the highest ground found at the top of a face is its crest, and within which
columns must not have ground on both sides. Measured on 58 scenes of a site seen from one side:
ground lost 0.613 % without, 0.554 % with it, kappa 0.9604 and 0.9626."""

_JOIN_CELLS = 3
"""Side of the window that joins columns to one face: two with one cell between them still join."""


class _RimCounts(NamedTuple):
    """For each face: sides of its columns that meet open ground, at the foot, and at the top."""

    rim: NDArray[np.float64]
    feet: NDArray[np.float64]
    heads: NDArray[np.float64]


class _FaceHeights(NamedTuple):
    """For each cell: how high a face reaches and its crest, m, and which sides have ground."""

    upper: NDArray[np.float32]
    crest: NDArray[np.float32]
    sides: NDArray[np.uint8]


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
    columns within three metres. A face goes up to its crest near by, behind which the ground may
    lie in shadow, and no higher than the ground measured at its top near by: what goes on above
    that stands on the crest.
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
    counts = _RimCounts(np.zeros(count), np.zeros(count), np.zeros(count))
    sides = np.zeros((_SIDES + 1, *column.shape), np.uint8)
    heights = _FaceHeights(upper, crest, sides)
    _sides_kernel(labels, surface, free, tops, reach, counts, heights)
    length = size_m * np.hypot(boxes[:, cv2.CC_STAT_WIDTH], boxes[:, cv2.CC_STAT_HEIGHT])
    needed = np.where(length >= _LONG_M, _HEADS_SHARE_OF_LONG, _HEADS_SHARE)
    face = (length >= _SHORTEST_M) & (counts.rim > 0)
    face &= (counts.feet >= _FEET_SHARE * counts.rim) & (counts.heads >= needed * counts.rim)
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
    free: NDArray[np.bool_] = (opposite > _OPPOSITE_SHARE * feet) & (
        heads < _FEW_HEADS_SHARE * feet
    )
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
            for k in range(BINS):
                if (bins[row, column] >> np.uint64(k)) & np.uint64(1):
                    tops[row, column] = BIN_M * (k + 1)
                    empty = 0
                else:
                    empty += 1
                    if empty > _EMPTY_BINS:
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
    counts: _RimCounts,
    found: _FaceHeights,
) -> None:
    upper, crest, sides = found.upper, found.crest, found.sides
    rows, columns = labels.shape
    for row in range(rows):
        for column in range(columns):
            label = labels[row, column]
            if label == 0:
                continue
            low_sides = 0
            for side in range(_SIDES):
                beside = _first_free(labels, free, row * columns + column, side, reach)
                if beside < 0:
                    continue
                height = surface[beside // columns, beside % columns]
                beyond = height - surface[row, column]
                counts.rim[label] += 1.0
                if beyond < _FOOT_RISE_SHARE * tops[row, column]:
                    counts.feet[label] += 1.0
                    low_sides |= 1 << side
                    sides[side, row, column] = 1
                elif beyond > _HEAD_RISE_SHARE * tops[row, column]:
                    counts.heads[label] += 1.0
                    sides[_HEADS, row, column] += 1
                    upper[row, column] = max(upper[row, column], height)
                    crest[row, column] = max(crest[row, column], height)
            if low_sides & _UP_AND_DOWN == _UP_AND_DOWN or low_sides & _BESIDE == _BESIDE:
                upper[row, column] = -np.inf


def warm_up() -> None:
    """Compile the kernels of this file."""
    surface = np.zeros((4, 4), np.float32)
    bins = np.zeros((4, 4), np.uint64)
    bins[1] = 63
    faces(surface, np.ones((4, 4), np.bool_), column_tops(bins), 0.2)
