"""Openings of a height grid with an octagon, and holes of a grid filled as a stretched skin."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel

_SWEEPS = 24
_RELAXED_CELLS = 16


def opened(heights: NDArray[np.float32], radius: int) -> NDArray[np.float32]:
    """The highest surface below ``heights`` that an octagon of ``radius`` cells can touch.

    Beyond its border the grid goes on with the border's heights.

    References
    ----------
    Soille 2003: an octagon is the sum of squares and crosses; the shares here make it regular.
    """
    import cv2

    side = round(0.414 * radius)
    square = np.ones((2 * side + 1, 2 * side + 1), np.uint8)
    cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
    surface = np.pad(heights, radius, mode="edge")
    for turn in (cv2.erode, cv2.dilate):
        surface = turn(surface, square).astype(np.float32, copy=False)
        surface = turn(surface, cross, iterations=radius - side).astype(np.float32, copy=False)
    inside = slice(radius, -radius)
    return np.ascontiguousarray(surface[inside, inside])


def opened_within(heights: NDArray[np.float32], radius: int) -> NDArray[np.float32]:
    """The same, but beyond its border the grid goes on with its own mirror image."""
    mirrored = np.pad(heights, radius, mode="symmetric")
    inside = slice(radius, -radius)
    return np.ascontiguousarray(opened(mirrored, radius)[inside, inside])


def filled(heights: NDArray[np.float32], known: NDArray[np.bool_]) -> NDArray[np.float32]:
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
        coarse = filled(coarse_heights, coarse_known)
        _prolong_kernel(coarse, known, surface)
        there, back = _near_known(known)
        _relax_kernel(there, back, _SWEEPS, surface)
    return surface


def _near_known(known: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cells to relax, counted along the rows, and the same with each row from its end.

    Far from what is known the coarser skin is as smooth as relaxing would make it.
    """
    import cv2

    element = np.ones((2 * _RELAXED_CELLS + 1, 2 * _RELAXED_CELLS + 1), np.uint8)
    near = (cv2.dilate(known.view(np.uint8), element) > 0) & ~known
    columns = known.shape[1]
    turned = np.flatnonzero(near[:, ::-1])
    return np.flatnonzero(near), turned + (columns - 1 - 2 * (turned % columns))


def nearest_known(known: NDArray[np.bool_]) -> NDArray[np.int32]:
    """The nearest known cell of every cell, counted along the rows: (rows, columns) int32."""
    import cv2

    _, labels = cv2.distanceTransformWithLabels(
        (~known).view(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    flat = np.flatnonzero(known)
    cell_of_label = np.zeros(int(labels.max()) + 1, np.int32)
    cell_of_label[labels.ravel()[flat]] = flat
    nearest: NDArray[np.int32] = cell_of_label[labels]
    return nearest


def steepness_of(surface: NDArray[np.float32], size_m: float) -> NDArray[np.float32]:
    """Rise over run of a surface: (rows, columns) float32."""
    import cv2

    scale = 1.0 / (8.0 * size_m)
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
def _relax_kernel(
    there: NDArray[np.int64],
    back: NDArray[np.int64],
    sweeps: int,
    surface: NDArray[np.float32],
) -> None:
    rows, columns = surface.shape
    for sweep in range(sweeps):
        cells = there if sweep % 2 == 0 else back
        for place in range(cells.shape[0]):
            row, column = cells[place] // columns, cells[place] % columns
            total = np.float32(0.0)
            count = 0
            if row > 0:
                total += surface[row - 1, column]
                count += 1
            if row < rows - 1:
                total += surface[row + 1, column]
                count += 1
            if column > 0:
                total += surface[row, column - 1]
                count += 1
            if column < columns - 1:
                total += surface[row, column + 1]
                count += 1
            surface[row, column] = total / np.float32(count)


def warm_up() -> None:
    """Compile the kernels of this file."""
    known = np.zeros((4, 4), np.bool_)
    known[0, 0] = known[3, 3] = True
    filled(np.ones((4, 4), np.float32), known)
