"""Measures of figures whose numbers are known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.map.drafting.measuring import measures_of, width_between
from tests.processing.map.drafting.positions import positions


def _values(measures) -> dict[str, float]:
    return {measure.name.en: measure.value for measure in measures}


def test_two_places_tell_distance_height_and_slope() -> None:
    found = _values(measures_of(positions((0, 0, 0), (3, 4, -0.25)), is_closed=False))
    assert found == pytest.approx(
        {
            "Distance": np.hypot(5, 0.25),
            "Plan distance": 5,
            "Height difference": -0.25,
            "Slope": -5,
            "Gradient 1:n": 20,
            "Direction": np.degrees(np.arctan2(3, 4)),
        }
    )


def test_level_and_plumb_pairs_leave_out_what_has_no_value() -> None:
    level = _values(measures_of(positions((0, 0, 1), (3, 4, 1)), is_closed=False))
    assert level["Slope"] == 0
    assert "Gradient 1:n" not in level
    plumb = _values(measures_of(positions((0, 0, 0), (0, 0, 2)), is_closed=False))
    assert plumb == pytest.approx({"Distance": 2, "Plan distance": 0, "Height difference": 2})
    assert measures_of(positions((0, 0, 1)), is_closed=False) == ()


def test_a_line_tells_its_length_its_last_leg_and_the_angle_before_it() -> None:
    line = positions((0, 0, 0), (10, 0, 0), (10, 3, 4))
    found = _values(measures_of(line, is_closed=False))
    assert found["Length"] == pytest.approx(15)
    assert found["Plan length"] == pytest.approx(13)
    assert found["Last leg"] == pytest.approx(5)
    assert found["Height difference"] == pytest.approx(4)
    assert found["Angle"] == pytest.approx(90)
    straight = _values(measures_of(positions((0, 0), (1, 0), (2, 0)), is_closed=False))
    assert straight["Angle"] == pytest.approx(180)
    still = _values(measures_of(positions((0, 0), (1, 0), (1, 0)), is_closed=False))
    assert "Angle" not in still


def test_a_ring_on_a_slope_has_a_larger_area_than_its_plan() -> None:
    ring = positions((0, 0, 0), (4, 0, 3), (4, 10, 3), (0, 10, 0))
    found = _values(measures_of(ring, is_closed=True))
    assert found == pytest.approx(
        {"Plan area": 40, "Slope area": 50, "Perimeter": 30, "Plan perimeter": 28}
    )


def test_the_width_of_a_widening_road_is_least_at_its_start() -> None:
    left, right = positions((0, 0), (10, 0)), positions((-5, 3), (15, 7))
    width = width_between(left, right)
    assert width.least_m == pytest.approx(4)
    assert width.greatest_m == pytest.approx(6)
    assert width.mean_m == pytest.approx(5)


def test_the_mean_width_doesnt_depend_on_where_vertices_stand() -> None:
    right = positions((0, 3), (10, 8))
    plain = positions((0, 0), (10, 0))
    crowded = positions((0, 0), *((n / 100, 0) for n in range(1, 100)), (10, 0))
    assert width_between(plain, right).mean_m == pytest.approx(5.5, abs=0.01)
    assert width_between(crowded, right).mean_m == pytest.approx(5.5, abs=0.01)


def test_only_the_stretch_beside_the_other_line_counts() -> None:
    width = width_between(positions((0, 0), (100, 0)), positions((40, 4), (60, 4)))
    assert tuple(width) == pytest.approx((4, 4, 4))


def test_the_nearest_crossing_counts_on_either_side() -> None:
    folded = positions((0, -4), (10, -4), (10, -9), (0, -9))
    assert tuple(width_between(positions((1, 0), (9, 0)), folded)) == pytest.approx((4, 4, 4))


def test_lines_that_are_nowhere_beside_each_other_are_refused() -> None:
    with pytest.raises(Unsuitable) as refusal:
        width_between(positions((0, 0), (10, 0)), positions((20, 5), (30, 5)))
    assert "幅" in refusal.value.line("ja")
    with pytest.raises(Unsuitable):
        width_between(positions((0, 0), (0, 0, 5)), positions((20, 5), (30, 5)))


def test_ten_thousand_vertices_have_a_width() -> None:
    left = positions(*((n / 10, np.sin(n / 50)) for n in range(10_000)))
    right = positions(*((n / 10, np.sin(n / 50) + 6) for n in range(10_000)))
    width = width_between(left, right)
    assert 4 < width.least_m <= width.mean_m <= width.greatest_m < 7
