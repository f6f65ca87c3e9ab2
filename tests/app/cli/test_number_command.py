"""``zuka number`` fills in what ledgers ask for, once; the window can take it back."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Vertex
from processing.project.project import Project


def _feature(id_: str, kind: str, *xy: tuple[float, float], **own: AttributeValue) -> Feature:
    geometry = Geometry.LINE if len(xy) > 1 else Geometry.POINT
    return Feature(id_, kind, geometry, tuple(Vertex((x, y, 0.0)) for x, y in xy), own)


_TREES = (
    _feature("far", "street_tree", (45.0, 3.0)),
    _feature("near", "street_tree", (5.0, 3.0)),
)
_CENTRE = _feature("centre", "road_center", (0.0, 0.0), (60.0, 0.0), route="市道1号線")


def _project(folder: Path, *features: Feature) -> Path:
    with closing(Project.create(folder / "street.zuka", "EPSG:6677")) as project:
        project.features.apply(Text.same("drawn"), Change(added=features))
        return project.folder


def _number(project: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    status = run_in_terminal(["number", str(project)])
    printed = capsys.readouterr()
    return status, printed.out + printed.err


def test_trees_get_numbers_once_and_the_step_can_be_taken_back(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")
    folder = _project(tmp_path, *_TREES, _CENTRE)
    assert _number(folder, capsys)[0] == DONE
    with closing(Project.open(folder)) as project:
        told = {one.id: one.attributes for one in project.features.all()}
        assert [told[id_]["number"] for id_ in ("near", "far")] == ["1", "2"]
        assert told["near"]["route"] == "市道1号線"
        steps = project.history.position
    status, printed = _number(folder, capsys)
    assert status == DONE
    assert "filled in" in printed
    with closing(Project.open(folder, writing=True)) as project:
        assert project.history.position == steps
        project.features.undo()
        assert all("number" not in one.attributes for one in project.features.all())


def test_a_map_without_a_centre_line_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "ja")
    status, printed = _number(_project(tmp_path, *_TREES), capsys)
    assert status == BAD_INPUT
    assert "道路中心線がありません" in printed
    assert printed.strip().count("\n") == 0
    assert _number(tmp_path / "none.zuka", capsys)[0] == BAD_INPUT
