"""Corners of paint and feet of poles, found about a place."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from processing.core.arrays import Floats
from processing.methods.registration.control_marks import find_corner, find_foot


def _painted(corner: tuple[float, float], turn_deg: float) -> tuple[Floats, Floats]:
    random = np.random.default_rng(3)
    xy = random.uniform(-0.6, 0.6, (6000, 2))
    turn = np.radians(turn_deg)
    about = xy - corner
    along = about @ [np.cos(turn), np.sin(turn)]
    across = about @ [-np.sin(turn), np.cos(turn)]
    inside = (along > 0) & (across > 0) & (across < 0.15)
    return xy, np.where(inside, 3.0, 1.0) + random.normal(0, 0.1, xy.shape[0])


@settings(max_examples=5, deadline=None)
@given(some.floats(-0.05, 0.05), some.floats(-0.05, 0.05), some.floats(0.0, 359.0))
def test_the_corner_of_a_line_is_found_to_some_millimetres(
    east: float, north: float, turn: float
) -> None:
    found = find_corner(*_painted((east, north), turn))
    assert found is not None
    assert found.offset == pytest.approx([east, north], abs=0.01)


def test_asphalt_without_paint_has_no_corner() -> None:
    random = np.random.default_rng(4)
    xy = random.uniform(-0.6, 0.6, (1000, 2))
    assert find_corner(xy, 1.0 + random.normal(0, 0.05, 1000)) is None


def test_the_foot_of_a_leaning_pole_lies_on_its_axis_at_the_height_asked_for() -> None:
    random = np.random.default_rng(5)
    height, angle = random.uniform(0.1, 2.0, 800), random.uniform(-1.2, 1.2, 800)
    pole = np.column_stack(
        [
            0.03 + 0.02 * height + 0.09 * np.cos(angle),
            -0.02 + 0.09 * np.sin(angle),
            height,
        ]
    )
    pole += random.normal(0, 0.003, pole.shape)
    found = find_foot(pole)
    assert found is not None
    assert found.offset == pytest.approx([0.03, -0.02], abs=0.004)


def test_a_wall_is_no_pole() -> None:
    random = np.random.default_rng(6)
    wall = np.column_stack(
        [random.uniform(-0.6, 0.6, 900), np.full(900, 0.1), random.uniform(0.1, 2.0, 900)]
    )
    assert find_foot(wall + random.normal(0, 0.003, wall.shape)) is None
