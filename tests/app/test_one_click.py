"""Curbs and covered gutters by one click: told before where they can't run, else in the queue."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton, QToolBar, QToolButton
from pytestqt.qtbot import QtBot

from app.review.review import Review
from app.window.window_parts import WindowParts
from processing.core.monitor import Monitor
from processing.project.importing.importing import ImportRequest
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS, extractors
from processing.tools.normals import NormalsParameters
from processing.tools.tool import Candidate, CandidateResult, Finder, Needs
from tests.app.conftest import shown_window
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.candidates import FINDER

WAIT_MS = 30_000


def find_lids(drive: Drive, _parameters: NormalsParameters, monitor: Monitor) -> CandidateResult:
    """Five lids of 5 cm, apart from each other, each with a corner on one of the drive's points."""
    monitor.check()
    found = []
    corners = np.array([[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.05, 0.05, 0.0], [0.0, 0.05, 0.0]])
    for at in range(5):
        points = np.array([at * (drive.count // 5), -1, -1, -1])
        lid = Candidate(
            "gutter_lid", "area", drive.xyz(points[:1]) + corners, points, 0.5 + at / 10
        )
        found.append(replace(lid, attributes={"run": at // 3}))
    return CandidateResult(tuple(found))


@pytest.fixture
def parts(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[WindowParts]:
    """The window of a program that has a tool for gutters and none for curbs."""
    monkeypatch.delitem(TOOLS, "curbs", raising=False)
    tool = replace(
        FINDER,
        id="gutters",
        needs=Needs.TRAJECTORY,
        method=Finder(find_lids),
        button=TOOLS["gutters"].button,
    )
    monkeypatch.setitem(TOOLS, "gutters", tool)
    with shown_window(qtbot, tmp_path) as parts:
        yield parts


def open_street(
    parts: WindowParts, folder: Path, qtbot: QtBot, *, has_trajectory: bool = True
) -> None:
    drive = simulated_drive(3)
    trajectories = (write_trajectory_csv(drive, folder / "t.csv"),) if has_trajectory else ()
    changes = parts.document.shared.map_changes
    with qtbot.waitSignal(changes.drives_changed, timeout=WAIT_MS):
        parts.document.create(folder / "p.zuka", "EPSG:6677")
    with qtbot.waitSignal(changes.drives_changed, timeout=WAIT_MS):
        request = ImportRequest((write_laz(drive, folder / "left.laz"),), trajectories)
        parts.document.import_files(request)


def button_of(parts: WindowParts) -> QToolButton:
    (bar,) = (one for one in parts.window.findChildren(QToolBar) if one.objectName() == "toolbar")
    button = bar.widgetForAction(parts.window.actions_by_id["run-gutters"])
    assert isinstance(button, QToolButton)
    return button


def test_a_button_is_there_for_each_of_them_that_the_program_has(parts: WindowParts) -> None:
    assert not button_of(parts).icon().isNull()
    assert "run-curbs" not in parts.window.actions_by_id
    assert "Open a project first." in [
        parts.window.actions_made.why_disabled(entry).en
        for entry in parts.window.actions_made.entries
        if entry.action.id == "run-gutters"
    ]


def test_one_click_finds_lids_and_puts_them_before_the_reviewer(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    open_street(parts, tmp_path, qtbot)
    found = parts.document.shared.map_changes.candidates_found
    with qtbot.waitSignal(found, timeout=WAIT_MS):
        qtbot.mouseClick(button_of(parts), Qt.MouseButton.LeftButton)
    qtbot.waitUntil(parts.review_panel.isVisible, timeout=5_000)
    # Nothing has moved yet; the review begins by its own button or key.
    assert not parts.of(Review).is_open
    parts.window.actions_by_id["review-start"].trigger()
    # A step of ten centimetres is large enough to be judged in the section.
    assert {pane.viewport.scale >= 100 for pane in parts.section_view.panes} == {True}
    assert parts.of(Review).progress.total == 5
    shown = parts.of(Review).current
    assert shown is not None
    assert shown.provenance.confidence == 0.5
    # A second click takes the place of what is undecided, in the queue that is open.
    with qtbot.waitActive(parts.window):
        parts.window.activateWindow()
    parts.image_view.setFocus()
    qtbot.keyClick(parts.image_view, Qt.Key.Key_Return)
    assert parts.of(Review).progress.accepted == 1
    with qtbot.waitSignal(found, timeout=WAIT_MS):
        qtbot.keyClick(parts.image_view, Qt.Key.Key_F9, Qt.KeyboardModifier.ShiftModifier)
    assert parts.of(Review).progress.total == 5
    assert (parts.of(Review).progress.accepted, parts.of(Review).progress.left) == (1, 4)
    now = parts.of(Review).current
    assert now is not None
    assert now.provenance.run != shown.provenance.run
    assert now.provenance.confidence == 0.6


def test_a_row_of_lids_is_accepted_by_one_key_over_any_view(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    open_street(parts, tmp_path, qtbot)
    with qtbot.waitSignal(parts.document.shared.map_changes.candidates_found, timeout=WAIT_MS):
        button_of(parts).click()
    parts.window.actions_by_id["review-start"].trigger()
    (line,) = (
        one
        for one in parts.review_panel.findChildren(QPushButton)
        if one.text() == "Accept line: 3"
    )
    assert line.isVisible()
    with qtbot.waitActive(parts.window):
        parts.window.activateWindow()
    parts.image_view.setFocus()
    qtbot.keyClick(parts.image_view, Qt.Key.Key_Return, Qt.KeyboardModifier.ShiftModifier)
    assert parts.of(Review).progress.accepted == 3
    assert line.text() == "Accept line: 2"
    qtbot.keyClick(parts.image_view, Qt.Key.Key_Delete, Qt.KeyboardModifier.ShiftModifier)
    assert parts.of(Review).progress.rejected == 2
    assert not line.isVisible()


def test_without_a_trajectory_the_button_is_disabled_and_says_why(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    open_street(parts, tmp_path, qtbot, has_trajectory=False)
    action = parts.window.actions_by_id["run-gutters"]
    assert not action.isEnabled()
    assert "trajectory" in action.toolTip()
    (entry,) = (one for one in parts.window.actions_made.entries if one.made is action)
    assert "trajectory" in parts.window.actions_made.why_disabled(entry).en
    assert not parts.processing_panel.run_tool("gutters")


def test_find_all_runs_each_tool_into_one_queue(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    for tool in [one for one in extractors() if one != "gutters"]:
        monkeypatch.delitem(TOOLS, tool)
    both = replace(TOOLS["gutters"], makes=("gutter_lid",))
    monkeypatch.setitem(TOOLS, "gutters", both)
    monkeypatch.setitem(TOOLS, "trees", replace(both, id="trees"))
    open_street(parts, tmp_path, qtbot)
    found = parts.document.shared.map_changes.candidates_found
    with qtbot.waitActive(parts.window):
        parts.window.activateWindow()
    parts.image_view.setFocus()
    with qtbot.waitSignals([found, found], timeout=WAIT_MS):
        qtbot.keyClick(parts.image_view, Qt.Key.Key_F10, Qt.KeyboardModifier.ControlModifier)
    parts.window.actions_by_id["review-start"].trigger()
    assert parts.of(Review).progress.total == 10
    project = parts.document.project
    assert project is not None
    assert {one.provenance.tool for one in project.features.all()} == {"gutters", "trees"}
