"""Top-view cells: north up, about one point in a filled cell, every point in one cell."""

import numpy as np
import pytest

from processing.recording.without_revolutions.top_view import TopView, top_view_of

RANDOM = np.random.default_rng(3)


def _view_of(xyz):
    return top_view_of(xyz, len(xyz), xyz.min(axis=0), xyz.max(axis=0))


def test_cells_run_from_the_north_west_row_by_row():
    view = TopView(west=100.0, north=50.0, cell_m=1.0, cells_per_row=10, rows=10)
    xyz = np.array([[100.5, 49.5, 0], [101.5, 49.5, 0], [100.5, 48.5, 0]])
    assert view.cells_of(xyz).tolist() == [0, 1, 10]


def test_points_outside_are_in_the_cells_at_the_edge():
    view = TopView(west=100.0, north=50.0, cell_m=1.0, cells_per_row=10, rows=10)
    xyz = np.array([[0.0, 1e6, 0], [1e6, 0.0, 0]])
    assert view.cells_of(xyz).tolist() == [0, 99]


@pytest.mark.parametrize("extent", [(80.0, 40.0), (2_000.0, 3.0), (1.0, 1.0)])
def test_about_one_point_falls_in_a_filled_cell(extent):
    xyz = RANDOM.uniform([0, 0, 0], [*extent, 5.0], (40_000, 3))
    filled = np.unique(_view_of(xyz).cells_of(xyz)).size
    assert 1.0 <= len(xyz) / filled < 2.5


def test_a_few_stray_points_far_away_leave_the_cells_fine():
    xyz = RANDOM.uniform([500_000, 4_000_000, 0], [500_080, 4_000_040, 5.0], (40_000, 3))
    xyz[:12] = 0.0
    view = _view_of(xyz)
    assert view.cell_m < 0.6
    filled = np.unique(view.cells_of(xyz[12:])).size
    assert 1.0 <= len(xyz) / filled < 2.5


def test_cells_of_a_strip_across_a_million_metres_follow_its_points_not_its_box():
    along = RANDOM.uniform(0, 1e6, 200_000)
    across = RANDOM.uniform(0, 50, 200_000)
    view = _view_of(np.column_stack([along, 0.3 * along + across, np.zeros(200_000)]))
    assert 10.0 < view.cell_m < 40.0  # a point has 250 m² in the strip, 1.5 million in the box
    assert view.cells_per_row * view.rows <= 1.01e10


def test_a_dense_patch_in_a_thin_strip_takes_cells_between_their_spacings():
    strip = RANDOM.uniform([0, 0, 0], [1_000.0, 200.0, 1.0], (50_000, 3))
    patch = RANDOM.uniform([400, 80, 0], [440.0, 120.0, 1.0], (150_000, 3))
    view = _view_of(np.concatenate([strip, patch]))
    assert 0.1 < view.cell_m < 2.0


def test_a_single_point_and_a_vertical_line_have_a_cell():
    one = np.array([[5.0, 5.0, 5.0]])
    assert _view_of(one).cells_of(one).tolist() == [0]
    line = np.column_stack([np.full(9, 5.0), np.full(9, 5.0), np.arange(9.0)])
    assert not _view_of(line).cells_of(line).any()


def test_a_wall_is_a_row_of_cells():
    wall = RANDOM.uniform([0, 0, 0], [10.0, 0.0, 3.0], (30_000, 3))
    view = _view_of(wall)
    assert view.rows <= 2
    assert np.unique(view.cells_of(wall)).size > 1_000
