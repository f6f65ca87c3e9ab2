"""Loops that link steps of scanlines to tracks along the path, and join and smooth tracks.

A track is followed from scanline to scanline: its place and direction are predicted, the step that
fits best is taken, and the prediction is made better by it (an alpha-beta filter), so that a step
is followed round bends and wide corners without any search.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_GAIN, _SLOPE_GAIN, _HEIGHT_GAIN = 0.5, 0.12, 0.5
"""Of the alpha-beta filter: shares of what a step is off its prediction that place, direction and
heights take over, once a track is no longer young. By trial."""

_YOUNG = 4
"""A track of fewer steps is young: its direction isn't known yet."""

_YOUNG_SHARE, _YOUNG_SLOPE_GAIN = 0.25, 0.5
"""Of young tracks the gain falls from 1 by the first for each step, to that of others; the gain of
the direction is the second divided by the number of steps. By trial."""

_LEAST_GAP_M, _LONG_GAP_M = 0.1, 0.5
"""Directions follow from what a step is off over the gap before it: over no less than one spacing
of scanlines, and over a metre where the gap is longer than the second, so that one step behind a
gap doesn't turn a track. By trial."""

_NEAR_M, _TURN, _NEW_TURN = 0.05, 0.12, 1.0
"""How far off its prediction a step may be: at once, m; and per metre of the gap, m per m, of
tracks (7°) and of young ones (45°). By trial."""

_MOST_OFF_M = 0.20
"""How far at most: less than the least width of an edging or an apron, so that no track passes from
one edge to another. By trial."""

_HIGH_M, _HIGH_PER_M = 0.05, 0.1
"""How far heights may differ from one scanline to the next, and how much more per metre of the gap
(10 %: steeper than ramps of dropped curbs rise over their whole length). Upper edges, which grass
hides, may differ by twice as much. By trial."""

_WORST, _SUM = 0.5, 6
"""A pair's cost is half its worst misfit and half the mean of all three, so that 1 is the limit of
each."""

_MOST_ACTIVE = 512
"""Tracks followed at a time: many times the steps of a scanline, of which fields have thirty;
beyond it no further track begins."""

_LAST, _NUMBER, _AGE = range(3)
"""Columns of counts of a track: scanline of its last step, its number, its steps."""

_AT, _DIRECTION, _LOW, _HIGH, _SIGN = range(5)
"""Columns of the state of a track: place across, m; slope, m per m; heights of both edges, m; 1
where the ground rises to the right, else −1."""

_STEP_AT, _STEP_LOW, _STEP_HIGH, _STEP_SIGN = range(4)
"""Columns of a step that is to be linked: see `link_kernel`."""

_STATION, _ACROSS, _SLOPE, _LOWER, _LENGTH = range(5)
END_COLUMNS = 5
"""Of one end of a track, as a straight line over its last metres: station, place across there, m;
slope, m per m; height of the lower edge; length of the whole track, m."""

_END_M = 3.0
"""Length of a track that gives the direction of its end. By trial."""

_HELD_M2 = 0.3
"""Holds the direction of short ends along the vehicle's path, m²: ends of 0.5 m keep a third of
what their steps say, those of 3 m nearly all. By trial."""

_FEWEST_AT_END, _MOST_AT_END = 3, 10
"""Steps whose median is the height of an end: the last metre, at least three for a median."""

_OFF_M, _OFF_PER_M, _END_TURN = 0.05, 0.04, 0.12
"""How far two ends may lie off each other's line half way: at once, m, and per metre of the gap;
how far their slopes may differ, m per m (7°). By trial."""

_END_HIGH_M, _END_HIGH_PER_M = 0.05, 0.03
"""How far their heights may differ: at once, m, and per metre of the gap, the steepest of usual
roads. By trial."""

_BESIDE_M = 3.0
"""Tracks of one low step may go on beside each other for so long. By trial."""

_LONG_M = 8.0
"""Longest gap that is bridged where both sides lie on one line: a parked lorry."""

_LONG_SHARE = 3
"""Both sides of a gap longer than what is joined at once must be at least this part of it long. By
trial."""

_SHORT_M, _SHORT_TURNS, _LONG_TURNS = 1.0, 3.0, 0.5
"""Across gaps shorter than the first slopes may differ by so many times `_END_TURN`, since short
ends tell their direction badly; across those longer than what is joined at once by half of it. By
trial."""

_ROUNDS = 3
"""Of the robust fit: one without weights, two with them. By trial."""

_SPREADS, _OF_MEDIAN, _LEAST_OFF_M = 3.0, 1.5, 0.002
"""What is off by more than so many standard deviations weighs nothing (biweight); a standard
deviation is about 1.5 times the median of what is off (1.48 of normal noise), at least that of a
good scanner, m."""

_LEAST_WEIGHT, _FARTHEST_M, _WIDER = 1e-3, 100.0, 1.5
"""Where a window holds less weight it is widened by the last factor, up to so many metres."""

_HELD_SHARE, _HELD = 0.2, 0.02
"""Hold slopes where all points of a window lie in one place: of the reach, and of the square of
it. By trial."""


class _Tables(NamedTuple):
    """Tracks that are followed: their states, counts, and which of them have a step here."""

    state: _Floats
    counts: _Integers
    taken: NDArray[np.bool_]


class _Pair(NamedTuple):
    """A step, the track that it goes on, and how badly it does: 1 is the most."""

    cost: float
    step: int
    track: int


@kernel
def link_kernel(
    section: _Integers, steps: _Floats, spacing: float, longest_gap: float, track: _Integers
) -> int:
    """Number the tracks that steps belong to.

    Parameters
    ----------
    section : (n,)
        Scanline of each step, not decreasing.
    steps : (n, 4)
        Middle of the face across, heights of the edges about the road, m; 1 where the ground rises
        to the right, else −1.
    spacing : float
        Between scanlines, m.
    longest_gap : float
        Within a track, m.
    track : (n,)
        Filled.

    Returns
    -------
    int
        How many tracks there are.
    """
    most_gap = int(longest_gap / spacing)
    counts = np.empty((_MOST_ACTIVE, 3), np.int64)
    state = np.empty((_MOST_ACTIVE, 5))
    tables = _Tables(state, counts, np.zeros(_MOST_ACTIVE, np.bool_))
    active, tracks, begin = 0, 0, 0
    track[:] = -1
    while begin < section.size:
        here = section[begin]
        end = begin
        while end < section.size and section[end] == here:
            end += 1
        active = _forget(tables, active, here, most_gap)
        for _ in range(end - begin):
            best = _Pair(1.0, -1, -1)
            for i in range(begin, end):
                if track[i] < 0:
                    best = _better(tables, active, (i, here, spacing), steps[i], best)
            i, k = best.step, best.track
            if i < 0:
                break
            _go_on(state[k], (here - counts[k, _LAST]) * spacing, counts[k, _AGE], steps[i])
            counts[k, _LAST] = here
            counts[k, _AGE] += 1
            tables.taken[k] = True
            track[i] = counts[k, _NUMBER]
        for i in range(begin, end):
            if track[i] < 0:
                track[i] = tracks
                active = _begin(tables, active, (here, tracks), steps[i])
                tracks += 1
        begin = end
    return tracks


@kernel
def _begin(
    tables: _Tables,
    active: int,
    which: tuple[int, int],
    step: _Floats,
) -> int:
    """Put a new track into the tables; gives how many there are."""
    state, counts, _ = tables
    if active == _MOST_ACTIVE:
        return active
    here, number = which
    counts[active, _LAST], counts[active, _NUMBER], counts[active, _AGE] = here, number, 0
    state[active, _AT], state[active, _DIRECTION] = step[_STEP_AT], 0.0
    state[active, _LOW:] = step[_STEP_LOW:]
    return active + 1


@kernel
def _forget(tables: _Tables, active: int, here: int, most_gap: int) -> int:
    """Tracks that have ended are taken out of the tables; gives how many are left."""
    state, counts, taken = tables
    kept = 0
    for k in range(active):
        if here - counts[k, _LAST] <= min(most_gap, 1 + 2 * counts[k, _AGE]):
            counts[kept] = counts[k]
            state[kept] = state[k]
            kept += 1
    taken[:kept] = False
    return kept


@kernel
def _better(
    tables: _Tables,
    active: int,
    where: tuple[int, int, float],
    found: _Floats,
    best: _Pair,
) -> _Pair:
    """Cost, step and track of the best pair so far, a further step being looked at."""
    state, counts, taken = tables
    step, here, spacing = where
    for k in range(active):
        if not taken[k] and state[k, _SIGN] == found[_STEP_SIGN]:
            gap = (here - counts[k, _LAST]) * spacing
            off = abs(found[_STEP_AT] - state[k, _AT] - state[k, _DIRECTION] * gap)
            if off >= _MOST_OFF_M / (_WORST + 1 / _SUM):
                continue  # so far off its cost is more than the most
            cost = _cost(state[k], gap, counts[k, _AGE], found)
            if cost < best.cost:
                best = _Pair(cost, step, k)
    return best


@kernel
def _go_on(state: _Floats, gap: float, age: int, found: _Floats) -> None:
    """Make a track's prediction better by the step that was found."""
    predicted = state[_AT] + state[_DIRECTION] * gap
    off = found[_STEP_AT] - predicted
    gain, turn = _GAIN, _SLOPE_GAIN
    if age < _YOUNG:
        gain, turn = 1.0 / (1.0 + _YOUNG_SHARE * age), _YOUNG_SLOPE_GAIN / (1.0 + age)
    state[_AT] = predicted + gain * off
    state[_DIRECTION] += turn * off / max(gap, _LEAST_GAP_M) if gap < _LONG_GAP_M else turn * off
    state[_LOW] += _HEIGHT_GAIN * (found[_STEP_LOW] - state[_LOW])
    state[_HIGH] += _HEIGHT_GAIN * (found[_STEP_HIGH] - state[_HIGH])


@kernel
def _cost(state: _Floats, gap: float, age: int, found: _Floats) -> float:
    """How badly a step goes on a track: 1 is the most."""
    turn = _NEW_TURN if age < _YOUNG else _TURN
    most = min(_NEAR_M + turn * gap, _MOST_OFF_M)
    off = abs(found[_STEP_AT] - state[_AT] - state[_DIRECTION] * gap) / most
    high = _HIGH_M + _HIGH_PER_M * gap
    low_off = abs(found[_STEP_LOW] - state[_LOW]) / high
    up_off = abs(found[_STEP_HIGH] - state[_HIGH]) / (2 * high)
    return float(max(off, low_off, up_off) * _WORST + (off + low_off + up_off) / _SUM)


@kernel
def ends_kernel(
    stations: _Floats, positions: _Floats, rows: _Integers, bounds: _Integers, ends: _Floats
) -> None:
    """Both ends of tracks.

    Parameters
    ----------
    stations : (n,)
        Of each step, along the vehicle's path, m.
    positions : (n, 2)
        Middle of its face across, and height of its lower edge; m.
    rows : (k,)
        Steps of one track after the other, each track's along the vehicle's path.
    bounds : (t, 2)
        Where each track begins and ends in ``rows``.
    ends : (t, 2, END_COLUMNS)
        Filled: first and last end.
    """
    for track in range(bounds.shape[0]):
        steps = rows[bounds[track, 0] : bounds[track, 1]]
        first, last = stations[steps[0]], stations[steps[-1]]
        for end in range(2):
            _end_of(stations, positions, steps, (last if end else first), ends[track, end])
            ends[track, end, _LENGTH] = last - first


@kernel
def _end_of(
    stations: _Floats, positions: _Floats, steps: _Integers, station: float, end: _Floats
) -> None:
    near = steps[np.abs(stations[steps] - station) <= _END_M]
    away, across = stations[near] - station, positions[near, 0]
    middle = away.mean()
    # A short end tells no direction: held along the vehicle's path, within some degrees.
    slope = ((away - middle) * across).sum() / (((away - middle) ** 2).sum() + _HELD_M2)
    few = min(max(_FEWEST_AT_END, min(_MOST_AT_END, near.size)), near.size)
    close = near[near.size - few :] if station == stations[steps[-1]] else near[:few]
    end[_STATION], end[_ACROSS] = station, across.mean() - slope * middle
    end[_SLOPE], end[_LOWER] = slope, np.median(positions[close, 1])


@kernel
def joins_kernel(
    ends: _Floats, signs: _Floats, join_m: float, costs: _Floats, pairs: _Integers
) -> int:
    """Tracks that may go on as others; gives how many pairs there are, beyond the room too.

    Parameters
    ----------
    ends : (t, 2, END_COLUMNS)
        Of tracks, as `ends_kernel` fills it.
    signs : (t,)
        1 where the ground rises to the right, else −1.
    join_m : float
        Longest gap between tracks that needn't be long.
    costs, pairs : (k,), (k, 2)
        Filled: how badly they go on, and the two.
    """
    count = 0
    order = np.argsort(ends[:, 0, _STATION])
    starts = ends[order, 0, _STATION]
    for i in range(ends.shape[0]):
        end = ends[i, 1]
        low = np.searchsorted(starts, end[_STATION] - _BESIDE_M)
        high = np.searchsorted(starts, end[_STATION] + _LONG_M, side="right")
        for j in order[low:high]:
            start = ends[j, 0]
            is_later = (
                ends[i, 0, _STATION] < start[_STATION] and end[_STATION] < ends[j, 1, _STATION]
            )
            if signs[i] != signs[j] or not is_later:
                continue
            cost = _misfit(end, start, join_m)
            if cost < 1.0:
                if count < costs.size:
                    costs[count] = cost + abs(start[_STATION] - end[_STATION])
                    pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return count


@kernel
def _misfit(end: _Floats, start: _Floats, join_m: float) -> float:
    """How badly two ends fit each other: 1 is the most."""
    half = (start[_STATION] - end[_STATION]) / 2
    gap = abs(2 * half)
    off = abs(end[_ACROSS] + end[_SLOPE] * half - start[_ACROSS] + start[_SLOPE] * half)
    turn = abs(end[_SLOPE] - start[_SLOPE])
    most_off, most_turn = _OFF_M + _OFF_PER_M * min(gap, join_m), _END_TURN
    if gap > join_m:
        if min(end[_LENGTH], start[_LENGTH]) < gap / _LONG_SHARE:
            return 2.0
        most_turn = _LONG_TURNS * _END_TURN
    if gap < _SHORT_M:
        most_turn = _SHORT_TURNS * _END_TURN
    low = abs(end[_LOWER] - start[_LOWER]) / (_END_HIGH_M + _END_HIGH_PER_M * gap)
    return float(max(off / most_off, turn / most_turn, low))


@kernel
def smooth_kernel(
    at: _Floats, values: _Floats, weights: _Floats, reach_m: float, positions: _Floats, out: _Floats
) -> None:
    """Robust local straight lines through values along a run.

    Parameters
    ----------
    at, values, weights : (n,)
        Along the run, rising, m; what was measured there; how much it counts, changed here.
    reach_m : float
        How far to either side is looked.
    positions : (k,)
        Where the line is wanted, rising.
    out : (k,)
        Filled; straight on from the nearest where nothing is within reach.
    """
    fitted, off = np.empty(at.size), np.empty(at.size)
    robust = weights.copy()
    for turn in range(_ROUNDS):
        _local_lines(at, values, robust, reach_m, at, fitted)
        for i in range(at.size):
            off[i] = abs(values[i] - fitted[i])
        if turn == _ROUNDS - 1:
            break
        scale = _SPREADS * _OF_MEDIAN * max(np.median(off), _LEAST_OFF_M)
        for i in range(at.size):
            share = off[i] / scale
            robust[i] = weights[i] * (1 - share * share) ** 2 if share < 1 else 0.0
    weights[:] = robust
    _local_lines(at, values, robust, reach_m, positions, out)


@kernel
def _local_lines(
    at: _Floats, values: _Floats, weights: _Floats, reach_m: float, positions: _Floats, out: _Floats
) -> None:
    for k in range(positions.size):
        reach = reach_m
        while True:
            begin = np.searchsorted(at, positions[k] - reach)
            end = np.searchsorted(at, positions[k] + reach)
            w, u, v, uu, uv = 0.0, 0.0, 0.0, 0.0, 0.0
            for i in range(begin, end):
                d = at[i] - positions[k]
                near = 1 - (d / reach) ** 2
                weight = weights[i] * near
                w += weight
                u += weight * d
                v += weight * values[i]
                uu += weight * d * d
                uv += weight * d * values[i]
            if w > _LEAST_WEIGHT or reach > _FARTHEST_M:
                break
            reach *= _WIDER
        spread = uu * w - u * u
        held = (_HELD_SHARE * reach_m * w) ** 2
        if w <= 0:
            out[k] = values[min(max(begin, 0), at.size - 1)]
            continue
        slope = (uv * w - u * v) / (spread + _HELD * held)
        out[k] = (v - slope * u) / w


def warm_up() -> None:
    """Compile the kernels."""
    section, number = np.array([0, 1]), np.empty(2, np.int64)
    zeros, ones = np.zeros(2), np.ones(2)
    link_kernel(section, np.zeros((2, 4)), 0.1, 0.8, number)
    smooth_kernel(zeros + np.arange(2), zeros, ones.copy(), 1.5, ones, np.empty(2))
    ends = np.empty((1, 2, END_COLUMNS))
    ends_kernel(zeros, np.zeros((2, 2)), section, np.array([[0, 2]]), ends)
    joins_kernel(ends, np.ones(1), 2.5, np.empty(1), np.empty((1, 2), np.int64))
