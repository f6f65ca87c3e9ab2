"""Somebody runs the three tools of waveforms from the panel, by mouse."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QPushButton, QTreeWidget

from processing.core.text import Text
from processing.project.importing.dropped_files import request_of_files
from processing.recording.columns.counted_classes import class_columns
from tests.journeys.conftest import WAIT_MS, Surveyor
from tests.waveform_flight import write_flight

_POINTS = 600


def _open_flight(surveyor: Surveyor, tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "航空.las", _POINTS)
    assert surveyor.document.create(tmp_path / "Flight.zuka", "")
    request = request_of_files((flight.path,), "")
    surveyor.wait_for_job(lambda: surveyor.document.import_files(request))


def _choose(surveyor: Surveyor, tool: str) -> None:
    """Open the panel from the menu and click the tool in its list."""
    surveyor.parts.window.actions_by_id[f"process-{tool}"].trigger()
    panel = surveyor.parts.processing_panel
    surveyor.bot.waitUntil(panel.isVisible)
    tools = panel.findChild(QTreeWidget)
    item = tools.currentItem()
    tools.scrollToItem(item)
    place = tools.visualItemRect(item).center()
    surveyor.bot.mouseClick(tools.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert panel.tool == tool
    assert panel.form is not None


def _run(surveyor: Surveyor) -> None:
    panel = surveyor.parts.processing_panel
    words = {"en": "Run", "ja": "実行"}[surveyor.parts.language]
    button = next(one for one in panel.findChildren(QPushButton) if one.text() == words)
    assert button.isEnabled()
    surveyor.bot.mouseClick(button, Qt.MouseButton.LeftButton)


def _wait_for_words(surveyor: Surveyor, said: list[Text], name: str) -> None:
    surveyor.bot.waitUntil(lambda: any(name in one.en for one in said), timeout=WAIT_MS)


def _codes(surveyor: Surveyor) -> np.ndarray:
    columns = surveyor.drive.columns
    return class_columns(columns).codes_of(np.arange(surveyor.drive.count))


def _answer(monkeypatch: pytest.MonkeyPatch, name: str) -> list[str]:
    """The file dialog is answered with a name; gives the one that it offered."""
    offered: list[str] = []

    def chosen(_parent: object, _title: str, start: str, _files: str) -> tuple[str, str]:
        offered.append(start)
        return name, ""

    monkeypatch.setattr(QFileDialog, "getSaveFileName", chosen)
    return offered


def test_classes_of_a_flight_are_shown_after_a_run(surveyor: Surveyor, tmp_path: Path) -> None:
    _open_flight(surveyor, tmp_path)
    _choose(surveyor, "waveform-classify")
    assert (_codes(surveyor) == 1).all()
    _run(surveyor)
    surveyor.bot.waitUntil(lambda: (_codes(surveyor) != 1).any(), timeout=WAIT_MS)
    assert set(np.unique(_codes(surveyor))) <= {2, 5, 6, 11, 14, 15}


def test_after_a_run_one_sees_what_the_model_occlusion(surveyor: Surveyor, tmp_path: Path) -> None:
    _open_flight(surveyor, tmp_path)
    surveyor.parts.window.actions_by_id["panel-waveform"].trigger()
    panel = surveyor.parts.pulse_panel
    surveyor.bot.waitUntil(panel.isVisible)
    switch, point = panel.occlusion_box.switch, 10
    surveyor.document.shared.cursor.move_to(surveyor.position_of(point))
    assert panel.plot.pulse is not None
    assert not switch.isEnabled()
    _choose(surveyor, "waveform-classify")
    _run(surveyor)
    surveyor.bot.waitUntil(lambda: len(surveyor.document.runs()) == 1, timeout=WAIT_MS)
    surveyor.document.shared.cursor.move_to(surveyor.position_of(point + 1))
    surveyor.bot.waitUntil(switch.isEnabled)
    switch.click()
    surveyor.bot.waitUntil(lambda: panel.plot.occlusion is not None, timeout=WAIT_MS)
    found = panel.plot.occlusion
    assert found.code == _codes(surveyor)[point + 1]
    assert f"{found.share:.0%}" in panel.occlusion_box.lines()[0]


def test_echoes_go_into_the_file_that_is_asked_for(
    surveyor: Surveyor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _open_flight(surveyor, tmp_path)
    target = tmp_path / "分解.laz"
    offered = _answer(monkeypatch, str(target))
    said: list[Text] = []
    surveyor.document.reported.connect(said.append)
    _choose(surveyor, "waveform-decompose")
    _run(surveyor)
    _wait_for_words(surveyor, said, target.name)
    assert offered == [str(tmp_path / "Flight-waveform-decompose.laz")]
    assert laspy.read(target).header.point_count >= _POINTS


def test_estimated_waveforms_are_written_beside_their_points(
    surveyor: Surveyor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _open_flight(surveyor, tmp_path)
    target = tmp_path / "推定.las"
    offered = _answer(monkeypatch, str(target))
    said: list[Text] = []
    surveyor.document.reported.connect(said.append)
    _choose(surveyor, "waveform-estimate")
    _run(surveyor)
    _wait_for_words(surveyor, said, target.name)
    assert offered[0].endswith(".las")
    with laspy.open(target) as file:
        assert file.header.point_count == surveyor.drive.count
    assert target.with_suffix(".wdp").stat().st_size > 60


def test_an_archive_is_classified_through_estimated_waveforms(
    surveyor: Surveyor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flight, archive = write_flight(tmp_path / "航空.las", _POINTS), tmp_path / "書庫.laz"
    laspy.convert(laspy.read(flight.path), point_format_id=6).write(archive)
    assert surveyor.document.create(tmp_path / "Archive.zuka", "")
    surveyor.wait_for_job(lambda: surveyor.document.import_files(request_of_files((archive,), "")))
    delivered, target = surveyor.drive, tmp_path / "推定.las"
    _answer(monkeypatch, str(target))
    said: list[Text] = []
    surveyor.document.reported.connect(said.append)
    _choose(surveyor, "waveform-estimate")
    _run(surveyor)
    _wait_for_words(surveyor, said, target.name)
    surveyor.wait_for_job(lambda: surveyor.document.import_files(request_of_files((target,), "")))
    estimated = next(one for one in surveyor.document.drives() if one.id != delivered.id)
    settings = surveyor.document.shared.view_settings
    settings.show_image(estimated.id, settings.image_kind)
    _choose(surveyor, "waveform-classify")
    _run(surveyor)
    surveyor.bot.waitUntil(lambda: (_codes(surveyor) != 1).any(), timeout=WAIT_MS)
    assert not surveyor.document.drive(delivered.id).columns.has("label"), "nor counted twice"


def test_no_name_in_the_dialog_runs_nothing(
    surveyor: Surveyor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _open_flight(surveyor, tmp_path)
    _answer(monkeypatch, "")
    started = len(surveyor.parts.jobs.statuses)
    panel = surveyor.parts.processing_panel
    panel.show_tool("waveform-decompose")
    assert panel.run_tool("waveform-decompose")
    assert len(surveyor.parts.jobs.statuses) == started
