"""Where gutters may run: long smooth lines beside the way along which notches come regularly.

The thesis' equal spacing (mms.md, 7.3 c2) asks pairs of notches; here all notches of some metres
are asked at once, by the sum of the waves of their places (a periodogram), so that notches by
chance cancel each other and the gutter stands out where most of its holes were missed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter, uniform_filter1d
from scipy.spatial import cKDTree

from processing.points.passes import Pass
from processing.road.gutters.gutter_axis import GutterAxis
from processing.road.gutters.gutter_kernels import waves_kernel
from processing.road.gutters.notches import Notches

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

LENGTHS_M = (0.6, 0.5, 1.0)
"""Lids' lengths met in Japan, the usual one first (JIS A 5372; mms.md, Table 7-2)."""

_REACH_M = 6.5
_CELL_M = 0.05
_COUNT = round(2 * _REACH_M / _CELL_M) + 1
_BAND_CELLS = 9  # holes of one lid lie at most so many cells apart
_WINDOW_STEP_M = 1.0
_WINDOWS_AT_ONCE = 256
_LEAST_WEIGHT = 0.3
_LEAST_STRENGTH = 0.1
_BEYOND_M = 3.0  # how much farther its joints are looked for than a line is regular
_SAME_M = 0.04  # notches so near to each other are of one opening
_ABOUT_M = 0.3  # no two joints are nearer, but bars and weeds are
_BIN_M = 0.04
_LEAST_VOTE = 0.5  # notches that are weaker together have less than a vote
_ASIDE_CELLS = 2  # how far a gutter moves across the road from window to window
_CLEAR_M = 0.4
_LEAST_WINDOWS = 2


@dataclass(frozen=True)
class Search:
    """How lines are looked for.

    Attributes
    ----------
    half_m : float
        Half the length of the windows in which waves are summed.
    joints_m : (k,) float64
        Widths of joints between lids to try.
    pooled_m : float
        Half the length over which a line's windows are averaged.
    seed, followed : float
        How regular a line is at its most regular place at least, and elsewhere.
    """

    half_m: float
    joints_m: _Floats
    pooled_m: float
    seed: float
    followed: float


LONG = Search(6.0, np.arange(0.0, 0.021, 0.004), 10.0, 3.3, 2.2)
"""Long lines, of which far and sparse scanners miss most holes: gratings and other lids put waves
out of step, so that windows are short and their powers averaged."""
SHORT = Search(6.0, np.arange(0.0, 0.021, 0.004), 0.0, 6.5, 3.0)
"""Short lines, which average out among what is beyond their ends."""


@dataclass(frozen=True)
class GutterLine:
    """A line along which notches come regularly.

    Attributes
    ----------
    axis : GutterAxis
        About in the middle of the holes.
    regularity : float
        Mean over the line of the periodogram: 1 where notches come by chance.
    """

    axis: GutterAxis
    regularity: float


def gutter_lines(
    passes: Sequence[Pass], notches: Notches, search: Search, bridge_m: float
) -> tuple[GutterLine, ...]:
    """Lines of gutters along all passes, found from what all drives measured.

    Parameters
    ----------
    passes : sequence of Pass
        Of all drives; each notch is told along the longest that it lies beside.
    notches : Notches
        Of all drives.
    search : Search
    bridge_m : float
        How far a line goes on without any regular notch.
    """
    xyz, strength = notches.xyz, notches.strength
    is_free = strength >= _LEAST_STRENGTH
    lines: list[GutterLine] = []
    for one in sorted(passes, key=lambda one: -one.length_m):
        if not is_free.any():
            break
        station, across = _told(one, xyz[is_free])
        is_beside = np.isfinite(station) & (np.abs(across) <= _REACH_M)
        chosen = np.flatnonzero(is_free)[is_beside]
        is_free[chosen] = False
        if chosen.size:
            own = (station[is_beside], across[is_beside], strength[chosen], xyz[chosen, 2])
            lines += _lines_beside(one, own, search, bridge_m)
    return tuple(lines)


def _told(one: Pass, xyz: _Floats) -> tuple[_Floats, _Floats]:
    """Station and across of places by the nearest part of the way, whoever measured them."""
    way = one.way.places[:, :2] + one.origin[:2]
    away, nearest = cKDTree(way).query(xyz[:, :2], distance_upper_bound=_REACH_M + 2.0)
    station, across = np.full(len(xyz), np.nan), np.full(len(xyz), np.nan)
    near = np.flatnonzero(np.isfinite(away))
    if near.size:
        times = one.time_at(np.asarray(nearest, np.int64)[near] * one.way.step_m)
        order = np.argsort(times, kind="stable")
        found = one.stations_of(xyz[near[order]], times[order])
        station[near[order]], across[near[order]] = found
    return station, across


def _lines_beside(
    one: Pass, own: tuple[_Floats, _Floats, _Floats, _Floats], search: Search, bridge_m: float
) -> Iterator[GutterLine]:
    station, across, strength, height = own
    cells = np.floor((across + _REACH_M) / _CELL_M).astype(np.int64)
    places = _one_of_each(station, cells, strength)
    places = places[np.argsort(station[places], kind="stable")]
    height_of = cKDTree(np.column_stack([station, across]))
    found = _map_of(one, (station[places], cells[places], strength[places]), search)
    for windows, columns in _ridges(found, search, bridge_m):
        regularity = float(found[windows, columns].mean())
        line = _axis_of(one, (windows, columns), (height_of, height), search.half_m)
        yield GutterLine(line, regularity)


def _axis_of(
    one: Pass,
    ridge: tuple[_Integers, _Integers],
    heights: tuple[cKDTree, _Floats],
    half_m: float,
) -> GutterAxis:
    windows, columns = ridge
    height_of, height = heights
    smooth = _smoothed(columns.astype(np.float64))
    at_m, aside_m = windows * _WINDOW_STEP_M, (smooth + 0.5) * _CELL_M - _REACH_M
    at_m = np.concatenate([[at_m[0] - half_m - _BEYOND_M], at_m, [at_m[-1] + half_m + _BEYOND_M]])
    aside_m = np.concatenate([[aside_m[0]], aside_m, [aside_m[-1]]])
    at_m = np.clip(at_m, -_REACH_M, one.length_m + _REACH_M)
    line = one.xyz_at(at_m, aside_m)
    _, near = height_of.query(np.column_stack([at_m, aside_m]), k=min(9, height.size))
    line[:, 2] = np.median(height[np.asarray(near).reshape(len(at_m), -1)], axis=1)
    return GutterAxis.through(line)


def _one_of_each(station: _Floats, cells: _Integers, strength: _Floats) -> _Integers:
    """The strongest notch of each opening in each cell, by rising station."""
    rough = np.floor(station / _SAME_M).astype(np.int64)
    order = np.lexsort((-strength, cells, rough))
    keys = rough[order] * 100_000 + cells[order]
    chosen: _Integers = order[np.concatenate([[True], np.diff(keys) > 0])]
    return chosen


def _votes(station: _Floats, cells: _Integers, strength: _Floats) -> tuple[_Floats, _Floats]:
    """Weights by which all notches about a place have one vote together, where they are strong.

    So the many bars of a grating, or weeds, count no more than a joint that lies alone.

    Returns
    -------
    worth, abreast : (n,) float64
        Of each, and of all that lie side by side with it: of the two holes of a joint.
    """
    bins = ((station - station.min(initial=0.0)) / _BIN_M).astype(np.int64)
    size = int(bins.max(initial=0)) + 1

    def summed(values: _Floats, along_m: float) -> _Floats:
        flat = np.bincount(bins * _COUNT + cells, values, minlength=size * _COUNT)
        window = 2 * round(along_m / _BIN_M) + 1, _BAND_CELLS
        even = uniform_filter(flat.reshape(size, _COUNT), window, mode="constant")
        return np.asarray(even[bins, cells] * (window[0] * window[1]), np.float64)

    worth = strength / np.maximum(summed(strength, _ABOUT_M), _LEAST_VOTE)
    return worth, summed(worth, _SAME_M)


def _map_of(one: Pass, own: tuple[_Floats, _Integers, _Floats], search: Search) -> _Floats:
    """(w, c) how regular notches are about every place beside a pass."""
    station, cells, strength = own
    windows = int(one.length_m / _WINDOW_STEP_M) + 2
    inside = np.clip(cells, 0, _COUNT - 1)
    regularity = np.zeros((windows, _COUNT))
    for first in range(0, windows, _WINDOWS_AT_ONCE):
        stop = min(first + _WINDOWS_AT_ONCE, windows)
        ends = np.array([first, stop]) * _WINDOW_STEP_M + [-search.half_m, search.half_m]
        near = slice(*np.searchsorted(station, ends))
        votes = _votes(station[near], inside[near], strength[near])
        part = (station[near] - first * _WINDOW_STEP_M, inside[near], votes)
        regularity[first:stop] = _power(part, _scales(one, first, stop, _COUNT), search)
    if search.pooled_m == 0.0:
        return regularity
    size = 2 * round(search.pooled_m / _WINDOW_STEP_M) + 1
    beside = maximum_filter1d(regularity, 3, axis=1)
    pooled: _Floats = uniform_filter1d(beside, size, axis=0, mode="nearest")
    return pooled


def _scales(one: Pass, first: int, stop: int, count: int) -> _Floats:
    """(w, c) how long a metre of the way is in each cell: more or less in bends."""
    at = np.arange(first, stop + 1) * _WINDOW_STEP_M
    sides = []
    for aside in (-_REACH_M, _REACH_M):
        edge = one.xyz_at(at, np.full(at.size, aside))
        sides.append(np.hypot(*np.diff(edge[:, :2], axis=0).T) / _WINDOW_STEP_M)
    share = np.linspace(0.0, 1.0, count)[None, :]
    scales: _Floats = sides[0][:, None] * (1 - share) + sides[1][:, None] * share
    return scales


def _power(
    own: tuple[_Floats, _Integers, tuple[_Floats, _Floats]], scales: _Floats, search: Search
) -> _Floats:
    """(w, c) the most of the periodogram, 1 on average where joints lie by chance."""
    pitches = (np.array(LENGTHS_M)[:, None] + search.joints_m[None, :]).ravel()
    waves = np.zeros((*scales.shape, pitches.size), np.complex128)
    weights = np.zeros(scales.shape)
    waves_kernel(*own, scales, pitches, (_WINDOW_STEP_M, search.half_m), waves, weights)
    band = uniform_filter1d(waves, _BAND_CELLS, axis=1, mode="constant") * _BAND_CELLS
    chance = uniform_filter1d(weights, _BAND_CELLS, axis=1, mode="constant") * _BAND_CELLS
    power = (np.abs(band) ** 2).max(axis=2) / np.maximum(chance, _LEAST_WEIGHT)
    return np.asarray(power, np.float64)


def _ridges(
    regularity: _Floats, search: Search, bridge_m: float
) -> Iterator[tuple[_Integers, _Integers]]:
    """Windows and cells of each line, the most regular first."""
    left = regularity.copy()
    clear = round(_CLEAR_M / _CELL_M)
    bridge = max(1, int(bridge_m / _WINDOW_STEP_M))
    while left.size:
        most = np.unravel_index(int(left.argmax()), left.shape)
        if left[most] < search.seed:
            return
        start = int(most[0]), int(most[1])
        ahead = _followed(left, start, (1, bridge), search.followed)
        behind = _followed(left, start, (-1, bridge), search.followed)
        path = np.array(behind[:0:-1] + ahead)
        for window, cell in path:
            left[window, max(0, cell - clear) : cell + clear + 1] = 0.0
        if len(path) >= _LEAST_WINDOWS:
            yield path[:, 0], path[:, 1]


def _followed(
    left: _Floats, start: tuple[int, int], way: tuple[int, int], least: float
) -> list[tuple[int, int]]:
    step, bridge = way
    path, missed, last = [start], 0, 1
    window, cell = start
    while 0 <= window + step < len(left) and missed < bridge:
        window += step
        low = max(0, cell - _ASIDE_CELLS)
        near = left[window, low : cell + _ASIDE_CELLS + 1]
        if near.max() >= least:
            cell, missed = low + int(near.argmax()), 0
        else:
            missed += 1
        path.append((window, cell))
        last = len(path) if missed == 0 else last
    return path[:last]


def _smoothed(values: _Floats) -> _Floats:
    padded = np.pad(values, 2, mode="edge")
    middle = np.median(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=1)
    return uniform_filter1d(middle, 5, mode="nearest")
