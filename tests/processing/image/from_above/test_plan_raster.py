"""The point that one sees from above: the highest one below a ceiling, in every pixel."""

from __future__ import annotations

import numpy as np
import pytest

from processing.image.from_above.plan_raster import (
    CEILING_PX,
    NO_POINT,
    PlanFrame,
    PlanRaster,
    ceiling_shape,
    raster_kernel,
    square_middles,
)

ORIGIN = np.array([-11_000.0, -35_000.0, 100.0])
FRAME = PlanFrame(west=-11_000.0, north=-34_990.0, px_per_m=2.0, width=20, height=20)
"""Ten by ten metres, half a metre a pixel."""


def add(raster: PlanRaster, *positions: tuple[float, float, float], drive: int = 0, size: int = 1):
    """Points by their place from the origin; each has the colour of its number."""
    count = len(positions)
    colours = np.arange(count, dtype=np.uint8)[:, None] + np.array([10, 20, 30], np.uint8)
    points = 100 + np.arange(count)
    raster.add(drive, points, np.array(positions, dtype=np.float32), colours, size_px=size)


def test_a_point_is_in_the_pixel_where_it_lies() -> None:
    raster = PlanRaster(FRAME, ORIGIN)
    add(raster, (0.1, 9.9, 1.0), (9.9, 0.1, 1.0), (3.2, 6.7, 1.0))
    picture = raster.picture()
    rows, columns = np.nonzero(picture.points != NO_POINT)
    shown = sorted(zip(rows.tolist(), columns.tolist(), strict=True))
    assert shown == [(0, 0), (6, 6), (19, 19)]
    assert picture.pixels[6, 6].tolist() == [32, 22, 12, 255]
    assert picture.pixels[1, 1].tolist() == [0, 0, 0, 0]


def test_of_several_points_in_a_pixel_the_highest_is_shown_whatever_their_order() -> None:
    for positions in ([(5.1, 5.1, 2.0), (5.2, 5.2, 1.0)], [(5.2, 5.2, 1.0), (5.1, 5.1, 2.0)]):
        raster = PlanRaster(FRAME, ORIGIN)
        add(raster, *positions)
        picture = raster.picture()
        (shown,) = picture.points[picture.points != NO_POINT].tolist()
        assert positions[shown - 100][2] == 2.0


def test_what_is_above_the_ceiling_hides_nothing() -> None:
    ceilings = np.full(ceiling_shape(FRAME), 103.0)
    raster = PlanRaster(FRAME, ORIGIN, ceilings)
    add(raster, (5.1, 5.1, 0.2), (5.1, 5.1, 6.0), (1.0, 1.0, 3.5))
    picture = raster.picture()
    assert picture.points[picture.points != NO_POINT].tolist() == [100]


def test_each_square_has_a_ceiling_of_its_own() -> None:
    assert ceiling_shape(FRAME) == (2, 2)
    ceilings = np.array([[101.0, 110.0], [110.0, 110.0]])
    raster = PlanRaster(FRAME, ORIGIN, ceilings)
    add(raster, (1.0, 9.0, 5.0), (9.0, 9.0, 5.0), (1.0, 1.0, 5.0))
    picture = raster.picture()
    assert sorted(picture.points[picture.points != NO_POINT].tolist()) == [101, 102]


def test_ceilings_of_another_shape_are_refused() -> None:
    with pytest.raises(ValueError, match="ceilings"):
        PlanRaster(FRAME, ORIGIN, np.zeros((1, 1)))


def test_the_squares_middles_are_where_their_pixels_are() -> None:
    middles = square_middles(FRAME)
    side_m = CEILING_PX / FRAME.px_per_m
    assert middles.shape == (2, 2, 2)
    assert middles[0, 0].tolist() == [FRAME.west + side_m / 2, FRAME.north - side_m / 2]
    assert middles[1, 0, 1] == FRAME.north - 1.5 * side_m


def test_a_larger_point_covers_a_square_about_its_place_also_at_the_edge() -> None:
    raster = PlanRaster(FRAME, ORIGIN)
    add(raster, (5.25, 4.75, 1.0), size=3)
    rows, columns = np.nonzero(raster.picture().points != NO_POINT)
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (9, 11, 9, 11)
    raster = PlanRaster(FRAME, ORIGIN)
    add(raster, (-0.2, 10.2, 1.0), (30.0, 5.0, 1.0), size=3)
    picture = raster.picture()
    assert picture.points[0, 0] == 100
    assert (picture.points != NO_POINT).sum() == 1


def test_the_drawn_point_near_a_place_is_found_with_its_drive() -> None:
    raster = PlanRaster(FRAME, ORIGIN)
    add(raster, (5.1, 5.1, 2.0), drive=3)
    picture = raster.picture()
    assert picture.point_at(-10_994.9, -34_994.9, 0.1) == (3, 100)
    assert picture.point_at(-10_994.0, -34_994.9, 1.0) == (3, 100)
    assert picture.point_at(-10_992.0, -34_994.9, 1.0) is None
    assert picture.point_at(-11_900.0, -34_994.9, 1.0) is None


def test_a_picture_stays_as_it_was_when_points_are_added() -> None:
    raster = PlanRaster(FRAME, ORIGIN)
    before = raster.picture()
    add(raster, (5.1, 5.1, 2.0))
    assert (before.points == NO_POINT).all()
    assert not before.pixels.any()


def test_the_kernel_gives_the_same_compiled_and_plain() -> None:
    random = np.random.default_rng(5)
    xyz = random.uniform([-1, -1, 0], [11, 11, 8], (300, 3)).astype(np.float32)
    points = np.arange(300)
    colours = random.integers(0, 255, (300, 3), dtype=np.uint8)
    corner = np.array([0.0, 10.0, 2.0])
    ceilings = np.full((2, 2), 6.0, np.float32)
    results = []
    for function in (raster_kernel, raster_kernel.py_func):
        heights = np.full((20, 20), -np.inf, np.float32)
        shown = np.full((20, 20), NO_POINT)
        drives = np.zeros((20, 20), np.uint8)
        pixels = np.zeros((20, 20, 4), np.uint8)
        function(points, xyz, colours, 1, 2, corner, ceilings, heights, shown, drives, pixels)
        results.append((heights, shown, drives, pixels))
    for compiled, plain in zip(*results, strict=True):
        assert (compiled == plain).all()
    heights, shown, _, _ = results[0]
    is_filled = shown != NO_POINT
    assert (heights[is_filled] == xyz[shown[is_filled], 2]).all()
    assert heights.max() <= 6.0
