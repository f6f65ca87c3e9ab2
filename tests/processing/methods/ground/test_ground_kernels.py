"""The loops against plain numpy, uncompiled too."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage

from processing.methods.ground.filters import band, cells, morphology, openings, walls


def test_levels_are_the_lowest_height_and_the_next_clearly_above() -> None:
    xyz = np.array([[0.5, 0.5, 1.0], [0.6, 0.5, 1.05], [0.5, 0.6, 2.0], [1.5, 0.5, 9.0]])
    grid = cells.CellGrid(np.zeros(3), 1.0, 1, 3)
    floor = np.full((1, 3), -np.inf, np.float32)
    levels = cells.levels_above(lambda: [xyz], grid, floor, 0.3)
    np.testing.assert_array_equal(levels.lowest, np.float32([[1.0, 9.0, np.nan]]))
    np.testing.assert_array_equal(levels.second, np.float32([[2.0, np.inf, np.inf]]))
    assert levels.near.tolist() == [[2, 1, 0]]
    assert levels.above.tolist() == [[1, 0, 0]]


def test_an_opening_takes_away_what_is_narrower_and_leaves_a_slope() -> None:
    surface = np.tile(np.arange(30, dtype=np.float32), (30, 1))
    peak = surface.copy()
    peak[15, 15] += 5.0
    opened = openings.open_heights(peak, 3)
    np.testing.assert_allclose(opened[5:25, 5:25], surface[5:25, 5:25])


def test_a_filled_hole_is_between_its_borders_and_known_cells_stay() -> None:
    heights = np.tile(np.arange(16, dtype=np.float32), (16, 1))
    known = np.ones((16, 16), np.bool_)
    known[5:11, 5:11] = False
    filled = morphology.fill_heights(heights, known)
    np.testing.assert_array_equal(filled[known], heights[known])
    np.testing.assert_allclose(filled, heights, atol=0.05)


def test_relaxing_uncompiled_gives_what_the_kernel_gives() -> None:
    rng = np.random.default_rng(1)
    for shape in ((9, 7), (1, 6), (6, 1), (4, 40)):
        known = rng.random(shape) < 0.3
        compiled = rng.random(shape).astype(np.float32)
        plain, before = compiled.copy(), compiled.copy()
        lists = morphology._near_known(known)
        assert sorted(np.concatenate(lists)) == np.flatnonzero(~known).tolist()
        morphology._relax_kernel(lists, 3, compiled)
        morphology._relax_kernel.py_func(lists, 3, plain)
        np.testing.assert_allclose(compiled, plain, rtol=1e-6)
        np.testing.assert_array_equal(compiled[known], before[known])


def test_relaxing_long_enough_makes_a_plane_between_known_borders() -> None:
    plane = np.add.outer(np.arange(12.0), 2.0 * np.arange(9.0)).astype(np.float32)
    known = np.ones(plane.shape, np.bool_)
    known[1:-1, 1:-1] = False
    surface = np.where(known, plane, np.float32(0.0)).astype(np.float32)
    morphology._relax_kernel(morphology._near_known(known), 200, surface)
    np.testing.assert_allclose(surface, plane, atol=1e-3)


@pytest.mark.parametrize("radius", [1, 3, 17, 18, 33])
@pytest.mark.parametrize("shape", [(60, 41), (2, 50), (50, 1)])
def test_an_opening_is_what_octagons_under_the_surface_reach(
    shape: tuple[int, int], radius: int
) -> None:
    heights = np.random.default_rng(radius).random(shape).astype(np.float32)
    side = round(0.414 * radius)
    reach = np.abs(np.arange(-radius, radius + 1))
    octagon = np.maximum(reach[:, None] - side, 0) + np.maximum(reach - side, 0) <= radius - side
    padded = np.pad(heights, 2 * radius, mode="edge")
    least = ndimage.minimum_filter(padded, footprint=octagon, mode="nearest")
    expected = ndimage.maximum_filter(least, footprint=octagon, mode="nearest")
    inside = slice(2 * radius, -2 * radius)
    np.testing.assert_array_equal(openings.open_heights(heights, radius), expected[inside, inside])


def test_the_least_along_a_diagonal_uncompiled_is_what_the_kernel_gives() -> None:
    heights = np.random.default_rng(2).random((11, 8)).astype(np.float32)
    for east in (1, -1):
        compiled, plain = np.empty_like(heights), np.empty_like(heights)
        openings._least_along_kernel(heights, 2, east, compiled)
        openings._least_along_kernel.py_func(heights, 2, east, plain)
        np.testing.assert_array_equal(compiled, plain)
        line = heights[[4, 5, 6, 7, 8], np.array([2, 3, 4, 5, 6])[::east]]
        assert compiled[6, 4] == line.min()


def test_the_height_at_a_place_is_bilinear_and_goes_on_beyond_the_last_centres() -> None:
    y, x = np.mgrid[:4, :5].astype(np.float32)
    surface = (2.0 * x + 3.0 * y).astype(np.float32)
    grid = cells.CellGrid(np.array([10.0, 20.0, 100.0]), 1.0, 4, 5)
    positions = np.array([[10.5, 20.5], [12.0, 21.25], [10.1, 20.1], [9.0, 20.0]])
    expected = [100.0, 100 + 2 * 1.5 + 3 * 0.75, 100 - 0.8 - 1.2, np.nan]
    np.testing.assert_allclose(band.heights_at(positions, grid, surface), expected, rtol=1e-6)


def test_a_column_ends_where_four_tenths_of_a_metre_are_empty() -> None:
    bins = np.array([[0b1011, 0b100001, 0, 1 << 10]], np.uint64)
    tops = walls.column_tops(bins)
    np.testing.assert_allclose(tops, [[0.4, 0.1, 0.0, 0.0]], rtol=1e-6)


def test_points_strewn_over_all_integers_stretch_no_cells_and_a_second_place_stays() -> None:
    random = np.random.default_rng(3)
    street = random.uniform(0, [60.0, 40.0, 3.0], (50_000, 3))
    strewn = random.uniform(-2_147_483.0, 2_147_483.0, (500, 3))
    other = random.uniform(0, [20.0, 20.0, 3.0], (500, 3)) + np.array([5000.0, 0.0, 0.0])
    alone = cells.choose_cells(lambda: [np.concatenate([street, strewn])])
    assert alone.rows * alone.size_m < 2_000
    assert alone.columns * alone.size_m < 2_000
    both = cells.choose_cells(lambda: [np.concatenate([street, other])])
    assert both.origin[0] + both.columns * both.size_m > 5_019.0
