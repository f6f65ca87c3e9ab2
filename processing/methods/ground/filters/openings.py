"""Openings of a height grid with an octagon, at the same cost for small and for large ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_SQUARE_SHARE = 0.414
"""Of an octagon's radius the half side of its square, √2 − 1: with it all eight sides are alike."""

_FEW_CROSSES = 10
"""So many crosses are laid on one after the other; more of them cost more than two diagonals. The
result is the same."""


def open_heights(heights: NDArray[np.float32], radius: int) -> NDArray[np.float32]:
    """The highest surface below ``heights`` that an octagon of ``radius`` cells can touch.

    Beyond its border the grid goes on with the border's heights.

    References
    ----------
    Soille 2003: an octagon is the sum of squares and crosses; the shares here make it regular.
    """
    import cv2

    return _opened(heights, radius, cv2.BORDER_REPLICATE)


def open_heights_within(heights: NDArray[np.float32], radius: int) -> NDArray[np.float32]:
    """The same, but beyond its border the grid goes on with its own mirror image."""
    import cv2

    return _opened(heights, radius, cv2.BORDER_REFLECT)


def _opened(heights: NDArray[np.float32], radius: int, border: int) -> NDArray[np.float32]:
    import cv2

    wider = cv2.copyMakeBorder(heights, radius, radius, radius, radius, border)
    surface: NDArray[np.float32] = np.asarray(wider, np.float32)
    scratch = np.empty_like(surface)
    for _ in range(2):
        _sink(surface, radius, scratch)
        np.negative(surface, out=surface)
    return np.ascontiguousarray(surface[radius:-radius, radius:-radius])


def _sink(surface: NDArray[np.float32], radius: int, scratch: NDArray[np.float32]) -> None:
    """Give each cell the least height of the octagon around it, in place."""
    import cv2

    side = round(_SQUARE_SHARE * radius)
    crosses = radius - side
    cv2.erode(surface, np.ones((2 * side + 1, 2 * side + 1), np.uint8), dst=surface)
    if crosses > _FEW_CROSSES:
        # Two diagonals make every second cell of a diamond, a cross the others.
        half = (crosses - 1) // 2
        _least_along_kernel(surface, half, 1, scratch)
        _least_along_kernel(scratch, half, -1, surface)
        crosses -= 2 * half
    cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
    cv2.erode(surface, cross, dst=surface, iterations=crosses)


@kernel
def _least_of_two(
    first: NDArray[np.float32], second: NDArray[np.float32], least: NDArray[np.float32]
) -> None:
    for position in range(least.shape[0]):
        a, b = first[position], second[position]
        least[position] = a if a < b else b


@kernel
def _take_row(
    heights: NDArray[np.float32], row: int, beyond: int, taken: NDArray[np.float32]
) -> None:
    """A row that goes on beyond both ends with its last height; rows outside are the last ones."""
    rows, columns = heights.shape
    source = heights[min(max(row, 0), rows - 1)]
    taken[:beyond] = source[0]
    taken[beyond : beyond + columns] = source
    taken[beyond + columns :] = source[columns - 1]


@kernel
def _least_along_kernel(
    heights: NDArray[np.float32], half: int, east: int, least: NDArray[np.float32]
) -> None:
    """The least height within ``half`` cells along a diagonal, ``east`` 1 or −1 for each north.

    Van Herk 1992 and Gil & Werman 1993: rows are taken in runs as long as the line; a line is
    then the end of one run and the beginning of the next.
    """
    rows, columns = heights.shape
    length = 2 * half + 1
    width = columns + 2 * half
    to_end = np.empty((length, width), np.float32)
    from_start = np.empty((2, width), np.float32)
    taken = np.empty(width, np.float32)
    low, high = max(0, east), width - max(0, -east)
    back_low, back_high = max(0, -east), width - max(0, east)
    near, far = half - half * east, half + half * east
    for first in range(0, rows, length):
        _take_row(heights, first + half, half, to_end[length - 1])
        for position in range(length - 2, -1, -1):
            own, after = to_end[position], to_end[position + 1]
            _take_row(heights, first + position - half, half, own)
            after = after[back_low + east : back_high + east]
            _least_of_two(own[back_low:back_high], after, own[back_low:back_high])
        least[first] = to_end[0, near : near + columns]
        for position in range(1, min(length, rows - first)):
            now, before = from_start[position % 2], from_start[1 - position % 2]
            _take_row(heights, first + position + half, half, taken)
            now[:] = taken
            if position > 1:
                # What lies at the end without a cell before it is asked for by no line.
                before = before[low - east : high - east]
                _least_of_two(taken[low:high], before, now[low:high])
            ending = now[far : far + columns]
            _least_of_two(to_end[position, near : near + columns], ending, least[first + position])


def warm_up() -> None:
    """Compile the kernels of this file."""
    open_heights(np.zeros((4, 4), np.float32), 2 * _FEW_CROSSES)
