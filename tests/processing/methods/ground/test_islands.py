"""Parts of the ground that hang together with no other, and what is far from all ground."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.ground.filters import islands
from processing.methods.ground.filters.adaptive import GroundAssumptions, find_ground
from processing.methods.ground.filters.islands import crowded_islands


def test_small_crowded_parts_are_things_and_wide_or_bare_ones_are_ground() -> None:
    """A road, a terrace beyond a step, a yard behind a gap, and the foot of a wall in shadow."""
    heights = np.zeros((40, 60), np.float32)
    ground = np.zeros((40, 60), np.bool_)
    ground[:, :30] = True
    ground[:20, 30:45] = True
    heights[:20, 30:45] = 0.5
    ground[25:30, 50:55] = True
    ground[35:36, 40:50] = True
    heights[35:36, 40:50] = 0.8
    crowded = np.zeros((40, 60), np.bool_)
    crowded[35:36, 40:46] = True
    crowded[:20, 30:45] = True
    found = crowded_islands(heights, ground, crowded, 0.2)
    wall = np.zeros((40, 60), np.bool_)
    wall[35:36, 40:50] = True
    terrace = np.zeros((40, 60), np.bool_)
    terrace[:20, 30:45] = True
    assert np.array_equal(found, wall)
    # Twice as large cells make the terrace 48 m², half as large ones 3 m²: less than a car.
    assert not crowded_islands(heights, ground, crowded, 0.4)[terrace].any()
    assert crowded_islands(heights, ground, crowded, 0.1)[terrace].all()


@pytest.mark.parametrize("is_compiled", [True, False])
def test_parts_touch_by_corners_and_end_at_barriers(is_compiled: bool) -> None:
    heights = np.array([[0, 9, 9, 0], [9, 0, 9, 0.5], [9, 9, 0, 9]], np.float32)
    ground = heights < 5
    labels = np.zeros(heights.shape, np.int32)
    numbers = np.flatnonzero(ground)
    stack = np.empty(numbers.size, np.int64)
    kernel = islands._parts_kernel if is_compiled else islands._parts_kernel.py_func
    assert kernel(numbers, heights, 0.4, stack, labels) == 2
    assert labels[0, 0] == labels[1, 1] == labels[2, 2] == labels[1, 3]
    assert labels[0, 3] != labels[1, 3]


def test_the_foot_of_a_wall_in_a_cars_shadow_is_no_ground() -> None:
    """One scan along a street: behind a car nothing is seen but the wall above half a metre."""
    random = np.random.default_rng(2)
    road = np.column_stack([random.uniform(0, 30, 40_000), random.uniform(0, 8, 40_000)])
    road = np.column_stack([road, random.normal(0, 0.005, len(road))])
    wall = np.column_stack([random.uniform(12, 17, 4000), np.full(4000, 11.0)])
    wall = np.column_stack([wall, random.uniform(0.5, 3.0, 4000)])
    xyz = np.concatenate([road, wall])
    surface = find_ground(lambda: [xyz], GroundAssumptions(), SilentMonitor())
    is_ground = surface.is_ground(xyz)
    assert is_ground[: len(road)].mean() > 0.99
    assert not is_ground[len(road) :].any()
