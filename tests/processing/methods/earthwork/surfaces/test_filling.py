from __future__ import annotations

import numpy as np

from processing.methods.earthwork.surfaces.filling import FARTHEST_M, measured_extent

CELL_M = 0.5


def test_what_lies_between_points_is_within_and_what_lies_beyond_is_not() -> None:
    known = np.zeros((120, 200), np.bool_)
    known[:, 40:80] = known[:, 100:160] = True
    extent = measured_extent(known, CELL_M)

    # A gap of 10 m is bridged but near its open ends; 20 m beside the last points nothing is.
    assert extent[10:-10, 40:160].all()
    assert not extent[:, :39].any()
    assert not extent[:, 161:].any()


def test_ground_that_points_surround_is_within_however_wide_it_is() -> None:
    known = np.zeros((160, 160), np.bool_)
    known[10:150, 10:150] = True
    wide = round(3 * FARTHEST_M / CELL_M)
    known[50 : 50 + wide, 50 : 50 + wide] = False

    assert measured_extent(known, CELL_M)[10:150, 10:150].all()


def test_without_points_nothing_is_within() -> None:
    assert not measured_extent(np.zeros((5, 5), np.bool_), CELL_M).any()
