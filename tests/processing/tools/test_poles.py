"""Poles: each type by what it carries, measured; trunks and posts of fences are none."""

from __future__ import annotations

import csv
import math
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.ledger_csv import write_ledger
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, grid, tube
from processing.map.catalogue_file import read_catalogue
from processing.methods.road.requested_position import RequestedPosition
from processing.project.results.found_features import found_features
from processing.recording.drive import Drive
from processing.tools.poles import POLES, PoleParameters, diagnose_poles
from processing.tools.running.runner import RunRequest, run
from processing.tools.tool import Candidate, CandidateResult
from resources import path_of
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
GROUND_M = 0.16
HEIGHTS_M = {
    "utility_pole": 10.5,
    "street_light": 8.0,
    "signal_pole": 5.8,
    "arm_pole": 6.9,
    "sign_pole": 2.8,
    "mirror_pole": 3.0,
    "bollard": 0.8,
    "delineator": 0.9,
}
DIAMETERS_M = {
    "utility_pole": 0.3,
    "street_light": 0.16,
    "signal_pole": 0.19,
    "arm_pole": 0.2163,
    "sign_pole": 0.0605,
    "mirror_pole": 0.0763,
    "bollard": 0.1143,
    "delineator": 0.0605,
}
FEET = {
    kind: np.array([8.0 + 6.0 * number, 5.0 if number % 2 else -5.0, GROUND_M])
    for number, kind in enumerate(HEIGHTS_M)
}
LEAN = 0.05
LOOKS_DEG = 270.0
"""Where the mirror looks: back along the road, which leads to the east."""

TREE = np.array([44.0, 5.5, GROUND_M])
FENCE = np.array([14.0, 6.5, GROUND_M])


def shaft(kind: str) -> TriangleShape:
    """A pole as thick as said 1.2 m up; utility poles lose a 75th, the post of the mirror leans."""
    high, diameter = HEIGHTS_M[kind], DIAMETERS_M[kind]
    up = np.linspace(-0.3, high, 8)
    lean = LEAN if kind == "mirror_pole" else 0.0
    taper = {"utility_pole": 1 / 75, "street_light": 0.008}.get(kind, 0.0)
    path = FEET[kind] + np.column_stack([lean * up, np.zeros(8), up])
    return tube(path, (diameter - taper * (up - 1.2)) / 2, 32)


def towards(kind: str, along: float, across: float, up: float) -> Floats:
    """A place so far from a pole's foot: along the road, towards its middle, upwards."""
    side = -np.sign(FEET[kind][1])
    return np.asarray(FEET[kind] + np.array([along, side * across, up]))


def arm(kind: str, up: float, reach: float) -> TriangleShape:
    ends = np.array([towards(kind, 0.0, across, up) for across in (0.0, reach / 2, reach)])
    return tube(ends, np.full(3, 0.045), 12)


def block(
    kind: str, low: tuple[float, float, float], high: tuple[float, float, float]
) -> TriangleShape:
    """A box between two corners about a pole: along, towards the road, up."""
    corners = np.array([towards(kind, *low), towards(kind, *high)])
    first, second = corners.min(axis=0), corners.max(axis=0)
    return box(tuple(first.tolist()), tuple(second.tolist()))


def wires() -> list[TriangleShape]:
    """Four of them over the utility pole, along the road."""
    at = np.linspace(-18.0, 18.0, 13)
    sag = 0.5 * (np.abs(at) / 18.0) * (1 - np.abs(at) / 18.0) * 4
    return [
        tube(
            np.array(
                [towards("utility_pole", x, across, up - z) for x, z in zip(at, sag, strict=True)]
            ),
            np.full(13, 0.011),
            6,
        )
        for across, up in ((0.2, 10.2), (0.2, 8.0), (0.2, 7.4), (0.2, 6.9))
    ]


def glass() -> TriangleShape:
    """A mirror of 80 cm that bulges along the road."""
    turns = np.linspace(0, 2 * np.pi, 25)
    rings = [0.01, 0.15, 0.3, 0.4]
    rows = [
        [
            towards(
                "mirror_pole",
                -0.12 - (0.16 - r * r) / (2 * 2.2) + LEAN * 2.5,
                r * math.cos(turn),
                2.5 + r * math.sin(turn),
            )
            for turn in turns
        ]
        for r in rings
    ]
    return grid(np.array(rows))


def leaves(middle: Floats) -> TriangleShape:
    random = np.random.default_rng(5)
    places = random.normal(size=(1_500, 3))
    places *= (random.uniform(0.2, 1.0, 1_500) / np.linalg.norm(places, axis=1))[:, None]
    corners = middle + (places * [1.8, 1.8, 1.5])[:, None] + random.normal(0, 0.05, (1_500, 3, 3))
    return corners.reshape(-1, 3), np.arange(4_500, dtype=np.int64).reshape(-1, 3)


def fence() -> list[TriangleShape]:
    """Posts two metres apart with three rails."""
    parts = [
        tube(FENCE + np.array([[2.0 * post, 0, -0.3], [2.0 * post, 0, 1.0]]), np.full(2, 0.03), 12)
        for post in range(5)
    ]
    return parts + [
        tube(FENCE + np.array([[0.0, 0, up], [8.0, 0, up]]), np.full(2, 0.025), 8)
        for up in (0.35, 0.65, 0.95)
    ]


def street() -> tuple[TriangleShape, ...]:
    trunk = TREE + np.array([[0, 0, -0.3], [0.01, 0, 1.0], [0.02, 0, 2.0], [0.04, 0, 3.4]])
    return (
        road_along(LENGTH_M),
        *(shaft(kind) for kind in HEIGHTS_M),
        *wires(),
        arm("street_light", 8.0, 1.8),
        block("street_light", (-0.15, 1.7, 7.95), (0.15, 2.3, 8.06)),
        arm("signal_pole", 5.2, 3.4),
        block("signal_pole", (-0.25, 2.1, 5.0), (-0.05, 3.4, 5.42)),
        arm("arm_pole", 6.6, 3.0),
        arm("arm_pole", 5.8, 3.0),
        block("arm_pole", (-0.12, 0.9, 5.5), (-0.08, 3.1, 6.9)),
        block("sign_pole", (-0.06, -0.3, 2.1), (-0.04, 0.3, 2.7)),
        glass(),
        tube(trunk, np.array([0.14, 0.12, 0.11, 0.1]), 32),
        leaves(TREE + np.array([0.0, 0.0, 4.3])),
        *fence(),
    )


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    way = straight(LENGTH_M)
    driven = DrivenRecording(way, facing_along(way), street(), head=HEAD_45, pulses=3_000)
    return recorded(tmp_path_factory.mktemp("poles"), driven)


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    folder: Path = tmp_path_factory.mktemp("columns")
    # A thin post by itself is half as likely as not: the one of the sign has .49.
    parameters = PoleParameters(least_confidence=0.4)
    request = RunRequest("poles", drives[0], parameters, tuple(drives[1:]))
    result = run(request, SilentMonitor(), into=folder / "columns")
    assert isinstance(result, CandidateResult)
    return RunOutcome(result.candidates, result.note.en)


def pole_at(told: RunOutcome, foot: Floats) -> Candidate:
    near = [one for one in told.candidates if math.dist(one.xyz[0, :2], (foot + ORIGIN)[:2]) < 0.4]
    assert len(near) == 1
    return near[0]


def measure(pole: Candidate, name: str) -> float:
    value = pole.attributes[name]
    assert isinstance(value, float | int)
    return float(value)


@pytest.mark.parametrize("kind", list(HEIGHTS_M))
def test_a_pole_is_found_with_its_type_and_measured(told: RunOutcome, kind: str) -> None:
    pole = pole_at(told, FEET[kind])
    assert pole.attributes["type"] == kind
    assert pole.xyz[0] == pytest.approx(FEET[kind] + ORIGIN, abs=0.04)
    assert measure(pole, "height_m") == pytest.approx(HEIGHTS_M[kind], abs=0.25)
    off = abs(measure(pole, "diameter_m") - DIAMETERS_M[kind])
    assert off < 0.01
    assert off <= measure(pole, "diameter_within_m")


def test_a_pole_tells_how_it_leans_and_tapers(told: RunOutcome) -> None:
    lean = measure(pole_at(told, FEET["mirror_pole"]), "lean_deg")
    assert lean == pytest.approx(math.degrees(math.atan(LEAN)), abs=0.4)
    taper = measure(pole_at(told, FEET["utility_pole"]), "taper_m_per_m")
    assert taper == pytest.approx(1 / 75, abs=0.002)


def test_trees_and_posts_of_fences_are_no_poles(told: RunOutcome) -> None:
    assert len(told.candidates) == len(HEIGHTS_M)


def test_a_mirror_is_a_kind_of_its_own_and_tells_where_it_looks(told: RunOutcome) -> None:
    mirror = pole_at(told, FEET["mirror_pole"])
    assert [one for one in told.candidates if one.kind == "mirror"] == [mirror]
    assert {one.kind for one in told.candidates if one is not mirror} == {"pole"}
    assert measure(mirror, "direction_deg") == pytest.approx(LOOKS_DEG, abs=4)


def test_the_circles_of_a_pole_are_told_where_they_are(drives: tuple[Drive, ...]) -> None:
    place = FEET["mirror_pole"] + ORIGIN
    scanlines = scanline_through(drives[0], place, ScanlineSettings())
    assert scanlines is not None
    asked = RequestedPosition(drives[0], place, scanlines)
    taken = [one for one in diagnose_poles(asked, PoleParameters()) if one.is_taken]
    circles = [one for one in taken if one.outcomes[0].name.en == "Diameter of the circle"]
    assert len(taken) > len(circles) >= 6
    for one in circles:
        assert one.outcomes[0].value == pytest.approx(DIAMETERS_M["mirror_pole"], abs=0.015)
        leant = LEAN * (one.xyz[2] - place[2])
        assert math.dist(one.xyz[:2], (place[0] + leant, place[1])) < 0.03


def ledger_of(told: RunOutcome, kind: str, path: Path) -> list[dict[str, str]]:
    """The rows of the ledger of a kind, once all that was found is on the map."""
    now = datetime.now(UTC)
    result = CandidateResult(told.candidates)
    found = found_features(result, POLES, PoleParameters(), ("left",), started=now, finished=now)
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    mapped = [one for one in found.change.added if one.kind == kind]
    write_ledger(path, mapped, catalogue[kind], TableStyle("en", crs="EPSG:6677"))
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def assert_foot(row: dict[str, str], kind: str) -> None:
    for axis, name in enumerate(("Easting (Y) [m]", "Northing (X) [m]", "Height (H) [m]")):
        assert float(row[name]) == pytest.approx((FEET[kind] + ORIGIN)[axis], abs=0.04)


def test_the_ledger_of_poles_is_true(told: RunOutcome, tmp_path: Path) -> None:
    told_rows = ledger_of(told, "pole", tmp_path / "ledger_pole.csv")
    types = read_catalogue(path_of("catalogue/level500.toml"))["pole"].attribute("type")
    assert types is not None
    ids = {types.name_of_choice(one).en: one for one in HEIGHTS_M}
    assert all(" " in name or name.istitle() for name in ids), "names, not ids"
    rows = {ids[row["Kind of pole"]]: row for row in told_rows}
    assert set(rows) == set(HEIGHTS_M) - {"mirror_pole"}
    for kind, row in rows.items():
        assert float(row["Height [m]"]) == pytest.approx(HEIGHTS_M[kind], abs=0.25)
        assert float(row["Diameter [m]"]) == pytest.approx(DIAMETERS_M[kind], abs=0.01)
        assert_foot(row, kind)


def test_the_ledger_of_mirrors_is_true(told: RunOutcome, tmp_path: Path) -> None:
    (row,) = ledger_of(told, "mirror", tmp_path / "ledger_mirror.csv")
    assert_foot(row, "mirror_pole")
    assert float(row["Height [m]"]) == pytest.approx(HEIGHTS_M["mirror_pole"], abs=0.25)
    direction = float(row["Direction (clockwise from north) [°]"])
    assert direction == pytest.approx(LOOKS_DEG, abs=4)


def test_a_street_without_poles_is_told(tmp_path: Path) -> None:
    way = straight(12.0)
    bare = DrivenRecording(way, facing_along(way), (road_along(12.0),))
    told = told_by("poles", recorded(tmp_path, bare), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")
