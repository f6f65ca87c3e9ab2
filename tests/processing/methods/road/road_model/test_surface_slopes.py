"""Straight lines through surfaces of known slope, with posts, kerbs and holes in them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.methods.road.road_model.surface_slopes import (
    fall_across,
    row_medians,
    slope_along,
    straight_fit,
)
from processing.methods.road.surface.carriageway import RoadProfiles


def test_a_straight_line_is_found_exactly() -> None:
    x = np.arange(0.0, 4.0, 0.2)
    fit = straight_fit(x, 7.0 + 0.02 * x)
    assert fit.slope == pytest.approx(0.02)
    assert fit.height == pytest.approx(7.0)
    assert fit.within < 2e-4


def test_what_stands_on_a_third_of_it_changes_nothing() -> None:
    x = np.arange(0.0, 6.0, 0.2)
    heights = 0.02 * x
    heights[20:] += 0.15
    heights[3] = np.nan
    assert straight_fit(x, heights).slope == pytest.approx(0.02, abs=1e-6)


def test_an_error_is_as_large_as_noise_makes_it() -> None:
    x, random = np.arange(0.0, 4.0, 0.2), np.random.default_rng(1)
    slopes = [straight_fit(x, random.normal(0, 0.005, x.size)) for _ in range(200)]
    spread = float(np.std([one.slope for one in slopes]))
    assert np.median([one.within for one in slopes]) == pytest.approx(spread, rel=0.25)


@pytest.mark.parametrize("count", [0, 1, 5])
def test_too_few_places_tell_nothing(count: int) -> None:
    assert math.isnan(straight_fit(np.arange(count) * 1.0, np.zeros(count)).slope)
    assert math.isnan(straight_fit(np.zeros(9), np.zeros(9)).slope)


def crowned(fall: float, rise: float) -> RoadProfiles:
    stations, offsets = np.arange(0.0, 40.0, 0.5), np.arange(-40, 41) * 0.2
    heights = rise * stations[:, None] - fall * np.abs(offsets)[None]
    return RoadProfiles(stations, offsets, heights)


def test_a_crown_falls_to_both_sides_and_the_road_rises() -> None:
    profiles = crowned(0.02, 0.05)
    slope = slope_along(profiles, 20.0)
    assert slope.slope == pytest.approx(0.05)
    for is_left in (True, False):
        fall = fall_across(profiles, 20.0, 3.5, slope, is_left=is_left)
        assert fall.slope == pytest.approx(0.02)
    assert math.isnan(fall_across(profiles, 20.0, math.nan, slope, is_left=True).slope)


def test_medians_leave_out_what_is_not_known() -> None:
    rows = np.array([[1.0, np.nan, 3.0], [np.nan, np.nan, np.nan], [5.0, 1.0, 2.0]])
    np.testing.assert_array_equal(row_medians(rows), [2.0, np.nan, 2.0])
    assert row_medians(np.empty((2, 0))).shape == (2,)


def test_what_lies_far_below_most_of_the_road_is_no_surface() -> None:
    profiles = crowned(0.02, 0.0)
    profiles.heights[:, :33] -= 1.5
    profiles.heights[:, 33:37] = np.nan
    slope = slope_along(profiles, 20.0)
    fall = fall_across(profiles, 20.0, 5.0, slope, is_left=False)
    assert math.isnan(fall.slope) or fall.slope == pytest.approx(0.02, abs=1e-6)
