"""How far apart points lie, told from the points alone."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.noise.features.local_spacing import local_spacings
from processing.methods.noise.neighbours.morton import nested_cells


def plane(spacing_m: float, east_m: float) -> NDArray[np.float64]:
    """Ten thousand points of a level plane, each somewhere in a square of its own."""
    steps = np.arange(100) * spacing_m
    xy = np.stack(np.meshgrid(steps + east_m, steps), axis=-1).reshape(-1, 2)
    xy += np.random.default_rng(1).uniform(-0.5, 0.5, xy.shape) * spacing_m
    return np.column_stack([xy, np.zeros(len(xy))])


def spacings_of(xyz: NDArray[np.float64]) -> NDArray[np.float64]:
    cells = nested_cells(xyz, float(np.ptp(xyz, axis=0).max()) / 2**20)
    found = np.empty(len(xyz))
    found[cells.order] = local_spacings(cells)
    return found


def test_each_region_has_its_own_spacing() -> None:
    fine, coarse = plane(0.05, 0.0), plane(0.4, 100.0)
    found = spacings_of(np.vstack([fine, coarse]))
    assert np.median(found[: len(fine)]) == pytest.approx(0.05, rel=0.5)
    assert np.median(found[len(fine) :]) == pytest.approx(0.4, rel=0.5)


def test_a_few_points_aside_take_the_spacing_of_what_is_around() -> None:
    fine = plane(0.05, 0.0)
    aside = np.array([[8.0, 8.0, 0.0], [8.0, 8.3, 0.0]])
    found = spacings_of(np.vstack([fine, aside]))
    assert found[-2:] == pytest.approx(np.median(found), rel=0.5)


def test_a_single_point_and_points_at_one_place_have_a_spacing() -> None:
    assert np.isfinite(spacings_of(np.zeros((1, 3)))).all()
    assert np.isfinite(spacings_of(np.zeros((50, 3)))).all()
