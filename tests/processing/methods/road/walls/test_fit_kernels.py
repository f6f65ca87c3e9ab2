"""Lines through the stations of walls, against plain numpy."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.walls.fit_kernels import (
    robust_fit_kernel,
    running_fit_kernel,
    station_medians_kernel,
)

HUBER_M, RUN = 0.008, 2


def robust(terms: Floats, values: Floats) -> Floats:
    weights = np.ones(len(values))
    found = np.zeros(terms.shape[1])
    for _ in range(6):
        root = np.sqrt(weights)
        found = np.linalg.lstsq(terms * root[:, None], values * root, rcond=None)[0]
        weights = HUBER_M / np.maximum(np.abs(values - terms @ found), HUBER_M)
    return found


def stations(seed: int) -> tuple[Floats, Floats]:
    """A wall that bends, with a gate's post before it and two stations at one place."""
    rng = np.random.default_rng(seed)
    along = np.sort(rng.uniform(0.0, 6.0, 24))
    along[7] = along[8]
    values = 0.05 * np.sin(along) + rng.normal(0.0, 0.003, len(along))
    values[12] += 0.2
    return along, values


@pytest.mark.parametrize("degree", [1, 2])
def test_a_line_or_a_curve_is_that_of_numpy(degree: int) -> None:
    along, values = stations(1)
    terms = np.vander(along, degree + 1, increasing=True)
    found = np.zeros(degree + 1)
    robust_fit_kernel(terms, values, HUBER_M, found)
    np.testing.assert_allclose(found, robust(terms, values), atol=1e-9)


def test_each_station_lies_on_the_line_through_those_about_it() -> None:
    along, values = stations(2)
    found = np.empty(len(along))
    running_fit_kernel(along, values, RUN, HUBER_M, found)
    for at in range(len(along)):
        near = slice(max(0, at - RUN), at + RUN + 1)
        terms = np.vander(along[near] - along[at], 2, increasing=True)
        assert found[at] == pytest.approx(robust(terms, values[near])[0], abs=1e-9)


def test_stations_at_one_place_give_their_mean() -> None:
    found = np.empty(3)
    running_fit_kernel(np.full(3, 4.0), np.array([1.0, 1.002, 1.004]), RUN, HUBER_M, found)
    np.testing.assert_allclose(found, 1.002)


def test_two_stations_are_left_as_they_are() -> None:
    found = np.empty(2)
    running_fit_kernel(np.array([0.0, 0.3]), np.array([1.0, 2.0]), RUN, HUBER_M, found)
    assert found.tolist() == [1.0, 2.0]


def test_stations_tell_the_mean_place_and_the_median_distance_of_their_points() -> None:
    rng = np.random.default_rng(3)
    station = rng.integers(0, 9, 60)
    station[station == 4] = 5
    along, off = station + rng.random(60), rng.normal(size=60)
    for kernel in (station_medians_kernel, station_medians_kernel.py_func):  # type: ignore[attr-defined]
        room = np.empty((10, 2))
        told = room[: kernel(station, along, off, 3, room)]
        counted = [one for one in range(9) if np.count_nonzero(station == one) >= 3]
        expected = [
            (along[station == one].mean(), np.median(off[station == one])) for one in counted
        ]
        np.testing.assert_allclose(told, expected)
