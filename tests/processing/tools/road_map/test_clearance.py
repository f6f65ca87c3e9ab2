"""What hangs over a road that is known exactly, what stands on it, and what is high enough."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.laboratory.simulate.scene.mesh import TriangleShape
from processing.methods.road.objects import drive_chunks
from processing.recording.drive import Drive
from processing.tools.road_map.clearance import ClearanceParameters, find_clearance
from tests.monitors import CancelledAfter
from tests.processing.methods.road.bad_recordings import (
    HEAD_90,
    ORIGIN,
    ROAD,
    DrivenRecording,
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

LENGTH_M = 22.0
BEAM_M = 3.8
BEAM: RoadCrossSection = ((1.0, BEAM_M), (3.0, BEAM_M))
BRIDGE: RoadCrossSection = ((-9.0, 5.2), (9.0, 5.2))
LORRY: RoadCrossSection = ((1.0, 0.3), (1.0, 3.5), (3.0, 3.5), (3.0, 0.3))
AWNING: RoadCrossSection = ((4.6, 2.1), (5.6, 2.1))
MEADOW: RoadCrossSection = ((-14.0, 0.0), (14.0, 0.0))
PIPE: RoadCrossSection = ((-4.5, 0.15), (-4.5, 5.0), (4.5, 5.0), (4.5, 0.15))


def swept(profile: RoadCrossSection, low: float, high: float) -> TriangleShape:
    return drawn_along(profile, np.array([[low, 0.0], [high, 0.0]]))


def driven(*shapes: TriangleShape, land: RoadCrossSection = ROAD) -> DrivenRecording:
    way = straight(LENGTH_M)
    scene = (road_along(LENGTH_M, land), *shapes)
    return DrivenRecording(way, facing_along(way), scene, head=HEAD_90, pulses=1_500)


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("clearance")
    things = (swept(BEAM, 10.0, 13.0), swept(BRIDGE, 4.0, 7.0), swept(AWNING, 15.0, 17.0))
    return imported(folder, delivered(driven(*things), folder))


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("clearance", drives, tmp_path_factory.mktemp("columns"))


def test_a_beam_over_the_road_is_found_where_and_as_low_as_it_hangs(told: RunOutcome) -> None:
    (beam,) = [one for one in told.candidates if one.attributes["above"] == "carriageway"]
    facts = beam.attributes
    assert facts["lowest_m"] == pytest.approx(BEAM_M, abs=0.02)
    assert facts["limit_m"] == 4.5
    assert facts["length_m"] == pytest.approx(3.0, abs=0.5)
    assert facts["inside_m"] == pytest.approx(3.0, abs=0.3)
    assert (facts["thing"], facts["told_by"]) == ("structure", "shape")
    x, y, z = (beam.xyz[0] - ORIGIN).tolist()
    assert 10.0 <= x <= 13.0
    assert 1.0 <= y <= 3.0
    assert z == pytest.approx(BEAM_M, abs=0.02)
    assert beam.points[0] >= 0


def test_over_a_walk_less_is_kept_free(told: RunOutcome) -> None:
    (awning,) = [one for one in told.candidates if one.attributes["above"] == "walk"]
    assert awning.attributes["lowest_m"] == pytest.approx(2.1 - 0.155, abs=0.02)
    assert awning.attributes["limit_m"] == 2.5


def test_the_same_whatever_is_read_at_a_time(
    drives: tuple[Drive, ...], told: RunOutcome, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drive_chunks, "_POINTS_AT_ONCE", 30_001)
    again = told_by("clearance", tuple(Drive(one.folder) for one in drives), tmp_path)
    for one, other in zip(again.candidates, told.candidates, strict=True):
        np.testing.assert_array_equal(one.xyz, other.xyz)
        assert one.attributes == other.attributes


def test_what_stands_on_the_road_is_no_place(tmp_path: Path) -> None:
    told = told_of("clearance", delivered(driven(swept(LORRY, 8.0, 14.0)), tmp_path), tmp_path)
    assert told.candidates == ()
    assert told.sentence.startswith("Nothing hangs")


def test_a_pipe_higher_than_the_limit_is_no_place(tmp_path: Path) -> None:
    told = told_of(
        "clearance", delivered(driven(swept(PIPE, -2.0, LENGTH_M + 2.0)), tmp_path), tmp_path
    )
    assert told.candidates == ()


def test_rain_is_no_place(tmp_path: Path) -> None:
    request = delivered(driven(), tmp_path)
    cloud = laspy.read(request.inputs[0])
    xyz, random = cloud.xyz.copy(), np.random.default_rng(3)
    drops = random.random(len(xyz)) < 0.004
    xyz[drops] = ORIGIN + random.uniform((0, -4, 0.5), (LENGTH_M, 4, 4.4), (int(drops.sum()), 3))
    cloud.xyz = xyz
    cloud.write(str(request.inputs[0]))
    assert told_of("clearance", request, tmp_path).candidates == ()


def test_without_curbs_the_sentence_says_how_far_was_looked(tmp_path: Path) -> None:
    recording = driven(swept(BEAM, 10.0, 13.0), land=MEADOW)
    told = told_of("clearance", delivered(recording, tmp_path), tmp_path)
    assert len(told.candidates) == 1
    assert "no curb or gutter was seen" in told.sentence


def test_without_a_trajectory_it_is_refused_in_a_sentence(tmp_path: Path) -> None:
    request = replace(delivered(driven(), tmp_path), trajectories=())
    told = told_of("clearance", request, tmp_path)
    assert told.candidates == ()
    assert "trajectory" in told.sentence


def all_noise(cloud: laspy.LasData) -> None:
    cloud.classification = np.full(len(cloud.x), 7, np.uint8)


def far_off(cloud: laspy.LasData) -> None:
    cloud.y = np.asarray(cloud.y) + 200.0


@pytest.mark.parametrize("change", [all_noise, far_off])
def test_recordings_without_a_road_are_told(
    tmp_path: Path, change: Callable[[laspy.LasData], None]
) -> None:
    request = delivered(driven(), tmp_path)
    cloud = laspy.read(request.inputs[0])
    change(cloud)
    cloud.write(str(request.inputs[0]))
    told = told_of("clearance", request, tmp_path)
    assert told.candidates == ()
    assert told.sentence


def test_a_search_that_is_cancelled_ends_at_once(drives: tuple[Drive, ...]) -> None:
    with pytest.raises(Cancelled):
        find_clearance(drives, ClearanceParameters(), CancelledAfter(3))
