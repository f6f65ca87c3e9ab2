"""``zuka run volume`` as tests run it, and the small files that they give it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from processing.formats.surfaces.landxml_writing import LandXmlFacts, WrittenSurface, write_landxml
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface

CORNER = np.array([-12_380.0, -36_690.0, 5.0])
SIDE_M = 20.0


def write_polygon(path: Path, corners: list[list[float]]) -> Path:
    ring = [[*(CORNER[:2] + position).tolist()] for position in [*corners, corners[0]]]
    shape = {"type": "Polygon", "coordinates": [ring]}
    member = {"type": "Feature", "properties": {}, "geometry": shape}
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [member]}))
    return path


def write_design(path: Path, *names: str) -> Path:
    """Level squares over the whole site, each surface a metre above the last."""
    plan = np.array([[0.0, 0.0], [SIDE_M, 0.0], [SIDE_M, SIDE_M], [0.0, SIDE_M]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    surfaces = [
        WrittenSurface(
            TriangleSurface(np.column_stack([plan, np.full(4, 2.0 + up)]) + CORNER, faces, name)
        )
        for up, name in enumerate(names)
    ]
    facts = LandXmlFacts(project="test", crs="EPSG:6677", height_datum="T.P.")
    write_landxml(path, surfaces, facts)
    return path


def run(output: Path, *words: object) -> int:
    status = run_in_terminal(["run", "volume", *map(str, words), "--output", str(output)])
    assert isinstance(status, int)
    return status


def reported(output: Path, before: object, after: object, *settings: str) -> dict[str, Any]:
    words = [word for setting in settings for word in ("--set", setting)]
    assert run(output, "--before", before, "--after", after, *words) == DONE
    found: dict[str, Any] = json.loads(output.read_text(encoding="utf-8"))
    return found


def refused(
    folder: Path, capsys: pytest.CaptureFixture[str], *words: object, name: str = "out.json"
) -> str:
    """The one line that says what is wrong; nothing is written."""
    kept = sorted(path for path in folder.rglob("*") if path.is_file())
    capsys.readouterr()
    assert run(folder / name, *words) == BAD_INPUT
    written = capsys.readouterr()
    assert sorted(path for path in folder.rglob("*") if path.is_file()) == kept
    # Progress comes before it; what is wrong is the last line, and one line.
    line = written.err.rstrip("\n").splitlines()[-1]
    assert line.count(" | ") == 2
    return line
