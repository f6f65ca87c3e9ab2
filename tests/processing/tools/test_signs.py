"""Road signs: plates on posts, a wall and one seen from behind, and boards that are none."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import BadFile
from processing.core.monitor import SilentMonitor
from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.ledger_csv import write_ledger
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.simulate.roadside.sign_plates import (
    PlateMounting,
    PlateShape,
    SignPlate,
    axes_of,
    face,
    outline,
)
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, tube
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.tools.running.runner import RunRequest, run
from processing.tools.signs import SignParameters, diagnose_signs
from processing.tools.tool import Candidate, CandidateResult
from resources import path_of
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    SPEED_M_S,
    START_S,
    DrivenRecording,
    Floats,
    RunOutcome,
    delivered,
    facing_along,
    imported,
    recorded,
    road_along,
    straight,
    told_by,
    told_of,
)

LENGTH_M = 34.0
GROUND_M = 0.16
DIFFUSE, BRIGHT = (3_000, 9_000), 40_000


@dataclass(frozen=True)
class KnownPlate:
    """A plate, the middle of its outline's box (m), and where it looks, clockwise from north."""

    plate: SignPlate
    middle: tuple[float, float, float]
    facing_deg: float

    @property
    def hung(self) -> PlateMounting:
        return PlateMounting(np.array(self.middle), math.radians(90.0 - self.facing_deg))

    @property
    def shape(self) -> TriangleShape:
        return face(outline(self.plate), self.hung, 0.0)

    @property
    def centroid(self) -> Floats:
        corners = outline(self.plate)
        ahead = np.roll(corners, -1, axis=0)
        cross = corners[:, 0] * ahead[:, 1] - ahead[:, 0] * corners[:, 1]
        flat = ((corners + ahead) * cross[:, None]).sum(axis=0) / (3 * cross.sum())
        right, up, _ = axes_of(self.hung)
        return np.asarray(np.array(self.middle) + flat[0] * right + flat[1] * up)


def known(
    shape: PlateShape,
    size_m: float,
    middle: tuple[float, float, float],
    facing_deg: float = 90.0,
    high_m: float = 0.0,
) -> KnownPlate:
    return KnownPlate(SignPlate(shape, size_m, high_m), middle, facing_deg)


CIRCLE = known("circle", 0.6, (8.0, 5.5, 2.5))
BELOW = known("rectangle", 0.4, (8.0, 5.5, 2.05), high_m=0.2)
TRIANGLE = known("triangle", 0.8, (16.0, 5.5, 2.6), 85.0)
DIAMOND = known("diamond", 0.45, (22.0, 5.5, 2.7), 95.0)
FROM_BEHIND = known("square", 0.6, (14.0, -5.5, 2.4), 270.0)
GUIDE = known("rectangle", 1.8, (26.0, 0.5, 6.0), high_m=1.2)
ON_A_POLE = known("circle", 0.6, (22.0, -5.5, 2.6), 270.0)
ON_TWO = known("rectangle", 1.6, (19.0, 6.4, 2.9), high_m=0.8)
PLATES = (CIRCLE, BELOW, TRIANGLE, DIAMOND, FROM_BEHIND, GUIDE, ON_A_POLE, ON_TWO)
BUS_STOP = known("circle", 0.45, (11.5, -5.5, 2.4))
POSTS = (
    (CIRCLE, "single"),
    (FROM_BEHIND, "single"),
    (ON_A_POLE, "attached"),
    (ON_TWO, "double"),
    (GUIDE, "cantilever"),
)


def post(x: float, y: float, top_m: float, radius_m: float = 0.03) -> TriangleShape:
    path = np.array([[x, y, -0.3], [x, y, top_m]])
    return tube(path, np.full(2, radius_m), 16)


def arm(x: float, z: float, y: tuple[float, float]) -> TriangleShape:
    return tube(np.array([[x, y[0], z], [x, y[1], z]]), np.full(2, 0.05), 16)


def street() -> tuple[TriangleShape, ...]:
    """A road with signs, a machine and a low board."""
    return (
        road_along(LENGTH_M),
        *(one.shape for one in PLATES),
        *(post(x, 5.5, 2.9) for x in (7.94, 15.94, 21.94)),
        post(14.06, -5.5, 2.75),
        post(22.15, -5.5, 7.5, 0.14),
        *(post(18.94, y, 3.35, 0.04) for y in (5.9, 6.9)),
        post(25.9, 5.8, 6.6, 0.08),
        arm(25.9, 6.0, (-0.2, 5.8)),
        BUS_STOP.shape,
        post(11.44, -5.5, 2.6),
        box((11.0, 5.4, 0.0), (12.0, 6.1, 1.83)),
        box((19.0, -6.0, 0.3), (19.05, -4.6, 1.5)),
    )


def recording() -> DrivenRecording:
    way = straight(LENGTH_M)
    return DrivenRecording(way, facing_along(way), street(), head=HEAD_45, pulses=3_000)


def shine(cloud: Path, plates: Sequence[KnownPlate] = PLATES) -> None:
    """Give points on the faces of plates, seen from before, the intensity of beads."""
    points = laspy.read(cloud)
    xyz = np.asarray(points.xyz) - ORIGIN
    random = np.random.default_rng(5)
    intensity = random.integers(*DIFFUSE, len(xyz))
    scanner_x = (np.asarray(points.gps_time) - START_S) * SPEED_M_S
    for one in plates:
        right, up, look = axes_of(one.hung)
        about = xyz - np.array(one.middle)
        half = max(one.plate.size_m, one.plate.high_m) * 0.75
        is_on = np.abs(about @ look) < 0.015
        is_on &= (np.abs(about @ right) < half) & (np.abs(about @ up) < half)
        is_before = (scanner_x - one.middle[0]) * look[0] - one.middle[1] * look[1] > 0
        intensity[is_on & is_before] = BRIGHT
    points.intensity = intensity.astype(np.uint16)
    points.write(str(cloud))


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("signs")
    request = delivered(recording(), folder)
    shine(request.inputs[0])
    return imported(folder, request)


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("signs", drives, tmp_path_factory.mktemp("found"))


def sign_at(told: RunOutcome, plate: KnownPlate) -> Candidate:
    """The sign whose centre is near that of a plate."""
    near = [one for one in told.candidates if math.dist(one.xyz[0], plate.centroid + ORIGIN) < 0.2]
    assert len(near) == 1
    return near[0]


def test_signs_are_found_and_boards_are_not(told: RunOutcome) -> None:
    for one in PLATES:
        assert sign_at(told, one).confidence >= 0.5
    assert len(told.candidates) == len(PLATES)
    assert all(one.kind == "sign" for one in told.candidates)


@pytest.mark.parametrize("plate", PLATES, ids=lambda one: one.plate.shape)
def test_shape_size_and_place_are_those_of_the_plate(told: RunOutcome, plate: KnownPlate) -> None:
    found = sign_at(told, plate)
    assert found.attributes["shape"] == plate.plate.shape
    assert found.attributes["size_m"] == pytest.approx(plate.plate.size_m, rel=0.1)
    assert math.dist(found.xyz[0], plate.centroid + ORIGIN) < 0.03


@pytest.mark.parametrize("plate", PLATES, ids=lambda one: one.plate.shape)
def test_a_sign_faces_where_it_shines_seen_from_before_or_behind(
    told: RunOutcome, plate: KnownPlate
) -> None:
    found = sign_at(told, plate).attributes
    assert isinstance(found["facing_deg"], float)
    off = (found["facing_deg"] - plate.facing_deg + 180) % 360 - 180
    assert abs(off) < 3.0
    assert found["height_m"] == pytest.approx(plate.centroid[2], abs=0.2)


@pytest.mark.parametrize("plate", PLATES, ids=lambda one: one.plate.shape)
def test_a_sign_keeps_the_points_on_its_plate_and_no_others(
    told: RunOutcome, drives: tuple[Drive, ...], plate: KnownPlate
) -> None:
    found = sign_at(told, plate)
    assert found.own_points is not None
    assert found.own_drives is not None
    assert np.unique(found.own_points).size == found.own_points.size
    assert found.own_drives.tolist() == [0] * found.own_points.size
    right, up, look = axes_of(plate.hung)
    about = drives[0].coordinates.xyz(np.arange(drives[0].count)) - ORIGIN - np.array(plate.middle)
    half = np.stack([about @ right, about @ up]) / np.abs(outline(plate.plate)).max(axis=0)[:, None]
    is_near = (np.abs(about @ look) < 0.03) & (np.abs(half) < 1.1).all(axis=0)
    assert is_near[found.own_points].all()
    assert found.own_points.size > 0.7 * np.count_nonzero(
        is_near & (np.abs(half) < 0.6).all(axis=0)
    )


def test_a_plate_below_a_sign_is_its_supplement(told: RunOutcome) -> None:
    assert sign_at(told, BELOW).attributes["supplementary"] is True
    assert sign_at(told, CIRCLE).attributes["supplementary"] is False
    assert sign_at(told, CIRCLE).attributes["plates"] == 2


@pytest.mark.parametrize(("plate", "form"), POSTS, ids=[form for _, form in POSTS])
def test_what_a_sign_hangs_on_is_named(told: RunOutcome, plate: KnownPlate, form: str) -> None:
    assert sign_at(told, plate).attributes["post"] == form


FORMS = {"single": "単柱", "double": "複柱", "cantilever": "片持", "attached": "添架"}


def test_the_ledger_of_signs_says_what_is_true(told: RunOutcome, tmp_path: Path) -> None:
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    features = [
        Feature(f"s{number}", "sign", Geometry.POINT, (Vertex((x, y, z)),), {**one.attributes})
        for number, one in enumerate(told.candidates)
        for x, y, z in one.xyz.tolist()
    ]
    path = tmp_path / "ledger_sign.csv"
    write_ledger(path, features, catalogue["sign"], TableStyle(crs="EPSG:6677"))
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file, strict=True))
    assert len(rows) == len(PLATES)
    names = {one.name.ja: one for one in catalogue["sign"].attributes}
    ids = {id_ for one in told.candidates for id_ in one.attributes}
    assert not ids & rows[0].keys(), "columns are called by their names"
    shapes = names["板形状"]
    for plate, form in POSTS:
        place = plate.centroid + ORIGIN
        (row,) = (
            row
            for row in rows
            if abs(float(row["東距(Y) [m]"]) - place[0]) < 0.05
            and abs(float(row["北距(X) [m]"]) - place[1]) < 0.05
            and abs(float(row["標高(H) [m]"]) - place[2]) < 0.05
        )
        assert row["板形状"] == shapes.name_of_choice(plate.plate.shape).ja
        assert float(row["板寸法 [m]"]) == pytest.approx(plate.plate.size_m, rel=0.1)
        assert row["支柱形式"] == FORMS[form]
        assert row["板枚数"] == ("2" if plate is CIRCLE else "1")
        off = float(row["向き（北から時計回り） [°]"]) - plate.facing_deg
        assert abs((off + 180) % 360 - 180) < 3.0


@pytest.mark.parametrize("plate", [CIRCLE, BUS_STOP], ids=["sign", "bus stop"])
def test_diagnostics_draw_an_outline_on_a_plate_and_say_what_speaks_for_it(
    drives: tuple[Drive, ...], plate: KnownPlate
) -> None:
    place = plate.centroid + ORIGIN
    scanlines = scanline_through(drives[0], place, ScanlineSettings())
    assert scanlines is not None
    looked_at = diagnose_signs(RequestedPosition(drives[0], place, scanlines), SignParameters())
    (found,) = (one for one in looked_at if math.dist(one.xyz, place) < 0.05)
    assert found.is_taken is (plate is CIRCLE)
    assert found.outcomes[0].is_met is (plate is CIRCLE)
    assert found.outline is not None
    radii = np.linalg.norm(found.outline - place, axis=1)
    assert radii == pytest.approx(plate.plate.size_m / 2, abs=0.04)


def test_signs_are_found_without_a_trajectory(tmp_path: Path) -> None:
    request = delivered(recording(), tmp_path)
    shine(request.inputs[0])
    told = told_of("signs", replace(request, trajectories=()), tmp_path)
    assert sign_at(told, TRIANGLE).attributes["shape"] == "triangle"
    assert sign_at(told, GUIDE).attributes["shape"] == "rectangle"


def asked(drives: tuple[Drive, ...], table: Path, text: str) -> CandidateResult:
    """What is found by positions."""
    table.write_text(text, "utf-8")
    request = RunRequest("signs", drives[0], SignParameters(positions=str(table)), drives[1:])
    result = run(request, SilentMonitor(), into=table.parent / "columns")
    assert isinstance(result, CandidateResult)
    return result


def test_given_positions_give_their_signs_and_name_the_others(
    drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    (x, y, z), (u, v, w) = CIRCLE.centroid + ORIGIN, TRIANGLE.centroid + ORIGIN
    rows = [
        "easting_m,northing_m,height_m,shape,size_m",
        f"{x + 1.2:.2f},{y - 1.0:.2f},{z + 0.3:.2f},,",
        f"{u - 0.9:.2f},{v + 0.8:.2f},{w:.2f},triangle,0.8",
        f"{x + 500:.2f},{y:.2f},,,",
        f"{y:.2f},{x:.2f},,,",
        "139.7,35.6,,,",
        f"{x - 4.5:.2f},{y:.2f},,,",
    ]
    result = asked(drives, tmp_path / "positions.csv", "\n".join(rows) + "\n")
    found = sorted(tuple(one.xyz[0].round(1)) for one in result.candidates)
    assert found == sorted(tuple((one.centroid + ORIGIN).round(1)) for one in (CIRCLE, TRIANGLE))
    sentences = [one for one in result.note.en.split(". ") if one]
    assert len(sentences) == 4
    for line in (4, 5, 6, 7):
        assert sum(f"{line}" in one.split(":")[1] for one in sentences) == 1


def test_heights_of_another_reference_are_named_and_tell_nothing(
    drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    x, y, z = CIRCLE.centroid + ORIGIN
    text = f"easting_m,northing_m,height_m\n{x + 0.4:.2f},{y:.2f},{z + 37.1:.2f}\n"
    result = asked(drives, tmp_path / "positions.csv", text)
    (found,) = result.candidates
    assert np.hypot(found.xyz[0][0] - x, found.xyz[0][1] - y) < 0.1
    assert "not used: 2" in result.note.en


def test_a_given_shape_that_the_points_speak_against_is_not_taken(
    drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    x, y, z = CIRCLE.centroid + ORIGIN
    text = f"easting_m,northing_m,height_m,shape,size_m\n{x:.2f},{y:.2f},{z:.2f},triangle,1.2\n"
    (found,) = asked(drives, tmp_path / "positions.csv", text).candidates
    assert (found.attributes["shape"], found.attributes["size_m"]) == ("circle", 0.6)


@pytest.mark.parametrize(
    ("text", "line"),
    [("x,y\n1,2\n", "line 1"), ("easting_m,northing_m\n1,2\n3,much\n", "line 3"),
     ("easting_m,northing_m,shape\n1,2,star\n", "line 2")],
)  # fmt: skip
def test_a_file_that_is_no_table_of_positions_is_refused(
    drives: tuple[Drive, ...], tmp_path: Path, text: str, line: str
) -> None:
    with pytest.raises(BadFile) as refused:
        asked(drives, tmp_path / "positions.csv", text)
    assert line in refused.value.where.en


def test_points_without_intensity_are_told(tmp_path: Path) -> None:
    way = straight(12.0)
    plain = DrivenRecording(way, facing_along(way), (road_along(12.0), CIRCLE.shape))
    told = told_by("signs", recorded(tmp_path, replace(plain, pulses=2_000)), tmp_path)
    assert "intensity" in told.sentence
