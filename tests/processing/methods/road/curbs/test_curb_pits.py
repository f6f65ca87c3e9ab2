"""Tree pits in a row are told from what stands alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from processing.methods.road.curbs.steps.curb_confidence import confidence_of
from processing.methods.road.curbs.steps.curb_pits import CHANCE, tree_pits
from processing.methods.road.curbs.steps.curb_profile import StepSettings
from processing.methods.road.curbs.steps.curb_runs import StepRun
from tests.processing.methods.road.curbs.test_curb_lines import run_of

SETTINGS = StepSettings()
FRONT_M = 1.25


def front(
    at: float, high_m: float = 0.13, long_m: float = FRONT_M, risen_m: float = 0.15
) -> StepRun:
    """The side of a frame towards the road; plants in it hang over and hide its top."""
    run = run_of(at, at + long_m)
    count = run.stations_m.size
    return replace(
        run,
        upper=run.lower + np.array([0.0, 0.01, high_m]),
        top_m=np.full(count, 0.1),
        foot_cover_m=np.full(count, 0.03),
        risen_m=np.full(count, risen_m),
    )


def side(at: float) -> StepRun:
    """A side square to the road, from the end of a front at a station on."""
    run = front(at, long_m=0.95, risen_m=0.0)
    across = run.lower[:, 0] - at
    lower = np.column_stack([np.full(across.size, at), 5 + across, np.zeros(across.size)])
    return replace(run, lower=lower, upper=lower + np.array([0.01, 0.0, 0.13]))


def test_fronts_in_a_row_are_taken_with_the_sides_that_meet_them() -> None:
    fronts = [front(0.0), front(7.0, 0.135), front(13.0, 0.128)]
    sides = [side(7.0), side(7.0 + FRONT_M)]
    away = side(10.0)
    taken = tree_pits([*fronts, away, *sides], [], SETTINGS)
    begins = [tuple(run.lower[0]) for run in taken]
    assert begins == [tuple(run.lower[0]) for run in [*fronts, *sides]]
    assert all(confidence_of(run) >= CHANCE for run in taken)
    # The diagnostic layer knows them by what was measured.
    assert all(one.upper is run.upper for one, run in zip(taken, [*fronts, *sides], strict=True))
    assert all(confidence_of(run) < CHANCE for run in fronts)


def test_what_is_likely_by_itself_is_left_as_it_is() -> None:
    fronts = [front(0.0), front(7.0), front(13.0)]
    assert tree_pits(fronts, fronts[:1], SETTINGS) == []


@pytest.mark.parametrize(
    "fronts",
    [
        [front(0.0)],
        [front(0.0), front(7.0)],
        [front(0.0), front(7.0, 0.16), front(13.0, 0.10)],
        [front(0.0), front(7.0, long_m=2.4), front(13.0, long_m=0.65)],
        [front(0.0, risen_m=0.0), front(7.0, risen_m=0.0), front(13.0, risen_m=0.0)],
        [front(0.0), front(0.1), front(0.2)],
    ],
    ids=["alone", "two", "heights", "lengths", "on the road", "one place"],
)
def test_what_is_alone_unlike_or_on_the_road_is_no_row(fronts: Sequence[StepRun]) -> None:
    assert tree_pits(fronts, [], SETTINGS) == []
