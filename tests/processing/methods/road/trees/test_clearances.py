"""How high crowns hang over carriageway and walk, on a ground that is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.objects.ground_heights import GROUND_CELLS, GROUND_M
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.trees.clearances import Clearances, GroundBelowCrowns

CURB_M, EDGE_M, WALL_M = 0.15, 4.8, 8.0
PATH = np.column_stack([np.arange(0.0, 24.0, 0.5), np.full(48, 4.0)])
"""The vehicle drives east."""

FOOT = np.array([12.0, 4.0 + 5.6, CURB_M])


def street(curb_m: float = CURB_M, driven: Floats = PATH) -> GroundBelowCrowns:
    """A road, from 4.8 m beside the path a walk, from 8 m a bank."""
    plan = SparsePlan(np.zeros(3), np.array([25.0, 25.0, 1.0]))
    places = np.stack(np.meshgrid([1.0, 13.0], [1.0, 13.0]), axis=-1).reshape(-1, 2)
    plan.add(np.column_stack([places, np.zeros(4)]))
    ground = np.empty((len(plan), GROUND_CELLS, GROUND_CELLS), np.float32)
    for tile in range(len(plan)):
        north = plan.middles(tile, np.zeros((1, 2), np.int64))[0, 1] - 0.1
        beside = north + (np.arange(GROUND_CELLS) + 0.5) * GROUND_M - PATH[0, 1]
        ground[tile] = np.where(beside < EDGE_M, 0.0, curb_m) + np.where(beside < WALL_M, 0.0, 0.9)
    return GroundBelowCrowns(plan, ground, driven)


def crown(*hangs: tuple[float, float]) -> Floats:
    """Its underside: how far from the path and how high over the plan's origin."""
    return np.array([[12.0, 4.0 + beside, up] for beside, up in hangs])


def test_what_hangs_over_the_road_and_over_the_walk_is_told_apart() -> None:
    told = street().clearances(
        FOOT, crown((3.0, 4.6), (4.0, 4.2), (5.6, 2.8), (6.9, 2.4), (9.0, 2))
    )
    assert told.road_m == pytest.approx(4.2, abs=0.01)
    assert told.walk_m == pytest.approx(2.4 - CURB_M, abs=0.01)


def test_a_crown_over_the_walk_alone_has_no_clearance_over_the_road() -> None:
    told = street().clearances(FOOT, crown((5.5, 2.8), (6.4, 2.6)))
    assert math.isnan(told.road_m)
    assert told.walk_m == pytest.approx(2.6 - CURB_M, abs=0.01)


def test_without_a_curb_half_a_lane_is_road_and_no_walk_is_known() -> None:
    told = street(curb_m=0.0).clearances(FOOT, crown((2.5, 4.4), (4.0, 3.9), (5.5, 2.5)))
    assert told.road_m == pytest.approx(4.4, abs=0.01)
    assert math.isnan(told.walk_m)


@pytest.mark.parametrize(
    "driven", [np.empty((0, 2)), PATH + np.array([0.0, 40.0])], ids=["none", "far"]
)
def test_without_a_path_near_by_neither_is_told(driven: Floats) -> None:
    assert np.isnan(street(driven=driven).clearances(FOOT, crown((3.0, 4.6)))).all()


def test_a_bare_trunk_has_neither() -> None:
    told = street().clearances(FOOT, np.empty((0, 3)))
    assert isinstance(told, Clearances)
    assert np.isnan(told).all()
