"""Road markings: solid and broken lines, stop lines and bars, found by what is brighter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.methods.road.objects import drive_chunks
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.tool import Candidate
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

LENGTH_M = 36.0
WIDE_M, STRIPE_M = 0.15, 0.45
EDGE_M, MIDDLE_M = 2.9, -0.9
STOP_M = (26.0, 26.45)
BARS_M = (29.0, 32.0)
BARS_AT_M = np.array([-3.4, -2.5, -1.6])
DASH_M, GAP_M = 3.0, 4.0

PAINT: list[tuple[float, float, float, float]] = [
    (-20.0, 60.0, EDGE_M - WIDE_M / 2, EDGE_M + WIDE_M / 2),
    *((at, at + DASH_M, MIDDLE_M - WIDE_M / 2, MIDDLE_M + WIDE_M / 2) for at in (4.0, 11.0, 18.0)),
    (*STOP_M, -3.6, -1.1),
    *((*BARS_M, float(at) - STRIPE_M / 2, float(at) + STRIPE_M / 2) for at in BARS_AT_M),
]
"""From and to which place along the road, and beside it."""

Law = Callable[[Floats, Floats], Floats]
"""From reflectance and range to intensity."""


def by_range(reflectance: Floats, away_m: Floats) -> Floats:
    return np.asarray(60_000 * reflectance * (2.0 / away_m) ** 1.2)


def by_logarithm(reflectance: Floats, away_m: Floats) -> Floats:
    return np.asarray(20_000 + 8_000 * np.log10(reflectance / 0.1) - 3_000 * np.log10(away_m))


def delivery(
    folder: Path, law: Law = by_range, paint: list[tuple[float, float, float, float]] = PAINT
) -> ImportRequest:
    """The road as it is delivered, with paint on it that only intensities show."""
    way = straight(LENGTH_M)
    driven = DrivenRecording(
        way, facing_along(way), (road_along(LENGTH_M),), head=HEAD_45, pulses=2_500
    )
    request = delivered(driven, folder)
    cloud = laspy.read(request.inputs[0])
    xyz = np.asarray(cloud.xyz) - ORIGIN
    reflectance = np.full(len(xyz), 0.12)
    for low, high, right, left in paint:
        on = (xyz[:, 0] >= low) & (xyz[:, 0] <= high) & (xyz[:, 1] >= right) & (xyz[:, 1] <= left)
        reflectance[on] = 0.5
    reflectance *= np.exp(np.random.default_rng(5).normal(0.0, 0.15, len(xyz)))
    away = np.hypot(np.abs(xyz[:, 1]) + 0.3, HIGH_M)
    cloud.intensity = np.clip(law(reflectance, away), 1, 65_535).astype(np.uint16)
    cloud.write(str(request.inputs[0]))
    return request


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("markings")
    return imported(folder, delivery(folder))


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("markings", drives, tmp_path_factory.mktemp("columns"))


def of_type(told: RunOutcome, name: str) -> list[Candidate]:
    return [one for one in told.candidates if one.attributes["type"] == name]


def local(one: Candidate) -> Floats:
    return np.asarray(one.xyz - ORIGIN)


def measure(one: Candidate, name: str) -> float:
    value = one.attributes[name]
    assert isinstance(value, float | int)
    return float(value)


def assert_edge_line(told: RunOutcome) -> None:
    """The solid line, whole and in its place."""
    (edge,) = [one for one in of_type(told, "solid") if np.ptp(local(one)[:, 0]) > 20]
    along, north, high = local(edge).T
    assert np.ptp(along) > LENGTH_M - 4
    assert np.abs(north - EDGE_M).max() < 0.02
    assert np.abs(high).max() < 0.02


def test_a_solid_line_lies_on_its_middle_and_has_its_width(told: RunOutcome) -> None:
    assert_edge_line(told)
    widths = [measure(one, "width_m") for one in of_type(told, "solid")]
    assert max(abs(one - WIDE_M) for one in widths) < 0.02


def test_a_broken_line_is_one_line_with_its_pattern(told: RunOutcome) -> None:
    (middle,) = of_type(told, "broken")
    along, north, _ = local(middle).T
    assert sorted((along[0], along[-1])) == pytest.approx([4.0, 21.0], abs=0.1)
    assert np.abs(north - MIDDLE_M).max() < 0.02
    assert measure(middle, "dash_m") == pytest.approx(DASH_M, abs=0.15)
    assert measure(middle, "gap_m") == pytest.approx(GAP_M, abs=0.15)


def test_a_line_across_the_way_is_a_stop_line(told: RunOutcome) -> None:
    (stop,) = of_type(told, "stop_line")
    assert stop.kind == "stop_line"
    along, north, _ = local(stop).T
    assert np.abs(along - sum(STOP_M) / 2).max() < 0.03
    assert sorted((north[0], north[-1])) == pytest.approx([-3.6, -1.1], abs=0.1)
    assert measure(stop, "width_m") == pytest.approx(STRIPE_M, abs=0.03)


def test_bars_of_a_crossing_are_told_from_lines(told: RunOutcome) -> None:
    bars = of_type(told, "crosswalk_bar")
    assert [one.kind for one in bars] == ["crosswalk_bar"] * len(BARS_AT_M)
    at = sorted(float(local(one)[:, 1].mean()) for one in bars)
    np.testing.assert_allclose(at, BARS_AT_M, atol=0.03)
    for one in bars:
        ends = local(one)[:, 0]
        assert sorted((ends[0], ends[-1])) == pytest.approx(BARS_M, abs=0.1)


def test_nothing_else_is_a_marking(told: RunOutcome) -> None:
    assert len(told.candidates) == 3 + len(BARS_AT_M)
    assert all(one.confidence >= 0.5 for one in told.candidates)


def test_a_head_that_gives_logarithms_shows_the_same(tmp_path: Path) -> None:
    told = told_of("markings", delivery(tmp_path, by_logarithm), tmp_path)
    assert_edge_line(told)
    assert len(of_type(told, "broken")) == len(of_type(told, "stop_line")) == 1


def test_markings_of_a_drive_read_in_parts_are_the_same(
    drives: tuple[Drive, ...],
    told: RunOutcome,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(drive_chunks, "_POINTS_AT_ONCE", 40_001)
    again = told_by("markings", tuple(Drive(one.folder) for one in drives), tmp_path)
    assert len(again.candidates) == len(told.candidates)
    for one, other in zip(again.candidates, told.candidates, strict=True):
        np.testing.assert_array_equal(one.xyz, other.xyz)
        assert one.attributes == other.attributes


def test_without_a_trajectory_lines_are_found_and_it_is_told(tmp_path: Path) -> None:
    request = replace(delivery(tmp_path), trajectories=())
    told = told_of("markings", request, tmp_path)
    assert_edge_line(told)
    assert "Without a trajectory" in told.sentence


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (lambda reflectance, _: np.full_like(reflectance, 9_000.0), "no intensity"),
        (lambda reflectance, _: np.minimum(reflectance * 1e6, 65_535.0), "cut off"),
        (lambda reflectance, _: np.minimum(reflectance * 5e5, 60_000.0), "cut off"),
    ],
    ids=["the same everywhere", "all at the highest value", "half at the highest value"],
)
def test_intensities_that_tell_nothing_are_told(tmp_path: Path, law: Law, words: str) -> None:
    told = told_of("markings", delivery(tmp_path, law), tmp_path)
    assert told.candidates == ()
    assert words in told.sentence


def test_a_road_without_paint_is_told(tmp_path: Path) -> None:
    told = told_of("markings", delivery(tmp_path, paint=[]), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")
