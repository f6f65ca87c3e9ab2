"""Heights on given triangles: everywhere between them one, nowhere else any."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from processing.methods.earthwork.geometry import plan_buckets, triangle_surface
from processing.methods.earthwork.geometry.plan_buckets import sort_into_buckets
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from tests.processing.methods.earthwork.bodies import SURVEYED, scattered_surface, surface_of


def test_heights_on_a_plane_are_those_of_the_plane_and_nan_outside() -> None:
    plane = scattered_surface(400, seed=1, height=lambda x, y: 0.3 * x - 0.2 * y + 5.0)
    positions = np.random.default_rng(2).uniform(-5.0, 25.0, (5000, 2)) + SURVEYED[:2]
    heights = plane.heights_at(positions)
    inside = np.all((positions >= SURVEYED[:2]) & (positions <= SURVEYED[:2] + 20.0), axis=1)
    local = positions - SURVEYED[:2]
    expected = 0.3 * local[:, 0] - 0.2 * local[:, 1] + 5.0 + SURVEYED[2]
    assert np.array_equal(np.isfinite(heights), inside)
    assert np.allclose(heights[inside], expected[inside], atol=1e-9)


@given(st.integers(0, 10_000), st.integers(3, 60))
def test_each_place_on_an_edge_or_a_corner_has_a_height(seed: int, count: int) -> None:
    surface = scattered_surface(count, seed=seed, height=lambda x, y: np.sin(x) + 0.1 * y)
    assert np.allclose(surface.heights_at(surface.xyz[:, :2]), surface.xyz[:, 2], rtol=0, atol=1e-7)
    one = surface.xyz[surface.corners[:, [0, 1, 2]].ravel()]
    other = surface.xyz[surface.corners[:, [1, 2, 0]].ravel()]
    share = np.random.default_rng(seed).uniform(0, 1, (len(one), 1))
    assert np.isfinite(surface.heights_at((one + share * (other - one))[:, :2])).all()


def test_of_two_triangles_at_an_edge_the_first_has_the_place() -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 9], [1, 1, 9.0]])
    step = TriangleSurface(corners, np.array([[0, 1, 2], [4, 5, 3]]))
    turned = TriangleSurface(corners, np.array([[4, 5, 3], [0, 1, 2]]))
    on_edge = np.array([[0.5, 0.5]])
    assert step.heights_at(on_edge) == [0.0]
    assert turned.heights_at(on_edge) == [9.0]


def test_the_sense_of_the_corners_changes_nothing() -> None:
    surface = scattered_surface(50, seed=3, height=lambda x, y: x * y)
    turned = TriangleSurface(surface.xyz, surface.corners[:, ::-1].copy())
    positions = np.random.default_rng(0).uniform(0.0, 20.0, (500, 2)) + SURVEYED[:2]
    assert np.allclose(surface.heights_at(positions), turned.heights_at(positions), atol=1e-9)
    assert surface.plan_area_m2() == pytest.approx(turned.plan_area_m2())


def test_places_that_are_no_numbers_and_far_ones_have_no_height() -> None:
    surface = scattered_surface(50, seed=3, height=lambda x, y: x)
    positions = np.array(
        [[np.nan, 0.0], [0.0, np.inf], [-np.inf, 3.0], [1e300, -1e300], [0.0, 0.0]]
    )
    assert np.isnan(surface.heights_at(positions)).all()
    assert surface.heights_at(np.empty((0, 2))).shape == (0,)


def test_walls_and_no_triangles_hold_no_place() -> None:
    wall = surface_of([[[0, 0, 0], [4, 0, 0], [4, 0, 3]], [[0, 0, 0], [2, 2, 0], [4, 4, 1]]])
    assert wall.is_vertical.all()
    assert np.isnan(wall.heights_at(np.array([[1.0, 0.0], [2.0, 2.0]]))).all()
    none = TriangleSurface(np.empty((0, 3)), np.empty((0, 3), np.int64))
    assert np.isnan(none.heights_at(np.array([[1.0, 0.0]]))).all()
    assert none.plan_area_m2() == 0.0


def test_a_triangle_whose_corner_is_no_number_holds_no_place() -> None:
    good, bad = [[0, 0, 1], [4, 0, 1], [0, 4, 1]], [[4, 4, 1], [4, 0, 1], [0, np.nan, 1]]
    low = [[0, 0, 1], [0, 4, 1], [-4, 4, np.nan]]
    surface = surface_of([good, bad, low], origin=SURVEYED)
    positions = np.array([[1.0, 1.0], [3.0, 3.0], [-1.0, 3.0]]) + SURVEYED[:2]
    assert surface.heights_at(positions) == pytest.approx(
        [SURVEYED[2] + 1, np.nan, np.nan], nan_ok=True
    )
    assert surface.plan_area_m2() == pytest.approx(8.0)


def test_a_corner_far_away_leaves_the_buckets_as_small_as_the_triangles() -> None:
    near = scattered_surface(3000, seed=1, height=lambda x, y: x)
    far = surface_of([[[0, 0, 0], [0, 1, 0], [90_000.0, 90_000.0, 0]]], origin=SURVEYED)
    xyz = np.concatenate([near.xyz, far.xyz])
    both = TriangleSurface(xyz, np.concatenate([near.corners, far.corners + len(near.xyz)]))
    assert both._buckets.size_m < 100.0
    corners = both.heights_at(far.xyz[:, :2])
    assert np.isfinite(corners).all()


def test_slopes_area_and_extent() -> None:
    corners = [
        [[0, 0, 0], [4, 0, 0], [0, 3, 0]],
        [[4, 0, 0], [4, 3, 3], [0, 3, 3]],
        [[0, 0, 0], [0, 3, 0], [0, 3, 5]],
    ]
    surface = surface_of(corners, origin=SURVEYED)
    assert surface.slopes_deg() == pytest.approx([0.0, np.degrees(np.arctan(1.0)), 90.0])
    assert surface.plan_area_m2() == pytest.approx(12.0)
    west, south = SURVEYED[:2]
    assert surface.extent() == pytest.approx((west, south, west + 4, south + 3))


def test_thin_triangles_across_the_plan_are_found_from_everywhere_on_them() -> None:
    low, high = np.linspace(0.0, 1000.0, 400), np.linspace(0.0, 1000.0, 400)[::-1]
    fan = [
        [[x, 0.0, 1.0], [x + 1e-3, 0.0, 1.0], [y, 1000.0, 1.0]]
        for x, y in zip(low, high, strict=True)
    ]
    surface = surface_of(fan)
    assert surface._buckets.size_m < 20.0
    shares = np.random.default_rng(0).dirichlet([1, 1, 1], 400)
    positions = np.einsum("nk,nkd->nd", shares, np.asarray(fan))
    assert np.allclose(surface.heights_at(positions[:, :2]), 1.0)


def test_buckets_hold_each_triangle_wherever_it_reaches() -> None:
    random = np.random.default_rng(5)
    triangles = random.uniform(0.0, 10.0, (40, 3, 3))
    buckets = sort_into_buckets(triangles)
    shares = random.dirichlet([1, 1, 1], (40, 200))
    positions = np.einsum("tnk,tkd->tnd", shares, triangles)
    column = np.floor((positions[..., 0] - buckets.west) / buckets.size_m).astype(int)
    row = np.floor((positions[..., 1] - buckets.south) / buckets.size_m).astype(int)
    for triangle in range(40):
        for bucket in np.unique(row[triangle] * buckets.columns + column[triangle]):
            held = buckets.triangles[buckets.starts[bucket] : buckets.starts[bucket + 1]]
            assert triangle in held
            assert (np.diff(held) > 0).all()


def test_kernels_give_the_same_without_being_compiled() -> None:
    triangles = Delaunay(np.random.default_rng(1).uniform(0, 9, (12, 2)))
    xyz = np.column_stack([triangles.points, triangles.points[:, 0]])
    surface = TriangleSurface(xyz, triangles.simplices.astype(np.int64))
    figures = surface.plan_triangles(np.zeros(3))
    buckets = sort_into_buckets(figures)
    frame = (buckets.west, buckets.south, buckets.size_m)
    counts = np.zeros(buckets.rows * buckets.columns + 1, np.int64)
    plan_buckets._count_kernel.py_func(figures, frame, buckets.columns, counts)
    assert np.array_equal(np.cumsum(counts)[:-1], buckets.starts[1:])
    held = np.empty_like(buckets.triangles)
    following = buckets.starts[:-1].copy()
    plan_buckets._fill_kernel.py_func(figures, frame, buckets.columns, (following, held))
    assert np.array_equal(held, buckets.triangles)
    positions = np.random.default_rng(2).uniform(-1, 10, (300, 2))
    heights = np.full(300, np.nan)
    whole = (*frame, buckets.rows, buckets.columns)
    triangle_surface._heights_kernel.py_func(
        positions, figures, whole, (buckets.starts, buckets.triangles), heights
    )
    inside = triangles.find_simplex(positions) >= 0
    assert np.array_equal(np.isfinite(heights), inside)
    assert np.allclose(heights[inside], positions[inside, 0])
