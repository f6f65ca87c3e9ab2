"""Parallel copies of lines whose copies are known, and the distance from a line."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.parallels import distance_to_line, parallel
from tests.processing.map.drafting.positions import distances_to, local, positions

SQUARE = positions((0, 0), (10, 0), (10, 10), (0, 10))


def test_a_right_angle_is_mitred_on_both_sides_with_the_heights_beside_it() -> None:
    corner = positions((0, 0, 0), (10, 0, 1), (10, 10, 2))
    left, right = parallel(corner, 1.0), parallel(corner, -1.0)
    assert np.allclose(local(left), [(0, 1, 0), (9, 1, 0.9), (9, 10, 2)], atol=1e-9)
    assert np.allclose(local(right), [(0, -1, 0), (11, -1, 1), (11, 10, 2)], atol=1e-9)


def test_a_ring_grows_to_the_right_and_shrinks_to_the_left() -> None:
    inner = local(parallel(SQUARE, 1.0, is_closed=True))
    outer = local(parallel(SQUARE, -1.0, is_closed=True))
    assert sorted(map(tuple, inner[:, :2].round(6))) == [(1, 1), (1, 9), (9, 1), (9, 9)]
    assert sorted(map(tuple, outer[:, :2].round(6))) == [(-1, -1), (-1, 11), (11, -1), (11, 11)]


def test_no_copy_is_left_where_the_distance_is_larger_than_the_ring() -> None:
    with pytest.raises(OutOfRange) as refusal:
        parallel(SQUARE, 6.0, is_closed=True)
    assert "平行線" in refusal.value.line("ja")
    with pytest.raises(OutOfRange):
        parallel(positions((0, 0, 0), (0, 0, 3)), 1.0)
    with pytest.raises(OutOfRange):
        parallel((), 1.0)


def test_a_bend_narrower_than_the_distance_leaves_no_loop() -> None:
    t = np.linspace(0, np.pi, 60)
    bend = [(np.sin(a), 1 - np.cos(a)) for a in t]
    hairpin = positions((-20, 0), *bend, (-20, 2.5))
    copy = parallel(hairpin, -3.0)
    assert crosses_itself(copy, is_closed=False) is None
    assert distances_to(hairpin, copy).min() > 3 - 1e-6
    street = positions((0, 0), (10, 0), (10.5, 0.5), (10.5, 9), (0, 14))
    for distance in (0.5, 2.0, 4.0):
        copy = parallel(street, distance)
        assert crosses_itself(copy, is_closed=False) is None
        assert distances_to(street, copy).min() > distance - 1e-6


def test_a_small_jog_doesnt_break_the_copy() -> None:
    jog = positions((0, 0), (10, 0), (10.02, 0.1), (20, 0.1), (20.05, 0.0), (30, 0))
    for distance in (-3.0, -0.5, 0.5, 3.0):
        copy = local(parallel(jog, distance))
        assert copy[0, 0] == pytest.approx(0, abs=1e-9)
        assert copy[-1, 0] == pytest.approx(30, abs=1e-9)
        assert (np.diff(copy[:, 0]) >= -1e-9).all()


def test_a_bump_in_the_line_keeps_the_copy_whole() -> None:
    bump = positions((0, 0), (5, 0), (5.5, 0.5), (6, 0), (10, 0))
    for distance in (2.0, -2.0):
        copy = local(parallel(bump, distance))
        assert copy[-1, 0] == pytest.approx(10, abs=1e-9)


def test_a_very_sharp_corner_is_cut_off_at_the_distance() -> None:
    spike = positions((0, 0), (10, 0), (0, 0.5))
    copy = local(parallel(spike, -1.0))
    assert copy[:, 0].max() < 11.1


def test_a_noisy_line_has_a_copy_from_end_to_end() -> None:
    random = np.random.default_rng(3)
    noisy = positions(*((n * 0.1, random.normal(0, 0.02)) for n in range(400)))
    for distance in (-3.0, -0.15, 0.15, 3.0):
        copy = local(parallel(noisy, distance))
        assert copy[0, 0] < 1.5
        assert copy[-1, 0] > 38.5
        inner = copy[(copy[:, 0] > 3) & (copy[:, 0] < 37)]
        assert np.abs(inner[:, 1] - distance).max() < 0.4


def test_no_distance_gives_the_line_itself_and_repeated_places_dont_matter() -> None:
    twice = positions((0, 0, 0), (0, 0, 0), (10, 0, 1), (10, 0, 1))
    assert np.allclose(local(parallel(twice, 1.0)), [(0, 1, 0), (10, 1, 1)])
    assert parallel(SQUARE, 0.0) == SQUARE


def test_ten_thousand_places_have_a_parallel() -> None:
    wave = positions(*((n / 10, 30 * np.sin(n / 500)) for n in range(10_000)))
    copy = parallel(wave, 3.0)
    assert distances_to(wave, copy[::997]) == pytest.approx(3.0, abs=1e-5)


def test_the_distance_is_positive_on_the_left() -> None:
    corner = positions((0, 0), (10, 0), (10, 10))
    beside = positions((5, 2), (5, -2), (12, -2), (8, 3), (11, 5), (-3, 1), (10, 14))
    found = [distance_to_line(corner, position) for position in beside]
    assert found[:2] == pytest.approx([2, -2])
    assert found[2] == pytest.approx(-np.hypot(2, 2))
    assert found[3:5] == pytest.approx([2, -1])
    assert found[5] == pytest.approx(np.hypot(3, 1))
    assert abs(found[6]) == pytest.approx(4)
    assert distance_to_line(SQUARE, positions((1, 5))[0], is_closed=True) == pytest.approx(1)
    assert distance_to_line(SQUARE, positions((-1, -1))[0], is_closed=True) < 0
    with pytest.raises(OutOfRange):
        distance_to_line(SQUARE[:1], SQUARE[1])
