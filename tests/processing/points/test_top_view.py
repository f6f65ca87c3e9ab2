"""Top-view cells: north up, about one point in a filled cell, every point in one cell."""

import numpy as np

from processing.points.top_view import TopView, top_view_of


def test_cells_run_from_the_north_west_row_by_row():
    view = TopView(west=100.0, north=50.0, cell_m=1.0, cells_per_row=10)
    xyz = np.array([[100.5, 49.5, 0], [101.5, 49.5, 0], [100.5, 48.5, 0]])
    assert view.cells_of(xyz).tolist() == [0, 1, 10]


def test_about_one_point_falls_in_a_filled_cell():
    random = np.random.default_rng(3)
    xyz = random.uniform([0, 0, 0], [80.0, 40.0, 5.0], (40_000, 3))
    view = top_view_of(xyz, len(xyz), xyz.min(axis=0), xyz.max(axis=0))
    filled = np.unique(view.cells_of(xyz)).size
    assert 1.0 <= len(xyz) / filled < 2.5


def test_a_single_point_and_a_vertical_line_have_a_cell():
    one = np.array([[5.0, 5.0, 5.0]])
    view = top_view_of(one, 1, one[0], one[0])
    assert view.cells_of(one).tolist() == [0]
    line = np.column_stack([np.full(9, 5.0), np.full(9, 5.0), np.arange(9.0)])
    view = top_view_of(line, 9, line.min(axis=0), line.max(axis=0))
    assert (view.cells_of(line) >= 0).all()
