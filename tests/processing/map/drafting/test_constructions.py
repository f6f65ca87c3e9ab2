"""Arcs, splines, circles, rectangles against figures whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.map.drafting.constructions import (
    arc_through,
    circle_through,
    rectangle_from,
    spline_through,
)
from tests.processing.map.drafting.positions import distances_to, local, positions


def test_an_arc_lies_on_the_circle_of_its_three_places() -> None:
    first, second, third = positions((10, 0, 1), (0, 10, 2), (-10, 0, 4))
    arc = arc_through(first, second, third, tolerance_m=0.01)
    assert arc[0] == first
    assert arc[-1] == third
    assert second in arc
    found = local(arc)
    assert np.allclose(np.hypot(found[:, 0], found[:, 1]), 10, atol=1e-9)
    middles = (found[1:] + found[:-1]) / 2
    assert 10 - np.hypot(middles[:, 0], middles[:, 1]).min() <= 0.01
    angles = np.degrees(np.arctan2(found[:, 1], found[:, 0])) % 360
    assert np.allclose(found[:, 2], np.interp(angles, [0, 90, 180], [1, 2, 4]))


def test_an_arc_turns_the_way_its_second_place_says() -> None:
    first, second, third = positions((10, 0), (0, -10), (-10, 0))
    assert local(arc_through(first, second, third))[:, 1].max() <= 1e-9
    long_way = arc_through(*positions((10, 0), (-10, 0), (0, -10)))
    assert local(long_way)[:, 1].max() == pytest.approx(10, abs=0.02)


def test_an_arc_of_places_in_a_row_is_straight() -> None:
    row = positions((0, 0, 0), (5, 0.001, 1), (10, 0, 3))
    assert arc_through(*row) == row
    back = positions((0, 0, 0), (10, 0, 1), (5, 0, 3))
    assert arc_through(*back) == back
    assert arc_through(row[0], row[0], row[2]) == (row[0], row[2])
    assert arc_through(row[0], row[1], row[0]) == (row[0], row[1], row[0])


def test_a_circle_lies_on_the_tilted_plane_of_its_places() -> None:
    normal = np.array([0.3, -0.2, 1.0]) / np.linalg.norm([0.3, -0.2, 1.0])
    one = np.cross(normal, [1.0, 0, 0])
    one /= np.linalg.norm(one)
    other = np.cross(normal, one)
    given = positions(*(0.3 * (np.cos(a) * one + np.sin(a) * other) for a in (0.1, 2.0, 3.5)))
    ring = circle_through(*given, tolerance_m=0.001)
    assert ring[0] == given[0]
    assert set(given) <= set(ring)
    assert ring[-1] != ring[0]
    found = local(ring)
    assert np.allclose(np.linalg.norm(found, axis=1), 0.3, atol=1e-9)
    assert np.allclose(found @ normal, 0, atol=1e-9)
    middles = (found + np.roll(found, -1, axis=0)) / 2
    assert 0.3 - np.linalg.norm(middles, axis=1).min() <= 0.001


def test_figures_of_places_in_a_row_are_refused_in_both_languages() -> None:
    row = positions((0, 0, 0), (1, 1, 1), (3, 3, 3))
    for figure in (circle_through, rectangle_from):
        with pytest.raises(OutOfRange) as refusal:
            figure(*row)
        assert "straight line" in refusal.value.line("en")
        assert "一直線上" in refusal.value.line("ja")
    with pytest.raises(OutOfRange):
        rectangle_from(row[0], row[0], row[2])
    with pytest.raises(OutOfRange):
        circle_through(row[0], row[0], row[0])


def test_a_rectangle_reaches_to_the_third_place_with_right_angles() -> None:
    corners = rectangle_from(*positions((0, 0, 0), (2, 0, 0), (1.5, 0.5, 0.1)))
    expected = [(0, 0, 0), (2, 0, 0), (2, 0.5, 0.1), (0, 0.5, 0.1)]
    assert np.allclose(local(corners), expected, atol=1e-9)


def test_a_spline_goes_through_all_places_and_stays_smooth() -> None:
    angles = np.linspace(0, np.pi, 9)
    given = positions(*((20 * np.cos(a), 20 * np.sin(a), a) for a in angles))
    curve = spline_through(given, tolerance_m=0.005)
    assert set(given) <= set(curve)
    found = local(curve)
    # Between inner places the curve is as round as the circle it was taken from.
    inner = found[found[:, 1] > 8]
    assert np.abs(np.hypot(inner[:, 0], inner[:, 1]) - 20).max() < 0.05
    steps = np.diff(found[:, :2], axis=0)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    assert np.abs(np.diff(headings)).max() < 0.2
    assert (np.diff(found[:, 2]) > 0).all()


def test_finer_chords_stay_within_the_tolerance_of_the_curve() -> None:
    given = positions((0, 0), (10, 0), (10, 10), (30, 12), (31, 0))
    coarse, fine = (spline_through(given, tolerance) for tolerance in (0.02, 0.0005))
    assert len(coarse) < len(fine)
    assert distances_to(coarse, fine).max() <= 0.021


def test_a_spline_of_one_or_two_places_is_what_it_was() -> None:
    two = positions((0, 0), (1, 1))
    assert spline_through(two) == two
    assert spline_through((two[0], two[0], two[1])) == two
    assert spline_through(two[:1]) == two[:1]
    assert spline_through(()) == ()


def test_a_spline_keeps_places_above_one_another() -> None:
    given = positions((0, 0, 0), (5, 1, 0), (5, 1, 0.15), (10, 0, 0.15))
    curve = spline_through(given)
    assert set(given) <= set(curve)
    assert set(np.round(local(curve)[:, 2], 6)) == {0.0, 0.15}
    plumb = positions((0, 0, 0), (0, 0, 1), (0, 0, 2))
    assert spline_through(plumb) == plumb


def test_ten_thousand_places_make_a_spline() -> None:
    given = positions(*((n * 0.5, np.sin(n / 9), 0.0) for n in range(10_000)))
    assert set(given) <= set(spline_through(given))
