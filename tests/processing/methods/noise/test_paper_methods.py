"""The two methods of the road-surface study: as published, as Open3D, whole or in parts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.monitor import SilentMonitor
from processing.methods.noise.neighbours.radius import radius_outliers
from processing.methods.noise.neighbours.statistical import (
    DistanceSums,
    mean_distances,
    statistical_outliers,
)
from processing.methods.noise.noise_codes import HIGH_NOISE, LOW_NOISE, part_noise_by_ground
from processing.methods.noise.tiles_of_space import TiledCloud
from processing.methods.noise.whole_clouds import (
    radius_outliers_by_parts,
    statistical_outliers_by_parts,
)

CloudXyz = NDArray[np.float64]
START = np.array([-11e3, -35e3, 120.0])


def street(spikes: int = 1) -> CloudXyz:
    """A dense plane that thins out, with points in the air and some far away; map coordinates."""
    chance = np.random.default_rng(5)
    plane = np.column_stack([chance.random(6_000) ** 2 * 30, chance.random(6_000) * 4])
    air = chance.random((200, 3)) * [30, 4, 6]
    far = np.tile([9_000.0, 0.0, 0.0], (spikes, 1))
    return np.vstack([np.column_stack([plane, np.zeros(6_000)]), air, far]) + START


def open3d_kept(xyz: CloudXyz) -> dict[str, NDArray[np.bool_]]:
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(xyz))
    found = {
        "radius": cloud.remove_radius_outlier(113, 0.5)[1],
        "statistical": cloud.remove_statistical_outlier(113, 1.5)[1],
    }
    kept = {name: np.zeros(len(xyz), np.bool_) for name in found}
    for name, points in found.items():
        kept[name][np.asarray(points)] = True
    return kept


def test_a_point_with_113_others_is_kept_and_one_with_112_is_not() -> None:
    ring = np.linspace(0, 2 * np.pi, 113, endpoint=False)
    around = np.column_stack([0.4 * np.cos(ring), 0.4 * np.sin(ring), np.zeros(113)])
    assert not radius_outliers(np.vstack([[0, 0, 0], around]))[0]
    assert radius_outliers(np.vstack([[0, 0, 0], around[1:]]))[0]
    assert radius_outliers(np.vstack([[0, 0, 0], around]), counts_itself=False)[0]


def test_both_methods_keep_what_open3d_keeps() -> None:
    xyz = street()
    kept = open3d_kept(xyz)
    assert 0.05 < kept["radius"].mean() < 0.95
    np.testing.assert_array_equal(~radius_outliers(xyz), kept["radius"])
    np.testing.assert_array_equal(~statistical_outliers(xyz), kept["statistical"])


def test_radius_agrees_with_counting_every_distance() -> None:
    xyz = street()
    counts = cKDTree(xyz).query_ball_point(xyz, 0.5, return_length=True)
    np.testing.assert_array_equal(radius_outliers(xyz, 0.5, 40), counts <= 40)


def test_mean_distances_agree_with_a_tree() -> None:
    xyz = street() - START
    tree = cKDTree(xyz)
    np.testing.assert_allclose(mean_distances(xyz), tree.query(xyz, 113)[0].mean(axis=1))
    # PCL counts so many others.
    others = tree.query(xyz, 114)[0].sum(axis=1) / 113
    np.testing.assert_allclose(mean_distances(xyz, counts_itself=False), others)


def test_many_points_at_one_place_among_others_hold_nothing_up() -> None:
    chance = np.random.default_rng(3)
    xyz = np.vstack([np.full((300, 3), 0.5), chance.random((900, 3)), [[1e4, 0, 0]]])
    expected = cKDTree(xyz).query(xyz, 113)[0].mean(axis=1)
    np.testing.assert_allclose(mean_distances(xyz), expected, atol=1e-9)


@pytest.mark.parametrize("counts_itself", [True, False])
def test_spikes_of_thousands_of_kilometres_change_no_other_point(counts_itself: bool) -> None:
    xyz = np.vstack([street() - START, [[2e6, 0, 0], [0, -2e6, 0], [0, 0, 2e6], [2e6, 0, 1]]])
    asked = 113 if counts_itself else 114
    expected = cKDTree(xyz).query(xyz, asked)[0].sum(axis=1) / 113
    found = mean_distances(xyz, counts_itself=counts_itself)
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_the_limit_is_the_mean_and_so_many_deviations() -> None:
    means = np.array([1.0, 2.0, 6.0, np.nan])
    parts = DistanceSums.of(means[:1]) + DistanceSums.of(means[1:])
    assert parts.limit(1.5) == pytest.approx(3.0 + 1.5 * np.std(means[:3], ddof=1))


def test_a_point_without_a_place_is_noise_and_nobodys_neighbour() -> None:
    xyz = np.vstack([np.zeros((113, 3)), np.full((3, 3), np.nan)])
    assert radius_outliers(xyz).all()
    assert not radius_outliers(xyz, neighbours=112)[:113].any()
    assert statistical_outliers(xyz)[113:].all()


@pytest.mark.parametrize(
    ("cloud", "radius", "statistical"),
    [
        (np.zeros((0, 3)), 0, 0),
        (np.zeros((1, 3)), 1, 0),
        (np.random.default_rng(0).random((10, 3)), 10, None),
        (np.ones((500, 3)), 0, 0),
        (np.column_stack([np.random.default_rng(0).random((500, 2)), np.zeros(500)]), None, None),
        (np.vstack([np.ones((500, 3)), [[1e4, 0, 0], [0, 0, -1e6]]]), 2, 1),
    ],
)
def test_strange_clouds_are_judged_without_a_word(
    cloud: CloudXyz, radius: int | None, statistical: int | None
) -> None:
    by_radius, by_statistics = radius_outliers(cloud), statistical_outliers(cloud)
    assert by_radius.size == by_statistics.size == len(cloud)
    assert radius is None or by_radius.sum() == radius
    assert statistical is None or by_statistics.sum() == statistical


@pytest.mark.parametrize("points", [1, 700, 10_000])
@pytest.mark.parametrize("tile_m", [2.0, 50.0])
def test_parts_give_what_the_whole_cloud_gives(tmp_path: Path, points: int, tile_m: float) -> None:
    xyz = np.vstack([street(), np.full((2, 3), np.nan)])
    silent = SilentMonitor()
    cloud = TiledCloud(lambda p: xyz[p], len(xyz), tmp_path / "order", tile_m, monitor=silent)
    found = np.zeros(len(xyz), np.uint8)
    radius_outliers_by_parts(cloud, found, 0.5, 40, monitor=silent, points_per_part=points)
    np.testing.assert_array_equal(found > 0, radius_outliers(xyz, 0.5, 40))
    found[:] = 0
    statistical_outliers_by_parts(
        cloud, found, 30, scratch=tmp_path, monitor=silent, points_per_part=points
    )
    np.testing.assert_array_equal(found > 0, statistical_outliers(xyz, 30))


def test_ties_are_the_same_in_every_part(tmp_path: Path) -> None:
    # Points on a lattice of 0.1 m: many pairs are exactly a radius apart, to a rounding.
    positions = np.stack(np.meshgrid(np.arange(60), np.arange(60)), -1).reshape(-1, 2) * 0.1
    xyz = np.column_stack([positions, np.zeros(len(positions))]) + START
    silent = SilentMonitor()
    cloud = TiledCloud(lambda p: xyz[p], len(xyz), tmp_path / "order", 1.0, monitor=silent)
    found = np.zeros(len(xyz), np.uint8)
    radius_outliers_by_parts(cloud, found, 0.5, 72, monitor=silent, points_per_part=500)
    np.testing.assert_array_equal(found > 0, radius_outliers(xyz, 0.5, 72))


def test_noise_is_low_below_the_ground_and_high_elsewhere(tmp_path: Path) -> None:
    chance = np.random.default_rng(1)
    ground = np.column_stack([chance.random((4_000, 2)) * 10, np.zeros(4_000)])
    noise = np.array([[5.0, 5.0, 2.0], [5.0, 5.0, -1.0], [5.0, 5.0, -9_000.0]])
    xyz = np.vstack([ground, noise])
    silent = SilentMonitor()
    cloud = TiledCloud(lambda p: xyz[p], len(xyz), tmp_path / "order", 1.0, monitor=silent)
    codes = np.zeros(len(xyz), np.uint8)
    codes[-3:] = 1
    part_noise_by_ground(cloud, codes, monitor=silent, points_per_part=300)
    assert not codes[:-3].any()
    assert codes[-3:].tolist() == [HIGH_NOISE, LOW_NOISE, LOW_NOISE]
