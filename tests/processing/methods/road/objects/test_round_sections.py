"""How round a section is: trunks bend all the way round, piers at their corners alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.arrays import Floats
from processing.methods.road.objects.round_sections import round_share

NOISE_M = 0.004


def circle(radius_m: float, noise_m: float = NOISE_M, turns: float = 0.5) -> Floats:
    """What one scanner sees of a trunk."""
    random = np.random.default_rng(3)
    turn = random.uniform(-np.pi * turns, np.pi * turns, 1_500)
    out = radius_m + random.normal(0.0, noise_m, turn.size)
    return np.column_stack([out * np.cos(turn), out * np.sin(turn)])


def pier(half_m: float, aside_m: float = 0.0, noise_m: float = NOISE_M) -> Floats:
    """Two sides of a square pier, which stands a little aside."""
    random = np.random.default_rng(4)
    along = random.uniform(-half_m, half_m, 1_500)
    off = half_m + random.normal(0.0, noise_m, along.size)
    is_first = random.random(along.size) < 0.5
    sides = np.where(
        is_first[:, None], np.column_stack([along, off]), np.column_stack([off, along])
    )
    return sides + aside_m


def share(*drives: Floats, radius_m: float) -> float:
    points = np.vstack(drives)
    numbers = np.repeat(np.arange(len(drives)), [len(one) for one in drives])
    return round_share(points, np.full(len(points), radius_m), numbers)


@given(radius_m=st.floats(0.12, 0.6), turns=st.floats(0.3, 1.0))
def test_a_circle_is_round_whatever_its_size(radius_m: float, turns: float) -> None:
    assert share(circle(radius_m, turns=turns), radius_m=radius_m) > 0.8


@given(half_m=st.floats(0.12, 0.5))
def test_a_pier_is_not(half_m: float) -> None:
    assert share(pier(half_m), radius_m=1.13 * half_m) < 0.4


def test_nor_one_that_passes_double() -> None:
    assert share(pier(0.4), pier(0.4, 0.04), radius_m=0.45) < 0.4


def test_passes_that_lie_apart_leave_a_trunk_round() -> None:
    assert share(circle(0.2), circle(0.2) + 0.03, radius_m=0.2) > 0.8


@pytest.mark.parametrize("points", [circle(0.03), circle(0.2)[:30], circle(0.1, 0.03)])
def test_thin_things_few_points_and_noise_say_nothing(points: Floats) -> None:
    assert math.isnan(share(points, radius_m=float(np.hypot(*points.T).mean())))


def test_no_points_say_nothing() -> None:
    assert math.isnan(share(np.empty((0, 2)), radius_m=0.2))
