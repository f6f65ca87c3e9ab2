"""Wires: parallel ones told apart, gaps joined, spans ended at poles; sag and clearance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, tube
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.tools.tool import Candidate
from processing.tools.wires import WireParameters, diagnose_wires
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    Floats,
    RunOutcome,
    facing_along,
    recorded,
    road_along,
    straight,
    told_by,
)

LENGTH_M = 60.0
SAG_M = 0.6
SPAN = (4.0, 32.0)
FOLLOWING = (32.0, 58.0)
NORTH_M = 5.0
WALK_M = 0.16
HIGHS_M = (9.0, 7.2, 7.0)
"""Two of the three hang 20 cm apart."""

CROSSING_SAG_M = 0.2
CROSSING_HIGH_M = 5.0


def hanging(start: Floats, end: Floats, sag_m: float) -> Floats:
    share = np.linspace(0.0, 1.0, 41)[:, None]
    path: Floats = start + share * (end - start)
    path[:, 2] -= sag_m * (4 * share * (1 - share))[:, 0]
    return path


def along(span: tuple[float, float], high_m: float) -> Floats:
    first, last = span
    return hanging(np.array([first, NORTH_M, high_m]), np.array([last, NORTH_M, high_m]), SAG_M)


CROSSING = hanging(
    np.array([20.0, -6.0, CROSSING_HIGH_M]), np.array([22.0, 6.0, CROSSING_HIGH_M]), CROSSING_SAG_M
)
WIRES = [along(span, high) for span in (SPAN, FOLLOWING) for high in HIGHS_M] + [CROSSING]


def street() -> tuple[TriangleShape, ...]:
    pole = np.array([[32.0, NORTH_M + 0.2, -0.3], [32.0, NORTH_M + 0.2, 10.0]])
    return (
        road_along(LENGTH_M),
        *(tube(path, np.full(len(path), 0.011), 8) for path in WIRES),
        tube(pole, np.full(2, 0.15), 24),
        box((10.0, 8.0, 0.0), (30.0, 8.5, 6.0)),
        # A gap in what the scanner sees of the wires behind it.
        box((44.0, 3.0, 4.0), (46.0, 3.1, 9.5)),
    )


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    way = straight(LENGTH_M)
    driven = DrivenRecording(way, facing_along(way), street(), head=HEAD_45, pulses=3_000)
    return recorded(tmp_path_factory.mktemp("wires"), driven)


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("wires", drives, tmp_path_factory.mktemp("columns"))


def wire_along(told: RunOutcome, path: Floats) -> Candidate:
    """The wire that runs through the middle of a path."""
    middle = path[len(path) // 2] + ORIGIN
    near = [
        one
        for one in told.candidates
        if np.linalg.norm(one.xyz - middle, axis=1).min() < 0.4
        and abs(one.xyz[np.abs(one.xyz[:, 0] - middle[0]).argmin(), 2] - middle[2]) < 0.08
    ]
    assert len(near) == 1
    return near[0]


def measure(wire: Candidate, name: str) -> float:
    value = wire.attributes[name]
    assert isinstance(value, float | int)
    return float(value)


@pytest.mark.parametrize("number", range(len(WIRES)))
def test_a_wire_lies_where_it_hangs(told: RunOutcome, number: int) -> None:
    path = WIRES[number]
    wire = wire_along(told, path)
    fine = np.column_stack(
        [np.interp(np.linspace(0, 40, 4_001), np.arange(41), axis) for axis in path.T]
    )
    off = [np.linalg.norm(fine - (place - ORIGIN), axis=1).min() for place in wire.xyz]
    assert max(off) < 0.05
    length = float(np.linalg.norm(np.diff(wire.xyz, axis=0), axis=1).sum())
    assert length > 0.7 * np.linalg.norm(path[-1] - path[0])


def test_nothing_else_is_a_wire(told: RunOutcome) -> None:
    assert len(told.candidates) == len(WIRES)
    assert all(one.kind == "wire" and one.confidence >= 0.5 for one in told.candidates)


def test_sag_and_clearance_are_those_of_the_wire(told: RunOutcome) -> None:
    wire = wire_along(told, WIRES[0])
    assert measure(wire, "sag_m") == pytest.approx(SAG_M, abs=0.15)
    assert measure(wire, "clearance_m") == pytest.approx(HIGHS_M[0] - SAG_M - WALK_M, abs=0.05)
    assert "road_clearance_m" not in wire.attributes


def test_a_wire_too_low_over_the_road_is_listed(told: RunOutcome) -> None:
    low_m = CROSSING_HIGH_M - CROSSING_SAG_M
    wire = wire_along(told, CROSSING)
    assert measure(wire, "road_clearance_m") == pytest.approx(low_m, abs=0.05)
    assert "lower than 5 m over the road: 1 (" in told.sentence
    assert f"{measure(wire, 'road_clearance_m'):.2f} m" in told.sentence


def test_a_section_tells_its_wires_with_their_residuals(drives: tuple[Drive, ...]) -> None:
    place = np.array([18.0, NORTH_M, WALK_M]) + ORIGIN
    scanlines = scanline_through(drives[0], place, ScanlineSettings())
    assert scanlines is not None
    asked = RequestedPosition(drives[0], place, scanlines)
    told = diagnose_wires(asked, WireParameters())
    lines = [one for one in told if len(one.outcomes) > 1 and one.is_taken]
    points = [one for one in told if len(one.outcomes) == 1]
    for path in WIRES[: len(HIGHS_M)]:
        true = np.interp(18.0, path[:, 0], path[:, 2]) + ORIGIN[2]
        assert min(abs(one.xyz[2] - true) for one in lines) < 0.03
    assert all(abs(one.xyz[0] - place[0]) < 0.1 for one in lines)
    assert len(points) > 2 * len(lines)
    assert sum(one.is_taken for one in points) > 0.8 * len(points)


def test_a_street_without_wires_is_told(tmp_path: Path) -> None:
    way = straight(12.0)
    bare = DrivenRecording(way, facing_along(way), (road_along(12.0),))
    told = told_by("wires", recorded(tmp_path, bare), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")
