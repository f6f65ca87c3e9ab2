"""Points of noise that are hidden are nowhere: not in tiles, not under the mouse, on no line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.image.attributes.attributes import colours
from processing.image.attributes.colour_maps import class_colours
from processing.image.attributes.tile_cache import TileCache, TileRequest
from processing.image.images_of_drives import image_of
from processing.image.neighbourhoods.points_around import neighbours
from processing.image.rows.point_image_kernels import noiseless_raster_kernel, raster_kernel
from processing.image.tiles.tiles import TileKey
from processing.labels.label_column import make_column, write_labels
from processing.recording.columns.classes import read_classes
from processing.recording.columns.counted_classes import NOISE_CODES, class_columns, seen_points
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.section.cut import Cut
from processing.section.points_in_cut import points_in_cut
from resources import path_of
from tests.processing.image.recordings import small_drive

GROUND = 2


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    """Every other point of some rows is noise by label; one delivered as noise was painted."""
    made, _ = small_drive(tmp_path / "d", multi_return_share=0.3)
    delivered = np.zeros(made.count, np.uint8)
    delivered[10] = NOISE_CODES[0]
    made.columns.add("classification", delivered)
    make_column(made)
    noise = np.flatnonzero(np.random.default_rng(4).uniform(size=made.count) < 0.5)
    codes = np.where(noise % 2, *NOISE_CODES).astype(np.uint8)
    write_labels(made, noise, codes)
    write_labels(made, np.array([10]), np.array([GROUND], np.uint8))
    return made


def noise_of(drive: Drive) -> NDArray[np.bool_]:
    labels = np.asarray(drive.columns["label"])
    noise: NDArray[np.bool_] = np.isin(labels, NOISE_CODES)
    return noise


def test_the_codes_of_noise_are_those_of_the_class_table() -> None:
    names = {one.code: one.name.en for one in read_classes(path_of("catalogue/classes.toml"))}
    assert [names[code] for code in NOISE_CODES] == ["Low noise", "High noise"]


def test_what_counts_is_the_label_and_else_the_delivered_class(drive: Drive) -> None:
    classes = class_columns(drive.columns)
    assert classes.codes_of(np.array([10])).tolist() == [GROUND]
    assert not classes.are_noise(np.array([10])).any()
    every = np.arange(drive.count)
    np.testing.assert_array_equal(classes.are_noise(every), noise_of(drive))
    np.testing.assert_array_equal(classes.noise_between(100, 200), noise_of(drive)[100:200])
    np.testing.assert_array_equal(
        seen_points(drive.columns, every, hides_noise=True), every[~noise_of(drive)]
    )
    assert seen_points(drive.columns, every, hides_noise=False) is every
    shown = colours(drive, np.array([10, -1]), "class", 2, 98)
    np.testing.assert_array_equal(shown[0], class_colours()[GROUND])


@pytest.mark.parametrize("kind", list(ImageKind)[:4])
@pytest.mark.parametrize("step", [1, 4])
def test_a_pixel_shows_its_next_good_point_or_nothing(
    drive: Drive, kind: ImageKind, step: int
) -> None:
    if kind not in drive.image_kinds:
        pytest.skip("not a kind of this drive")
    image, noise = image_of(drive, kind), noise_of(drive)
    rows, columns = range(image.rows), range(image.width)
    classes = class_columns(drive.columns)
    raster = image.raster(rows, columns, step, without_noise=classes)
    for i, j in np.ndindex(raster.shape):
        row = i * step
        held = [image.points_at(row, one) for one in columns[j * step : (j + 1) * step]]
        good = [points[~noise[points]] for points in held]
        first = next((points for points in good if points.size), np.empty(0, np.int64))
        if not first.size:
            assert raster[i, j] == -1
        else:
            assert raster[i, j] in first
    shown = image.raster(rows, columns, step)
    is_good = (shown >= 0) & ~noise[shown]
    if step == 1:
        np.testing.assert_array_equal(raster[is_good], shown[is_good])
    plain = np.empty_like(raster)
    window = np.array([0, step, 0, image.width, image.width])
    noiseless_raster_kernel.py_func(image.layout, classes, window, plain)
    np.testing.assert_array_equal(plain, raster)


def test_without_any_noise_hiding_it_changes_nothing(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
    shape = image.rows, image.width
    one, other = np.empty(shape, np.int64), np.empty(shape, np.int64)
    window = np.array([0, 1, 0, image.width, image.width])
    raster_kernel(image.layout, window, one)
    noiseless_raster_kernel(image.layout, class_columns(drive.columns), window, other)
    np.testing.assert_array_equal(one, other)


def test_a_tile_without_noise_is_another_one_than_with_it(drive: Drive) -> None:
    kind, noise = drive.image_kinds[0], noise_of(drive)
    cache = TileCache()
    cache.use(lambda _: drive)
    try:
        request = TileRequest(drive.id, kind, TileKey(0, 0, 0), "class", 2.0, 98.0)
        hidden = replace(request, hides_noise=True)
        everything = replace(hidden, key=TileKey(0, 0, 0, has_all=True))
        made = [cache._pixels_of(one, lambda _: drive) for one in (request, hidden, everything)]
        with_noise, without, every = (pixels.points[pixels.points >= 0] for pixels in made)
        assert noise[with_noise].any()
        assert without.size
        assert not noise[without].any()
        assert not noise[every].any()
        assert every.size >= without.size
        with cache._changed:
            for one, pixels in zip((request, hidden, everything), made, strict=True):
                cache._keep(one, pixels)
        cache.drop_relabelled(drive, with_noise[:1])
        assert all(cache.get(one) is None for one in (request, hidden, everything))
    finally:
        cache.close()


def test_hidden_noise_is_in_no_section_and_under_no_mouse(drive: Drive) -> None:
    noise = noise_of(drive)
    middle = drive.xyz(np.array([drive.count // 2]))[0]
    cut = Cut(tuple(middle.tolist()), (1.0, 0.0), width_m=3.0)
    every = points_in_cut(drive, cut, drive.count)
    seen = points_in_cut(drive, cut, drive.count, hides_noise=True)
    np.testing.assert_array_equal(seen, every[~noise[every]])
    assert 0 < seen.size < every.size
    few = points_in_cut(drive, cut, 20, hides_noise=True)
    assert few.size == 20
    assert not noise[few].any()
    image = image_of(drive, drive.image_kinds[0])
    classes = class_columns(drive.columns)
    found = [image.nearest_filled(9, one, without_noise=classes) for one in range(image.width)]
    found = [one for one in found if one >= 0]
    assert found
    assert not noise[found].any()


def test_noise_is_no_neighbour_on_whose_edge_a_click_would_snap(drive: Drive) -> None:
    noise = noise_of(drive)
    for point in (1000, 1001, 1002):
        found = neighbours(drive, point, 0.5)
        assert point in found
        assert not noise[found[found != point]].any()
