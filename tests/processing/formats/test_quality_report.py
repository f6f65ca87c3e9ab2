"""The quality report says the same in every file, and in both languages."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from processing.core.text import Language
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Provenance, Status, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.pages import plain, words_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))


def _line(id_: str, *positions: Position, status: Status = Status.ACCEPTED) -> Feature:
    vertices = tuple(map(Vertex, positions))
    return Feature(id_, "road_edge", Geometry.LINE, vertices, {}, status)


_CROSSING = (
    _line("one", (0.0, 0.0, 5.0), (10.0, 10.0, 5.0)),
    _line("other", (0.0, 10.0, 5.0), (10.0, 0.0, 5.0)),
)


def _written(folder: Path, *features: Feature, language: Language = "en") -> dict[str, Path]:
    request = ExportRequest(("qa",), folder, language)
    paths = export(features, _CATALOGUE, "EPSG:6677", request)
    return {path.suffix: path for path in paths}


@pytest.mark.parametrize(
    ("language", "rule"), [("en", "Lines of one kind cross"), ("ja", "同じ種別の線の交差")]
)
def test_a_finding_stands_in_every_file_with_its_place(
    tmp_path: Path, language: Language, rule: str
) -> None:
    files = _written(tmp_path, *_CROSSING, language=language)
    assert {path.name for path in files.values()} == {"qa.pdf", "qa.html", "qa.json"}
    numbers = json.loads(files[".json"].read_text(encoding="utf-8"))
    (finding,) = numbers["findings"]
    assert (finding["rule"], finding["features"]) == ("crossing", ["one", "other"])
    assert (finding["easting_m"], finding["northing_m"]) == (5.0, 5.0)
    assert (numbers["errors"], numbers["crs"]) == (1, "EPSG:6677")
    page = plain(files[".html"].read_text(encoding="utf-8"))
    for words in (page, "".join(words_of(files[".pdf"]))):
        assert plain(rule) in words
        assert "5.000" in words


def test_candidates_count_although_they_are_not_handed_in(tmp_path: Path) -> None:
    candidate = _line("maybe", (0.0, 20.0, 5.0), (9.0, 20.0, 5.0), status=Status.CANDIDATE)
    files = _written(tmp_path, candidate, _CROSSING[0])
    numbers = json.loads(files[".json"].read_text(encoding="utf-8"))
    assert [one["rule"] for one in numbers["findings"]] == ["undecided"]
    assert numbers["decided_share"] == 0.0
    assert numbers["errors"] == 0


def test_an_empty_map_has_a_report_without_findings(tmp_path: Path) -> None:
    files = _written(tmp_path)
    assert json.loads(files[".json"].read_text(encoding="utf-8"))["findings"] == []
    assert "Nothing was found." in files[".html"].read_text(encoding="utf-8")
    assert plain("Nothing was found.") in words_of(files[".pdf"])[0]


def test_words_of_a_map_are_no_markup(tmp_path: Path) -> None:
    odd = _line("<b>&", (0.0, 0.0, 5.0), (0.001, 0.0, 5.0))
    page = _written(tmp_path, odd)[".html"].read_text(encoding="utf-8")
    assert "&lt;b&gt;&amp;" in page
    assert "<b>" not in page


def test_precision_and_recall_are_those_of_the_review(tmp_path: Path) -> None:
    by_tool = Provenance("curbs", 1, {}, 0.9)
    lines = [_line(f"f{at}", (0.0, 9.0 * at, 5.0), (5.0, 9.0 * at, 5.0)) for at in range(4)]
    found = [replace(one, provenance=by_tool) for one in lines]
    found[3] = replace(found[3], status=Status.REJECTED)
    missed = _line("missed", (0.0, 90.0, 5.0), (5.0, 90.0, 5.0))
    files = _written(tmp_path, *found, missed)
    (kind,) = json.loads(files[".json"].read_text(encoding="utf-8"))["kinds"]
    assert (kind["precision"], kind["recall"]) == (0.75, 0.75)
    assert "75.0%" in plain(files[".html"].read_text(encoding="utf-8"))
    by_hand = _written(tmp_path / "hand", missed)
    (kind,) = json.loads(by_hand[".json"].read_text(encoding="utf-8"))["kinds"]
    assert (kind["precision"], kind["recall"]) == (None, None)


def test_what_a_ledger_lists_without_number_or_route_is_a_place_to_look_at(tmp_path: Path) -> None:
    tree = Feature("t", "street_tree", Geometry.POINT, (Vertex((0.0, 0.0, 0.0)),), {"number": "1"})
    whole = replace(tree, id="u", vertices=(Vertex((9.0, 0.0, 0.0)),),
                    attributes={"number": "2", "route": "市道1号線"})  # fmt: skip
    files = _written(tmp_path, tree, whole)
    numbers = json.loads(files[".json"].read_text(encoding="utf-8"))
    assert [(one["rule"], one["features"]) for one in numbers["findings"]] == [
        ("ledger_missing", ["t"])
    ]
    assert numbers["errors"] == 0
