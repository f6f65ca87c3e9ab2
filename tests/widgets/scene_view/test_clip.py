"""Parts of space: what they hold, and which boxes may reach into them."""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.search.clip import Clip, planes_kernel
from processing.image.search.corridor import Corridor, CorridorExtent, corridor_kernel
from processing.recording.drive import Drive

BOX = Clip.box(np.array([10.0, 20.0, 0.0]), np.array([14.0, 30.0, 5.0]))
TILTED = np.array([[0.0, 0.0], [3.0, 4.0], [-1.0, 7.0], [-4.0, 3.0]])

SLAB = CorridorExtent(left_m=4.0, right_m=2.5, lowest_m=-0.3, highest_m=2.0)


def test_a_box_holds_its_faces_and_nothing_beyond() -> None:
    positions = np.array([[10.0, 20.0, 0.0], [14.0, 30.0, 5.0], [9.999, 25, 1], [12, 25, 5.001]])
    assert BOX.holds(positions).tolist() == [True, True, False, False]


def test_around_places_is_a_box_with_a_margin() -> None:
    positions = np.array([[0.0, 0.0, 0.0], [4.0, 1.0, 2.0]])
    part = Clip.around(positions, 0.5)
    asked = np.array([[-0.5, -0.5, -0.5], [4.5, 1.5, 2.5], [-0.6, 0, 0], [2, 1.6, 1]])
    assert part.holds(asked).tolist() == [True, True, False, False]


def test_an_upright_part_has_no_ends_in_height() -> None:
    part, area = Clip.upright(TILTED), shapely.Polygon(TILTED)
    asked = np.random.default_rng(3).uniform(-8, 8, (500, 3)) * [1, 1, 1000]
    wanted = shapely.contains_xy(area, asked[:, 0], asked[:, 1])
    assert part.holds(asked).tolist() == wanted.tolist()
    assert 50 < wanted.sum() < 450


@given(st.integers(0, 10_000))
def test_a_box_that_holds_something_shown_is_never_left_out(seed: int) -> None:
    random = np.random.default_rng(seed)
    for part in (BOX, Clip.upright(TILTED)):
        low = random.uniform(-10, 30, (20, 3))
        high = low + random.uniform(0, 10, (20, 3))
        inside = random.uniform(0, 1, (20, 50, 1)) * (high - low)[:, None] + low[:, None]
        holds = part.holds(inside.reshape(-1, 3)).reshape(20, 50).any(axis=1)
        assert (part.may_hold(low, high) | ~holds).all()


def truth_of(
    drive: Drive, slab: CorridorExtent, xyz: Floats
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which places a corridor holds, and which are clearly off its borders."""
    assert drive.trajectory is not None
    vehicle_path = drive.trajectory.xyz
    line = shapely.LineString(vehicle_path[:, :2])
    along = shapely.line_locate_point(line, shapely.points(xyz[:, :2]))
    ends = [
        shapely.get_coordinates(shapely.line_interpolate_point(line, np.maximum(along + step, 0.0)))
        for step in (-0.05, 0.0, 0.05)
    ]
    ahead, off = ends[2] - ends[0], xyz[:, :2] - ends[1]
    left = ahead[:, 0] * off[:, 1] - ahead[:, 1] * off[:, 0]
    away = np.hypot(*off.T)
    limit = np.where(left >= 0, slab.left_m, slab.right_m)
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(vehicle_path[:, :2], axis=0).T))])
    road = np.interp(along, gone, vehicle_path[:, 2])
    near = away < 1.0
    above = xyz[:, 2] - road
    above -= np.percentile(above[near], 10)  # the road is the lowest thing below the vehicle
    inside = (away <= limit) & (above >= slab.lowest_m) & (above <= slab.highest_m)
    is_clear = (np.abs(away - limit) > 0.1) & (away > 0.05)
    is_clear &= (np.abs(above - slab.lowest_m) > 0.1) & (np.abs(above - slab.highest_m) > 0.1)
    return inside, is_clear


def test_a_corridor_reaches_to_both_sides_and_above_the_road(left_drive: Drive) -> None:
    xyz = left_drive.xyz(slice(None))[::40]
    inside, is_clear = truth_of(left_drive, SLAB, xyz)
    held = Corridor(left_drive, SLAB).holds(xyz)
    assert (held[is_clear] == inside[is_clear]).mean() > 0.999
    assert 0 < held.sum() < held.size


def test_boxes_beside_a_corridor_are_left_out_and_others_never(left_drive: Drive) -> None:
    corridor, random = Corridor(left_drive, SLAB), np.random.default_rng(1)
    xyz = left_drive.xyz(slice(None))
    low = xyz[random.integers(0, len(xyz), 200)] + random.uniform(-8, 8, (200, 3))
    high = low + random.uniform(0, 4, (200, 3))
    inside = random.uniform(0, 1, (200, 40, 1)) * (high - low)[:, None] + low[:, None]
    holds = corridor.holds(inside.reshape(-1, 3)).reshape(200, 40).any(axis=1)
    may_hold = corridor.may_hold(low, high)
    assert (may_hold | ~holds).all()
    far = np.array([[500.0, 500.0, 0.0]])
    assert not corridor.may_hold(low[:1] + far, high[:1] + far).any()


def test_places_far_away_and_unknown_ones_are_outside(left_drive: Drive) -> None:
    corridor = Corridor(left_drive, SLAB)
    middle = left_drive.xyz(slice(None)).mean(axis=0)
    far = np.stack([middle + 1e7, middle - 1e7, np.full(3, np.nan)])
    assert not corridor.holds(far).any()


def test_the_plain_loop_gives_the_same() -> None:
    random = np.random.default_rng(2)
    xyz = random.uniform(-3, 3, (300, 3))
    vehicle_path = np.array([[-2.0, 0.0, 0.0], [0.0, 0.0, 0.5], [2.0, 1.0, 1.0]])
    keys = np.arange(36, dtype=np.int64)
    nearest = np.ones(36, np.int64)
    cells = np.array([-3.0, -3.0, 1.0, 6.0])
    limits = np.array([1.0, 2.0, -1.0, 1.0])
    fast, plain = np.empty(300, np.bool_), np.empty(300, np.bool_)
    corridor_kernel(xyz, vehicle_path, keys, nearest, cells, limits, fast)
    corridor_kernel.py_func(xyz, vehicle_path, keys, nearest, cells, limits, plain)  # type: ignore[attr-defined]
    assert fast.tolist() == plain.tolist()
    assert 0 < fast.sum() < 300


def test_the_plain_loop_over_planes_gives_the_same() -> None:
    xyz = np.random.default_rng(4).uniform(8, 32, (300, 3))
    planes, plain = np.array(BOX.planes), np.empty(300, np.bool_)
    planes_kernel.py_func(xyz, planes, plain)  # type: ignore[attr-defined]
    assert BOX.holds(xyz).tolist() == plain.tolist()
