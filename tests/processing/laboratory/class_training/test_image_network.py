"""The image network's way from points to pixels, tiles and back, and the choice of forests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.class_training.forests import whole_score
from processing.laboratory.class_training.image_network.augmenting import (
    LearntImage,
    random_crop,
)
from processing.laboratory.class_training.image_network.comparison import (
    Described,
    Forests,
    best_kinds,
    chosen_shares,
    score_of,
)
from processing.laboratory.class_training.image_network.kept_streets import (
    KeptStreet,
    StreetFolder,
    seen_colours,
)
from processing.laboratory.class_training.image_network.network_training import (
    CLASSES,
    IMAGE_CHANNELS,
    ChannelScale,
    intermediate_features,
    read_network,
    targets_of,
    train_network,
    write_network,
)
from processing.laboratory.class_training.image_network.street_rasters import (
    CHANNELS,
    StreetRaster,
    holes_of,
    pixel_colours,
    raster_of,
    some_of_lines,
)
from processing.laboratory.class_training.image_network.tiles import (
    TILE_PX,
    at_pixels,
    cut_out,
    tiles_of,
)
from processing.laboratory.class_training.point_samples import NAMES, PointSample
from processing.laboratory.simulate.cameras.photographs import write_image_list
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.camera_scene import SURFACE_COLOURS, looking, photograph
from tests.processing.image.recordings import drive_of, small_drive


def raster(filled: np.ndarray, codes: np.ndarray, far: np.ndarray | None = None) -> StreetRaster:
    """A raster whose every channel is the column's number."""
    values = np.broadcast_to(np.arange(filled.shape[1]), (len(CHANNELS), *filled.shape))
    rows, columns = np.nonzero(filled)
    return StreetRaster(
        np.where(filled, values, 0).astype(np.float16),
        np.where(filled, codes, 0).astype(np.uint8),
        filled,
        np.zeros(filled.shape, np.uint8) if far is None else far,
        0,
        rows.astype(np.int32),
        columns.astype(np.int32),
    )


@pytest.mark.parametrize("shape", [(40, 700), (513, 513), (514, 1_000), (977, 3_000)])
def test_tiles_cover_an_image_and_every_pixel_is_one_tiles_own(shape: tuple[int, int]) -> None:
    owners = np.zeros(shape, np.int64)
    for tile in tiles_of(*shape):
        for first, own, length in (
            (tile.row, tile.own_rows, shape[0]),
            (tile.column, tile.own_columns, shape[1]),
        ):
            assert first <= own.start
            assert own.stop <= first + TILE_PX
            # Away from the image's border a tile's own pixels are 25 and more from its edge.
            assert own.start == 0 or own.start - first >= 25
            assert own.stop == length or first + TILE_PX - own.stop >= 25
        owners[tile.own_rows.start : tile.own_rows.stop,
               tile.own_columns.start : tile.own_columns.stop] += 1  # fmt: skip
    assert (owners == 1).all()


def test_a_tile_beyond_the_border_is_empty_there() -> None:
    image = np.ones((2, 40, 600), np.float16)
    *_, last = tiles_of(40, 600)
    cut = cut_out(image, last)
    assert cut.shape == (2, TILE_PX, TILE_PX)
    assert cut[:, :40].all()
    assert not cut[:, 40:].any()


def test_a_networks_coarse_output_is_brought_back_to_pixels() -> None:
    # A quarter of the pixels: 129 values from corner to corner of 513 pixels, here a plane.
    down, across = np.mgrid[0:129, 0:129].astype(np.float32) * 4
    coarse = np.stack([down, across, 2 * down - across])
    rows, columns = np.array([0, 512, 3, 200, 511]), np.array([0, 512, 1, 77, 510])
    wanted = np.stack([rows, columns, 2 * rows - columns], axis=1)
    np.testing.assert_allclose(at_pixels(coarse, rows, columns), wanted, atol=1e-3)


def test_holes_of_one_or_two_pixels_within_a_row_are_found() -> None:
    filled = np.array([[1, 0, 1, 0, 0, 1, 0, 0, 0, 1], [0, 0, 1, 1, 1, 1, 1, 1, 0, 0]], bool)
    holes = holes_of(filled)
    assert holes.rows.tolist() == [0, 0]
    assert holes.before.tolist() == [0, 2]
    assert holes.after.tolist() == [2, 5]


def test_for_learning_a_hole_is_filled_between_the_same_class_but_not_between_wires() -> None:
    filled = np.array([[1, 0, 1, 0, 0, 1, 0, 1, 0, 1]], bool)
    codes = np.array([[5, 0, 5, 0, 0, 5, 0, 14, 0, 14]], np.uint8)
    found = raster(filled, codes).without_holes(by_labels=True)
    assert found.filled[0].tolist() == [True] * 6 + [False, True, False, True]
    assert found.codes[0].tolist() == [5] * 6 + [0, 14, 0, 14]
    np.testing.assert_allclose(found.values[3, 0, :6], np.arange(6), atol=1e-2)
    assert found.values[3, 0, 6] == 0


def test_without_labels_a_hole_is_filled_where_its_ends_are_close_and_gets_no_class() -> None:
    filled = np.array([[1, 0, 1, 0, 1]], bool)
    far = np.array([[0, 0, 0, 0, 1]], np.uint8)
    found = raster(filled, np.full((1, 5), 14), far).without_holes(by_labels=False)
    assert found.filled[0].tolist() == [True, True, True, False, True]
    assert found.codes[0].tolist() == [14, 0, 14, 0, 14]


def test_a_drives_raster_holds_its_points_features_and_survives_its_file(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    labels = np.where(np.arange(drive.count) % 2, 6, 11).astype(np.uint8)
    rows = range(2, 9)
    found = raster_of(drive, labels, rows)
    assert found.filled.shape[0] == len(rows)
    points = found.first_point + np.arange(found.rows_of_points.size)
    at = found.pixels_of(points)
    is_shown = at[1] >= 0
    assert is_shown.any()
    # A pixel that two points share speaks for both; most have one.
    heights = found.values[CHANNELS.index("height")][at[0][is_shown], at[1][is_shown]]
    same = np.isclose(heights, drive.xyz(points[is_shown])[:, 2], rtol=1e-3, atol=0.02)
    assert same.mean() > 0.8
    assert np.isin(found.codes[found.filled], (6, 11)).all()
    found.write(tmp_path / "raster.npz")
    read = StreetRaster.read(tmp_path / "raster.npz")
    np.testing.assert_array_equal(read.values, found.values)
    assert read.first_point == found.first_point


def test_of_a_scan_line_every_third_point_and_the_ends_are_looked_around() -> None:
    along = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 2.0, 5.0, 5.1, 5.2])
    xyz = np.stack([along, np.zeros(9), np.zeros(9)], axis=1)
    assert np.flatnonzero(some_of_lines(xyz)).tolist() == [0, 3, 4, 5, 6, 8]


def test_ground_is_road_and_what_is_no_class_is_not_learnt() -> None:
    numbers = targets_of(np.array([2, 11, 66, 0, 1, 18], np.uint8))
    road, pole = CLASSES.index(11), CLASSES.index(66)
    assert numbers.tolist() == [road, road, pole, -1, -1, -1]


def test_channels_are_scaled_by_what_is_usual_and_empty_pixels_are_nothing() -> None:
    filled = np.ones((30, 40), bool)
    filled[:, 7] = False
    street = raster(filled, np.full((30, 40), 11))
    image = ChannelScale.of([street]).image_of(street)
    assert image.values.shape == (len(IMAGE_CHANNELS) + 1, 30, 40)
    assert not image.values[:, :, 7].any()
    assert abs(np.median(image.values[0][filled])) < 0.1
    assert (image.targets[filled] == CLASSES.index(11)).all()
    assert (image.targets[:, 7] == -1).all()


def test_colours_are_further_channels_and_nothing_where_no_camera_sees() -> None:
    filled = np.ones((30, 40), bool)
    filled[:, 7] = False
    colours = np.zeros((4, 30, 40), np.uint8)
    colours[:, :, 20:] = np.array([200, 120, 40, 1])[:, None, None]
    colours[0, :, 20:] += np.arange(20, dtype=np.uint8)
    plain = raster(filled, np.full((30, 40), 11))
    street = plain.with_colours(colours)
    scale, known = ChannelScale.of([street]), ChannelScale.of([plain])
    # What isn't seen says nothing of what is usual; the other channels are as without colours.
    assert scale.middle[-3:] == pytest.approx([209.5, 120, 40], abs=1.5)
    np.testing.assert_array_equal(scale.middle[:-3], known.middle)
    image = scale.image_of(street)
    assert image.values.shape == (len(IMAGE_CHANNELS) + 5, 30, 40)
    assert not image.values[-5:-1, :, :20].any()
    assert image.values[-5, 0, 20] < 0 < image.values[-5, 0, 39]
    assert (image.values[-2] == (np.arange(40) >= 20)).all()
    assert (image.values[-1] == filled).all()


def test_a_hole_has_a_colour_only_where_both_ends_have_one() -> None:
    filled = np.array([[1, 0, 1, 0, 1]], bool)
    colours = np.zeros((4, 1, 5), np.uint8)
    colours[:, 0, 0], colours[:, 0, 2] = (100, 90, 80, 1), (120, 90, 80, 1)
    street = raster(filled, np.full((1, 5), 11)).with_colours(colours)
    found = street.without_holes(by_labels=True)
    assert found.filled.all()
    assert found.is_seen[0].tolist() == [True, True, True, False, False]
    assert found.values[-4, 0, 1] == 110


def test_points_and_pixels_get_the_colours_of_camera_images(tmp_path: Path) -> None:
    street = simulated_drive(3, pulses_per_revolution=600.0, lost_share=0.0)
    drive = drive_of(street, tmp_path / "d")
    assert not seen_colours([drive]).any()
    image = looking(tmp_path / "1.png", (-0.5, 1.0, 2.0), (0.0, 1.0, -0.3), size=(600, 450))
    photograph(image)
    write_images(drive.folder, ImageList([image]))
    drive = Drive(drive.folder)
    found = seen_colours([drive])
    is_road = (street.surface == 0) & (found[:, 3] > 0)
    assert is_road.sum() > 50
    assert (found[is_road, :3] == SURFACE_COLOURS[0]).all(axis=1).mean() > 0.95
    rows = range(2, 9)
    pixels = pixel_colours(drive, found, rows)
    kept = raster_of(drive, np.full(drive.count, 11, np.uint8), rows)
    assert pixels.shape == (4, *kept.filled.shape)
    assert not pixels[:, ~kept.filled].any()
    assert kept.with_colours(pixels).is_seen.any()


def test_a_deliverys_colours_come_later_than_all_else(tmp_path: Path) -> None:
    street = simulated_drive(3, pulses_per_revolution=600.0, lost_share=0.0)
    delivery, work = tmp_path / "street", tmp_path / "work"
    (delivery / "truth").mkdir(parents=True)
    work.mkdir()
    write_laz(street, delivery / "left.laz")
    write_trajectory_csv(street, delivery / "trajectory.csv")
    codes = np.where(street.surface == 0, 11, 6).astype(np.uint8)
    np.save(delivery / "truth" / "left.labels.npy", codes)
    image = looking(delivery / "1.png", (-0.5, 1.0, 2.0), (0.0, 1.0, -0.3), size=(600, 450))
    photograph(image)
    write_image_list(delivery / "images.csv", [image])
    (plain,) = StreetFolder(work, 10.0, asks_colours=False).delivered([delivery], 200)
    assert not plain.colours_path.exists()
    before = plain.raster_path.stat().st_mtime_ns
    (coloured,) = StreetFolder(work, 10.0, asks_colours=True).delivered([delivery], 200)
    assert coloured.raster_path.stat().st_mtime_ns == before
    is_road = (coloured.sample.codes == 11) & (coloured.colours[:, 0] >= 0)
    assert is_road.any()
    right = (coloured.colours[is_road] == SURFACE_COLOURS[0]).all(axis=1)
    assert right.mean() > 0.9
    assert coloured.coloured_raster.is_seen.any()


def test_a_kept_streets_points_have_their_colours_or_none(tmp_path: Path) -> None:
    path = tmp_path / "colours.npz"
    points = np.array([[0, 0, 0, 0], [9, 8, 7, 1], [1, 2, 3, 1]], np.uint8)
    np.savez(path, points=points)
    rows = np.zeros((2, len(NAMES)), np.float32)
    sample = PointSample(rows, np.full(2, 11, np.uint8), np.array([2, 0]), {11: 2})
    street = KeptStreet("street", sample, tmp_path / "raster.npz", path)
    assert street.colours.tolist() == [[1, 2, 3], [-1, -1, -1]]


def test_crops_meet_a_rare_class_and_keep_values_with_their_targets() -> None:
    targets = np.zeros((300, 900), np.int16)
    targets[100:104, 400:404] = 1  # 16 of 270,000
    values = np.stack([targets * 3.0, np.ones_like(targets)]).astype(np.float16)
    rng, met = np.random.default_rng(0), 0
    for _ in range(10):
        found, asked = random_crop(LearntImage(values, targets), rng, size=65)
        assert found.shape == (2, 65, 65)
        met += bool((asked == 1).any())
        outside = asked < 0
        assert not found[:, outside].any()
        if (asked == 1).any():
            assert found[0][asked == 1].mean() > found[0][asked == 0].mean()
    assert met >= 3


def test_each_class_is_given_by_the_forest_that_knew_it_best() -> None:
    codes = np.array([5, 66], np.uint8)
    true = np.repeat(codes, 10)
    counts = {5: 10, 66: 10}
    first, second = true.copy(), true.copy()
    first[12:], second[:5] = 5, 66  # the first misses poles, the second crowns
    scores = {"M": whole_score(true, first, counts), "M&A": whole_score(true, second, counts)}
    assert best_kinds(scores, [5, 66, 3], ["M", "M&A"]) == ["M", "M&A", "M&A"]
    shares = {"M": np.array([[0.9, 0.1]]), "M&A": np.array([[0.2, 0.8]])}
    np.testing.assert_allclose(chosen_shares(shares, ["M", "M&A"]), [[0.9, 0.8]])


def test_a_street_is_scored_by_each_kind_of_features_ground_as_road() -> None:
    rng = np.random.default_rng(0)
    codes = rng.choice(np.array([2, 11, 66], np.uint8), 300)
    told = (codes == 66)[:, None] + rng.normal(0, 0.1, (300, 2)).astype(np.float32)
    rows = np.zeros((300, len(NAMES)), np.float32)
    sample = PointSample(rows, codes, np.arange(300), {2: 500, 11: 500, 66: 100})
    described = Described(sample, {"blind": rows[:, :2], "seeing": told})
    forests = Forests.of([described])
    assert forests.codes.tolist() == [11, 66]
    shares = forests.shares(described)
    seeing = score_of(sample, forests.codes, shares["seeing"])
    assert {one.id for one in seeing.classes} == {"11", "66", "ground_and_road"}
    assert seeing.points == 1_100
    blind = score_of(sample, forests.codes, shares["blind"])
    assert {one.id: one.value for one in seeing.figures}["mean_f"] > 0.95
    assert {one.id: one.value for one in blind.figures}["mean_f"] < 0.6


def test_a_network_learns_from_a_street_and_is_the_same_from_its_file(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    filled = np.ones((60, 300), bool)
    codes = np.where(np.arange(300) < 150, 11, 6) * np.ones((60, 1))
    street = raster(filled, codes)
    scale = ChannelScale.of([street])
    image = scale.image_of(street)
    network = train_network([image], 1, lambda _: None)
    write_network(network, scale, tmp_path / "network.pt")
    again, its_scale = read_network(tmp_path / "network.pt")
    rows, columns = np.array([3, 59, 10]), np.array([0, 299, 100])
    found = intermediate_features(network, image, rows, columns)
    assert found.shape == (3, 256)
    assert np.isfinite(found).all()
    np.testing.assert_allclose(
        intermediate_features(again, its_scale.image_of(street), rows, columns), found, atol=1e-5
    )
