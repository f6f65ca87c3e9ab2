"""Truth painted in the window, noise judged by it, settings studied; all by mouse and keys."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QComboBox,
    QMessageBox,
    QPushButton,
    QTableWidget,
    QTabWidget,
)

from app.classes.truth_evaluations import TruthEvaluations
from app.jobs.jobs import JobState
from processing.core.monitor import SilentMonitor
from processing.image.attributes.colour_maps import ERROR_MAP_COLOURS
from processing.image.images_of_drives import image_of
from processing.labels.label_column import labels_of
from processing.project.evaluation.truth_store import has_truth
from processing.project.importing.importing import ImportRequest
from processing.recording.columns.error_map import ErrorMapValue
from processing.tools.noise import NoiseParameters
from processing.tools.running.runner import RunRequest, run
from tests.builders import write_laz, write_trajectory_csv
from tests.journeys.conftest import WAIT_MS
from tests.mouse_events import NO_KEYS, move_mouse
from tests.noisy_street import noisy_street

LEFT = Qt.MouseButton.LeftButton
RADIUS = NoiseParameters("radius", radius_m=0.3, neighbours=12)
PAINTED = 2


@pytest.fixture
def judge(surveyor, tmp_path):
    """The surveyor before a short street, with the page of point classes open."""
    street = noisy_street(7, length_m=3.0)
    cloud = write_laz(street.drive, tmp_path / "左.laz")
    way = write_trajectory_csv(street.drive, tmp_path / "軌跡.csv")
    np.savez(tmp_path / "truth.npz", code=street.noise)
    document = surveyor.document
    assert document.create(tmp_path / "p.zuka", "EPSG:6677")
    surveyor.wait_for_job(lambda: document.import_files(ImportRequest((cloud,), (way,))))
    return EvaluatingUser(surveyor)


class EvaluatingUser:
    """What a surveyor does to judge a tool."""

    def __init__(self, surveyor):
        self.surveyor = surveyor
        self.parts, self.bot = surveyor.parts, surveyor.bot
        self.panel, self.studies = self.parts.class_panel, self.parts.study_panel

    def show_page(self, page):
        self.parts.window.show_panel("evaluation")
        tabs = self.parts.window.findChildren(QTabWidget)
        next(one for one in tabs if one.isAncestorOf(page)).setCurrentIndex(
            1 if page is self.panel else 2
        )
        self.bot.waitUntil(page.isVisible, timeout=WAIT_MS)

    def paint(self, key: str, row_share: float):
        """A stroke with the class of a key; gives the points that it labelled."""
        drive, view = self.surveyor.drive, self.parts.image_view
        with self.bot.waitActive(self.parts.window):
            self.parts.window.activateWindow()
        view.setFocus()
        self.parts.window.actions_by_id["tool-paint-brush"].trigger()
        self.bot.keyClick(view, key)
        before = self.labels()
        image = image_of(drive, self.parts.document.shared.view_settings.image_kind)
        point = self.surveyor.shown_point(int(image.rows * row_share), image.width // 2)
        spot = self.surveyor.pixel_of(point)
        QTest.mousePress(view, LEFT, NO_KEYS, spot)
        move_mouse(view, spot + QPoint(12, 0), LEFT)
        QTest.mouseRelease(view, LEFT, NO_KEYS, spot + QPoint(12, 0))
        return np.flatnonzero(self.labels() != before)

    def labels(self):
        drive = self.surveyor.drive
        return labels_of(drive, np.arange(drive.count))

    def make_truth(self, number: int):
        button = next(
            one for one in self.panel.truths.findChildren(QPushButton) if one.menu() is not None
        )
        actions = [one for one in button.menu().actions() if not one.isSeparator()]
        with self.bot.waitSignal(self.parts.of(TruthEvaluations).truth_made, timeout=WAIT_MS):
            actions[number].trigger()

    def load_truth(self, path):
        with self.bot.waitSignal(self.parts.of(TruthEvaluations).truth_made, timeout=WAIT_MS):
            self.parts.of(TruthEvaluations).load_truth(path)

    def run_noise(self):
        """The tool's form filled in and its button clicked."""
        panel = self.parts.processing_panel
        self.parts.window.show_panel("processing")
        panel.show_tool("noise")
        panel.form.set_values({"method": "radius", "radius_m": 0.3, "neighbours": 12})
        button = next(one for one in panel.findChildren(QPushButton) if one.text() == "Run")
        with self.bot.waitSignal(self.parts.document.reported, timeout=WAIT_MS):
            self.bot.mouseClick(button, LEFT)

    def click(self, words: str, within):
        buttons = within.findChildren(QAbstractButton)
        button = next(one for one in buttons if one.text() == words)
        assert button.isEnabled()
        self.bot.mouseClick(button, LEFT, pos=QPoint(8, button.height() // 2))

    def rows(self):
        table = self.panel.findChild(QTableWidget)
        return [
            [table.item(row, column).text() for column in range(table.columnCount())]
            for row in range(table.rowCount())
        ]


def test_painted_truth_judges_a_run_as_one_does_by_hand(judge, tmp_path):
    noise, building = judge.paint("7", 0.3), judge.paint("6", 0.7)
    assert min(noise.size, building.size) > 5
    judge.show_page(judge.panel)
    judge.make_truth(PAINTED)
    with judge.bot.waitSignal(judge.parts.of(TruthEvaluations).judged, timeout=WAIT_MS):
        judge.run_noise()
    judge.bot.waitUntil(lambda: len(judge.rows()) == 3, timeout=WAIT_MS)
    drive = judge.surveyor.drive
    result = run(RunRequest("noise", drive, RADIUS), SilentMonitor(), into=tmp_path / "again")
    called = np.isin(result.read("classification", 0, drive.count), (7, 18))
    hits, alarms = int(called[noise].sum()), int(called[building].sum())
    misses, right = noise.size - hits, building.size - alarms
    untouched, found, now = judge.rows()
    assert untouched[0] == "Noise: if nothing were removed"
    assert untouched[2] == "100.00 %"
    assert found[0].startswith("Noise: Radius (ROR), Radius (ROR) 0.3 m, Neighbours")
    assert found[1] == f"{100 * right / (right + misses):.2f} %"
    assert found[2] == f"{100 * right / building.size:.2f} %"
    assert found[5] == f"{100 * hits / noise.size:.2f} %"
    assert found[8:] == [str(alarms), str(misses), str(noise.size + building.size)]
    assert now[0] == "Noise: as it stands now"
    assert now[3] == now[6] == "100.00 %"


def test_right_and_wrong_are_colours_in_the_views_until_the_button_is_up_again(judge, tmp_path):
    judge.load_truth(tmp_path / "truth.npz")
    judge.show_page(judge.panel)
    judge.run_noise()
    judge.bot.waitUntil(lambda: len(judge.rows()) == 3, timeout=WAIT_MS)
    settings = judge.parts.document.shared.view_settings
    before = settings.look.attribute
    with judge.bot.waitSignal(settings.look_changed, timeout=WAIT_MS):
        judge.click("Show right and wrong", judge.panel)
    assert settings.look.attribute == "judged"
    drive, counts = judge.surveyor.drive, judge.panel.chosen.counts
    seen = np.bincount(drive.columns["judged"], minlength=5)
    assert seen[ErrorMapValue.WRONGLY_KEPT] == counts.misses
    assert seen[ErrorMapValue.WRONGLY_REMOVED] == counts.false_alarms
    assert seen[ErrorMapValue.RIGHTLY_REMOVED] == counts.hits
    assert seen[ErrorMapValue.UNKNOWN] == 0
    judge.click("Show right and wrong", judge.panel)
    assert settings.look.attribute == before


def test_right_and_wrong_follow_what_is_painted_and_undone(judge, tmp_path):
    judge.load_truth(tmp_path / "truth.npz")
    judge.show_page(judge.panel)
    judge.run_noise()
    judge.bot.waitUntil(lambda: len(judge.rows()) == 3, timeout=WAIT_MS)
    assert judge.panel.chosen.run is None
    document, drive = judge.parts.document, judge.surveyor.drive
    with judge.bot.waitSignal(document.shared.view_settings.look_changed, timeout=WAIT_MS):
        judge.click("Show right and wrong", judge.panel)
    counted, before = judge.rows()[2], np.array(drive.columns["judged"])
    judged = document.shared.map_changes.error_maps_changed
    with judge.bot.waitSignal(judged, timeout=WAIT_MS):
        painted = judge.paint("7", 0.3)
    was = before[painted]
    expected = before.copy()
    expected[painted[was == ErrorMapValue.RIGHTLY_KEPT]] = ErrorMapValue.WRONGLY_REMOVED
    expected[painted[was == ErrorMapValue.WRONGLY_KEPT]] = ErrorMapValue.RIGHTLY_REMOVED
    assert (expected != before).any()
    np.testing.assert_array_equal(drive.columns["judged"], expected)
    view = judge.parts.image_view
    wrong = np.array(list(bytes.fromhex(ERROR_MAP_COLOURS[ErrorMapValue.WRONGLY_REMOVED][1:])))

    def seen_wrong():
        image = view.grab().toImage().convertToFormat(QImage.Format.Format_RGBA8888)
        pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)
        return int((pixels[:, :, :3] == wrong).all(axis=2).sum())

    judge.bot.waitUntil(lambda: seen_wrong() > 100, timeout=WAIT_MS)
    judge.bot.waitUntil(lambda: judge.rows()[2] != counted, timeout=WAIT_MS)
    # Counted before all of it is painted, as many may be seen of what else is wrong.
    judge.bot.waitUntil(lambda: seen_wrong() > 100 and view._is_sharp, timeout=WAIT_MS)
    seen = seen_wrong()
    with judge.bot.waitSignal(judged, timeout=WAIT_MS):
        judge.bot.keyClick(view, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    np.testing.assert_array_equal(drive.columns["judged"], before)
    judge.bot.waitUntil(lambda: judge.rows()[2] == counted, timeout=WAIT_MS)
    judge.bot.waitUntil(lambda: seen_wrong() < seen, timeout=WAIT_MS)


def test_a_study_of_two_values_gives_a_plot_and_its_setting_goes_into_the_form(judge, tmp_path):
    judge.load_truth(tmp_path / "truth.npz")
    judge.show_page(judge.studies)
    judge.parts.processing_panel.use_values("noise", {"method": "radius", "neighbours": 12})
    form = judge.studies.form
    row = form.first
    row.choice.setCurrentIndex(row.choice.findData("radius_m"))
    row.low.setValue(0.2)
    row.high.setValue(0.4)
    row.steps.setValue(2)
    with judge.bot.waitSignal(judge.parts.of(TruthEvaluations).study_made, timeout=WAIT_MS):
        judge.click("Study", form)
    study = judge.studies.plot.study
    assert [cell.values for cell in study.cells] == [(0.2,), (0.4,)]
    assert study.fixed["neighbours"] == 12
    best = judge.studies.plot.best
    worst = next(number for number, one in enumerate(study.cells) if one is not best)
    judge.bot.waitUntil(lambda: judge.studies.view.position_of(1).x() > 0, timeout=WAIT_MS)
    position = judge.studies.view.position_of(worst).toPoint()
    judge.bot.mouseClick(judge.studies.view, LEFT, pos=position)
    judge.click("Use these values", judge.studies)
    value = judge.parts.processing_panel.form.value()
    assert (value.method, value.radius_m) == ("radius", study.cells[worst].values[0])
    document = judge.parts.document
    document.close()
    assert judge.studies.plot is None
    assert document.open(tmp_path / "p.zuka")
    assert judge.studies.plot.study == study


def test_a_cancelled_study_leaves_nothing(judge, tmp_path):
    judge.load_truth(tmp_path / "truth.npz")
    judge.show_page(judge.studies)
    jobs, states = judge.parts.jobs, []

    def stop_when_it_runs(status):
        states.append(status.state)
        if status.state is JobState.RUNNING and "study" in status.title.en:
            jobs.cancel(status.id)

    jobs.changed.connect(stop_when_it_runs)
    with judge.bot.waitSignal(jobs.cancelled, timeout=WAIT_MS):
        judge.click("Study", judge.studies.form)
    jobs.changed.disconnect(stop_when_it_runs)
    assert judge.parts.of(TruthEvaluations).studies() == ()
    left = [one for one in (tmp_path / "p.zuka" / "tmp").iterdir() if any(one.iterdir())]
    assert left == []


def test_a_truth_is_forgotten_only_when_that_is_confirmed(judge, tmp_path):
    judge.load_truth(tmp_path / "truth.npz")
    (truth,) = judge.parts.of(TruthEvaluations).truths()
    bar, window = judge.panel.truths, judge.parts.window
    judge.show_page(judge.panel)
    for words, is_kept in (("Cancel", True), ("Forget it", False)):
        bar.removal_requested.emit(bar.truth)
        box = window.findChild(QMessageBox)
        button = next(one for one in box.buttons() if one.text().replace("&", "") == words)
        judge.bot.mouseClick(button, LEFT)
        judge.bot.waitUntil(lambda box=box: not box.isVisible(), timeout=WAIT_MS)
        box.setParent(None)
        assert has_truth(judge.surveyor.drive, truth.id) is is_kept
    assert judge.parts.of(TruthEvaluations).truths() == ()
    assert bar.findChild(QComboBox).currentText() == "None yet"
