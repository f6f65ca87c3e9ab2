"""Loops that link steps of scanlines to tracks along the path, and join and smooth tracks.

A track is followed from scanline to scanline: its place and direction are predicted, the step that
fits best is taken, and the prediction is made better by it (an alpha-beta filter), so that a step
is followed round bends and wide corners without any search.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_GAIN, _TURN_GAIN = 0.5, 0.12
_NEAR_M, _TURN = 0.05, 0.12  # how far off the prediction: at once, and per metre and for new tracks
_NEW_TURN = 1.0
_YOUNG = 4
_MOST_OFF_M = 0.20
_HIGH_M, _HIGH_PER_M = (
    0.05,
    0.1,
)  # how far heights may differ from one scanline to the next; grows with the gap
_MOST_ACTIVE = 512
_LAST, _NUMBER, _AGE = range(3)  # scanline of a track's last step, its number, its steps
_STATION, _ACROSS, _SLOPE, _LOWER, _LENGTH = range(5)
END_COLUMNS = 5
"""Of one end of a track, as a straight line over its last metres: station, place across there, m;
slope, m per m; height of the lower edge; length of the whole track, m."""

_END_M = 3.0  # what tells the direction of an end
_OFF_M, _OFF_PER_M, _END_TURN = 0.05, 0.04, 0.12
_END_HIGH_M, _END_HIGH_PER_M = 0.05, 0.03
_BESIDE_M = 3.0  # tracks of one low step may go on beside each other
_LONG_M = 8.0  # longest gap that is bridged where both sides lie on one line: a parked lorry
_ROUNDS = 3
_SPREADS = 3.0


@kernel
def link_kernel(section: _Integers, steps: _Floats, limits: _Floats, track: _Integers) -> int:
    """Number the tracks that steps belong to.

    Parameters
    ----------
    section : (n,)
        Scanline of each step, not decreasing.
    steps : (n, 4)
        Middle of the face across, heights of the edges about the road, m; 1 where the ground rises
        to the right, else −1.
    limits : (2,)
        Between scanlines; the longest gap within a track; m.
    track : (n,)
        Filled.

    Returns
    -------
    int
        How many tracks there are.
    """
    spacing, most_gap = limits[0], int(limits[1] / limits[0])
    counts = np.empty((_MOST_ACTIVE, 3), np.int64)
    state = np.empty((_MOST_ACTIVE, 5))
    tables = (state, counts, np.zeros(_MOST_ACTIVE, np.bool_))
    active, tracks, begin = 0, 0, 0
    track[:] = -1
    while begin < section.size:
        here = section[begin]
        end = begin
        while end < section.size and section[end] == here:
            end += 1
        active = _forget(tables, active, here, most_gap)
        for _ in range(end - begin):
            best = (1.0, -1, -1)
            for i in range(begin, end):
                if track[i] < 0:
                    best = _better(tables, active, (i, here, spacing), steps[i], best)
            i, k = best[1], best[2]
            if i < 0:
                break
            _go_on(state[k], (here - counts[k, _LAST]) * spacing, counts[k, _AGE], steps[i])
            counts[k, _LAST] = here
            counts[k, _AGE] += 1
            tables[2][k] = True
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
    tables: tuple[_Floats, _Integers, NDArray[np.bool_]],
    active: int,
    which: tuple[int, int],
    step: _Floats,
) -> int:
    """Put a new track into the tables; gives how many there are."""
    state, counts, _ = tables
    if active == _MOST_ACTIVE:
        return active
    counts[active, _LAST], counts[active, _NUMBER], counts[active, _AGE] = which[0], which[1], 0
    state[active, 0], state[active, 1] = step[0], 0.0
    state[active, 2:] = step[1:]
    return active + 1


@kernel
def _forget(
    tables: tuple[_Floats, _Integers, NDArray[np.bool_]], active: int, here: int, most_gap: int
) -> int:
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
    tables: tuple[_Floats, _Integers, NDArray[np.bool_]],
    active: int,
    where: tuple[int, int, float],
    found: _Floats,
    best: tuple[float, int, int],
) -> tuple[float, int, int]:
    """Cost, step and track of the best pair so far, a further step being looked at."""
    state, counts, taken = tables
    step, here, spacing = where
    for k in range(active):
        if not taken[k] and state[k, 4] == found[3]:
            gap = (here - counts[k, _LAST]) * spacing
            cost = _cost(state[k], gap, counts[k, _AGE], found)
            if cost < best[0]:
                best = (cost, step, k)
    return best


@kernel
def _go_on(state: _Floats, gap: float, age: int, found: _Floats) -> None:
    """Make a track's prediction better by the step that was found."""
    predicted = state[0] + state[1] * gap
    off = found[0] - predicted
    gain, turn = _GAIN, _TURN_GAIN
    if age < _YOUNG:
        gain, turn = 1.0 / (1.0 + 0.25 * age), 0.5 / (1.0 + age)
    state[0] = predicted + gain * off
    state[1] += turn * off / max(gap, 0.1) if gap < 0.5 else turn * off
    state[2] += 0.5 * (found[1] - state[2])
    state[3] += 0.5 * (found[2] - state[3])


@kernel
def _cost(state: _Floats, gap: float, age: int, found: _Floats) -> float:
    """How badly a step goes on a track: 1 is the most."""
    turn = _NEW_TURN if age < _YOUNG else _TURN
    most = min(_NEAR_M + turn * gap, _MOST_OFF_M)
    off = abs(found[0] - state[0] - state[1] * gap) / most
    high = _HIGH_M + _HIGH_PER_M * gap
    low_off, up_off = abs(found[1] - state[2]) / high, abs(found[2] - state[3]) / (2 * high)
    return float(max(off, low_off, up_off) * 0.5 + (off + low_off + up_off) / 6)


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
    slope = ((away - middle) * across).sum() / (((away - middle) ** 2).sum() + 0.3)
    few = min(max(3, min(10, near.size)), near.size)
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
        tail = ends[i, 1]
        low = np.searchsorted(starts, tail[_STATION] - _BESIDE_M)
        high = np.searchsorted(starts, tail[_STATION] + _LONG_M, side="right")
        for j in order[low:high]:
            head = ends[j, 0]
            is_later = ends[i, 0, _STATION] < head[_STATION] and tail[_STATION] < ends[j, 1, 0]
            if signs[i] != signs[j] or not is_later:
                continue
            cost = _misfit(tail, head, join_m)
            if cost < 1.0:
                if count < costs.size:
                    costs[count] = cost + abs(head[_STATION] - tail[_STATION])
                    pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return count


@kernel
def _misfit(tail: _Floats, head: _Floats, join_m: float) -> float:
    """How badly two ends fit each other: 1 is the most."""
    half = (head[_STATION] - tail[_STATION]) / 2
    gap = abs(2 * half)
    off = abs(tail[_ACROSS] + tail[_SLOPE] * half - head[_ACROSS] + head[_SLOPE] * half)
    turn = abs(tail[_SLOPE] - head[_SLOPE])
    most_off, most_turn = _OFF_M + _OFF_PER_M * min(gap, join_m), _END_TURN
    if gap > join_m:
        if min(tail[_LENGTH], head[_LENGTH]) < gap / 3:
            return 2.0
        most_turn = _END_TURN / 2
    if gap < 1.0:
        most_turn = 3 * _END_TURN
    low = abs(tail[_LOWER] - head[_LOWER]) / (_END_HIGH_M + _END_HIGH_PER_M * gap)
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
        scale = _SPREADS * 1.5 * max(np.median(off), 0.002)
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
            if w > 1e-3 or reach > 100:
                break
            reach *= 1.5
        spread = uu * w - u * u
        held = (0.2 * reach_m * w) ** 2
        if w <= 0:
            out[k] = values[min(max(begin, 0), at.size - 1)]
            continue
        slope = (uv * w - u * v) / (spread + 0.02 * held)
        out[k] = (v - slope * u) / w


def warm_up() -> None:
    """Compile the kernels."""
    section, number = np.array([0, 1]), np.empty(2, np.int64)
    zeros, ones = np.zeros(2), np.ones(2)
    link_kernel(section, np.zeros((2, 4)), np.array([0.1, 0.8]), number)
    smooth_kernel(zeros + np.arange(2), zeros, ones.copy(), 1.5, ones, np.empty(2))
    ends = np.empty((1, 2, END_COLUMNS))
    ends_kernel(zeros, np.zeros((2, 2)), section, np.array([[0, 2]]), ends)
    joins_kernel(ends, np.ones(1), 2.5, np.empty(1), np.empty((1, 2), np.int64))
