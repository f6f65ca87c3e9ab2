"""The tool FEATURES against plain numpy, on drives whose neighbours can be counted by hand."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.image.attributes.attributes import available, colours
from processing.image.attributes.colour_maps import UNKNOWN_COLOUR
from processing.methods.point_features import best_radius
from processing.methods.point_features.path_features import beside_kernel, path_places
from processing.methods.point_features.scan_line_features import stretches_kernel
from processing.recording.columns.point_features import (
    CELL_FEATURES,
    DISC_FEATURES,
    POINT_FEATURES,
    SCALES_M,
    SELECTED,
    SPHERE_FEATURES,
)
from processing.recording.drive import Drive, write_trajectory
from processing.recording.vehicle_path.trajectory import Trajectory
from processing.tools.features import FeaturesParameters, chosen_features
from processing.tools.running.runner import RunRequest, run
from processing.tools.tool import FinishedColumns
from tests.older_project import forget_all_sums
from tests.processing.image.recordings import small_drive, without_revolutions

Floats = NDArray[np.float64]


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    return small_drive(tmp_path / "d", multi_return_share=0.1)[0]


def computed(drive: Drive, parameters: FeaturesParameters) -> FinishedColumns:
    into = drive.folder.parent / uuid4().hex
    result = run(RunRequest("features", drive, parameters), SilentMonitor(), into=into)
    assert isinstance(result, FinishedColumns)
    return result


def values_of(drive: Drive, *names: str) -> list[NDArray[np.float32]]:
    result = computed(drive, FeaturesParameters(names=",".join(names)))
    return [result.read(name, 0, result.count) for name in names]


def falling_eigenvalues(neighbours: Floats) -> Floats:
    covariance = np.cov(neighbours.T, bias=True)
    return np.maximum(np.sort(np.linalg.eigvalsh(covariance))[::-1], 0.0)


def test_there_are_a_hundred_columns_beside_height_and_intensity() -> None:
    named = 14 * 5 + 4 * 4 + 4 + 4
    assert len(POINT_FEATURES) == named + 6
    assert len(SPHERE_FEATURES) == 14 + 1
    assert (len(DISC_FEATURES), len(CELL_FEATURES)) == (4, 4)
    assert len(SELECTED) + 2 == 17
    for column in POINT_FEATURES.values():
        assert column.title.ja
        assert column.formula
        assert column.source
        assert len(column.id) <= 32, "LAS keeps no longer names"


@pytest.mark.parametrize("scale", ["1m", "3m"])
def test_spheres_are_those_of_plain_numpy(drive: Drive, scale: str) -> None:
    names = [f"{name}_{scale}" for name, *_ in SPHERE_FEATURES]
    found = computed(drive, FeaturesParameters(group=f"sphere_{scale}"))
    assert list(found.names) == names
    rows = np.column_stack([found.read(name, 0, drive.count) for name in names])
    xyz = drive.xyz(slice(None))
    for point in range(0, drive.count, max(1, drive.count // 60)):
        away = np.linalg.norm(xyz - xyz[point], axis=1)
        near = xyz[away <= SCALES_M[scale]]
        radius = away[away <= SCALES_M[scale]].max()
        heights = near[:, 2]
        np.testing.assert_allclose(rows[point, 8], radius, rtol=1e-5)
        np.testing.assert_allclose(rows[point, 11], heights.mean(), rtol=1e-5)
        spread = [np.ptp(heights), heights.std()]
        np.testing.assert_allclose(rows[point, 12:14], spread, rtol=1e-4, atol=1e-5)
        if len(near) <= 3:
            assert not rows[point, :8].any()
            continue
        large, middle, small = falling_eigenvalues(near)
        shares = np.array([large - middle, middle - small, small]) / large
        np.testing.assert_allclose(rows[point, :3], shares, atol=1e-5)
        np.testing.assert_allclose(rows[point, 6], large + middle + small, rtol=1e-4)
        np.testing.assert_allclose(rows[point, 7], small / (large + middle + small), atol=1e-5)
        np.testing.assert_allclose(rows[point, 4], shares[0] + shares[1], atol=1e-5)
        density = len(near) / (4 / 3 * np.pi * radius**3)
        np.testing.assert_allclose(rows[point, 9], density, rtol=1e-4)
        logs = np.log(shares, where=shares > 1e-12, out=np.zeros(3))
        np.testing.assert_allclose(rows[point, 14], -(shares * logs).sum(), atol=1e-4)


def test_discs_reach_through_all_heights_and_cells_hold_what_is_in_them(drive: Drive) -> None:
    disc = values_of(drive, "plan_radius_2m", "plan_density_2m", "plan_eigenvalue_ratio_2m")
    count, height = values_of(drive, "cell_points", "cell_height")
    xyz = drive.xyz(slice(None))
    cells = np.floor(xyz[:, :2] / 0.25)
    for point in range(0, drive.count, max(1, drive.count // 60)):
        away = np.linalg.norm(xyz[:, :2] - xyz[point, :2], axis=1)
        near, radius = xyz[away <= 2.0, :2], away[away <= 2.0].max()
        values = np.sort(np.linalg.eigvalsh(np.cov(near.T, bias=True)))
        wanted = [radius, len(near) / (2 * np.pi * radius**2), max(values[0], 0) / values[1]]
        found = [values[point] for values in disc]
        np.testing.assert_allclose(found, wanted, rtol=1e-4, atol=1e-5)
        inside = xyz[(cells == cells[point]).all(axis=1), 2]
        assert count[point] == len(inside)
        np.testing.assert_allclose(height[point], xyz[point, 2] - inside.min(), atol=1e-5)


def test_the_best_neighbourhood_has_the_least_entropy_of_all_sizes(drive: Drive) -> None:
    neighbours, radius = values_of(drive, "neighbours_best", "radius_best")
    xyz = drive.xyz(slice(None))
    for point in range(0, drive.count, max(1, drive.count // 40)):
        away = np.linalg.norm(xyz - xyz[point], axis=1)
        order = np.argsort(away, kind="stable")
        order = order[away[order] <= best_radius.FARTHEST_M]
        entropies = []
        counts = [int(k) for k in best_radius._COUNTS if k < len(order)] or [len(order) - 1]
        for k in counts:
            large, middle, small = falling_eigenvalues(xyz[order[: k + 1]])
            shares = np.array([large - middle, middle - small, small]) / large
            logs = np.log(shares, where=shares > 1e-12, out=np.zeros(3))
            entropies.append(-(shares * logs).sum())
        chosen = counts.index(int(neighbours[point]))
        # Of points equally far from it another one may be the last.
        assert entropies[chosen] <= min(entropies) + 1e-3
        np.testing.assert_allclose(radius[point], away[order[counts[chosen]]], rtol=1e-4)


def test_a_pole_is_upright_and_linear_and_a_road_is_neither(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    step = np.linspace(-2.0, 2.0, 41)
    road = np.column_stack([*(axis.ravel() for axis in np.meshgrid(step, step)), np.zeros(41**2)])
    pole = np.column_stack([np.zeros((200, 2)), np.linspace(1.5, 5.5, 200)])
    made = cloud_of(drive, np.concatenate([road, pole]))
    linear, upright, flat = values_of(made, "linearity_1m", "height_range_1m", "verticality_1m")
    middle, shaft = 41 * 20 + 20, 41**2 + 100
    assert linear[shaft] > 0.99
    assert 1.9 < upright[shaft] <= 2.0
    assert linear[middle] < 0.1
    assert flat[middle] < 0.01


def cloud_of(drive: Drive, xyz: Floats) -> Drive:
    """The first points of a drive put elsewhere, the others out of the way."""
    far = np.column_stack([1000.0 + np.arange(drive.count) * 20.0, np.zeros((drive.count, 2))])
    far[: len(xyz)] = xyz
    integers = np.rint(drive.coordinates.quantisation.in_units(far)).astype("<i4")
    forget_all_sums(drive.folder)
    integers.tofile(drive.folder / "xyz.bin")
    return Drive(drive.folder)


def test_a_scan_line_is_cut_at_gaps_and_bends_by_its_depth_over_its_width() -> None:
    # Half a circle of 1 m, a gap, then two points 20 cm apart; another row goes on from there.
    angles = np.linspace(0.0, np.pi, 91)
    arc = np.column_stack([np.cos(angles), np.zeros(91), np.sin(angles)])
    pair = np.array([[-3.0, 0.0, 0.0], [-3.2, 0.0, 0.0], [-3.3, 0.0, 0.0]])
    xyz = np.concatenate([arc, pair])
    found = np.zeros((2, len(xyz)), np.float32)
    plain = stretches_kernel.py_func  # type: ignore[attr-defined]
    for kernel in (plain, stretches_kernel):
        found[:] = 0.0
        kernel(xyz, np.arange(len(xyz)), np.array([0, 93, 94]), found)
        np.testing.assert_allclose(found[0, :91], np.pi, rtol=1e-3)
        np.testing.assert_allclose(found[1, :91], 0.5, rtol=1e-3)
        np.testing.assert_allclose(found[0, 91:], [0.2, 0.2, 0.0], atol=1e-6)
        assert not found[1, 91:].any()


def test_a_leaf_before_a_wall_does_not_cut_the_scan_line_on_the_wall() -> None:
    wall = np.column_stack([np.arange(10) * 0.1, np.full(10, 5.0), np.ones(10)])
    xyz = np.insert(wall, 5, [0.5, 2.0, 1.0], axis=0)
    pulses = np.insert(np.arange(10), 5, 5)
    found = np.zeros((2, 11), np.float32)
    stretches_kernel(xyz, pulses, np.array([0, 11]), found)
    assert found[0, 5] == 0.0
    np.testing.assert_allclose(np.delete(found[0], 5), 0.9, rtol=1e-5)


def test_the_pass_above_is_nobody_elses_trajectory() -> None:
    # Along a street, and a minute and a half later back over it on a bridge 6 m higher.
    along = np.arange(0.0, 100.0)
    there = np.column_stack([along, np.zeros(100), np.full(100, 2.0)])
    back = np.column_stack([along[::-1], np.zeros(100), np.full(100, 8.0)])
    times = np.concatenate([np.arange(100.0) * 0.5, 150.0 + np.arange(100.0) * 0.5])
    places = path_places(Trajectory.from_positions(times, np.concatenate([there, back])))
    xyz = np.array([[50.25, 4.0, 0.0], [50.25, -3.0, 0.0]])
    plain = beside_kernel.py_func  # type: ignore[attr-defined]
    for kernel in (plain, beside_kernel):
        found = np.zeros((2, 2), np.float32)
        kernel(xyz, np.array([25.0, 175.0]), np.ones(2, np.bool_), places, found)
        np.testing.assert_allclose(found, [[-2.0, -8.0], [4.0, 3.0]], atol=1e-5)


def test_what_a_cloud_lacks_is_left_out_and_said(drive: Drive) -> None:
    flat = without_revolutions(drive)
    found = computed(flat, FeaturesParameters())
    assert set(found.names) == {name for name in SELECTED if not name.startswith(("path", "scan"))}
    assert "trajectory" in found.note.en
    assert "scan-line" in found.note.en
    with pytest.raises(Unsuitable) as refusal:
        computed(flat, FeaturesParameters(group="path"))
    assert "trajectory" in refusal.value.what.en


def test_a_trajectory_gives_what_is_asked_of_it(drive: Drive) -> None:
    times = np.array(drive.columns["time"])
    ends = np.array([times.min() - 1.0, times.max() + 1.0])
    (east, south, low), north = drive.xyz(slice(None)).min(axis=0), 200.0
    path = np.array([[east, south - 50.0, low + 2.0], [east, south + north, low + 2.0]])
    write_trajectory(drive.folder, Trajectory.from_positions(ends, path))
    again = Drive(drive.folder)
    height, distance = values_of(again, "path_height", "path_distance")
    xyz = again.xyz(slice(None))
    np.testing.assert_allclose(distance, xyz[:, 0] - east, atol=1e-4)
    np.testing.assert_allclose(height, xyz[:, 2] - low - 2.0, atol=1e-4)


def test_an_unknown_name_is_refused_with_what_is_meant() -> None:
    with pytest.raises(OutOfRange):
        chosen_features(FeaturesParameters(names="linearity_5m,linarity_1m"))
    assert chosen_features(FeaturesParameters(names=" cell_height , linearity_5m")) == (
        "linearity_5m",
        "cell_height",
    )
    assert len(chosen_features(FeaturesParameters(group="all"))) == len(POINT_FEATURES)
    assert len(chosen_features(FeaturesParameters(group="disc"))) == 16


def test_a_feature_colours_points_once_it_is_there(drive: Drive) -> None:
    points = np.arange(drive.count)
    assert "verticality_1m" not in available(drive)
    with pytest.raises(Unsuitable, match="Verticality"):
        colours(drive, points, "verticality_1m", 2.0, 98.0)
    (values,) = values_of(drive, "verticality_1m")
    values[:5] = np.nan
    drive.columns.add("verticality_1m", values)
    assert "verticality_1m" in available(drive)
    shown = colours(drive, points, "verticality_1m", 2.0, 98.0)
    assert (shown[:5] == UNKNOWN_COLOUR).all()
    brightness = shown[5:].astype(float).sum(axis=1)
    assert np.corrcoef(brightness, values[5:])[0, 1] > 0.7
