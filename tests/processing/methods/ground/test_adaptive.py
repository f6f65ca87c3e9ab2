"""Ground of clouds whose truth is built in."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.core.monitor import SilentMonitor
from processing.methods.ground.filters.adaptive import GroundAssumptions, GroundSurface, find_ground
from processing.methods.ground.filters.published_method import PublishedSteps, published_surface


def _plane(side_m: float, step_m: float, slope: float = 0.0) -> np.ndarray:
    x, y = np.meshgrid(np.arange(0.0, side_m, step_m), np.arange(0.0, side_m, step_m))
    noise = np.random.default_rng(1).normal(0.0, 0.003, x.size)
    return np.column_stack([x.ravel(), y.ravel(), slope * x.ravel() + noise])


def _box(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    """Points on the top and the four sides."""
    rng = np.random.default_rng(2)
    low_corner, high_corner = np.array(low), np.array(high)
    points = rng.uniform(low_corner, high_corner, (8000, 3))
    side = rng.integers(0, 5, len(points))
    points[side == 0, 2] = high[2]
    for number, (axis, value) in enumerate(((0, low[0]), (0, high[0]), (1, low[1]), (1, high[1]))):
        points[side == number + 1, axis] = value
    return points


def _found(xyz: np.ndarray) -> GroundSurface:
    return find_ground(lambda: [xyz], GroundAssumptions(), SilentMonitor())


def _without(xyz: np.ndarray, low: tuple[float, float], high: tuple[float, float]) -> np.ndarray:
    inside = np.all((xyz[:, :2] > low) & (xyz[:, :2] < high), axis=1)
    return xyz[~inside]


_CUT_DEG = 75.0
"""As firm earth is cut."""


def _step(east: np.ndarray, east_m: float, height_m: float) -> np.ndarray:
    """Heights of a step of cut earth, its top at ``east_m``."""
    steep = np.tan(np.radians(_CUT_DEG))
    return np.clip((east - east_m) * steep + height_m, 0.0, height_m)


def _face(east_m: float, length_m: float, height_m: float, count: int, *, seed: int) -> np.ndarray:
    """Points on the face of such a step."""
    rng = np.random.default_rng(seed)
    up = rng.uniform(0.0, height_m, count)
    east = east_m - (height_m - up) / np.tan(np.radians(_CUT_DEG))
    return np.column_stack([east, rng.uniform(0.0, length_m, count), up])


def test_a_machine_on_a_slope_is_removed_and_the_slope_stays() -> None:
    ground = _without(_plane(30.0, 0.12, slope=0.3), (10.0, 10.0), (14.0, 12.5))
    machine = _box((10.0, 10.0, 3.3), (14.0, 12.5, 6.5))
    is_ground = _found(np.vstack([ground, machine])).is_ground(np.vstack([ground, machine]))
    assert is_ground[: len(ground)].mean() > 0.99
    assert is_ground[len(ground) :].mean() < 0.06


def test_a_heap_at_the_slope_of_repose_is_ground() -> None:
    xyz = _plane(30.0, 0.12)
    xyz[:, 2] += np.clip(2.0 - 0.7 * np.hypot(xyz[:, 0] - 15.0, xyz[:, 1] - 15.0), 0.0, 2.0)
    assert _found(xyz).is_ground(xyz).mean() > 0.99


def test_a_step_of_two_metres_stays_with_its_face() -> None:
    xyz = _plane(30.0, 0.12)
    xyz[:, 2] += _step(xyz[:, 0], 15.0, 2.0)
    face = _face(15.0, 29.0, 2.0, 6000, seed=3)
    whole = np.vstack([xyz, face])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(xyz)].mean() > 0.99
    assert is_ground[len(xyz) :].mean() > 0.9


def test_a_retaining_wall_is_no_ground_and_the_ground_at_its_foot_and_top_is() -> None:
    xyz = _plane(30.0, 0.12)
    xyz[:, 2] += np.where(xyz[:, 0] > 15.0, 1.5, 0.0)
    rng = np.random.default_rng(3)
    wall = np.column_stack(
        [np.full(6000, 15.0), rng.uniform(0.0, 29.0, 6000), rng.uniform(0.0, 1.5, 6000)]
    )
    wall[:, 0] += rng.normal(0.0, 0.01, 6000)
    whole = np.vstack([xyz, wall])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(xyz)].mean() > 0.98
    assert is_ground[len(xyz) :].mean() < 0.25


def test_points_under_the_ground_are_rejected_and_do_not_pull_it_down() -> None:
    ground = _plane(20.0, 0.1)
    rng = np.random.default_rng(4)
    ghosts = ground[rng.choice(len(ground), 300, replace=False)] - [0.0, 0.0, 1.0]
    whole = np.vstack([ground, ghosts])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.99
    assert not is_ground[len(ground) :].any()


def test_a_hole_behind_a_machine_is_filled_and_said_to_be_filled() -> None:
    surface = _found(_without(_plane(30.0, 0.12, slope=0.2), (10.0, 10.0), (15.0, 15.0)))
    positions = np.array([[12.5, 12.5], [5.0, 5.0], [-9.0, 5.0]])
    assert surface.is_filled_at(positions).tolist() == [True, False, True]
    assert surface.heights_at(positions)[:2] == pytest.approx([2.5, 1.0], abs=0.1)
    assert np.isnan(surface.heights_at(positions)[2])


def test_blocks_in_another_order_give_the_same_ground() -> None:
    xyz = np.vstack([_plane(20.0, 0.15), _box((8.0, 8.0, 0.0), (10.0, 11.0, 2.0))])
    shuffled = np.random.default_rng(5).permutation(len(xyz))
    parts = np.array_split(xyz[shuffled], 7)
    whole = _found(xyz).is_ground(xyz)
    cut = find_ground(lambda: iter(parts), GroundAssumptions(), SilentMonitor())
    assert np.array_equal(cut.is_ground(xyz), whole)


def test_a_sparse_cloud_from_the_air_loses_its_hall_and_keeps_its_hill() -> None:
    rng = np.random.default_rng(6)
    xyz = np.column_stack([rng.uniform(0.0, 160.0, (20000, 2)), np.zeros(20000)])
    xyz[:, 2] = 5.0 * np.sin(xyz[:, 0] / 30.0) + rng.normal(0.0, 0.03, 20000)
    hall = np.all((xyz[:, :2] > [40.0, 50.0]) & (xyz[:, :2] < [85.0, 80.0]), axis=1)
    xyz[hall, 2] = 16.0
    is_ground = _found(xyz).is_ground(xyz)
    assert is_ground[~hall].mean() > 0.98
    assert not is_ground[hall].any()


def test_points_without_coordinates_and_spikes_of_ten_kilometres_are_not_ground() -> None:
    ground = _plane(20.0, 0.1)
    odd = np.array(
        [[np.nan, 1.0, 0.0], [5.0, 5.0, np.inf], [1e4, 5.0, 0.0], [5.0, 5.0, -1e4], [5.0, 5.0, 1e4]]
    )
    whole = np.vstack([ground, odd])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.99
    assert not is_ground[len(ground) :].any()


@pytest.mark.parametrize("count", [3, 10])
def test_a_handful_of_level_points_is_ground(count: int) -> None:
    xyz = np.random.default_rng(7).uniform(0.0, 1.0, (count, 3)) * [5.0, 5.0, 0.0]
    assert _found(xyz).is_ground(xyz).all()


@pytest.mark.parametrize("xyz", [np.zeros((0, 3)), np.full((9, 3), np.nan), np.ones((10, 3))])
def test_a_cloud_without_extent_is_refused_in_a_sentence(xyz: np.ndarray) -> None:
    with pytest.raises(OutOfRange, match="three or more places"):
        _found(xyz)


@pytest.mark.parametrize(
    ("xyz", "positions"),
    [
        (np.ones((500, 3)), 1),
        (np.column_stack([np.ones((500, 2)), np.arange(500.0)]), 1),
        (np.tile([[0.0, 0.0, 1.0], [4.0, 0.0, 1.0]], (250, 1)), 2),
    ],
    ids=["copies", "one above the other", "copies at two places"],
)
def test_a_refused_cloud_is_told_how_many_places_it_has_not_how_many_points(
    xyz: np.ndarray, positions: int
) -> None:
    blocks = [xyz[:100], xyz[100:]]
    for method in (
        lambda: find_ground(lambda: blocks, GroundAssumptions(), SilentMonitor()),
        lambda: published_surface(lambda: blocks, PublishedSteps(), SilentMonitor()),
    ):
        with pytest.raises(OutOfRange, match=f"the cloud has {positions}\\."):
            method()


def test_the_foot_of_a_fence_goes_with_the_fence() -> None:
    ground = _plane(20.0, 0.05)
    rng = np.random.default_rng(8)
    fence = np.column_stack(
        [rng.uniform(5.0, 15.0, 6000), np.full(6000, 10.02), rng.uniform(0.0, 1.5, 6000)]
    )
    whole = np.vstack([ground, fence])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.99
    assert not is_ground[len(ground) :].any()


def test_a_machine_with_a_shadow_behind_it_is_removed() -> None:
    ground = _without(_plane(30.0, 0.12, slope=0.1), (10.0, 10.0), (14.0, 20.0))
    machine = _box((10.0, 10.0, 1.2), (14.0, 12.5, 3.0))
    whole = np.vstack([ground, machine[machine[:, 1] < 12.4]])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.99
    assert is_ground[len(ground) :].mean() < 0.03


def test_a_step_seen_from_below_keeps_its_crest_with_the_ground_behind_in_shadow() -> None:
    xyz = _without(_plane(30.0, 0.12), (15.0, -1.0), (18.0, 31.0))
    xyz[:, 2] += _step(xyz[:, 0], 15.0, 1.5)
    face = _face(15.0, 29.0, 1.5, 4000, seed=9)
    whole = np.vstack([xyz, face])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(xyz)].mean() > 0.99
    assert is_ground[len(xyz) :].mean() > 0.9


def test_a_fence_that_ends_at_a_wall_is_no_part_of_the_wall() -> None:
    ground = _plane(30.0, 0.08)
    ground[:, 2] += _step(ground[:, 0], 15.0, 3.0)
    rng = np.random.default_rng(10)
    face = _face(15.0, 29.0, 3.0, 12000, seed=13)
    fence = np.column_stack(
        [rng.uniform(9.0, 15.0, 4000), np.full(4000, 15.0), rng.uniform(0.0, 1.5, 4000)]
    )
    whole = np.vstack([ground, face, fence])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.99
    assert is_ground[len(ground) : len(ground) + len(face)].mean() > 0.9
    assert is_ground[len(ground) + len(face) :].mean() < 0.15


def test_a_fence_askew_that_touches_a_long_wall_is_no_part_of_the_wall() -> None:
    ground = _plane(40.0, 0.08)
    ground[:, 2] += _step(ground[:, 0], 30.0, 3.0)
    rng = np.random.default_rng(12)
    face = _face(30.0, 39.9, 3.0, 16000, seed=14)
    along = rng.uniform(0.0, 1.0, 30000)
    fence = np.column_stack(
        [5.0 + 25.0 * along, 10.0 + 15.0 * along, rng.uniform(0.05, 2.9, 30000)]
    )
    fence[:, 1] += rng.normal(0.0, 0.03, 30000)
    whole = np.vstack([ground, face, fence])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.98
    assert is_ground[len(ground) : len(ground) + len(face)].mean() > 0.9
    assert is_ground[len(ground) + len(face) :].mean() < 0.15


def test_a_bush_on_the_crest_of_a_step_is_no_part_of_its_face() -> None:
    ground = _plane(30.0, 0.08)
    ground[:, 2] += 2.0 * np.clip((ground[:, 0] - 15.0) / 0.4, 0.0, 1.0)
    rng = np.random.default_rng(11)
    up = rng.uniform(0.0, 1.0, 30000)
    face = np.column_stack([15.0 + 0.4 * up, rng.uniform(0.0, 29.9, 30000), 2.0 * up])
    inside = rng.uniform(-1.0, 1.0, (24000, 3))
    inside = inside[(np.linalg.norm(inside, axis=1) < 1.0) & (inside[:, 2] > 0.1)]
    bush = inside * [1.2, 1.2, 1.0] + [16.2, 15.0, 2.0]
    whole = np.vstack([ground, face, bush])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.98
    assert is_ground[len(ground) : len(ground) + len(face)].mean() > 0.9
    assert is_ground[len(ground) + len(face) :].mean() < 0.06


def test_a_hall_cut_by_the_border_goes_and_a_terrace_along_the_border_stays() -> None:
    xyz = _plane(80.0, 0.5)
    hall = (np.abs(xyz[:, 0] - 40.0) < 11.0) & (xyz[:, 1] < 12.0)
    terrace = xyz[:, 1] > 72.0
    xyz[:, 2] += np.where(hall, 7.0, 0.0) + np.where(terrace, 3.0, 0.0)
    is_ground = _found(xyz).is_ground(xyz)
    assert is_ground[~hall].mean() > 0.99
    assert is_ground[hall].mean() < 0.02


def test_the_farthest_point_does_not_make_the_cells_of_a_small_cloud_large() -> None:
    xyz = np.random.default_rng(11).uniform(0.0, 8.0, (150, 3)) * [1.0, 1.0, 0.0]
    assert _found(xyz).grid.size_m < 1.5


def _around_a_station(per_m2: float, astray: float) -> tuple[np.ndarray, np.ndarray]:
    """Ground about a tripod, densest near it, and the points that a share of its pulses put under.

    The density falls by the third power of the distance as on level ground, from ``per_m2`` at
    two metres; what went astray lies 0.1 m and, on average, 0.4 m more below.
    """
    rng = np.random.default_rng(8)
    ring_m = np.linspace(2.0, 14.0, 241)
    counts = rng.poisson(2.0 * np.pi * ring_m * 0.05 * np.maximum(per_m2 * (2.0 / ring_m) ** 3, 20))
    reach, turn = (
        np.repeat(ring_m, counts) + rng.uniform(0.0, 0.05, counts.sum()),
        rng.uniform(0.0, 2.0 * np.pi, counts.sum()),
    )
    xyz = np.column_stack([reach * np.cos(turn), reach * np.sin(turn), np.zeros(len(reach))])
    xyz[:, 2] = 0.1 * xyz[:, 0] + rng.normal(0.0, 0.004, len(xyz))
    is_astray = rng.random(len(xyz)) < astray
    xyz[is_astray, 2] -= 0.1 + rng.exponential(0.4, is_astray.sum())
    return xyz, is_astray


@pytest.mark.parametrize(
    ("per_m2", "astray"),
    [
        *((per_m2, astray) for per_m2 in (20.0, 200.0, 2000.0) for astray in (0.002, 0.02)),
        *((20000.0, astray) for astray in (0.002, 0.02, 0.06)),
    ],
)
def test_points_under_the_ground_near_a_station_do_not_sink_it_at_any_density(
    per_m2: float, astray: float
) -> None:
    xyz, is_astray = _around_a_station(per_m2, astray)
    is_ground = _found(xyz).is_ground(xyz)
    assert is_ground[~is_astray].mean() > 0.99
    assert is_ground[is_astray].sum() <= 3 + 0.06 * is_astray.sum()


def test_a_stray_point_over_dense_ground_takes_none_of_it_away() -> None:
    ground = _plane(10.0, 0.01)
    strays = ground[::400] + np.array([0.0, 0.0, 0.2])
    whole = np.vstack([ground, strays])
    is_ground = _found(whole).is_ground(whole)
    assert is_ground[: len(ground)].mean() > 0.99
    assert not is_ground[len(ground) :].any()


def _sparse(extent_m: float, spacing_m: float, seed: int) -> np.ndarray:
    """Positions as from the air, about ``spacing_m`` apart, at height 0."""
    along = np.arange(0.0, extent_m, spacing_m)
    xy = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    xy += np.random.default_rng(seed).uniform(-0.4, 0.4, xy.shape) * spacing_m
    return np.column_stack([xy, np.zeros(len(xy))])


def test_from_the_air_the_crests_of_a_quarry_stay() -> None:
    xyz = _sparse(200.0, 3.0, 21)
    for edge in (50.0, 100.0, 150.0):
        xyz[:, 2] += np.clip(2.0 * (xyz[:, 0] - edge), 0.0, 8.0)
    assert _found(xyz).is_ground(xyz).mean() > 0.97


def test_from_the_air_a_hall_wider_than_any_window_goes() -> None:
    xyz = _sparse(240.0, 1.5, 22)
    hall = np.all(np.abs(xyz[:, :2] - 120.0) < 60.0, axis=1)
    xyz[hall, 2] += 10.0
    is_ground = _found(xyz).is_ground(xyz)
    assert is_ground[~hall].mean() > 0.99
    assert is_ground[hall].mean() < 0.01


def test_from_the_air_shrubs_on_a_steep_slope_go() -> None:
    xyz = _sparse(150.0, 2.0, 23)
    xyz[:, 2] = 0.6 * xyz[:, 0] + np.random.default_rng(24).normal(0.0, 0.05, len(xyz))
    shrubs = np.zeros(len(xyz), np.bool_)
    shrubs[::37] = True
    xyz[shrubs, 2] += 2.2
    is_ground = _found(xyz).is_ground(xyz)
    assert is_ground[~shrubs].mean() > 0.98
    assert is_ground[shrubs].mean() < 0.1


def test_cells_are_as_fine_as_where_most_points_lie() -> None:
    rng = np.random.default_rng(25)
    near = np.column_stack([rng.uniform(40.0, 60.0, (20_000, 2)), np.zeros(20_000)])
    far = np.column_stack([rng.uniform(0.0, 100.0, (1_500, 2)), np.zeros(1_500)])
    assert _found(np.vstack([near, far])).grid.size_m < 0.4
