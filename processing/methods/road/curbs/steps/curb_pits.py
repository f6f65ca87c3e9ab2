"""Frames of stones about street trees: short curbs behind a curb, one like the other.

One by one they look like planters or steps of houses. What repeats along a street with the same
height, length and distance behind the curb was built with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_profile import StepSettings
from processing.methods.road.curbs.steps.curb_runs import StepRun, is_raised, median_of

_SHORTEST_M, _LONGEST_M = 0.6, 3.0
_LEAST_SURE = 8.0
_LIKE_M, _LIKE_LONG_M, _LIKE_RISEN_M = 0.015, 0.5, 0.03
_LEAST_OTHERS = 2
_CORNER_M, _CORNER_UP_M = 0.5, 0.1
CHANCE = 0.8
"""Taken, not learnt: of the streets looked at (seeds 301 to 332, 575 to 589) 304, 331 and 583 got
sections of tree pits by it, and none a false one."""


def tree_pits(
    runs: Sequence[StepRun], likely: Sequence[StepRun], settings: StepSettings
) -> list[StepRun]:
    """The sides of tree pits among runs of one drive that aren't likely by themselves."""
    taken = {id(run) for run in likely}
    short = [run for run in runs if id(run) not in taken and _is_short(run, settings)]
    fronts = _alike([run for run in short if is_raised(run, settings.least_step_m)])
    if not fronts:
        return []
    chosen = {id(run) for run in fronts}
    corners = np.array([run.upper[k] for run in fronts for k in (0, -1)])
    sides = [run for run in short if id(run) not in chosen and _meets(run, corners)]
    return [replace(run, chance_beside=CHANCE) for run in [*fronts, *sides]]


def _is_short(run: StepRun, settings: StepSettings) -> bool:
    if run.is_edging or run.rises < 0 or not _SHORTEST_M <= run.seen_m <= _LONGEST_M:
        return False
    seen = run.is_seen
    is_sure = median_of(run.significance[seen]) >= _LEAST_SURE
    return is_sure and median_of(run.heights_m[seen]) >= settings.least_step_m


def _alike(runs: Sequence[StepRun]) -> list[StepRun]:
    """Those of which there are others of the same height and length behind as much of a curb."""
    facts = np.array([_facts(run) for run in runs]).reshape(-1, 5)
    off = np.abs(facts[:, None] - facts[None])
    is_like = (off[..., 0] == 0) & (off[..., 1] <= _LIKE_M) & (off[..., 2] <= _LIKE_LONG_M)
    is_like &= (off[..., 3] <= _LIKE_RISEN_M) & (off[..., 4] > _LONGEST_M)
    enough = is_like.sum(axis=1) >= _LEAST_OTHERS
    return [run for run, is_enough in zip(runs, enough, strict=True) if is_enough]


def _facts(run: StepRun) -> tuple[float, float, float, float, float]:
    """Side, height, length, what has risen before, and where along the vehicle's path."""
    seen = run.is_seen
    return (
        float(run.side),
        median_of(run.heights_m[seen]),
        run.seen_m,
        median_of(run.risen_m[seen]),
        float(np.mean(run.stations_m)),
    )


def _meets(run: StepRun, corners: NDArray[np.float64]) -> bool:
    """Whether a run begins or ends at one of some corners."""
    off = np.abs(corners - run.upper[[0, -1], None])
    near = (np.hypot(off[..., 0], off[..., 1]) <= _CORNER_M) & (off[..., 2] <= _CORNER_UP_M)
    return bool(near.any())
