"""What two triangles share, seen from above: loops over pairs that lie in the same buckets.

All triangles are counterclockwise, near the origin, and have an area. Buckets are
those of :class:`processing.methods.earthwork.geometry.plan_buckets.PlanBuckets`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

_CORNERS = 12
"""Room for a figure while it is cut: a triangle cut by a triangle has six corners at most, and each
cut may add one twice by rounding."""

_MEETS_M = 1e-3
"""Triangles that lie over each other by less only meet badly: files have whole millimetres."""

_NO_AREA_M2 = 1e-14
"""Less is what rounding leaves of triangles that touch: a strip of a metre and 10⁻¹⁴ m."""


@kernel
def _clip_to(triangle: Floats, count: int, work: Floats) -> int:
    """Cut ``work[0]`` off beyond a triangle (Sutherland and Hodgman 1974): ``work[1]``."""
    for side in range(3):
        start, end = triangle[side], triangle[(side + 1) % 3]
        x, y = start[0], start[1]
        dx, dy = end[0] - x, end[1] - y
        figure, cut = work[side % 2], work[(side + 1) % 2]
        left = 0
        a = dx * (figure[0, 1] - y) - dy * (figure[0, 0] - x)
        for corner in range(count):
            other = corner + 1 if corner + 1 < count else 0
            b = dx * (figure[other, 1] - y) - dy * (figure[other, 0] - x)
            if a >= 0.0:
                cut[left, 0], cut[left, 1] = figure[corner, 0], figure[corner, 1]
                left += 1
            if (a >= 0.0) != (b >= 0.0):
                share = a / (a - b)
                cut[left, 0] = figure[corner, 0] + share * (figure[other, 0] - figure[corner, 0])
                cut[left, 1] = figure[corner, 1] + share * (figure[other, 1] - figure[corner, 1])
                left += 1
            a = b
        count = left
        if count < 3:
            return 0
    return count


@kernel
def _fan_area(figure: Floats, corner: int) -> float:
    """Area of the triangle of a figure's first corner, another one and the one after it."""
    ux, uy = figure[corner, 0] - figure[0, 0], figure[corner, 1] - figure[0, 1]
    vx, vy = figure[corner + 1, 0] - figure[0, 0], figure[corner + 1, 1] - figure[0, 1]
    return float(0.5 * (ux * vy - uy * vx))


@kernel
def _gradient(triangle: Floats) -> tuple[float, float]:
    """Rise of a triangle's plane to the east and to the north."""
    x0, y0, z0 = triangle[0, 0], triangle[0, 1], triangle[0, 2]
    ux, uy, uz = triangle[1, 0] - x0, triangle[1, 1] - y0, triangle[1, 2] - z0
    vx, vy, vz = triangle[2, 0] - x0, triangle[2, 1] - y0, triangle[2, 2] - z0
    area = ux * vy - uy * vx
    return (uz * vy - vz * uy) / area, (ux * vz - vx * uz) / area


@kernel
def _height(triangle: Floats, gradient: tuple[float, float], x: float, y: float) -> float:
    """Height of a triangle at a place in it, never beyond its corners, however steep a sliver."""
    z0, z1, z2 = triangle[0, 2], triangle[1, 2], triangle[2, 2]
    height = z0 + gradient[0] * (x - triangle[0, 0]) + gradient[1] * (y - triangle[0, 1])
    return float(min(max(height, min(z0, z1, z2)), max(z0, z1, z2)))


@kernel
def _add_prism(area: float, a: float, b: float, c: float, sums: Floats) -> None:
    """Add cut, fill and area of a triangle with these differences at its corners."""
    whole = area * (a + b + c) / 3.0
    sums[2] += area
    if a >= 0.0 and b >= 0.0 and c >= 0.0:
        sums[1] += whole
        return
    if a <= 0.0 and b <= 0.0 and c <= 0.0:
        sums[0] -= whole
        return
    # One corner lies alone on its side of zero: a pyramid stands on what the zero line cuts off.
    if (b > 0.0) == (c > 0.0):
        alone, one, other = a, b, c
    elif (a > 0.0) == (c > 0.0):
        alone, one, other = b, a, c
    else:
        alone, one, other = c, a, b
    pyramid = area * alone / 3.0 * (alone / (alone - one)) * (alone / (alone - other))
    if alone > 0.0:
        sums[1] += pyramid
        sums[0] += pyramid - whole
    else:
        sums[0] -= pyramid
        sums[1] += whole - pyramid


@kernel
def _add_pair(one: Floats, other: Floats, work: Floats, sums: Floats) -> None:
    """Add what two triangles share; ``one`` is the ground before."""
    work[0, :3] = one[:, :2]
    count = _clip_to(other, 3, work)
    if count == 0:
        return
    figure, differences = work[1], work[2, :, 0]
    of_one, of_other = _gradient(one), _gradient(other)
    for corner in range(count):
        x, y = figure[corner, 0], figure[corner, 1]
        differences[corner] = _height(other, of_other, x, y) - _height(one, of_one, x, y)
    for corner in range(1, count - 1):
        area = _fan_area(figure, corner)
        _add_prism(area, differences[0], differences[corner], differences[corner + 1], sums)


@kernel
def overlay_kernel(
    triangles: Floats,
    others: Floats,
    frame: tuple[float, float, float, int, int],
    held: tuple[Numbers, Numbers],
    sums: Floats,
) -> None:
    """Cut, fill and area that triangles share with the others, which lie in buckets."""
    west, south, size, rows, columns = frame
    starts, numbers = held
    work = np.empty((3, _CORNERS, 2))
    # Two triangles meet in several buckets and are counted once.
    counted = np.full(others.shape[0], -1, np.int64)
    for triangle in range(triangles.shape[0]):
        one = triangles[triangle]
        x_low, x_high = min(one[0, 0], one[1, 0], one[2, 0]), max(one[0, 0], one[1, 0], one[2, 0])
        y_low, y_high = min(one[0, 1], one[1, 1], one[2, 1]), max(one[0, 1], one[1, 1], one[2, 1])
        first = max(int(np.floor((x_low - west) / size)), 0)
        last = min(int(np.floor((x_high - west) / size)), columns - 1)
        bottom = max(int(np.floor((y_low - south) / size)), 0)
        top = min(int(np.floor((y_high - south) / size)), rows - 1)
        for row in range(bottom, top + 1):
            for bucket in range(row * columns + first, row * columns + last + 1):
                for entry in range(starts[bucket], starts[bucket + 1]):
                    number = numbers[entry]
                    if counted[number] != triangle:
                        counted[number] = triangle
                        _add_pair(one, others[number], work, sums)


@kernel
def level_kernel(triangles: Floats, level: float, sums: Floats) -> None:
    """Cut, fill and area from triangles to a level."""
    for triangle in range(triangles.shape[0]):
        one = triangles[triangle]
        _add_prism(_fan_area(one, 1), level - one[0, 2], level - one[1, 2], level - one[2, 2], sums)


@kernel
def _is_apart(one: Floats, other: Floats) -> bool:
    """Whether a side of ``one`` has all of the other triangle beyond it, but for rounding."""
    for side in range(3):
        start, end = one[side], one[(side + 1) % 3]
        dx, dy = end[0] - start[0], end[1] - start[1]
        reach = _MEETS_M * np.hypot(dx, dy)
        is_beyond = True
        for corner in range(3):
            turn = dx * (other[corner, 1] - start[1]) - dy * (other[corner, 0] - start[0])
            if turn > reach:
                is_beyond = False
                break
        if is_beyond:
            return True
    return False


@kernel
def overlap_kernel(
    triangles: Floats,
    buckets: tuple[Numbers, Numbers],
    of_triangles: tuple[Numbers, Numbers],
    found: Floats,
) -> None:
    """Area covered twice, and of the pair that shares most its area and a position in it."""
    starts, held = buckets
    firsts, bucket_of = of_triangles
    work = np.empty((2, _CORNERS, 2))
    # Two triangles meet in several buckets and are looked at once.
    looked_at = np.full(triangles.shape[0], -1, np.int64)
    for one in range(triangles.shape[0]):
        for bucket in bucket_of[firsts[one] : firsts[one + 1]]:
            for other in held[starts[bucket] : starts[bucket + 1]]:
                if other >= one:
                    break
                if looked_at[other] == one:
                    continue
                looked_at[other] = one
                a, b = triangles[one], triangles[other]
                if _is_apart(a, b) or _is_apart(b, a):
                    continue
                work[0, :3] = b[:, :2]
                area = 0.0
                for corner in range(1, _clip_to(a, 3, work) - 1):
                    area += _fan_area(work[1], corner)
                found[0] += area
                if area > found[1]:
                    found[1] = area
                    found[2:] = work[1, 0]


@kernel
def pieces_kernel(
    triangles: Floats,
    others: Floats,
    of_triangles: tuple[Numbers, Numbers],
    pieces: Floats,
) -> int:
    """Cut triangles into what each shares with its others, as triangles on its own plane.

    ``of_triangles``: where the others of each triangle begin, and their numbers. Gives how many
    pieces there are; those beyond the end of ``pieces`` are only counted.
    """
    firsts, numbers = of_triangles
    work = np.empty((3, _CORNERS, 2))
    made = 0
    for triangle in range(triangles.shape[0]):
        one = triangles[triangle]
        gradient = _gradient(one)
        for number in numbers[firsts[triangle] : firsts[triangle + 1]]:
            work[0, :3] = one[:, :2]
            count = _clip_to(others[number], 3, work)
            for corner in range(1, count - 1):
                if _fan_area(work[1], corner) <= _NO_AREA_M2:
                    continue
                if made < pieces.shape[0]:
                    for position, of_figure in enumerate((0, corner, corner + 1)):
                        x, y = work[1, of_figure, 0], work[1, of_figure, 1]
                        pieces[made, position, 0], pieces[made, position, 1] = x, y
                        pieces[made, position, 2] = _height(one, gradient, x, y)
                made += 1
    return made
