"""Kernels of the depth picture: how far apart points lie, and which one is in front."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel

ALONE_M = 0.01
"""The size of a point without neighbours: it hides next to nothing."""


_RIM = 0.6
_STRAIGHT = -0.7


@kernel
def _size_between(
    xyz: NDArray[np.float64],
    is_filled: NDArray[np.bool_],
    here: tuple[int, int],
    step: tuple[int, int],
    limit: float,
) -> float:
    """Distance to the nearer of two opposite neighbours; less where they form no surface."""
    height, width = is_filled.shape
    r, c = here
    nearest, product, found = np.inf, 0.0, 0
    first = np.zeros(3)
    length = 0.0
    for side in (1, -1):
        i, j = r + side * step[0], c + side * step[1]
        if i < 0 or j < 0 or i >= height or j >= width or not is_filled[i, j]:
            continue
        x = xyz[i, j, 0] - xyz[r, c, 0]
        y = xyz[i, j, 1] - xyz[r, c, 1]
        z = xyz[i, j, 2] - xyz[r, c, 2]
        away = np.sqrt(x * x + y * y + z * z)
        if away > limit or away == 0.0:
            continue
        if found:
            product = (x * first[0] + y * first[1] + z * first[2]) / (away * length)
        first[0], first[1], first[2], length = x, y, z, away
        found += 1
        nearest = min(nearest, away)
    if found == 0:
        return 0.0
    # Leaves scatter: neighbours on both sides are rarely in line there, on a surface they are.
    return nearest if found == 2 and product < _STRAIGHT else _RIM * nearest


@kernel
def sizes_kernel(
    xyz: NDArray[np.float64], is_filled: NDArray[np.bool_], limit: float, sizes: NDArray[np.float32]
) -> None:
    """How large a piece of surface each point of a raster stands for.

    ``xyz``: (h, w, 3) m; ``limit``: neighbours farther away are other surfaces, m; ``sizes``:
    (h, w), the larger of the distances to the nearer neighbours in the row and in the column.
    """
    height, width = is_filled.shape
    for r in range(height):
        for c in range(width):
            if is_filled[r, c]:
                along = _size_between(xyz, is_filled, (r, c), (0, 1), limit)
                across = _size_between(xyz, is_filled, (r, c), (1, 0), limit)
                sizes[r, c] = max(along, across, ALONE_M)


@kernel
def front_kernel(
    places: NDArray[np.float64],
    ranges: NDArray[np.float64],
    radii: NDArray[np.float64],
    front: NDArray[np.float32],
    number: NDArray[np.int32],
) -> None:
    """The nearest point in each cell.

    ``places``: (n, 2) column and row in cells, NaN where not seen; ``ranges``: (n,) m;
    ``radii``: (n,) cells that a point covers around its own; ``front``: (h, w), infinite at
    first; ``number``: (h, w), the front point.
    """
    height, width = front.shape
    for k in range(places.shape[0]):
        x, y, radius = places[k, 0], places[k, 1], radii[k]
        if not (x >= -radius and y >= -radius and x < width + radius and y < height + radius):
            continue
        # A cell is covered when its middle is; the point's own cell always.
        left, right = int(np.ceil(x - radius - 0.5)), int(np.floor(x + radius - 0.5))
        top, bottom = int(np.ceil(y - radius - 0.5)), int(np.floor(y + radius - 0.5))
        left, right = min(left, int(np.floor(x))), max(right, int(np.floor(x)))
        top, bottom = min(top, int(np.floor(y))), max(bottom, int(np.floor(y)))
        away = np.float32(ranges[k])
        for r in range(max(0, top), min(height - 1, bottom) + 1):
            for c in range(max(0, left), min(width - 1, right) + 1):
                if away < front[r, c]:
                    front[r, c] = away
                    number[r, c] = k


@kernel
def hidden_kernel(
    cells: NDArray[np.int64],
    ranges: NDArray[np.float64],
    front: NDArray[np.float32],
    tolerance: tuple[float, float],
    hidden: NDArray[np.bool_],
) -> None:
    """Which points lie behind the surface in their cell.

    ``cells``: (n, 2) column and row, −1: outside; ``tolerance``: m, and share of the range.
    The inverse range of a plane is linear in the image, so the far end of a tilted surface
    within its cell is foretold from the cells beside it; the smaller of the differences to both
    sides is taken, so that an edge isn't mistaken for a slope.
    """
    height, width = front.shape
    for k in range(cells.shape[0]):
        c, r = cells[k, 0], cells[k, 1]
        hidden[k] = False
        if c < 0 or r < 0 or front[r, c] == np.inf:
            continue
        here = 1.0 / front[r, c]
        level = np.inf
        if c > 0:
            level = abs(here - 1.0 / front[r, c - 1])
        if c + 1 < width:
            level = min(level, abs(here - 1.0 / front[r, c + 1]))
        steep = np.inf
        if r > 0:
            steep = abs(here - 1.0 / front[r - 1, c])
        if r + 1 < height:
            steep = min(steep, abs(here - 1.0 / front[r + 1, c]))
        far = here
        if level < np.inf:
            far -= level
        if steep < np.inf:
            far -= steep
        if far <= 0.0:
            continue
        hidden[k] = ranges[k] > 1.0 / far + tolerance[0] + tolerance[1] * ranges[k]


def warm_up() -> None:
    """Compile the kernels."""
    sizes_kernel(np.zeros((2, 2, 3)), np.ones((2, 2), np.bool_), 0.3, np.zeros((2, 2), np.float32))
    front = np.full((2, 2), np.inf, np.float32)
    front_kernel(np.zeros((1, 2)), np.ones(1), np.ones(1), front, np.zeros((2, 2), np.int32))
    cells, hidden = np.zeros((1, 2), np.int64), np.zeros(1, np.bool_)
    hidden_kernel(cells, np.ones(1), front, (0.2, 0.01), hidden)
