"""``zuka run curbs`` and ``gutters`` on a street with both: files by the contract, and scores."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import pyogrio
import pytest

from app.cli.terminal import DONE, run_in_terminal
from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from tests.app.score_answers import scored

STREET = StreetRequest(seed=418, length_m=30.0, style="rural", images=False)
GEOMETRY = {"curbs": "LineString", "gutters": "Polygon"}
WORDS = {
    "curbs": {"edge": {"upper", "lower"}, "type": {"curb", "dropped"}},
    "gutters": {"type": {"lid", "grating"}},
}
MEASURES = {"curbs": ("height_m",), "gutters": ("width_m", "length_m")}
COUNTS = {"curbs": ("without_dropped", "all"), "gutters": ("slots", "lids")}
LEAST_F = {"without_dropped": 0.95, "all": 0.92, "slots": 0.93, "lids": 0.90}
"""A short street has few sections: one more or less is some percent."""
BOTH = pytest.mark.parametrize("tool", ["curbs", "gutters"])


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A delivery of 30 m with truth, and a project of it."""
    folder = tmp_path_factory.mktemp("道路")
    made = simulate_street(STREET, folder / "street", SilentMonitor())
    words = ["import", str(folder / "通り.zuka"), *map(str, made.points)]
    assert run_in_terminal([*words, "--trajectory", str(made.trajectories[0])]) == DONE
    return folder


@pytest.fixture(scope="module")
def results(street: Path) -> dict[tuple[str, str], Path]:
    """Every tool's result in every format."""
    found = {}
    for tool in GEOMETRY:
        for ending in ("geojson", "csv", "gpkg", "dxf"):
            path = street / f"結果 {tool}.{ending}"
            words = ["run", tool, str(street / "通り.zuka"), "--output", str(path)]
            assert run_in_terminal(words) == DONE
            found[tool, ending] = path
    return found


def members(path: Path) -> list[dict[str, Any]]:
    whole = json.loads(path.read_text("utf-8"))
    assert whole["crs"]["properties"]["name"].endswith("6677")
    found: list[dict[str, Any]] = whole["features"]
    return found


@BOTH
def test_geojson_has_what_the_contract_names(
    results: dict[tuple[str, str], Path], tool: str
) -> None:
    features = members(results[tool, "geojson"])
    assert features
    for one in features:
        facts = one["properties"]
        assert one["geometry"]["type"] == GEOMETRY[tool]
        assert isinstance(facts["kind"], str)
        assert 0.0 <= facts["confidence"] <= 1.0
        assert facts["status"] == "candidate"
        assert isinstance(facts["run"], int | str)
        for name, known in WORDS[tool].items():
            assert facts[name] in known
        for name in MEASURES[tool]:
            assert 0.0 < facts[name] < 3.0
        positions = one["geometry"]["coordinates"]
        for position in positions[0] if tool == "gutters" else positions:
            assert len(position) == 3


def test_every_curb_has_both_edges_along_the_drive(results: dict[tuple[str, str], Path]) -> None:
    edges: dict[object, list[str]] = {}
    for one in members(results["curbs", "geojson"]):
        edges.setdefault(one["properties"]["run"], []).append(one["properties"]["edge"])
    assert all(set(pair) == {"upper", "lower"} for pair in edges.values())


def test_every_cover_has_four_corners(results: dict[tuple[str, str], Path]) -> None:
    for one in members(results["gutters", "geojson"]):
        (ring,) = one["geometry"]["coordinates"]
        assert len(ring) == 5
        assert ring[0] == ring[-1]


@BOTH
def test_table_and_geopackage_hold_the_same_features(
    results: dict[tuple[str, str], Path], tool: str
) -> None:
    features = members(results[tool, "geojson"])
    with results[tool, "csv"].open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["status"] for row in rows} == {"candidate"}
    assert {row["type"] for row in rows} == {one["properties"]["type"] for one in features}
    layers = pyogrio.list_layers(results[tool, "gpkg"])[:, 0]
    frames = [pyogrio.raw.read(results[tool, "gpkg"], layer=layer) for layer in layers]
    assert sum(len(shapes) for _, _, shapes, _ in frames) == len(features)
    for reported, _, _, _ in frames:
        assert {"confidence", "status", "run", "type", *MEASURES[tool]} <= set(reported["fields"])


@BOTH
def test_the_drawing_is_sound_and_has_faces_of_lids(
    results: dict[tuple[str, str], Path], tool: str
) -> None:
    drawing = ezdxf.filemanagement.readfile(results[tool, "dxf"])
    audit = drawing.audit()
    assert not audit.errors
    assert not audit.fixes
    space = drawing.modelspace()
    features = members(results[tool, "geojson"])
    assert len(space.query("POLYLINE")) >= len(features)
    faces = len(space.query("3DFACE"))
    assert faces > len(features) if tool == "gutters" else faces == 0


@BOTH
@pytest.mark.parametrize("ending", ["geojson", "gpkg"])
def test_the_result_scores_as_promised(
    street: Path,
    results: dict[tuple[str, str], Path],
    capsys: pytest.CaptureFixture[str],
    tool: str,
    ending: str,
) -> None:
    truth = street / "street" / "truth" / f"{tool}.geojson"
    capsys.readouterr()
    reported = scored(capsys, tool, results[tool, ending], truth)["classes"]
    for name in COUNTS[tool]:
        assert reported[name]["f"] >= LEAST_F[name], (name, reported[name])
