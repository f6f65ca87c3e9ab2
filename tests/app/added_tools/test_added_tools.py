"""Two tools of one file each are the program's own as soon as the registry lists them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import laspy
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox
from pytestqt.qtbot import QtBot

from app.cli.terminal import DONE, run_in_terminal
from app.window.window_parts import WindowParts
from processing.map.catalogue_file import read_catalogue
from processing.project.importing.importing import ImportRequest
from processing.section.stations import Stations
from processing.tools.listed.registry import TOOLS, asked_classes, every_tool, scorer_of, scorers
from resources import path_of
from tests.app.added_tools.high_points import CROWN, HIGH_POINTS, OTHER, HighPointsParameters
from tests.app.added_tools.highest_point import HIGHEST_POINT, HighestPointParameters
from tests.app.score_answers import scored
from tests.builders import SimulatedDrive, simulated_drive, write_laz, write_trajectory_csv
from widgets.panels.class_evaluation.study_form import StudyForm
from widgets.panels.processing.processing_panel import ProcessingPanel
from widgets.section_view.picture.section_diagnostics import diagnostics_at
from widgets.section_view.picture.section_position import CutLine, SectionPosition

WAIT_MS = 30_000


@pytest.fixture(autouse=True)
def added(monkeypatch: pytest.MonkeyPatch) -> None:
    """What their entries in the registry do."""
    for tool in (HIGH_POINTS, HIGHEST_POINT):
        monkeypatch.setitem(TOOLS, tool.id, tool)


@pytest.fixture
def recorded() -> SimulatedDrive:
    return simulated_drive(3)


@pytest.fixture
def cloud(recorded: SimulatedDrive, tmp_path: Path) -> Path:
    return write_laz(recorded, tmp_path / "left.laz")


@pytest.fixture
def street(
    parts: WindowParts, recorded: SimulatedDrive, cloud: Path, tmp_path: Path, qtbot: QtBot
) -> WindowParts:
    """The window with the cloud imported."""
    changes = parts.document.shared.map_changes
    with qtbot.waitSignal(changes.drives_changed, timeout=WAIT_MS):
        parts.document.create(tmp_path / "p.zuka", "EPSG:6677")
    trajectory = write_trajectory_csv(recorded, tmp_path / "t.csv")
    with qtbot.waitSignal(changes.drives_changed, timeout=WAIT_MS):
        parts.document.import_files(ImportRequest((cloud,), (trajectory,)))
    return parts


def answer(capsys: pytest.CaptureFixture[str], *arguments: object) -> Any:
    assert run_in_terminal([*map(str, arguments)]) == DONE
    return json.loads(capsys.readouterr().out)


def test_the_command_line_lists_them(capsys: pytest.CaptureFixture[str]) -> None:
    listed = {one["id"]: one for one in answer(capsys, "tools", "--json")}
    points, finder = listed["high_points"], listed["highest_point"]
    assert points["gives"] == "columns"
    assert [one["name"] for one in points["outputs"]] == ["classification"]
    assert [one["id"] for one in points["parameters"]] == ["above_m"]
    assert finder["gives"] == "candidates"
    assert finder["makes"] == ["pole"]
    assert answer(capsys, "tools", "highest_point", "--json") == finder


def test_each_has_a_form_with_its_fields(qtbot: QtBot) -> None:
    panel = ProcessingPanel("en")
    qtbot.addWidget(panel)
    panel.show_tool("high_points")
    assert panel.tool == "high_points"
    panel.use_values("high_points", {"above_m": 3.5})
    assert panel.parameters_of("high_points") == HighPointsParameters(above_m=3.5)
    panel.use_values("highest_point", {"confidence": 0.25})
    assert panel.parameters_of("highest_point") == HighestPointParameters(confidence=0.25)


def test_points_are_marked_and_scored_by_the_command_line(
    recorded: SimulatedDrive, cloud: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    heights = recorded.xyz[:, 2]
    level = float(np.median(heights)) + 0.0005
    output = tmp_path / "marked.laz"
    arguments = ["run", "high_points", cloud, "--set", f"above_m={level}", "--output", output]
    assert run_in_terminal([*map(str, arguments)]) == DONE
    capsys.readouterr()
    is_high = heights > level
    codes = np.asarray(laspy.read(output).classification)
    np.testing.assert_array_equal(codes, np.where(is_high, CROWN, OTHER))
    np.savez(tmp_path / "truth.npz", is_high=is_high)
    score = scored(capsys, "high_points", output, tmp_path / "truth.npz")
    counts = score["classes"]["high"]
    assert (counts["tp"], counts["tn"]) == (is_high.sum(), (~is_high).sum())
    assert (counts["fp"], counts["fn"]) == (0, 0)


def test_things_are_found_and_scored_by_the_command_line(
    recorded: SimulatedDrive, cloud: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "found.geojson"
    arguments = ["run", "highest_point", cloud, "--set", "confidence=0.75", "--output", output]
    assert run_in_terminal([*map(str, arguments)]) == DONE
    capsys.readouterr()
    (feature,) = json.loads(output.read_text("utf-8"))["features"]
    assert feature["properties"]["kind"] == "pole"
    assert feature["properties"]["confidence"] == 0.75
    top = recorded.xyz[recorded.xyz[:, 2].argmax()]
    assert feature["geometry"]["coordinates"] == pytest.approx(top.tolist())
    assert scored(capsys, "highest_point", output, output)["classes"]["highest"]["f"] == 1.0


def test_its_key_runs_a_finder_and_shows_what_it_found_in_the_review(
    street: WindowParts, qtbot: QtBot
) -> None:
    action = street.window.actions_by_id["run-highest_point"]
    assert action.text() == "Find the highest point"
    assert not action.icon().isNull()
    assert action.isEnabled()
    with qtbot.waitActive(street.window):
        street.window.activateWindow()
    street.image_view.setFocus()
    modifiers = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
    found = street.document.shared.map_changes.candidates_found
    with qtbot.waitSignal(found, timeout=WAIT_MS):
        qtbot.keyClick(street.image_view, Qt.Key.Key_F9, modifiers)
    qtbot.waitUntil(street.review_panel.isVisible, timeout=5_000)
    (pole,) = street.document.features()
    assert pole.kind == "pole"
    assert pole.provenance.tool == "highest_point"


def test_a_section_shows_what_it_makes_of_a_place(street: WindowParts) -> None:
    (drive,) = street.document.drives()
    position = drive.xyz(slice(drive.count // 2, drive.count // 2 + 1))[0]
    ahead = np.array([0.0, 5.0, 0.0])
    line = Stations(np.stack([position - ahead, position + ahead]))
    standing = SectionPosition(CutLine("", drive.id, line), 5.0)
    parameters = {"highest_point": HighestPointParameters()}
    begun, whole = diagnostics_at((drive,), standing, standing.cut, parameters)
    assert begun.awaited == "highest_point"
    assert [len(found.lines) > 0 for found in begun.drives] == [True]
    assert [one.tool for found in whole.drives for one in found.diagnostics] == ["highest_point"]
    assert not whole.awaited


def test_settings_of_a_tool_that_is_asked_something_can_be_studied(qtbot: QtBot) -> None:
    form = StudyForm("en")
    qtbot.addWidget(form)
    assert "high_points" in asked_classes()
    (tools,) = (box for box in form.findChildren(QComboBox) if box.findData("noise") >= 0)
    assert tools.itemText(tools.findData("high_points")) == "High points"


def test_every_tool_makes_kinds_that_the_catalogue_has() -> None:
    known = {kind.id for kind in read_catalogue(path_of("catalogue/level500.toml"))}
    for tool in every_tool().values():
        assert set(tool.makes) <= known, tool.id
        assert tool.gives_candidates or not tool.makes


@pytest.mark.parametrize("name", [tool.id for tool in TOOLS.values() if tool.makes])
def test_what_a_tool_finds_is_of_the_kinds_that_it_declares(
    name: str, recorded: SimulatedDrive, cloud: Path, tmp_path: Path
) -> None:
    trajectory = write_trajectory_csv(recorded, tmp_path / "t.csv")
    found = tmp_path / "found.geojson"
    arguments = ["run", name, cloud, "--trajectory", trajectory, "--output", found]
    assert run_in_terminal([*map(str, arguments)]) == DONE
    features = json.loads(found.read_text("utf-8"))["features"]
    assert {one["properties"]["kind"] for one in features} <= set(TOOLS[name].makes)


def test_every_scorer_and_every_question_belongs_to_its_tool() -> None:
    for tool in every_tool().values():
        if tool.scorer is not None:
            assert tool.scorer.tool == tool.id
            assert scorer_of(tool.id) is tool.scorer
        if tool.asked is not None:
            assert tool.asked.codes & set(tool.gives_classes)
    assert {"trees", "signs", "poles", "classify"} <= set(scorers())
