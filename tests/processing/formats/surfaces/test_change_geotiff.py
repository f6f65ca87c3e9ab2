"""A map of change as GDAL reads it: place, reference system, numbers and “no data”."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasterio

from processing.core.errors import Cancelled, InUse
from processing.formats.surfaces.change_geotiff import CHANGE_BANDS, write_change_geotiff
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.ground.filters.cells import CellGrid
from tests.monitors import CancelledAfter

WEST, SOUTH, LOWEST, CELL = -12_000.25, -35_000.5, 101.125, 0.5
ROWS, COLUMNS = 300, 270


def change_grid() -> ChangeGrid:
    """A ramp to the north-east that is raised by 25 cm; a corner lies outside, a cell is a hole."""
    north, east = np.mgrid[:ROWS, :COLUMNS].astype(np.float32)
    before = 0.01 * north + 0.001 * east
    after = before + np.float32(0.25)
    after[50, 60] = np.nan
    inside = np.ones((ROWS, COLUMNS), np.float32)
    inside[:20, :30] = 0.0
    is_measured = np.ones((ROWS, COLUMNS), np.bool_)
    is_measured[100:110, 5:8] = False
    grid = CellGrid(np.array([WEST, SOUTH, LOWEST]), CELL, ROWS, COLUMNS)
    return ChangeGrid(grid, before, after, is_measured, inside)


def opened(path: Path, crs: str = "EPSG:6677") -> Any:
    write_change_geotiff(path, change_grid(), crs=crs)
    return rasterio.open(path)


def test_place_system_and_bands_are_told(tmp_path: Path) -> None:
    with opened(tmp_path / "c.tif") as read:
        assert (read.height, read.width, read.count) == (ROWS, COLUMNS, 4)
        assert read.crs.to_epsg() == 6677
        assert tuple(read.transform)[:6] == (CELL, 0.0, WEST, 0.0, -CELL, SOUTH + ROWS * CELL)
        assert tuple(read.bounds) == (WEST, SOUTH, WEST + COLUMNS * CELL, SOUTH + ROWS * CELL)
        assert read.descriptions == CHANGE_BANDS
        assert read.dtypes == ("float32",) * 4
        assert np.isnan(read.nodata)


def test_values_lie_at_their_places(tmp_path: Path) -> None:
    change = change_grid()
    with opened(tmp_path / "c.tif") as read:
        bands = read.read()[:, ::-1]
        np.testing.assert_array_equal(bands[0], change.change_m)
        np.testing.assert_allclose(bands[1], change.before + LOWEST, atol=1e-5)
        np.testing.assert_allclose(bands[2], change.after + LOWEST, atol=1e-5)
        # The place's own cell, asked for by coordinates.
        east, north = WEST + 40.2 * CELL, SOUTH + 200.7 * CELL
        (found,) = read.sample([(east, north)])
        assert found == pytest.approx([0.25, LOWEST + 2.04, LOWEST + 2.29, 1.0], abs=1e-4)


def test_what_is_outside_filled_or_missing_can_be_told(tmp_path: Path) -> None:
    change = change_grid()
    with opened(tmp_path / "c.tif") as read:
        difference, before, after, measured = read.read()[:, ::-1]
    assert np.isnan(difference[:20, :30]).all()
    assert np.isnan(measured[:20, :30]).all()
    assert np.isfinite(before).all()
    assert np.isnan(after[50, 60])
    expected = np.where(np.isnan(change.change_m), np.nan, change.is_measured)
    assert np.isnan(measured[50, 60])
    np.testing.assert_array_equal(measured, expected)


def test_an_unknown_system_is_not_made_up(tmp_path: Path) -> None:
    with opened(tmp_path / "c.tif", crs="") as read:
        assert read.crs is None or not read.crs.to_epsg()
        assert read.transform.c == WEST


def test_a_cancel_leaves_nothing_and_inputs_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "c.tif"
    with pytest.raises(Cancelled):
        write_change_geotiff(path, change_grid(), crs="", monitor=CancelledAfter())
    assert not list(tmp_path.iterdir())
    path.touch()
    with pytest.raises(InUse):
        write_change_geotiff(path, change_grid(), crs="", never=[path])
