"""Cells about trunks: leaves fill them, walls and wires don't, boughs rise."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from processing.core.arrays import Floats
from processing.methods.road.objects.columns import _columns_of
from processing.methods.road.objects.sparse_plan import TILE
from processing.methods.road.trees.crown_cells import (
    CrownCells,
    StandingStems,
    _keys_of,
    fill_kernel,
    shapes_kernel,
)


def shapes_of(points: Floats) -> tuple[float, float]:
    """Shares of cells that are flat, and that are boughs."""
    count = 4_096
    slots = np.full((2, 2 * count), -1, np.int64)
    sums, boxes = np.zeros((count, 10), np.float32), np.zeros((count, 6), np.float32)
    places = np.zeros((count, 4), np.int64)
    stems = StandingStems(np.zeros(2, np.int64), np.zeros((0, 7)), np.zeros(1))
    plan = (np.zeros((4, 4), np.int32), np.zeros(TILE * TILE, np.int32))
    is_noise = np.zeros(len(points), np.bool_)
    end, used = fill_kernel(points, is_noise, (0, 0), plan, stems, (slots, places, sums, boxes))
    assert end == len(points)
    assert sums[:used, 0].sum() == len(points)
    told = tuple(np.zeros((3, used), np.bool_))
    keys = _keys_of(places[:used, :3])
    order = np.argsort(keys)
    shapes_kernel(keys[order], order, sums[:used], (told[0], told[1], told[2]))
    known = told[0]
    return float(told[1][known].mean()), float(told[2][known].mean())


def along(direction: Floats, step_m: float = 0.02) -> Floats:
    """A line of points through (5, 5, 3)."""
    run = np.arange(-1.0, 1.0, step_m)[:, None]
    noise = np.random.default_rng(1).normal(0.0, 0.005, (run.size, 3))
    return np.asarray(np.array([5.0, 5.0, 3.0]) + run * direction + noise)


@pytest.mark.parametrize(
    ("points", "flat", "bough"),
    [
        (np.random.default_rng(2).uniform(2.0, 5.0, (20_000, 3)), 0.0, 0.0),
        (
            np.random.default_rng(2).uniform(2.0, 5.0, (20_000, 3)) * (1, 0, 1) + (0, 3.33, 0),
            1.0,
            0.0,
        ),
        (along(np.array([1.0, 0.0, 0.1])), 1.0, 0.0),
        (along(np.array([0.0, 0.0, 1.0])), 1.0, 0.0),
        (along(np.array([0.6, 0.2, 0.7])), 0.0, 1.0),
    ],
    ids=["leaves", "wall", "wire", "pipe", "bough"],
)
def test_the_shape_of_cells_is_told(points: Floats, flat: float, bough: float) -> None:
    assert shapes_of(points) == pytest.approx((flat, bough), abs=0.1)


def test_a_plate_is_flat_among_the_stray_points_that_its_shine_makes() -> None:
    random = np.random.default_rng(6)
    plate = random.uniform((4.9, 5.0, 2.5), (5.5, 5.0, 3.1), (3_000, 3))
    stray = random.normal((5.2, 5.0, 2.8), (0.3, 0.3, 0.3), (60, 3))
    assert shapes_of(np.vstack([plate, stray]))[0] > 0.8


def cells_at(places: list[tuple[int, int, int]]) -> CrownCells:
    count = len(places)
    none, flags = np.zeros((count, 3), np.float32), np.zeros(count, np.bool_)
    at, ones = np.array(places, np.int64), np.ones(count, np.int64)
    return CrownCells(at, ones, ones, none, none, flags, flags, flags)


def test_cells_that_touch_hang_together_and_parts_count_from_the_first_cell() -> None:
    cells = cells_at([(5, -3, 2), (0, 0, 0), (1, 1, 1), (1, 1, -1), (3, 1, 1), (0, -1, 0)])
    is_open = np.ones(len(cells), np.bool_)
    assert cells.components(is_open, 1).tolist() == [0, 1, 1, 1, 2, 1]
    assert cells.components(is_open, 2).tolist() == [0, 1, 1, 1, 1, 1]
    is_open[1] = False
    assert cells.components(is_open, 1).tolist() == [0, -1, 1, 2, 3, 4]


@pytest.mark.parametrize("link", [1, 2])
def test_components_are_those_of_all_pairs_within_reach(link: int) -> None:
    places = np.unique(np.random.default_rng(link).integers(-9, 9, (500, 3)), axis=0)
    cells = cells_at(list(map(tuple, places.tolist())))
    is_near = (np.abs(places[:, None] - places[None]) <= link).all(axis=2)
    expected = connected_components(coo_matrix(is_near), directed=False)[1]
    parts = cells.components(np.ones(len(cells), np.bool_), link)
    assert parts.tolist() == expected.tolist()


def test_a_thick_trunk_is_a_column_though_its_middle_is_empty() -> None:
    slabs = np.zeros((TILE + 14, TILE + 14), np.uint32)
    ring = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    for i, j in ring:
        slabs[30 + i, 40 + j] = (1 << 20) - 1
    found, raised = _columns_of(slabs)
    assert found
    assert raised == []
    for middle, _ in found:
        assert middle == pytest.approx(np.array([31.5, 41.5]) - 7, abs=1.0)
