"""Kernels of the depth picture: how far apart points lie, and which one is in front."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

ALONE_M = 0.01
"""The size of a point without neighbours: it hides next to nothing."""

MOST_CELLS = 8.0
"""So far from its own cell a point covers others at most."""

_RIM = 0.6
"""Of the distance to a neighbour: how large a point at a surface's rim, or among leaves, is. By
trial; no measurement is recorded."""

_STRAIGHT = -0.7
"""Cosine between the directions to two opposite neighbours on a surface: they are in line within
45°."""

_LEAST_SINE = 0.3
"""Of the angle between row and column from which both span a plane: 17°."""

_LIMIT = 3
"""Index of the farthest distance of neighbours in what `_size_between` is given."""


class PictureCell(NamedTuple):
    """A cell of a picture or a raster of points."""

    row: int
    column: int


class CellStep(NamedTuple):
    """How many rows and columns from one cell to the next."""

    rows: int
    columns: int


class HidingTolerance(NamedTuple):
    """How far behind a surface a point still is seen: m, and a share of its range."""

    distance_m: float
    share: float


class Discs(NamedTuple):
    """Points: (n, 3) from the perspective centre, m; (n, 3) normals; (n,) radii of discs, m."""

    away: NDArray[np.float64]
    normals: NDArray[np.float64]
    radii: NDArray[np.float64]


@kernel
def _size_between(
    xyz: NDArray[np.float64],
    is_filled: NDArray[np.bool_],
    here: PictureCell,
    step: CellStep,
    offset: NDArray[np.float64],
) -> float:
    """Distance to the nearer of two opposite neighbours; less where they form no surface.

    ``offset``: (4,) given with the farthest distance of neighbours in its last place; gets the
    offset to one of them.
    """
    height, width = is_filled.shape
    r, c = here
    nearest, product, found = np.inf, 0.0, 0
    length = 0.0
    for side in (1, -1):
        i, j = r + side * step.rows, c + side * step.columns
        if i < 0 or j < 0 or i >= height or j >= width or not is_filled[i, j]:
            continue
        x = xyz[i, j, 0] - xyz[r, c, 0]
        y = xyz[i, j, 1] - xyz[r, c, 1]
        z = xyz[i, j, 2] - xyz[r, c, 2]
        away = np.sqrt(x * x + y * y + z * z)
        if away > offset[_LIMIT] or away == 0.0:
            continue
        if found:
            product = (x * offset[0] + y * offset[1] + z * offset[2]) / (away * length)
        offset[0], offset[1], offset[2], length = x, y, z, away
        found += 1
        nearest = min(nearest, away)
    if found == 0:
        return 0.0
    # Leaves scatter: neighbours on both sides are rarely in line there, on a surface they are.
    return nearest if found == 2 and product < _STRAIGHT else _RIM * nearest


@kernel
def sizes_kernel(
    xyz: NDArray[np.float64],
    is_filled: NDArray[np.bool_],
    limit: float,
    sizes: NDArray[np.float32],
    normals: NDArray[np.float32],
) -> None:
    """How large a piece of surface each point of a raster stands for, and which way it faces.

    ``xyz``: (h, w, 3) m; ``limit``: neighbours farther away are other surfaces, m; ``sizes``:
    (h, w), the larger of the distances to the nearer neighbours in the row and in the column;
    ``normals``: (h, w, 3), either way round, zero at first and where none is known.
    """
    height, width = is_filled.shape
    a, b = np.zeros(4), np.zeros(4)
    a[_LIMIT], b[_LIMIT] = limit, limit
    for r in range(height):
        for c in range(width):
            if not is_filled[r, c]:
                continue
            here = PictureCell(r, c)
            along = _size_between(xyz, is_filled, here, CellStep(0, 1), a)
            across = _size_between(xyz, is_filled, here, CellStep(1, 0), b)
            sizes[r, c] = max(along, across, ALONE_M)
            if along == 0.0 or across == 0.0:
                continue
            x = a[1] * b[2] - a[2] * b[1]
            y = a[2] * b[0] - a[0] * b[2]
            z = a[0] * b[1] - a[1] * b[0]
            area = np.sqrt(x * x + y * y + z * z)
            long = np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
            wide = np.sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
            if area > _LEAST_SINE * long * wide:
                normals[r, c, 0] = x / area
                normals[r, c, 1] = y / area
                normals[r, c, 2] = z / area


@kernel
def front_kernel(
    positions: NDArray[np.float64],
    points: Discs,
    scale: float,
    rays: NDArray[np.float64],
    front: NDArray[np.float32],
    number: NDArray[np.int32],
) -> None:
    """The nearest piece of surface in each cell.

    ``positions``: (n, 2) column and row in cells, NaN where not seen; ``scale``: cells a
    radian; ``rays``: (h, w, 3) directions of the cells' middles; ``front``: (h, w), infinite at
    first; ``number``: (h, w), the front point.
    """
    height, width = front.shape
    away, normals, radii = points
    for k in range(positions.shape[0]):
        x, y = positions[k, 0], positions[k, 1]
        square = away[k, 0] ** 2 + away[k, 1] ** 2 + away[k, 2] ** 2
        distance = np.sqrt(square)
        radius = min(radii[k] * scale / distance, MOST_CELLS)
        if not (x >= -radius and y >= -radius and x < width + radius and y < height + radius):
            continue
        facing = (
            away[k, 0] * normals[k, 0] + away[k, 1] * normals[k, 1] + away[k, 2] * normals[k, 2]
        )
        own_c, own_r = int(np.floor(x)), int(np.floor(y))
        left, right = int(np.floor(x - radius)), int(np.floor(x + radius))
        top, bottom = int(np.floor(y - radius)), int(np.floor(y + radius))
        for r in range(max(0, top), min(height - 1, bottom) + 1):
            for c in range(max(0, left), min(width - 1, right) + 1):
                is_own = r == own_r and c == own_c
                inside = abs(c + 0.5 - x) <= radius and abs(r + 0.5 - y) <= radius
                met = distance
                u, v, w = rays[r, c, 0], rays[r, c, 1], rays[r, c, 2]
                slope = u * normals[k, 0] + v * normals[k, 1] + w * normals[k, 2]
                if facing != 0.0 and slope != 0.0:
                    # Where the cell's middle meets the disc.
                    met = facing / slope
                    beside = met * (u * away[k, 0] + v * away[k, 1] + w * away[k, 2])
                    inside = met > 0 and met * met - 2 * beside + square <= radii[k] ** 2
                    # Beyond its disc a plane through so few points says nothing.
                    if not inside:
                        met = distance
                if (inside or is_own) and np.float32(met) < front[r, c]:
                    front[r, c] = met
                    number[r, c] = k


@kernel
def _slope(front: NDArray[np.float32], cell: PictureCell, step: CellStep) -> float:
    """How much the inverse range of a surface changes from a cell to the next in a direction.

    A surface goes on to both sides, nearer on one and farther on the other; of both changes the
    smaller one is taken. What is nearer than both sides is a thin thing, and has no slope.
    """
    height, width = front.shape
    r, c = cell
    here = 1.0 / front[r, c]
    largest = 0.0
    # Over two cells as well: a sparse surface has the same point in neighbouring ones.
    for far in (1, 2):
        i, j = r - far * step.rows, c - far * step.columns
        k, m = r + far * step.rows, c + far * step.columns
        if i < 0 or j < 0 or k >= height or m >= width:
            continue
        before, after = here - 1.0 / front[i, j], 1.0 / front[k, m] - here
        if before * after > 0.0:
            largest = max(largest, min(abs(before), abs(after)) / far)
    return largest


@kernel
def hidden_kernel(
    cells: NDArray[np.int64],
    ranges: NDArray[np.float64],
    front: NDArray[np.float32],
    tolerance: HidingTolerance,
    hidden: NDArray[np.bool_],
) -> None:
    """Which points lie behind the surface in their cell.

    ``cells``: (n, 2) column and row, −1: outside.
    The inverse range of a plane is linear in the image, so the far end of a tilted surface
    within its cell is extrapolated from the cells beside it.
    """
    for k in range(cells.shape[0]):
        c, r = cells[k, 0], cells[k, 1]
        hidden[k] = False
        if c < 0 or r < 0 or front[r, c] == np.inf:
            continue
        cell = PictureCell(r, c)
        across, down = _slope(front, cell, CellStep(0, 1)), _slope(front, cell, CellStep(1, 0))
        far = 1.0 / front[r, c] - across - down
        if far > 0.0:
            hidden[k] = ranges[k] > 1.0 / far + tolerance.distance_m + tolerance.share * ranges[k]


def warm_up() -> None:
    """Compile the kernels."""
    sizes, normals = np.zeros((2, 2), np.float32), np.zeros((2, 2, 3), np.float32)
    sizes_kernel(np.zeros((2, 2, 3)), np.ones((2, 2), np.bool_), 0.3, sizes, normals)
    front, number = np.full((2, 2), np.inf, np.float32), np.zeros((2, 2), np.int32)
    points = Discs(np.ones((1, 3)), np.ones((1, 3)), np.ones(1))
    front_kernel(np.zeros((1, 2)), points, 1.0, np.ones((2, 2, 3)), front, number)
    cells, hidden = np.zeros((1, 2), np.int64), np.zeros(1, np.bool_)
    hidden_kernel(cells, np.ones(1), front, HidingTolerance(0.2, 0.01), hidden)
