"""Poles and wires where a recording lacks something: what can be had, and what is said of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.laboratory.simulate.scene.mesh import TriangleShape, tube
from processing.project.importing.importing import ImportRequest
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    Floats,
    RunOutcome,
    delivered,
    facing_along,
    road_along,
    straight,
    told_of,
)

LENGTH_M = 24.0
POLE = np.array([12.0, 5.2, 0.16])
WIRE_HIGH_M, SAG_M = 7.0, 0.4
BOTH = pytest.mark.parametrize("tool", ["poles", "wires"])


def wire() -> Floats:
    """A wire along the road over the pole's foot, from before the road to behind it."""
    along = np.linspace(-10.0, 34.0, 45)
    high = WIRE_HIGH_M - SAG_M * (1.0 - ((along - 12.0) / 22.0) ** 2)
    return np.column_stack([along, np.full(45, POLE[1] - 0.4), high])


def street() -> tuple[TriangleShape, ...]:
    up = np.linspace(-0.3, 8.5, 4)
    pole = POLE + np.column_stack([0 * up, 0 * up, up])
    return (
        road_along(LENGTH_M),
        tube(pole, 0.15 - up / 150, 32),
        tube(wire(), np.full(45, 0.011), 8),
    )


def delivery(folder: Path, change: Callable[[laspy.LasData], None] | None = None) -> ImportRequest:
    """The street as it is delivered, with something about its points changed."""
    way = straight(LENGTH_M)
    driven = DrivenRecording(way, facing_along(way), street(), head=HEAD_45, pulses=2_000)
    request = delivered(driven, folder)
    if change is not None:
        cloud = laspy.read(request.inputs[0])
        change(cloud)
        cloud.write(str(request.inputs[0]))
    return request


def assert_found(told: RunOutcome, tool: str) -> None:
    """The one pole, or the one wire, at its place."""
    assert len(told.candidates) == 1
    (found,) = told.candidates
    if tool == "poles":
        assert math.dist(found.xyz[0], POLE + ORIGIN) < 0.05
    else:
        path = wire() + ORIGIN
        off = np.hypot(
            found.xyz[:, 1] - path[0, 1],
            found.xyz[:, 2] - np.interp(found.xyz[:, 0], path[:, 0], path[:, 2]),
        )
        assert off.max() < 0.05


def without_intensity(cloud: laspy.LasData) -> None:
    cloud.intensity = np.zeros(len(cloud.x), np.uint16)


def without_times(cloud: laspy.LasData) -> None:
    cloud.gps_time = np.zeros(len(cloud.x))


@BOTH
def test_without_intensity_they_are_found_all_the_same(tmp_path: Path, tool: str) -> None:
    assert_found(told_of(tool, delivery(tmp_path, without_intensity), tmp_path), tool)


@BOTH
def test_without_a_trajectory_they_are_found_all_the_same(tmp_path: Path, tool: str) -> None:
    request = replace(delivery(tmp_path), trajectories=())
    told = told_of(tool, request, tmp_path)
    assert_found(told, tool)
    assert ("Without a trajectory" in told.sentence) == (tool == "wires")


@BOTH
def test_without_times_they_are_found_by_the_order_of_the_points(tmp_path: Path, tool: str) -> None:
    request = replace(delivery(tmp_path, without_times), trajectories=())
    assert_found(told_of(tool, request, tmp_path), tool)


@BOTH
def test_ten_points_are_told_to_be_too_few(tmp_path: Path, tool: str) -> None:
    way = straight(LENGTH_M)
    few = DrivenRecording(
        way,
        facing_along(way),
        street(),
        keep=lambda _, pulse: pulse < np.sort(pulse)[10],
    )
    told = told_of(tool, delivered(few, tmp_path), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


@BOTH
def test_points_far_below_and_above_are_not_followed(tmp_path: Path, tool: str) -> None:
    def with_outliers(cloud: laspy.LasData) -> None:
        high = np.asarray(cloud.z).copy()
        high[:: len(high) // 20] += 500.0
        high[7 :: len(high) // 20] -= 80.0
        cloud.z = high

    assert_found(told_of(tool, delivery(tmp_path, with_outliers), tmp_path), tool)
