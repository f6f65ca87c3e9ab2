"""Weights that tell curbs apart are learnt from lines of which it is known what they are."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.road_training.curb_training import EXPECTED
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    chances,
    cross_validate,
    fit_weights,
    reliability,
)
from processing.methods.road.curbs.steps.curb_confidence import (
    CONSTANT,
    WEIGHTS,
    CurbFacts,
    chance_of,
    terms_of,
)

FACTS = len(CurbFacts._fields)
RISEN, ROUGH = CurbFacts._fields.index("risen_m"), CurbFacts._fields.index("rough")


def known(count: int = 200) -> LabelledThings:
    """Lines on ten streets: those behind a rise of more than 5 cm are no curbs."""
    random = np.random.default_rng(7)
    terms = np.zeros((count, FACTS))
    terms[:, RISEN] = random.uniform(0.0, 0.2, count)
    terms[:, ROUGH] = random.uniform(1.0, 2.0, count)
    worth = random.uniform(1.0, 3.0, count)
    return LabelledThings(terms, terms[:, RISEN] < 0.05, worth, np.arange(count) % 10)


def test_what_tells_curbs_apart_gets_weight_and_no_weight_changes_its_sign() -> None:
    weights = fit_weights(known(), EXPECTED)
    assert weights[1 + RISEN] < -25.0
    assert np.all(weights[1:] * np.sign(EXPECTED.weights[1:]) >= 0.0)


def test_streets_left_out_are_told_right() -> None:
    lines = known()
    chance = cross_validate(lines, EXPECTED)
    sure = chance >= 0.9
    assert sure.any()
    assert lines.is_right[sure].mean() >= 0.9


def test_chances_of_the_command_are_those_of_the_tool() -> None:
    facts = CurbFacts(0.5, 0.03, -0.02, 0.0, 0.0, 0.0, 0.4, 1.2, 8.0, 0.1, 0.0, 0.2, 0.25, 0.0)
    lines = LabelledThings(
        np.array([terms_of(facts)]), np.array([True]), np.ones(1), np.zeros(1, np.int64)
    )
    weights = np.array([CONSTANT, *WEIGHTS])
    assert chances(lines, weights)[0] == pytest.approx(chance_of(facts))


def test_the_table_counts_every_line_once() -> None:
    lines = known()
    rows = reliability(lines, cross_validate(lines, EXPECTED)).strip().splitlines()[2:]
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    assert sum(int(row[1]) for row in cells) == lines.is_right.size
    assert sum(int(row[2]) for row in cells) == int(lines.is_right.sum())
