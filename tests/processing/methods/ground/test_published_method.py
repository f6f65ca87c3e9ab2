"""The published method on shapes whose answer is known."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.core.monitor import SilentMonitor
from processing.methods.ground.filters import lowest_points, triangles
from processing.methods.ground.filters.lowest_points import lowest_ground
from processing.methods.ground.filters.published_method import PublishedSteps, published_surface
from processing.methods.ground.filters.triangles import triangulate_points

_SHIFT = np.array([-12_400.0, -36_700.0, 50.0])


class _Found(NamedTuple):
    is_ground: np.ndarray
    outside_hull: int
    removals: int


def _ground(xyz: np.ndarray, steps: PublishedSteps) -> _Found:
    """The method on a cloud in one block."""
    surface = published_surface(lambda: [xyz], steps, SilentMonitor())
    is_ground, _, outside_hull = surface.judged(xyz)
    return _Found(is_ground, outside_hull, surface.removals)


def _slope() -> np.ndarray:
    x, y = np.meshgrid(np.arange(0.0, 30.0, 0.25), np.arange(0.0, 30.0, 0.25))
    return np.column_stack([x.ravel(), y.ravel(), 0.2 * x.ravel()]) + _SHIFT


def _inside(xyz: np.ndarray) -> np.ndarray:
    """Where the triangles of lowest points reach: three metres from the border."""
    local = xyz[:, :2] - _SHIFT[:2]
    return np.all((local > 3.0) & (local < 27.0), axis=1)


def _with_machine() -> tuple[np.ndarray, int]:
    ground = _slope()
    machine = np.random.default_rng(1).uniform([10.0, 10.0, 4.0], [12.0, 12.0, 5.0], (500, 3))
    return np.vstack([ground, machine + _SHIFT]), len(ground)


def test_a_slope_is_ground_and_a_machine_of_two_metres_is_not() -> None:
    xyz, count = _with_machine()
    found = _ground(xyz, PublishedSteps())
    inside = _inside(xyz[:count])
    assert found.is_ground[:count][inside].mean() > 0.99
    assert not found.is_ground[count:].any()


def test_a_point_at_the_distance_itself_is_ground() -> None:
    flat = np.array([[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0], [8.0, 8.0, 0.0]])
    xyz = np.vstack([flat, [[1.0, 1.0, 0.25], [1.0, 2.0, 0.26]]])
    steps = PublishedSteps(distance_m=0.25)
    found = _ground(xyz, steps)
    assert found.is_ground.tolist() == [True, True, True, True, True, False]


def test_the_highest_corner_of_a_steep_triangle_goes_once_or_until_none_is_left() -> None:
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    xyz = np.column_stack([x.ravel(), y.ravel(), np.zeros(25)])
    xyz[12, 2] = 40.0
    xyz[13, 2] = 20.0
    once = _ground(xyz, PublishedSteps(grid_m=1.0))
    often = _ground(xyz, PublishedSteps(grid_m=1.0, most_removals=9))
    assert once.removals == 1
    assert not often.is_ground[12:14].any()
    assert often.is_ground.sum() == 23


def test_slopes_of_triangles_are_angles_from_the_horizontal() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]) + _SHIFT
    assert triangulate_points(corners).slopes_deg() == pytest.approx([45.0])


@pytest.mark.parametrize("is_lattice", [False, True], ids=["scattered", "lattice"])
def test_the_triangle_of_a_place_holds_it_and_only_places_outside_the_hull_have_none(
    is_lattice: bool,
) -> None:
    rng = np.random.default_rng(3)
    corners = rng.uniform(0.0, 20.0, (300, 3))
    if is_lattice:
        corners = np.column_stack([np.mgrid[:21:2, :21:2].reshape(2, -1).T, np.zeros(121)])
    found = triangulate_points(corners + _SHIFT)
    positions = np.vstack([rng.uniform(-3.0, 23.0, (900, 2)), corners[:50, :2]])
    triangle = found.triangle_of(positions + _SHIFT[:2])
    # scipy is the peer; on edges and corners any of the triangles there will do.
    expected = found.mesh.find_simplex(positions + _SHIFT[:2] - found.origin[:2])
    assert np.array_equal(triangle[:900] < 0, expected[:900] < 0)
    assert (triangle[900:] >= 0).all()
    inside = triangle >= 0
    a, b, c = (found.xyz[found.corners[triangle[inside], k], :2] for k in range(3))
    of = positions[inside] + _SHIFT[:2] - found.origin[:2]
    for start, end in ((a, b), (b, c), (c, a)):
        edge, way = end - start, of - start
        assert (edge[:, 0] * way[:, 1] - edge[:, 1] * way[:, 0] > -1e-9).all()
    again = found.triangle_of(positions[::-1] + _SHIFT[:2])
    assert np.array_equal(again[::-1], triangle)


def test_walking_uncompiled_finds_what_the_kernel_finds() -> None:
    whole = triangulate_points(np.random.default_rng(4).uniform(0.0, 9.0, (20, 3)))
    corners, mesh = whole.xyz, whole.mesh
    positions = np.random.default_rng(5).uniform(-1.0, 10.0, (40, 2))
    asked = triangles._AskedPositions(positions, np.arange(40))
    results = []
    for walk in (triangles._walk_kernel, triangles._walk_kernel.py_func):
        found = triangles._LocatedPositions(np.empty(40, np.int64), np.zeros((40, 3)))
        walk(corners, mesh.simplices, mesh.neighbors, asked, found)
        results.append(found)
    assert np.array_equal(results[0].triangles, results[1].triangles)
    np.testing.assert_allclose(results[0].shares, results[1].shares)


def test_large_coordinates_and_duplicates_do_not_change_the_ground() -> None:
    xyz, _ = _with_machine()
    doubled = np.vstack([xyz, xyz])
    found = _ground(doubled, PublishedSteps()).is_ground
    moved = _ground(xyz + np.array([3e6, 5e6, 0.0]), PublishedSteps()).is_ground
    alone = _ground(xyz, PublishedSteps()).is_ground
    assert np.array_equal(found[: len(xyz)], alone)
    assert np.array_equal(moved, alone)


def test_the_lowest_points_are_one_per_cell_and_a_tolerance_keeps_a_band() -> None:
    xyz = np.array([[0.1, 0.1, 2.0], [0.2, 0.2, 1.0], [0.3, 0.1, 1.2], [1.5, 0.1, 7.0]])
    strict, with_band = (lowest_ground(lambda: [xyz], 1.0, band) for band in (0.0, 0.3))
    assert strict.lowest.numbers.tolist() == [1, 3]
    assert strict.is_ground(xyz, 0).tolist() == [False, True, False, True]
    assert with_band.is_ground(xyz, 0).tolist() == [False, True, True, True]


def test_lowest_points_are_the_same_however_often_they_are_sorted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rng = np.random.default_rng(5)
    keys, xyz = rng.integers(0, 9, (400, 2)), np.round(rng.random((400, 3)), 1)
    found = []
    for waiting in (0, 30, 1_000):
        monkeypatch.setattr(lowest_points, "_MOST_WAITING", waiting)
        lowest = lowest_points.LowestPoints(2)
        for start in range(0, 400, 25):
            part = slice(start, start + 25)
            lowest.add(keys[part], xyz[part], np.arange(start, start + 25))
            assert lowest.count_so_far <= len(np.unique(keys[: start + 25], axis=0))
        found.append(lowest.numbers.tolist())
    assert found[0] == found[1] == found[2]
    order = np.lexsort((np.arange(400), xyz[:, 2], keys[:, 0], keys[:, 1]))
    first = np.unique(keys[order][:, ::-1], axis=0, return_index=True)[1]
    assert found[0] == order[first].tolist()


def test_points_on_one_line_and_coplanar_points_have_ground() -> None:
    line = np.column_stack([np.arange(10.0), np.zeros(10), np.zeros(10)])
    found = _ground(line, PublishedSteps(grid_m=1.0))
    assert found.is_ground.all()
    assert found.outside_hull == 10


def test_points_without_coordinates_are_not_ground() -> None:
    xyz, count = _with_machine()
    xyz[5] = np.nan
    found = _ground(xyz, PublishedSteps())
    assert not found.is_ground[5]
    assert found.is_ground[:count].mean() > 0.94


def test_two_points_are_refused_in_a_sentence() -> None:
    with pytest.raises(OutOfRange, match="three or more places"):
        _ground(np.zeros((2, 3)), PublishedSteps())
