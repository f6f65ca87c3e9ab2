"""The points of a row that may be on or beside the road, from the vehicle outwards on each side.

Roads are smoother than what is beside them: followed outwards, a line begins on the road and ends
at walls, and a hole close before a wall lies between enough points.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_OVERLAP = 12  # points on the other side with which a side begins


@kernel
def row_side_kernel(near: Integers, row: tuple[int, int], side: int, outwards: Integers) -> int:
    """Points of one side of a row, from the vehicle outwards; how many.

    Roads are smoother than what is beside them, so that lines begin on the road and end at walls.
    """
    size, middle = row
    if side == 0:
        first = max(middle - _OVERLAP, 0)
        for one in range(first, size):
            outwards[one - first] = near[one]
        return size - first
    last = min(middle + _OVERLAP, size) - 1
    for one in range(last + 1):
        outwards[one] = near[last - one]
    return last + 1


@kernel
def row_points_kernel(
    xyz: Floats,
    points: tuple[int, int],
    place: Floats,
    right: Floats,
    limits: tuple[float, float, float, float, float, float, float],
    near: Integers,
) -> tuple[int, int]:
    """Points of a row that may be on the road or beside it; how many, and the nearest of them."""
    size, middle, least = 0, 0, np.inf
    for point in range(points[0], points[1]):
        east, north = xyz[point, 0] - place[0], xyz[point, 1] - place[1]
        across = east * right[0] + north * right[1]
        if (
            abs(across) <= limits[0]
            and abs(north * right[0] - east * right[1]) <= 2.0 * limits[0]
            and abs(xyz[point, 2] - place[2]) <= limits[1]
        ):
            near[size] = point
            if abs(across) < least:
                least, middle = abs(across), size
            size += 1
    return size, middle


@kernel
def row_along_kernel(xyz: Floats, near: Integers, size: int, along: Floats) -> None:
    """Where points are along their row: in plan from its first to its last point."""
    first, last = near[0], near[size - 1]
    east, north = xyz[last, 0] - xyz[first, 0], xyz[last, 1] - xyz[first, 1]
    length = max(np.sqrt(east * east + north * north), 1e-9)
    east, north = east / length, north / length
    for one in range(size):
        point = near[one]
        along[one] = (xyz[point, 0] - xyz[first, 0]) * east + (
            xyz[point, 1] - xyz[first, 1]
        ) * north


def warm_up() -> None:
    """Compile the kernels of this file."""
    near, along = np.empty(4, np.int64), np.empty(4)
    limits = (6.5, 1.5, 0.003, 0.02, 0.01, 0.1, 4.0)
    xyz, place, right = np.zeros((4, 3)), np.zeros(3), np.array([1.0, 0.0])
    size, middle = row_points_kernel(xyz, (0, 4), place, right, limits, near)
    outwards = np.empty(4, np.int64)
    row_along_kernel(xyz, outwards, row_side_kernel(near, (size, middle), 0, outwards), along)
