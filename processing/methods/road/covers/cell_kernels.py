"""Loops over points and cells: the surface of a road in fine cells, and what differs about it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.core.kernels import kernel
from processing.methods.road.markings.tone_kernels import own_tone
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import TILE, cell_of

_BELOW_M, BINS, _BIN_M = 0.1, 25, 0.02
"""About the coarse ground, in which heights the surface is looked for: walks behind curbs lie up to
0.25 m over it, and slope."""

_SHARE = 0.2
"""Of a cell's points that the surface has at least: what is lower lies between a grating's bars,
what is higher is a curb or stands on it."""

_ABOVE_M = 0.055
"""Over the begin of the surface's bins: two of them, and noise; but no curb."""

_BRIGHTEST = 3.0
"""Over the road's tone; paint and concrete reach it, reflectors far more."""

_OPEN_M, _DEEPEST_M = 0.02, 1.5
"""Below the surface: what beams meet between the bars of a grating and through it."""

_MOST_COUNTED = 200

LAYERS = 5
"""Of a window: weight, tone and height of the surface, weight of all points, share of those below.
"""


@kernel
def count_heights_kernel(
    local: Floats,
    is_noise: Flags,
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    heights: NDArray[np.uint8],
) -> None:
    """Count the points of each cell of 20 cm by their height about the ground."""
    for point in range(len(local)):
        if is_noise[point]:
            continue
        east, north, height = local[point, 0], local[point, 1], local[point, 2]
        coarse = cell_of(east, north, table, GROUND_CELLS)
        if coarse < 0:
            continue
        number = (height - ground[coarse] + _BELOW_M) / _BIN_M
        if 0.0 <= number < BINS:
            cell = cell_of(east, north, table, TILE)
            if heights[cell, int(number)] < 255:
                heights[cell, int(number)] += 1


@kernel
def surface_levels_kernel(
    heights: NDArray[np.uint8],
    ground: NDArray[np.float32],
    per_ground: int,
    levels: NDArray[np.float32],
) -> None:
    """Where the surface of each cell of 20 cm begins: the lowest two bins that hold enough.

    ``per_ground``: cells along the side of one of the ground. ``levels``: infinite where nothing
    was measured.
    """
    for cell in range(len(heights)):
        total = 0
        for k in range(BINS):
            total += heights[cell, k]
        levels[cell] = np.inf
        if total == 0:
            continue
        tile, a, b = cell // TILE**2, cell // TILE % TILE, cell % TILE
        coarse = (tile * GROUND_CELLS + a // per_ground) * GROUND_CELLS + b // per_ground
        for k in range(BINS):
            both = heights[cell, k] + (heights[cell, k + 1] if k + 1 < BINS else 0)
            if heights[cell, k] > 0 and both >= _SHARE * total:
                levels[cell] = ground[coarse] - _BELOW_M + k * _BIN_M
                break


@kernel
def surface_kernel(
    local: Floats,
    is_noise: Flags,
    intensity: NDArray[np.uint16],
    place: tuple[NDArray[np.int32], NDArray[np.float32], NDArray[np.float32]],
    per_tile: int,
    counts: NDArray[np.uint8],
    sums: NDArray[np.float32],
) -> None:
    """Add up tones and heights of the surface in fine cells, and count what lies below it.

    ``place``: the table of tiles, the road's tones as ``levels_kernel`` tells them, and where the
    surface of 20 cm begins. Where a head's tones say nothing, its points count as the road's own.
    """
    table, levels, surface = place
    for point in range(len(local)):
        if is_noise[point]:
            continue
        east, north, height = local[point, 0], local[point, 1], local[point, 2]
        cell = cell_of(east, north, table, TILE)
        if cell < 0:
            continue
        above = height - surface[cell]
        if not -_DEEPEST_M < above < _ABOVE_M:
            continue
        fine = cell_of(east, north, table, per_tile)
        if above < -_OPEN_M:
            if counts[1, fine] < _MOST_COUNTED:
                counts[1, fine] += 1
            continue
        if counts[0, fine] >= _MOST_COUNTED:
            continue
        own = own_tone(east, north, table, levels)
        tone = 0.0
        if own > 0.0:
            tone = min(intensity[point] / own - 1.0, _BRIGHTEST)
        counts[0, fine] += 1
        sums[0, fine] += tone
        sums[1, fine] += height


@kernel
def window_kernel(
    raster: tuple[NDArray[np.int32], NDArray[np.uint8], NDArray[np.float32]],
    per_tile: int,
    frame: tuple[float, float, float, float],
    usual: float,
    most: float,
    layers: NDArray[np.float32],
) -> None:
    """The cells about a place, turned along a direction.

    ``raster``: table, counts, sums. ``frame``: easting and northing of the window's middle and the
    direction of its first axis (cosine, sine), in cells. ``usual``: points of a cell that count as
    one; ``most``: the weight of a cell at most. ``layers``: (LAYERS, n, n).
    """
    table, counts, sums = raster
    size = layers.shape[1]
    east, north, cosine, sine = frame
    layers[:] = 0.0
    for a in range(size):
        for b in range(size):
            u, v = a + 0.5 - size / 2, b + 0.5 - size / 2
            x = math.floor(east + u * cosine - v * sine)
            y = math.floor(north + u * sine + v * cosine)
            if x < 0 or y < 0:
                continue
            i, j = x // per_tile, y // per_tile
            if i >= table.shape[0] or j >= table.shape[1] or table[i, j] < 0:
                continue
            cell = (table[i, j] * per_tile + x % per_tile) * per_tile + y % per_tile
            own, below = float(counts[0, cell]), float(counts[1, cell])
            if own + below > 0:
                layers[3, a, b] = min((own + below) / usual, most)
                layers[4, a, b] = below / (own + below)
            if own > 0:
                layers[0, a, b] = min(own / usual, most)
                layers[1, a, b] = sums[0, cell] / own
                layers[2, a, b] = sums[1, cell] / own


@kernel
def integral_kernel(layers: NDArray[np.float32], level: float, sums: Floats) -> None:
    """Sums over all cells before each place of a window.

    ``sums``: (n + 1, n + 1, 7): weight w, wt, wtt, wh, whh of the surface, its heights about
    ``level``; weight v of all, share of those below.
    """
    size = layers.shape[1]
    row = np.zeros(7)
    for i in range(size):
        row[:] = 0.0
        for j in range(size):
            w, t, v = layers[0, i, j], layers[1, i, j], layers[3, i, j]
            if w > 0:
                h = layers[2, i, j] - level
                row[0] += w
                row[1] += w * t
                row[2] += w * t * t
                row[3] += w * h
                row[4] += w * h * h
            row[5] += v
            row[6] += v * layers[4, i, j]
            for k in range(7):
                sums[i + 1, j + 1, k] = sums[i, j + 1, k] + row[k]


@kernel
def _box(sums: Floats, low: tuple[int, int], high: tuple[int, int], found: Floats) -> None:
    """What the cells of a box add up to; its ends exclusive."""
    for k in range(7):
        found[k] = (
            sums[high[0], high[1], k]
            - sums[low[0], high[1], k]
            - sums[high[0], low[1], k]
            + sums[low[0], low[1], k]
        )


@kernel
def contrast_kernel(
    sums: Floats,
    ranges: tuple[int, int, int],
    halves: NDArray[np.int64],
    band: int,
    floors: tuple[float, float, float],
    scores: Floats,
) -> None:
    """How far the rims of boxes about places differ from the bands around them.

    Parameters
    ----------
    ranges : (int, int, int)
        First and last cell along both axes, and the step, in cells.
    halves : (s, 2) int
        Half sides of the boxes, in cells.
    band : int
        Width of the rim and of the band around it, in cells.
    floors : (float, float, float)
        What tones, heights and shares of points below differ by where nothing lies.
    scores : (s, n, n) float64
        Gets the sum of the squares of the differences over what chance makes of them.

    Notes
    -----
    Of tones the second smallest of the differences to the four sides counts: a line, an edge and a
    corner of something larger are like the box on two sides at least; one side may be a curb or
    paint. Heights are held against means of opposite sides, which slopes change nothing in.
    """
    first, last, step = ranges
    whole, core, side = np.zeros(7), np.zeros(7), np.zeros((4, 7))
    off = np.zeros(4)
    for s in range(len(halves)):
        p, q = halves[s, 0], halves[s, 1]
        thin = min(p, q) <= band
        least = 0.5 * 4 * p * q
        for a in range((last - first) // step):
            for b in range((last - first) // step):
                i, j = first + a * step, first + b * step
                scores[s, a, b] = 0.0
                _box(sums, (i - p, j - q), (i + p, j + q), whole)
                if whole[5] < least:
                    continue
                if not thin:
                    _box(sums, (i - p + band, j - q + band), (i + p - band, j + q - band), core)
                    for k in range(7):
                        whole[k] -= core[k]
                _box(sums, (i - p - band, j - q), (i - p, j + q), side[0])
                _box(sums, (i + p, j - q), (i + p + band, j + q), side[1])
                _box(sums, (i - p, j - q - band), (i + p, j - q), side[2])
                _box(sums, (i - p, j + q), (i + p, j + q + band), side[3])
                seen = True
                for c in range(4):
                    seen = seen and side[c, 0] > 0.4 * band * 2 * (q if c < 2 else p)
                if seen:
                    scores[s, a, b] = _contrast(whole, side, floors, off)


@kernel
def _contrast(own: Floats, side: Floats, floors: tuple[float, float, float], off: Floats) -> float:
    """The sum of the squares of what a rim differs by from the bands on its four sides."""
    count = own[0]
    t, h = 0.0, 0.0
    if count > 0.3 * own[5]:
        tone, level = own[1] / count, own[3] / count
        spread = max(own[2] / count - tone * tone, 0.0)
        rough = max(own[4] / count - level * level, 0.0)
        for c in range(4):
            mean, height = side[c, 1] / side[c, 0], side[c, 3] / side[c, 0]
            off[c] = tone - mean
            spread += max(side[c, 2] / side[c, 0] - mean * mean, 0.0)
            rough += max(side[c, 4] / side[c, 0] - height * height, 0.0)
        t = _second(off) ** 2 / (2 * spread / 5 / count + floors[0] ** 2)
        one = level - (side[0, 3] / side[0, 0] + side[1, 3] / side[1, 0]) / 2
        other = level - (side[2, 3] / side[2, 0] + side[3, 3] / side[3, 0]) / 2
        if one * other > 0:
            h = min(abs(one), abs(other)) ** 2 / (2 * rough / 5 / count + floors[1] ** 2)
    below = own[6] / own[5]
    for c in range(4):
        off[c] = below - side[c, 6] / max(side[c, 5], 1e-9)
    v = max(_second(off), 0.0) ** 2 / floors[2] ** 2 if below > floors[2] else 0.0
    return float(t + h + v)


@kernel
def _second(off: Floats) -> float:
    """Of four differences the second smallest towards the side of most of them."""
    total = off[0] + off[1] + off[2] + off[3]
    sign = 1.0 if total > 0 else -1.0
    low, second = np.inf, np.inf
    for q in range(4):
        value = sign * off[q]
        if value < low:
            low, second = value, low
        elif value < second:
            second = value
    return float(max(second, 0.0))


@kernel
def apart_kernel(places: Floats, halves: Floats, alike: float, is_left: Flags) -> None:
    """Leave out boxes that are nearly the same as one before them that stays.

    ``places``, ``halves``: (n, 2) middles and half sides; ``alike``: how many times as long one may
    be as another that it is nearly the same as.
    """
    for one in range(len(places)):
        if not is_left[one]:
            continue
        for other in range(one + 1, len(places)):
            ratio = halves[other, 0] / halves[one, 0]
            if (
                abs(places[other, 0] - places[one, 0]) < 0.5 * min(halves[one, 0], halves[other, 0])
                and abs(places[other, 1] - places[one, 1])
                < 0.5 * min(halves[one, 1], halves[other, 1])
                and 1 / alike < ratio < alike
            ):
                is_left[other] = False
