"""Trunks of columns: stems of one tree in several columns are one tree, posts aren't."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.methods.road.objects.column_points import ColumnPoints
from processing.methods.road.objects.columns import FoundColumns
from processing.methods.road.trees.column_trunks import ColumnTrunk, column_trunks
from processing.methods.road.trees.trunks import has_flat_sides

MOST_M = 1.2
STEM_M = 0.09


def stem(foot: tuple[float, float], lean: tuple[float, float], wide_m: float = STEM_M) -> Floats:
    """The half of a stem that one scanner sees, a line of points every 5 cm, with 3 mm of noise."""
    random = np.random.default_rng(7)
    up = np.repeat(np.arange(0.1, 4.0, 0.05), 24)
    turn = np.tile(np.linspace(-1.5, 1.5, 24), up.size // 24)
    radius = wide_m / 2 + random.normal(0.0, 0.003, up.size)
    east = foot[0] + lean[0] * up + radius * np.cos(turn)
    return np.column_stack([east, foot[1] + lean[1] * up + radius * np.sin(turn), up])


def trunks_of(*columns: Floats) -> list[ColumnTrunk]:
    """The trunks of columns whose points these are, on level ground."""
    ground = np.random.default_rng(8).uniform(-0.9, 0.9, (800, 3)) * (1, 1, 0)
    middles = np.array([np.median(one[:, :2], axis=0) for one in columns])
    local = [
        np.vstack([one, ground + np.array([*middle, 0.0])])
        for one, middle in zip(columns, middles, strict=True)
    ]
    points = np.vstack(local)
    gathered = ColumnPoints(
        np.cumsum([0, *map(len, local)]),
        points,
        np.zeros(len(points), np.int64),
        np.arange(len(points)),
    )
    free = np.full(len(columns), 0x7FF, np.uint32)
    found = FoundColumns(middles, np.zeros(len(columns)), free)
    return column_trunks(found, gathered, MOST_M, SilentMonitor())


def test_stems_that_leave_the_ground_together_are_one_tree() -> None:
    both = np.vstack([stem((0.0, 0.15), (0.0, 0.1)), stem((-0.1, 0.3), (-0.15, 0.1))])
    tree = trunks_of(stem((0.2, 0.0), (0.2, 0.0)), both, stem((0.0, -0.2), (-0.1, -0.2)))
    assert [len(one.trunk.stems) for one in tree] == [4]
    assert tree[0].trunk.diameter_m == pytest.approx(0.7 * 4 * STEM_M, abs=0.02)
    foot = tree[0].middle + tree[0].trunk.base
    assert np.hypot(*(foot - np.array([0.025, 0.0625]))) < 0.05


def test_posts_side_by_side_stay_two() -> None:
    posts = trunks_of(stem((0.0, 0.0), (0.0, 0.0)), stem((0.6, 0.0), (0.02, 0.0)))
    assert [len(one.trunk.stems) for one in posts] == [1, 1]


def test_trees_that_lean_towards_each_other_stay_two() -> None:
    trees = trunks_of(stem((0.0, 0.0), (0.1, 0.0)), stem((1.3, 0.0), (-0.1, 0.0)))
    assert [len(one.trunk.stems) for one in trees] == [1, 1]


def test_a_stem_that_a_poles_column_holds_is_one_of_its_tree() -> None:
    wide_m, pole = 0.16, stem((1.0, 0.0), (0.0, 0.0), 0.33)
    beside_pole = np.vstack([stem((0.2, 0.0), (0.2, 0.0), wide_m), pole])
    found = trunks_of(stem((0.0, 0.0), (-0.2, 0.0), wide_m), beside_pole)
    assert sorted(len(one.trunk.stems) for one in found) == [1, 2]
    tree = max(found, key=lambda one: len(one.trunk.stems)).trunk
    assert tree.diameter_m == pytest.approx(0.7 * 2 * wide_m, abs=0.01)


def test_the_end_of_a_wall_has_flat_sides_and_a_trunk_has_none() -> None:
    (trunk,) = trunks_of(stem((0.0, 0.0), (0.0, 0.0), 0.36))
    one_drive = np.zeros(len(trunk.about), np.int64)
    assert not has_flat_sides(trunk.trunk.stems[0], trunk.about, one_drive)
    up = np.repeat(np.arange(0.1, 4.0, 0.05), 60)
    along = np.tile(np.linspace(-0.16, 0.16, 20), up.size // 20)
    face = np.tile(np.repeat([0, 1, 2], 20), up.size // 60)
    sides = np.full(along.size, 0.16)
    east = np.choose(face, [sides, along, along])
    north = np.choose(face, [along, sides, -sides])
    foot = np.array([*trunk.trunk.stems[0].base, 0.0])
    points = np.column_stack([east, north, up]) + foot
    assert has_flat_sides(trunk.trunk.stems[0], points, np.zeros(len(points), np.int64))
