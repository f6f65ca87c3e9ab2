"""Feet of walls, retaining walls and faces of buildings beside a road that is known exactly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.simulate.scene.mesh import TriangleShape
from processing.methods.road.objects import drive_chunks
from processing.methods.road.requested_position import RequestedPosition
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.road_map.walls import WallParameters, diagnose_walls, find_walls
from processing.tools.tool import Candidate
from tests.monitors import CancelledAfter
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    Floats,
    RoadCrossSection,
    RunOutcome,
    delivered,
    drawn_along,
    facing_along,
    imported,
    road_along,
    straight,
    told_by,
    told_of,
)

LENGTH_M = 26.0
GROUND_M = 0.15
WALL_M, HIGH_M = 6.0, 1.6
GATE_M = (11.0, 14.0)
FACE_M = -7.0

LAND: RoadCrossSection = (
    (-14.0, GROUND_M), (-4.02, GROUND_M), (-4.0, 0.0),
    (4.0, 0.0), (4.02, GROUND_M), (14.0, GROUND_M),
)  # fmt: skip
WALL: RoadCrossSection = (
    (WALL_M, 0.0),
    (WALL_M, GROUND_M + HIGH_M),
    (WALL_M + 0.15, GROUND_M + HIGH_M),
    (WALL_M + 0.15, 0.0),
)
HOUSE: RoadCrossSection = ((FACE_M, 0.0), (FACE_M, 6.0))
SLOPING: RoadCrossSection = ((WALL_M, GROUND_M), (WALL_M + 0.3, GROUND_M + 1.5), (14.0, 1.7))
SHEET: RoadCrossSection = ((WALL_M, 0.2), (WALL_M, GROUND_M + HIGH_M))


def swept(profile: RoadCrossSection, low: float, high: float) -> TriangleShape:
    return drawn_along(profile, np.array([[low, 0.0], [high, 0.0]]))


BESIDE = (swept(HOUSE, 4.0, 16.0), swept(WALL, -20.0, GATE_M[0]), swept(WALL, GATE_M[1], 50.0))


def driven(*shapes: TriangleShape) -> DrivenRecording:
    way = straight(LENGTH_M)
    scene = (road_along(LENGTH_M, LAND), *shapes)
    return DrivenRecording(way, facing_along(way), scene, head=HEAD_45, pulses=2_000)


def both_heads(folder: Path, recording: DrivenRecording) -> tuple[Drive, ...]:
    """One head looks to the left, the other to the right."""
    right = replace(HEAD_45, name="right", source_id=2, yaw_deg=-HEAD_45.yaw_deg)
    return imported(
        folder,
        delivered(recording, folder),
        delivered(replace(recording, head=right), folder, "right"),
    )


def local(one: Candidate) -> Floats:
    return np.asarray(one.xyz - ORIGIN)


def number(one: Candidate, name: str) -> float:
    value = one.attributes[name]
    assert isinstance(value, float | int)
    return float(value)


def of_kind(told: RunOutcome, kind: str) -> list[Candidate]:
    """Along the road, from west to east."""
    found = [one for one in told.candidates if one.kind == kind]
    return sorted(found, key=lambda one: float(local(one)[:, 0].mean()))


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    return both_heads(tmp_path_factory.mktemp("walls"), driven(*BESIDE))


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("walls", drives, tmp_path_factory.mktemp("columns"))


def test_the_foot_of_a_wall_lies_where_it_meets_the_ground_before_it(told: RunOutcome) -> None:
    walls = of_kind(told, "wall")
    assert len(walls) == 2
    for one in walls:
        assert np.abs(local(one)[:, 1] - WALL_M).max() < 0.01
        assert np.abs(local(one)[:, 2] - GROUND_M).max() < 0.02
        assert number(one, "height_m") == pytest.approx(HIGH_M, abs=0.05)
        assert number(one, "top_m") == pytest.approx(ORIGIN[2] + GROUND_M + HIGH_M, abs=0.05)
        assert one.attributes["type"] == "wall"
        assert one.confidence > 0.8


def test_a_gate_parts_a_wall_and_is_told_with_its_width(told: RunOutcome) -> None:
    west, east = of_kind(told, "wall")
    assert local(west)[:, 0].max() == pytest.approx(GATE_M[0], abs=0.1)
    assert local(east)[:, 0].min() == pytest.approx(GATE_M[1], abs=0.1)
    for one in (west, east):
        names = ("opening_before_m", "opening_after_m")
        (width,) = [number(one, name) for name in names if name in one.attributes]
        assert width == pytest.approx(GATE_M[1] - GATE_M[0], abs=0.2)
    assert west.attributes["run"] == east.attributes["run"]


def test_the_face_of_a_building_lies_at_the_height_that_was_asked_for(
    drives: tuple[Drive, ...], told: RunOutcome
) -> None:
    (face,) = of_kind(told, "building_face")
    along, north, high = local(face).T
    assert sorted((along[0], along[-1])) == pytest.approx([4.0, 16.0], abs=0.1)
    assert np.abs(north - FACE_M).max() < 0.01
    assert np.abs(high - GROUND_M - 1.0).max() < 0.03
    again = find_walls(drives, WallParameters(face_height_m=1.5), SilentMonitor())
    (face,) = [one for one in again.candidates if one.kind == "building_face"]
    assert np.abs(local(face)[:, 2] - GROUND_M - 1.5).max() < 0.03


def test_nothing_else_is_found(told: RunOutcome) -> None:
    assert len(told.candidates) == 3


def test_a_wall_that_leans_back_holds_the_ground_behind_it(tmp_path: Path) -> None:
    told = told_of("walls", delivered(driven(swept(SLOPING, -20.0, 50.0)), tmp_path), tmp_path)
    (wall,) = told.candidates
    assert wall.kind == "revetment_concrete"
    assert wall.attributes["type"] == "retaining"
    assert np.abs(local(wall)[:, 1] - WALL_M).max() < 0.02
    assert number(wall, "height_m") == pytest.approx(1.5, abs=0.1)


def hidden(xyz: Floats, _: object) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Nothing of what lies behind a car."""
    return np.asarray((xyz[:, 1] < 5.0) | (xyz[:, 0] < 9.0) | (xyz[:, 0] > 12.0))


def test_a_wall_goes_on_behind_what_hides_it_and_that_is_told(tmp_path: Path) -> None:
    recording = replace(driven(swept(WALL, -20.0, 50.0)), keep=hidden)
    told = told_of("walls", delivered(recording, tmp_path), tmp_path)
    (wall,) = told.candidates
    assert number(wall, "hidden_m") == pytest.approx(3.0, abs=0.4)
    assert np.abs(local(wall)[:, 1] - WALL_M).max() < 0.01


def test_a_fence_that_one_looks_through_is_no_wall(tmp_path: Path) -> None:
    bars = [swept(SHEET, at, at + 0.03) for at in np.arange(-3.0, LENGTH_M + 3.0, 0.08).tolist()]
    told = told_of("walls", delivered(driven(*bars), tmp_path), tmp_path)
    assert told.candidates == ()
    assert "likely enough" in told.sentence


def test_walls_of_a_drive_read_in_parts_are_the_same(
    drives: tuple[Drive, ...], told: RunOutcome, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drive_chunks, "_POINTS_AT_ONCE", 40_001)
    again = told_by("walls", tuple(Drive(one.folder) for one in drives), tmp_path)
    assert len(again.candidates) == len(told.candidates)
    for one, other in zip(again.candidates, told.candidates, strict=True):
        np.testing.assert_array_equal(one.xyz, other.xyz)
        np.testing.assert_array_equal(one.points, other.points)
        assert one.attributes == other.attributes


def test_without_a_trajectory_walls_are_found_and_it_is_told(tmp_path: Path) -> None:
    request: ImportRequest = replace(delivered(driven(*BESIDE), tmp_path), trajectories=())
    told = told_of("walls", request, tmp_path)
    walls = of_kind(told, "wall")
    assert walls
    assert max(np.abs(local(one)[:, 1] - WALL_M).max() for one in walls) < 0.02
    assert "Without a trajectory" in told.sentence


def test_a_road_with_nothing_beside_it_is_told(tmp_path: Path) -> None:
    told = told_of("walls", delivered(driven(), tmp_path), tmp_path)
    assert told.candidates == ()
    assert "Nothing upright" in told.sentence


def test_a_search_that_is_cancelled_ends_at_once(drives: tuple[Drive, ...]) -> None:
    with pytest.raises(Cancelled):
        find_walls(drives, WallParameters(), CancelledAfter(6))


def test_a_section_shows_the_strip_of_each_face_and_what_decided(
    drives: tuple[Drive, ...],
) -> None:
    xyz = ORIGIN + np.array([8.0, WALL_M, 1.0])
    scanlines = scanline_through(drives[0], xyz, ScanlineSettings())
    assert scanlines is not None
    found = diagnose_walls(RequestedPosition(drives[0], xyz, scanlines), WallParameters())
    wall = min(found, key=lambda one: abs(float(one.xyz[1] - xyz[1])))
    assert wall.is_taken
    np.testing.assert_allclose(wall.xyz - ORIGIN, [8.0, WALL_M, GROUND_M], atol=0.03)
    assert wall.outline is not None
    assert np.ptp(wall.outline[:, 2]) == pytest.approx(HIGH_M, abs=0.05)
    assert wall.points is not None
    assert len(wall.points) > 50


def all_noise(cloud: laspy.LasData) -> None:
    cloud.classification = np.full(len(cloud.x), 7, np.uint8)


def one_height(cloud: laspy.LasData) -> None:
    cloud.z = np.full(len(cloud.x), ORIGIN[2])


@pytest.mark.parametrize("change", [all_noise, one_height])
def test_recordings_without_any_face_are_told(
    tmp_path: Path, change: Callable[[laspy.LasData], None]
) -> None:
    request = delivered(driven(*BESIDE), tmp_path)
    cloud = laspy.read(request.inputs[0])
    change(cloud)
    cloud.write(str(request.inputs[0]))
    told = told_of("walls", request, tmp_path)
    assert told.candidates == ()
    assert "Nothing upright" in told.sentence


def test_a_noisy_recording_shows_the_same_walls(tmp_path: Path) -> None:
    recording = replace(driven(*BESIDE), noise_m=0.02)
    told = told_of("walls", delivered(recording, tmp_path), tmp_path)
    walls = of_kind(told, "wall")
    assert len(walls) == 2
    assert max(np.abs(local(one)[:, 1] - WALL_M).max() for one in walls) < 0.03
