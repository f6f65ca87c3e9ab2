"""Gratings among notches whose rectangle is known."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from processing.methods.road.gutters.grating_facts import GratingFound, one_of_each
from processing.methods.road.gutters.gratings import GratingParameters, gratings_among
from processing.methods.road.gutters.notches.notches import OPENING, Notches
from processing.recording.passes import Pass, passes_of_trajectory
from processing.recording.vehicle_path.trajectory import Trajectory

SPEED_M_S, ROWS_PER_S = 11.1, 100.0
CORNERS = ((4.0, 3.0), (4.5, 3.4))


def way_east() -> Pass:
    """A straight drive along x."""
    times = np.arange(0.0, 3.0, 0.01)
    xyz = np.column_stack([SPEED_M_S * times, np.zeros_like(times), np.full_like(times, 2.0)])
    return passes_of_trajectory(Trajectory.from_positions(times, xyz))[0]


def notches_at(x: np.ndarray, across: np.ndarray, *, width_m: float = 0.03) -> Notches:
    """Openings of rows at 45 degrees that pass the places."""
    row = np.round((x - across) / (SPEED_M_S / ROWS_PER_S)).astype(np.int64)
    order = np.argsort(row, kind="stable")
    x, across, row = x[order], across[order], row[order]
    count = len(x)
    return Notches(
        np.column_stack([x, -across, 0.02 * across]),
        time_s=row / ROWS_PER_S,
        depth_m=np.full(count, 0.05),
        width_m=np.full(count, width_m),
        spacing_m=np.full(count, 0.01),
        steepness=np.full(count, 0.5),
        pattern=np.full(count, OPENING, np.uint8),
        strength=np.full(count, 0.9),
        row=row,
        point=np.arange(count),
        station_m=x,
        across_m=across,
        pass_number=np.zeros(count, np.int64),
        direction=np.tile(np.array([1.0, -1.0]) / np.sqrt(2.0), (count, 1)),
        area_m2=np.full(count, width_m * SPEED_M_S / ROWS_PER_S / np.sqrt(2.0)),
        raised_m=0.02 * across,
    )


def openings_of_a_grating() -> tuple[np.ndarray, np.ndarray]:
    """Where rows 0.111 m apart pass between bars 0.06 m apart."""
    (x0, y0), (x1, y1) = CORNERS
    positions = []
    for middle in np.arange(x0 + 0.02, x1, 0.04):
        for row in range(100):
            across = middle - row * SPEED_M_S / ROWS_PER_S
            if y0 < across < y1:
                positions.append((middle, across))
    found = np.array(positions)
    return found[:, 0], found[:, 1]


def found_by(notches: Notches) -> tuple[GratingFound, ...]:
    return gratings_among(notches, (way_east(),), GratingParameters())


def test_a_grating_has_its_place_and_size() -> None:
    found = found_by(notches_at(*openings_of_a_grating()))

    assert len(found) == 1
    one = found[0]
    assert one.length_m == pytest.approx(0.5, abs=0.06)
    assert one.width_m == pytest.approx(0.4, abs=0.06)
    assert one.corners[:, :2].mean(axis=0) == pytest.approx([4.25, -3.2], abs=0.02)
    assert one.corners[:, 2] == pytest.approx(-0.02 * one.corners[:, 1], abs=1e-6)
    assert one.confidence > 0.8


def test_a_slow_vehicle_makes_a_grating_no_surer_that_is_none() -> None:
    random = np.random.default_rng(1)
    x, across = random.uniform(0.5, 10.0, 1200), random.uniform(1.0, 4.0, 1200)
    slow = notches_at(x, across)
    # Each place measured by four rows that stand for a quarter of the way.
    often = Notches(
        **{f.name: np.repeat(getattr(slow, f.name), 4, axis=0) for f in fields(slow)}
        | {"area_m2": np.repeat(slow.area_m2 / 4, 4), "row": np.arange(4 * slow.count)}
    )

    assert all(one.confidence < 0.5 for one in (*found_by(slow), *found_by(often)))


def test_the_holes_of_lids_are_no_grating() -> None:
    joints = np.repeat(np.arange(1.0, 20.0, 0.6), 6)
    across = np.tile([3.05, 3.08, 3.11, 3.25, 3.28, 3.31], len(joints) // 6)

    assert not found_by(notches_at(joints, across))


def test_gravel_without_an_edge_is_less_sure() -> None:
    random = np.random.default_rng(0)
    x, across = random.uniform(3.0, 5.0, 600), random.uniform(2.5, 4.0, 600)

    assert not found_by(notches_at(x, across))


def test_without_notches_there_are_no_gratings() -> None:
    assert not found_by(notches_at(np.empty(0), np.empty(0)))


def test_a_grating_that_two_heads_saw_is_one() -> None:
    (one,) = found_by(notches_at(*openings_of_a_grating()))
    seen_in_part = replace(one, corners=one.corners[[0, 1, 1, 0]], confidence=one.confidence / 2)
    seen_in_part.corners[2:] += (one.corners[2:] - one.corners[[1, 0]]) / 2
    far = replace(one, corners=one.corners + np.array([2.0, 0.0, 0.0]))

    assert one_of_each([seen_in_part, one, far]) == (one, far)
