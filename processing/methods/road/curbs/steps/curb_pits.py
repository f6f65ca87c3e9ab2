"""Frames of stones about street trees: short curbs behind a curb, one like the other.

One by one they look like planters or steps of houses. What repeats along a street with the same
height, length and distance behind the curb was built with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_profile import StepSettings
from processing.methods.road.curbs.steps.curb_runs import StepRun, is_raised, median_of

# "By trial": chosen on the streets named at `CHANCE`; no measurement of the single value is
# recorded.

_SHORTEST_M, _LONGEST_M = 0.6, 3.0
"""Length of a pit's side that was seen: one kerb stone at least; no pit of a street tree is longer.
Pits of a row are also farther apart than that."""

_LEAST_SURE = 8.0
"""Median height of its steps in their standard deviations: hardly less than that of usual curbs
(10). By trial."""

_LIKE_M, _LIKE_LONG_M, _LIKE_RISEN_M = 0.015, 0.5, 0.03
"""By how much pits of a row may differ: in height, in length, and in what other steps have raised
before them; m. A height is known within a centimetre, a length within two ends of a few scanlines.
By trial."""

_LEAST_OTHERS = 2
"""Others that are alike: three make a row, two may be any two planters."""

_CORNER_M, _CORNER_UP_M = 0.5, 0.1
"""How far in plan and in height a side may end from the corner of a front that it meets: rounded
corners, which scanlines see badly. By trial."""

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
    facts = np.array([_facts(run) for run in runs]).reshape(-1, len(_PitFacts._fields))
    side, height, seen, risen, station = np.moveaxis(np.abs(facts[:, None] - facts[None]), -1, 0)
    is_like = (side == 0) & (height <= _LIKE_M) & (seen <= _LIKE_LONG_M)
    is_like &= (risen <= _LIKE_RISEN_M) & (station > _LONGEST_M)
    enough = is_like.sum(axis=1) >= _LEAST_OTHERS
    return [run for run, is_enough in zip(runs, enough, strict=True) if is_enough]


class _PitFacts(NamedTuple):
    """Side of the road; height, length, what has risen before, station along the path; m."""

    side: float
    height_m: float
    seen_m: float
    risen_m: float
    station_m: float


def _facts(run: StepRun) -> _PitFacts:
    seen = run.is_seen
    return _PitFacts(
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
