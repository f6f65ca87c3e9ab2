"""Given surfaces: what is refused, what is left out and told, outlines and holes."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from processing.core.errors import Unsuitable
from processing.methods.earthwork.geometry.overlay_kernels import overlap_kernel
from processing.methods.earthwork.geometry.plan_buckets import (
    buckets_of_triangles,
    sort_into_buckets,
)
from processing.methods.earthwork.geometry.surface_check import check_surface, holes_of, outline
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from tests.processing.methods.earthwork.bodies import SURVEYED, scattered_surface, surface_of


def squares(*, without: tuple[tuple[int, int], ...] = (), size: int = 6) -> TriangleSurface:
    """A net of squares of 1 m, cut into triangles."""
    figures = []
    for row in range(size):
        for column in range(size):
            if (row, column) not in without:
                a, b = [column, row, 0], [column + 1, row, 0]
                c, d = [column + 1, row + 1, 0], [column, row + 1, 0]
                figures += [[a, b, c], [a, c, d]]
    return surface_of(figures, origin=SURVEYED)


def test_a_good_surface_is_taken_as_it_is() -> None:
    surface = scattered_surface(500, seed=1, height=lambda x, y: 0.1 * x)
    checked = check_surface(surface)
    assert checked.surface is surface
    assert checked.notes == ()
    assert (checked.vertical, checked.repeated, checked.covered_twice_m2) == (0, 0, 0.0)


def test_no_triangle_is_refused() -> None:
    with pytest.raises(Unsuitable, match="no triangle"):
        check_surface(TriangleSurface(np.zeros((4, 3)), np.empty((0, 3), np.int64), "design"))


@pytest.mark.parametrize("number", [-1, 4])
def test_a_corner_that_is_not_there_is_refused(number: int) -> None:
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    bad = TriangleSurface(xyz, np.array([[0, 1, 2], [0, 2, number]]), "design")
    with pytest.raises(Unsuitable, match=r"Triangle 2 .* not there.* Surface design"):
        check_surface(bad)


def test_a_corner_that_is_no_number_is_refused_where_a_triangle_uses_it() -> None:
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, np.nan], [0, 1, 0.0]])
    with pytest.raises(Unsuitable, match=r"Triangle 1 .* no number"):
        check_surface(TriangleSurface(xyz, np.array([[0, 1, 2]])))
    assert check_surface(TriangleSurface(xyz, np.array([[0, 1, 3]]))).notes == ()


def test_walls_are_left_out_and_told_and_a_wall_alone_is_refused() -> None:
    floor = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    walls = [[[0, 0, 0], [4, 0, 0], [4, 0, 3]], [[0, 0, 0], [4, 0, 3], [0, 0, 3]]]
    checked = check_surface(surface_of([floor, *walls]))
    assert checked.vertical == 2
    assert len(checked.surface.corners) == 1
    assert "2 vertical triangles" in checked.notes[0].en
    with pytest.raises(Unsuitable, match="seen from above"):
        check_surface(surface_of(walls))


def test_a_triangle_that_comes_twice_counts_once() -> None:
    one = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    checked = check_surface(surface_of([one, one[1:] + one[:1], one[::-1]], origin=SURVEYED))
    assert checked.repeated == 2
    assert checked.surface.plan_area_m2() == pytest.approx(8.0)


def test_triangles_over_each_other_are_refused_with_the_place() -> None:
    floor = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    roof = [[1, 1, 2], [5, 1, 2], [1, 5, 2]]
    with pytest.raises(Unsuitable, match=r"on 2.00 m².* easting -3599\d"):
        check_surface(surface_of([floor, roof], origin=SURVEYED))


def test_triangles_that_meet_badly_by_a_millimetre_are_borne() -> None:
    left = [[0, 0, 0], [10, 0, 0], [10.001, 10, 0]]
    right = [[10, 0, 0], [20, 0, 0], [10, 10, 0]]
    assert check_surface(surface_of([left, right])).notes == ()


def test_a_long_side_along_two_short_ones_encloses_no_hole() -> None:
    figures = [
        [[0, 0, 0], [10, 0, 0], [5, 5, 0]],
        [[0, 0, 0], [3, -5, 0], [5, 0, 0]],
        [[5, 0, 0], [3, -5, 0], [10, 0, 0]],
    ]
    surface = surface_of(figures, origin=SURVEYED)
    assert check_surface(surface).covered_twice_m2 == 0.0
    whole = outline(surface)
    assert whole.geom_type == "Polygon"
    assert whole.area == pytest.approx(50.0)
    assert holes_of(surface) == ()


def test_holes_are_found_and_the_largest_comes_first() -> None:
    surface = squares(without=((1, 1), (3, 3), (3, 4)))
    holes = holes_of(surface)
    assert [hole.area for hole in holes] == pytest.approx([2.0, 1.0])
    expected = shapely.box(3, 3, 5, 4)
    moved = shapely.transform(holes[0], lambda positions: positions - SURVEYED[:2])
    assert moved.equals(expected)
    assert outline(surface).area == pytest.approx(33.0)


def test_holes_that_touch_at_a_corner_and_parts_that_lie_apart() -> None:
    touching = squares(without=((1, 1), (2, 2)))
    assert outline(touching).area == pytest.approx(34.0)
    assert sum(hole.area for hole in holes_of(touching)) == pytest.approx(2.0)
    apart = squares(without=tuple((row, 2) for row in range(6)))
    assert outline(apart).geom_type == "MultiPolygon"
    assert outline(apart).area == pytest.approx(30.0)
    assert shapely.is_valid(outline(apart))


def test_the_overlap_kernel_gives_what_shapely_gives_compiled_or_not() -> None:
    random = np.random.default_rng(8)
    plan = random.uniform(0.0, 10.0, (12, 3, 2))
    surface = surface_of(np.concatenate([plan, np.zeros((12, 3, 1))], axis=2))
    figures = surface.plan_triangles(np.zeros(3))
    buckets = sort_into_buckets(figures)
    polygons = shapely.polygons(plan)
    pairs = [
        shapely.intersection(polygons[i], polygons[j]).area for i in range(12) for j in range(i)
    ]
    for kernel in (overlap_kernel, overlap_kernel.py_func):
        found = np.zeros(4)
        held = (buckets.starts, buckets.triangles)
        kernel(figures, held, buckets_of_triangles(buckets), found)
        assert found[0] == pytest.approx(sum(pairs))
        assert found[1] == pytest.approx(max(pairs))
