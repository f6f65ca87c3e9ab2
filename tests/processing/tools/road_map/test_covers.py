"""Covers in a road and its walks, found by brightness, height and what lies below them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.methods.road.covers.street_covers import street_covers
from processing.methods.road.objects import drive_chunks
from processing.methods.road.requested_position import RequestedPosition
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.road_map.covers import CoverParameters, diagnose_covers, find_covers
from processing.tools.tool import Candidate
from tests.monitors import CancelledAfter
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    HIGH_M,
    ORIGIN,
    DrivenRecording,
    Floats,
    RunOutcome,
    delivered,
    facing_along,
    imported,
    road_along,
    straight,
    told_by,
    told_of,
)

LENGTH_M = 24.0
MANHOLE_M, RADIUS_M = np.array([7.0, 1.4]), 0.3
BOX_M, SIDES_M = np.array([12.0, -1.5]), (0.9, 0.6)
HAND_HOLE_M, HAND_SIDES_M = np.array([14.0, 5.2]), (0.45, 0.45)
GRATING_M, GRATING_SIDES_M = np.array([17.0, -3.2]), (0.5, 0.4)
DAMP_M = np.array([9.5, 2.0])
RAISED_M = 0.006
COVERS = ("manhole", "box", "hand hole", "grating")

Law = Callable[[Floats], Floats]
"""From reflectance to intensity."""


def by_reflectance(reflectance: Floats) -> Floats:
    return np.asarray(60_000 * reflectance)


def is_within(xyz: Floats, middle: Floats, sides_m: tuple[float, float]) -> np.ndarray:
    off = np.abs(xyz[:, :2] - middle)
    inside: np.ndarray = (off[:, 0] < sides_m[0] / 2) & (off[:, 1] < sides_m[1] / 2)
    return inside


def delivery(
    folder: Path, law: Law = by_reflectance, covers: tuple[str, ...] = COVERS
) -> ImportRequest:
    """The road as it is delivered, with covers set into it."""
    way = straight(LENGTH_M)
    driven = DrivenRecording(
        way, facing_along(way), (road_along(LENGTH_M),), head=HEAD_45, pulses=2_500
    )
    request = delivered(driven, folder)
    cloud = laspy.read(request.inputs[0])
    xyz = np.asarray(cloud.xyz) - ORIGIN
    random = np.random.default_rng(5)
    reflectance = np.full(len(xyz), 0.15)
    away = np.hypot(*(xyz[:, :2] - DAMP_M).T)
    reflectance *= 1 - 0.5 * np.exp(-((away / 0.4) ** 2))
    shapes = {
        "manhole": (np.hypot(*(xyz[:, :2] - MANHOLE_M).T) < RADIUS_M, 0.08, RAISED_M),
        "box": (is_within(xyz, BOX_M, SIDES_M), 0.21, RAISED_M),
        "hand hole": (is_within(xyz, HAND_HOLE_M, HAND_SIDES_M), 0.08, RAISED_M),
        "grating": (is_within(xyz, GRATING_M, GRATING_SIDES_M), 0.12, 0.0),
    }
    for name in covers:
        inside, own, raised_m = shapes[name]
        reflectance[inside] = own
        xyz[inside, 2] += raised_m
        if name == "grating":
            falls = inside & (random.random(len(xyz)) < 0.4)
            xyz[falls, 2] -= random.uniform(0.03, 0.6, int(falls.sum()))
    reflectance *= np.exp(random.normal(0.0, 0.12, len(xyz)))
    xyz[:, 2] += random.normal(0.0, 0.002, len(xyz))
    cloud.xyz = xyz + ORIGIN
    distance = np.hypot(np.abs(xyz[:, 1]) + 0.3, HIGH_M)
    strength = law(reflectance) * (2.0 / distance) ** 1.2
    cloud.intensity = np.clip(strength, 1, 65_535).astype(np.uint16)
    cloud.write(str(request.inputs[0]))
    return request


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("covers")
    return imported(folder, delivery(folder))


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("covers", drives, tmp_path_factory.mktemp("columns"))


def at(told: RunOutcome, middle: Floats) -> Candidate:
    """The one that lies there."""
    (found,) = [
        one
        for one in told.candidates
        if np.hypot(*(one.xyz[:, :2].mean(axis=0) - ORIGIN[:2] - middle)) < 0.04
    ]
    return found


def measures(one: Candidate, *names: str) -> list[float]:
    values = [one.attributes[name] for name in names]
    return [float(value) for value in values if isinstance(value, int | float)]


def test_a_round_cover_is_a_point_with_its_diameter(told: RunOutcome) -> None:
    manhole = at(told, MANHOLE_M)
    assert (manhole.kind, manhole.geometry) == ("manhole", "point")
    assert measures(manhole, "diameter_m") == pytest.approx([2 * RADIUS_M], abs=0.03)
    assert measures(manhole, "raised_m") == pytest.approx([RAISED_M], abs=0.002)
    assert manhole.attributes["lies_in"] == "carriageway"
    assert manhole.xyz[0, 2] - ORIGIN[2] == pytest.approx(RAISED_M, abs=0.004)


def test_a_square_cover_is_an_area_with_sides_and_direction(told: RunOutcome) -> None:
    box = at(told, BOX_M)
    assert (box.kind, box.geometry, len(box.xyz)) == ("manhole_area", "area", 4)
    assert measures(box, "length_m", "width_m") == pytest.approx(SIDES_M, abs=0.05)
    assert measures(box, "direction_deg") == pytest.approx([90.0], abs=3.0)


def test_a_cover_behind_a_curb_lies_in_the_walk(told: RunOutcome) -> None:
    hole = at(told, HAND_HOLE_M)
    assert hole.attributes["lies_in"] == "walk"
    assert measures(hole, "length_m", "width_m") == pytest.approx(HAND_SIDES_M, abs=0.05)


def test_what_points_fall_through_is_a_grating(told: RunOutcome) -> None:
    grating = at(told, GRATING_M)
    assert grating.kind == "rain_inlet"
    assert measures(grating, "length_m", "width_m") == pytest.approx(GRATING_SIDES_M, abs=0.05)


def test_a_damp_place_is_no_cover(told: RunOutcome) -> None:
    assert len(told.candidates) == len(COVERS)
    assert all(one.confidence >= 0.5 for one in told.candidates)


def test_covers_of_a_drive_read_in_parts_are_the_same(
    drives: tuple[Drive, ...],
    told: RunOutcome,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(drive_chunks, "_POINTS_AT_ONCE", 40_001)
    again = told_by("covers", tuple(Drive(one.folder) for one in drives), tmp_path)
    assert len(again.candidates) == len(told.candidates)
    for one, other in zip(again.candidates, told.candidates, strict=True):
        np.testing.assert_array_equal(one.xyz, other.xyz)
        assert one.attributes == other.attributes


def test_without_a_trajectory_covers_are_found_and_it_is_told(tmp_path: Path) -> None:
    request = replace(delivery(tmp_path), trajectories=())
    told = told_of("covers", request, tmp_path)
    assert "lies_in" not in at(told, MANHOLE_M).attributes
    assert "Without a trajectory" in told.sentence


def test_without_intensities_what_stands_out_is_found_and_it_is_told(tmp_path: Path) -> None:
    request = delivery(tmp_path, lambda reflectance: np.zeros_like(reflectance))
    told = told_of("covers", request, tmp_path)
    assert at(told, GRATING_M).kind == "rain_inlet"
    assert "no intensity" in told.sentence


def test_intensities_that_are_cut_off_are_told(tmp_path: Path) -> None:
    request = delivery(tmp_path, lambda reflectance: reflectance * 1e8)
    cloud = laspy.read(request.inputs[0])
    cloud.intensity[::7] = 60_000
    cloud.write(str(request.inputs[0]))
    assert "cut off" in told_of("covers", request, tmp_path).sentence


def test_a_road_without_covers_is_told(tmp_path: Path) -> None:
    told = told_of("covers", delivery(tmp_path, covers=()), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


def test_a_cancelled_search_stops(drives: tuple[Drive, ...]) -> None:
    fresh = tuple(Drive(one.folder) for one in drives)
    with pytest.raises(Cancelled):
        street_covers(fresh, 0.5, CancelledAfter(3))


def test_nothing_is_found_without_points_and_it_is_told() -> None:
    found = find_covers((), CoverParameters(), CancelledAfter(1_000))
    assert found.candidates == ()
    assert found.note.en == "The drive has no points."


def test_a_section_shows_the_covers_about_it_and_what_decided(drives: tuple[Drive, ...]) -> None:
    place = np.append(MANHOLE_M, 0.0) + ORIGIN
    scanlines = scanline_through(drives[0], place, ScanlineSettings())
    assert scanlines is not None
    told = diagnose_covers(RequestedPosition(drives[0], place, scanlines), CoverParameters())
    (manhole,) = [one for one in told if np.hypot(*(one.xyz - place)[:2]) < 0.05]
    assert manhole.is_taken
    assert manhole.outline is not None
    assert len(manhole.outline) == 4
    assert manhole.outcomes[-1].value >= 0.5
