"""Kerb stones as they were laid, and as time left them."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.street.stones import StoneNodes, StoneRow, lay_stones


def _laid(wear: float) -> StoneNodes:
    row = StoneRow(0.6, 0.002, wear)
    return lay_stones(np.random.default_rng(3), np.array([0.0, 60.0]), row, np.empty(0))


def test_stones_without_wear_stand_upright_and_sharp() -> None:
    new = _laid(0.0)
    assert not new.tilted.any()
    assert not new.rounded.any()


def test_worn_stones_lie_where_they_were_laid_but_lean_settle_and_are_rounded() -> None:
    new, old = _laid(0.0), _laid(1.0)
    assert np.array_equal(new.along, old.along)
    assert 0.02 < old.tilted.std() < 0.1
    assert old.rounded.max() > 0.02
    assert old.upwards.std() > 2 * new.upwards.std()
