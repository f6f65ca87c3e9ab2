"""Triangles over points and break lines: edges keep to the lines, gaps stay gaps."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.geometry.break_lines import break_net
from processing.methods.earthwork.geometry.surface_check import check_surface, outline
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.triangulation import clip_surface, triangulate_ground
from tests.processing.methods.earthwork.bodies import SURVEYED


def scattered(count: int, seed: int = 0, size_m: float = 20.0) -> np.ndarray:
    plan = np.random.default_rng(seed).uniform(0, size_m, (count, 2))
    corners = size_m * np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    plan = np.concatenate([corners, plan])
    return np.column_stack([plan, np.zeros(len(plan))]) + SURVEYED


def made(xyz: np.ndarray, lines: Sequence[np.ndarray] = (), **options: Any) -> TriangleSurface:
    return triangulate_ground(xyz, lines, SilentMonitor(), **options)


def line(*positions: tuple[float, float, float]) -> np.ndarray:
    return np.array(positions) + SURVEYED


def is_chain_of_edges(surface: TriangleSurface, drawn: np.ndarray) -> bool:
    """Whether edges of triangles cover each segment of a line."""
    corners = surface.corners
    sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    sides = np.unique(np.sort(sides, axis=1), axis=0)
    plan = surface.xyz[:, :2] - SURVEYED[:2]
    for start, end in zip(drawn[:-1, :2], drawn[1:, :2], strict=True):
        start, end = start - SURVEYED[:2], end - SURVEYED[:2]
        along = (end - start) / np.hypot(*(end - start))
        across = np.array([-along[1], along[0]])
        length = np.hypot(*(end - start))
        # Lines that meet within a millimetre are joined, which may bend them by as much.
        is_on = np.abs((plan - start) @ across) < 2e-3
        share = np.clip((plan - start) @ along, 0.0, length)
        low, high = np.sort(share[sides[is_on[sides].all(axis=1)]], axis=1).T
        low, high = low[low.argsort()], high[low.argsort()]
        reached = np.concatenate([[0.0], np.maximum.accumulate(high)])
        covered = np.maximum(0.0, high - np.maximum(low, reached[:-1])).sum()
        if covered == pytest.approx(length, abs=1e-5):
            continue
        return False
    return True


def test_points_become_a_surface_through_all_of_them() -> None:
    xyz = scattered(500)
    xyz[:, 2] += np.sin(xyz[:, 0])
    surface = made(xyz)
    assert surface.plan_area_m2() == pytest.approx(400.0)
    assert np.allclose(surface.heights_at(xyz[:, :2]), xyz[:, 2], atol=1e-9)
    assert check_surface(surface).notes == ()


def test_points_at_one_place_become_one_at_their_mean_height() -> None:
    xyz = np.concatenate([scattered(30), scattered(30) + np.array([0, 0, 1.0])])
    surface = made(xyz)
    assert len(surface.xyz) == 34
    assert np.allclose(surface.xyz[:, 2], SURVEYED[2] + 0.5)


def test_rows_that_are_no_numbers_are_passed_over() -> None:
    xyz = scattered(40)
    broken = np.concatenate([xyz, [[np.nan, 0, 0], [0, 0, np.nan], [np.inf, 0, 0]]])
    assert np.array_equal(made(broken).xyz, made(xyz).xyz)


def test_a_crest_between_points_is_kept_sharp() -> None:
    xyz = scattered(800, seed=3)
    local = xyz - SURVEYED
    xyz[:, 2] += np.maximum(0.0, local[:, 0] - 9.0)
    crest = line((9.0, 0.0, 0.0), (9.0, 20.0, 0.0))
    surface = made(xyz, [crest])
    assert is_chain_of_edges(surface, crest)
    positions = np.random.default_rng(1).uniform(0.5, 19.5, (4000, 2))
    expected = np.maximum(0.0, positions[:, 0] - 9.0) + SURVEYED[2]
    found = surface.heights_at(positions + SURVEYED[:2])
    assert np.allclose(found, expected, atol=1e-9)


def test_noisy_points_beside_the_line_dont_spoil_it() -> None:
    xyz = scattered(900, seed=4)
    beside = np.column_stack([np.full(300, 9.0), np.linspace(0.1, 19.9, 300), np.full(300, 0.3)])
    beside[:, 0] += np.random.default_rng(2).normal(0, 0.02, 300)
    crest = line((9.0, 0.0, 0.0), (9.0, 20.0, 0.0))
    surface = made(np.concatenate([xyz, beside + SURVEYED]), [crest])
    assert is_chain_of_edges(surface, crest)
    along = np.column_stack([np.full(500, 9.0), np.linspace(0, 20, 500)]) + SURVEYED[:2]
    assert np.allclose(surface.heights_at(along), SURVEYED[2], atol=1e-9)
    local = surface.xyz - SURVEYED
    assert (np.abs(local[np.abs(local[:, 0] - 9.0) < 0.02, 2]) < 1e-9).all()


def test_heights_along_a_sloping_line_are_on_the_line() -> None:
    drawn = line((2.0, 3.0, 0.0), (17.0, 12.0, 6.0), (18.0, 19.0, 1.0))
    surface = made(scattered(600, seed=5), [drawn])
    assert is_chain_of_edges(surface, drawn)
    share = np.linspace(0, 1, 200)[:, None]
    for start, end in pairwise(drawn):
        positions = start + share * (end - start)
        assert np.allclose(surface.heights_at(positions[:, :2]), positions[:, 2], atol=1e-8)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 300), st.integers(1, 6))
def test_any_lines_become_edges_and_the_surface_stays_whole(
    seed: int, count: int, lines: int
) -> None:
    random = np.random.default_rng(seed)
    drawn = [
        np.column_stack([random.uniform(1, 19, (n, 2)), np.full(n, 0.2)]) + SURVEYED
        for n in random.integers(2, 5, lines)
    ]
    surface = made(scattered(count, seed), drawn)
    assert surface.plan_area_m2() == pytest.approx(400.0, rel=1e-6)
    for one in drawn:
        assert is_chain_of_edges(surface, one)
        assert np.allclose(surface.heights_at(one[:, :2]), one[:, 2], atol=1e-3)


@pytest.mark.parametrize("degrees", [60.0, 20.0, 5.0, 1.0])
def test_lines_that_meet_at_a_small_angle_come_to_an_end(degrees: float) -> None:
    way = np.radians(degrees)
    drawn = [
        line((1.0, 1.0, 0.0), (18.0, 1.0, 0.0)),
        line((1.0, 1.0, 0.0), (1 + 17 * np.cos(way), 1 + 17 * np.sin(way), 0.0)),
    ]
    surface = made(scattered(400), drawn)
    assert all(is_chain_of_edges(surface, one) for one in drawn)
    assert len(surface.xyz) < 3000


def test_points_on_a_square_grid_leave_the_diagonal_no_choice() -> None:
    row, column = np.mgrid[:11, :11]
    grid = np.column_stack([column.ravel(), row.ravel(), np.zeros(121)]) + SURVEYED
    diagonal = line((0.0, 0.0, 1.0), (10.0, 10.0, 1.0))
    surface = made(grid, [diagonal])
    assert is_chain_of_edges(surface, diagonal)


def test_crossing_lines_at_one_height_are_joined_and_at_two_are_refused() -> None:
    one = line((2.0, 10.0, 1.0), (18.0, 10.0, 1.0))
    other = line((10.0, 2.0, 1.02), (10.0, 18.0, 1.02))
    surface = made(scattered(200), [one, other])
    assert surface.heights_at(SURVEYED[None, :2] + 10.0) == pytest.approx(SURVEYED[2] + 1.01)
    with pytest.raises(Unsuitable, match=r"differ by 0.50 m.*Easting -35990.000, northing -11990"):
        made(scattered(200), [one, other + np.array([0, 0, 0.48])])


def test_a_line_that_ends_on_another_is_joined_to_it() -> None:
    one = line((2.0, 10.0, 0.0), (18.0, 10.0, 1.6))
    touching = line((10.0, 10.0004, 0.8), (10.0, 18.0, 0.0))
    net = break_net([one, touching], 0.05)
    assert len(net.xyz) == 4
    assert len(net.segments) == 3
    with pytest.raises(Unsuitable, match=r"differ by 0\.40 m"):
        break_net([one, touching + np.array([0, 0, 0.4])], 0.05)


def test_lines_drawn_twice_and_along_each_other_count_once() -> None:
    one = line((2.0, 10.0, 0.0), (18.0, 10.0, 0.0))
    part = line((5.0, 10.0, 0.0), (11.0, 10.0, 0.0))
    net = break_net([one, one[::-1], part], 0.05)
    assert len(net.segments) == 3
    surface = made(scattered(100), [one, one[::-1], part])
    assert is_chain_of_edges(surface, one)


def test_a_closed_line_and_one_that_crosses_itself_are_taken() -> None:
    ring = line((3.0, 3.0, 0), (15.0, 3.0, 0), (15.0, 15.0, 0), (3.0, 15.0, 0), (3.0, 3.0, 0))
    loop = line((2.0, 2.0, 0), (16.0, 16.0, 0), (16.0, 2.0, 0), (2.0, 16.0, 0))
    surface = made(scattered(100), [ring, loop])
    assert is_chain_of_edges(surface, ring)
    assert is_chain_of_edges(surface, loop)


@pytest.mark.parametrize(
    ("drawn", "says"),
    [
        (np.zeros((1, 3)), "no length in plan.*Break line 2"),
        (np.array([[0, 0, 0], [0, 0, 3.0]]), "no length in plan.*Break line 2"),
        (np.array([[0, 0, 0], [np.nan, 0, 3.0]]), "without position.*Break line 2"),
        (np.array([[5, 5, 0], [5, 5, 2.0], [9, 9, 0]]), "differ by 2.00 m"),
    ],
)
def test_lines_that_are_none_are_refused(drawn: np.ndarray, says: str) -> None:
    good = line((2.0, 10.0, 0.0), (18.0, 10.0, 0.0))
    with pytest.raises(Unsuitable, match=says):
        made(scattered(50), [good, drawn])


def test_unmeasured_ground_stays_unmeasured() -> None:
    xyz = scattered(3000, seed=6)
    local = xyz - SURVEYED
    is_gap = np.hypot(local[:, 0] - 10.0, local[:, 1] - 10.0) < 4.0
    whole = made(xyz[~is_gap])
    surface = made(xyz[~is_gap], longest_m=2.0)
    middle = SURVEYED[None, :2] + 10.0
    assert np.isfinite(whole.heights_at(middle)).all()
    assert np.isnan(surface.heights_at(middle)).all()
    assert surface.plan_area_m2() == pytest.approx(400.0 - np.pi * 16.0, rel=0.03)


def test_the_surface_ends_at_the_boundary() -> None:
    boundary = shapely.transform(
        shapely.Polygon([[2, 2], [17, 4], [11, 10], [15, 18], [3, 15]]),
        lambda positions: positions + SURVEYED[:2],
    )
    xyz = scattered(400, seed=7)
    xyz[:, 2] += 0.2 * (xyz[:, 0] - SURVEYED[0])
    surface = made(xyz, boundary=boundary)
    assert surface.plan_area_m2() == pytest.approx(boundary.area, rel=1e-9)
    assert shapely.symmetric_difference(outline(surface), boundary).area < 1e-6
    middles = surface.xyz[surface.corners].mean(axis=1)
    assert np.allclose(middles[:, 2], SURVEYED[2] + 0.2 * (middles[:, 0] - SURVEYED[0]), atol=1e-8)
    assert check_surface(clip_surface(surface, boundary.buffer(-0.5), SilentMonitor())).notes == ()


@pytest.mark.parametrize(
    "xyz",
    [
        np.empty((0, 3)),
        scattered(10)[:2],
        np.repeat(scattered(10)[:1], 5, axis=0),
        np.column_stack([np.arange(9.0), np.arange(9.0), np.zeros(9)]),
        np.full((5, 3), np.nan),
    ],
)
def test_too_few_places_are_refused(xyz: np.ndarray) -> None:
    with pytest.raises(Unsuitable, match="no three places"):
        made(xyz)


def test_nothing_left_is_refused() -> None:
    with pytest.raises(Unsuitable, match="No triangle"):
        made(scattered(10), longest_m=0.01)
    with pytest.raises(Unsuitable, match="No triangle"):
        made(scattered(10), boundary=shapely.box(0, 0, 1, 1))


def test_break_lines_alone_make_a_surface() -> None:
    low = line((0.0, 0.0, 0.0), (20.0, 0.0, 0.0))
    high = line((0.0, 5.0, 5.0), (20.0, 5.0, 5.0))
    surface = made(np.empty((0, 3)), [low, high])
    assert surface.slopes_deg() == pytest.approx(45.0)
    assert surface.plan_area_m2() == pytest.approx(100.0)
