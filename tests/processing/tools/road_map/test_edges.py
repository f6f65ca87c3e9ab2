"""Edges of a carriageway that no curb ends: a bright walk at its height, and rough soil."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.methods.road.edges.edge_courses import _without_entrances
from processing.methods.road.objects import drive_chunks
from processing.methods.road.requested_position import RequestedPosition
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.road_map.edges import EdgeParameters, diagnose_edges, find_edges
from processing.tools.tool import Candidate
from tests.monitors import CancelledAfter
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    HIGH_M,
    ORIGIN,
    DrivenRecording,
    Floats,
    RoadCrossSection,
    RunOutcome,
    delivered,
    facing_along,
    imported,
    road_along,
    straight,
    told_by,
    told_of,
)

LENGTH_M = 30.0
WALK_M, SOIL_M = 3.6, -3.1
LAND: RoadCrossSection = ((-12.0, 0.0), (12.0, 0.0))
CURBS: RoadCrossSection = (
    (-8.0, 0.15), (-3.11, 0.15), (-3.1, 0.0), (3.6, 0.0), (3.61, 0.15), (8.0, 0.15),
)  # fmt: skip

Change = Callable[[laspy.LasData], None]


def bright_walk(cloud: laspy.LasData) -> None:
    """A walk of paving on the left, soil on the right; brightness falls with the range."""
    xyz = np.asarray(cloud.xyz) - ORIGIN
    random = np.random.default_rng(5)
    reflectance = np.where(xyz[:, 1] > WALK_M, 0.36, np.where(xyz[:, 1] < SOIL_M, 0.35, 0.13))
    reflectance *= np.exp(random.normal(0.0, 0.15, len(xyz)))
    away = np.hypot(np.abs(xyz[:, 1]) + 0.3, HIGH_M)
    law = 60_000 * reflectance * (2.0 / away) ** 1.2
    cloud.intensity = np.clip(law, 1, 65_535).astype(np.uint16)
    rough = np.where(xyz[:, 1] < SOIL_M, random.normal(0.0, 0.01, len(xyz)), 0.0)
    cloud.z = np.asarray(cloud.z) + rough


def delivery(
    folder: Path, profile: RoadCrossSection = LAND, change: Change = bright_walk
) -> ImportRequest:
    way = straight(LENGTH_M)
    driven = DrivenRecording(
        way, facing_along(way), (road_along(LENGTH_M, profile),), head=HEAD_45, pulses=2_500
    )
    request = delivered(driven, folder)
    cloud = laspy.read(request.inputs[0])
    change(cloud)
    cloud.write(str(request.inputs[0]))
    return request


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("edges")
    return imported(folder, delivery(folder))


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("edges", drives, tmp_path_factory.mktemp("columns"))


def local(one: Candidate) -> Floats:
    return np.asarray(one.xyz - ORIGIN)


def on_side(told: RunOutcome, side: str) -> Candidate:
    (one,) = [one for one in told.candidates if one.attributes["side"] == side]
    return one


def test_a_walk_at_the_height_of_the_road_begins_where_it_grows_brighter(told: RunOutcome) -> None:
    walk = on_side(told, "left")
    assert walk.kind == "sidewalk"
    assert walk.attributes["type"] == "walk"
    assert str(walk.attributes["evidence"]).startswith("intensity")
    assert np.abs(local(walk)[:, 1] - WALK_M).max() < 0.05
    assert np.abs(local(walk)[:, 2]).max() < 0.02
    assert np.ptp(local(walk)[:, 0]) > 0.85 * LENGTH_M
    assert walk.confidence > 0.8


def test_soil_is_told_by_its_roughness_too(told: RunOutcome) -> None:
    soil = on_side(told, "right")
    assert soil.kind == "road_edge"
    assert soil.attributes["type"] == "soil"
    assert "roughness" in str(soil.attributes["evidence"])
    assert np.abs(local(soil)[:, 1] - SOIL_M).max() < 0.06
    assert soil.attributes["before"] == "gap"  # its head looks ahead on this side
    assert soil.attributes["after"] == "end"


def test_what_closes_the_carriageway_is_told(told: RunOutcome) -> None:
    assert "end without a step" in told.sentence
    assert "0 m at a curb" in told.sentence


def test_curbs_are_left_to_the_search_for_curbs(tmp_path: Path) -> None:
    told = told_of("edges", delivery(tmp_path, CURBS), tmp_path)
    assert told.candidates == ()
    metres = re.search(r"(\d+) m at a curb", told.sentence)
    assert metres is not None
    assert int(metres[1]) > 0.85 * 2 * LENGTH_M


def hidden(cloud: laspy.LasData) -> None:
    """A parked car on the left hides the walk's edge."""
    bright_walk(cloud)
    xyz = np.asarray(cloud.xyz) - ORIGIN
    kept = (xyz[:, 1] < 2.0) | (np.abs(xyz[:, 0] - 15.0) > 2.0)
    cloud.points = cloud.points[kept]


def test_an_edge_goes_on_behind_what_hides_it_and_that_is_told(tmp_path: Path) -> None:
    told = told_of("edges", delivery(tmp_path, change=hidden), tmp_path)
    walk = on_side(told, "left")
    bridged = walk.attributes["bridged_m"]
    assert isinstance(bridged, float)
    assert bridged == pytest.approx(4.0, abs=1.5)
    assert np.abs(local(walk)[:, 1] - WALK_M).max() < 0.06


def test_a_drive_read_in_parts_gives_the_same(
    drives: tuple[Drive, ...], told: RunOutcome, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drive_chunks, "_POINTS_AT_ONCE", 40_001)
    again = told_by("edges", tuple(Drive(one.folder) for one in drives), tmp_path)
    assert len(again.candidates) == len(told.candidates)
    for one, other in zip(again.candidates, told.candidates, strict=True):
        np.testing.assert_allclose(one.xyz, other.xyz, atol=1e-3)
        assert one.attributes == other.attributes


def flat(cloud: laspy.LasData) -> None:
    bright_walk(cloud)
    cloud.intensity = np.full(len(cloud.x), 500, np.uint16)


def saturated(cloud: laspy.LasData) -> None:
    bright_walk(cloud)
    cloud.intensity = np.minimum(np.asarray(cloud.intensity), 4_000)


@pytest.mark.parametrize(
    ("change", "words"), [(flat, "no intensity"), (saturated, "Intensities are cut off")]
)
def test_what_is_wrong_with_intensities_is_told(tmp_path: Path, change: Change, words: str) -> None:
    assert words in told_of("edges", delivery(tmp_path, change=change), tmp_path).sentence


def test_without_a_trajectory_a_sentence_says_so(tmp_path: Path) -> None:
    told = told_of("edges", replace(delivery(tmp_path), trajectories=()), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


def all_noise(cloud: laspy.LasData) -> None:
    cloud.classification = np.full(len(cloud.x), 7, np.uint8)


def test_a_drive_of_noise_has_no_edges(tmp_path: Path) -> None:
    told = told_of("edges", delivery(tmp_path, change=all_noise), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


def test_a_search_that_is_cancelled_ends_at_once(drives: tuple[Drive, ...]) -> None:
    with pytest.raises(Cancelled):
        find_edges(drives, EdgeParameters(), CancelledAfter(6))


def test_a_section_shows_where_the_carriageway_ends_and_why(drives: tuple[Drive, ...]) -> None:
    xyz = ORIGIN + np.array([15.0, WALK_M, 0.0])
    scanlines = scanline_through(drives[0], xyz, ScanlineSettings())
    assert scanlines is not None
    found = diagnose_edges(RequestedPosition(drives[0], xyz, scanlines), EdgeParameters())
    walk = min(found, key=lambda one: abs(float(one.xyz[1] - xyz[1])))
    assert walk.is_taken
    assert abs(float(walk.xyz[1] - xyz[1])) < 0.05
    assert walk.outline is not None
    assert walk.points is not None
    assert len(walk.points) > 10


def test_curbs_go_on_where_they_are_lowered_for_an_entrance() -> None:
    flags = np.zeros(80, np.bool_)
    flags[[*range(20), *range(40, 50)]] = True
    whole = _without_entrances(flags)
    assert whole[:50].all()
    assert not whole[50:].any()
    flags[20:60], flags[60:] = False, True
    assert not _without_entrances(flags)[20:60].any()
