"""Heights of lines from measured surfaces that are known: planes, curbs, gaps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.map.drafting.height_kernels import near_points_kernel, warm_up
from processing.map.drafting.heights import set_on_ground
from processing.recording.columns.columns import ColumnWriter
from processing.recording.drive import Drive
from processing.recording.drive_info import DriveInfo, write_drive_info
from tests.processing.image.recordings import small_drive
from tests.processing.map.drafting.positions import CORNER, local, positions

SCALE, CELLS = 0.001, 64


def surface(folder: Path, xyz: NDArray[np.float64]) -> Drive:
    """A drive without revolutions of points about the far corner, as a top view holds them."""
    integers = np.rint(xyz / SCALE).astype(np.int32)
    cells = np.floor((xyz[:, :2] - xyz[:, :2].min(axis=0)) / 0.25).astype(np.int64)
    pulse = cells[:, 1] * CELLS + np.minimum(cells[:, 0], CELLS - 1)
    order = np.argsort(pulse, kind="stable")
    folder.mkdir(parents=True)
    count = len(xyz)
    flat = {
        name: np.zeros(count)
        for name in ("time", "intensity", "return_number", "number_of_returns", "classification")
    }
    with ColumnWriter(folder) as writer:
        writer.append(
            {
                **flat,
                "xyz": integers[order],
                "pulse": pulse[order],
                "source_index": np.arange(count),
                "source_file": np.zeros(count),
            }
        )
    low, high = (tuple((edge + CORNER).tolist()) for edge in (xyz.min(axis=0), xyz.max(axis=0)))
    write_drive_info(
        folder,
        DriveInfo(
            id=folder.name,
            name=folder.name,
            scanner=1,
            count=count,
            scale=(SCALE,) * 3,
            offset=tuple(CORNER.tolist()),
            lowest=low,
            highest=high,
            crs="EPSG:6677",
            sources=(),
            clock_offset_s=0.0,
            rows_by="top-view",
            cell_m=0.25,
            cells_per_row=CELLS,
        ),
    )
    return Drive(folder)


def plane(
    seed: int, slope: tuple[float, float] = (0.03, -0.02), per_m2: int = 600
) -> NDArray[np.float64]:
    """Points of a plane, 12 m by 6 m, with 3 mm of noise."""
    random = np.random.default_rng(seed)
    xy = random.uniform((0, 0), (12, 6), (12 * 6 * per_m2, 2))
    return np.column_stack([xy, xy @ slope + random.normal(0, 0.003, len(xy))])


def heights_of(vertices) -> NDArray[np.float64]:
    return local([vertex.xyz for vertex in vertices])[:, 2]


def test_a_line_on_a_plane_gets_the_planes_heights(tmp_path: Path) -> None:
    drive = surface(tmp_path / "a", plane(1))
    given = positions(*((x, 3.0, 0.2) for x in np.linspace(1, 11, 200)))
    vertices = set_on_ground(given, [drive])
    truth = local(given)[:, :2] @ (0.03, -0.02)
    assert np.abs(heights_of(vertices) - truth).max() < 0.002
    assert [vertex.xyz[:2] for vertex in vertices] == [position[:2] for position in given]
    assert not any(vertex.is_occluded for vertex in vertices)


def test_two_drives_count_together(tmp_path: Path) -> None:
    cloud = plane(2)
    west = surface(tmp_path / "w", cloud[cloud[:, 0] < 6])
    east = surface(tmp_path / "e", cloud[cloud[:, 0] >= 6])
    given = positions(*((x, 3.0, 0.0) for x in np.linspace(1, 11, 41)))
    vertices = set_on_ground(given, [west, east])
    assert not any(vertex.is_occluded for vertex in vertices)
    assert np.abs(heights_of(vertices) - local(given)[:, :2] @ (0.03, -0.02)).max() < 0.003


def test_beside_a_curb_the_surface_of_most_points_is_met_and_no_mean(tmp_path: Path) -> None:
    cloud = plane(3, slope=(0.0, 0.0))
    cloud[cloud[:, 1] > 3.0, 2] += 0.15
    drive = surface(tmp_path / "a", cloud)
    road = set_on_ground(positions(*((x, 2.95, 0.075) for x in range(1, 11))), [drive])
    walk = set_on_ground(positions(*((x, 3.05, 0.075) for x in range(1, 11))), [drive])
    assert np.abs(heights_of(road)).max() < 0.003
    assert np.abs(heights_of(walk) - 0.15).max() < 0.003


def test_on_a_curbs_edge_the_given_height_decides(tmp_path: Path) -> None:
    cloud = plane(4, slope=(0.0, 0.0), per_m2=2000)
    cloud[cloud[:, 1] > 3.0, 2] += 0.15
    random = np.random.default_rng(5)
    face = np.column_stack([random.uniform(0, 12, 3000), np.full(3000, 3.0), np.zeros(3000)])
    face[:, 2] = random.uniform(0, 0.15, 3000)
    drive = surface(tmp_path / "a", np.concatenate([cloud, face]))
    lower = set_on_ground(positions(*((x, 3.0, 0.0) for x in range(1, 11))), [drive])
    upper = set_on_ground(positions(*((x, 3.0, 0.15) for x in range(1, 11))), [drive])
    assert np.abs(heights_of(lower)).max() < 0.02
    assert np.abs(heights_of(upper) - 0.15).max() < 0.02


def test_an_embankment_is_followed_up_its_slope(tmp_path: Path) -> None:
    drive = surface(tmp_path / "a", plane(13, slope=(0.0, 0.6)))
    given = positions(*((5.0, y, 0.6 * y + 0.1) for y in np.linspace(1, 5, 60)))
    truth = 0.6 * local(given)[:, 1]
    assert np.abs(heights_of(set_on_ground(given, [drive])) - truth).max() < 0.015


def test_leaves_above_the_road_dont_lift_the_line(tmp_path: Path) -> None:
    cloud = plane(6, slope=(0.05, 0.0))
    random = np.random.default_rng(7)
    leaves = cloud[random.random(len(cloud)) < 0.3] + (0, 0, 0.3)
    leaves[:, 2] += random.uniform(-0.1, 0.1, len(leaves))
    drive = surface(tmp_path / "a", np.concatenate([cloud, leaves]))
    given = positions(*((x, 3.0, 0.1 + 0.05 * x) for x in range(1, 11)))
    assert np.abs(heights_of(set_on_ground(given, [drive])) - 0.05 * np.arange(1, 11)).max() < 0.004


def test_where_points_are_missing_heights_come_from_the_neighbours(tmp_path: Path) -> None:
    cloud = plane(8)
    cloud = cloud[(cloud[:, 0] < 4) | (cloud[:, 0] > 7)]
    cloud = cloud[cloud[:, 0] < 10]
    drive = surface(tmp_path / "a", cloud)
    eastings = np.array([1, 3, 4.5, 5.5, 6.5, 8, 9, 11, 11.5])
    given = positions(*((x, 3.0, 0.03 * x + 0.04) for x in eastings))
    vertices = set_on_ground(given, [drive])
    assert [vertex.is_occluded for vertex in vertices] == [
        x in (4.5, 5.5, 6.5, 11, 11.5) for x in eastings
    ]
    assert np.abs(heights_of(vertices) - (0.03 * eastings - 0.06)).max() < 0.006


def test_points_on_another_level_dont_count(tmp_path: Path) -> None:
    drive = surface(tmp_path / "a", plane(9, slope=(0.0, 0.0)))
    given = positions((5, 3, 2.0), (6, 3, 2.1))
    assert [(vertex.xyz, vertex.is_occluded) for vertex in set_on_ground(given, [drive])] == [
        (position, True) for position in given
    ]
    (vertex,) = set_on_ground(positions((5, 3, 0.45)), [drive])
    assert heights_of([vertex])[0] == pytest.approx(0, abs=0.003)


def test_one_or_two_points_give_the_height_of_the_nearest(tmp_path: Path) -> None:
    alone = np.array([[1, 1, 0.1], [1.1, 1, 0.3], [5, 5, 0.2]])
    drive = surface(tmp_path / "a", alone)
    vertices = set_on_ground(positions((1.01, 1, 0), (5, 5.1, 0)), [drive])
    assert heights_of(vertices) == pytest.approx([0.1, 0.2], abs=1e-6)


def test_no_drive_no_line_and_one_place(tmp_path: Path) -> None:
    given = positions((1, 1, 0), (2, 2, 0))
    assert [vertex.xyz for vertex in set_on_ground(given, [])] == list(given)
    assert all(vertex.is_occluded for vertex in set_on_ground(given, []))
    assert set_on_ground((), []) == ()
    drive = surface(tmp_path / "a", plane(10, slope=(0.0, 0.0)))
    assert len(set_on_ground(given[:1], [drive])) == 1
    assert len(set_on_ground((given[0], given[0]), [drive])) == 2
    far = positions((1e5, 1e5, 0))
    assert set_on_ground(far, [drive])[0].is_occluded


def test_a_recording_with_revolutions_gives_the_road_below_its_vehicle(tmp_path: Path) -> None:
    drive, simulated = small_drive(tmp_path / "a", 3)
    road = simulated.xyz[simulated.surface == 0]
    chosen = road[:: len(road) // 50]
    given = [(x, y, z + 0.1) for x, y, z in chosen.tolist()]
    vertices = set_on_ground(given, [drive])
    found = np.array([vertex.xyz[2] for vertex in vertices])
    assert np.median(np.abs(found - chosen[:, 2])) < 0.005
    assert not any(vertex.is_occluded for vertex in vertices)


def test_ten_thousand_places_over_a_long_line_are_found(tmp_path: Path) -> None:
    drive = surface(tmp_path / "a", plane(11, slope=(0.0, 0.0)))
    given = positions(*((x, 3.0, 0.1) for x in np.linspace(-500, 500, 10_000)))
    vertices = set_on_ground(given, [drive])
    found = np.array([not vertex.is_occluded for vertex in vertices])
    eastings = local(given)[:, 0]
    assert found[(eastings > 0.2) & (eastings < 11.8)].all()
    assert not found[(eastings < -0.2) | (eastings > 12.2)].any()


def test_the_kernel_finds_the_pairs_that_plain_arithmetic_finds() -> None:
    random = np.random.default_rng(12)
    xyz = random.integers(0, 3000, (400, 3)).astype(np.int32)
    xyz.flags.writeable = False
    centres = random.uniform(0.5, 2.5, (20, 3))
    reach, cell, side = np.array([0.3, 0.4]), 0.5, 8
    cells = np.floor(centres[:, 1] / cell).astype(int) * side + np.floor(centres[:, 0] / cell)
    cells = cells.astype(np.int64)
    starts = np.concatenate([[0], np.cumsum(np.bincount(cells, minlength=side * side))])
    frame = np.array([0.001, 0.001, 0.001, 0.0, 0.0, 0.0, cell])
    grid = (np.ones((side, side), np.uint8), starts.astype(np.int64), np.argsort(cells))
    steps = (xyz * 0.001)[None] - centres[:, None]
    truth = (np.hypot(steps[..., 0], steps[..., 1]) <= 0.3) & (np.abs(steps[..., 2]) <= 0.4)
    for kernel in (near_points_kernel, near_points_kernel.py_func):
        owners, offsets = np.empty(1000, np.int64), np.empty((1000, 3))
        count = kernel(xyz, frame, *grid, centres, reach, owners, offsets)
        assert count == truth.sum()
        assert (np.bincount(owners[:count], minlength=20) == truth.sum(axis=1)).all()
        assert (np.hypot(offsets[:count, 0], offsets[:count, 1]) <= 0.3).all()
        assert kernel(xyz, frame, *grid, centres, reach, owners[:3], offsets[:3]) == count
    warm_up()
