"""What is no curb: runs whose length, height or surroundings speak against one.

Grass and hedges rise rough and uneven; the line where a vehicle or a wall meets the ground has no
level top behind it; the rear edge of kerb stones lies a stone's width behind the curb itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.monitor import Monitor
from processing.core.worked_ahead import one_ahead
from processing.image.scan_lines.scanlines import Scanlines, ScanlineSettings, scanlines_of
from processing.methods.road.curbs.steps.curb_chains import chains_of
from processing.methods.road.curbs.steps.curb_confidence import confidence_of
from processing.methods.road.curbs.steps.curb_crossings import crossing_runs
from processing.methods.road.curbs.steps.curb_pits import tree_pits
from processing.methods.road.curbs.steps.curb_profile import (
    PassSteps,
    StepSettings,
    join_steps,
    steps_of,
)
from processing.methods.road.curbs.steps.curb_ridges import PassRidges, ridge_runs, ridges_of
from processing.methods.road.curbs.steps.curb_runs import StepRun, is_raised, median_of, run_of
from processing.methods.road.curbs.steps.curb_verges import PassVerges, join_verges, verges_of
from processing.recording.drive import Drive

Floats = NDArray[np.float64]

LEAST_LENGTH_M = 1.0
"""What stands alone has to be so long: a kerb stone is 0.6 m, two of them make a line."""

LEAST_CHANCE = 0.4
"""Runs less likely than this are left out: more of them are wrong than right (of those from 0.4 to
0.7 39 % were right, see `curb_confidence`)."""

_HIGH_M, _MOST_LEAN = 0.10, 0.7
"""From this height, m, faces of curbs lean by less than 35° (Takahashi 2022, Table 6-1: 30°), m
across per m of height: banks of earth between fields don't. Of low steps too few points tell."""

_LEVEL_M, _LEVEL_SHARE, _RISEN_SHARE = 0.02, 0.25, 0.5
"""Where the ground falls away from the road and what falls is hardly higher than the road itself
(by less than 2 cm, or than a quarter of the fall), less than half of the fall having risen before,
no island ends but a ditch or a bank begins. The quarter followed two streets of twelve on which the
edge of a shoulder 3 cm above the road, 30 cm above a ditch, made 182 false sections of 2 m."""

_DEEP_M, _CHANNEL_M = 0.10, 0.5
"""What comes up from as deep below the road, over ground as narrow, is the wall of a channel. By
trial, on streets with open channels and levees."""

_WIDEST_STONE_M = 0.35
"""Stones are up to 25 cm wide, and both edges are known within some centimetres."""

_BESIDE_SHARE = 0.25
"""Along so much of a run a stone's other edge must lie; no planting strip is as narrow as a stone,
so a part of it suffices. By trial."""

_ABOVE_ROAD_M = 0.05
"""A curb whose foot lies lower above the road at the vehicle's path stands on the road: less than
the lowest full curb. By trial."""

_WIDEST_STRIP_M, _ALONG_SHARE = 3.5, 0.5
"""How far behind a curb an edging stone stands at most, the width of a planting strip with a tree,
and along how much of it. By trial."""


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
    return remove_unlikely_runs(runs, settings)


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
        noted = _NotedStretches([], [], [])
        crossing = list(crossing_runs(_note_steps(stretches, settings, noted), number, settings))
        steps, verges = join_steps(noted.steps), join_verges(noted.verges)
        for run in (*crossing, *ridge_runs(noted.ridges, steps, number, settings)):
            yield verges.of(run)
        for chain in chains_of(steps, settings):
            yield verges.of(run_of(steps, chain, number))


class _NotedStretches(NamedTuple):
    """What was seen on the stretches of one pass, in order."""

    steps: list[PassSteps]
    ridges: list[PassRidges]
    verges: list[PassVerges]


def _note_steps(
    stretches: Iterable[Scanlines], settings: StepSettings, noted: _NotedStretches
) -> Iterator[Scanlines]:
    """The stretches, each one's steps being noted as it passes: none is held."""
    for stretch in stretches:
        noted.steps.append(steps_of(stretch, settings))
        noted.ridges.append(ridges_of(stretch, settings))
        noted.verges.append(verges_of(stretch))
        yield stretch


def remove_unlikely_runs(runs: Sequence[StepRun], settings: StepSettings) -> tuple[StepRun, ...]:
    """The runs of one drive that are taken for curbs."""
    likely = [run for run in runs if is_likely(run, settings)]
    return remove_rear_edges([*likely, *tree_pits(runs, likely, settings)], settings)


def remove_rear_edges(runs: Sequence[StepRun], settings: StepSettings) -> tuple[StepRun, ...]:
    """Runs, of any drives, that aren't rear edges of stones whose front is another of them."""
    fronts = _fronts(runs, settings)
    return tuple(run for run in runs if run.rises > 0 or not _is_rear(run, fronts))


def remove_inner_faces(runs: Sequence[StepRun], settings: StepSettings) -> tuple[StepRun, ...]:
    """Runs, of any drives, but for faces of edging stones towards what is planted.

    They rise from the soil behind a curb; the map shows the stone's edge at the walk.
    """
    edging = _positions([run for run in runs if run.is_edging])
    return tuple(
        run
        for run in runs
        if run.is_edging
        or run.rises < 0
        or not is_raised(run, settings.least_step_m)
        or not _is_stone(run, edging)
    )


def remove_lone_edging(runs: Sequence[StepRun], settings: StepSettings) -> tuple[StepRun, ...]:
    """Runs, of any drives, but for narrow ridges that no curb runs beside: those of fields."""
    fronts = _fronts(runs, settings)
    return tuple(run for run in runs if not run.is_edging or _is_beside(run, fronts))


class CurbIndications(NamedTuple):
    """What the ground about a run says of it, true where it speaks for a curb.

    Attributes
    ----------
    is_upright : bool
        Its face stands, as those of high curbs do.
    is_of_road : bool
        The road lies before it: no ditch or bank falls off here, no channel comes up.
    """

    is_upright: bool
    is_of_road: bool


def curb_indications_of(run: StepRun) -> CurbIndications:
    """What the ground about a run says of it."""
    high_m = median_of(run.heights_m[run.is_seen])
    is_high = run.rises > 0 and high_m >= _HIGH_M
    is_leaning = is_high and median_of(run.face_m[run.is_seen]) > _MOST_LEAN * high_m
    is_off = _falls_off(run, high_m) if run.rises < 0 else _climbs_out(run, high_m)
    return CurbIndications(is_upright=not is_leaning, is_of_road=not is_off)


def is_likely(run: StepRun, settings: StepSettings) -> bool:
    """Whether a run by itself looks like a curb."""
    if run.seen_m < LEAST_LENGTH_M or median_of(run.heights_m[run.is_seen]) < settings.least_step_m:
        return False
    return all(curb_indications_of(run)) and confidence_of(run) >= LEAST_CHANCE


def _falls_off(run: StepRun, high_m: float) -> bool:
    """Whether the ground falls off beside the road: nothing rose before, the road is as high."""
    seen = run.is_seen
    above_m = median_of(run.above_path_m[seen]) + high_m
    is_level = above_m < max(_LEVEL_M, _LEVEL_SHARE * high_m)
    return is_level and median_of(run.risen_m[seen]) < _RISEN_SHARE * high_m


def _climbs_out(run: StepRun, high_m: float) -> bool:
    """Whether narrow ground that lies below the road comes up to its level again."""
    seen = run.is_seen
    below_m = -median_of(run.above_path_m[seen])
    if below_m < _DEEP_M or high_m - below_m >= max(_LEVEL_M, _LEVEL_SHARE * high_m):
        return False
    return median_of(run.foot_m[seen]) < _CHANNEL_M


def _is_rear(run: StepRun, fronts: Floats) -> bool:
    """Whether along some of a run a higher front lies a stone's width away."""
    if not fronts.size:
        return False
    tree = cKDTree(fronts[:, :2])
    found = tree.query(run.upper[:, :2], distance_upper_bound=_WIDEST_STONE_M)
    beside = np.isfinite(found[0])
    nearest = np.asarray(found[1], np.int64)[beside]
    beside[beside] = fronts[nearest, 2] >= run.heights_m[beside]
    return bool(beside.mean() >= _BESIDE_SHARE)


def _is_stone(run: StepRun, edging: Floats) -> bool:
    """Whether along some of a run an edging's edge lies a stone's width away."""
    return _share_near(run, edging, _WIDEST_STONE_M) >= _BESIDE_SHARE


def _is_beside(run: StepRun, fronts: Floats) -> bool:
    """Whether along most of a run there is a front as far away as planting strips are wide."""
    return _share_near(run, fronts, _WIDEST_STRIP_M) >= _ALONG_SHARE


def _share_near(run: StepRun, positions: Floats, within_m: float) -> float:
    """Along how much of a run one of some places is near in plan, 0 to 1."""
    if not positions.size:
        return 0.0
    away = cKDTree(positions[:, :2]).query(run.upper[:, :2], distance_upper_bound=within_m)[0]
    return float(np.isfinite(away).mean())


def _fronts(runs: Sequence[StepRun], settings: StepSettings) -> Floats:
    """Places of the curbs that stand on the road, as :func:`_positions` gives them."""
    return _positions([run for run in runs if run.rises > 0 and _is_first(run, settings)])


def _positions(runs: Sequence[StepRun]) -> Floats:
    """(n, 3) upper edges in plan and how high the steps are, m."""
    each = (np.column_stack([run.upper[:, :2], run.heights_m]) for run in runs)
    return np.vstack([np.empty((0, 3)), *each])


def _is_first(run: StepRun, settings: StepSettings) -> bool:
    """Whether a run stands on the road: stones on ground that a curb has raised are edgings."""
    is_low = median_of(run.above_path_m[run.is_seen]) < _ABOVE_ROAD_M
    return is_low and not is_raised(run, settings.least_step_m)
