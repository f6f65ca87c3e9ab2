"""Radius and gradient of a centre line are those that it was made with."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.map.routes.road_alignment import RouteShape


def _bend(radius_m: float) -> Floats:
    """100 m straight, a quarter of a circle, 100 m straight; vertices every metre or so."""
    turns = np.linspace(0.0, math.pi / 2, max(8, round(radius_m * 1.6)))
    arc = np.stack([radius_m * np.sin(turns), radius_m * (1 - np.cos(turns))], axis=1)
    xy = np.concatenate([[[-100.0, 0.0]], arc, [[radius_m, radius_m + 100.0]]])
    return np.column_stack([xy, np.full(len(xy), 5.0)])


@pytest.mark.parametrize("radius_m", [15.0, 25.0, 60.0, 200.0])
def test_a_curve_has_its_radius(radius_m: float) -> None:
    line = RouteShape(_bend(radius_m))
    arc = radius_m * math.pi / 2
    found = line.between(100.0, 100.0 + arc)
    assert found.least_radius_m == pytest.approx(radius_m, rel=0.03)
    if radius_m < 30.0:
        # Its ends are seen with some of the straight line before and behind them.
        assert arc - 10.0 <= found.tight_m <= arc + 1e-6
    else:
        assert found.tight_m == 0.0


def test_a_straight_line_has_no_radius_however_it_trembles() -> None:
    along = np.arange(0.0, 200.0, 5.0)
    aside = 0.05 * (np.arange(len(along)) % 2)
    line = RouteShape(np.column_stack([along, aside, np.full(len(along), 5.0)]))
    found = line.between(20.0, 180.0)
    assert math.isnan(found.least_radius_m) or found.least_radius_m >= 900.0
    assert found.tight_m == 0.0


def test_a_ramp_has_its_gradient_and_length() -> None:
    xyz = np.array([[0, 0, 5.0], [100, 0, 5.0], [150, 0, 10.0], [250, 0, 10.0]], np.float64)
    line = RouteShape(xyz)
    found = line.between(0.0, 250.0)
    assert found.steepest_percent == pytest.approx(10.0)
    assert 40.0 <= found.steep_m <= 50.0 + 1e-6
    assert line.between(0.0, 90.0).steepest_percent == pytest.approx(0.0)


def test_a_flat_map_says_nothing_of_gradients() -> None:
    line = RouteShape(np.array([[0, 0, 0.0], [100, 0, 0.0]], np.float64))
    assert math.isnan(line.between(0.0, 100.0).steepest_percent)
