"""The ground about columns where the coarse map holds the bottom of something deep."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.objects.foot import ground_beside_kernel

DEEP_M = -0.48


def _street(deep: float, share: float) -> Floats:
    """Points of a street, a share of those beyond 0.25 m to the south as deep as told."""
    random = np.random.default_rng(4)
    plan = random.uniform(-0.7, 0.7, (4_000, 2))
    is_deep = (plan[:, 1] < -0.25) & (random.random(len(plan)) < share)
    heights = np.where(is_deep, deep, 0.0) + random.normal(0, 0.004, len(plan))
    return np.column_stack([plan, heights])


def _hedge() -> Floats:
    """Its flat top and what is seen of its sides; nothing of the ground."""
    random = np.random.default_rng(5)
    places = random.uniform([-0.7, -0.7, 0.0], [0.7, 0.7, 0.6], (3_000, 3))
    places[: len(places) // 2, 2] = 0.6
    return places


def _ground(points: Floats, coarse: float) -> float:
    told = []
    for kernel in (ground_beside_kernel, ground_beside_kernel.py_func):  # type: ignore[attr-defined]
        ground = np.zeros(1)
        starts = np.array([0, len(points)], np.int64)
        kernel(points, starts, np.zeros((1, 2)), np.array([coarse]), ground)
        told.append(float(ground[0]))
    assert told[0] == pytest.approx(told[1])
    return told[0]


@pytest.mark.parametrize("coarse", [DEEP_M, -0.2, 0.0])
def test_the_bottom_of_an_open_gutter_is_not_the_ground_of_a_post(coarse: float) -> None:
    assert _ground(_street(DEEP_M, 0.3), coarse) == pytest.approx(0.0, abs=0.05)


def test_at_a_step_the_coarse_map_is_asked() -> None:
    assert _ground(_street(-0.3, 1.0), -0.3) == -0.3


def test_a_hedge_is_no_ground() -> None:
    assert _ground(_hedge(), 0.0) == pytest.approx(0.0, abs=0.1)


def test_where_nothing_was_seen_the_coarse_map_is_asked() -> None:
    assert _ground(np.empty((0, 3)), 1.5) == 1.5
