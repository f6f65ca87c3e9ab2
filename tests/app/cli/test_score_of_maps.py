"""``zuka score`` on maps and volumes: JSON, tables in both languages, files that don't fit."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.cli.terminal import DONE, run_in_terminal
from tests.app.score_answers import refused, scored
from tests.processing.scoring.small_maps import ORIGIN, gutter, street_curbs

TREES = [
    ("Point", [6.0 * number, 0.0, 0.0], {"kind": "tree", "dbh_m": 0.12, "height_m": 5.0})
    for number in range(6)
]


def write_map(path: Path, features: Any = None, crs: str | None = "EPSG:6677") -> Path:
    """Trees, or features given as type, offsets from the origin, and facts."""
    members = [
        {
            "type": "Feature",
            "geometry": {"type": kind, "coordinates": shifted(positions)},
            "properties": facts,
        }
        for kind, positions, facts in (TREES if features is None else features)
    ]
    name = crs and f"urn:ogc:def:crs:EPSG::{crs.removeprefix('EPSG:')}"
    member = name and {"type": "name", "properties": {"name": name}}
    whole = {"type": "FeatureCollection", "crs": member, "features": members}
    path.write_text(json.dumps(whole), "utf-8")
    return path


def shifted(positions: Any) -> Any:
    if isinstance(positions[0], list):
        return [shifted(one) for one in positions]
    return [one + float(origin) for one, origin in zip(positions, ORIGIN, strict=True)]


def test_the_json_has_every_count_error_and_limit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truth = write_map(tmp_path / "truth.geojson")
    thick = [("Point", [x + 0.3, y, z], {**facts, "dbh_m": 0.14}) for _, (x, y, z), facts in TREES]
    result = write_map(tmp_path / "結果.geojson", thick[:-1])
    reported = scored(capsys, "trees", result, truth)
    assert (reported["tool"], reported["result"]) == ("trees", str(result))
    trees = reported["classes"]["trees"]
    assert (trees["tp"], trees["fp"], trees["fn"], trees["tn"]) == (5, 0, 1, None)
    assert (trees["precision"], trees["recall"]) == (1.0, pytest.approx(5 / 6))
    assert reported["errors"]["dbh"]["mean_abs"] == pytest.approx(0.02)
    assert reported["errors"]["place"]["max"] == pytest.approx(0.3)
    assert reported["errors"]["crown"] == {
        "unit": "m",
        "count": 0,
        **dict.fromkeys(("mean", "mean_abs", "rms", "p95", "max")),
    }
    assert reported["limits"]["within_m"] == 2.0
    assert reported["left_out"]["unseen"] == 0


@pytest.mark.parametrize("tool", ["curbs", "gutters"])
def test_a_truth_against_itself_is_all_right_in_a_table_that_lines_up(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tool: str
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "ja")
    made = {"curbs": street_curbs(), "gutters": gutter()}[tool]
    features = []
    for one in made.features:
        positions = (one.xyz - ORIGIN).tolist()
        is_area = one.shape == "area"
        shape = [[*positions, positions[0]]] if is_area else positions
        features.append(("Polygon" if is_area else "LineString", shape, dict(one.facts)))
    path = write_map(tmp_path / "a.geojson", features)
    assert run_in_terminal(["score", tool, str(path), str(path)]) == DONE
    lines = capsys.readouterr().out.splitlines()
    head, *rows = lines[2 : lines.index("", 2)]
    assert head.split() == ["評価対象", "適合率", "再現率", "F値", "TP", "FP", "FN", "TN"]
    assert all(row.count("100.000 %") == 3 for row in rows)
    ends = {len(line) + sum(ord(one) > 0x2E80 for one in line) for line in (head, *rows)}
    assert len(ends) == 1


def test_markings_are_scored_in_a_table_that_names_what_was_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")
    line = [[0.0, 0.0, 0.0], [20.0, 0.0, 0.0]]
    bar = [[5.0, 4.0, 0.0], [5.0, 7.0, 0.0]]
    features = [
        ("LineString", line, {"kind": "marking_line", "type": "solid", "width_m": 0.15}),
        ("LineString", bar, {"kind": "crosswalk_bar", "piece_points": [2]}),
    ]
    path = write_map(tmp_path / "a.geojson", features)
    assert run_in_terminal(["score", "markings", str(path), str(path)]) == DONE
    told = capsys.readouterr().out
    lines = next(row for row in told.splitlines() if row.startswith("lines"))
    assert lines.split()[-4:] == ["200", "0", "0", "–"]
    left = next(row for row in told.splitlines() if row.startswith("bars of crossings not"))
    assert left.split()[-1] == "1"


def test_volumes_are_scored_from_their_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truth = {"cut_m3": 200.0, "fill_m3": 500.0, "net_m3": 300.0, "area_m2": 1000.0}
    (tmp_path / "truth.json").write_text(json.dumps({**truth, "polygon": [[0, 1]]}), "utf-8")
    found = {**truth, "cut_m3": 190.0, "uncertainty_m3": 20.0, "method": "grid"}
    (tmp_path / "result.json").write_text(json.dumps(found), "utf-8")
    reported = scored(capsys, "volume", tmp_path / "result.json", tmp_path / "truth.json")
    assert reported["figures"]["cut_off"] == pytest.approx(-0.05)
    assert reported["shares"]["within_uncertainty"] == {"count": 3, "of": 3, "share": 1.0}
    assert (
        run_in_terminal(
            ["score", "volume", str(tmp_path / "result.json"), str(tmp_path / "truth.json")]
        )
        == DONE
    )
    assert "-5.000 %" in capsys.readouterr().out
    for text, says in (
        ("[]", "no JSON object"),
        ("{", "no JSON object"),
        ("{}", "cut_m3, fill_m3"),
    ):
        (tmp_path / "wrong.json").write_text(text, "utf-8")
        assert says in refused(capsys, "volume", tmp_path / "wrong.json", tmp_path / "truth.json")


def test_files_that_do_not_fit_are_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truth = write_map(tmp_path / "truth.geojson")
    other = write_map(tmp_path / "other.geojson", crs="EPSG:6678")
    assert "The result is in EPSG:6678, the truth in EPSG:6677." in refused(
        capsys, "trees", other, truth
    )
    unknown = write_map(tmp_path / "unknown.geojson", crs=None)
    assert scored(capsys, "trees", unknown, truth)["classes"]["trees"]["tp"] == 6
    assert "none of: signs" in refused(capsys, "signs", truth, truth)
    line = [("LineString", [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], {"kind": "tree"})]
    wrong = write_map(tmp_path / "wrong.geojson", line)
    assert "a line, not a point" in refused(capsys, "trees", wrong, truth)
    assert "GeoPackage, GeoJSON" in refused(capsys, "trees", tmp_path / "a.csv", truth)
    assert "no such file" in refused(capsys, "trees", tmp_path / "none.geojson", truth)
    (tmp_path / "text.geojson").write_text("not JSON", "utf-8")
    assert "no GeoJSON" in refused(capsys, "trees", truth, tmp_path / "text.geojson")
    degrees = {"type": "Point", "coordinates": [139.7, 35.6]}
    (tmp_path / "degrees.geojson").write_text(json.dumps(degrees), "utf-8")
    assert "degrees" in refused(capsys, "trees", tmp_path / "degrees.geojson", truth)
