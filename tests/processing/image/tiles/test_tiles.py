"""Tiles: what they show, where they are in space, and which ones a view needs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.image.search.tile_choice import Camera3D, tiles_in_view, tiles_in_window
from processing.image.tiles.tiles import TILE, TileKey, TilePyramid
from processing.recording.columns.coordinates import Coordinates
from processing.recording.columns.quantisation import Quantisation
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import random_recording, small_drive

SCALE, OFFSET = (0.001, 0.001, 0.001), (10_000.0, -20_000.0, 50.0)
SPACING_M = 0.1


def plane_image(rows: int = 700, width: int = 600, folder: Path | None = None) -> PointCloudImage:
    """A top view whose points lie on a level grid, 0.1 m apart, all cells filled."""
    cells = np.arange(rows * width)
    xyz = np.column_stack([cells % width * 100, -(cells // width) * 100, cells * 0])
    coordinates = Coordinates({"xyz": xyz.astype(np.int32)}, Quantisation(SCALE, OFFSET), folder)
    return PointCloudImage(ImageKind.TOP_VIEW, cells, width, coordinates=coordinates)


def camera(**changes: object) -> Camera3D:
    """Straight down on the middle of the plane from 100 m."""
    middle = (OFFSET[0] + 30.0, OFFSET[1] - 35.0, OFFSET[2])
    values: dict[str, object] = {
        "origin": middle,
        "position": (0.0, 0.0, 100.0),
        "direction": (0.0, 0.0, -1.0),
        "up": (0.0, 1.0, 0.0),
        "width_px": 800,
        "height_px": 800,
        **changes,
    }
    return Camera3D(**values)  # type: ignore[arg-type]


def test_the_coarsest_level_is_one_tile_and_children_tile_their_parent() -> None:
    pyramid = plane_image().pyramid
    assert list(pyramid.keys(pyramid.levels - 1)) == [pyramid.top]
    assert [len(list(pyramid.keys(level))) for level in (0, 1, 2)] == [9, 4, 1]
    # So few that a hundred drives can be drawn together.
    assert pyramid.points(pyramid.top).size <= 4096
    for level in range(1, pyramid.levels):
        for key in pyramid.keys(level):
            rows, columns = pyramid.rows_columns(key)
            area = 0
            for child in pyramid.children(key):
                assert pyramid.parent(child) == key
                own_rows, own_columns = pyramid.rows_columns(child)
                assert own_rows.start >= rows.start
                assert own_columns.stop <= columns.stop
                area += len(own_rows) * len(own_columns)
            assert area == len(rows) * len(columns)
    assert pyramid.children(TileKey(0, 0, 0)) == ()


def test_a_coarse_tile_shows_points_of_its_children() -> None:
    recording = random_recording(5, pulses_per_revolution=700, revolutions=600, lost_share=0.5)
    xyz = np.zeros((recording.pulses.size, 3), np.int32)
    image = PointCloudImage(
        ImageKind.TRAJECTORY_REVERSIBLE,
        recording.pulses,
        recording.revolutions,
        coordinates=Coordinates({"xyz": xyz}, Quantisation(SCALE, OFFSET)),
    )
    pyramid = image.pyramid
    key = pyramid.top
    while key.level:
        shown = pyramid.points(key)
        assert max(shown.shape) <= TILE
        below = np.concatenate([pyramid.points(child).ravel() for child in pyramid.children(key)])
        assert np.isin(shown[shown >= 0], below).all()
        key = pyramid.children(key)[0]


def test_bounds_hold_every_point_of_a_tile_and_touch_them() -> None:
    recording = random_recording(1, pulses_per_revolution=300, revolutions=600)
    random = np.random.default_rng(0)
    xyz = random.integers(-50_000, 50_000, (recording.pulses.size, 3)).astype(np.int32)
    coordinates = Coordinates({"xyz": xyz}, Quantisation(SCALE, OFFSET))
    image = PointCloudImage(
        ImageKind.FEATURE_CENTER, recording.pulses, recording.revolutions, coordinates=coordinates
    )
    metres = xyz * np.array(SCALE) + np.array(OFFSET)
    rows, columns = image.pixel_of(np.arange(image.drive_count))
    for level in range(image.pyramid.levels):
        for key in image.pyramid.keys(level):
            own_rows, own_columns = image.pyramid.rows_columns(key)
            inside = (rows >= own_rows.start) & (rows < own_rows.stop)
            inside &= (columns >= own_columns.start) & (columns < own_columns.stop)
            bounds = image.pyramid.bounds(key)
            if not inside.any():
                assert bounds is None
                continue
            assert bounds is not None
            np.testing.assert_allclose(bounds[0], metres[inside].min(axis=0), atol=1e-9)
            np.testing.assert_allclose(bounds[1], metres[inside].max(axis=0), atol=1e-9)
            assert image.pyramid.count(key) == (image.pyramid.points(key) >= 0).sum()


def test_spacing_is_the_distance_of_neighbours_and_doubles_with_the_level() -> None:
    pyramid = plane_image().pyramid
    pyramid.prepare()
    assert pyramid.spacing_m(TileKey(0, 1, 1)) == pytest.approx(SPACING_M)
    assert pyramid.spacing_m(TileKey(1, 0, 0)) == pytest.approx(2 * SPACING_M)


def test_bounds_are_kept_in_the_folder_and_made_again_when_damaged(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    path = tmp_path / "d" / "tile_bounds_reversible.npy"
    first = image_of(drive, ImageKind.REVERSIBLE).pyramid.table
    assert path.is_file()

    def again() -> TilePyramid:
        image = PointCloudImage.of_drive(drive, ImageKind.REVERSIBLE)
        assert not image.pyramid.is_ready
        return image.pyramid

    np.testing.assert_array_equal(again().table, first)
    for damage in (b"", b"nonsense", path.read_bytes()[:200]):
        path.write_bytes(damage)
        np.testing.assert_array_equal(again().table, first)
        assert len(path.read_bytes()) > 200
    path.unlink()
    np.testing.assert_array_equal(again().table, first)
    assert not list(path.parent.glob("*.part"))


def test_a_pyramid_in_a_folder_that_takes_no_files_still_works(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    # A folder in the way of the temporary file stands for a disk that refuses to write.
    (tmp_path / "d" / "tile_bounds_reversible.npy").mkdir()
    pyramid = image_of(drive, ImageKind.REVERSIBLE).pyramid
    assert pyramid.count(pyramid.top) > 0


def test_without_coordinates_there_is_no_pyramid() -> None:
    image = PointCloudImage(ImageKind.TOP_VIEW, np.arange(10), 5)
    with pytest.raises(ValueError, match="coordinates"):
        _ = image.pyramid


def test_a_window_is_covered_by_sharp_tiles_the_middle_first() -> None:
    pyramid = plane_image().pyramid
    assert tiles_in_window(pyramid, range(300, 400), range(300, 400), 1.0) == [TileKey(0, 1, 1)]
    assert tiles_in_window(pyramid, range(300, 400), range(300, 400), 4.0) == [TileKey(0, 1, 1)]
    assert {key.level for key in tiles_in_window(pyramid, range(700), range(600), 0.6)} == {0}
    assert {key.level for key in tiles_in_window(pyramid, range(700), range(600), 0.5)} == {1}
    assert tiles_in_window(pyramid, range(700), range(600), 0.01) == [pyramid.top]
    wide = tiles_in_window(pyramid, range(-500, 2000), range(250, 350), 1.0)
    assert len(wide) == 6
    assert wide[0].row == 2
    assert tiles_in_window(pyramid, range(5000, 6000), range(10), 1.0) == []


def covered(pyramid: TilePyramid, chosen: list[tuple[int, TileKey]]) -> np.ndarray:
    """How often each level-0 tile is covered."""
    times = np.zeros(pyramid.shape(0), int)
    for _, key in chosen:
        size = 1 << key.level
        times[
            key.row * size : (key.row + 1) * size, key.column * size : (key.column + 1) * size
        ] += 1
    return times


def test_from_above_every_part_is_drawn_exactly_once_at_any_budget() -> None:
    pyramid = plane_image().pyramid
    for budget in (1, 100_000, 200_000, 10**9):
        chosen = tiles_in_view([pyramid], camera(angle_deg=60.0), budget)
        assert (covered(pyramid, chosen) == 1).all()
        levels = [key.level for _, key in chosen]
        assert levels == sorted(levels, reverse=True)
        points = sum(pyramid.count(key) for _, key in chosen)
        assert points <= max(budget, pyramid.count(pyramid.top))


def test_a_nearer_camera_gets_finer_tiles_and_a_far_one_does_not_spend_the_budget() -> None:
    pyramid = plane_image().pyramid
    near = tiles_in_view([pyramid], camera(position=(0.0, 0.0, 5.0), angle_deg=60.0), 10**9)
    far = tiles_in_view([pyramid], camera(position=(0.0, 0.0, 5000.0)), 10**9)
    assert min(key.level for _, key in near) == 0
    assert far == [(0, pyramid.top)]


def test_what_lies_beside_or_behind_the_view_is_not_drawn() -> None:
    pyramid = plane_image().pyramid
    assert tiles_in_view([pyramid], camera(direction=(0.0, 0.0, 1.0)), 10**9) == []
    assert tiles_in_view([pyramid], camera(position=(500.0, 0.0, 50.0)), 10**9) == []
    narrow = camera(position=(0.0, 0.0, 5.0), angle_deg=20.0)
    chosen = tiles_in_view([pyramid], narrow, 10**9)
    assert (0, TileKey(0, 1, 1)) in chosen
    assert (0, TileKey(0, 0, 0)) not in chosen


def test_a_parallel_view_refines_by_its_scale_alone() -> None:
    pyramid = plane_image().pyramid
    for height in (0.5, 1e4):
        view = camera(position=(0.0, 0.0, height), parallel_height_m=10.0)
        chosen = tiles_in_view([pyramid], view, 10**9)
        assert {key.level for _, key in chosen} == {0}
    wide = camera(parallel_height_m=10_000.0)
    assert tiles_in_view([pyramid], wide, 10**9) == [(0, pyramid.top)]


def test_tiles_of_several_drives_share_the_budget() -> None:
    pyramids = [plane_image().pyramid, plane_image().pyramid]
    chosen = tiles_in_view(pyramids, camera(angle_deg=60.0), 400_000)
    assert {number for number, _ in chosen} == {0, 1}
    assert sum(pyramids[number].count(key) for number, key in chosen) <= 400_000
