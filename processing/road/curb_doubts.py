"""What is no curb: runs whose length, height or surroundings speak against one.

Grass and hedges rise rough and uneven; the line where a vehicle or a wall meets the ground has no
level top behind it; the rear edge of kerb stones lies a stone's width behind the curb itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from processing.image.scanlines import Scanlines, ScanlineSettings, scanlines_of
from processing.monitor import Monitor
from processing.points.drive import Drive
from processing.road.curb_chains import chains_of
from processing.road.curb_confidence import confidence_of
from processing.road.curb_crossings import crossing_runs
from processing.road.curb_profile import PassSteps, StepSettings, joined_steps, steps_of
from processing.road.curb_runs import StepRun, median_of, run_of
from processing.worked_ahead import one_ahead

LEAST_LENGTH_M = 1.0
"""What stands alone has to be so long: a kerb stone is 0.6 m, two of them make a line."""

LEAST_CHANCE = 0.4
"""Runs less likely than this are left out: more of them are wrong than right."""

_HIGH_M, _MOST_LEAN = 0.10, 0.7
"""Faces of high curbs lean by less than 35° (Table 6-1: 30°): banks of earth between fields don't.
Of low steps too few points tell."""

_LEVEL_M, _RISEN_SHARE = 0.02, 0.5
"""Where the ground falls away from the road and what falls is no higher than the road itself, less
than this share of it having risen before, no island ends but a ditch or a bank begins."""

_WIDEST_STONE_M = 0.30
_BESIDE_SHARE = 0.5


def step_runs(
    drive: Drive, number: int, settings: StepSettings, monitor: Monitor
) -> tuple[StepRun, ...]:
    """The runs of a drive that are taken for curbs.

    Parameters
    ----------
    number : int
        Which of the drives given it is; noted in the runs.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    Cancelled
    """
    scanlines = one_ahead(scanlines_of(drive, ScanlineSettings(), monitor))
    runs: list[StepRun] = []
    for run in runs_of(scanlines, number, settings):
        monitor.check()
        runs.append(run)
    return without_doubtful(runs, settings)


def runs_of(
    scanlines: Iterable[Scanlines], number: int, settings: StepSettings
) -> Iterator[StepRun]:
    """All runs of a drive's scanlines, doubtful ones too, pass by pass.

    Parameters
    ----------
    scanlines : iterable of Scanlines
        Stretch by stretch, in order.
    number : int
        Which of the drives given they are of.
    """
    for _, stretches in groupby(scanlines, key=lambda one: one.number):
        parts: list[PassSteps] = []
        yield from crossing_runs(_noted(stretches, settings, parts), number, settings)
        steps = joined_steps(parts)
        for chain in chains_of(steps, settings):
            yield run_of(steps, chain, number)


def _noted(
    stretches: Iterable[Scanlines], settings: StepSettings, parts: list[PassSteps]
) -> Iterator[Scanlines]:
    """The stretches, each one's steps being noted on the way: none is held."""
    for stretch in stretches:
        parts.append(steps_of(stretch, settings))
        yield stretch


def without_doubtful(runs: Sequence[StepRun], settings: StepSettings) -> tuple[StepRun, ...]:
    """The runs of one drive that are taken for curbs."""
    likely = [run for run in runs if is_likely(run, settings)]
    return tuple(run for run in likely if not _is_rear(run, likely))


def is_likely(run: StepRun, settings: StepSettings) -> bool:
    """Whether a run by itself looks like a curb."""
    if run.seen_m < LEAST_LENGTH_M:
        return False
    high_m = median_of(run.heights_m[run.is_seen])
    if high_m < settings.least_step_m:
        return False
    if run.rises < 0 and _falls_off(run, high_m):
        return False
    is_high = run.rises > 0 and high_m >= _HIGH_M
    if is_high and median_of(run.face_m[run.is_seen]) > _MOST_LEAN * high_m:
        return False
    return confidence_of(run) >= LEAST_CHANCE


def _falls_off(run: StepRun, high_m: float) -> bool:
    """Whether the ground falls off beside the road: nothing rose before, the road is as high."""
    seen = run.is_seen
    above_m = median_of(run.above_way_m[seen]) + high_m
    return above_m < _LEVEL_M and median_of(run.risen_m[seen]) < _RISEN_SHARE * high_m


def _is_rear(run: StepRun, runs: Sequence[StepRun]) -> bool:
    """Whether most of a run is the rear edge of stones whose front is another, higher run."""
    if run.rises > 0:
        return False
    beside = np.zeros(run.stations_m.size, np.bool_)
    for other in runs:
        if other.side == run.side and other.rises > 0:
            beside |= _behind(run, other)
    return bool(beside.mean() >= _BESIDE_SHARE)


def _behind(run: StepRun, front: StepRun) -> NDArray[np.bool_]:
    """(k,) where the front edge of a stone lies on the road's side of a run."""
    if np.any(np.diff(front.stations_m) <= 0):
        return np.zeros(run.stations_m.size, np.bool_)
    low, high = front.stations_m[0], front.stations_m[-1]
    here = (run.stations_m >= low) & (run.stations_m <= high)
    apart = np.full(run.stations_m.size, np.inf)
    places = run.stations_m[here]
    level = [np.interp(places, front.stations_m, front.upper[:, axis]) for axis in range(3)]
    apart[here] = np.hypot(level[0] - run.upper[here, 0], level[1] - run.upper[here, 1])
    is_higher = np.zeros(run.stations_m.size, np.bool_)
    is_higher[here] = np.interp(places, front.stations_m, front.heights_m) >= run.heights_m[here]
    return (apart <= _WIDEST_STONE_M) & is_higher
