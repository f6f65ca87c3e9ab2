"""Curbs that run across the vehicle's path: side streets, corners of small radius, ends of islands.

Scanlines run along such curbs and don't show them. The same surface is therefore cut square to the
scanlines too: lines of constant distance from the vehicle's path, through the heights of all
scanlines of a stretch. What is found there is a run from left to right.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.image.scan_lines.scanlines import Scanlines
from processing.methods.road.curbs.steps.curb_chains import chains_of
from processing.methods.road.curbs.steps.curb_profile import PassSteps, StepSettings, steps_on_lines
from processing.methods.road.curbs.steps.curb_runs import StepRun, run_of
from processing.methods.road.curbs.steps.level_kernels import LevelGrid, levels_kernel
from processing.methods.road.curbs.steps.step_columns import LOWER_ACROSS, VERTEX
from processing.methods.road.curbs.steps.step_kernels import CELL_M

Floats = NDArray[np.float64]

_SPACING_M = 0.1
"""Between lines of constant distance from the vehicle's path: as far as scanlines are apart, so
that curbs across the path are sampled as those along it."""

_HALF_M = 15.0
"""How far to either side: as far as scanlines reach (`ScanlineSettings`)."""

_TOGETHER, _OVERLAP = 600, 40
"""Scanlines that are looked at together: 60 m, which bounds the memory. So many of them are seen
twice, 4 m: a step needs ground on both sides."""

_STEEPEST = 1.2
"""Runs that turn from square across by more (tangent: 50°) are found on the scanlines themselves. A
little over 45°, so that no direction is left out between the two looks."""

_GRID_M = _SPACING_M / math.sqrt(12)
"""How far an edge on lines of points `_SPACING_M` apart lies off by that alone: the standard
deviation of a uniform distribution of that width."""

_DENSER = math.sqrt(_SPACING_M / CELL_M)
"""Of scanlines every cell holds points, of these lines one in so many (squared): what is known of
foot and top is worse by it, and says nothing against a curb."""

_LEAST_SPREAD_M = 0.01
"""What is left of a run's spread without `_GRID_M` is known no better than this. By trial."""

_MARGIN_M = 0.1
"""Beyond the outermost place, so that it falls into a cell: one spacing of scanlines."""


@dataclass(frozen=True)
class _Levels:
    """Heights of some scanlines at even places across; NaN where nothing was measured."""

    heights: Floats
    positions: Floats
    rights: Floats
    stations_m: Floats
    times_s: Floats


def crossing_runs(
    stretches: Iterable[Scanlines], number: int, settings: StepSettings
) -> Iterator[StepRun]:
    """Runs across the vehicle's path of one pass.

    Parameters
    ----------
    stretches : iterable of Scanlines
        Of one pass, in order.
    number : int
        Which of the drives given they are of.
    """
    held: list[_Levels] = []
    is_first = True
    for stretch in stretches:
        held.append(_levels_of(stretch))
        while sum(one.stations_m.size for one in held) >= _TOGETHER + 2 * _OVERLAP:
            whole = _join_levels(held)
            yield from _runs_in(_part(whole, 0, _TOGETHER), (is_first, False), number, settings)
            held = [_part(whole, _TOGETHER - 2 * _OVERLAP, whole.stations_m.size)]
            is_first = False
    if held:
        yield from _runs_in(_join_levels(held), (is_first, True), number, settings)


def _levels_of(stretch: Scanlines) -> _Levels:
    count = round(2 * _HALF_M / _SPACING_M) + 1
    heights = np.empty((stretch.stations_m.size, count))
    levels_kernel(
        stretch.across_m, stretch.height_m, stretch.starts, LevelGrid(_HALF_M, _SPACING_M), heights
    )
    times = np.full(stretch.stations_m.size, np.nan)
    filled = np.diff(stretch.starts) > 0
    middle = (stretch.starts[:-1] + stretch.starts[1:]) // 2
    times[filled] = stretch.time_s[middle[filled]]
    return _Levels(heights, stretch.positions, stretch.rights, stretch.stations_m, times)


def _join_levels(parts: list[_Levels]) -> _Levels:
    return _Levels(
        np.vstack([one.heights for one in parts]),
        np.vstack([one.positions for one in parts]),
        np.vstack([one.rights for one in parts]),
        np.concatenate([one.stations_m for one in parts]),
        np.concatenate([one.times_s for one in parts]),
    )


def _part(whole: _Levels, begin: int, end: int) -> _Levels:
    rows = slice(begin, end)
    return _Levels(
        whole.heights[rows],
        whole.positions[rows],
        whole.rights[rows],
        whole.stations_m[rows],
        whole.times_s[rows],
    )


def _runs_in(
    levels: _Levels, is_end: tuple[bool, bool], number: int, settings: StepSettings
) -> Iterator[StepRun]:
    """Runs across the vehicle's path on some scanlines; of what is seen twice, one half."""
    stations = levels.stations_m
    if stations.size < 2:
        return
    lines = levels.heights.T
    filled = np.isfinite(lines)
    starts = np.concatenate([[0], np.cumsum(filled.sum(axis=1))]).astype(np.int64)
    which = np.nonzero(filled)[1]
    middle = (stations[0] + stations[-1]) / 2
    half = float(stations[-1] - stations[0]) / 2 + _MARGIN_M
    table = steps_on_lines(
        (stations[which] - middle, lines[filled], starts), half, settings, is_square=False
    )
    low = -half if is_end[0] else stations[0] - middle + _OVERLAP * _SPACING_M
    high = half if is_end[1] else stations[-1] - middle - _OVERLAP * _SPACING_M
    table = table[(table[:, LOWER_ACROSS] >= low) & (table[:, LOWER_ACROSS] < high)]
    times = levels.times_s[which[table[:, VERTEX].astype(np.int64)]]
    across: Floats = -_HALF_M + _SPACING_M * np.arange(lines.shape[0], dtype=np.float64)
    flat = np.zeros((across.size, 3))
    rights: Floats = np.tile(np.array([1.0, 0.0]), (across.size, 1))
    steps = PassSteps(across, flat, rights, table, times)
    for chain in chains_of(steps, settings):
        run = run_of(steps, chain, number)
        turn = np.abs(np.diff(run.lower[:, 0])) / _SPACING_M
        if turn.size and float(np.median(turn)) <= _STEEPEST:
            yield _placed_on_map(run, levels, middle, chain.sign)


def _placed_on_map(run: StepRun, levels: _Levels, middle: float, sign: int) -> StepRun:
    """A run of places (station, 0, height) over places across, put where it is."""
    across = run.stations_m
    edges = []
    for edge in (run.lower, run.upper):
        at = edge[:, 0] + middle
        position = _between(at, levels.stations_m, levels.positions)
        right = _between(at, levels.stations_m, levels.rights)
        shift = np.column_stack([across[:, None] * right, edge[:, 2]])
        edges.append(position + shift)
    # Seen from left to right the vehicle's path goes on to the left: what is higher there is
    # higher on the left.
    return replace(
        run,
        face_m=np.maximum(run.face_m - _SPACING_M, 0.0),
        significance=run.significance * _DENSER,
        spread_m=np.maximum(
            np.sqrt(np.maximum(run.spread_m**2 - _GRID_M**2, 0.0)), _LEAST_SPREAD_M
        ),
        lower=edges[0],
        upper=edges[1],
        stations_m=run.lower[:, 0] + middle,
        side=-sign,
        rises=1,
    )


def _between(at: Floats, stations: Floats, values: Floats) -> Floats:
    return np.column_stack([np.interp(at, stations, column) for column in values.T])
