"""What exact edges change of the chance that a line is a curb."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.approximate_lines import approximate_lines_of
from processing.methods.road.curbs.edges.curb_edge_kernels import (
    FACE_POINTS,
    HIGH_OFF,
    LEAN,
    LOW_OFF,
    LOWER_ABOVE,
    LOWER_ACROSS,
    UPPER_ABOVE,
    UPPER_ACROSS,
)
from processing.methods.road.curbs.edges.curb_evidence import facts_of, noise_of
from processing.methods.road.curbs.edges.curb_joins import join_edges
from processing.methods.road.curbs.edges.curb_lines import lines_of
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, chance_of
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.tools.curbs import CurbParameters
from tests.processing.methods.road.test_curb_lines import measures_of, run_of

INLIER_M, NOISE_M = 0.005, 0.002
LEAST = CurbParameters().least_confidence


def facts(measures: NDArray[np.float64], run: StepRun) -> CurbFacts:
    """With a scanner's noise of 2 mm."""
    (approximate_line,) = approximate_lines_of([run], 8.0)
    count = approximate_line.xyz.shape[0]
    edges = join_edges([measures[:count]], 0.45)
    (line,) = lines_of(approximate_line, edges, 8.0)
    return facts_of((approximate_line, line), [run], edges, [measures[:count]], (INLIER_M, NOISE_M))


def chance(measures: NDArray[np.float64], run: StepRun | None = None) -> float:
    """Of a line of 8 m."""
    return chance_of(facts(measures, run or run_of(0.0, 8.0)))


def stone() -> NDArray[np.float64]:
    """A straight curb whose points lie on its planes."""
    measures = measures_of(80)
    measures[:, [LOW_OFF, HIGH_OFF]] = 0.002
    measures[:, [LOWER_ACROSS, UPPER_ACROSS]] = [0.0, 0.015]
    measures[:, UPPER_ABOVE] = measures[:, LOWER_ABOVE] + 0.15
    return measures


def verge() -> NDArray[np.float64]:
    """Grass that rises beside the asphalt: flat, uneven and rough."""
    measures = stone()
    rough = np.random.default_rng(2)
    measures[:, LEAN] = 0.6
    measures[:, [LOW_OFF, HIGH_OFF]] = 0.006
    measures[:, UPPER_ABOVE] += rough.normal(0, 0.01, 80)
    measures[:, [LOWER_ACROSS, UPPER_ACROSS]] += rough.normal(0, 0.01, (80, 1))
    return measures


def test_stone_is_likely_and_a_verge_is_left_out() -> None:
    assert chance(stone()) > 0.8
    assert chance(verge()) < LEAST


def test_what_is_too_tall_for_kerb_stones_is_less_likely() -> None:
    tall = stone()
    tall[:, UPPER_ABOVE] += 0.23
    assert chance(tall) < chance(stone()) - 0.2


def test_what_stands_behind_another_rise_is_less_likely() -> None:
    first = run_of(0.0, 4.0)
    behind = replace(first, risen_m=first.risen_m + 0.15, above_path_m=first.above_path_m + 0.15)
    assert chance(stone(), behind) < chance(stone(), first) - 0.2


def test_a_long_line_may_stand_behind_another_curb() -> None:
    first = run_of(0.0, 30.0)
    behind = replace(first, risen_m=first.risen_m + 0.15, above_path_m=first.above_path_m + 0.15)
    measures = np.vstack([stone(), stone()])
    assert chance(measures, behind) == pytest.approx(chance(measures, first))


def test_a_face_nobody_sees_stands_on_pavement_unless_it_looks_away() -> None:
    unseen = stone()
    unseen[:, FACE_POINTS], unseen[:, LOW_OFF] = 0.0, 0.005
    front = run_of(0.0, 8.0)
    assert facts(unseen, front).rough == pytest.approx(2.5)
    assert facts(unseen, replace(front, rises=-1, side=1)).rough == pytest.approx(1.0)


def test_noise_is_that_of_the_quieter_stations() -> None:
    assert noise_of([np.vstack([stone(), verge()])]) == pytest.approx(0.002)
    assert noise_of([]) > 0
