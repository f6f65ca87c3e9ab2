"""Plates that are passed fast or seen askew: points hang together, lines are linked."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.signs.link_kernels import link_kernel
from processing.methods.road.signs.piece_kernels import (
    BRIGHT,
    COUNT,
    DULL,
    FROM,
    PIECE,
    TO,
    VIEW,
    ChunkPoints,
    PieceLimits,
    runs_kernel,
)

PULSES = 5_000
LIMITS = PieceLimits(
    1.0, 2 * np.pi / PULSES, 0.012, 0.07, 6.0, has_origin=True, usual_m=10.0
)  # fmt: skip


def runs_of(steps_m: list[float], kind: int) -> list[int]:
    """Of points 5 m from the scanner and more, so far one behind the other along its ray."""
    local = np.zeros((len(steps_m) + 1, 3))
    local[1:, 0] = np.cumsum(steps_m)
    local[:, 0] += 5.0
    count = len(local)
    chunk = ChunkPoints(
        local, np.arange(count), np.zeros(count, np.bool_), np.zeros(count, np.uint16),
        np.zeros((1, 3)),
    )  # fmt: skip
    runs = np.empty(count, np.int32)
    runs_kernel(chunk, np.full(count, kind, np.uint8), LIMITS, runs)
    found: list[int] = runs.tolist()
    return found


def test_a_face_seen_under_85_degrees_is_one_run() -> None:
    assert runs_of([0.07, 0.08, 0.09, 0.10], BRIGHT) == [0] * 5


def test_dull_points_as_far_apart_are_one_run_where_they_follow_evenly() -> None:
    assert runs_of([0.07, 0.072, 0.075, 0.077], DULL) == [0] * 5
    assert runs_of([0.07, 0.15, 0.09, 0.2], DULL) == [0, 1, 2, 3, 4]


def test_what_lies_far_behind_a_face_is_none_of_it() -> None:
    assert runs_of([0.07, 0.6], BRIGHT) == [0, 0, 1]


def two_lines(apart_m: float, way_m: float) -> list[int]:
    """Groups of two level lines on a plate that looks along the road, seen from beside it.

    The scanner's plane stands askew to the road by 45 degrees, so a line moves on the plate by what
    the vehicle goes.
    """
    values = np.zeros((2, PIECE))
    for number in range(2):
        values[number, FROM : FROM + 3] = [0.0, 0.0, number * apart_m]
        values[number, TO : TO + 3] = values[number, FROM : FROM + 3] + [0.0, 0.4, 0.0]
        values[number, VIEW : VIEW + 3] = [np.sqrt(0.5), 0.0, -np.sqrt(0.5)]
    values[:, COUNT] = 10
    groups = np.empty(2, np.int64)
    ways: Floats = np.tile([way_m, 0.0, 0.0], (2, 1))
    link_kernel(values, np.arange(2), np.ones(2, np.bool_), ways, groups)
    found: list[int] = groups.tolist()
    return found


def test_lines_of_one_plate_are_linked_however_fast_the_vehicle_went() -> None:
    assert two_lines(0.28, way_m=0.28) == [0, 0]


def test_lines_farther_apart_than_the_vehicle_went_are_of_two_things() -> None:
    assert two_lines(0.5, way_m=0.1) == [0, 1]


def test_lines_are_linked_where_nobody_knows_the_speed() -> None:
    assert two_lines(0.28, way_m=np.nan) == [0, 0]
