"""Holes of a height grid filled as a stretched skin, and what lies nearest to them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel


class _RelaxedCells(NamedTuple):
    """Cells to relax, counted along the rows: the two colours of a chessboard, and the border."""

    even: NDArray[np.int32]
    odd: NDArray[np.int32]
    border: NDArray[np.int32]


_SWEEPS = 24
"""Rounds of relaxing on each grid. The coarser grid has given the long waves already; 24 rounds
even out what is a few cells wide. By trial."""

_RELAXED_CELLS = 16
"""From known cells up to which a skin is relaxed; by trial. Beyond, heights differ by up to 1 cm on
a rough surface from those of relaxing everywhere, which took four times as long on a street."""

_SOBEL_SPACINGS = 8.0
"""What OpenCV's Sobel operator gives for a rise of one per cell: its weights times distances."""

_BORDER_LIST = 2
"""Which of the lists holds cells on the border; 0 and 1 are the colours of the chessboard."""


def fill_heights(heights: NDArray[np.float32], known: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Heights everywhere: the known ones, and between them a skin without own bumps.

    Parameters
    ----------
    heights : (rows, columns) float32
        m; values where ``known`` is false are not read.
    known : (rows, columns) bool
        At least one is true.

    Notes
    -----
    Laplace's equation, solved from coarse to fine grids: the same whatever the order of points.
    """
    if known.all():
        return heights.copy()
    surface = np.where(known, heights, np.float32(0.0)).astype(np.float32)
    if known.shape[0] > 1 or known.shape[1] > 1:
        coarse_heights, coarse_known = _halved(surface, known)
        coarse = fill_heights(coarse_heights, coarse_known)
        _prolong_kernel(coarse, known, surface)
        _relax_kernel(_near_known(known), _SWEEPS, surface)
    return surface


def _near_known(known: NDArray[np.bool_]) -> _RelaxedCells:
    """Cells to relax: those near known ones.

    Far from what is known the coarser skin is as smooth as relaxing would make it.
    """
    import cv2

    element = np.ones((2 * _RELAXED_CELLS + 1, 2 * _RELAXED_CELLS + 1), np.uint8)
    near = np.asarray(cv2.dilate(known.view(np.uint8), element), np.uint8)
    cells = np.empty((3, _list_kernel(near, known, np.empty((3, 0), np.int32))), np.int32)
    _list_kernel(near, known, cells)
    even, odd, border = cells
    return _RelaxedCells(even[even >= 0], odd[odd >= 0], border[border >= 0])


def nearest_known(known: NDArray[np.bool_]) -> NDArray[np.int32]:
    """The nearest known cell of every cell, counted along the rows: (rows, columns) int32."""
    import cv2

    _, labels = cv2.distanceTransformWithLabels(
        (~known).view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    # Known cells are numbered from 1 along the rows.
    cell_of_label = np.zeros(int(np.count_nonzero(known)) + 1, np.int32)
    cell_of_label[1:] = np.flatnonzero(known)
    nearest: NDArray[np.int32] = cell_of_label[labels]
    return nearest


def steepness_of(surface: NDArray[np.float32], size_m: float) -> NDArray[np.float32]:
    """Rise over run of a surface: (rows, columns) float32."""
    import cv2

    scale = 1.0 / (_SOBEL_SPACINGS * size_m)
    east = cv2.Sobel(surface, cv2.CV_32F, 1, 0, scale=scale, borderType=cv2.BORDER_REPLICATE)
    north = cv2.Sobel(surface, cv2.CV_32F, 0, 1, scale=scale, borderType=cv2.BORDER_REPLICATE)
    return np.hypot(east, north).astype(np.float32)


def _halved(
    heights: NDArray[np.float32], known: NDArray[np.bool_]
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    rows, columns = (known.shape[0] + 1) // 2, (known.shape[1] + 1) // 2
    coarse = np.zeros((rows, columns), np.float32)
    coarse_known = np.zeros((rows, columns), np.bool_)
    _halve_kernel(heights, known, coarse, coarse_known)
    return coarse, coarse_known


@kernel
def _halve_kernel(
    heights: NDArray[np.float32],
    known: NDArray[np.bool_],
    coarse: NDArray[np.float32],
    coarse_known: NDArray[np.bool_],
) -> None:
    for row in range(coarse.shape[0]):
        for column in range(coarse.shape[1]):
            total = 0.0
            count = 0
            for r in range(2 * row, min(2 * row + 2, known.shape[0])):
                for c in range(2 * column, min(2 * column + 2, known.shape[1])):
                    if known[r, c]:
                        total += heights[r, c]
                        count += 1
            if count:
                coarse[row, column] = total / count
                coarse_known[row, column] = True


@kernel
def _prolong_kernel(
    coarse: NDArray[np.float32], known: NDArray[np.bool_], surface: NDArray[np.float32]
) -> None:
    rows, columns = coarse.shape
    for row in range(known.shape[0]):
        y = min(max((row + 0.5) / 2 - 0.5, 0.0), rows - 1.0)
        r = min(int(y), max(rows - 2, 0))
        r1 = min(r + 1, rows - 1)
        v = y - r
        for column in range(known.shape[1]):
            if known[row, column]:
                continue
            x = min(max((column + 0.5) / 2 - 0.5, 0.0), columns - 1.0)
            c = min(int(x), max(columns - 2, 0))
            c1 = min(c + 1, columns - 1)
            u = x - c
            surface[row, column] = (1 - v) * ((1 - u) * coarse[r, c] + u * coarse[r, c1]) + v * (
                (1 - u) * coarse[r1, c] + u * coarse[r1, c1]
            )


@kernel
def _list_kernel(
    near: NDArray[np.uint8], known: NDArray[np.bool_], lists: NDArray[np.int32]
) -> int:
    """Number of cells in the longest list; lists with room for them are filled, and up with −1."""
    rows, columns = known.shape
    counts = np.zeros(3, np.int64)
    for row in range(rows):
        for column in range(columns):
            if not near[row, column] or known[row, column]:
                continue
            own = (row + column) % 2
            if row == 0 or column == 0 or row == rows - 1 or column == columns - 1:
                own = _BORDER_LIST
            if counts[own] < lists.shape[1]:
                lists[own, counts[own]] = row * columns + column
            counts[own] += 1
    for own in range(3):
        lists[own, counts[own] :] = -1
    return int(counts.max())


@kernel
def _relax_kernel(cells: _RelaxedCells, sweeps: int, surface: NDArray[np.float32]) -> None:
    """Give cells the mean of their neighbours; none waits for another of its colour."""
    columns = surface.shape[1]
    heights = surface.reshape(-1)
    for _ in range(sweeps):
        _relax_inside(cells.even, columns, heights)
        _relax_inside(cells.odd, columns, heights)
        for cell in cells.border:
            _relax_at_border(cell // columns, cell % columns, surface)


@kernel
def _relax_inside(cells: NDArray[np.int32], columns: int, heights: NDArray[np.float32]) -> None:
    for position in range(cells.shape[0]):
        cell = cells[position]
        beside = heights[cell - 1] + heights[cell + 1]
        beyond = heights[cell - columns] + heights[cell + columns]
        heights[cell] = np.float32(0.25) * (beside + beyond)


@kernel
def _relax_at_border(row: int, column: int, surface: NDArray[np.float32]) -> None:
    rows, columns = surface.shape
    total = np.float32(0.0)
    count = 0
    for side in range(4):
        r = row - (side == 0) + (side == 1)
        c = column - (side == 2) + (side == 3)
        if 0 <= r < rows and 0 <= c < columns:
            total += surface[r, c]
            count += 1
    surface[row, column] = total / np.float32(count)


def warm_up() -> None:
    """Compile the kernels of this file."""
    known = np.zeros((4, 4), np.bool_)
    known[0, 0] = known[3, 3] = True
    fill_heights(np.ones((4, 4), np.float32), known)
