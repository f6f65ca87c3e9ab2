"""What the model looked at: switched on below the waveform, or greyed with the reason."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from pytestqt.qtbot import QtBot

from processing.core.text import Language, Text
from processing.map.feature import PointReference
from processing.methods.classes.pulse_occlusion import PulseOcclusion
from processing.methods.waveforms.pulse_grad_cam import PulseGradCam
from processing.project.store.runs import Run
from processing.recording.drive import Drive
from tests.waveform_flight import import_flight, write_flight
from tests.widgets.builders import OpenMap
from widgets.panels.waveform.pulse_panel import PulsePanel
from widgets.panels.waveform.pulse_plot import ALONE, SEEN, TOGETHER
from widgets.shared.cursor import PickedPosition

Take = Callable[[object | None], None]
NOW = datetime(2026, 11, 1, tzinfo=UTC)
NOTHING = Text("", "")


def run_of(drive: Drive, *, uses_waveforms: bool = True) -> Run:
    parameters = {"uses_waveforms": uses_waveforms}
    return Run("r", "waveform-classify", 1, parameters, (drive.id,), NOW, NOW, NOTHING)


class WaitingWork:
    """Work that is done when a test says so."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Callable[[], object], Take]] = []

    def __call__(self, work: Callable[[], object], take: Take) -> None:
        self.waiting.append((work, take))

    def do(self) -> None:
        work, take = self.waiting.pop(0)
        take(work())


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    """A flight of which all points but the first are ground."""
    made = import_flight(write_flight(tmp_path / "flight.las", 300).path, tmp_path)
    codes = np.full(made.count, 2, np.uint8)
    codes[0] = 9
    codes.tofile(made.folder / "label.bin")
    return Drive(made.folder)


@pytest.fixture
def work() -> WaitingWork:
    return WaitingWork()


@pytest.fixture
def flight(drive: Drive) -> OpenMap:
    return OpenMap((drive,), all_runs=(run_of(drive),))


def shown_panel(
    qtbot: QtBot, flight: OpenMap, work: WaitingWork, language: Language = "en"
) -> PulsePanel:
    panel = PulsePanel(flight, flight.shared, work, language)
    qtbot.addWidget(panel)
    panel.resize(900, 240)
    panel.show()
    qtbot.waitExposed(panel)
    return panel


@pytest.fixture
def panel(qtbot: QtBot, flight: OpenMap, work: WaitingWork) -> PulsePanel:
    return shown_panel(qtbot, flight, work)


def go_to(flight: OpenMap, point: int) -> None:
    (drive,) = flight.all_drives
    x, y, z = drive.xyz(np.array([point]))[0].tolist()
    flight.shared.cursor.move_to(PickedPosition((x, y, z), PointReference(drive.id, point)))


def switch_on(qtbot: QtBot, panel: PulsePanel) -> None:
    switch = panel.occlusion_box.switch
    place = switch.rect().center()
    place.setX(8)
    qtbot.mouseClick(switch, Qt.MouseButton.LeftButton, pos=place)
    assert switch.isChecked()


def test_it_is_off_until_somebody_wants_it(
    panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    go_to(flight, 7)
    assert panel.occlusion_box.switch.isEnabled()
    assert not panel.occlusion_box.switch.isChecked()
    assert work.waiting == []
    assert panel.occlusion_box.lines() == ()


def test_what_was_found_is_drawn_and_told(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    go_to(flight, 7)
    switch_on(qtbot, panel)
    assert panel.occlusion_box.lines() == ("Asking the model …",)
    assert panel.plot.occlusion is None
    work.do()
    found = panel.plot.occlusion
    assert found is not None
    assert found.code == 2
    whole, alone, together = panel.occlusion_box.lines()
    assert whole == f"Ground: {found.share:.0%} with the whole waveform"
    assert "this pulse" in alone
    assert "around" in together
    panel.occlusion_box.switch.setChecked(False)
    assert panel.plot.occlusion is None
    assert panel.occlusion_box.lines() == ()


def test_the_newest_point_is_asked_next(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    switch = panel.occlusion_box.switch
    go_to(flight, 7)
    switch_on(qtbot, panel)
    go_to(flight, 8)
    go_to(flight, 9)
    assert len(work.waiting) == 1
    work.do()
    assert panel.plot.occlusion is None
    assert len(work.waiting) == 1
    work.do()
    assert panel.plot.occlusion is not None
    assert switch.isChecked()
    assert work.waiting == []


def test_work_on_a_closed_project_is_not_waited_for(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    go_to(flight, 7)
    switch_on(qtbot, panel)
    _, late = work.waiting.pop()
    flight.shared.map_changes.drives_changed.emit()
    work.do()
    found = panel.plot.occlusion
    assert found is not None
    late(None)
    assert panel.plot.occlusion is found


def test_failed_work_leaves_the_band_empty(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    go_to(flight, 7)
    switch_on(qtbot, panel)
    _, take = work.waiting.pop()
    take(None)
    assert panel.plot.occlusion is None
    assert panel.occlusion_box.lines() == ("",)
    go_to(flight, 8)
    assert len(work.waiting) == 1


@pytest.mark.parametrize(("language", "word"), [("en", "no waveform"), ("ja", "波形がありません")])
def test_without_a_point_it_is_grey(
    qtbot: QtBot, flight: OpenMap, work: WaitingWork, language: Language, word: str
) -> None:
    panel = shown_panel(qtbot, flight, work, language)
    switch = panel.occlusion_box.switch
    assert not switch.isEnabled()
    assert word in switch.toolTip()


def test_it_is_grey_where_no_model_was_asked(
    panel: PulsePanel, flight: OpenMap, drive: Drive
) -> None:
    switch = panel.occlusion_box.switch
    flight.all_runs = ()
    go_to(flight, 7)
    assert not switch.isEnabled()
    assert "Classes of flights" in switch.toolTip()
    flight.all_runs = (run_of(drive), run_of(drive, uses_waveforms=False))
    go_to(flight, 8)
    assert not switch.isEnabled()
    assert "points alone" in switch.toolTip()
    flight.all_runs = (run_of(drive),)
    go_to(flight, 0)
    assert not switch.isEnabled()
    assert "none of the six" in switch.toolTip()
    go_to(flight, 7)
    assert switch.isEnabled()
    assert "5 ns" in switch.toolTip()


def test_another_class_of_the_point_is_asked_about(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, drive: Drive, work: WaitingWork
) -> None:
    go_to(flight, 7)
    switch_on(qtbot, panel)
    work.do()
    changed = flight.shared.map_changes.labels_changed
    changed.emit(drive.id, np.array([8]))
    assert work.waiting == []
    changed.emit(drive.id, np.array([6, 7]))
    assert len(work.waiting) == 1


def test_the_band_is_painted_below_the_waveform(panel: PulsePanel, flight: OpenMap) -> None:
    go_to(flight, 7)
    starts = np.arange(76.0)
    bump = np.exp(-(((starts - 30) / 4) ** 2)).astype(np.float32)
    panel.plot.show_looked_at(
        PulseOcclusion(2, 0.9, starts, 5.0, 0.8 * bump, -0.3 * bump), has_room=True
    )
    picture = panel.plot.grab().toImage()
    colours = {
        QColor(picture.pixel(x, y)).name()
        for x in range(picture.width())
        for y in range(picture.height() // 2, picture.height())
    }
    for wanted in map(QColor, (ALONE, TOGETHER)):
        near = [
            max(
                abs(one.red() - wanted.red()),
                abs(one.green() - wanted.green()),
                abs(one.blue() - wanted.blue()),
            )
            for one in map(QColor, colours)
        ]
        assert min(near) < 24


def test_the_local_network_shows_where_it_saw_the_class(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    go_to(flight, 7)
    switch_on(qtbot, panel)
    qtbot.keyClick(panel.occlusion_box.method, Qt.Key.Key_Down)
    work.do()  # what was asked before isn't shown
    assert panel.plot.occlusion is None
    assert panel.plot.grad_cam is None
    work.do()
    found = panel.plot.grad_cam
    assert found is not None
    assert found.code == 2
    whole, seen = panel.occlusion_box.lines()
    assert whole.startswith(f"Ground: {found.share:.0%} by the local network, which is not")
    assert ("likeliest" in whole) == (found.likeliest != 2)
    assert seen
    qtbot.keyClick(panel.occlusion_box.method, Qt.Key.Key_Up)
    assert panel.plot.grad_cam is None
    work.do()
    assert panel.plot.occlusion is not None


def test_the_local_network_needs_no_run(
    qtbot: QtBot, panel: PulsePanel, flight: OpenMap, work: WaitingWork
) -> None:
    box, flight.all_runs = panel.occlusion_box, ()
    assert not box.method.isEnabled()
    go_to(flight, 7)
    assert not box.switch.isEnabled()
    qtbot.keyClick(box.method, Qt.Key.Key_Down)
    assert box.switch.isEnabled()
    assert "not the model that classifies" in box.switch.toolTip()
    switch_on(qtbot, panel)
    work.do()
    assert panel.plot.grad_cam is not None


def test_what_the_network_saw_is_painted(panel: PulsePanel, flight: OpenMap) -> None:
    go_to(flight, 7)
    times = np.arange(60.0)
    seen = np.exp(-(((times - 30) / 6) ** 2)).astype(np.float32)
    panel.plot.show_looked_at(PulseGradCam(2, 0.9, 2, 0.9, times, seen), has_room=True)
    picture = panel.plot.grab().toImage()
    wanted = QColor(SEEN)
    below = (
        QColor(picture.pixel(x, y))
        for x in range(picture.width())
        for y in range(picture.height() // 2, picture.height())
    )
    assert any(
        abs(one.red() - wanted.red()) < 24
        and abs(one.green() - wanted.green()) < 24
        and abs(one.blue() - wanted.blue()) < 24
        for one in below
    )
