"""Cells of a plan, and the points about places of several groups."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from processing.core.monitor import SilentMonitor
from processing.methods.road.objects import column_points
from processing.methods.road.objects.column_points import points_about, points_about_each
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, cell_of, touch_kernel
from processing.methods.road.objects.survey import survey_ground
from processing.recording.drive import Drive
from tests.processing.methods.road.bad_recordings import (
    DrivenRecording,
    facing_along,
    recorded,
    road_along,
    straight,
)

SIZE_M = CELL_M * TILE
LENGTH_M, REACH_M = 12.0, 1.0


@given(place=st.floats(0.0, 1e5))
@example(place=float(np.nextafter(3 * SIZE_M, 0.0)))
@example(place=3 * SIZE_M)
@example(place=float(np.nextafter(7809 * SIZE_M, 0.0)))
def test_a_place_is_in_the_tile_that_floor_division_tells(place: float) -> None:
    tile = int(place // SIZE_M)
    table = np.full((tile + 2, 1), -1, np.int32)
    table[tile, 0] = 0
    touched = np.zeros(table.shape, np.bool_)
    touch_kernel(np.array([[place, 0.0, 0.0]]), touched)
    assert np.flatnonzero(touched).tolist() == [tile]
    assert 0 <= cell_of(place, 0.0, table, TILE) < TILE * TILE


@pytest.mark.parametrize("place", [-1e-9, -SIZE_M, np.nan, np.inf])
def test_a_place_beside_the_plan_is_in_no_cell(place: float) -> None:
    assert cell_of(place, 0.0, np.zeros((2, 2), np.int32), TILE) == -1


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    """A short bare road."""
    folder: Path = tmp_path_factory.mktemp("road")
    way = straight(LENGTH_M)
    return recorded(folder, DrivenRecording(way, facing_along(way), (road_along(LENGTH_M),)))


def test_points_about_several_groups_are_those_about_each(drives: tuple[Drive, ...]) -> None:
    plan, monitor = survey_ground(drives, SilentMonitor()).plan, SilentMonitor()
    xyz = drives[0].xyz(slice(0, drives[0].count)) - plan.origin
    one = xyz[[0, len(xyz) // 2], :2] + (0.1, 0.0)
    other = xyz[[len(xyz) // 2, -1], :2] - (0.1, 0.0)
    both = points_about_each(drives, plan, (one, np.empty((0, 2)), other), REACH_M, monitor)
    apart = [points_about(drives, plan, some, REACH_M, monitor) for some in (one, other)]
    assert both.starts.size == 5
    np.testing.assert_array_equal(both.local, np.concatenate([some.local for some in apart]))
    np.testing.assert_array_equal(both.points, np.concatenate([some.points for some in apart]))
    middles = np.concatenate([one, other])
    for column in range(4):
        part = both.of(column)
        assert part.stop > part.start
        assert (np.diff(both.points[part]) > 0).all()
        away = np.hypot(*(both.local[part, :2] - middles[column]).T)
        assert away.max() <= REACH_M
        np.testing.assert_allclose(xyz[both.points[part]], both.local[part], atol=1e-9)


def test_about_no_place_are_no_points(drives: tuple[Drive, ...]) -> None:
    plan = survey_ground(drives, SilentMonitor()).plan
    none = points_about(drives, plan, np.empty((0, 2)), REACH_M, SilentMonitor())
    assert none.starts.tolist() == [0]
    assert len(none.local) == len(none.points) == 0


def test_points_of_a_large_survey_lie_in_a_file_without_a_name(
    drives: tuple[Drive, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, monitor = survey_ground(drives, SilentMonitor()).plan, SilentMonitor()
    xyz = drives[0].xyz(slice(0, drives[0].count)) - plan.origin
    groups = xyz[[0, len(xyz) // 2], :2].copy(), xyz[[-1], :2].copy()
    held = points_about_each(drives, plan, groups, REACH_M, monitor)
    monkeypatch.setattr(column_points, "_MOST_IN_MEMORY", 0)
    before = sorted(drives[0].folder.iterdir())
    filed = points_about_each(drives, plan, groups, REACH_M, monitor)
    assert isinstance(filed.local.base, np.memmap)
    assert sorted(drives[0].folder.iterdir()) == before
    for name in ("starts", "local", "drives", "points"):
        np.testing.assert_array_equal(getattr(filed, name), getattr(held, name))
