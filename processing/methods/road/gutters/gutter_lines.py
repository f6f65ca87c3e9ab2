"""Where gutters may run: long smooth lines along which notches come regularly.

The equal spacing of Takahashi 2022, section 7.3 c2, asks pairs of notches; here all notches of some
metres are asked at once, by the sum of the waves of their places (a periodogram), so that notches
by chance cancel each other and the gutter stands out where most of its holes were missed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.spatial import cKDTree

from processing.methods.road.gutters.gutter_axis import GutterAxis
from processing.methods.road.gutters.gutter_kernels import (
    Nearness,
    Notched,
    Votes,
    Windows,
    near_kernel,
    waves_kernel,
)
from processing.methods.road.gutters.notches.notches import Notches
from processing.recording.passes import Pass

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Own = tuple[_Floats, _Floats, _Floats, _Floats]  # stations, across, strengths, heights of notches

LENGTHS_M = (0.6, 0.5, 1.0)
"""Lids' lengths met in Japan, m, the usual one first (JIS A 5372; Takahashi 2022, Table 7-2)."""

REACH_M = 8.0
"""How far from the vehicle's path gutters are looked for: what is met at 6.5 m, with a metre and a
half for what the path sways and bends. Of 3,256 lids of 46 streets by heads of any mounting 91 % of
those up to 5.5 m were found, 45 % of those up to 6 m, one of 25 up to 6.5 m and none of 98 beyond:
a beam that comes in so flat hardly enters a hole of 3 cm. Takahashi 2022 found them within some 4
to 5 m (section 7.5)."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_CELL_M = 0.05
"""Cells across the road: a hole's width is two of them."""

_BAND_CELLS = 5
"""Cells across that are asked together, 25 cm: holes of one lid lie hardly farther apart, nor do
their heights."""

_WINDOW_STEP_M = 1.0
_WINDOWS_AT_ONCE = 256
"""From window to window, of which neighbours share nearly all notches; windows at a time, which
bounds the memory."""

_LEAST_WEIGHT = 0.3
"""Weight of notches in a band from which chance is believed: below it one notch would seem regular.
By trial."""

_LEAST_STRENGTH = 0.1
"""As in `gratings`."""

_BEYOND_M = 3.0
"""How much farther its joints are looked for than a line is regular. By trial."""

_SAME_M, _KEY = 0.04, 100_000
"""Notches so near to each other are of one opening, as in equation 7-4 of Takahashi 2022 (hole
length s, Table 7-3); more than there are cells, for the key of both."""

_ABREAST_M = 0.06
"""Both holes of a joint, in oblique rows, lie within so much along the road. By trial."""

_ABOUT_M = 0.34
"""No two joints are nearer, but bars and weeds are: the shortest lid is 0.5 m. By trial."""

_LEAST_VOTE = 0.5
"""Notches that are weaker together have less than a vote. By trial."""

_ASIDE_CELLS = 2
"""How far a gutter moves across the road from window to window, 10 cm: 6°. By trial."""

_CLEAR_M = 0.4
"""To either side of a line no other is looked for: the widest lid's edge."""

_LEAST_WINDOWS = 2
"""Of a line."""

_LINE_WIDE_M = 0.25
"""To each side, in which a line's height is looked for: as far as holes lie."""

_LAYER_M, _LAYERS = 0.02, 101
"""Heights are looked through in layers of this thickness, so many: a metre up and down."""

_LEVEL_M = 10.0
"""Over which a gutter's height above the path changes little. By trial."""

_MORE_REACH_M = 2.0
"""A place may lie nearer to a smoothed path than to the path itself; and so far beyond the reach it
is still told along it."""

_SMOOTHED = 5
"""Windows of a running median and mean: 5 m."""


@dataclass(frozen=True)
class Search:
    """How lines are looked for.

    Attributes
    ----------
    half_m : float
        Half the length of the windows in which waves are summed.
    joints_m : (k,) float64
        Widths of joints between lids to try.
    averaged_m : float
        Half the length over which a line's windows are averaged.
    seed, followed : float
        How regular a line is at its most regular place at least, and elsewhere.
    reach_m : float
        How far from the vehicle's path.
    """

    half_m: float
    joints_m: _Floats
    averaged_m: float
    seed: float
    followed: float
    reach_m: float = REACH_M

    @property
    def cells(self) -> int:
        """How many across the vehicle's path."""
        return round(2 * self.reach_m / _CELL_M) + 1


_JOINTS_M = np.arange(0.0, 0.021, 0.004)
"""Widths of joints tried: up to 2 cm. Over 12 m, 20 lids, a step of 4 mm moves a lid by 8 cm, an
eighth of a wave."""

LONG = Search(half_m=6.0, joints_m=_JOINTS_M, averaged_m=10.0, seed=3.3, followed=2.2)
"""Long lines, of which far and sparse scanners miss most holes: gratings and other lids put waves
out of step, so that windows are short and their powers averaged. How regular a line must be, in
terms of chance, was set by trial; what passes is tested against chance once more
(`gutter_runs`)."""

SHORT = Search(half_m=6.0, joints_m=_JOINTS_M, averaged_m=0.0, seed=6.5, followed=3.0)
"""Short lines, which average out among what is beyond their ends. By trial, as `LONG`."""


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
) -> Iterator[GutterLine]:
    """Lines of gutters along all passes, found from what all drives measured, one after another.

    Parameters
    ----------
    passes : sequence of Pass
        Of all drives; each notch is counted along the longest that it lies beside.
    notches : Notches
        Of all drives.
    search : Search
    bridge_m : float
        How far a line goes on without any regular notch.
    """
    xyz, strength = notches.xyz, notches.strength
    is_free = strength >= _LEAST_STRENGTH
    for one in sorted(passes, key=lambda one: -one.length_m):
        if not is_free.any():
            return
        station, across = _stations_of(one, xyz[is_free], search.reach_m)
        is_beside = np.isfinite(station) & (np.abs(across) <= search.reach_m)
        chosen = np.flatnonzero(is_free)[is_beside]
        is_free[chosen] = False
        if chosen.size:
            own = (station[is_beside], across[is_beside], strength[chosen], xyz[chosen, 2])
            yield from _lines_beside(one, own, search, bridge_m)


def _stations_of(one: Pass, xyz: _Floats, reach_m: float) -> tuple[_Floats, _Floats]:
    """Station and across of places by the nearest part of the path, whoever measured them."""
    vehicle_path = one.vehicle_path.positions[:, :2] + one.origin[:2]
    away, nearest = cKDTree(vehicle_path).query(
        xyz[:, :2], distance_upper_bound=reach_m + _MORE_REACH_M
    )
    station, across = np.full(len(xyz), np.nan), np.full(len(xyz), np.nan)
    near = np.flatnonzero(np.isfinite(away))
    if near.size:
        times = one.time_at(np.asarray(nearest, np.int64)[near] * one.vehicle_path.step_m)
        order = np.argsort(times, kind="stable")
        found = one.stations_of(xyz[near[order]], times[order])
        station[near[order]], across[near[order]] = found
    return station, across


def _lines_beside(one: Pass, own: _Own, search: Search, bridge_m: float) -> Iterator[GutterLine]:
    station, across, strength, _ = own
    cells = np.floor((across + search.reach_m) / _CELL_M).astype(np.int64)
    positions = _one_of_each(station, cells, strength)
    found = _map_of(one, (station[positions], cells[positions], strength[positions]), search)
    for windows, columns in _ridges(found, search, bridge_m):
        regularity = float(found[windows, columns].mean())
        line = _axis_of(one, (windows, columns), own, search)
        yield GutterLine(line, regularity)


def _axis_of(
    one: Pass,
    ridge: tuple[_Integers, _Integers],
    own: _Own,
    search: Search,
) -> GutterAxis:
    windows, columns = ridge
    smooth = _smoothed(columns.astype(np.float64))
    at_m = windows.astype(np.float64) * _WINDOW_STEP_M
    aside_m: _Floats = (smooth + 0.5) * _CELL_M - search.reach_m
    raised = _raised(one, (at_m, aside_m), own, search)
    beyond = search.half_m + _BEYOND_M
    at_m = np.concatenate([[at_m[0] - beyond], at_m, [at_m[-1] + beyond]])
    aside_m, raised = np.pad(aside_m, 1, mode="edge"), np.pad(raised, 1, mode="edge")
    line = one.xyz_at(np.clip(at_m, -search.reach_m, one.length_m + search.reach_m), aside_m)
    line[:, 2] += raised
    return GutterAxis.through(line)


def _raised(
    one: Pass,
    line: tuple[_Floats, _Floats],
    own: _Own,
    search: Search,
) -> _Floats:
    """How far above the path notches near a line come most regularly, about each place of it, m.

    A walk beside a gutter lies a curb higher, a field lower, each with notches of its own.
    """
    at_m, aside_m = line
    station, across, strength, height = own
    near = np.flatnonzero(
        (station >= at_m[0] - search.half_m) & (station <= at_m[-1] + search.half_m)
    )
    is_on = np.abs(across[near] - np.interp(station[near], at_m, aside_m)) <= _LINE_WIDE_M
    # A line that was smoothed may lie beside its own notches.
    near = near[is_on] if is_on.any() else near
    raised = height[near] - one.xyz_at(station[near], across[near])[:, 2]
    middle = float(np.median(raised))
    layers = np.floor((raised - middle) / _LAYER_M).astype(np.int64) + _LAYERS // 2
    inside = (layers >= 0) & (layers < _LAYERS)
    near, layers = near[inside], layers[inside]
    chosen = _one_of_each(station[near], layers, strength[near])
    near, layers = near[chosen], layers[chosen]
    votes = _votes(station[near], layers, strength[near])
    power = _power((station[near] - at_m[0], layers, votes), np.ones((at_m.size, _LAYERS)), search)
    size = 2 * round(_LEVEL_M / _WINDOW_STEP_M) + 1
    best = uniform_filter1d(power, size, axis=0, mode="nearest").argmax(axis=1)
    level: _Floats = middle + (best - _LAYERS // 2 + 0.5) * _LAYER_M
    return _smoothed(level)


def _one_of_each(station: _Floats, cells: _Integers, strength: _Floats) -> _Integers:
    """The strongest notch of each opening in each cell, by rising station."""
    rough = np.floor(station / _SAME_M).astype(np.int64)
    order = np.lexsort((-strength, cells, rough))
    keys = rough[order] * _KEY + cells[order]
    chosen: _Integers = order[np.concatenate([[True], np.diff(keys) > 0])]
    return chosen[np.argsort(station[chosen], kind="stable")]


def _votes(station: _Floats, cells: _Integers, strength: _Floats) -> Votes:
    """Weights by which all notches about a place have one vote together, where they are strong.

    So the many bars of a grating, or weeds, count no more than a joint that lies alone.
    """
    about, abreast = np.empty(station.size), np.empty(station.size)
    near_kernel(Notched(station, cells, strength), Nearness(_ABOUT_M, _BAND_CELLS // 2), about)
    worth = strength / np.maximum(about, _LEAST_VOTE)
    near_kernel(Notched(station, cells, worth), Nearness(_ABREAST_M, _BAND_CELLS // 2), abreast)
    return Votes(worth, abreast)


def _map_of(one: Pass, own: tuple[_Floats, _Integers, _Floats], search: Search) -> _Floats:
    """(w, c) how regular notches are about every place beside a pass."""
    station, cells, strength = own
    windows = int(one.length_m / _WINDOW_STEP_M) + 2
    inside = np.clip(cells, 0, search.cells - 1)
    regularity = np.zeros((windows, search.cells))
    for first in range(0, windows, _WINDOWS_AT_ONCE):
        stop = min(first + _WINDOWS_AT_ONCE, windows)
        ends = np.array([first, stop]) * _WINDOW_STEP_M + [-search.half_m, search.half_m]
        near = slice(*np.searchsorted(station, ends))
        votes = _votes(station[near], inside[near], strength[near])
        part = (station[near] - first * _WINDOW_STEP_M, inside[near], votes)
        regularity[first:stop] = _power(part, _scales(one, (first, stop), search), search)
    if search.averaged_m == 0.0:
        return regularity
    size = 2 * round(search.averaged_m / _WINDOW_STEP_M) + 1
    beside = maximum_filter1d(regularity, 3, axis=1)
    pooled: _Floats = uniform_filter1d(beside, size, axis=0, mode="nearest")
    return pooled


def _scales(one: Pass, windows: tuple[int, int], search: Search) -> _Floats:
    """(w, c) how long a metre of the path is in each cell: more or less in bends."""
    at = np.arange(windows[0], windows[1] + 1) * _WINDOW_STEP_M
    sides = []
    for aside in (-search.reach_m, search.reach_m):
        edge = one.xyz_at(at, np.full(at.size, aside))
        sides.append(np.hypot(*np.diff(edge[:, :2], axis=0).T) / _WINDOW_STEP_M)
    share = np.linspace(0.0, 1.0, search.cells)[None, :]
    scales: _Floats = sides[0][:, None] * (1 - share) + sides[1][:, None] * share
    return scales


def _power(own: tuple[_Floats, _Integers, Votes], scales: _Floats, search: Search) -> _Floats:
    """(w, c) the most of the periodogram, 1 on average where joints lie by chance."""
    pitches = (np.array(LENGTHS_M)[:, None] + search.joints_m[None, :]).ravel()
    waves = np.zeros((*scales.shape, pitches.size), np.complex128)
    weights = np.zeros(scales.shape)
    waves_kernel(*own, scales, pitches, Windows(_WINDOW_STEP_M, search.half_m), waves, weights)
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
    left: _Floats, start: tuple[int, int], stride: tuple[int, int], least: float
) -> list[tuple[int, int]]:
    """Windows and cells from a start on; the stride: step from window to window, longest bridge."""
    step, bridge = stride
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
    padded = np.pad(values, _SMOOTHED // 2, mode="edge")
    middle = np.median(np.lib.stride_tricks.sliding_window_view(padded, _SMOOTHED), axis=1)
    return uniform_filter1d(middle, _SMOOTHED, mode="nearest")
