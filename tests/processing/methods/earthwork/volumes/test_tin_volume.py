"""Volumes between triangulated surfaces: bodies of known volume, and what never changes one."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.errors import Cancelled, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.volumes import cut_and_fill
from processing.methods.earthwork.geometry import overlay_kernels
from processing.methods.earthwork.geometry.plan_buckets import sort_into_buckets
from processing.methods.earthwork.geometry.plan_clip import clip_triangles
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface, twice_areas
from processing.methods.earthwork.volumes.tin_volume import (
    TinVolume,
    volume_between,
    volume_to_level,
)
from tests.processing.methods.earthwork.bodies import (
    SURVEYED,
    frustum,
    frustum_m3,
    meshed,
    scattered_surface,
    surface_of,
)

QUIET = SilentMonitor()
SITE = shapely.box(*SURVEYED[:2], *(SURVEYED[:2] + 20.0))


def hills(seed: int, count: int = 60) -> TriangleSurface:
    ways = np.random.default_rng(seed).normal(0, 0.4, 4)
    return scattered_surface(
        count,
        seed,
        lambda x, y: ways[0] * x + ways[1] * y + 3 * np.sin(x * ways[2]) * np.cos(y * ways[3]),
    )


def around(surface: TriangleSurface, height: float = 0.0, size_m: float = 40.0) -> TriangleSurface:
    """Level ground of scattered triangles below a body that stands at its origin."""
    plan = np.random.default_rng(7).uniform(-size_m, size_m, (300, 2))
    plan = np.concatenate([plan, size_m * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1.0]])])
    return meshed(plan, lambda x, y: np.full(len(x), height))


def by_shapely(before: TriangleSurface, after: TriangleSurface) -> tuple[float, float, float]:
    """Cut, fill and area from polygons clipped by shapely: slow, but somebody else's."""
    origin = before.origin
    cut = fill = area = 0.0
    for one in before.plan_triangles(origin):
        for other in after.plan_triangles(origin):
            shared = shapely.Polygon(one[:, :2]).intersection(shapely.Polygon(other[:, :2]))
            if shared.area < 1e-12:
                continue
            planes = [
                np.linalg.solve(np.column_stack([t[:, :2], np.ones(3)]), t[:, 2])
                for t in (one, other)
            ]
            a, b, c = planes[1] - planes[0]
            area += shared.area
            whole, above = integral(shared, a, b, c), integral(upper(shared, a, b, c), a, b, c)
            fill += above
            cut += above - whole
    return cut, fill, area


def integral(figure: shapely.Geometry, a: float, b: float, c: float) -> float:
    if figure.is_empty:
        return 0.0
    middle = figure.centroid
    return float(figure.area * (a * middle.x + b * middle.y + c))


def upper(figure: shapely.Geometry, a: float, b: float, c: float) -> shapely.Geometry:
    """Where a x + b y + c is not negative."""
    if np.hypot(a, b) < 1e-12:
        return figure if c > 0 else shapely.Polygon()
    up = np.array([a, b]) / np.hypot(a, b)
    along = np.array([-up[1], up[0]])
    start = -c / np.hypot(a, b) * up
    far = 1e3
    corners = [start - far * along, start + far * along]
    return figure.intersection(
        shapely.Polygon([*corners, corners[1] + far * up, corners[0] + far * up])
    )


@pytest.mark.parametrize(("sides", "top_m"), [(4, 6.0), (4, 1e-3), (7, 3.0), (360, 5.0)])
def test_a_heap_on_level_ground_has_its_volume(sides: int, top_m: float) -> None:
    heap = frustum(12.0, top_m, 5.0, sides)
    expected = frustum_m3(12.0, top_m, 5.0, sides)
    found = volume_between(around(heap), heap, QUIET)
    assert found.fill_m3 == pytest.approx(expected, rel=1e-10)
    assert found.cut_m3 == pytest.approx(0.0, abs=1e-9)
    assert found.area_m2 == pytest.approx(heap.plan_area_m2(), rel=1e-10)
    assert found.after_only_m2 == 0.0
    assert found.before_only_m2 == pytest.approx(80.0**2 - heap.plan_area_m2(), rel=1e-9)


def test_many_facets_near_the_volume_of_a_round_frustum() -> None:
    heap = frustum(12.0, 5.0, 4.0, 2000)
    round_m3 = np.pi * 4.0 / 3 * (144.0 + 25.0 + 60.0)
    assert volume_to_level(heap, SURVEYED[2], QUIET).cut_m3 == pytest.approx(round_m3, rel=1e-5)


def test_a_plane_against_a_tilted_one_cuts_what_it_fills() -> None:
    flat = scattered_surface(300, 1, lambda x, y: 0.0 * x)
    tilted = scattered_surface(200, 2, lambda x, y: 0.3 * (x - 10.0))
    found = volume_between(flat, tilted, QUIET, SITE)
    assert found.cut_m3 == pytest.approx(0.3 * 10.0**2 / 2 * 20.0, rel=1e-10)
    assert found.fill_m3 == pytest.approx(found.cut_m3, rel=1e-10)
    assert found.net_m3 == pytest.approx(0.0, abs=1e-7)
    assert found.area_m2 == pytest.approx(400.0)
    assert found.missing_m2 == 0.0


def test_a_wedge_within_a_boundary_with_a_hole() -> None:
    flat = scattered_surface(100, 1, lambda x, y: 0.0 * x)
    wedge = scattered_surface(100, 2, lambda x, y: 0.1 * y)
    local = shapely.Polygon(
        [[2, 2], [18, 2], [18, 18], [2, 18]], [[[8, 4], [12, 4], [12, 8], [8, 8]]]
    )
    boundary = shapely.transform(local, lambda positions: positions + SURVEYED[:2])
    found = volume_between(flat, wedge, QUIET, boundary)
    assert found.fill_m3 == pytest.approx(0.1 * 10.0 * 256.0 - 0.1 * 6.0 * 16.0, rel=1e-10)
    assert found.area_m2 == pytest.approx(240.0)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 5000), st.integers(3, 12))
def test_the_volume_is_that_of_polygons_clipped_one_by_one(seed: int, count: int) -> None:
    before, after = hills(seed, count), hills(seed + 1, count + 2)
    found = volume_between(before, after, QUIET)
    assert (found.cut_m3, found.fill_m3, found.area_m2) == pytest.approx(
        by_shapely(before, after), rel=1e-7, abs=1e-7
    )


@pytest.mark.parametrize("seed", range(4))
def test_the_volume_is_that_of_the_truth_of_simulated_sites(seed: int) -> None:
    random = np.random.default_rng(seed)
    grids = [HeightGrid(random.normal(0, 1, (13, 17)).astype(np.float32), 0.5) for _ in range(2)]
    ring = np.array([[0.7, 0.3], [7.1, 1.2], [6.6, 5.2], [4.1, 2.2], [1.1, 5.7]])
    truth = cut_and_fill(grids[0], grids[1], ring)
    before, after = (halves_of(grid.z, grid.res) for grid in grids)
    found = volume_between(before, after, QUIET, moved(shapely.Polygon(ring), SURVEYED))
    assert found.cut_m3 == pytest.approx(truth.cut_m3.sum(), rel=1e-8)
    assert found.fill_m3 == pytest.approx(truth.fill_m3.sum(), rel=1e-8)


def halves_of(z: np.ndarray, res: float) -> TriangleSurface:
    """Triangles over nodes, each cell halved from its lower left to its upper right corner."""
    row, column = np.mgrid[: z.shape[0], : z.shape[1]]
    xyz = np.column_stack([column.ravel() * res, row.ravel() * res, z.ravel()]) + SURVEYED
    number = np.arange(z.size).reshape(z.shape)
    low, right = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    up, high = number[1:, :-1].ravel(), number[1:, 1:].ravel()
    halves = [np.column_stack([low, right, high]), np.column_stack([low, high, up])]
    return TriangleSurface(xyz, np.concatenate(halves))


@given(st.integers(0, 10_000))
def test_the_way_back_is_the_way_there_with_cut_and_fill_exchanged(seed: int) -> None:
    before, after = hills(seed), hills(seed + 1)
    there, back = volume_between(before, after, QUIET), volume_between(after, before, QUIET)
    assert alike(there, back.reversed())


@given(st.integers(0, 10_000), st.floats(-400_000, 400_000), st.floats(-400_000, 400_000))
def test_where_the_site_lies_changes_nothing(seed: int, east: float, north: float) -> None:
    before, after = hills(seed), hills(seed + 1)
    ring = shapely.Polygon([[1, 2], [19, 5], [14, 19], [7, 9]])
    position = np.array([*SURVEYED[:2], 0.0])
    shift = np.round(np.array([east, north, 700.0]), 3)
    there = volume_between(before, after, QUIET, moved(ring, position))
    far = [TriangleSurface(s.xyz - position + shift, s.corners) for s in (before, after)]
    here = volume_between(far[0], far[1], QUIET, moved(ring, shift))
    assert alike(there, here, rel=1e-6)


@given(st.integers(0, 10_000), st.floats(1.0, 19.0), st.floats(1.0, 19.0))
def test_two_parts_of_the_boundary_add_up_to_it(seed: int, low: float, high: float) -> None:
    before, after = hills(seed), hills(seed + 1)
    west = moved(shapely.Polygon([[0, 0], [low, 0], [high, 20], [0, 20]]), SURVEYED)
    east = moved(shapely.Polygon([[low, 0], [20, 0], [20, 20], [high, 20]]), SURVEYED)
    whole = volume_between(before, after, QUIET, SITE)
    parts = [volume_between(before, after, QUIET, part) for part in (west, east)]
    for name in ("cut_m3", "fill_m3", "area_m2"):
        total = sum(getattr(part, name) for part in parts)
        assert total == pytest.approx(getattr(whole, name), rel=1e-8, abs=1e-6)
    assert alike(volume_between(before, after, QUIET, shapely.MultiPolygon([west, east])), whole)


def moved(area: shapely.Geometry, shift: np.ndarray) -> shapely.Geometry:
    return shapely.transform(area, lambda positions: positions + shift[:2])


def alike(one: TinVolume, other: TinVolume, rel: float = 1e-8) -> bool:
    names = ("cut_m3", "fill_m3", "area_m2", "before_only_m2", "after_only_m2", "neither_m2")
    return all(
        getattr(one, name) == pytest.approx(getattr(other, name), rel=rel, abs=1e-5)
        for name in names
    )


def test_area_that_lacks_a_surface_is_told_apart() -> None:
    before = surface_of(
        [[[0, 0, 0], [10, 0, 0], [10, 10, 0]], [[0, 0, 0], [10, 10, 0], [0, 10, 0]]]
    )
    after = surface_of([[[5, 0, 1], [15, 0, 1], [15, 10, 1]], [[5, 0, 1], [15, 10, 1], [5, 10, 1]]])
    found = volume_between(before, after, QUIET, shapely.box(0, 0, 20, 10))
    expected = TinVolume(0.0, 50.0, 50.0, 50.0, 50.0, 50.0)
    assert alike(found, expected)
    assert found.missing_m2 == pytest.approx(150.0)
    level = volume_to_level(before, -2.0, QUIET, shapely.box(0, 0, 20, 10))
    assert alike(level, TinVolume(200.0, 0.0, 100.0, 0.0, 0.0, 100.0))


def test_a_level_gives_what_a_level_surface_gives() -> None:
    ground = hills(4)
    flat = scattered_surface(40, 5, lambda x, y: np.full(len(x), 1.5))
    boundary = moved(shapely.Point(9.0, 11.0).buffer(7.0), SURVEYED)
    for area in (None, boundary):
        found = volume_to_level(ground, SURVEYED[2] + 1.5, QUIET, area)
        assert alike(found, volume_between(ground, flat, QUIET, area))


def test_surfaces_that_lie_apart_are_refused() -> None:
    here, there = hills(1), TriangleSurface(hills(2).xyz + 500.0, hills(2).corners)
    with pytest.raises(Unsuitable, match="no ground in common"):
        volume_between(here, there, QUIET)
    with pytest.raises(Unsuitable, match="no ground in common"):
        volume_between(here, here, QUIET, shapely.box(0, 0, 1, 1))
    with pytest.raises(Unsuitable, match="no ground in common"):
        volume_to_level(here, 0.0, QUIET, shapely.box(0, 0, 1, 1))


def test_walls_bear_no_volume() -> None:
    floor = [[[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 0, 0], [4, 0, 0], [4, 0, 9]]]
    roof = [[[0, 0, 1], [4, 0, 1], [0, 4, 1]]]
    assert volume_between(surface_of(floor), surface_of(roof), QUIET).fill_m3 == pytest.approx(8.0)


def test_the_work_stops_when_it_is_asked_to() -> None:
    class Impatient(SilentMonitor):
        def check(self) -> None:
            raise Cancelled

    with pytest.raises(Cancelled):
        volume_between(hills(1), hills(2), Impatient())


def test_thin_triangles_across_many_others_keep_the_volume() -> None:
    strips = np.linspace(0.0, 20.0, 800)
    plan = np.concatenate([np.column_stack([strips, np.full(800, y)]) for y in (0.0, 20.0)])
    fan = meshed(plan, lambda x, y: np.full(len(x), 2.0))
    ground = scattered_surface(500, 3, lambda x, y: 0.1 * x)
    found = volume_between(ground, fan, QUIET, SITE)
    assert found.fill_m3 == pytest.approx(400.0, rel=1e-9)


def test_what_is_clipped_lies_on_the_planes_of_its_triangles() -> None:
    surface = hills(9)
    origin = np.array([*SURVEYED[:2], 0.0])
    triangles = surface.plan_triangles(origin)
    ring = shapely.Polygon([[1, 1], [18, 3], [9, 9], [15, 18], [2, 15]], [[[4, 4], [6, 4], [5, 7]]])
    pieces = clip_triangles(triangles, ring, QUIET)
    area = twice_areas(pieces) / 2
    assert (area > 0).all()
    assert area.sum() == pytest.approx(ring.area)
    middles = pieces.mean(axis=1)
    heights = surface.heights_at(middles[:, :2] + origin[:2])
    assert np.allclose(heights, middles[:, 2], atol=1e-7)
    assert shapely.contains_xy(ring, middles[:, 0], middles[:, 1]).all()
    assert clip_triangles(triangles[:0], ring, QUIET).shape == (0, 3, 3)


def test_kernels_give_the_same_without_being_compiled() -> None:
    before, after = (s.plan_triangles(SURVEYED) for s in (hills(1, 8), hills(2, 8)))
    buckets = sort_into_buckets(after)
    frame = (buckets.west, buckets.south, buckets.size_m, buckets.rows, buckets.columns)
    held = (buckets.starts, buckets.triangles)
    plain, compiled = np.zeros(3), np.zeros(3)
    overlay_kernels.overlay_kernel.py_func(before, after, frame, held, plain)
    overlay_kernels.overlay_kernel(before, after, frame, held, compiled)
    assert plain == pytest.approx(compiled)
    plain[:], compiled[:] = 0.0, 0.0
    overlay_kernels.level_kernel.py_func(before, 1.0, plain)
    overlay_kernels.level_kernel(before, 1.0, compiled)
    assert plain == pytest.approx(compiled)
    every = (
        np.arange(0, (len(before) + 1) * len(after), len(after)),
        np.tile(np.arange(len(after)), len(before)),
    )
    pieces = np.empty(
        (overlay_kernels.pieces_kernel(before, after, every, plain[:0].reshape(0, 3, 3)), 3, 3)
    )
    again = pieces.copy()
    assert overlay_kernels.pieces_kernel.py_func(before, after, every, pieces) == len(pieces)
    overlay_kernels.pieces_kernel(before, after, every, again)
    assert np.allclose(pieces, again)


def test_the_prism_of_one_triangle_for_every_order_of_signs() -> None:
    for a, b, c in np.random.default_rng(0).normal(0, 1, (200, 3)).round(1):
        sums = np.zeros(3)
        overlay_kernels._add_prism.py_func(2.0, a, b, c, sums)
        shares = (
            np.stack(np.meshgrid(np.arange(60), np.arange(60)), -1).reshape(-1, 2) + 1 / 3
        ) / 60
        shares = np.concatenate([shares, shares + 1 / 180])
        shares = shares[shares.sum(axis=1) < 1.0]
        depth = a + shares @ np.array([b - a, c - a])
        assert sums[1] - sums[0] == pytest.approx(2.0 * (a + b + c) / 3)
        assert sums[1] == pytest.approx(2.0 * np.maximum(depth, 0).mean(), abs=4e-3)
        assert sums.min() >= 0.0
