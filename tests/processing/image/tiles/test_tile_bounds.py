"""Bounds of tiles that are worked out bit by bit, and choosing by them meanwhile."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.image.point_image import PointCloudImage
from processing.image.search.tile_choice import Camera3D, tiles_in_view
from processing.image.tiles.tiles import TileKey, TilePyramid
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.coordinates import Coordinates
from processing.recording.columns.quantisation import Quantisation
from processing.recording.kinds import ImageKind
from tests.monitors import CancelledAfter

ROWS, WIDTH = 2600, 300
SCALE, OFFSET = (0.001, 0.001, 0.001), (10_000.0, -20_000.0, 50.0)
STEP = 100
"""Between points, in the integers' unit."""


def hills(folder: Path | None = None) -> PointCloudImage:
    """A top view of waves that run north, 780,000 points; every cell is filled."""
    cells = np.arange(ROWS * WIDTH)
    row, column = np.divmod(cells, WIDTH)
    heights = 2000 * np.sin(row / 90) + 900 * np.cos(column / 7)
    xyz = np.column_stack([column * STEP, row * STEP, heights]).astype(np.int32)
    if folder is not None:
        folder.mkdir(exist_ok=True)
        with ColumnWriter(folder) as writer:
            writer.append({"xyz": xyz, "pulse": cells})
    coordinates = Coordinates({"xyz": xyz}, Quantisation(SCALE, OFFSET), folder)
    return PointCloudImage(ImageKind.TOP_VIEW, cells, WIDTH, coordinates=coordinates)


def position_of_row(row: int) -> np.ndarray:
    """In the middle of a row, m."""
    return np.array([WIDTH / 2 * STEP, row * STEP, 0]) * SCALE + OFFSET


def test_what_is_worked_out_bit_by_bit_equals_what_is_made_in_one_go(tmp_path: Path) -> None:
    whole = hills().pyramid.table
    pyramid = hills(tmp_path / "d").pyramid
    while not pyramid.extend(position_of_row(1300), 100_000):
        assert not pyramid.is_ready
    assert pyramid.is_ready
    np.testing.assert_array_equal(pyramid.table, whole)
    assert [path.name for path in (tmp_path / "d").glob("tile_bounds*")] == [
        "tile_bounds_top-view.npy"
    ]


def test_tiles_near_the_place_asked_for_become_exact_first() -> None:
    whole = hills().pyramid
    pyramid = hills().pyramid
    pyramid.extend(position_of_row(1400), 1)
    near, far = TileKey(0, 1400 // 256, 0), TileKey(0, 0, 0)
    assert pyramid.is_exact(near)
    assert not pyramid.is_exact(far)
    line = pyramid.index(near)
    np.testing.assert_array_equal(pyramid.facts[line], whole.table[line])
    assert not pyramid.is_exact(pyramid.top)


def test_a_sketch_says_about_where_tiles_are() -> None:
    whole, pyramid = hills().pyramid, hills().pyramid
    low, high = slice(0, 3), slice(3, 6)
    sketched, exact = pyramid.facts, whole.table
    assert not pyramid.is_ready
    plan = [0, 1]  # waves rise between the rows that were looked at
    assert (sketched[:, low][:, plan] <= exact[:, low][:, plan]).all()
    assert (sketched[:, high][:, plan] >= exact[:, high][:, plan]).all()
    size = exact[:, high] - exact[:, low]
    room = 0.5 * np.linalg.norm(size, axis=1, keepdims=True) + 2.0
    assert (sketched[:, high] - sketched[:, low] <= size + room).all()


def test_what_was_worked_out_before_the_program_ended_is_not_done_again(tmp_path: Path) -> None:
    first = hills(tmp_path / "d").pyramid
    first.extend(position_of_row(1400), 200_000)
    first.keep()
    done = [key for key in first.keys(0) if first.is_exact(key)]
    assert 0 < len(done) < len(list(first.keys(0)))
    again = hills(tmp_path / "d").pyramid
    again.sketch()
    assert [key for key in again.keys(0) if again.is_exact(key)] == done
    np.testing.assert_array_equal(again.table, hills().pyramid.table)
    assert not (tmp_path / "d" / "tile_bounds_top-view.begun.npz").exists()


@pytest.mark.parametrize("damage", [b"", b"nonsense", b"PK\x03\x04 cut off"])
def test_a_damaged_file_of_what_was_begun_is_made_again(tmp_path: Path, damage: bytes) -> None:
    pyramid = hills(tmp_path / "d").pyramid
    pyramid.extend(None, 200_000)
    pyramid.keep()
    path = tmp_path / "d" / "tile_bounds_top-view.begun.npz"
    path.write_bytes(damage)
    again = hills(tmp_path / "d").pyramid
    again.sketch()
    assert not any(again.is_exact(key) for key in again.keys(0))
    np.testing.assert_array_equal(again.table, hills().pyramid.table)


def test_preparing_can_be_cancelled_and_goes_on_from_there() -> None:
    # 780,000 points are one portion, so two images' worth is what can be stopped in between.
    cells = np.arange(6 * ROWS * WIDTH // 2)
    xyz = np.column_stack([cells % WIDTH, cells // WIDTH, cells * 0]).astype(np.int32)
    coordinates = Coordinates({"xyz": xyz}, Quantisation(SCALE, OFFSET))
    image = PointCloudImage(ImageKind.TOP_VIEW, cells, WIDTH, coordinates=coordinates)
    with pytest.raises(Cancelled):
        image.pyramid.prepare(CancelledAfter())
    assert any(image.pyramid.is_exact(key) for key in image.pyramid.keys(0))
    assert not image.pyramid.is_ready
    image.pyramid.prepare()
    assert image.pyramid.is_ready


@pytest.mark.parametrize("budget", [3_000, 100_000, 10**7])
def test_while_bounds_are_sketched_every_part_is_drawn_exactly_once(budget: int) -> None:
    pyramid = hills().pyramid
    chosen = tiles_in_view([pyramid], above(pyramid), budget)
    assert not pyramid.is_ready
    assert drawn_times(pyramid, chosen).min() == drawn_times(pyramid, chosen).max() == 1


def test_a_coarse_tile_without_points_of_its_own_does_not_hide_those_below() -> None:
    # One column of points in odd rows, none of which a coarser level samples.
    cells = (np.arange(1, 2000, 2) * 300 + 7).astype(np.int64)
    xyz = np.column_stack([cells % 300 * STEP, cells // 300 * STEP, cells * 0]).astype(np.int32)
    coordinates = Coordinates({"xyz": xyz}, Quantisation(SCALE, OFFSET))
    image = PointCloudImage(ImageKind.TOP_VIEW, cells, 300, coordinates=coordinates)
    pyramid = image.pyramid
    assert pyramid.bounds(pyramid.top) is not None
    chosen = tiles_in_view([pyramid], above(pyramid), 10**6)
    shown = np.concatenate([pyramid.points(key).ravel() for _, key in chosen])
    np.testing.assert_array_equal(np.unique(shown[shown >= 0]), np.arange(cells.size))


def test_a_hundred_drives_together_all_get_something_within_the_budget() -> None:
    pyramids = [hills_at(number).pyramid for number in range(100)]
    budget = 150_000
    view = above(pyramids[0], height_m=500.0)
    chosen = tiles_in_view(pyramids, view, budget)
    assert {number for number, _ in chosen} == set(range(100))
    assert sum(pyramids[number].count(key) for number, key in chosen) <= budget


def wall(levels: int = 40) -> PointCloudImage:
    """A top view of a wall that runs east, so many points above each other in each of its cells."""
    column, height = np.divmod(np.arange(300 * levels), levels)
    xyz = np.column_stack([column * STEP, column * 0, -height * STEP]).astype(np.int32)
    coordinates = Coordinates({"xyz": xyz}, Quantisation(SCALE, OFFSET))
    return PointCloudImage(ImageKind.TOP_VIEW, column, 300, coordinates=coordinates)


def test_a_wall_that_the_image_shows_as_a_line_is_drawn_with_all_its_points_from_near() -> None:
    image = wall()
    pyramid = image.pyramid
    view = above(pyramid, height_m=30.0)
    flat = tiles_in_view([pyramid], view, 10**6)
    shown = np.concatenate([pyramid.points(key).ravel() for _, key in flat])
    assert np.count_nonzero(shown >= 0) == 300
    whole = tiles_in_view([pyramid], view, 10**6, has_all=True)
    assert all(key.has_all for _, key in whole)
    shown = np.concatenate([pyramid.points(key).ravel() for _, key in whole])
    assert sorted(shown.tolist()) == list(range(image.drive_count))


def test_all_points_are_drawn_only_within_the_budget_and_where_they_make_a_difference() -> None:
    pyramid = wall().pyramid
    view = above(pyramid, height_m=30.0)
    poor = tiles_in_view([pyramid], view, 1000, has_all=True)
    assert not any(key.has_all for _, key in poor)
    far = tiles_in_view([pyramid], above(pyramid, height_m=20_000.0), 10**6, has_all=True)
    assert not any(key.has_all for _, key in far)
    single = hills_at(0).pyramid
    near = tiles_in_view([single], above(single, height_m=1.0), 10**6, has_all=True)
    assert not any(key.has_all for _, key in near)


def test_the_tile_with_all_points_stands_below_the_finest_one() -> None:
    pyramid = wall().pyramid
    key = TileKey(0, 0, 1, has_all=True)
    assert pyramid.parent(key) == TileKey(0, 0, 1)
    assert key.rank == 0 < TileKey(0, 0, 1).rank
    assert pyramid.rows_columns(key) == pyramid.rows_columns(TileKey(0, 0, 1))


def hills_at(number: int) -> PointCloudImage:
    """A small level patch, so many metres further."""
    cells = np.arange(300 * 300)
    xyz = np.column_stack([cells % 300 * STEP, cells // 300 * STEP + 10 * number, cells * 0])
    coordinates = Coordinates({"xyz": xyz.astype(np.int32)}, Quantisation(SCALE, OFFSET))
    return PointCloudImage(ImageKind.TOP_VIEW, cells, 300, coordinates=coordinates)


def above(pyramid: TilePyramid, height_m: float = 400.0) -> Camera3D:
    """Straight down on all of it."""
    line = pyramid.facts[pyramid.index(pyramid.top)]
    middle = (line[:3] + line[3:6]) / 2
    return Camera3D(
        origin=(float(middle[0]), float(middle[1]), float(middle[2])),
        position=(0.0, 0.0, height_m),
        direction=(0.0, 0.0, -1.0),
        up=(0.0, 1.0, 0.0),
        width_px=1000,
        height_px=1000,
        angle_deg=45.0,
    )


def drawn_times(pyramid: TilePyramid, chosen: list[tuple[int, TileKey]]) -> np.ndarray:
    """How often each pixel is covered by the tiles chosen."""
    drawn = np.zeros((ROWS, WIDTH), np.int64)
    for _, key in chosen:
        rows, columns = pyramid.rows_columns(key)
        drawn[rows.start : rows.stop, columns.start : columns.stop] += 1
    return drawn
