"""Bodies of trunks that bend, that ivy stands on, and of which too little is seen for circles."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.trees import alike_stems, cone_kernels
from processing.methods.road.trees.alike_stems import lines_of, pieces_of
from processing.methods.road.trees.cone_kernels import NUMBERS
from processing.methods.road.trees.stems import FittedStem, stems_of
from processing.methods.road.trees.trunks import Trunk, trunk_of

MOST_M = 1.2


def bark(diameter_m: float, *, bend: float = 0.0, lean: float = 0.0, seen: int = 24) -> Floats:
    """The half of a stem that one scanner sees, with 3 mm of noise, bent and leaning eastwards."""
    random = np.random.default_rng(4)
    up = np.repeat(np.arange(0.2, 2.8, 0.05), seen)
    turn = np.tile(np.linspace(-1.5, 1.5, seen), up.size // seen)
    radius = diameter_m / 2 + random.normal(0.0, 0.003, up.size)
    axis = lean * up + bend * (up - 1.2) ** 2
    return np.column_stack([axis + radius * np.cos(turn), radius * np.sin(turn), up])


def trunk_in(points: Floats) -> Trunk:
    trunk = trunk_of(stems_of(points, MOST_M))
    assert trunk is not None
    return trunk


def thickest(points: Floats) -> FittedStem:
    return trunk_in(points).stems[0]


@pytest.mark.parametrize("bend", [-0.08, 0.05])
def test_a_trunk_that_bends_keeps_its_diameter_and_its_foot(bend: float) -> None:
    stem = thickest(bark(0.3, bend=bend))
    assert 2 * stem.radius_m == pytest.approx(0.3, abs=0.006)
    assert stem.bend == pytest.approx([bend, 0.0], abs=0.01)
    assert stem.middle_at(0.0) == pytest.approx([bend * 1.44, 0.0], abs=0.02)
    assert stem.base == pytest.approx(stem.middle_at(0.0))
    assert stem.slope == pytest.approx((stem.middle_at(stem.high_m) - stem.base) / stem.high_m)


def test_a_bent_stem_is_the_same_about_a_higher_foot() -> None:
    stem = thickest(bark(0.2, bend=0.06, lean=0.1))
    higher = stem.about(0.3)
    for height in (0.0, 0.9, 2.0):
        assert higher.middle_at(height) == pytest.approx(stem.middle_at(height + 0.3))
    assert higher.radius_m == pytest.approx(stem.radius_m - 0.3 * stem.taper)


def test_above_a_bent_stem_its_end_goes_straight_on() -> None:
    stem = thickest(bark(0.2, bend=0.06))
    on, low = stem.straight_on, stem.low_m
    end = on[:2] + (stem.high_m - 1.2) * on[2:4]
    assert end == pytest.approx(stem.middle_at(stem.high_m))
    assert on[2:4] == pytest.approx((end - stem.middle_at(low)) / (stem.high_m - low))
    assert stem.middle_at(8.0) == pytest.approx(on[:2] + 6.8 * on[2:4])
    assert not on[8:].any()


def test_a_straight_trunk_stays_straight() -> None:
    assert thickest(bark(0.3, lean=0.05)).bend == pytest.approx([0.0, 0.0], abs=0.002)


def test_ivy_on_a_trunk_is_no_bark() -> None:
    random = np.random.default_rng(7)
    trunk, count = bark(0.08), 500
    up, turn = random.uniform(0.2, 2.8, count), random.uniform(-1.5, 1.5, count)
    away = 0.04 + random.uniform(0.0, 0.05, count)
    ivy = np.column_stack([away * np.cos(turn), away * np.sin(turn), up])
    assert 2 * thickest(np.vstack([trunk, ivy])).radius_m == pytest.approx(0.08, abs=0.012)


def stem_from(foot: tuple[float, float], lean: tuple[float, float], points: Floats) -> Floats:
    """A stem's points about another axis."""
    moved = points.copy()
    moved[:, :2] += np.array(foot) + points[:, 2:] * np.array(lean)
    return moved


def test_a_stem_that_shows_too_little_for_circles_counts_beside_one_like_it() -> None:
    known = stem_from((0.0, 0.1), (0.0, 0.1), bark(0.05, seen=6))
    few = bark(0.05, seen=8)
    # Three points of every second line.
    few = few[np.isin(np.arange(len(few)) % 16, (1, 3, 5))]
    other = stem_from((0.0, -0.1), (0.05, -0.12), few)
    trunk = trunk_in(np.vstack([known, other]))
    assert len(trunk.stems) == 2
    assert trunk.diameter_m == pytest.approx(0.7 * 0.1, abs=0.02)


def test_what_does_not_part_at_the_root_is_no_stem_of_the_tree() -> None:
    known = stem_from((0.0, 0.0), (0.0, 0.0), bark(0.05))
    few = bark(0.05, seen=8)
    few = few[np.isin(np.arange(len(few)) % 16, (1, 3, 5))]
    beside = stem_from((0.0, -0.35), (0.0, 0.0), few)
    assert len(trunk_in(np.vstack([known, beside])).stems) == 1


def test_pieces_are_small_and_stand_apart() -> None:
    random = np.random.default_rng(3)
    small = np.column_stack([0.5 + random.uniform(-0.02, 0.02, (20, 2)), np.full(20, 1.0)])
    hedge = np.column_stack([np.linspace(-0.8, 0.2, 200), np.zeros(200), np.full(200, 1.0)])
    pieces = pieces_of(np.vstack([small, hedge]), np.array([1.0, 2.0]), 0.2, 0.025)
    assert pieces == pytest.approx(np.array([[1.0, 0.5, 0.5]]), abs=0.01)


def test_lines_run_through_pieces_that_part_from_an_axis() -> None:
    heights = np.arange(0.5, 2.05, 0.1)
    parts = np.column_stack([heights, 0.1 + 0.2 * heights, 0 * heights])
    beside = np.column_stack([heights, 0 * heights, np.full(heights.size, 0.3)])
    pieces = np.vstack([parts, beside])
    pieces = pieces[np.argsort(pieces[:, 0], kind="stable")]
    (line,) = lines_of(pieces, np.zeros(4), 0.02)
    assert line == pytest.approx(parts)


def test_the_loops_agree_with_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    body = np.zeros(NUMBERS)
    body[4], body[8] = 0.15, 0.05
    points = bark(0.3, bend=0.05)
    local = points - (0.0, 0.0, 1.2)
    monkeypatch.setattr(cone_kernels, "off_of", cone_kernels.off_of.py_func)
    off = np.hypot(local[:, 0] - 0.05 * local[:, 2] ** 2, local[:, 1]) - 0.15
    near = cone_kernels.near_kernel.py_func(local, body)
    assert near.tolist() == (np.abs(off) <= 0.012).tolist()
    share = cone_kernels.inside_kernel.py_func(local, body)
    assert share == (off < -0.012).sum() / near.sum()
    speaks = np.where(np.abs(off) < 0.012, 1 - (off / 0.012) ** 2, 0.0).sum()
    speaks -= (off < -0.012).sum()
    assert cone_kernels.speaks_kernel.py_func(local, body) == pytest.approx(speaks)
    thinner = body.copy()
    cone_kernels.thinner_kernel.py_func(local, 0.6, thinner)
    assert thinner[4] == pytest.approx(0.09)
    assert thinner[0] + thinner[4] == pytest.approx(0.15, abs=0.002)
    even = cone_kernels.evenness_kernel.py_func(local, body, near)
    clusters = near & (np.abs(np.arctan2(local[:, 1], local[:, 0])) > 1.2)
    clusters &= np.random.default_rng(2).random(len(near)) < 0.5
    assert even > 0.9
    assert cone_kernels.evenness_kernel.py_func(local, body, clusters) <= even
    pieces = np.column_stack([np.arange(0.3, 1.5, 0.1), np.zeros(12), np.zeros(12)])
    on = np.zeros(12, np.bool_)
    monkeypatch.setattr(alike_stems, "_on_kernel", alike_stems._on_kernel.py_func)
    axis = np.array([0.2, 0.0, 0.2, 0.0])
    args = (pieces, np.ones(12, np.bool_), axis, 0.02, on)
    assert alike_stems.line_kernel.py_func(*args) == 12
    assert on.all()
