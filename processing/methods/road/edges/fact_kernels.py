"""Loops over the cells of each station: what speaks for an edge between one cell and the next."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

CELL_M = 0.05
"""Across the way: half of what edges are asked for on a map of 1 : 500."""

FACTS = 15
"""Numbers told of each place, in the order of `edge_facts.EdgeFacts`."""

_SHARP, _BRIGHTER, _DARKER, _FAR_TONE, _FLEETING, _UNLIKE = range(6)
_ROUGHER, _SMOOTHER, _ROUGH_ON, _FAR_ROUGH, _UNEVEN = range(6, 11)
_BEND, _RISE, _DROP, _HIDDEN = range(11, 15)

NOT_SEEN = -1.0
"""As the first fact, where nothing was measured on the inner side."""

_ALONG, _MOST_MOVED = 2, 6  # stations to each side, and cells that a vehicle swerves by over them
_BAND = 2  # cells: a decimetre
_BANDS = 3  # outside, as wide as the narrowest gutter (0.35 m); painted lines are half as wide
_INNER = 16  # cells: 0.8 m, in which a painted line is the smaller part
_FAR, _FAR_END = 4, 10  # cells: beyond a painted line, on the narrowest gutter
_LINE, _LEAST_LINE = 10, 4  # cells: half a metre to each side tell the slope
_FROM = 16  # cells from the way: no edge is nearer, a vehicle is 1.7 m wide
_LANE = 30  # cells from the way that are lane
_STEP_M, _STEP_RANGE_M = 0.02, 0.05
_BLADES = 1.5  # standard deviations that blades of grass reach above the ground they stand on
_PAINT_WIDE, _PAINT, _PAINT_RISE_M = 6, 0.2, 0.08
"""Painted lines are narrower than so many cells (0.3 m; the narrowest gutter is 0.35 m wide),
brighter than both sides by so much of a logarithm, and have road on both sides: no rim of a gutter
that is open."""

_EARLIER = 16, 11  # cells: inside of an open gutter that is half a metre wide
_SUNK_M = 0.07  # over 0.55 m: no carriageway falls by more than 1 in 10
_MOST_BEND = 0.1
_PAINTED = 0.4  # share of the inner tones that is taken: below the middle, paint is brighter
_HALF_CHANGE = 0.3  # of a logarithm, a third more: what different pavements differ by at least


@kernel
def facts_kernel(
    cells: tuple[NDArray[np.float32], Floats, Floats, Floats],
    course: NDArray[np.int32],
    stations: tuple[int, int],
    facts: NDArray[np.float32],
    steps: NDArray[np.float32],
) -> None:
    """What speaks for an edge at each place beside some stations.

    Parameters
    ----------
    cells : tuple
        Counts, heights, roughness and tones: (stations, 2·half) each, rightmost first.
    course : (stations, 2) int32
        Cell from the way outwards by which each station lies beside those around it, as the
        vehicle swerves; negative: it stands alone.
    stations : (int, int)
        First, and the one behind the last.
    facts : (last − first, 2, half, FACTS) float32
        Of the boundary before each cell, by its distance from the way; left first.
    steps : (last − first, 2, half) float32
        How far the ground rises there, m, less what blades of grass may do.
    """
    counts, heights, rough, tones = cells
    half = counts.shape[1] // 2
    weight, height, coarse, tone = np.empty(half), np.empty(half), np.empty(half), np.empty(half)
    sums = np.empty((6, half))
    for station in range(stations[0], stations[1]):
        for side in range(2):
            sums[:] = 0.0
            own = course[station, side]
            for other in range(max(station - _ALONG, 0), min(station + _ALONG + 1, len(counts))):
                moved = course[other, side] - own if own >= 0 else 0
                is_beside = own >= 0 and course[other, side] >= 0 and abs(moved) <= _MOST_MOVED
                if other == station or is_beside:
                    _add_station((counts, heights, rough, tones), (other, side, moved), sums)
            for cell in range(half):
                weight[cell] = sums[0, cell]
                height[cell] = sums[1, cell] / sums[0, cell] if sums[0, cell] > 0 else np.nan
                coarse[cell] = sums[2, cell] / sums[3, cell] if sums[3, cell] > 0 else np.nan
                tone[cell] = sums[4, cell] / sums[5, cell] if sums[5, cell] > 0 else np.nan
            row = station - stations[0]
            _side_facts((weight, height, coarse, tone), facts[row, side], steps[row, side])


@kernel
def _add_station(
    cells: tuple[NDArray[np.float32], Floats, Floats, Floats],
    which: tuple[int, int, int],
    sums: Floats,
) -> None:
    """Add one side of a station, moved by some cells, to sums of what is known."""
    counts, heights, rough, tones = cells
    station, side, moved = which
    half = counts.shape[1] // 2
    for cell in range(max(0, -moved), min(half, half - moved)):
        column = half + cell + moved if side == 0 else half - 1 - cell - moved
        share = counts[station, column]
        if share == 0:
            continue
        sums[0, cell] += share
        sums[1, cell] += share * heights[station, column]
        if not math.isnan(rough[station, column]):
            sums[2, cell] += share * rough[station, column]
            sums[3, cell] += share
        if not math.isnan(tones[station, column]):
            sums[4, cell] += share * tones[station, column]
            sums[5, cell] += share


@kernel
def _side_facts(
    row: tuple[Floats, Floats, Floats, Floats],
    facts: NDArray[np.float32],
    steps: NDArray[np.float32],
) -> None:
    """Facts of one side of a station, its cells from the way outwards."""
    weight, height, coarse, painted = row
    tone = painted.copy()
    _paint_out(painted, height, tone)
    facts[:] = 0.0
    facts[:, 0] = NOT_SEEN
    steps[:] = 0.0
    lane = _quantile_of(coarse, weight, 0, _LANE, 0.5)
    for cell in range(_FROM, len(weight) - _LINE):
        if (weight[cell - 1] == 0 and weight[cell - 2] == 0) or _is_sunk(height, weight, cell):
            continue
        one = facts[cell]
        seen = 0
        for band in range(_BANDS):
            at = cell + band * _BAND
            seen += int(weight[at] + weight[at + 1] > 0)
        one[_HIDDEN] = 1.0 - seen / _BANDS
        _tone_facts(tone, weight, cell, one)
        _rough_facts(coarse, weight, cell, lane, one)
        one[_FLEETING] = one[_SHARP] * (1.0 - max(one[_FAR_TONE], one[_FAR_ROUGH]))
        steps[cell] = _slopes(height, coarse, weight, cell, one)


@kernel
def _is_sunk(height: Floats, weight: Floats, cell: int) -> bool:
    """Whether the ground inside of a place lies deeper than a carriageway falls: in a gutter."""
    before = _mean_of(height, weight, cell - 4, cell - 1)
    earlier = _mean_of(height, weight, cell - _EARLIER[0], cell - _EARLIER[1])
    return earlier - before > _SUNK_M


@kernel
def _paint_out(painted: Floats, height: Floats, tone: Floats) -> None:
    """Put what lies on both sides in place of narrow bright lines."""
    for cell in range(_PAINT_WIDE, len(painted) - _PAINT_WIDE):
        before, behind = cell - _PAINT_WIDE, cell + _PAINT_WIDE
        is_even = abs(height[behind] - height[before]) < _PAINT_RISE_M
        if is_even and painted[cell] > max(painted[before], painted[behind]) + _PAINT:
            tone[cell] = (painted[before] + painted[behind]) / 2.0


@kernel
def _full(change: float) -> float:
    """A change of a logarithm, 0 to 1: half at a third more, hardly more where it is larger."""
    return change / (change + _HALF_CHANGE) if change > 0 else 0.0


@kernel
def _tone_facts(tone: Floats, weight: Floats, cell: int, one: NDArray[np.float32]) -> None:
    """How brightness changes at a place, beyond it, and how far it is from the lane's inside."""
    within = _quantile_of(tone, weight, cell - _INNER, cell, _PAINTED)
    inner = _mean_of(tone, weight, cell - _BAND, cell)
    outer = _mean_of(tone, weight, cell, cell + _BAND)
    one[_SHARP] = 0.0 if math.isnan(inner) or math.isnan(outer) else _full(abs(outer - inner))
    if math.isnan(within):
        return
    one[_UNLIKE] = min(abs(within), 1.0)
    lowest, highest = _range_of(tone, weight, cell)
    if lowest <= highest:
        one[_BRIGHTER] = _full(lowest - within)
        one[_DARKER] = _full(within - highest)
    beyond = _quantile_of(tone, weight, cell + _FAR, cell + _FAR_END, _PAINTED)
    if not math.isnan(beyond):
        one[_FAR_TONE] = _full(abs(beyond - within))


@kernel
def _rough_facts(
    coarse: Floats, weight: Floats, cell: int, lane: float, one: NDArray[np.float32]
) -> None:
    """The same of roughness."""
    inner = _mean_of(coarse, weight, cell - _BAND, cell)
    outer = _mean_of(coarse, weight, cell, cell + _BAND)
    if not math.isnan(inner) and not math.isnan(outer):
        one[_ROUGHER] = _full(outer - inner)
        one[_SMOOTHER] = _full(inner - outer)
    within = _quantile_of(coarse, weight, cell - _INNER, cell, 0.5)
    if math.isnan(within):
        return
    if not math.isnan(lane):
        one[_UNEVEN] = min(abs(within - lane), 1.5)
    lowest, highest = _range_of(coarse, weight, cell)
    if lowest <= highest:
        one[_ROUGH_ON] = _full(lowest - within)
    beyond = _quantile_of(coarse, weight, cell + _FAR, cell + _FAR_END, 0.5)
    if not math.isnan(beyond):
        one[_FAR_ROUGH] = _full(abs(beyond - within))


@kernel
def _range_of(values: Floats, weight: Floats, cell: int) -> tuple[float, float]:
    """The lowest and highest mean of the bands outside; the highest is lower where none is told."""
    lowest, highest = np.inf, -np.inf
    for band in range(_BANDS):
        at = cell + band * _BAND
        value = _mean_of(values, weight, at, at + _BAND)
        if not math.isnan(value):
            lowest, highest = min(lowest, value), max(highest, value)
    return lowest, highest


@kernel
def _slopes(
    height: Floats, coarse: Floats, weight: Floats, cell: int, one: NDArray[np.float32]
) -> float:
    """The bend and the step at a place, written into its facts; the step, m."""
    inner, outer = np.zeros(2), np.zeros(2)
    if not (
        _fit_line(height, weight, (cell - _LINE, cell - 1, cell), inner)
        and _fit_line(height, weight, (cell + 1, cell + _LINE, cell), outer)
    ):
        return 0.0
    one[_BEND] = min(abs(outer[1] - inner[1]), _MOST_BEND) / _MOST_BEND
    before = _mean_of(height, weight, cell - 4, cell - 1)
    behind = _mean_of(height, weight, cell + 1, cell + 5)
    if math.isnan(before) or math.isnan(behind):
        return 0.0
    # Out of an open gutter the ground rises to what it was before.
    earlier = _mean_of(height, weight, cell - _EARLIER[0], cell - _EARLIER[1])
    drop = before + 5.5 * CELL_M * inner[1] - behind
    rise = -drop if math.isnan(earlier) else min(-drop, behind - earlier)
    blades = _mean_of(coarse, weight, cell + 1, cell + 5)
    low = rise - _BLADES * math.exp(blades) if not math.isnan(blades) else rise
    one[_RISE] = min(max(low - _STEP_M, 0.0) / _STEP_RANGE_M, 1.0)
    # An open gutter begins behind its rim, 9 cm wide at most.
    deepest = drop
    for band in range(1, _BANDS + 1):
        level = _mean_of(height, weight, cell + band * _BAND, cell + (band + 1) * _BAND)
        if not math.isnan(level):
            deepest = max(deepest, before + (band * _BAND + 3.5) * CELL_M * inner[1] - level)
    one[_DROP] = min(max(deepest - _STEP_M, 0.0) / _STEP_RANGE_M, 1.0)
    return float(low if rise > 0 else min(-drop, 0.0))


@kernel
def _mean_of(values: Floats, weight: Floats, first: int, end: int) -> float:
    """The weighted mean of some cells; NaN where none is known."""
    total, count = 0.0, 0.0
    for cell in range(max(first, 0), min(end, len(values))):
        if weight[cell] > 0 and not math.isnan(values[cell]):
            total += weight[cell] * values[cell]
            count += weight[cell]
    return float(total / count) if count > 0 else np.nan


@kernel
def _quantile_of(values: Floats, weight: Floats, first: int, end: int, share: float) -> float:
    """A quantile of the known values of some cells; NaN where fewer than a quarter are known."""
    kept = np.empty(end - first)
    count = 0
    for cell in range(max(first, 0), min(end, len(values))):
        if weight[cell] > 0 and not math.isnan(values[cell]):
            at = count
            while at > 0 and kept[at - 1] > values[cell]:
                kept[at] = kept[at - 1]
                at -= 1
            kept[at] = values[cell]
            count += 1
    if count * 4 < end - first:
        return np.nan
    return float(kept[min(int(share * count), count - 1)])


@kernel
def _fit_line(height: Floats, weight: Floats, cells: tuple[int, int, int], line: Floats) -> bool:
    """The line through some cells: its height at a boundary, m, and its slope."""
    first, end, about = cells
    count, s, ss, h, sh = 0.0, 0.0, 0.0, 0.0, 0.0
    for cell in range(max(first, 0), min(end, len(height))):
        if weight[cell] > 0:
            at = (cell + 0.5 - about) * CELL_M
            count += 1.0
            s += at
            ss += at * at
            h += height[cell]
            sh += at * height[cell]
    if count < _LEAST_LINE:
        return False
    line[1] = (sh - s * h / count) / (ss - s * s / count)
    line[0] = h / count - line[1] * s / count
    return True
