"""Points without company, on rows of beams whose truth is known by construction."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.noise.beams import closed_surfaces as closed
from processing.methods.noise.beams import lone_points as lone
from processing.methods.noise.beams.beam_kernels import PointBeams, spacing_kernel
from processing.methods.noise.combined import noise_codes_with_beams

_ROWS, _COLUMNS, _STEP_RAD, _HIGH_M = 60, 400, 0.004, 2.5


def rows_over_a_road(along_m: float = 0.05) -> tuple[PointBeams, NDArray[np.int64]]:
    """Upright rows of a scanner that goes along x over level ground; the grid of points."""
    angles = (np.arange(_COLUMNS) - _COLUMNS / 2) * _STEP_RAD
    grid = np.arange(_ROWS * _COLUMNS).reshape(_ROWS, _COLUMNS)
    origins = np.zeros((grid.size, 3))
    origins[:, 0] = np.repeat(np.arange(_ROWS) * along_m, _COLUMNS)
    ranges = np.tile(_HIGH_M / np.cos(angles), _ROWS)
    beams = PointBeams(
        np.empty((grid.size, 3)),
        origins,
        ranges,
        np.tile(np.arange(_COLUMNS, dtype=np.int32), _ROWS),
        np.arange(_ROWS + 1) * _COLUMNS,
        np.zeros(_ROWS, np.int32),
        _STEP_RAD,
    )
    place(beams)
    return beams, grid


def place(beams: PointBeams) -> None:
    """Points at their ranges along their beams."""
    angles = (beams.columns - _COLUMNS / 2) * _STEP_RAD
    beams.xyz[:, 0] = beams.origins[:, 0]
    beams.xyz[:, 1] = beams.ranges * np.sin(angles)
    beams.xyz[:, 2] = -beams.ranges * np.cos(angles)


def found_in(beams: PointBeams, strictness: float = 0.5) -> NDArray[np.bool_]:
    spacings = np.empty(beams.ranges.size)
    spacing_kernel(beams, 0, _ROWS, spacings)
    points = np.arange(beams.ranges.size)
    rows = np.repeat(np.arange(_ROWS), _COLUMNS)
    return lone.lone_points(beams, spacings, points, rows, strictness, monitor=SilentMonitor())


def test_a_drop_and_an_echo_below_the_road_stand_alone_and_a_wire_does_not() -> None:
    beams, grid = rows_over_a_road()
    drop, echo, wire = grid[20, 150], grid[40, 230], grid[:, 300]
    beams.ranges[drop] *= 0.4
    beams.ranges[echo] += 0.4
    beams.ranges[wire] = 1.2  # one pulse of every row
    place(beams)
    found = found_in(beams)
    assert set(np.flatnonzero(found).tolist()) == {drop, echo}


def test_a_wire_across_the_road_keeps_the_single_pulses_of_its_rows() -> None:
    beams, grid = rows_over_a_road()
    for row in range(_ROWS):  # runs at 45°: as far aside as along
        beams.ranges[grid[row, 100 + 6 * row if row < 45 else 0]] = 1.4
    place(beams)
    assert not found_in(beams).any()


def test_stricter_asks_for_nearer_company() -> None:
    beams, grid = rows_over_a_road()
    beams.ranges[grid[30, 200]] -= 0.15  # three spacings over the road
    place(beams)
    assert found_in(beams).any()
    assert not found_in(beams, strictness=0.0).any()


def test_a_recording_with_a_single_false_point_loses_it() -> None:
    beams, grid = rows_over_a_road()
    drop = grid[30, 180]
    beams.ranges[drop] *= 0.5
    place(beams)
    codes = noise_codes_with_beams(beams, np.full(grid.size, 1000, np.uint16))
    assert np.flatnonzero(codes).tolist() == [drop]
    assert codes[drop] == 18


@pytest.mark.parametrize("is_compiled", [True, False])
def test_what_lies_just_below_a_road_is_no_part_of_it_and_a_joint_is(is_compiled: bool) -> None:
    """Millimetres of noise on the road; a lone echo 10 cm behind it, and a joint 3 cm deep."""
    beams, grid = rows_over_a_road()
    beams.ranges[:] += np.random.default_rng(3).normal(0, 0.003, beams.ranges.size)
    echo, joint = grid[30, 180], grid[20:40, 240]
    beams.ranges[echo] += 0.10
    beams.ranges[joint] += 0.03
    place(beams)
    points, fitted = np.arange(grid.size), np.empty((40, 6))
    kernel = closed.off_surface if is_compiled else closed.off_surface.py_func
    asked = points if is_compiled else np.append(grid[28:32, 176:184].ravel(), joint)
    said = [kernel(beams, int(point), int(point) // _COLUMNS, fitted) for point in asked]
    assert asked[np.array(said) != closed.ON_SURFACE].tolist() == [echo]
    assert said[asked.tolist().index(echo)] == closed.BELOW_SURFACE
    assert np.flatnonzero(found_in(beams)).tolist() == [echo]


def test_a_point_seen_through_a_window_is_kept() -> None:
    """The road stands upright here: a wall beside the scanner, a room behind it."""
    beams, grid = rows_over_a_road()
    beams.ranges[grid[30, 180]] += 0.6
    place(beams)
    upright = beams._replace(
        xyz=beams.xyz[:, [0, 2, 1]].copy(), origins=beams.origins[:, [0, 2, 1]].copy()
    )
    assert found_in(beams).sum() == 1
    assert not closed_codes(upright).any()


def closed_codes(beams: PointBeams) -> NDArray[np.uint8]:
    found = np.empty(beams.ranges.size, np.uint8)
    rows = np.repeat(np.arange(_ROWS), _COLUMNS)
    closed.off_surfaces_kernel(beams, np.arange(beams.ranges.size), rows, found)
    return found


def test_a_range_between_an_edge_and_what_is_behind_it_is_alone_and_a_leaf_is_not() -> None:
    """A crown over the road: leaves in clumps of four beams; ranges between them and the road."""
    beams, grid = rows_over_a_road()
    random = np.random.default_rng(5)
    crown = grid[10:50, 100:300]
    for row, column in zip(range(0, 40, 4), range(0, 200, 20), strict=True):
        clump = crown[row : row + 2, column : column + 2]
        beams.ranges[clump] = 1.2 + random.uniform(-0.02, 0.02, clump.shape)
    between = crown[20, 102]  # beside a clump, and half-way to the road
    beams.ranges[between] = 1.9
    place(beams)
    assert np.flatnonzero(found_in(beams)).tolist() == [between]


@pytest.mark.parametrize("is_compiled", [True, False])
def test_company_is_as_far_as_every_distance_says(is_compiled: bool) -> None:
    beams, grid = rows_over_a_road()
    beams.ranges[grid[30, 200]] *= 0.6
    beams.ranges[grid[31, 203]] *= 0.63
    place(beams)
    points = grid[28:33, 198:205].ravel()
    away = np.linalg.norm(beams.xyz[points, None] - beams.xyz[None], axis=2)
    away[np.arange(points.size), points] = np.inf
    rows = points // _COLUMNS
    away[np.abs(np.arange(grid.size) // _COLUMNS - rows[:, None]) > 5] = np.inf
    kernel = lone._is_accompanied if is_compiled else lone._is_accompanied.py_func
    for limit in (0.02, 0.06, 0.3, 1.0):
        said = [
            bool(kernel(beams, int(point), int(row), 5, limit))
            for point, row in zip(points, rows, strict=True)
        ]
        assert said == (away.min(axis=1) <= limit).tolist()
