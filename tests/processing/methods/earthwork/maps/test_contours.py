"""Contours of known ground, and lines of change."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import Cancelled, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.contours import (
    ContourOptions,
    change_lines,
    choose_interval,
    contour_lines,
)
from processing.methods.ground.filters.cells import CellGrid

QUIET = SilentMonitor()
GRID = CellGrid(np.array([-36_000.0, -12_000.0, 41.3]), 0.25, rows=80, columns=120)


def middles() -> tuple[np.ndarray, np.ndarray]:
    row, column = np.mgrid[: GRID.rows, : GRID.columns]
    return (column + 0.5) * GRID.size_m, (row + 0.5) * GRID.size_m


def test_contours_of_a_plane_are_straight_and_where_the_plane_has_that_height() -> None:
    east, north = middles()
    heights = (0.2 * east + 0.1 * north).astype(np.float32)
    lines = contour_lines(GRID, heights, ContourOptions(0.5), QUIET)
    assert [line.level_m for line in lines] == pytest.approx(np.arange(41.5, 49.1, 0.5))
    for line in lines:
        local = line.xyz - GRID.origin
        assert np.allclose(0.2 * local[:, 0] + 0.1 * local[:, 1], local[:, 2], atol=1e-5)
        assert (line.xyz[:, 2] == line.level_m).all()
        assert not line.is_closed
    bold = [line.level_m for line in lines if line.is_index]
    assert bold == [42.5, 45.0, 47.5]


def test_contours_of_a_cone_are_circles() -> None:
    east, north = middles()
    heights = (8.0 - np.hypot(east - 15.0, north - 10.0)).astype(np.float32)
    lines = contour_lines(GRID, heights, ContourOptions(1.0), QUIET)
    closed = [line for line in lines if line.is_closed]
    assert closed
    for line in closed:
        radius = np.hypot(*(line.xyz[:, :2] - GRID.origin[:2] - [15.0, 10.0]).T)
        assert np.allclose(radius, 8.0 - (line.level_m - 41.3), atol=0.05)


def test_lines_end_at_ground_that_is_not_there() -> None:
    _, north = middles()
    heights = (0.2 * north).astype(np.float32)
    heights[:, 40:60] = np.nan
    lines = contour_lines(GRID, heights, ContourOptions(1.0), QUIET)
    assert len(lines) == 2 * 4
    for line in lines:
        local = line.xyz[:, 0] - GRID.origin[0]
        assert (local <= 10.0).all() or (local >= 15.0).all()


def test_simplified_lines_stay_near_and_short_ones_are_left_out() -> None:
    east, north = middles()
    heights = (8.0 - np.hypot(east - 15.0, north - 10.0)).astype(np.float32)
    whole = contour_lines(GRID, heights, ContourOptions(1.0), QUIET)
    simple = contour_lines(GRID, heights, ContourOptions(1.0, simplify_m=0.05), QUIET)
    assert sum(len(line.xyz) for line in simple) < sum(len(line.xyz) for line in whole) / 3
    for line in simple:
        radius = np.hypot(*(line.xyz[:, :2] - GRID.origin[:2] - [15.0, 10.0]).T)
        assert np.allclose(radius, 8.0 - (line.level_m - 41.3), atol=0.1)
    long = contour_lines(GRID, heights, ContourOptions(1.0, shortest_m=20.0), QUIET)
    assert 0 < len(long) < len(whole)
    assert contour_lines(GRID, heights, ContourOptions(1.0, shortest_m=1e4), QUIET) == ()
    coarse = contour_lines(GRID, heights, ContourOptions(1.0, simplify_m=50.0), QUIET)
    assert not any(line.is_closed for line in coarse)


def test_lines_of_change_have_no_zero_and_stay_within_the_boundary() -> None:
    east, north = middles()
    before = np.zeros(east.shape, np.float32)
    after = (0.1 * (east - 15.0)).astype(np.float32)
    inside = (north < 10.0).astype(np.float32)
    change = ChangeGrid(GRID, before, after, np.ones(east.shape, bool), inside)
    lines = change_lines(change, ContourOptions(0.25), QUIET)
    assert [line.level_m for line in lines] == pytest.approx(
        [-1.25, -1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0, 1.25]
    )
    for line in lines:
        local = line.xyz - GRID.origin
        assert np.allclose(local[:, 0], 15.0 + 10.0 * line.level_m, atol=1e-4)
        assert (local[:, 1] <= 10.0).all()


@pytest.mark.parametrize(
    ("high", "expected"),
    [
        (0.0, 0.01),
        (0.3, 0.01),
        (0.41, 0.02),
        (1.0, 0.05),
        (4.0, 0.1),
        (7.9, 0.2),
        (19.0, 0.5),
        (40.0, 1.0),
        (41.0, 2.0),
        (900.0, 50.0),
    ],
)
def test_the_interval_goes_in_steps_of_one_two_and_five(high: float, expected: float) -> None:
    assert choose_interval(0.0, high) == expected
    assert high / expected <= 40.0 + 1e-9


@pytest.mark.parametrize("interval", [0.0, -1.0, np.nan, np.inf])
def test_an_interval_that_is_none_is_refused(interval: float) -> None:
    with pytest.raises(OutOfRange, match="no positive length"):
        contour_lines(GRID, np.zeros((80, 120), np.float32), ContourOptions(interval), QUIET)


def test_too_many_levels_are_refused_with_an_interval_that_will_do() -> None:
    heights = np.linspace(0, 100, 9600, dtype=np.float32).reshape(80, 120)
    with pytest.raises(OutOfRange, match=r"Take 0\.1 m or more"):
        contour_lines(GRID, heights, ContourOptions(0.01), QUIET)
    assert contour_lines(GRID, heights, ContourOptions(1.0), QUIET)


def test_no_ground_and_a_grid_of_one_row_give_no_line() -> None:
    nothing = np.full((80, 120), np.nan, np.float32)
    assert contour_lines(GRID, nothing, ContourOptions(0.5), QUIET) == ()
    row = CellGrid(GRID.origin, 0.25, rows=1, columns=5)
    assert (
        contour_lines(row, np.arange(5, dtype=np.float32)[None], ContourOptions(0.5), QUIET) == ()
    )


def test_the_work_stops_when_it_is_asked_to() -> None:
    class Impatient(SilentMonitor):
        def check(self) -> None:
            raise Cancelled

    east, _ = middles()
    with pytest.raises(Cancelled):
        contour_lines(GRID, east.astype(np.float32), ContourOptions(0.5), Impatient())
