"""Barriers: a guard rail, a guard pipe, a house and a vehicle beside a road of known measures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.simulate.border.along import posts
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, tube
from processing.methods.road.barriers.street_barriers import street_barriers
from processing.methods.road.objects import drive_chunks
from processing.methods.road.requested_position import RequestedPosition
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.road_map.barriers import (
    BarrierParameters,
    diagnose_barriers,
    find_barriers,
)
from processing.tools.tool import Candidate
from tests.monitors import CancelledAfter
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    Floats,
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

LENGTH_M = 36.0
ENDS_M = (8.0, 30.0)
RAIL_M, PIPES_M = -4.8, 4.9
POSTS_M = 2.0
TOP_M, GROUND_M = 0.78, 0.155
BEAM = ((0.07, 0.43), (0.15, 0.5), (0.085, 0.6), (0.15, 0.7), (0.07, TOP_M))
HOUSE = ((9.0, 0.0), (9.0, 7.0))


def _sheet(profile: tuple[tuple[float, float], ...], aside_m: float) -> TriangleShape:
    line = np.array([[one, aside_m] for one in ENDS_M])
    return drawn_along(tuple((across, up + GROUND_M) for across, up in profile), line)


def _posts(aside_m: float, radius_m: float, high_m: float) -> TriangleShape:
    at = np.arange(ENDS_M[0], ENDS_M[1] + 0.1, POSTS_M)
    feet = np.column_stack([at, np.full_like(at, aside_m), np.full_like(at, GROUND_M)])
    return posts(feet, radius_m, high_m)


def _pipe(aside_m: float, high_m: float) -> TriangleShape:
    path = np.array([[one, aside_m, GROUND_M + high_m] for one in np.linspace(*ENDS_M, 15)])
    return tube(path, np.full(15, 0.025), 8)


THINGS = (
    _sheet(BEAM, RAIL_M),
    _posts(RAIL_M, 0.06, 0.75),
    *(_pipe(PIPES_M, high) for high in (0.3, 0.6, 0.9)),
    _posts(PIPES_M, 0.035, 0.92),
    _sheet(HOUSE, 0.0),
    box((12.0, -8.6, 0.5), (16.2, -6.9, 1.5)),
)


def delivery(folder: Path, things: tuple[TriangleShape, ...] = THINGS) -> ImportRequest:
    """The road as it is delivered, with things beside it."""
    way = straight(LENGTH_M)
    scene = (road_along(LENGTH_M), *things)
    driven = DrivenRecording(way, facing_along(way), scene, head=HEAD_45, pulses=2_500)
    return delivered(driven, folder)


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("barriers")
    return imported(folder, delivery(folder))


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("barriers", drives, tmp_path_factory.mktemp("columns"))


def local(one: Candidate) -> Floats:
    return np.asarray(one.xyz - ORIGIN)


def measure(one: Candidate, name: str) -> float:
    value = one.attributes[name]
    assert isinstance(value, float | int)
    return float(value)


def assert_barrier(told: RunOutcome, type_: str, aside_m: float, top_m: float) -> None:
    """One of a type, whole, on its foot, as high as it is."""
    (one,) = [one for one in told.candidates if one.attributes["type"] == type_]
    along, north, high = local(one).T
    assert one.kind == type_
    assert sorted((along[0], along[-1])) == pytest.approx(ENDS_M, abs=0.4)
    assert np.abs(north - aside_m).max() < 0.06
    assert np.abs(high - GROUND_M).max() < 0.05
    assert measure(one, "height_m") == pytest.approx(top_m, abs=0.05)
    assert measure(one, "length_m") == pytest.approx(np.ptp(ENDS_M), abs=0.6)


def test_a_guard_rail_is_the_line_of_its_posts(told: RunOutcome) -> None:
    assert_barrier(told, "guard_rail", RAIL_M, TOP_M)


def test_a_guard_pipe_is_told_by_its_rails(told: RunOutcome) -> None:
    assert_barrier(told, "guard_pipe", PIPES_M, 0.925)


def test_posts_are_as_far_apart_as_they_stand(told: RunOutcome) -> None:
    (one,) = [one for one in told.candidates if one.attributes["type"] == "guard_pipe"]
    assert measure(one, "posts_m") == pytest.approx(POSTS_M, abs=0.1)


def test_neither_the_house_nor_the_vehicle_is_a_barrier(told: RunOutcome) -> None:
    assert len(told.candidates) == 2
    assert all(one.confidence >= 0.5 for one in told.candidates)


@pytest.mark.parametrize("aside_m", [RAIL_M, PIPES_M])
def test_a_section_tells_the_band_of_a_barrier(drives: tuple[Drive, ...], aside_m: float) -> None:
    place = np.array([18.0, aside_m + 0.1, GROUND_M + 0.5]) + ORIGIN
    scanlines = scanline_through(drives[0], place, ScanlineSettings())
    assert scanlines is not None
    asked = RequestedPosition(drives[0], place, scanlines)
    (told,) = diagnose_barriers(asked, BarrierParameters())
    assert told.is_taken
    assert abs(told.xyz[1] - ORIGIN[1] - aside_m) < 0.2
    top_m = TOP_M if aside_m == RAIL_M else 0.925
    assert told.outcomes[0].value == pytest.approx(top_m, abs=0.1)
    assert told.points is not None
    assert len(told.points) > 50


def test_a_section_through_the_road_tells_no_barrier(drives: tuple[Drive, ...]) -> None:
    place = np.array([18.0, 1.0, 0.5]) + ORIGIN
    scanlines = scanline_through(drives[0], place, ScanlineSettings())
    assert scanlines is not None
    told = diagnose_barriers(RequestedPosition(drives[0], place, scanlines), BarrierParameters())
    assert not any(one.is_taken for one in told)


def test_barriers_of_a_drive_read_in_parts_are_the_same(
    drives: tuple[Drive, ...],
    told: RunOutcome,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(drive_chunks, "_POINTS_AT_ONCE", 40_001)
    again = told_by("barriers", tuple(Drive(one.folder) for one in drives), tmp_path)
    assert len(again.candidates) == len(told.candidates)
    for one, other in zip(again.candidates, told.candidates, strict=True):
        np.testing.assert_array_equal(one.xyz, other.xyz)
        assert one.attributes == other.attributes


def test_without_a_trajectory_barriers_are_found_and_it_is_told(tmp_path: Path) -> None:
    request = replace(delivery(tmp_path), trajectories=())
    told = told_of("barriers", request, tmp_path)
    assert_barrier(told, "guard_pipe", PIPES_M, 0.925)
    assert "Without a trajectory" in told.sentence


def test_a_road_without_barriers_is_told(tmp_path: Path) -> None:
    told = told_of("barriers", delivery(tmp_path, ()), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


def test_a_cancelled_search_stops(drives: tuple[Drive, ...]) -> None:
    fresh = tuple(Drive(one.folder) for one in drives)
    with pytest.raises(Cancelled):
        street_barriers(fresh, CancelledAfter(3))


def test_nothing_is_found_without_points_and_it_is_told() -> None:
    found = find_barriers((), BarrierParameters(), CancelledAfter(1_000))
    assert found.candidates == ()
    assert found.note.en == "The drive has no points."
