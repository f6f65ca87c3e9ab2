from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.surfaces.joined_dates import JoinedDates, join_dates
from processing.methods.earthwork.surfaces.surfaces import SideHeights

Floats = NDArray[np.float64]
ROWS, COLUMNS = np.mgrid[:40, :60]
BUMPY: Floats = 0.4 * np.sin(COLUMNS / 2.0) + 0.3 * np.cos(ROWS / 3.0)
HOLE = np.hypot(ROWS - 20, COLUMNS - 30) < 10


def date(true: Floats, hidden: NDArray[np.bool_]) -> tuple[SideHeights, Floats]:
    """A date that didn't show some of its ground, filled in by a level surface, and its points."""
    filled = SideHeights(
        np.where(hidden, 0.0, true), ~hidden, np.where(hidden, 0.5, 0.0).astype(np.float64)
    )
    return filled, np.where(hidden, np.nan, true)


def joined(*dates: tuple[SideHeights, Floats]) -> JoinedDates:
    sides, counted = zip(*dates, strict=True)
    return join_dates(sides, counted, np.ones(BUMPY.shape, np.bool_), 0.5, SilentMonitor())


def test_a_date_takes_the_shape_that_another_shows() -> None:
    nothing = np.zeros_like(HOLE)
    before, after = date(BUMPY, nothing), date(BUMPY + 0.7, HOLE)
    found = joined(before, after)

    np.testing.assert_allclose(found.grounds[1].heights, BUMPY + 0.7, atol=0.06)
    np.testing.assert_array_equal(found.grounds[0].heights, BUMPY)
    assert 0 < found.change_spread[HOLE].max() < 0.2
    assert (found.change_spread[~HOLE] == 0).all()


def test_what_neither_shows_did_not_change_where_its_surroundings_did_not() -> None:
    lower = date(BUMPY, HOLE)
    higher = (
        SideHeights(
            lower[0].heights + np.where(HOLE, 0.8, 0.0), lower[0].is_measured, lower[0].spread
        ),
        lower[1],
    )
    found = joined(lower, higher)
    change = found.grounds[1].heights - found.grounds[0].heights

    # Each by itself would have been filled in 0.8 m apart.
    assert np.abs(change).max() < 0.01


def test_a_third_date_tells_the_shape_that_two_hide() -> None:
    two = date(BUMPY, HOLE), date(BUMPY + 1.0, HOLE)
    third = date(BUMPY + 0.3, np.zeros_like(HOLE))
    without, found = joined(*two), joined(*two, third)

    off_without, off = (
        float(np.abs(one.grounds[0].heights - BUMPY)[HOLE].max()) for one in (without, found)
    )
    assert off_without > 0.4
    assert off < 0.05
    assert found.grounds[1].heights[20, 30] == pytest.approx(BUMPY[20, 30] + 1.0, abs=0.1)
    assert found.change_spread.max() <= without.change_spread.max()
