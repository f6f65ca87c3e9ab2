"""Strokes of paint followed cell by cell: where their edges are, which way they lead, how far."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.objects.sparse_plan import TILE, cell_of


class StrokeRaster(NamedTuple):
    """What kernels need of a raster of paint.

    Attributes
    ----------
    shares : (cells,) float32
    table : (nx, ny) int32
    per_tile : int
    cell_m : float
    """

    shares: NDArray[np.float32]
    table: NDArray[np.int32]
    per_tile: int
    cell_m: float


class StrokeLimits(NamedTuple):
    """What a stroke is.

    Attributes
    ----------
    seed : float
        A cell with so much paint may begin one.
    widest_m, beside_m : float
        The widest stroke, and the road that must lie beside it.
    dark : float
        Of its paint that the road beside it may show.
    step_m, long_m : float
        Between stations, and how much of the stroke tells of one.
    """

    seed: float
    widest_m: float
    beside_m: float
    dark: float
    step_m: float
    long_m: float


STATION = 6
"""Numbers of a station: east, north, width, paint, paint on the left, on the right; m."""

_MOST_ACROSS = 200
_TENSOR_M, _TENSOR_CELL_M = 0.3, 0.05
_LEAST_COHERENT = 0.3
_TURN_BACK_M = 1.0
_MOST_SKIPPED = 4
_TRIED_M = 0.07


@kernel
def _share_at(east: float, north: float, raster: StrokeRaster) -> float:
    cell = cell_of(east, north, raster.table, raster.per_tile)
    return float(raster.shares[cell]) if cell >= 0 else math.nan


@kernel
def _direction_at(east: float, north: float, raster: StrokeRaster) -> tuple[float, float]:
    """Which way paint leads around a place, rad, and how clearly: 0 not at all, 1 in a line."""
    cell = max(raster.cell_m, _TENSOR_CELL_M)
    reach = int(_TENSOR_M / cell)
    xx, xy, yy = 0.0, 0.0, 0.0
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            if i * i + j * j > reach * reach:
                continue
            x, y = east + i * cell, north + j * cell
            before, after = _share_at(x - cell, y, raster), _share_at(x + cell, y, raster)
            below, above = _share_at(x, y - cell, raster), _share_at(x, y + cell, raster)
            if math.isnan(before) or math.isnan(after) or math.isnan(below) or math.isnan(above):
                continue
            across, along = min(after, 1.0) - min(before, 1.0), min(above, 1.0) - min(below, 1.0)
            xx += across * across
            xy += across * along
            yy += along * along
    total = xx + yy
    if total <= 0.0:
        return 0.0, 0.0
    part = math.sqrt((xx - yy) ** 2 + 4 * xy * xy)
    steepest = 0.5 * math.atan2(2 * xy, xx - yy)
    return steepest + math.pi / 2, part / total


@kernel
def _profile_across(
    east: float,
    north: float,
    heading: float,
    raster: StrokeRaster,
    limits: StrokeLimits,
    profile: Floats,
) -> int:
    """The paint of a short piece of a stroke put together across it; how long the profile is."""
    step = raster.cell_m / 2
    half = min(int((limits.widest_m + limits.beside_m) / step), len(profile) // 2 - 1)
    cosine, sine = math.cos(heading), math.sin(heading)
    pieces = max(1, int(limits.long_m / max(raster.cell_m, 0.04)))
    for k in range(2 * half + 1):
        aside = (k - half) * step
        total, seen = 0.0, 0
        for piece in range(pieces):
            ahead = ((piece + 0.5) / pieces - 0.5) * limits.long_m
            share = _share_at(
                east + ahead * cosine - aside * sine, north + ahead * sine + aside * cosine, raster
            )
            if not math.isnan(share):
                total += share
                seen += 1
        profile[k] = total / seen if 2 * seen >= pieces else math.nan
    return 2 * half + 1


@kernel
def _edges_at(
    east: float,
    north: float,
    heading: float,
    raster: StrokeRaster,
    limits: StrokeLimits,
    space: Floats,
    found: Floats,
) -> bool:
    """Where the edges of a stroke cross a line at right angles to it.

    Edges are where a profile falls halfway from the stroke's own paint to the road's beside it.

    Parameters
    ----------
    space : (m,) float64
        Room for the profile.
    found : (5,) float64
        Gets the offsets of the right and the left edge, the paint between them, and how painted
        the road to the right and to the left is.
    """
    step = raster.cell_m / 2
    count = _profile_across(east, north, heading, raster, limits, space)
    profile = space[:count]
    half = count // 2
    near = max(1, int(0.04 / step))
    start = half
    for k in range(half - near, half + near + 1):
        if profile[k] > profile[start] or math.isnan(profile[start]):
            start = k
    if not profile[start] >= limits.seed:
        return False
    most = profile[start]
    low, high = start, start
    for _ in range(2):
        low, high = _fall(profile, start, -1, most / 2), _fall(profile, start, 1, most / 2)
        if low < 0 or high < 0:
            return False
        most = _plateau(profile, low, high, most)
    beside, first = int(limits.beside_m / step), math.ceil(1.5 * raster.cell_m / step)
    right = _beside(profile, low - first, -1, beside)
    left = _beside(profile, high + first, 1, beside)
    is_free = right <= limits.dark * most and left <= limits.dark * most
    if not is_free or (high - low - 1) * step > limits.widest_m:
        return False
    found[0] = (low - half) * step + step * _crossing(profile, low, 1, (most + right) / 2)
    found[1] = (high - half) * step - step * _crossing(profile, high, -1, (most + left) / 2)
    found[2], found[3], found[4] = most, right, left
    return bool(found[1] - found[0] > raster.cell_m)


@kernel
def _fall(profile: Floats, start: int, way: int, level: float) -> int:
    """The first place from a stroke on that is no longer painted; −1: nothing tells."""
    at = start
    while 0 <= at < len(profile):
        if math.isnan(profile[at]):
            return -1
        if profile[at] <= level:
            return at
        at += way
    return -1


@kernel
def _plateau(profile: Floats, low: int, high: int, otherwise: float) -> float:
    """The paint of the inner half between two edges."""
    inner, many = 0.0, 0
    skip = (high - low) // 4
    for k in range(low + 1 + skip, high - skip):
        inner += profile[k]
        many += 1
    return inner / many if many else otherwise


@kernel
def _beside(profile: Floats, start: int, way: int, count: int) -> float:
    """The middle of the least and the mean paint beside a stroke; NaN where nothing was seen."""
    total, seen, least = 0.0, 0, np.inf
    for k in range(start, start + way * count, way):
        if 0 <= k < len(profile) and not math.isnan(profile[k]):
            total += profile[k]
            least = min(least, profile[k])
            seen += 1
            if 2 * seen >= count:
                break
    return (least + total / seen) / 2 if 3 * seen >= count else math.nan


@kernel
def _crossing(profile: Floats, outside: int, way: int, level: float) -> float:
    """How far inwards from the last place outside a level is crossed, in steps."""
    at = outside
    while 0 <= at + way < len(profile) and profile[at + way] < level:
        at += way
    if not 0 <= at + way < len(profile) or math.isnan(profile[at]):
        return abs(at - outside) + 0.5
    while profile[at] > level and 0 < at < len(profile) - 1 and not math.isnan(profile[at - way]):
        at -= way
    rise = profile[at + way] - profile[at]
    inside = (level - profile[at]) / rise if rise > 0 else 0.5
    return (at - outside) * way + min(max(inside, 0.0), 1.0)


@kernel
def _follow(
    start: Floats,
    heading: float,
    raster: StrokeRaster,
    limits: StrokeLimits,
    profile: Floats,
    stations: Floats,
) -> int:
    """Follow a stroke from a station on; how many further stations there are.

    Where its sides can't be told it goes on straight for as long as there is paint: at a stop line
    that meets an edge line, over a lid.
    """
    found = np.empty(5)
    count, skipped = 0, 0
    east, north, wide, own = start[0], start[1], start[2], start[3]
    while count < len(stations):
        east += limits.step_m * math.cos(heading)
        north += limits.step_m * math.sin(heading)
        if not _is_painted(east, north, heading, raster, own, limits):
            break
        ok = _edges_at(east, north, heading, raster, limits, profile, found)
        if ok:
            now = found[1] - found[0]
            ok = abs(now - wide) <= max(2 * raster.cell_m, 0.3 * wide)
        if not ok:
            skipped += 1
            if skipped > _MOST_SKIPPED:
                break
            continue
        skipped = 0
        aside = (found[0] + found[1]) / 2
        east -= aside * math.sin(heading)
        north += aside * math.cos(heading)
        wide += 0.2 * (found[1] - found[0] - wide)
        stations[count, 0], stations[count, 1] = east, north
        stations[count, 2], stations[count, 3] = found[1] - found[0], found[2]
        stations[count, 4], stations[count, 5] = found[4], found[3]
        count += 1
        back = count - 1 - int(_TURN_BACK_M / limits.step_m)
        x, y = (start[0], start[1]) if back < 0 else (stations[back, 0], stations[back, 1])
        away = math.hypot(east - x, north - y)
        if away > 0.4 * _TURN_BACK_M:
            wanted = math.atan2(north - y, east - x)
            turn = math.atan2(math.sin(wanted - heading), math.cos(wanted - heading))
            heading += 0.5 * turn
    return count


@kernel
def _is_painted(
    east: float,
    north: float,
    heading: float,
    raster: StrokeRaster,
    own: float,
    limits: StrokeLimits,
) -> bool:
    """Whether there is paint along a step to a place."""
    cosine, sine = math.cos(heading), math.sin(heading)
    total, seen = 0.0, 0
    pieces = max(2, int(limits.step_m / raster.cell_m))
    for piece in range(pieces):
        back = limits.step_m * piece / pieces
        share = _share_at(east - back * cosine, north - back * sine, raster)
        if not math.isnan(share):
            total += share
            seen += 1
    return seen > 0 and total / seen >= 0.5 * own


@kernel
def _end_at(
    station: Floats, heading: float, raster: StrokeRaster, limits: StrokeLimits, end: Floats
) -> None:
    """Where a stroke ends beyond its last station: paint falls below half of its own there."""
    step = raster.cell_m / 2
    cosine, sine = math.cos(heading), math.sin(heading)
    width = station[2] * 0.6
    pieces = max(1, int(width / step))
    at, last = 0.0, station[3]
    empty = 0
    while at < 2 * limits.long_m:
        at += step
        total, seen = 0.0, 0
        for piece in range(pieces):
            aside = ((piece + 0.5) / pieces - 0.5) * width
            share = _share_at(
                station[0] + at * cosine - aside * sine,
                station[1] + at * sine + aside * cosine,
                raster,
            )
            if not math.isnan(share):
                total += share
                seen += 1
        now = total / seen if seen else last
        empty = empty + 1 if seen == 0 else 0
        if now < station[3] / 2 or empty > 4:
            share = (last - station[3] / 2) / (last - now) if last > now else 0.5
            at -= step * (1.0 - share) + step * empty
            break
        last = now
    end[0], end[1] = station[0] + at * cosine, station[1] + at * sine


@kernel
def strokes_kernel(
    seeds: Integers,
    corner: tuple[float, float],
    raster: StrokeRaster,
    limits: StrokeLimits,
    is_done: NDArray[np.bool_],
    stations: Floats,
    counts: Integers,
) -> int:
    """Follow the strokes that begin at the cells of one tile, or through it.

    Parameters
    ----------
    seeds : (k,) int64
        Numbers of cells within the tile.
    corner : (east, north)
        Of the tile, m.
    is_done : (cells,) bool
        Cells of strokes; gets those that are found.
    stations : (m, STATION) float64
        Gets the stations of one stroke after the other; its ends are stations without width.
    counts : (k,) int64
        Gets how many stations each stroke has.

    Returns
    -------
    int
        How many strokes were found; as many as there was room for.
    """
    profile = np.empty(_MOST_ACROSS)
    most = len(stations) // 4
    forwards, backwards = np.empty((most, STATION)), np.empty((most, STATION))
    first = np.empty(STATION + 1)
    strokes, used = 0, 0
    is_tried = np.zeros(raster.per_tile * raster.per_tile, np.bool_)
    near = max(1, int(_TRIED_M / raster.cell_m))
    for seed in seeds:
        a, b = seed // raster.per_tile, seed % raster.per_tile
        first[0] = corner[0] + (a + 0.5) * raster.cell_m
        first[1] = corner[1] + (b + 0.5) * raster.cell_m
        cell = cell_of(first[0], first[1], raster.table, raster.per_tile)
        if is_done[cell] or is_tried[seed]:
            continue
        if not _begins(first, raster, limits, profile):
            _mark_around(a, b, raster.per_tile, near, is_tried)
            continue
        heading = first[STATION]
        ahead = _follow(first, heading, raster, limits, profile, forwards)
        back = _follow(first, heading + math.pi, raster, limits, profile, backwards)
        count = ahead + back + 3
        if used + count > len(stations) or strokes == len(counts):
            break
        stroke = stations[used : used + count]
        _put_together(backwards[:back], first, forwards[:ahead], stroke)
        _add_ends(stroke, heading, raster, limits)
        _mark(stroke, raster, is_done)
        counts[strokes] = count
        used += count
        strokes += 1
    return strokes


@kernel
def _begins(first: Floats, raster: StrokeRaster, limits: StrokeLimits, profile: Floats) -> bool:
    """Whether a stroke runs through a place; the place is moved to its middle.

    Parameters
    ----------
    first : (STATION + 1,) float64
        Its place; gets the station there, and which way the stroke leads.
    """
    found = np.empty(5)
    heading, clear = _direction_at(first[0], first[1], raster)
    if clear < _LEAST_COHERENT:
        return False
    for _ in range(3):
        if not _edges_at(first[0], first[1], heading, raster, limits, profile, found):
            return False
        aside = (found[0] + found[1]) / 2
        first[0] -= aside * math.sin(heading)
        first[1] += aside * math.cos(heading)
        turned, clear = _direction_at(first[0], first[1], raster)
        if clear >= _LEAST_COHERENT:
            heading = turned
    if not _edges_at(first[0], first[1], heading, raster, limits, profile, found):
        return False
    first[2], first[3], first[4], first[5] = found[1] - found[0], found[2], found[4], found[3]
    first[STATION] = heading
    return True


@kernel
def _put_together(backwards: Floats, first: Floats, forwards: Floats, stroke: Floats) -> None:
    """All stations of a stroke in their order; room is left for its ends."""
    stroke[:] = 0.0
    back = len(backwards)
    for k in range(back):
        stroke[1 + k] = backwards[back - 1 - k]
        left, right = stroke[1 + k, 4], stroke[1 + k, 5]
        stroke[1 + k, 4], stroke[1 + k, 5] = right, left
    for k in range(STATION):
        stroke[1 + back, k] = first[k]
    for k in range(len(forwards)):
        stroke[2 + back + k] = forwards[k]


@kernel
def _add_ends(stroke: Floats, heading: float, raster: StrokeRaster, limits: StrokeLimits) -> None:
    """Find both ends of a stroke, on the way that its last stations lead."""
    end = np.empty(2)
    last = len(stroke) - 2
    for side in range(2):
        at = 1 if side == 0 else last
        inner = min(4, last) if side == 0 else max(last - 3, 1)
        way = heading + (math.pi if side == 0 else 0.0)
        if inner != at:
            way = math.atan2(stroke[at, 1] - stroke[inner, 1], stroke[at, 0] - stroke[inner, 0])
        _end_at(stroke[at], way, raster, limits, end)
        into = 0 if side == 0 else last + 1
        stroke[into, 0], stroke[into, 1] = end[0], end[1]


@kernel
def _mark_around(a: int, b: int, per_tile: int, reach: int, is_marked: NDArray[np.bool_]) -> None:
    """Mark the cells of a tile about one of them."""
    for i in range(max(0, a - reach), min(per_tile, a + reach + 1)):
        for j in range(max(0, b - reach), min(per_tile, b + reach + 1)):
            is_marked[i * per_tile + j] = True


@kernel
def _mark(stations: Floats, raster: StrokeRaster, is_done: NDArray[np.bool_]) -> None:
    """Mark the cells of a stroke and those that touch it."""
    step = raster.cell_m / 2
    for k in range(len(stations) - 1):
        x, y = stations[k + 1, 0] - stations[k, 0], stations[k + 1, 1] - stations[k, 1]
        long = math.hypot(x, y)
        if long <= 0.0:
            continue
        wide = max(stations[k, 2], stations[k + 1, 2]) / 2 + 1.5 * raster.cell_m
        for i in range(-1, int(long / step) + 2):
            for j in range(-int(wide / step), int(wide / step) + 1):
                at, aside = i * step / long, j * step / long
                cell = cell_of(
                    stations[k, 0] + at * x - aside * y,
                    stations[k, 1] + at * y + aside * x,
                    raster.table,
                    raster.per_tile,
                )
                if cell >= 0:
                    is_done[cell] = True


@kernel
def surface_kernel(
    places: Floats, table: NDArray[np.int32], surface: Floats, heights: Floats
) -> None:
    """The road's height at (n, 2) places; NaN where it wasn't seen."""
    for k in range(len(places)):
        cell = cell_of(places[k, 0], places[k, 1], table, TILE)
        heights[k] = surface[cell] if cell >= 0 else math.nan


@kernel
def smooth_kernel(
    places: Floats, along: Floats, reach_m: float, step_m: float, smooth: Floats
) -> None:
    """Move places along a line onto parabolas through those about each, by least squares.

    Where no more than eight are near, onto a straight line; two and fewer stay.

    Parameters
    ----------
    places : (n, 2) float64
        m, from one end to the other.
    along : (n,) float64
        m from the first, rising.
    reach_m : float
        How far those about a place reach to both sides; near the ends no farther to one side than
        to the other, but at least half as far as the line is long.
    step_m : float
        Between places.
    smooth : (n, 2) float64
        Written; the places themselves before.
    """
    whole = along[-1]
    sums = np.empty(5)
    products = np.empty((2, 3))
    for k in range(len(places)):
        reach = min(reach_m, max(along[k], step_m), max(whole - along[k], step_m))
        reach = max(reach, min(reach_m, 0.5 * whole))
        first = np.searchsorted(along, along[k] - reach, side="left")
        end = np.searchsorted(along, along[k] + reach, side="right")
        if end - first < 3:
            continue
        sums[:] = 0.0
        products[:] = 0.0
        for near in range(first, end):
            at = (along[near] - along[k]) / reach
            power = 1.0
            for n in range(5):
                sums[n] += power
                if n < 3:
                    products[0, n] += power * (places[near, 0] - places[k, 0])
                    products[1, n] += power * (places[near, 1] - places[k, 1])
                power *= at
        for axis in range(2):
            smooth[k, axis] = places[k, axis] + _fitted_at_zero(sums, products[axis])


@kernel
def _fitted_at_zero(sums: Floats, products: Floats) -> float:
    """What a parabola fitted by least squares tells at 0, or a straight line through eight places.

    ``sums`` (5,) of the powers of what it is fitted over; ``products`` (3,) of the first three
    powers with the values.
    """
    level = sums[0] * sums[2] - sums[1] * sums[1]
    if level <= 1e-12 * sums[0] * sums[2]:
        return float(products[0] / sums[0])
    straight = float((sums[2] * products[0] - sums[1] * products[1]) / level)
    if sums[0] <= 8:
        return straight
    one = sums[2] * sums[4] - sums[3] * sums[3]
    two = sums[1] * sums[4] - sums[2] * sums[3]
    three = sums[1] * sums[3] - sums[2] * sums[2]
    bent = sums[0] * one - sums[1] * two + sums[2] * three
    if abs(bent) <= 1e-12 * sums[0] * sums[2] * sums[4]:
        return straight
    return float((products[0] * one - products[1] * two + products[2] * three) / bent)
