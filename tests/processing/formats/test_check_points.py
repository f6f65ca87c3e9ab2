"""The quality report says how near the map comes to check points, and judges it by its level."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Status, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.pages import plain, words_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))


def _hole(id_: str, x: float, *, kind: str = "manhole", hidden: bool = False) -> Feature:
    vertex = Vertex((x, 0.0, 10.0), is_occluded=hidden)
    return Feature(id_, kind, Geometry.POINT, (vertex,))


_HOLES = (_hole("a", 0.0), _hole("b", 10.0), _hole("c", 20.0, hidden=True), _hole("d", 30.0))
_ROWS = (
    "P1,0.03,0.04,10.06,,check",
    "P2,10.0,0.1,9.92,manhole,check",
    "P3,20.0,0.0,10.5,,",
    "P4,40.0,0.0,10.0,,",
    "G1,0.0,0.0,12.0,,control",
)


def _report(
    folder: Path, *rows: str, features: tuple[Feature, ...] = _HOLES, **options: str
) -> Any:
    folder.mkdir(exist_ok=True)
    table = folder / "検証点.csv"
    lines = ["id,easting_m,northing_m,height_m,kind,role", *rows]
    table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    chosen = {"check_points": str(table), **options}
    request = ExportRequest(("qa",), folder / "out", "ja", chosen)
    paths = {one.suffix: one for one in export(features, _CATALOGUE, "EPSG:6677", request)}
    return json.loads(paths[".json"].read_text(encoding="utf-8"))["check_points"], paths


def test_rmse_largest_and_verdict_are_those_of_the_differences(tmp_path: Path) -> None:
    numbers, paths = _report(tmp_path, *_ROWS)
    assert numbers["plan"] == {
        "count": 3,
        "rmse_m": pytest.approx(((0.05**2 + 0.1**2) / 3) ** 0.5, abs=1e-4),
        "max_m": 0.1,
        "limit_m": 0.25,
        "passes": True,
    }
    assert numbers["height"]["count"] == 2  # c rests on no measured point
    assert numbers["height"]["rmse_m"] == pytest.approx(((0.06**2 + 0.08**2) / 2) ** 0.5, abs=1e-4)
    assert numbers["missing"] == ["P4"]
    assert [one["feature"] for one in numbers["points"]] == ["a", "b", "c", None]
    page = plain(paths[".html"].read_text(encoding="utf-8"))
    for words in (page, plain("".join(words_of(paths[".pdf"])))):
        for expected in ("検証点による精度", "0.065", "P4", "該当なし", "適合"):
            assert plain(expected) in words


def test_a_finer_level_is_harder_and_candidates_do_not_count(tmp_path: Path) -> None:
    row = "P1,0.2,0.0,10.0,,"
    assert _report(tmp_path / "500", row)[0]["plan"]["passes"]
    fine = _report(tmp_path / "250", row, map_level="250")[0]
    assert (fine["plan"]["passes"], fine["plan"]["limit_m"]) == (False, 0.12)
    doubted = Feature("x", "manhole", Geometry.POINT, _HOLES[0].vertices, {}, Status.CANDIDATE)
    none = _report(tmp_path / "none", row, features=(doubted,))[0]
    assert (none["plan"]["count"], none["plan"]["passes"], none["missing"]) == (0, False, ["P1"])


def test_a_kind_restricts_what_a_point_is_compared_with(tmp_path: Path) -> None:
    features = (_hole("near", 0.1, kind="pole"), _hole("far", 0.3))
    row = "P1,0.0,0.0,10.0,manhole,"
    assert _report(tmp_path, row, features=features)[0]["points"][0]["feature"] == "far"


@pytest.mark.parametrize(
    ("row", "error"),
    [
        ("P1,abc,0.0,1.0,,", BadFile),
        ("P1,0.0", BadFile),
        ("P1,0.0,0.0,1.0,castle,", OutOfRange),
        ("P1,0.0,0.0,1.0,,control", OutOfRange),
    ],
)
def test_bad_check_points_are_refused_and_nothing_is_written(
    tmp_path: Path, row: str, error: type[Exception]
) -> None:
    with pytest.raises(error):
        _report(tmp_path, row)
    assert not list((tmp_path / "out").glob("*"))
    request = ExportRequest(("qa",), tmp_path / "out", "ja", {"check_points": "none.csv"})
    with pytest.raises(MissingInput):
        export(_HOLES, _CATALOGUE, "EPSG:6677", request)


def test_a_hand_check_gives_precision_and_recall_in_every_form(tmp_path: Path) -> None:
    request = ExportRequest(("gpkg",), tmp_path / "hand")
    (hand,) = export(_HOLES[:2], _CATALOGUE, "EPSG:6677", request)
    chosen = {"check_map": str(hand)}
    request = ExportRequest(("qa",), tmp_path / "out", "ja", chosen)
    paths = {one.suffix: one for one in export(_HOLES, _CATALOGUE, "EPSG:6677", request)}
    (row,) = json.loads(paths[".json"].read_text(encoding="utf-8"))["hand_check"]
    assert row["unit"] == "count"
    assert row["amount"] == 2
    assert row["map"] == {"precision": 1.0, "recall": 1.0}
    assert row["tools"]["recall"] == 0.0
    page = plain(paths[".html"].read_text(encoding="utf-8"))
    for words in (page, plain("".join(words_of(paths[".pdf"])))):
        assert plain("別途点検による適合率") in words
