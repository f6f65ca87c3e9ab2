"""Weights are learnt from things of which it is known whether they are right."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    chances,
    cross_validate,
    fit_weights,
    learn_weights,
    reliability,
)
from processing.methods.road.gutters.grating_confidence import (
    CONSTANT,
    WEIGHTS,
    grating_chance,
    terms_of,
)
from processing.methods.road.gutters.grating_facts import GratingFacts

EXPECTED = WeightPrior((0.0, 1.0, -1.0), (3.0, 3.0, 3.0))


def known(count: int = 300) -> LabelledThings:
    """Things on ten streets: right where the first fact is large; the second says nothing."""
    random = np.random.default_rng(7)
    terms = random.uniform(0.0, 1.0, (count, 2))
    is_right = terms[:, 0] + random.normal(0.0, 0.05, count) > 0.5
    return LabelledThings(terms, is_right, np.ones(count), np.arange(count) % 10)


def test_what_tells_gets_weight_and_no_weight_changes_its_sign() -> None:
    weights = fit_weights(known(), EXPECTED)
    assert weights[1] > 5.0
    assert -2.0 < weights[2] <= 0.0


def test_streets_left_out_are_told_right() -> None:
    things = known()
    sure = cross_validate(things, EXPECTED) >= 0.9
    assert sure.any()
    assert things.is_right[sure].mean() >= 0.9


def test_a_thing_of_no_worth_changes_nothing() -> None:
    things = known()
    more = LabelledThings.of(
        [
            *zip(things.terms, things.is_right, things.worth, things.street, strict=True),
            ([0.0, 0.0], True, 0.0, 3),
        ],
        2,
    )
    assert fit_weights(more, EXPECTED) == pytest.approx(fit_weights(things, EXPECTED), abs=1e-3)


def test_chances_of_the_command_are_those_of_the_tool() -> None:
    facts = GratingFacts(12, 0.5, depth_m=0.05, least_part=0.3, about=0.02, raised_m=0.0)
    one = LabelledThings.of([(terms_of(facts), True, 1.0, 0)], len(WEIGHTS))
    assert chances(one, np.array([CONSTANT, *WEIGHTS]))[0] == pytest.approx(grating_chance(facts))


def test_the_table_counts_every_thing_once() -> None:
    things = known()
    rows = reliability(things, cross_validate(things, EXPECTED)).strip().splitlines()[2:]
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    assert sum(int(row[1]) for row in cells) == things.is_right.size
    assert sum(int(row[2]) for row in cells) == int(things.is_right.sum())


def test_weights_are_told_by_name_with_both_tables() -> None:
    told = learn_weights(("open", "depth"), EXPECTED, known(), known(40))
    lines = told.splitlines()
    weights = fit_weights(known(), EXPECTED)
    assert lines[:3] == [
        f"{name} {weight:.2f}"
        for name, weight in zip(("constant", "open", "depth"), weights, strict=True)
    ]
    assert sum(line.startswith("| confidence") for line in lines) == 2
