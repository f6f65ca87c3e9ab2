"""Edges measured from points whose curb is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.curb_edge_kernels import edges_kernel
from processing.methods.road.curbs.edges.curb_edges import nearest_kernel
from processing.methods.road.curbs.edges.edge_measures import (
    FACE_POINTS,
    HIGH_POINTS,
    LOWER_ABOVE,
    LOWER_ACROSS,
    MEASURES,
    UPPER_ABOVE,
    UPPER_ACROSS,
    Window,
)

Floats = NDArray[np.float64]

WINDOW = Window(0.25, 0.5, 80.0, 0.005)


def curb_points(
    step_m: float = 0.15,
    *,
    at_m: float = 0.0,
    lean: float = 0.1,
    chamfer_m: float = 0.0,
    noise_m: float = 0.002,
    per_m: float = 300.0,
    fall: float = 0.02,
) -> tuple[Floats, Floats]:
    """Along (stations) and (n, 2) across and above, of a curb 2 m long with a face as steep."""
    random = np.random.default_rng(4)
    wide = lean * step_m
    outline = np.array(
        [
            (-0.4, -0.4 * -fall),
            (0.0, 0.0),
            (lean * (step_m - chamfer_m), step_m - chamfer_m),
            (wide + chamfer_m, step_m),
            (0.4, step_m),
        ]
    )
    lengths = np.hypot(*np.diff(outline, axis=0).T)
    ends = np.append(0.0, np.cumsum(lengths))
    positions = random.uniform(0, ends[-1], int(per_m * 2.0))
    xz = np.column_stack([np.interp(positions, ends, outline[:, k]) for k in (0, 1)])
    xz += random.normal(0, noise_m, xz.shape)
    xz[:, 0] += at_m
    return np.sort(random.uniform(0, 8, positions.size)), xz


def measured(
    points: tuple[Floats, Floats],
    width_m: float = 0.015,
    *,
    is_hidden: bool = False,
    step_m: float = 0.15,
    is_edging: bool = False,
) -> Floats:
    """What the kernel makes of the middle station."""
    measures = np.full((9, MEASURES), np.nan)
    stations = np.tile([width_m, float(is_hidden), step_m, float(is_edging)], (9, 1))
    edges_kernel(points[0], points[1], stations, WINDOW, measures)
    return np.asarray(measures[4])


@pytest.mark.parametrize("at_m", [-0.05, 0.0, 0.05])
@pytest.mark.parametrize("chamfer_m", [0.0, 0.02])
def test_edges_lie_where_the_planes_meet(at_m: float, chamfer_m: float) -> None:
    found = measured(curb_points(at_m=at_m, chamfer_m=chamfer_m))
    assert found[LOWER_ACROSS] == pytest.approx(at_m, abs=0.004)
    assert found[UPPER_ACROSS] == pytest.approx(at_m + 0.015, abs=0.004)
    assert found[LOWER_ABOVE] == pytest.approx(0.0, abs=0.003)
    assert found[UPPER_ABOVE] == pytest.approx(0.15, abs=0.003)
    assert found[FACE_POINTS] > 10


def test_a_dropped_curb_of_two_centimetres_is_measured() -> None:
    found = measured(curb_points(0.02))
    assert found[UPPER_ABOVE] - found[LOWER_ABOVE] == pytest.approx(0.02, abs=0.002)
    assert found[LOWER_ACROSS] == pytest.approx(0.0, abs=0.01)


def test_noise_of_fifteen_millimetres_costs_one_or_two_centimetres() -> None:
    found = measured(curb_points(noise_m=0.015, per_m=1000.0))
    assert found[LOWER_ACROSS] == pytest.approx(0.0, abs=0.02)
    assert found[UPPER_ABOVE] == pytest.approx(0.15, abs=0.01)


def test_grass_over_the_top_does_not_lift_the_edge() -> None:
    along, positions = curb_points()
    grass = np.column_stack([np.linspace(0.03, 0.3, 150), np.linspace(0.2, 0.35, 150)])
    order = np.argsort(np.concatenate([along, np.linspace(0, 8, 150)]), kind="stable")
    found = measured(
        (
            np.sort(np.concatenate([along, np.linspace(0, 8, 150)])),
            np.vstack([positions, grass])[order],
        )
    )
    assert found[UPPER_ABOVE] == pytest.approx(0.15, abs=0.01)


def test_the_foot_of_a_curb_behind_an_open_gutter_is_the_strip_between() -> None:
    along, positions = curb_points(fall=0.0)
    across, above = positions.T
    is_open, is_wall = (across > -0.34) & (across < -0.11), (across > -0.11) & (across < -0.08)
    random = np.random.default_rng(9)
    above = np.where(is_open, above - 0.3, above)
    above = np.where(is_wall, random.uniform(-0.3, 0.0, above.size), above)
    found = measured((along, np.column_stack([np.where(is_wall, -0.1, across), above])))
    assert found[LOWER_ABOVE] == pytest.approx(0.0, abs=0.01)
    assert found[UPPER_ABOVE] == pytest.approx(0.15, abs=0.005)
    assert found[LOWER_ACROSS] == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("seed", range(6))
def test_the_wall_of_a_gutter_does_not_draw_the_foot_down(seed: int) -> None:
    along, positions = curb_points(fall=0.0, per_m=120.0)
    random = np.random.default_rng(seed)
    # From the far side little is seen of the strip that the curb stands on, and all of the wall.
    is_strip = (positions[:, 0] > -0.09) & (positions[:, 0] < 0.0)
    is_shown = (positions[:, 0] > 0.0) | (is_strip & (random.random(along.size) < 0.8))
    wall = np.column_stack([np.full(60, -0.09), random.uniform(-0.25, 0.0, 60)])
    along = np.append(along[is_shown], random.uniform(0.0, 8.0, 60))
    order = np.argsort(along)
    found = measured((along[order], np.vstack([positions[is_shown], wall])[order]))
    assert found[LOWER_ABOVE] == pytest.approx(0.0, abs=0.01)
    assert found[LOWER_ACROSS] == pytest.approx(0.0, abs=0.01)


def test_of_a_hidden_face_the_end_of_the_top_is_the_upper_edge() -> None:
    along, positions = curb_points()
    is_top = (positions[:, 0] > 0.015) & (positions[:, 1] > 0.14)
    found = measured((along[is_top], positions[is_top]), is_hidden=True)
    assert found[UPPER_ACROSS] == pytest.approx(0.015, abs=0.015)
    assert found[UPPER_ABOVE] == pytest.approx(0.15, abs=0.005)


@pytest.mark.parametrize("at_m", [-0.06, 0.0, 0.06])
def test_a_narrow_top_with_soil_behind_it_is_told_from_the_soil(at_m: float) -> None:
    random = np.random.default_rng(6)
    top, face, soil = (random.uniform(0, 1, count) for count in (30, 30, 60))
    positions = np.vstack(
        [
            np.column_stack([at_m + 0.1 * top, np.full(30, 0.12)]),
            np.column_stack([np.full(30, at_m + 0.1), 0.11 * face]),
            np.column_stack([at_m + 0.1 + 0.3 * soil, np.full(60, 0.01)]),
        ]
    )
    positions += random.normal(0, 0.003, positions.shape)
    along = np.sort(random.uniform(2, 6, 120))
    points = (along, random.permutation(positions))
    found = measured(points, is_hidden=True, step_m=0.13, is_edging=True)
    assert found[UPPER_ACROSS] == pytest.approx(at_m, abs=0.025)
    assert found[UPPER_ABOVE] == pytest.approx(0.12, abs=0.01)


def test_a_hidden_top_of_a_pavement_may_fall_from_the_rough_height() -> None:
    """Only where the stone is narrow may its other face lie close below the top."""
    random = np.random.default_rng(7)
    across = random.uniform(0.0, 0.3, 120)
    positions = np.column_stack([across, 0.15 - 0.2 * across + random.normal(0, 0.004, 120)])
    along = np.sort(random.uniform(2, 6, 120))
    wide = measured((along, positions), is_hidden=True)
    narrow = measured((along, positions), is_hidden=True, is_edging=True)
    assert wide[UPPER_ABOVE] == pytest.approx(0.15, abs=0.01)
    assert wide[HIGH_POINTS] > narrow[HIGH_POINTS]


def test_without_points_nothing_is_measured() -> None:
    assert np.isnan(measured((np.empty(0), np.empty((0, 2))))).all()


def test_the_kernel_and_its_plain_form_agree() -> None:
    points = curb_points(per_m=60.0)
    stations = np.zeros((9, 4))
    compiled, plain = np.full((2, 9, MEASURES), np.nan)
    edges_kernel(points[0], points[1], stations, WINDOW, compiled)
    edges_kernel.py_func(points[0], points[1], stations, WINDOW, plain)  # type: ignore[attr-defined]
    np.testing.assert_allclose(compiled, plain, atol=1e-9)


def test_the_nearest_point_is_within_reach_or_none() -> None:
    along, positions = np.array([0.0, 1.0, 2.0]), np.zeros((3, 2))
    wanted = np.array([[1.1, 0.0, 0.05], [2.0, 0.3, 0.0]])
    found = np.empty(2, np.int64)
    nearest_kernel(along, positions, wanted, 0.15, found)
    assert found.tolist() == [1, -1]


def test_behind_the_end_of_a_curb_no_longer_window_finds_it_again() -> None:
    along, points = curb_points(per_m=60.0)
    ahead = np.linspace(8.0, 20.0, 90)
    level = np.column_stack([np.linspace(-0.4, 0.4, 90), np.zeros(90)])
    measures = np.full((18, MEASURES), np.nan)
    stations = np.tile([0.015, 0.0, 0.15, 0.0], (18, 1))
    everything = np.concatenate([along, ahead]), np.vstack([points, level])
    edges_kernel(*everything, stations, WINDOW, measures)
    assert measures[4, FACE_POINTS] > 3
    assert not (measures[11:, FACE_POINTS] > 0).any()
