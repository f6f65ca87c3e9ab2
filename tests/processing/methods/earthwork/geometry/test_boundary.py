"""Boundaries: what is refused and where, holes and parts, and exact shares of cells."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import OutOfRange, Unsuitable
from processing.methods.earthwork.geometry import boundary
from processing.methods.earthwork.geometry.boundary import boundary_polygon, inside_shares
from processing.methods.ground.filters.cells import CellGrid

CORNER = np.array([-12_000.0, -36_000.0])
SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])


def star(corners: int, seed: int, radius_m: float = 20.0) -> np.ndarray:
    random = np.random.default_rng(seed)
    ways = np.linspace(0.0, 2 * np.pi, corners, endpoint=False)
    reach = radius_m * random.uniform(0.4, 1.0, corners)
    return np.column_stack([np.cos(ways), np.sin(ways)]) * reach[:, None]


def shares_by_shapely(polygon: shapely.Geometry, grid: CellGrid) -> np.ndarray:
    row, column = np.mgrid[: grid.rows, : grid.columns]
    low = np.stack([column, row], axis=-1) * grid.size_m + grid.origin[:2]
    cells = shapely.box(
        low[..., 0], low[..., 1], low[..., 0] + grid.size_m, low[..., 1] + grid.size_m
    )
    return shapely.area(shapely.intersection(cells, polygon)) / grid.size_m**2


def test_a_ring_may_be_closed_or_not_and_go_either_way_round() -> None:
    closed = np.concatenate([SQUARE, SQUARE[:1]])
    for ring in (SQUARE, closed, SQUARE[::-1], closed[::-1]):
        polygon = boundary_polygon([ring + CORNER])
        assert polygon.area == pytest.approx(100.0, rel=1e-9)
        assert polygon.exterior.is_ccw


def test_heights_of_a_ring_are_passed_over() -> None:
    ring = np.column_stack([SQUARE, np.arange(4.0)])
    assert boundary_polygon([ring]).equals(boundary_polygon([SQUARE]))


def test_a_ring_within_a_ring_is_a_hole_and_one_apart_is_another_part() -> None:
    with_hole = boundary_polygon([SQUARE * 0.2 + 4.0, SQUARE])
    assert with_hole.area == pytest.approx(96.0)
    island = boundary_polygon([SQUARE, SQUARE * 0.6 + 2.0, SQUARE * 0.2 + 4.0])
    assert island.area == pytest.approx(100.0 - 36.0 + 4.0)
    apart = boundary_polygon([SQUARE, SQUARE + 20.0])
    assert len(apart.geoms) == 2


def test_a_boundary_that_crosses_itself_is_refused_with_the_place() -> None:
    bow = SQUARE[[0, 2, 1, 3]] + CORNER
    with pytest.raises(Unsuitable, match=r"easting -11995\.000, northing -35995\.000"):
        boundary_polygon([bow])


def test_a_spike_and_a_touching_corner_are_refused() -> None:
    spike = np.array([[0, 0], [10, 0], [10, 10], [10, 15], [10, 10], [0, 10.0]])
    touching = np.array([[0, 0], [10, 0], [10, 10], [5, 0], [0, 10.0]])
    for ring in (spike, touching):
        with pytest.raises(Unsuitable, match="crosses or touches itself"):
            boundary_polygon([ring])


def test_outlines_that_cross_each_other_are_refused() -> None:
    with pytest.raises(Unsuitable, match="Two outlines"):
        boundary_polygon([SQUARE, SQUARE + 5.0])


@pytest.mark.parametrize(
    ("ring", "says"),
    [
        (np.empty((0, 2)), "has 0"),
        (SQUARE[:2], "has 2"),
        (np.repeat(SQUARE[:2], 3, axis=0), "has 2"),
        (np.array([[0, 0], [1, np.nan], [2, 2.0]]), "Corner 2"),
        (np.array([[0, 0], [np.inf, 1], [2, 2.0]]), "Corner 2"),
        (np.array([[0, 0], [5, 5], [9, 9.0]]), "crosses or touches itself|no area"),
    ],
)
def test_what_is_no_area_is_refused_in_a_sentence(ring: np.ndarray, says: str) -> None:
    with pytest.raises(Unsuitable, match=says):
        boundary_polygon([ring])
    with pytest.raises(Unsuitable, match="outline 2"):
        boundary_polygon([SQUARE - 50.0, ring])


def test_no_outline_at_all_is_refused() -> None:
    with pytest.raises(Unsuitable, match="no outline"):
        boundary_polygon([])


def test_a_boundary_beyond_the_ground_is_refused_and_swapped_axes_are_told() -> None:
    extent = (-12_010.0, -36_010.0, -11_900.0, -35_900.0)
    assert boundary_polygon([SQUARE + CORNER], extent).area == pytest.approx(100.0)
    with pytest.raises(OutOfRange, match="on the site"):
        boundary_polygon([SQUARE], extent)
    with pytest.raises(OutOfRange, match="swapped"):
        boundary_polygon([(SQUARE + CORNER)[:, ::-1]], extent)


def test_a_boundary_whose_box_alone_reaches_the_ground_is_refused() -> None:
    hook = np.array([[0, 0], [10, 0], [10, 10], [9, 10], [9, 1], [0, 1.0]])
    with pytest.raises(OutOfRange):
        boundary_polygon([hook], (1.0, 5.0, 3.0, 7.0))


@given(st.integers(3, 40), st.integers(0, 999), st.floats(0.3, 7.0), st.floats(-15.0, 15.0))
def test_shares_of_cells_are_those_of_the_intersection(
    corners: int, seed: int, size_m: float, shift_m: float
) -> None:
    ring = star(corners, seed) + CORNER
    hole = star(5, seed + 1, 2.0) + CORNER
    polygon = shapely.orient_polygons(shapely.Polygon(ring).difference(shapely.Polygon(hole)))
    origin = np.array([*(CORNER - 12.0 + shift_m), 3.0])
    grid = CellGrid(origin, size_m, rows=9, columns=13)
    expected = shares_by_shapely(polygon, grid)
    assert np.allclose(inside_shares(polygon, grid), expected, atol=1e-6)


def test_shares_are_exactly_none_and_all_away_from_the_sides() -> None:
    polygon = boundary_polygon([star(200, 4) + CORNER])
    grid = CellGrid(np.array([*(CORNER - 25.0), 0.0]), 0.1, 500, 500)
    shares = inside_shares(polygon, grid)
    near = shapely.buffer(polygon.boundary, 0.2)
    far = ~shapely.intersects_xy(
        near, *(np.moveaxis(np.mgrid[:500, :500][::-1], 0, 0) * 0.1 + CORNER[:, None, None] - 24.95)
    )
    assert set(np.unique(shares[far])) == {0.0, 1.0}
    assert shares.sum(dtype=np.float64) * 0.01 == pytest.approx(polygon.area, rel=1e-6)


def test_several_parts_add_up_and_sides_on_cell_edges_cut_nothing_off() -> None:
    polygon = boundary_polygon([SQUARE, SQUARE + np.array([20.0, 0.0])])
    shares = inside_shares(polygon, CellGrid(np.zeros(3), 2.5, 6, 12))
    expected = np.zeros((6, 12), np.float32)
    expected[:4, :4] = expected[:4, 8:] = 1.0
    assert np.array_equal(shares, expected)


def test_the_kernel_gives_the_same_without_being_compiled() -> None:
    ring = shapely.get_coordinates(shapely.Polygon(star(12, 7)).exterior)
    plain, compiled = np.zeros((9, 12)), np.zeros((9, 12))
    for way in (ring[::-1], ring + 30.0, ring / 3.0 + 5.0):
        boundary._add_ring_kernel.py_func(np.ascontiguousarray(way), plain)
        boundary._add_ring_kernel(np.ascontiguousarray(way), compiled)
    assert np.allclose(plain, compiled)
