"""How sure a volume is: what filled ground adds, by its spread, its width and the site's length."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.volumes.uncertainty import volume_spread
from processing.methods.ground.filters.cells import CellGrid

CELL_M = 0.5
SPREAD_M = 0.1
Mask = NDArray[np.bool_]


def holes_m3(is_hole: Mask) -> float:
    """What ground adds that was filled in with the same spread everywhere."""
    flat = np.zeros(is_hole.shape, np.float32)
    grid = CellGrid(np.zeros(3), CELL_M, *is_hole.shape)
    change = ChangeGrid(grid, flat, flat, ~is_hole, np.ones(is_hole.shape, np.float32))
    spread = np.where(is_hole, SPREAD_M, 0.0)
    return volume_spread(change, ~is_hole, spread, None, 2).holes_m3


def strip(*, wide_m: float, long_m: float, site_m: float) -> Mask:
    """A strip of hidden ground in the middle of a square site."""
    middles = (np.arange(round(site_m / CELL_M)) + 0.5) * CELL_M - site_m / 2
    is_near = np.abs(middles) < wide_m / 2
    return is_near[:, None] & (np.abs(middles) < long_m / 2)[None, :]


def test_one_hole_is_no_less_sure_than_if_all_of_it_erred_to_one_side() -> None:
    hole = strip(wide_m=4.0, long_m=4.0, site_m=80.0)

    assert holes_m3(hole) == pytest.approx(SPREAD_M * 16.0)


def test_a_strip_along_all_of_a_site_errs_nearly_as_one() -> None:
    hole = strip(wide_m=6.0, long_m=60.0, site_m=60.0)
    to_one_side = SPREAD_M * 360.0

    assert 0.4 * to_one_side < holes_m3(hole) < to_one_side


def test_many_holes_err_less_together_than_one_hole_of_their_area() -> None:
    rows, columns = np.mgrid[:120, :120]
    many = (rows % 12 < 3) & (columns % 12 < 3)
    one = strip(wide_m=15.0, long_m=15.0, site_m=60.0)

    assert many.sum() == one.sum()
    assert holes_m3(many) < 0.6 * holes_m3(one)


def test_measured_ground_adds_nothing() -> None:
    assert holes_m3(np.zeros((20, 20), np.bool_)) == 0.0
