"""First returns of a flight, cut into patches."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.waveform_networks.patches import (
    FirstReturns,
    covering_patches,
    random_patch,
)
from processing.laboratory.waveform_networks.scoring import CHANGES, ClassRates


@pytest.fixture
def flight() -> FirstReturns:
    rng = np.random.default_rng(1)
    xyz = rng.uniform((5_000, -70_000, 30), (5_050, -69_980, 40), (1_000, 3))
    classes = np.where(xyz[:, 0] < 5_002, 4, 0)
    return FirstReturns(xyz, rng.uniform(0, 1, (1_000, 160)).astype(np.float16), classes)


def test_every_point_of_a_flight_is_in_a_patch_that_covers_it(flight: FirstReturns) -> None:
    patches = covering_patches(flight, 128, np.random.default_rng(0))
    assert {one.points.size for one in patches} == {128}
    assert np.unique(np.concatenate([one.points for one in patches])).size == 1_000
    one = patches[0]
    np.testing.assert_allclose(one.xyz.mean(axis=0), 0, atol=1e-3)
    np.testing.assert_array_equal(one.classes, flight.classes[one.points])


def test_a_flight_of_few_points_repeats_them(flight: FirstReturns) -> None:
    rng = np.random.default_rng(0)
    (whole,) = covering_patches(flight, 1_500, rng)
    assert whole.points.size == 1_500
    assert np.unique(whole.points).size == 1_000
    assert random_patch(flight, 1_500, rng).points.size == 1_500


def test_rare_classes_are_met(flight: FirstReturns) -> None:
    rng = np.random.default_rng(0)
    met = sum((random_patch(flight, 60, rng).classes == 4).any() for _ in range(40))
    assert met > 12


def test_a_turned_patch_keeps_heights_and_distances(flight: FirstReturns) -> None:
    patch = flight.patch(np.arange(50))
    turned = patch.turned(1.0)
    np.testing.assert_allclose(turned.xyz[:, 2], patch.xyz[:, 2], atol=1e-5)
    np.testing.assert_allclose(
        np.linalg.norm(turned.xyz, axis=1), np.linalg.norm(patch.xyz, axis=1), rtol=1e-5
    )


def test_thinning_keeps_no_more_than_asked(flight: FirstReturns) -> None:
    rng = np.random.default_rng(0)
    assert flight.density == pytest.approx(1.0, rel=0.02)
    assert len(flight.thinned(0.5, rng).xyz) == pytest.approx(500, rel=0.02)
    assert len(flight.thinned(9.0, rng).xyz) == 1_000


def test_disturbed_patches_keep_their_sizes(flight: FirstReturns) -> None:
    patch, rng = flight.patch(np.arange(200)), np.random.default_rng(0)
    for change in CHANGES.values():
        other = change(patch, rng)
        assert other.xyz.shape == patch.xyz.shape
        assert other.waves.shape == patch.waves.shape
        assert other.waves.min() >= 0


def test_rates_are_those_of_the_table_of_classes() -> None:
    classes, found = np.array([0, 0, 0, 1, 1, 5]), np.array([0, 0, 1, 1, 0, 5])
    rates = ClassRates.of(classes, found)
    np.testing.assert_allclose(rates.precision[[0, 1, 5]], [2 / 3, 1 / 2, 1])
    np.testing.assert_allclose(rates.recall[[0, 1, 5]], [2 / 3, 1 / 2, 1])
    np.testing.assert_allclose(rates.f_measure[[0, 1, 5]], [2 / 3, 1 / 2, 1])
    assert np.isnan(rates.f_measure[2:5]).all()
