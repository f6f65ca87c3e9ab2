"""Areas of one class cover exactly its cells: counted by area, told by any place inside."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.class_areas import class_areas
from processing.methods.earthwork.maps.heat_map import change_classes, class_numbers
from processing.methods.ground.filters.cells import CellGrid

CLASSES = change_classes(1.0)
ORIGIN = np.array([-12_000.25, -35_000.5, 100.0])


def change_of(values: np.ndarray, *, size_m: float = 0.5) -> ChangeGrid:
    after = values.astype(np.float32)
    grid = CellGrid(ORIGIN, size_m, *after.shape)
    whole = np.ones(after.shape)
    return ChangeGrid(
        grid, 0 * whole.astype(np.float32), after, whole > 0, whole.astype(np.float32)
    )


@given(
    st_numpy.arrays(
        np.float64,
        st_numpy.array_shapes(min_dims=2, max_dims=2, max_side=9),
        elements=st.sampled_from([-2.0, 0.0, 0.3, np.nan]),
    )
)
def test_every_cell_lies_in_an_area_of_its_class_and_in_no_other(values: np.ndarray) -> None:
    change = change_of(values)
    found = class_areas(change, CLASSES)
    numbers = class_numbers(change.change_m, CLASSES)
    rows, columns = np.indices(values.shape)
    middles = shapely.points(ORIGIN[0] + (columns + 0.5) * 0.5, ORIGIN[1] + (rows + 0.5) * 0.5)
    assert set(found.of_class) == set(np.unique(numbers).tolist()) - {255}
    for number, areas in found.of_class.items():
        held = np.array([shapely.contains(area, middles) for area in areas]).sum(axis=0)
        np.testing.assert_array_equal(held, numbers == number)
        assert all(area.is_valid for area in areas)
        total = sum(area.area for area in areas)
        assert total == pytest.approx(0.25 * np.count_nonzero(numbers == number))


def test_straight_sides_have_no_corners_between() -> None:
    values = np.zeros((40, 30))
    values[10:20, 5:25] = 2.0
    found = class_areas(change_of(values), CLASSES)
    (raised,) = found.of_class[8]
    (around,) = found.of_class[4]
    assert len(raised.exterior.coords) == 5
    assert [len(one.coords) for one in (around.exterior, *around.interiors)] == [5, 5]
    assert raised.bounds == (ORIGIN[0] + 2.5, ORIGIN[1] + 5, ORIGIN[0] + 12.5, ORIGIN[1] + 10)


def test_unmeasured_ground_is_an_area_of_its_own_where_there_is_a_change() -> None:
    change = change_of(np.where(np.arange(12).reshape(3, 4) == 0, np.nan, 1.5))
    change.is_measured[0, :2] = False
    (area,) = class_areas(change, CLASSES).unmeasured
    assert area.bounds == (ORIGIN[0] + 0.5, ORIGIN[1], ORIGIN[0] + 1.0, ORIGIN[1] + 0.5)


def test_a_large_map_is_thinned_to_means() -> None:
    values = np.full((60, 60), 0.3)
    values[::2] += 0.2
    values[1::2] -= 0.2
    values[:, 50:] = np.nan
    found = class_areas(change_of(values), CLASSES, most_cells=900)
    assert found.cell_m == 1.0
    ((area,),) = found.of_class.values()
    assert area.area == pytest.approx(60 * 50 * 0.25)


def test_a_map_without_change_has_no_areas() -> None:
    found = class_areas(change_of(np.full((3, 4), np.nan)), CLASSES)
    assert (found.of_class, found.unmeasured) == ({}, [])
