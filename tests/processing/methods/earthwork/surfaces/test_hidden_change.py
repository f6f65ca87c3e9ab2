from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.methods.earthwork.surfaces.hidden_change import expected_change, noise_of_change

EVERYWHERE = np.ones((40, 60), np.bool_)


def test_a_hole_in_untouched_ground_did_not_change_and_surely_so() -> None:
    change = np.random.default_rng(3).normal(0.0, 0.004, EVERYWHERE.shape)
    change[10:30, 20:40] = np.nan
    field = expected_change(change, EVERYWHERE, 0.5)

    assert np.abs(field.mean[10:30, 20:40]).max() < 0.01
    assert np.sqrt(field.variance[10:30, 20:40]).max() < 0.01


def test_between_fill_and_untouched_ground_either_may_be() -> None:
    change = np.zeros(EVERYWHERE.shape)
    change[:, 40:] = 2.0
    change[:, 20:40] = np.nan
    field = expected_change(change, EVERYWHERE, 0.5)

    assert field.mean[20, 29:31] == pytest.approx(1.0, abs=0.15)
    assert np.sqrt(field.variance[20, 29:31]) == pytest.approx(1.0, abs=0.15)
    assert np.sqrt(field.variance[20, 20]) < np.sqrt(field.variance[20, 30])


@given(seed=st.integers(0, 20), low_m=st.floats(-3.0, 0.0), high_m=st.floats(0.0, 3.0))
def test_no_change_is_expected_that_no_rim_shows(seed: int, low_m: float, high_m: float) -> None:
    chance = np.random.default_rng(seed)
    change = chance.uniform(low_m, high_m, (12, 15))
    change[chance.uniform(size=change.shape) < 0.6] = np.nan
    field = expected_change(change, np.ones(change.shape, np.bool_), 0.5)

    assert field.mean.min() >= low_m - 1e-9
    assert field.mean.max() <= high_m + 1e-9
    assert (field.variance >= 0).all()


def test_noise_is_told_apart_from_the_shape_of_the_change() -> None:
    across = np.arange(200)[None, :] * 0.05
    change = np.random.default_rng(1).normal(0.0, 0.02, (100, 200)) + across

    assert noise_of_change(change) == pytest.approx(0.02, rel=0.05)
    assert noise_of_change(np.full((2, 2), np.nan)) == 0.0
