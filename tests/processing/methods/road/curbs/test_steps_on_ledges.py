"""A curb close behind an open gutter stands on the top of its wall: they are two steps, not one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_profile import StepSettings, steps_on_lines
from processing.methods.road.curbs.steps.step_columns import (
    LOWER_ACROSS,
    LOWER_HEIGHT,
    UPPER_ACROSS,
    UPPER_HEIGHT,
)

Floats = NDArray[np.float64]

WALL_M, FACE_M, HIGH_M, DEEP_M = 0.08, 0.08, 0.125, 0.25


def line(seed: int, wall_at_m: float) -> tuple[Floats, Floats]:
    """A scanline seen from some metres away: many vertices on wall and face, three between."""
    random = np.random.default_rng(seed)
    foot = wall_at_m + WALL_M
    road = np.arange(0.0, wall_at_m - 0.33, 0.025)
    wall = wall_at_m + random.uniform(-0.004, 0.004, 10)
    ledge = wall_at_m + random.uniform(0.0, 0.01) + np.array([0.0, 0.031, 0.062])
    face = np.linspace(0.05, 0.95, 8)
    top = np.arange(foot + FACE_M, foot + 0.5, 0.035)
    x = np.concatenate([road, [wall_at_m - 0.06], wall, ledge, foot + FACE_M * face, top])
    deep = [[-0.9 * DEEP_M], random.uniform(-DEEP_M, -0.3 * DEEP_M, wall.size)]
    h = np.concatenate([0 * road, *deep, 0 * ledge, HIGH_M * face, np.full(top.size, HIGH_M)])
    order = np.argsort(x)
    return x[order], h[order] + random.normal(0.0, 0.002, x.size)


@pytest.mark.parametrize("wall_at_m", [2.895, 2.905])
def test_a_curb_on_the_wall_of_a_gutter_keeps_its_own_foot(wall_at_m: float) -> None:
    lines = [line(seed, wall_at_m) for seed in range(20)]
    starts = np.append(0, np.cumsum([x.size for x, _ in lines]))
    along, height = (np.concatenate([one[k] for one in lines]) for k in (0, 1))
    table = steps_on_lines((along, height, starts), 4.0, StepSettings(), is_square=True)
    is_right = np.abs(table[:, LOWER_ACROSS] - wall_at_m - WALL_M) < 0.03
    is_right &= np.abs(table[:, LOWER_HEIGHT]) < 0.02
    is_right &= np.abs(table[:, UPPER_ACROSS] - wall_at_m - WALL_M - FACE_M) < 0.03
    is_right &= np.abs(table[:, UPPER_HEIGHT] - HIGH_M) < 0.02
    assert is_right.sum() >= 18
