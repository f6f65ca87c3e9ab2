"""Stems of trees and posts: how far they go on, which are the trunk's, and their girth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.trees.diameter_errors import causes_of, wider
from processing.methods.road.trees.rises import followed, rise_of
from processing.methods.road.trees.stems import stems_of
from processing.methods.road.trees.trunks import Trunk, trunk_of, trunks_of

MOST_M = 1.2


def bark(
    diameter_m: float,
    low_m: float,
    high_m: float,
    *,
    middle: tuple[float, float] = (0.0, 0.0),
    thins: float = 0.0,
    oval: float = 0.0,
) -> Floats:
    """The half of a stem that one scanner sees, a line of points every 5 cm, with 3 mm of noise."""
    random = np.random.default_rng(4)
    up = np.repeat(np.arange(low_m, high_m, 0.05), 24)
    turn = np.tile(np.linspace(-1.5, 1.5, 24), up.size // 24)
    radius = diameter_m / 2 - thins * (up - 1.2) + random.normal(0.0, 0.003, up.size)
    east, north = radius * (1 + oval) * np.cos(turn), radius * (1 - oval) * np.sin(turn)
    return np.column_stack([middle[0] + east, middle[1] + north, up])


def leaves(low_m: float, high_m: float, count: int = 3_000) -> Floats:
    """Leaves all round."""
    random = np.random.default_rng(5)
    turn, away = random.uniform(0, 2 * np.pi, count), 0.9 * np.sqrt(random.random(count))
    up = random.uniform(low_m, high_m, count)
    return np.column_stack([away * np.cos(turn), away * np.sin(turn), up])


def trunk_in(*parts: Floats) -> Trunk:
    points = np.vstack(parts)
    trunk = trunk_of(followed(points, stems_of(points, MOST_M)))
    assert trunk is not None
    return trunk


def test_a_post_goes_on_through_leaves_to_its_end() -> None:
    points = np.vstack([bark(0.14, 0.2, 6.0), leaves(2.5, 7.0)])
    rise = rise_of(points, trunk_in(points).stems[0])
    assert rise.high_m == pytest.approx(6.0, abs=0.5)
    assert abs(rise.thins) < 0.02


def test_a_pole_with_a_sleeve_goes_on_above_it() -> None:
    points = np.vstack([bark(0.36, 0.2, 2.4), bark(0.31, 2.4, 7.9)])
    assert rise_of(points, trunk_in(points).stems[0]).high_m > 7.0


def test_a_trunk_ends_where_it_forks_and_is_denser_there_than_a_post_that_ends() -> None:
    forked = [bark(0.3, 0.2, 2.8), leaves(2.5, 6.0)]
    boughs = [
        bark(0.12, 2.8, 4.5, middle=(x, y)) for x, y in ((0.15, 0.1), (-0.15, 0.0), (0.0, -0.2))
    ]
    tree = np.vstack([*forked, *boughs])
    ended = np.vstack([bark(0.06, 0.2, 2.8), leaves(2.5, 6.0)])
    tree_rise = rise_of(tree, trunk_in(tree).stems[0])
    post_rise = rise_of(ended, trunk_in(ended).stems[0])
    assert tree_rise.high_m < 3.6
    assert post_rise.high_m < 3.6
    assert tree_rise.core > 1.0 > post_rise.core


def test_noise_above_a_person_is_nothing_that_goes_on() -> None:
    person = bark(0.3, 0.2, 1.7)
    stray = leaves(1.7, 5.0, 60)
    tree = np.vstack([person, leaves(1.7, 5.0)])
    assert rise_of(np.vstack([person, stray]), trunk_in(person).stems[0]).goes_on < 0.2
    assert rise_of(tree, trunk_in(tree).stems[0]).goes_on > 0.8


def test_a_stem_that_twigs_hide_from_a_height_on_is_no_stake() -> None:
    hidden = np.vstack([bark(0.09, 0.2, 1.7), bark(0.09, 2.3, 4.0)])
    other = bark(0.1, 0.2, 4.0, middle=(0.0, 0.17))
    stake = bark(0.06, 0.2, 1.4, middle=(0.0, -0.3))
    trunk = trunk_in(hidden, other, stake)
    assert len(trunk.stems) == 2
    assert trunk.diameter_m == pytest.approx(0.7 * 0.19, abs=0.012)


def test_a_pole_beside_a_tree_is_none_of_its_stems() -> None:
    points = np.vstack([bark(0.3, 0.2, 3.0), bark(0.32, 0.2, 6.0, middle=(-0.2, 0.6))])
    trunks = trunks_of(followed(points, stems_of(points, MOST_M)))
    assert [len(one.stems) for one in trunks] == [1, 1]
    assert [one.diameter_m for one in trunks] == pytest.approx([0.32, 0.3], abs=0.01)


def test_a_stake_as_high_as_it_is_seen_is_no_stem_of_a_young_tree() -> None:
    stake = bark(0.055, 0.2, 1.8, middle=(0.0, 0.4))
    trunk = trunk_in(bark(0.07, 0.2, 2.0), stake)
    assert trunk.diameter_m == pytest.approx(0.07, abs=0.008)
    assert [2 * one.radius_m for one in trunk.companions] == pytest.approx([0.055], abs=0.008)


def test_a_circle_among_leaves_does_not_replace_the_slender_stem_below_it() -> None:
    random = np.random.default_rng(6)
    stem = bark(0.06, 0.2, 2.1)
    turn, up = random.uniform(-1.2, 1.2, 60), random.uniform(1.6, 2.7, 60)
    radius = 0.12 + random.normal(0.0, 0.006, 60)
    twigs = np.column_stack([radius * np.cos(turn), radius * np.sin(turn) + 0.1, up])
    assert trunk_in(stem, twigs).diameter_m == pytest.approx(0.06, abs=0.008)


def test_a_stake_in_the_outline_of_a_trunk_leaves_its_diameter_open() -> None:
    trunk = trunk_in(bark(0.14, 0.1, 4.0))
    (stem,) = trunk.stems
    stake = replace(stem, radius_m=0.03, base=stem.base + 0.02, high_m=2.0)
    beside, low = replace(stake, base=stem.base + 0.1), replace(stake, high_m=1.0)
    assert Trunk((stem,), (stake,)).diameter_within_m > 0.06
    assert Trunk((stem,), (beside, low)).diameter_within_m == trunk.diameter_within_m < 0.02


def test_of_a_trunk_that_forks_below_the_tape_each_stem_counts() -> None:
    below = bark(0.3, 0.2, 0.7)
    stems = [bark(0.16, 0.7, 3.5, middle=(0.0, y)) for y in (-0.15, 0.15)]
    trunk = trunk_in(below, *stems)
    assert len(trunk.stems) == 2
    assert trunk.girth_m == pytest.approx(0.7 * 2 * math.pi * 0.16, abs=0.03)


def test_of_a_trunk_that_forks_above_the_tape_the_trunk_counts() -> None:
    trunk_below = bark(0.3, 0.2, 1.9)
    stems = [bark(0.16, 1.9, 4.0, middle=(0.0, y)) for y in (-0.2, 0.2)]
    trunk = trunk_in(trunk_below, *stems)
    assert trunk.girth_m == pytest.approx(math.pi * 0.3, abs=0.03)


def test_the_girth_of_an_oval_trunk_is_that_of_its_ellipse() -> None:
    points = np.vstack(
        [bark(0.3, 0.2, 2.6, oval=0.05), bark(0.3, 0.2, 2.6, oval=0.05) * (-1, 1, 1)]
    )
    # Ramanujan's formula; of so round an ellipse that of the mean radius but for a thousandth.
    assert trunk_in(points).girth_m == pytest.approx(math.pi * 0.3, abs=0.012)
    assert trunk_in(points).diameter_within_m < 0.02


def test_a_piece_of_a_wall_beside_a_trunk_is_none() -> None:
    wall = bark(1.1, 0.2, 2.6, middle=(0.0, 0.9))
    narrow = wall[np.abs(wall[:, 1] - 0.9) < 0.25]
    trunk = trunk_in(bark(0.16, 0.2, 2.6), narrow)
    assert trunk.diameter_m == pytest.approx(0.16, abs=0.01)


def test_of_several_stems_that_bend_each_counts() -> None:
    bent = bark(0.07, 0.2, 2.7, middle=(0.2, 0.0))
    bent[:, 0] += 0.03 * (bent[:, 2] - 1.2) ** 2
    trunk = trunk_in(bent, bark(0.09, 0.2, 4.0), bark(0.08, 0.2, 4.0, middle=(0.0, 0.2)))
    assert len(trunk.stems) == 3
    assert trunk.diameter_m == pytest.approx(0.7 * 0.24, abs=0.012)


def wall(start: tuple[float, float], end: tuple[float, float], high_m: float) -> Floats:
    """A line of points every 5 cm of height along a wall, with 3 mm of noise."""
    random = np.random.default_rng(9)
    share = np.tile(np.linspace(0.0, 1.0, 40), round(high_m / 0.05))
    up = np.repeat(np.arange(0.1, 0.1 + high_m, 0.05)[: share.size // 40], 40)
    along = np.outer(1 - share, start) + np.outer(share, end)
    noise = random.normal(0.0, 0.003, along.shape)
    return np.column_stack([along + noise, up[: len(along)]])


def test_the_corner_of_a_wall_is_no_stem() -> None:
    turn = np.linspace(-0.8, 0.8, 12)
    rounded = np.column_stack([0.05 * np.cos(turn), 0.05 * np.sin(turn)])
    up = np.repeat(np.arange(0.1, 2.6, 0.05), len(rounded))
    edge = np.column_stack([np.tile(rounded, (50, 1)), up])
    corner = np.vstack(
        [edge, wall((0.035, 0.036), (-0.6, 0.6), 2.5), wall((0.035, -0.036), (-0.6, -0.6), 2.5)]
    )
    assert not stems_of(corner, MOST_M)


def test_a_circle_among_twigs_is_no_stem_and_the_slender_one_below_is() -> None:
    random = np.random.default_rng(11)
    twigs = np.column_stack(
        [random.uniform(-0.5, 0.5, (2_500, 2)), random.uniform(1.5, 2.7, 2_500)]
    )
    found = stems_of(np.vstack([bark(0.07, 0.2, 1.6), twigs]), MOST_M)
    assert [2 * one.radius_m for one in found] == pytest.approx([0.07], abs=0.008)


def test_a_trunk_with_a_cane_beside_it_stands_free() -> None:
    both = np.vstack([bark(0.08, 0.2, 2.6), bark(0.03, 0.2, 2.4, middle=(0.0, 0.1))])
    assert any(abs(2 * one.radius_m - 0.08) < 0.008 for one in stems_of(both, MOST_M))


def test_a_slender_trunk_before_a_wall_is_found() -> None:
    across, up = np.meshgrid(np.arange(-0.85, 0.85, 0.02), np.arange(0.0, 3.0, 0.05))
    noise = np.random.default_rng(9).normal(0.0, 0.003, across.size)
    wall = np.column_stack([across.ravel(), 0.35 + noise, up.ravel()])
    trunk = trunk_in(bark(0.09, 0.2, 2.6), wall)
    assert len(trunk.stems) == 1
    assert trunk.diameter_m == pytest.approx(0.09, abs=0.01)


def test_a_circle_through_several_stems_is_none() -> None:
    turns = np.radians([90, 180, 270])
    places = [(0.3 * math.cos(turn), 0.3 * math.sin(turn)) for turn in turns]
    stems = stems_of(np.vstack([bark(0.05, 0.2, 2.6, middle=one) for one in places]), MOST_M)
    assert [one.radius_m for one in stems] == pytest.approx([0.025] * 3, abs=0.005)


def test_a_thick_stake_that_ends_below_is_not_the_trunk() -> None:
    young = bark(0.07, 0.2, 2.6)
    stake = bark(0.1, 0.2, 1.1, middle=(0.25, 0.3))
    trunk = trunk_in(young, stake)
    assert trunk.diameter_m == pytest.approx(0.07, abs=0.01)


def test_a_slender_trunk_of_which_few_points_were_measured_is_found() -> None:
    random = np.random.default_rng(8)
    up = np.repeat(np.arange(0.2, 2.8, 0.11), 2)
    turn = random.uniform(-1.4, 1.4, up.size)
    radius = 0.04 + random.normal(0.0, 0.003, up.size)
    trunk = trunk_in(np.column_stack([radius * np.cos(turn), radius * np.sin(turn), up]))
    assert trunk.diameter_m == pytest.approx(0.08, abs=0.02)


def test_a_circle_through_stakes_is_no_trunk_beside_one_that_goes_on() -> None:
    # A tripod of stakes hides the middle of the stem: its circles run through all four.
    whole = stems_of(np.vstack([bark(0.09, 0.2, 0.9), bark(0.09, 1.6, 4.0)]), MOST_M)
    (stem,) = {round(one.radius_m, 2): one for one in whole}.values()
    wide = replace(stem, radius_m=0.3, arc=0.34, noise_m=2.2 * stem.noise_m, low_m=0.9, high_m=1.5)
    trunk = trunk_of([wide, *whole])
    assert trunk is not None
    assert trunk.diameter_m == pytest.approx(0.09, abs=0.01)
    assert trunk.stems[0].low_m < 0.5
    assert trunk.stems[0].high_m > 2.5


def test_a_crowded_short_or_thinly_measured_stem_has_a_wider_error() -> None:
    stem = trunk_in(bark(0.2, 0.2, 4.0)).stems[0]
    sure = wider(causes_of((stem,), 0.2))
    crowded = replace(stem, free_slabs=2)
    short = replace(stem, low_m=1.0, high_m=1.6)
    thin = replace(stem, lines=stem.lines[::20])
    assert sure < 1.5
    for one in (crowded, short, thin):
        assert wider(causes_of((one,), 0.2)) > 1.15 * sure
    trunk = Trunk((crowded,), ())
    assert trunk.diameter_within_m > 1.15 * Trunk((stem,), ()).diameter_within_m
    assert trunk.fitted_within_m == pytest.approx(Trunk((stem,), ()).fitted_within_m)


def test_a_wide_circle_that_shows_less_is_none_beside_a_stem_that_shows_more() -> None:
    stem = replace(trunk_in(bark(0.2, 0.2, 4.0)).stems[0], arc=0.8)
    aside = np.array([stem.base[0] + 0.2, stem.base[1] + 0.15])
    fewer = stem.lines[::3]
    wide = replace(stem, radius_m=0.18, arc=0.34, low_m=1.3, base=aside, lines=fewer)
    trunk = trunk_of([wide, stem])
    assert trunk is not None
    assert trunk.diameter_m == pytest.approx(0.2, abs=0.01)
