"""The loops against plain numpy, uncompiled too."""

from __future__ import annotations

import numpy as np

from processing.ground import band, cells, morphology, walls


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
    opened = morphology.opened(peak, 3)
    np.testing.assert_allclose(opened[5:25, 5:25], surface[5:25, 5:25])


def test_a_filled_hole_is_between_its_borders_and_known_cells_stay() -> None:
    heights = np.tile(np.arange(16, dtype=np.float32), (16, 1))
    known = np.ones((16, 16), np.bool_)
    known[5:11, 5:11] = False
    filled = morphology.filled(heights, known)
    np.testing.assert_array_equal(filled[known], heights[known])
    np.testing.assert_allclose(filled, heights, atol=0.05)


def test_relaxing_uncompiled_gives_what_the_kernel_gives() -> None:
    rng = np.random.default_rng(1)
    known = rng.random((9, 7)) < 0.5
    compiled = rng.random((9, 7)).astype(np.float32)
    plain = compiled.copy()
    there, back = morphology._near_known(known)
    assert sorted(there) == sorted(back) == np.flatnonzero(~known).tolist()
    morphology._relax_kernel(there, back, 3, compiled)
    morphology._relax_kernel.py_func(there, back, 3, plain)
    np.testing.assert_allclose(compiled, plain, rtol=1e-6)


def test_the_height_at_a_place_is_bilinear_and_goes_on_beyond_the_last_centres() -> None:
    y, x = np.mgrid[:4, :5].astype(np.float32)
    surface = (2.0 * x + 3.0 * y).astype(np.float32)
    grid = cells.CellGrid(np.array([10.0, 20.0, 100.0]), 1.0, 4, 5)
    places = np.array([[10.5, 20.5], [12.0, 21.25], [10.1, 20.1], [9.0, 20.0]])
    expected = [100.0, 100 + 2 * 1.5 + 3 * 0.75, 100 - 0.8 - 1.2, np.nan]
    np.testing.assert_allclose(band.heights_at(places, grid, surface), expected, rtol=1e-6)


def test_a_column_ends_where_four_tenths_of_a_metre_are_empty() -> None:
    bins = np.array([[0b1011, 0b100001, 0, 1 << 10]], np.uint64)
    tops = walls.column_tops(bins)
    np.testing.assert_allclose(tops, [[0.4, 0.1, 0.0, 0.0]], rtol=1e-6)
