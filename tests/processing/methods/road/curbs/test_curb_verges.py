"""What lies behind grass, or falls where nothing was raised, is known as such."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.methods.road.curbs.edges.approximate_lines import approximate_lines_of
from processing.methods.road.curbs.edges.curb_evidence import raised_by_others
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, chance_of
from processing.methods.road.curbs.steps.curb_filters import runs_of
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.tools.curbs import CurbParameters
from tests.processing.methods.road.curbs.test_curb_runs import (
    SETTINGS,
    Floats,
    curb,
    found,
    scanlines,
)

STONE = CurbFacts(0.95, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3, 1.1, 15.0, 0.0, 0.0, 0.0, 0.0, 0.0)
LEAST = CurbParameters().least_confidence


def behind_grass(wide_m: float) -> StepRun:
    """A step of 15 cm at 4.5 m on the right, grass before it."""
    random = np.random.default_rng(3)
    step = curb(4.5, 0.15)

    def surface(station: float, across: Floats) -> Floats:
        is_grass = (across > 4.3 - wide_m) & (across < 4.3)
        return step(station, across) + is_grass * random.uniform(0.0, 0.12, across.size)

    runs = [run for run in runs_of([scanlines(surface)], 0, SETTINGS) if run.rises > 0]
    return max(
        (run for run in runs if abs(run.lower[0, 0] - 4.5) < 0.1), key=lambda one: one.seen_m
    )


@pytest.mark.parametrize("wide_m", [0.0, 1.0, 2.0])
def test_grass_between_the_path_and_a_step_is_measured(wide_m: float) -> None:
    verge_m = float(np.median(behind_grass(wide_m).verge_m))
    assert verge_m == pytest.approx(wide_m, abs=0.3)


def test_noise_of_the_scanner_is_no_grass() -> None:
    (run,) = found(curb(4.5, 0.15), noise_m=0.008)
    assert np.median(run.verge_m) == 0.0


def test_a_line_behind_a_verge_is_left_out_unless_another_curb_raised_it() -> None:
    assert chance_of(STONE) > 0.9
    behind = STONE._replace(verge_m=1.0)
    assert chance_of(behind) < LEAST
    assert chance_of(raised_by_others(behind, 1.0)) == chance_of(STONE)


def test_ground_falls_from_what_a_curb_has_raised_only() -> None:
    falls = STONE._replace(unraised=1.0)
    assert chance_of(falls) < LEAST
    assert chance_of(raised_by_others(falls, 1.0)) == chance_of(STONE)


def test_a_curb_on_the_wall_of_an_open_gutter_is_found() -> None:
    def surface(station: float, across: Floats) -> Floats:
        height = curb(3.5, 0.15, 0.02)(station, across)
        height[(across > 3.0) & (across < 3.42)] = -0.25
        height[(across > 3.0) & (across < 3.36)] = math.nan  # the near wall hides the bottom
        return height

    (run,) = found(surface)
    assert np.median(run.heights_m) == pytest.approx(0.15, abs=0.02)
    assert np.median(run.lower[:, 0]) == pytest.approx(3.5, abs=0.03)
    assert len(approximate_lines_of([run], 8.0)) == 1
