"""What shafts carry, told from points by construction: mirrors, plates, boards, cloths, arms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.poles.carried import (
    ShaftNeighbourhood,
    carried_of,
    type_of,
)
from processing.methods.road.poles.patch_kernels import (
    BULGING,
    PATCH_WIDTH,
    ROUGH,
    SMOOTH,
    STATE,
    patches_kernel,
)
from processing.methods.road.poles.shaft_kernels import SHAFT_WIDTH
from processing.methods.road.poles.shafts import Shaft

NOISE_M = 0.002
NOTHING = np.empty((0, 3))


def _shaft(diameter_m: float, top_m: float, points: int = 900) -> Shaft:
    heights = np.linspace(0, top_m, points)
    return Shaft(
        foot=np.zeros(3),
        lean=np.zeros(2),
        radius_m=diameter_m / 2,
        taper=0.0,
        deviation_m=0.001,
        noise_m=NOISE_M,
        low_m=0.0,
        top_m=top_m,
        told=np.zeros(SHAFT_WIDTH),
        drives=np.zeros(0, np.int64),
        points=np.zeros(0, np.int64),
        local=np.column_stack([np.zeros(points), np.zeros(points), heights]),
    )


def _plate(wide_m: float, heights: tuple[float, float], before_m: float, sphere_m: float) -> Floats:
    """Points every 3 cm of a board that looks south; bulging as a sphere of a radius does."""
    east, up = np.meshgrid(np.arange(-wide_m / 2, wide_m / 2, 0.03), np.arange(*heights, 0.03))
    middle = sum(heights) / 2
    bulge = (east**2 + (up - middle) ** 2) / (2 * sphere_m)
    points = np.column_stack([east.ravel(), (bulge - before_m).ravel(), up.ravel()])
    return np.asarray(points + np.random.default_rng(3).normal(0, NOISE_M, points.shape))


def _about(*heads: Floats, beyond: Floats = NOTHING) -> ShaftNeighbourhood:
    of = np.repeat(np.arange(len(heads)), [len(one) for one in heads])
    return ShaftNeighbourhood(np.concatenate(heads), of, beyond)


def _type_of(shaft: Shaft, about: ShaftNeighbourhood, *, shines: bool = False) -> str:
    return type_of(shaft, carried_of(about, shaft), over=0.0, is_reflecting=shines)


def test_a_mirror_is_told_though_another_head_sees_the_back_of_its_dish() -> None:
    glass = _plate(0.6, (2.1, 2.7), 0.08, 2.2)
    back = _plate(0.6, (2.1, 2.7), 0.03, 1e6)
    shaft = _shaft(0.0763, 2.8)
    carried = carried_of(_about(glass, back), shaft)
    assert type_of(shaft, carried, over=0.0, is_reflecting=False) == "mirror_pole"
    assert carried.mirror_deg == pytest.approx(180.0, abs=10.0)


def test_a_plate_before_its_back_is_flat() -> None:
    sides = _plate(0.6, (2.1, 2.7), 0.05, 1e6), _plate(0.6, (2.1, 2.7), 0.09, 1e6)
    assert _type_of(_shaft(0.0763, 2.8), _about(*sides)) == "sign_pole"


def test_a_timetable_below_a_disc_makes_no_post_of_a_sign() -> None:
    disc, table = _plate(0.5, (2.0, 2.5), 0.05, 1e6), _plate(0.4, (1.1, 1.8), 0.05, 1e6)
    shaft = _shaft(0.0605, 2.5)
    assert _type_of(shaft, _about(disc)) == "sign_pole"
    assert _type_of(shaft, _about(np.concatenate([disc, table]))) == "other"


def test_a_wall_behind_a_post_is_no_low_plate() -> None:
    sign, wall = _plate(0.6, (2.0, 2.6), 0.05, 1e6), _plate(1.9, (1.0, 1.6), -0.25, 1e6)
    assert _type_of(_shaft(0.0605, 2.6), _about(np.concatenate([sign, wall]))) == "sign_pole"


def test_a_cane_carries_no_sign() -> None:
    assert _type_of(_shaft(0.022, 2.5), _about(_plate(0.6, (2.0, 2.45), 0.04, 1e6))) == "other"


def test_what_a_thick_post_carries_is_a_sign_if_it_shines() -> None:
    shaft, board = _shaft(0.14, 3.6), _about(_plate(1.0, (2.6, 3.5), 0.1, 1e6))
    assert _type_of(shaft, board) == "other"
    assert _type_of(shaft, board, shines=True) == "sign_pole"


def test_the_board_of_a_shop_high_on_its_own_post_is_no_arm_and_no_lamp() -> None:
    shaft, board = _shaft(0.16, 5.4), _plate(1.6, (4.2, 5.4), 0.1, 1e6)
    assert _type_of(shaft, _about(board)) == "other"
    assert _type_of(shaft, _about(board), shines=True) != "other"
    plate = _plate(0.6, (2.4, 3.0), 0.05, 1e6)
    assert _type_of(_shaft(0.16, 5.4), _about(plate)) == "street_light"
    assert _type_of(_shaft(0.0763, 5.5), _about(plate)) == "sign_pole"


def test_an_arm_leads_on_where_its_end_is_nearer_to_a_neighbour() -> None:
    """A signal's arm above the road, beside a tree or another pole."""
    reach = np.arange(0.12, 3.4, 0.01)
    arm = np.column_stack([reach, np.zeros(reach.size), np.full(reach.size, 5.4)])
    lamp = np.stack(np.meshgrid(np.arange(2.6, 3.4, 0.05), [0.0, 0.15], np.arange(5.2, 5.65, 0.05)))
    signal = np.concatenate([arm, lamp.reshape(3, -1).T])
    is_near = signal[:, 0] < 1.4
    shaft = _shaft(0.2, 5.7)
    shaft.foot[:] = 0.0
    own, beyond = signal[is_near], signal[~is_near]
    assert carried_of(_about(own), shaft).arm_m < 2.0
    whole = carried_of(_about(own, beyond=beyond), shaft)
    assert whole.arm_m == pytest.approx(3.3, abs=0.3)
    assert type_of(shaft, whole, over=0.0, is_reflecting=False) == "signal_pole"


def test_patches_of_leaves_are_rough_and_those_of_balls_too_small_for_mirrors() -> None:
    random = np.random.default_rng(7)
    leaves = random.uniform(-0.3, 0.3, (300, 3))
    flat = _plate(0.6, (0.0, 0.6), 0.0, 1e6)
    mirror, ball = _plate(0.6, (0.0, 0.6), 0.0, 2.2), _plate(0.6, (0.0, 0.6), 0.0, 0.45)
    states = []
    for points in (leaves, flat, mirror, ball):
        middle = np.linalg.norm(points - points.mean(axis=0), axis=1).argmin()
        told = np.empty((1, PATCH_WIDTH))
        heads = np.zeros(len(points), np.int64)
        patches_kernel(points, heads, np.array([middle]), np.zeros(2), told)
        states.append(told[0, STATE])
    assert states == [ROUGH, SMOOTH, BULGING, ROUGH]


@pytest.mark.parametrize(
    ("diameter_m", "top_m", "shines", "expected"),
    [
        (0.0605, 0.83, False, "bollard"),
        (0.0605, 0.93, False, "delineator"),
        (0.034, 0.8, False, "delineator"),
        (0.08, 0.68, True, "delineator"),
        (0.1143, 0.7, True, "bollard"),
    ],
)
def test_a_reflector_tells_delineators_and_without_one_their_height(
    diameter_m: float, top_m: float, *, shines: bool, expected: str
) -> None:
    shaft = _shaft(diameter_m, top_m)
    assert _type_of(shaft, _about(NOTHING), shines=shines) == expected
    hidden = carried_of(_about(NOTHING), shaft)
    assert type_of(shaft, hidden, over=0.9, is_reflecting=shines) == "other"


def test_a_conical_post_of_five_metres_is_a_lamp_and_a_straight_one_a_sign() -> None:
    plate = _about(_plate(0.6, (4.4, 5.0), 0.05, 1e6))
    straight = _shaft(0.0891, 5.2)
    assert _type_of(straight, plate) == "sign_pole"
    assert _type_of(replace(straight, taper=0.011), plate) == "street_light"
    assert _type_of(replace(straight, taper=0.0009), plate) == "street_light"
    few = replace(_shaft(0.0891, 5.2, points=40), taper=0.0009)
    assert _type_of(few, plate) == "sign_pole"  # so much is chance of 40 points


def test_the_head_that_ends_a_slim_post_is_a_lamp_and_no_plate() -> None:
    shaft = _shaft(0.0891, 5.0)
    arm = _plate(0.08, (4.96, 5.04), 0.3, 1e6)
    head = _plate(0.3, (4.95, 5.05), 0.85, 1e6)
    along = np.column_stack([np.zeros(40), np.linspace(-0.1, -0.9, 40), np.full(40, 5.0)])
    lamp = np.concatenate([arm, head, along])
    assert _type_of(shaft, _about(lamp)) == "street_light"
    sign = _plate(0.6, (2.6, 3.2), 0.06, 1e6)
    assert _type_of(_shaft(0.0891, 4.0), _about(sign)) == "sign_pole"


def test_what_leads_out_of_sight_to_one_side_of_a_pipe_is_an_arm_and_to_two_are_wires() -> None:
    shaft = _shaft(0.3, 6.9)
    along = np.arange(0.15, 5.4, 0.05)
    pipes = [
        np.column_stack([0 * along, way * along, np.full(along.size, high)])
        for way in (-1.0, 1.0)
        for high in (6.0, 6.8)
    ]
    assert _type_of(shaft, _about(np.concatenate(pipes[:2]))) == "arm_pole"
    assert _type_of(shaft, _about(np.concatenate(pipes))) != "arm_pole"
    concrete = replace(shaft, taper=0.006)
    assert _type_of(concrete, _about(np.concatenate(pipes[:2]))) == "utility_pole"
