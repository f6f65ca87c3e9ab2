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
from scipy.ndimage import uniform_filter1d
from scipy.spatial import cKDTree

from processing.points.passes import Pass
from processing.road.gutter_axis import GutterAxis
from processing.road.gutter_kernels import waves_kernel
from processing.road.notches import Notches

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Bools = NDArray[np.bool_]

LENGTHS_M = (0.6, 0.5, 1.0)
"""Lids' lengths met in Japan, the usual one first (JIS A 5372; mms.md, Table 7-2)."""

_REACH_M = 6.5
_CELL_M = 0.05
_COUNT = round(2 * _REACH_M / _CELL_M) + 1
_BAND_CELLS = 9  # holes of one lid lie at most so many cells apart
_WINDOW_STEP_M, _WINDOW_HALF_M = 1.0, 3.0
# Half lengths of windows, and joints between lids to try: short ones for bends and where lengths
# change, long ones for sparse scanners that miss most of the holes; and how regular a line is at
# its most regular place at least.
_WINDOWS = (
    (_WINDOW_HALF_M, np.arange(0.002, 0.025, 0.006), 8.0),
    (6.0, np.arange(0.0, 0.021, 0.004), 7.0),
)
_WINDOWS_AT_ONCE = 256
_LEAST_WEIGHT = 3.0
_LEAST_STRENGTH = 0.1
_BEYOND_M = 3.0  # how much farther its joints are looked for than a line is regular
_SAME_M = 0.04  # notches so near to each other are of one opening
_MOST_ABREAST = 4.0  # cells that the two holes of a joint take
_ASIDE_CELLS = 2  # how far a gutter moves across the road from window to window
_CLEAR_M = 0.6
_FOLLOWED = 3.5
_LEAST_WINDOWS = 2


@dataclass(frozen=True)
class GutterLine:
    """A line along which notches come regularly.

    Attributes
    ----------
    axis : GutterAxis
        About in the middle of the holes.
    length_m : float
        Of the lids, as their spacing tells.
    regularity : float
        Mean over the line of the periodogram: 1 where notches come by chance.
    """

    axis: GutterAxis
    length_m: float
    regularity: float


@dataclass(frozen=True)
class _Map:
    """Regularity about every place beside a pass: (w, c) each."""

    regularity: _Floats
    length: _Integers


def gutter_lines(
    passes: Sequence[Pass], notches: Sequence[Notches], bridge_m: float
) -> tuple[GutterLine, ...]:
    """Lines of gutters along all passes, found from what all drives measured.

    Parameters
    ----------
    passes : sequence of Pass
        Of all drives; each notch is told along the longest that it lies beside.
    notches : sequence of Notches
        Of each drive.
    bridge_m : float
        How far a line goes on without any regular notch.
    """
    xyz = np.vstack([one.xyz for one in notches]) if notches else np.empty((0, 3))
    strength = np.concatenate([one.strength for one in notches]) if notches else np.empty(0)
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
            lines += _lines_beside(one, own, bridge_m)
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
    one: Pass, own: tuple[_Floats, _Floats, _Floats, _Floats], bridge_m: float
) -> Iterator[GutterLine]:
    station, across, strength, height = own
    cells = np.floor((across + _REACH_M) / _CELL_M).astype(np.int64)
    places = _one_of_each(station, cells, strength)
    places = places[np.argsort(station[places], kind="stable")]
    height_of = cKDTree(np.column_stack([station, across]))
    taken = np.zeros((int(one.length_m / _WINDOW_STEP_M) + 2, _COUNT), np.bool_)
    for half_m, joints, seed in _WINDOWS:
        found = _map_of(one, (station[places], cells[places], strength[places]), half_m, joints)
        for windows, columns in _ridges(found.regularity, taken, seed, bridge_m):
            yield _line_of(one, found, (windows, columns), (height_of, height), half_m)


def _line_of(
    one: Pass,
    found: _Map,
    ridge: tuple[_Integers, _Integers],
    heights: tuple[cKDTree, _Floats],
    half_m: float,
) -> GutterLine:
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
    votes = np.bincount(found.length[windows, columns], minlength=len(LENGTHS_M))
    return GutterLine(
        GutterAxis.through(line),
        LENGTHS_M[int(votes.argmax())],
        float(found.regularity[windows, columns].mean()),
    )


def _one_of_each(station: _Floats, cells: _Integers, strength: _Floats) -> _Integers:
    """The strongest notch of each opening in each cell, by rising station."""
    rough = np.floor(station / _SAME_M).astype(np.int64)
    order = np.lexsort((-strength, cells, rough))
    keys = rough[order] * 100_000 + cells[order]
    chosen: _Integers = order[np.concatenate([[True], np.diff(keys) > 0])]
    return chosen


def _worth(station: _Floats, cells: _Integers, strength: _Floats) -> _Floats:
    """Weights by which what lies side by side counts as the two holes of one joint at most."""
    near = cKDTree(np.column_stack([station / _SAME_M, cells / (_BAND_CELLS - 1)]))
    pairs = near.query_pairs(1.0, p=np.inf, output_type="ndarray")
    abreast = strength + np.bincount(pairs[:, 0], strength[pairs[:, 1]], minlength=strength.size)
    abreast += np.bincount(pairs[:, 1], strength[pairs[:, 0]], minlength=strength.size)
    worth: _Floats = np.minimum(1.0, _MOST_ABREAST / np.maximum(abreast, 1e-9))
    return worth


def _map_of(
    one: Pass, own: tuple[_Floats, _Integers, _Floats], half_m: float, joints: _Floats
) -> _Map:
    station, cells, strength = own
    windows = int(one.length_m / _WINDOW_STEP_M) + 2
    inside = np.clip(cells, 0, _COUNT - 1)
    worth = strength * _worth(station, cells, strength)
    regularity = np.zeros((windows, _COUNT))
    length = np.zeros((windows, _COUNT), np.int64)
    for first in range(0, windows, _WINDOWS_AT_ONCE):
        stop = min(first + _WINDOWS_AT_ONCE, windows)
        ends = first * _WINDOW_STEP_M - half_m, stop * _WINDOW_STEP_M + half_m
        near = slice(*np.searchsorted(station, ends))
        part = (station[near] - first * _WINDOW_STEP_M, inside[near], worth[near])
        power = _power(part, _scales(one, first, stop, _COUNT), half_m, joints)
        regularity[first:stop], length[first:stop] = power.max(axis=2), power.argmax(axis=2)
    return _Map(regularity, length)


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
    own: tuple[_Floats, _Integers, _Floats], scales: _Floats, half_m: float, joints: _Floats
) -> _Floats:
    """(w, c, l) the periodogram for each length of lids, 1 where notches come by chance."""
    windows, count = scales.shape
    pitches = (np.array(LENGTHS_M)[:, None] + joints[None, :]).ravel()
    waves = np.zeros((windows, count, pitches.size), np.complex128)
    weights = np.zeros((windows, count))
    waves_kernel(*own, scales, pitches, (_WINDOW_STEP_M, half_m), waves, weights)
    band = uniform_filter1d(waves, _BAND_CELLS, axis=1, mode="constant") * _BAND_CELLS
    all_weights = uniform_filter1d(weights, _BAND_CELLS, axis=1, mode="constant") * _BAND_CELLS
    power = np.abs(band) ** 2 / np.maximum(all_weights, _LEAST_WEIGHT)[:, :, None]
    by_length = power.reshape(windows, count, len(LENGTHS_M), -1).max(axis=3)
    # Lids of 1 m are regular at half their spacing too; the other way round they are not.
    is_whole = by_length[:, :, 2] > 0.6 * by_length[:, :, 1]
    by_length[:, :, 1] = np.where(is_whole, 0.0, by_length[:, :, 1])
    return np.asarray(by_length, np.float64)


def _ridges(
    regularity: _Floats, taken: _Bools, seed: float, bridge_m: float
) -> Iterator[tuple[_Integers, _Integers]]:
    """Windows and cells of each line, the most regular first; marks what they take."""
    left = np.where(taken, 0.0, regularity)
    clear = round(_CLEAR_M / _CELL_M)
    bridge = max(1, int(bridge_m / _WINDOW_STEP_M))
    while left.size:
        most = np.unravel_index(int(left.argmax()), left.shape)
        if left[most] < seed:
            return
        start = int(most[0]), int(most[1])
        ahead = _followed(left, start, 1, bridge)
        behind = _followed(left, start, -1, bridge)
        path = np.array(behind[:0:-1] + ahead)
        for window, cell in path:
            beside = slice(max(0, cell - clear), cell + clear + 1)
            left[window, beside] = 0.0
            taken[window, beside] = True
        if len(path) >= _LEAST_WINDOWS:
            yield path[:, 0], path[:, 1]


def _followed(
    left: _Floats, start: tuple[int, int], way: int, bridge: int
) -> list[tuple[int, int]]:
    path, missed, last = [start], 0, 1
    window, cell = start
    while 0 <= window + way < len(left) and missed < bridge:
        window += way
        low = max(0, cell - _ASIDE_CELLS)
        near = left[window, low : cell + _ASIDE_CELLS + 1]
        if near.max() >= _FOLLOWED:
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
