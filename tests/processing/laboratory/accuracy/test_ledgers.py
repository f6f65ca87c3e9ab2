"""Ledgers of a street held against its truth: rows, places, words and numbers."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.ledgers import LEDGERS, Row, checked_ledger, written_rows
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from resources import path_of

_, SIGNS, POLES = LEDGERS
DRAWN = {"trees": {"street_tree"}, "signs": {"sign"}, "poles": {"power_pole", "street_light"}}
WITHIN_M = {"trees": 0.3, "signs": 0.06, "poles": 0.2}
"""Of what is drawn on the sample street: feet are where bark and steel were met, in whole
centimetres."""


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    street = path_of("sample_street/trajectory.csv").parent
    points = (street / "left.laz", street / "right.laz")
    request = ImportRequest(points, (street / "trajectory.csv",), crs="EPSG:6677")
    into = tmp_path_factory.mktemp("sample") / "drives"
    return tuple(map(Drive, import_drives(request, into, SilentMonitor())))


def drawn(tool: str) -> list[list[float]]:
    """Places of the drawing that comes with the sample street."""
    stored = json.loads(path_of("sample_street/drawing.json").read_text("utf-8"))
    return [one["places"][0] for one in stored["features"] if one["kind"] in DRAWN[tool]]


def place_of(row: Row) -> tuple[float, float, float]:
    return float(row["easting_m"]), float(row["northing_m"]), float(row["elevation_m"])


def far(row: Row, places: list[list[float]]) -> float:
    """From a row's place in plan to the nearest of places."""
    return min(math.dist(place_of(row)[:2], place[:2]) for place in places)


def test_the_ledgers_of_the_sample_street_have_a_row_for_each_thing_and_no_other(
    sample: tuple[Drive, ...], tmp_path: Path
) -> None:
    rows = {one.tool: written_rows(one, sample, tmp_path) for one in LEDGERS}
    trees, signs = rows["trees"], rows["signs"]
    assert (len(trees), len(signs)) == (len(drawn("trees")), len(drawn("signs")))
    for tool, those in (("trees", trees), ("signs", signs)):
        assert max(far(one, drawn(tool)) for one in those) < WITHIN_M[tool]
    shapes = sorted((one["shape"], one["size_m"]) for one in signs)
    assert shapes == [
        ("circle", "0.600"), ("circle", "0.600"), ("diamond", "0.450"), ("diamond", "0.600"),
        ("pentagon", "0.600"), ("rectangle", "0.400"),
    ]  # fmt: skip
    assert all(0.3 < float(one["girth_m"]) < 1.5 for one in trees)
    posts = [one for one in rows["poles"] if one["type"] == "sign_pole"]
    others = [one for one in rows["poles"] if one["type"] != "sign_pole"]
    assert len(posts) == 4
    assert max(far(one, [[*place_of(sign)] for sign in signs]) for one in posts) < 0.15
    assert len(others) == len(drawn("poles"))
    assert max(far(one, drawn("poles")) for one in others) < WITHIN_M["poles"]
    assert sorted(one["type"] for one in others) == ["street_light"] * 2 + ["utility_pole"]


def row(east: float, north: float, up: float, **cells: str) -> Row:
    return {"easting_m": f"{east}", "northing_m": f"{north}", "elevation_m": f"{up}", **cells}


def true(east: float, north: float, up: float, **facts: object) -> MappedFeature:
    return MappedFeature(1, "point", np.array([[east, north, up]]), facts)


def test_rows_are_paired_by_place_and_numbers_and_words_compared() -> None:
    rows = (
        row(1.0, 2.0, 3.1, shape="circle", size_m="0.600", facing_deg="359.0"),
        row(9.0, 2.0, 3.0, shape="square", size_m="0.600", facing_deg="10.0"),
        row(50.0, 2.0, 3.0, shape="square", size_m="0.600", facing_deg="10.0"),
    )
    seen = {"front_points": 50}
    truth = MappedFile(Path("signs.geojson"), "", (
        true(1.0, 2.1, 3.0, shape="circle", size_m=0.6, facing_deg=1.0, **seen),
        true(9.1, 2.0, 3.0, shape="diamond", size_m=0.6, facing_deg=14.0, **seen),
        true(20.0, 2.0, 3.0, shape="circle", size_m=0.6, facing_deg=1.0, **seen),
        true(30.0, 2.0, 3.0, shape="circle", size_m=0.6, facing_deg=1.0, front_points=2),
    ))  # fmt: skip
    checked = checked_ledger("street", SIGNS, rows, truth)
    street, name, count, found, told = checked.cells()
    assert (street, name, count, found) == ("street", "signs", "3", "2, 1, 1")
    assert told.split("; ") == [
        "shape 1 of 2", "size_m 0.000, 0.000", "height_m –", "facing_deg 3.162, 4.000",
    ]  # fmt: skip


def test_a_street_without_rows_has_a_table_row_too() -> None:
    truth = MappedFile(Path("poles.geojson"), "", ())
    assert checked_ledger("street", POLES, (), truth).cells()[2:4] == ["0", "0, 0, 0"]
