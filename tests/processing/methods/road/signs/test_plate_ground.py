"""The ground below plates: the edge of a viaduct they stand on, not what lies far below it."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import SparsePlan, cell_of
from processing.methods.road.signs.plate_ground import ground_below

ROAD_M, BELOW_M, EDGE = 5.0, -4.0, 6.4
"""Heights of a road and of what lies beside it, and where that begins, m."""

NOWHERE = (float("nan"), float("nan"))


@pytest.fixture
def below() -> tuple[SparsePlan, np.ndarray]:
    plan = SparsePlan(np.zeros(3), np.array([12.0, 12.0, 1.0]))
    places = np.mgrid[0.1:12:0.2, 0.1:12:0.2].reshape(2, -1).T
    plan.add(np.column_stack([places, np.zeros(len(places))]))
    ground = np.full(len(plan) * GROUND_CELLS**2, np.nan, np.float32)
    for x, y in places.tolist():
        cell = int(cell_of(x, y, plan.table, GROUND_CELLS))
        ground[cell] = ROAD_M if y < EDGE else BELOW_M
    return plan, ground


@pytest.mark.parametrize(
    ("y", "road", "level"),
    [
        (6.0, (5.0, 2.0), ROAD_M),
        (6.9, (5.0, 2.0), ROAD_M),
        (6.9, NOWHERE, BELOW_M),
        (9.0, (5.0, 2.0), BELOW_M),
        (6.9, (5.0, 11.0), BELOW_M),
    ],
    ids=["on it", "over its edge", "no vehicle", "far beside it", "of the road below"],
)
def test_a_plate_over_an_edge_stands_on_it(
    below: tuple[SparsePlan, np.ndarray], y: float, road: tuple[float, float], level: float
) -> None:
    assert ground_below(np.array([5.0, y, 8.0]), road, below) == pytest.approx(level)


def test_beside_all_ground_nothing_is_told(below: tuple[SparsePlan, np.ndarray]) -> None:
    assert np.isnan(ground_below(np.array([500.0, 0.0, 8.0]), (5.0, 2.0), below))
