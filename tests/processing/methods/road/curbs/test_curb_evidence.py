"""What exact edges change of the chance that a line is a curb."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.approximate_lines import approximate_lines_of
from processing.methods.road.curbs.edges.curb_edges import MeasuredEdges
from processing.methods.road.curbs.edges.curb_evidence import (
    UsualMeasures,
    facts_of,
    noise_of,
    usual_step_m,
)
from processing.methods.road.curbs.edges.curb_joins import join_edges
from processing.methods.road.curbs.edges.curb_lines import lines_of
from processing.methods.road.curbs.edges.edge_measures import (
    FACE_POINTS,
    HIGH_OFF,
    LEAN,
    LOW_OFF,
    LOW_POINTS,
    LOWER_ABOVE,
    LOWER_ACROSS,
    UPPER_ABOVE,
    UPPER_ACROSS,
)
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, chance_of
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.tools.curbs import CurbParameters
from tests.processing.methods.road.curbs.test_curb_lines import measures_of, run_of

INLIER_M, NOISE_M = 0.005, 0.002
LEAST = CurbParameters().least_confidence


def facts(
    measures: NDArray[np.float64], run: StepRun, points: NDArray[np.float64] | None = None
) -> CurbFacts:
    """With a scanner's noise of 2 mm; points are (n, 3) in the line's frame, stations rising."""
    (approximate_line,) = approximate_lines_of([run], 8.0)
    count = approximate_line.xyz.shape[0]
    edges = join_edges([measures[:count]], 0.45)
    (line,) = lines_of(approximate_line, edges, 8.0)
    about = np.empty((0, 2)) if points is None else points[:, 1:]
    along = np.empty(0) if points is None else points[:, 0]
    seen = MeasuredEdges(measures[:count], along, about, np.arange(along.size))
    usual = UsualMeasures(INLIER_M, NOISE_M, 0.15)
    return facts_of((approximate_line, line), [run], edges, [seen], usual)


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


def test_a_face_that_goes_on_upwards_is_a_wall() -> None:
    along = np.repeat(np.arange(32.0), 10)
    above = np.tile(np.linspace(0.3, 0.6, 10), 32)
    wall = np.column_stack([along, np.full(along.size, 0.015), above])
    behind = np.column_stack([along, np.full(along.size, 0.3), above])
    assert facts(stone(), run_of(0.0, 8.0), wall).walled > 0.9
    assert facts(stone(), run_of(0.0, 8.0), behind).walled == 0.0


def test_a_step_without_a_face_between_foot_and_top_is_no_stone() -> None:
    faceless = stone()
    faceless[:, [FACE_POINTS, LOW_POINTS]] = [0.0, 20.0]
    assert facts(faceless, run_of(0.0, 8.0)).faceless == 1.0
    # A face that looks away shows none.
    away = replace(run_of(0.0, 8.0), rises=-1, side=1)
    assert facts(faceless, away).faceless == 0.0


def test_the_usual_step_is_that_of_long_lines() -> None:
    curbs = []
    for long_m, step_m in ((30.0, 0.12), (3.0, 0.4)):
        (approximate_line,) = approximate_lines_of([run_of(0.0, long_m)], 8.0)
        measures = np.vstack([stone(), stone()])[: approximate_line.xyz.shape[0]]
        measures[:, UPPER_ABOVE] = measures[:, LOWER_ABOVE] + step_m
        curbs += lines_of(approximate_line, join_edges([measures], 0.45), 8.0)
    assert usual_step_m(curbs) == pytest.approx(0.12, abs=0.002)
    assert usual_step_m([]) > 0.1
