"""Kernels of the road's surface and of the room over it, against plain numpy."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.clearance.hanging_bodies import touching_cubes
from processing.methods.road.clearance.passed_through import is_arc
from processing.methods.road.clearance.points_over_road import over_kernel
from processing.methods.road.clearance.thing_types import shape_of, thing_of
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan
from processing.methods.road.surface.road_raster import (
    cells_at,
    low_layer_kernel,
    lowest_two_kernel,
    middles_of,
)


@pytest.fixture
def plan() -> SparsePlan:
    plan = SparsePlan(np.zeros(3), np.array([25.0, 12.0, 5.0]))
    plan.add(np.array([[1.0, 1.0, 0.0], [20.0, 3.0, 0.0]]))
    return plan


@pytest.fixture
def local() -> np.ndarray:
    random = np.random.default_rng(5)
    return np.asarray(random.uniform((-2, -2, 0), (27, 14, 3), (4000, 3)))


def test_cells_lie_about_their_middles(plan: SparsePlan, local: np.ndarray) -> None:
    cells = cells_at(plan, local[:, :2])
    known = cells >= 0
    assert 0 < known.sum() < len(local)
    away = np.abs(middles_of(plan, cells[known]) - local[known, :2])
    assert away.max() <= 0.1 + 1e-9


@pytest.mark.parametrize("is_plain", [True, False])
def test_the_surface_is_the_mean_of_the_low_layer(
    plan: SparsePlan, local: np.ndarray, is_plain: bool
) -> None:
    lowest_two = lowest_two_kernel.py_func if is_plain else lowest_two_kernel
    low_layer = low_layer_kernel.py_func if is_plain else low_layer_kernel
    noise = np.zeros(len(local), np.bool_)
    noise[::7] = True
    lowest = np.full((len(plan) * TILE * TILE, 2), 1e9, np.float32)
    lowest_two(local, noise, plan.table, lowest)
    cells = cells_at(plan, local[:, :2])
    base = lowest[:, 0].copy()
    sums, counts = np.zeros(len(base), np.float32), np.zeros(len(base), np.uint16)
    low_layer(local, noise, plan.table, (base, sums, counts))
    for cell in np.unique(cells[(cells >= 0) & ~noise])[:200].tolist():
        heights = np.sort(local[(cells == cell) & ~noise, 2]).astype(np.float32)
        np.testing.assert_array_equal(lowest[cell, : min(2, heights.size)], heights[:2])
        layer = local[(cells == cell) & ~noise, 2] - base[cell]
        layer = layer[(layer >= -0.02) & (layer <= 0.05)]
        assert counts[cell] == layer.size
        assert sums[cell] == pytest.approx(layer.sum(), abs=1e-5)


@pytest.mark.parametrize("is_plain", [True, False])
def test_points_count_between_the_surface_and_the_limit(
    plan: SparsePlan, local: np.ndarray, is_plain: bool
) -> None:
    over_of = over_kernel.py_func if is_plain else over_kernel
    count = len(plan) * TILE * TILE
    surface = np.full(count, 0.25, np.float32)
    part = (np.arange(count) % 3).astype(np.uint8)
    cells, over = np.empty(len(local), np.int64), np.empty(len(local))
    over_of(local, plan.table, (surface, part), np.array([0.0, 2.0, 1.0]), (cells, over))
    np.testing.assert_array_equal(cells, cells_at(plan, local[:, :2]))
    known = cells >= 0
    above = local[:, 2] - np.float32(0.25)
    limits = np.array([0.0, 2.0, 1.0])[np.where(known, part[cells], 0)]
    wanted = known & (limits > 0) & (above > 0.3) & (above < limits)
    np.testing.assert_array_equal(np.isfinite(over), wanted)
    np.testing.assert_allclose(over[wanted], above[wanted], rtol=1e-6)


def test_cubes_that_touch_at_a_corner_are_one_body() -> None:
    places = np.array([[0.1, 0.1, 0.1], [0.4, 0.4, 0.4], [1.4, 0.1, 0.1], [1.5, 0.2, 0.2]])
    body = touching_cubes(places, 0.3)
    assert body[0] == body[1] != body[2] == body[3]
    assert touching_cubes(np.empty((0, 3)), 0.3).shape == (0,)


def test_shapes_and_classes_tell_what_hangs_there() -> None:
    random = np.random.default_rng(2)
    line = np.column_stack([np.linspace(0, 4, 80), np.zeros(80), np.full(80, 4.0)])
    assert shape_of(line + random.normal(0, 0.01, line.shape)) == "wire"
    plate = random.uniform((0, 0, 2), (0, 1, 3), (300, 3))
    assert shape_of(plate) == "sign"
    assert shape_of(plate[:, [1, 2, 0]]) == "structure"
    crown = random.uniform(0, 1.5, (500, 3))
    assert shape_of(crown) == "tree"
    codes = np.full(500, 14, np.uint8)
    assert thing_of(codes, crown) == ("wire", True)
    assert thing_of(np.where(np.arange(500) % 3 == 0, 14, 0).astype(np.uint8), crown) == (
        "tree",
        False,
    )


@pytest.mark.parametrize("turned", [(20.0, 110.0), (-10.0, 60.0)])
def test_an_arc_about_the_scanner_is_told_from_what_is_flat(turned: tuple[float, float]) -> None:
    random = np.random.default_rng(4)
    angle = np.radians(np.linspace(*turned, 300))
    noise = random.normal(0, 0.02, 300)
    arc = np.column_stack([(2.8 + noise) * np.cos(angle), 2.0 + (2.8 + noise) * np.sin(angle)])
    assert is_arc(*arc.T)
    assert not is_arc(np.full(300, np.inf), arc[:, 1])
    across = np.linspace(-1.5, 1.5, 300)
    assert not is_arc(across, 3.9 + noise)
    assert not is_arc(across + 1.0, 3.0 + 0.5 * across + noise)
    assert not is_arc(*random.uniform((-1.0, 2.0), (1.0, 4.0), (300, 2)).T)
    # A round pipe about the middle of the road, beside which the vehicle drives.
    lining = np.radians(np.linspace(20.0, 70.0, 300))
    assert not is_arc(1.5 + 4.0 * np.cos(lining), 1.0 + 4.0 * np.sin(lining))
