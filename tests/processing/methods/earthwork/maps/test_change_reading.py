"""What a map of change says at a place and along a line, on slopes whose heights are known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.change_reading import change_along, reading_at
from processing.methods.ground.filters.cells import CellGrid

ORIGIN = np.array([-11_000.0, -35_000.0, 120.0])
SIZE_M = 0.5


def _sloping(rows: int = 8, columns: int = 10) -> ChangeGrid:
    """Before: 0.1 m up per metre east; after: 0.5 m above it, rising 0.2 m per metre north."""
    row, column = np.indices((rows, columns))
    east, north = (column + 0.5) * SIZE_M, (row + 0.5) * SIZE_M
    before = (0.1 * east).astype(np.float32)
    after = (0.1 * east + 0.5 + 0.2 * north).astype(np.float32)
    shape = (rows, columns)
    grid = CellGrid(ORIGIN, SIZE_M, rows, columns)
    return ChangeGrid(grid, before, after, np.ones(shape, np.bool_), np.ones(shape, np.float32))


def test_a_cell_tells_both_heights_and_their_difference() -> None:
    reading = reading_at(_sloping(), -11_000.0 + 1.3, -35_000.0 + 2.4)  # column 2, row 4
    assert reading is not None
    assert reading.before_m == pytest.approx(120.125, abs=1e-5)
    assert reading.after_m == pytest.approx(120.125 + 0.5 + 0.45, abs=1e-5)
    assert reading.change_m == pytest.approx(0.95, abs=1e-5)
    assert reading.is_measured


@pytest.mark.parametrize(("east", "north"), [(-0.01, 1), (5.01, 1), (1, -0.01), (1, 4.01)])
def test_beside_the_map_nothing_is_told(east: float, north: float) -> None:
    assert reading_at(_sloping(), ORIGIN[0] + east, ORIGIN[1] + north) is None


def test_outside_the_boundary_and_without_a_ground_nothing_is_told() -> None:
    change = _sloping()
    change.inside[0, 0] = 0.0
    change.after[1, 1] = np.nan
    change.is_measured[2, 2] = False
    middles = ORIGIN[:2] + (np.arange(3)[:, None] + 0.5) * SIZE_M
    assert reading_at(change, *middles[0].tolist()) is None
    assert reading_at(change, *middles[1].tolist()) is None
    filled = reading_at(change, *middles[2].tolist())
    assert filled is not None
    assert not filled.is_measured


def test_a_line_between_the_middles_of_cells_follows_the_slope() -> None:
    change = _sloping()
    offsets = np.linspace(0.3, 4.7, 45)
    xy = ORIGIN[:2] + np.column_stack([offsets, np.full(45, 1.9)])
    line = change_along(change, offsets, xy)
    np.testing.assert_allclose(line.before, 120.0 + 0.1 * offsets, atol=1e-5)
    np.testing.assert_allclose(line.after, 120.5 + 0.1 * offsets + 0.2 * 1.9, atol=1e-5)
    assert line.is_measured.all()


def test_a_line_ends_where_the_map_ends_and_at_the_boundary() -> None:
    change = _sloping()
    change.inside[:, 4:6] = 0.0
    change.is_measured[:, :2] = False
    offsets = np.arange(-1.0, 6.0, 0.25) + 0.1
    xy = ORIGIN[:2] + np.column_stack([offsets, np.full(len(offsets), 1.0)])
    line = change_along(change, offsets, xy)
    is_in = (offsets > 0) & (offsets < 5) & ~((offsets >= 2) & (offsets < 3))
    np.testing.assert_array_equal(np.isfinite(line.before), is_in)
    np.testing.assert_array_equal(np.isfinite(line.after), is_in)
    np.testing.assert_array_equal(line.is_measured, is_in & (offsets >= 1))


def test_beside_a_cell_without_ground_the_own_cell_counts() -> None:
    change = _sloping()
    change.before[:, 3] = np.nan
    xy = ORIGIN[:2] + np.array([[1.4, 1.0], [1.6, 1.0]])
    line = change_along(change, np.array([0.0, 0.2]), xy)
    np.testing.assert_allclose(line.before, [120.125, np.nan], atol=1e-5)
