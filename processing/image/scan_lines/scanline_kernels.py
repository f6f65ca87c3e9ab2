"""The mesh between neighbouring rows and where the sections cross it: the loops over pixels."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Integers
from processing.core.kernels import kernel
from processing.image.scan_lines.scanline_arrays import (
    CellBases,
    CellLevels,
    CellSides,
    Crossings,
    MeshCell,
    MeshEdge,
    MeshLimits,
    MeshRows,
    MeshRule,
    Pixels,
    PointArrays,
    RowPair,
    TriangleBases,
    TriangleLevels,
)

_BEGIN, _END, _FIRST_POINT, _FIRST_PULSE, _IS_BREAK = range(5)
"""Columns of the ends of a row: its points, the number of the first point, the pulse of the first
column, and whether the mesh breaks before it."""

_NEXT_ROW, _OLD, _CROSSINGS, _IS_FILLED = range(4)
"""Of the state: next row, which of the pixels' rows holds the last one, number of crossings,
whether the next row is filled already."""

_ADVANCES = 1.5
"""Where rows are farther apart than two thirds of the longest edge, edges may be one and a half
advances long: a triangle's diagonal over a row and a half of pulses."""

_EDGES = 4.0
"""Sections crossed by a strip between two pixels: four edges of two triangles, each at most as long
as the longest."""


@kernel
def fill_row(
    pixels: Pixels,
    extent: Integers,
    points: PointArrays,
    ends: Integers,
    row_station: float,
    band: MeshLimits,
) -> None:
    """Put the points of a row into its pixels (w,), the last return of each pulse.

    ``extent`` (2,) is the first filled column and the one behind the last; ``ends`` (5,) a row of
    `MeshRows.ends`; ``row_station`` is the vehicle's, m.
    """
    pulse, position, found, time, intensity, is_noise = points
    for column in range(extent[0], extent[1]):
        pixel = pixels[column]
        pixel.point, pixel.crossing, pixel.is_short = -1, -1, False
    low, high = pixels.shape[0], 0
    for i in range(ends[_BEGIN], ends[_END]):
        station, across, above = found[i, 0], found[i, 1], found[i, 2]
        # Comparisons with NaN are false.
        if not (abs(station - row_station) <= band.reach_m and abs(across) <= band.half_width_m):
            continue
        if not (band.lowest_m <= above <= band.highest_m) or is_noise[i]:
            continue
        column = pulse[i] - ends[_FIRST_PULSE]
        if not 0 <= column < pixels.shape[0]:
            continue
        pixel = pixels[column]
        pixel.point = i + ends[_FIRST_POINT]
        pixel.east, pixel.north, pixel.up = position[i, 0], position[i, 1], position[i, 2]
        pixel.station, pixel.across = station, across
        pixel.time, pixel.intensity = time[i], intensity[i]
        level = np.floor(station / band.spacing_m)
        pixel.level = int(min(max(level, band.first - 1), band.last))
        low, high = min(low, column), max(high, column + 1)
    extent[0], extent[1] = low, high


@kernel
def _square_between(pixels: Pixels, a: int, i: int, b: int, j: int) -> float:
    one, other = pixels[a, i], pixels[b, j]
    east, north, up = one.east - other.east, one.north - other.north, one.up - other.up
    return float(east * east + north * north + up * up)


@kernel
def _join_row(pixels: Pixels, extents: Integers, which: int, longest: float) -> None:
    """Tell which edges along a row are short."""
    for c in range(extents[which, 0], extents[which, 1] - 1):
        if pixels[which, c].point >= 0 and pixels[which, c + 1].point >= 0:
            square = _square_between(pixels, which, c, which, c + 1)
            pixels[which, c].is_short = square <= longest


@kernel
def strip_bound(pixels: Pixels, extents: Integers, old: int) -> int:
    """At most so many crossings come from the strip between the old row and the new one."""
    new = 1 - old
    low, high = min(extents[0, 0], extents[1, 0]), max(extents[0, 1], extents[1, 1])
    bound = 0
    for column in range(low, high):
        here, there = pixels[old, column].point >= 0, pixels[new, column].point >= 0
        of_old, of_new = pixels[old, column].level, pixels[new, column].level
        if here and there:
            bound += abs(of_old - of_new)
        if column + 1 == high:
            continue
        here_next = pixels[old, column + 1].point >= 0
        there_next = pixels[new, column + 1].point >= 0
        old_next, new_next = pixels[old, column + 1].level, pixels[new, column + 1].level
        if here and here_next and pixels[old, column].crossing < 0:
            bound += abs(of_old - old_next)
        if there and there_next:
            bound += abs(of_new - new_next)
        most = 0
        if here and there_next:
            most = abs(of_old - new_next)
        if there and here_next:
            most = max(most, abs(of_new - old_next))
        bound += most
    return bound


@kernel
def _cross_edge(
    pixels: Pixels,
    edge: MeshEdge,
    spacing: float,
    crossings: Crossings,
    count: int,
) -> int:
    """Add the crossings of an edge; gives how many there are then."""
    a, i, b, j = edge
    one, other = pixels[a, i], pixels[b, j]
    from_level, to_level = one.level, other.level
    if from_level == to_level:
        return count
    start, length = one.station, other.station - one.station
    rise = other.up - one.up
    for level in range(min(from_level, to_level) + 1, max(from_level, to_level) + 1):
        share = min(max((level * spacing - start) / length, 0.0), 1.0)
        given = crossings[count]
        given.level = level
        given.across = one.across + share * (other.across - one.across)
        given.height = one.up + share * rise
        given.time = one.time + share * (other.time - one.time)
        given.intensity = one.intensity + share * (other.intensity - one.intensity)
        given.point = one.point if share < 0.5 else other.point
        given.first, given.second = -1, -1
        count += 1
    return count


@kernel
def _link(crossings: Crossings, a: int, b: int) -> None:
    if crossings[a].first < 0:
        crossings[a].first = b
    else:
        crossings[a].second = b
    if crossings[b].first < 0:
        crossings[b].first = a
    else:
        crossings[b].second = a


@kernel
def _vertex(one: int, other: int, base: int, level: int) -> int:
    """The crossing of a section on an edge by the levels of its ends; −1 where there is none."""
    low = min(one, other)
    return base + level - low - 1 if low < level <= max(one, other) else -1


@kernel
def _link_cell(levels: CellLevels, bases: CellBases, cut: int, crossings: Crossings) -> None:
    """Join the crossings of a cell with two triangles, across its diagonal.

    ``cut`` is 1 where it is cut rising, −1 falling.
    """
    oc, od, nc, nd = levels
    for level in range(min(min(oc, od), min(nc, nd)) + 1, max(max(oc, od), max(nc, nd)) + 1):
        a = _vertex(oc, od, bases.old, level)
        b = _vertex(nc, nd, bases.new, level)
        c = _vertex(oc, nc, bases.left, level)
        d = _vertex(od, nd, bases.right, level)
        # In the lower triangle with the old edge lies one side, in the upper one the other.
        lower, upper = (d, c) if cut > 0 else (c, d)
        if a >= 0 and lower >= 0:
            _link(crossings, a, lower)
            a, lower = -1, -1
        if b >= 0 and upper >= 0:
            _link(crossings, b, upper)
            b, upper = -1, -1
        if max(a, lower) >= 0 and max(b, upper) >= 0:
            _link(crossings, max(a, lower), max(b, upper))


@kernel
def _link_triangle(levels: TriangleLevels, bases: TriangleBases, crossings: Crossings) -> None:
    """Join the crossings on a triangle's edges 0–1, 1–2 and 2–0, section by section."""
    a, b, c = levels
    for level in range(min(a, b, c) + 1, max(a, b, c) + 1):
        first = _vertex(a, b, bases.first_second, level)
        second = _vertex(b, c, bases.second_third, level)
        third = _vertex(c, a, bases.third_first, level)
        if first < 0:
            first = third
        elif second < 0:
            second = third
        _link(crossings, first, second)


@kernel
def _spans(pixels: Pixels, a: int, c: int, third: int, most: int) -> bool:
    """Whether a triangle on the edge (a, c)–(a, c + 1) crosses few sections.

    Where stations jump, sections cross about the centre of a bend.
    """
    one, two, three = pixels[a, c].level, pixels[a, c + 1].level, pixels[1 - a, third].level
    return bool(max(one, two, three) - min(one, two, three) <= most)


@kernel
def _triangles(
    pixels: Pixels, old: int, c: int, sides: CellSides, rule: MeshRule
) -> tuple[bool, bool, bool]:
    """How a cell is cut, and whether the triangles with its old and its new edge are there.

    It is cut along the shorter diagonal, rising from its old left pixel to its new right one, or
    falling.
    """
    new, d = 1 - old, c + 1
    rising, falling = np.inf, np.inf
    if pixels[old, c].point >= 0 and pixels[new, d].point >= 0:
        rising = _square_between(pixels, old, c, new, d)
    if pixels[old, d].point >= 0 and pixels[new, c].point >= 0:
        falling = _square_between(pixels, old, d, new, c)
    if min(rising, falling) > rule.longest_square:
        return False, False, False
    is_rising = rising <= falling
    lower = sides.right if is_rising else sides.left
    upper = sides.left if is_rising else sides.right
    lower = lower and pixels[old, c].is_short
    upper = upper and pixels[new, c].is_short
    lower = lower and _spans(pixels, old, c, d if is_rising else c, rule.most_levels)
    upper = upper and _spans(pixels, new, c, c if is_rising else d, rule.most_levels)
    return is_rising, lower, upper


@kernel
def _mesh_cell(
    pixels: Pixels,
    cell: MeshCell,
    left: int,
    spacing: float,
    crossings: Crossings,
    count: int,
) -> tuple[int, int]:
    """Cross one cell; gives how many crossings there are then, and the first on its right edge.

    ``left`` is the first crossing on its left edge, or −1.
    """
    old, c, is_rising, has_lower, has_upper = cell
    new, d, right, cut = 1 - old, c + 1, -1, -1
    if left < 0 and (has_upper if is_rising else has_lower):
        left, count = (
            count,
            _cross_edge(pixels, MeshEdge(old, c, new, c), spacing, crossings, count),
        )
    if has_lower if is_rising else has_upper:
        right, count = (
            count,
            _cross_edge(pixels, MeshEdge(old, d, new, d), spacing, crossings, count),
        )
    if has_lower and pixels[old, c].crossing < 0:
        pixels[old, c].crossing = count
        count = _cross_edge(pixels, MeshEdge(old, c, old, d), spacing, crossings, count)
    if has_upper:
        pixels[new, c].crossing = count
        count = _cross_edge(pixels, MeshEdge(new, c, new, d), spacing, crossings, count)
    bases = CellBases(pixels[old, c].crossing, pixels[new, c].crossing, left, right)
    oc, od = pixels[old, c].level, pixels[old, d].level
    nc, nd = pixels[new, c].level, pixels[new, d].level
    if has_lower and has_upper:
        _link_cell(CellLevels(oc, od, nc, nd), bases, 1 if is_rising else -1, crossings)
        return count, right
    diagonal = MeshEdge(old, c, new, d) if is_rising else MeshEdge(old, d, new, c)
    cut, count = count, _cross_edge(pixels, diagonal, spacing, crossings, count)
    if has_lower and is_rising:
        corners, edges = TriangleLevels(oc, od, nd), TriangleBases(bases.old, right, cut)
    elif has_lower:
        corners, edges = TriangleLevels(oc, od, nc), TriangleBases(bases.old, cut, left)
    elif is_rising:
        corners, edges = TriangleLevels(nc, nd, oc), TriangleBases(bases.new, cut, left)
    else:
        corners, edges = TriangleLevels(nc, nd, od), TriangleBases(bases.new, right, cut)
    _link_triangle(corners, edges, crossings)
    return count, right


@kernel
def mesh_strip(
    pixels: Pixels, extents: Integers, old: int, rule: MeshRule, crossings: Crossings, count: int
) -> int:
    """Cross the triangles between two rows; gives how many crossings there are then.

    A section has vertices on the edges along and between rows, on diagonals only where the mesh
    ends.
    """
    new = 1 - old
    low, high = min(extents[0, 0], extents[1, 0]), max(extents[0, 1], extents[1, 1])
    side, is_side = -1, False
    for c in range(low - 1, high - 1):
        d, left, side, is_left = c + 1, side, -1, is_side
        is_side = pixels[old, d].point >= 0 and pixels[new, d].point >= 0
        is_side = is_side and _square_between(pixels, old, d, new, d) <= rule.longest_square
        if c < low or not (is_left or is_side):
            continue
        sides = CellSides(is_left, is_side)
        is_rising, has_lower, has_upper = _triangles(pixels, old, c, sides, rule)
        if has_lower or has_upper:
            cell = MeshCell(old, c, is_rising, has_lower, has_upper)
            count, side = _mesh_cell(pixels, cell, left, rule.spacing_m, crossings, count)
    return count


@kernel
def mesh_rows(
    image: RowPair,
    state: Integers,
    points: PointArrays,
    rows: MeshRows,
    band: MeshLimits,
    crossings: Crossings,
) -> None:
    """Mesh rows from the next on, as long as there is room for crossings.

    ``state`` (4,) is the next row, which of the pixels' rows holds the last one, the number of
    crossings, and whether the next row is filled already.
    """
    pixels, extents = image
    ends, stations = rows
    for row in range(state[_NEXT_ROW], ends.shape[0]):
        old = state[_OLD]
        new = 1 - old
        state[_NEXT_ROW] = row
        if state[_IS_FILLED] == 0:
            fill_row(pixels[new], extents[new], points, ends[row], stations[row + 1], band)
            _join_row(pixels, extents, new, band.longest_m * band.longest_m)
            state[_IS_FILLED] = 1
        if ends[row, _IS_BREAK] == 0:
            longest = max(band.longest_m, _ADVANCES * (stations[row + 1] - stations[row]))
            most = int(_EDGES * longest / band.spacing_m) + 1
            room = crossings.shape[0] - state[_CROSSINGS]
            if room < 4 * most * pixels.shape[1] and room < strip_bound(pixels, extents, old):
                return
            rule = MeshRule(band.spacing_m, longest * longest, most)
            state[_CROSSINGS] = mesh_strip(pixels, extents, old, rule, crossings, state[_CROSSINGS])
        state[_OLD] = new
        state[_IS_FILLED] = 0
    state[_NEXT_ROW] = ends.shape[0]
