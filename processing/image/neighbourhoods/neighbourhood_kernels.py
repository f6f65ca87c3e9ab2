"""Loops over the neighbours that the image gives every point, always measured in metres.

A point's neighbours are taken in its own row and in two others, at steps that cover the search
radius: so a neighbourhood is as wide along a row, where points may lie at 6 mm, as across rows.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

STEPS_ASIDE = 4
"""Neighbours in a row to either side; the two other rows have as many, so that 8 to 26 points make
a normal. By trial; no measurement is recorded."""

MOST_ROWS_ASIDE = 8
"""Neighbours are looked for no more rows away than this, which bounds the time where a vehicle
stands."""

_FAR = 1e30
"""m; stands for: there is no neighbour."""

_FEWEST = 4
"""With fewer points there is no plane with anything left over."""

_MISSES = 2
"""Candidates that may be farther than the best in a row before the search ends: distances along a
row rise but for noise."""

_FILLED = 0.8
"""Share of the reach within which the outer rows must lie. By trial; no measurement is recorded."""

_SPACINGS, _MOST_RADII = 1.5, 4
"""Where points are sparse the reach is so many spacings, so that the next ones lie within it, and
at most so many radii."""

_THINNEST = 0.01
"""Second to first eigenvalue below which points lie on a line: a tenth as wide as long."""


class PointRows(NamedTuple):
    """Points in their rows; a point's column is ``clocks[point] − origins[row]``.

    ``xyz`` times ``scale`` is metres: int32 as delivered, or float64 with a scale of 1; ``clocks``
    are int64 pulses, or int32 columns with origins of 0. Points seen from above are not
    ``is_regular``: how far the next one is says nothing of those after it.
    """

    xyz: NDArray[Any]
    scale: Floats
    clocks: NDArray[Any]
    row_starts: Integers
    origins: Integers
    segments: NDArray[np.int32]
    is_regular: bool


class Surfaces(NamedTuple):
    """What is found for each chosen point; each (k, 3) float32.

    ``normals``: unit eigenvector of the smallest eigenvalue, sign arbitrary, zero where there are
    too few neighbours or they lie on a line. ``shapes``: linearity, planarity, scattering.
    ``meshes``: (along the row) × (across rows), which points to the scanner everywhere or away
    from it everywhere.
    """

    normals: NDArray[np.float32]
    shapes: NDArray[np.float32]
    meshes: NDArray[np.float32]


@kernel
def neighbourhood_kernel(
    rows: PointRows, points: Integers, radius: float, surfaces: Surfaces
) -> None:
    """Normal, shape and mesh vector of chosen points; −1 among the points is left as zero."""
    sums = np.empty(9)
    along = np.empty(3)
    across = np.empty(3)
    row = 0
    for i in range(points.size):
        surfaces.normals[i, :] = 0
        surfaces.shapes[i, :] = 0
        surfaces.meshes[i, :] = 0
        if points[i] < 0:
            continue
        row = _row_of(rows.row_starts, points[i], row)
        sums[:] = 0
        along[:] = 0
        across[:] = 0
        used = 1 + _gather(rows, points[i], row, radius, sums, along, across)
        mesh = surfaces.meshes[i]
        mesh[0] = along[1] * across[2] - along[2] * across[1]
        mesh[1] = along[2] * across[0] - along[0] * across[2]
        mesh[2] = along[0] * across[1] - along[1] * across[0]
        if used >= _FEWEST:
            _fit_plane(sums, used, surfaces.normals[i], surfaces.shapes[i])


@kernel
def _gather(
    rows: PointRows,
    point: int,
    row: int,
    radius: float,
    sums: Floats,
    along: Floats,
    across: Floats,
) -> int:
    """Sums over the neighbours of a point; gives their number."""
    if rows.is_regular:
        step = _step_along(rows, point, row)
        gap, shift = _step_across(rows, point, row)
    else:
        step = _usual_step(rows, point, row)
        gap, shift = step, 0
    by_step = _SPACINGS * step if step < _FAR else 0.0
    by_gap = _SPACINGS * gap if gap < _FAR else 0.0
    reach = max(radius, by_step, by_gap)
    reach = min(reach, _MOST_RADII * radius)
    rows_aside, stride, count = _sampling(step, gap, reach)
    used = _add_row(rows, point, point, row, stride, count, reach, sums, along)
    column = rows.clocks[point] - rows.origins[row]
    for side in (-1, 1):
        other = _neighbour_row(rows.segments, row, side * rows_aside)
        if other < 0:
            continue
        near, distance = _nearest_in_row(rows, point, row, other, column + shift * (other - row))
        if near < 0 or distance > reach:
            continue
        used += _add_row(rows, point, near, other, stride, count, reach, sums, along)
        for axis in range(3):
            across[axis] += side * _difference(rows, near, point, axis)
    return used


@kernel
def _sampling(step: float, gap: float, reach: float) -> tuple[int, int, int]:
    """How many rows away, at what stride and how many points on each side neighbours are taken.

    Points at ±k·h, k = 1 … n, have the variance h² n (n + 1) / 3, three rows at a distance of g
    2 g² / 3; were they different, every plane would look a little like a line.
    """
    has_step, has_gap = 0 < step < _FAR, 0 < gap < _FAR
    if not has_step:
        step = reach
    if not has_gap:
        return 1, max(1, int(reach / (STEPS_ASIDE * step))), STEPS_ASIDE
    rows_aside = min(max(1, int(_FILLED * reach / gap), int(step / gap)), MOST_ROWS_ASIDE)
    wanted = rows_aside * gap
    stride = max(1, int(wanted / (step * math.sqrt(STEPS_ASIDE * (STEPS_ASIDE + 1) / 2))))
    ratio = wanted / (stride * step)
    return rows_aside, stride, min(max(1, int(math.sqrt(0.25 + 2 * ratio**2))), STEPS_ASIDE + 2)


@kernel
def _row_of(row_starts: Integers, point: int, hint: int) -> int:
    if row_starts[hint] <= point < row_starts[hint + 1]:
        return hint
    low, high = 0, row_starts.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if row_starts[middle] <= point:
            low = middle
        else:
            high = middle
    return low


@kernel
def _neighbour_row(segments: NDArray[np.int32], row: int, away: int) -> int:
    """The row so far away; nearer ones at a stop or at the image's edge; −1 when there is none."""
    while away != 0:
        other = row + away
        if 0 <= other < segments.size and segments[other] == segments[row]:
            return other
        away += 1 if away < 0 else -1
    return -1


@kernel
def _find_continued_rows(rows: PointRows, row: int) -> tuple[int, int]:
    """A row with those before and after it: the scan line goes on where a row ends."""
    before = _neighbour_row(rows.segments, row, -1)
    behind = _neighbour_row(rows.segments, row, 1)
    start = rows.row_starts[before] if before >= 0 else rows.row_starts[row]
    stop = rows.row_starts[behind + 1] if behind >= 0 else rows.row_starts[row + 1]
    return start, stop


@kernel
def _difference(rows: PointRows, one: int, other: int, axis: int) -> float:
    return float((float(rows.xyz[one, axis]) - rows.xyz[other, axis]) * rows.scale[axis])


@kernel
def _distance(rows: PointRows, one: int, other: int) -> float:
    dx = _difference(rows, one, other, 0)
    dy = _difference(rows, one, other, 1)
    dz = _difference(rows, one, other, 2)
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@kernel
def _step_along(rows: PointRows, point: int, row: int) -> float:
    """Distance to the nearer of the two next pixels in the row."""
    step, clock = _FAR, rows.clocks[point]
    start, stop = _find_continued_rows(rows, row)
    other = point + 1
    while other < stop and rows.clocks[other] == clock:
        other += 1
    if other < stop:
        step = _distance(rows, point, other)
    other = point - 1
    while other >= start and rows.clocks[other] == clock:
        other -= 1
    if other >= start:
        step = min(step, _distance(rows, point, other))
    return step


@kernel
def _usual_step(rows: PointRows, point: int, row: int) -> float:
    """Distance of pixels about a point, from the next few on the side where they are nearer."""
    step = _FAR
    for side in (-1, 1):
        clock, other, last, pixels = rows.clocks[point], point, point, 0
        while pixels < STEPS_ASIDE:
            other += side
            if not rows.row_starts[row] <= other < rows.row_starts[row + 1]:
                break
            if rows.clocks[other] != clock:
                clock, last = rows.clocks[other], other
                pixels += 1
        if pixels:
            step = min(step, _distance(rows, point, last) / pixels)
    return step


@kernel
def _step_across(rows: PointRows, point: int, row: int) -> tuple[float, int]:
    """Distance to the next row, and by how many columns one moves along in going there."""
    column = rows.clocks[point] - rows.origins[row]
    for side in (1, -1):
        other = _neighbour_row(rows.segments, row, side)
        if other >= 0:
            near, gap = _nearest_in_row(rows, point, row, other, column)
            if near >= 0:
                return gap, int(side * (rows.clocks[near] - rows.origins[other] - column))
    return _FAR, 0


@kernel
def _start_of_search(rows: PointRows, guess: int, other: int, clock: int) -> int:
    """The first point of a row whose clock isn't less; the last if none is."""
    start, stop = rows.row_starts[other], rows.row_starts[other + 1]
    position = min(max(guess, start), stop - 1)
    step = 1
    if rows.clocks[position] < clock:
        low = position
        while position < stop and rows.clocks[position] < clock:
            low = position + 1
            position += step
            step *= 2
        high = min(position, stop)
    else:
        high = position
        while position >= start and rows.clocks[position] >= clock:
            high = position
            position -= step
            step *= 2
        low = max(position + 1, start)
    while low < high:
        middle = (low + high) // 2
        if rows.clocks[middle] < clock:
            low = middle + 1
        else:
            high = middle
    return int(min(low, stop - 1))


@kernel
def _nearest_in_row(
    rows: PointRows, point: int, row: int, other: int, column: int
) -> tuple[int, float]:
    """The point of another row nearest in space: downhill from a column, over small bumps."""
    if rows.row_starts[other] == rows.row_starts[other + 1]:
        return -1, _FAR
    start, stop = _find_continued_rows(rows, other)
    # Neighbouring rows miss about the same pulses, so the place in the row is a good guess.
    guess = rows.row_starts[other] + point - rows.row_starts[row]
    best = _start_of_search(rows, guess, other, column + rows.origins[other])
    sx, sy, sz = rows.scale[0], rows.scale[1], rows.scale[2]
    px, py, pz = float(rows.xyz[point, 0]), float(rows.xyz[point, 1]), float(rows.xyz[point, 2])
    best_square = _distance(rows, point, best) ** 2
    for side in (1, -1):
        candidate, misses = best + side, 0
        while misses < _MISSES and start <= candidate < stop:
            dx = (rows.xyz[candidate, 0] - px) * sx
            dy = (rows.xyz[candidate, 1] - py) * sy
            dz = (rows.xyz[candidate, 2] - pz) * sz
            square = dx * dx + dy * dy + dz * dz
            if candidate != point and square < best_square:
                best, best_square, misses = candidate, square, 0
            else:
                misses += 1
            candidate += side
    return best, math.sqrt(best_square)


@kernel
def _add_row(
    rows: PointRows,
    point: int,
    middle: int,
    row: int,
    stride: int,
    count: int,
    reach: float,
    sums: Floats,
    along: Floats,
) -> int:
    """Take in a row's middle, unless it is the point, and points within reach on its both sides."""
    start, stop = _find_continued_rows(rows, row)
    px, py, pz = float(rows.xyz[point, 0]), float(rows.xyz[point, 1]), float(rows.xyz[point, 2])
    sx, sy, sz = rows.scale[0], rows.scale[1], rows.scale[2]
    # Sums in variables, not in the array: the compiler can keep those in registers.
    x, y, z, xx, yy, zz, xy, xz, yz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    ax, ay, az = 0.0, 0.0, 0.0
    clock, limit, used = rows.clocks[middle], reach * reach, 0
    mx = (float(rows.xyz[middle, 0]) - px) * sx
    my = (float(rows.xyz[middle, 1]) - py) * sy
    mz = (float(rows.xyz[middle, 2]) - pz) * sz
    for k in range(-count, count + 1):
        other = middle + k * stride
        if other < start or other >= stop or (k != 0 and rows.clocks[other] == clock):
            continue
        dx = (float(rows.xyz[other, 0]) - px) * sx
        dy = (float(rows.xyz[other, 1]) - py) * sy
        dz = (float(rows.xyz[other, 2]) - pz) * sz
        if other == point or dx * dx + dy * dy + dz * dz > limit:
            continue
        used += 1
        x, y, z = x + dx, y + dy, z + dz
        xx, yy, zz = xx + dx * dx, yy + dy * dy, zz + dz * dz
        xy, xz, yz = xy + dx * dy, xz + dx * dz, yz + dy * dz
        side = 1.0 if k > 0 else -1.0
        if k != 0:
            ax, ay, az = ax + side * (dx - mx), ay + side * (dy - my), az + side * (dz - mz)
    sums[0] += x
    sums[1] += y
    sums[2] += z
    sums[3] += xx
    sums[4] += yy
    sums[5] += zz
    sums[6] += xy
    sums[7] += xz
    sums[8] += yz
    along[0] += ax
    along[1] += ay
    along[2] += az
    return used


@kernel
def _fit_plane(
    sums: Floats, count: int, normal: NDArray[np.float32], shape: NDArray[np.float32]
) -> None:
    """Eigenvalues of the covariance by the cosine formula, the normal by cross products."""
    mx, my, mz = sums[0] / count, sums[1] / count, sums[2] / count
    xx, yy, zz = sums[3] / count - mx * mx, sums[4] / count - my * my, sums[5] / count - mz * mz
    xy, xz, yz = sums[6] / count - mx * my, sums[7] / count - mx * mz, sums[8] / count - my * mz
    mean = (xx + yy + zz) / 3
    ax, ay, az = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((ax * ax + ay * ay + az * az + 2 * (xy * xy + xz * xz + yz * yz)) / 6)
    if mean <= 0 or spread <= 0:
        return
    determinant = ax * (ay * az - yz * yz) - xy * (xy * az - yz * xz) + xz * (xy * yz - ay * xz)
    angle = math.acos(min(1.0, max(-1.0, determinant / (2 * spread**3)))) / 3
    largest = mean + 2 * spread * math.cos(angle)
    smallest = max(0.0, mean + 2 * spread * math.cos(angle + 2 * math.pi / 3))
    middle = max(smallest, 3 * mean - largest - smallest)
    shape[0] = (largest - middle) / largest
    shape[1] = (middle - smallest) / largest
    shape[2] = smallest / largest
    if middle < _THINNEST * largest:
        return
    # The rows of (covariance − smallest) span the plane; the longest cross product is safest.
    ax, ay, az = xx - smallest, yy - smallest, zz - smallest
    longest = 0.0
    for k in range(3):
        if k == 0:
            nx, ny, nz = xy * yz - xz * ay, xz * xy - ax * yz, ax * ay - xy * xy
        elif k == 1:
            nx, ny, nz = xy * az - xz * yz, xz * xz - ax * az, ax * yz - xy * xz
        else:
            nx, ny, nz = ay * az - yz * yz, yz * xz - xy * az, xy * yz - ay * xz
        length = nx * nx + ny * ny + nz * nz
        if length > longest:
            longest = length
            root = math.sqrt(length)
            normal[0], normal[1], normal[2] = nx / root, ny / root, nz / root
