"""The evaluation panel: a table of tools and runs, and a curve in the window's colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtWidgets import QLabel, QPushButton, QSplitter, QTableWidget
from pytestqt.qtbot import QtBot

from processing.map.feature import Status
from processing.project.evaluation.run_evaluation import RunEvaluation, evaluate_runs
from processing.recording.drive import Drive
from processing.scoring.features.curb_lines import curb_score
from processing.scoring.points.reliability import reliability_of
from tests.processing.project.candidates import found_lines
from tests.processing.scoring.small_maps import moved, street_curbs
from tests.widgets.builders import OpenMap
from widgets.panels.reliability_plot import PlotColours, PlotWords, ReliabilityPlot
from widgets.panels.review.evaluation_panel import EvaluationPanel

WORDS = PlotWords("Curbs", "Confidence", "Accepted", "{count} decided", "error {error}", "Nothing.")
PAPER = PlotColours.on_paper()


@pytest.fixture
def open_map(left_drive: Drive) -> OpenMap:
    return OpenMap((left_drive,))


@pytest.fixture
def panel(qtbot: QtBot, open_map: OpenMap) -> EvaluationPanel:
    panel = EvaluationPanel(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.resize(900, 360)
    return panel


def evaluations(open_map: OpenMap) -> tuple[RunEvaluation, ...]:
    """Two runs of one tool: eight of ten accepted, then one of ten."""
    features = []
    for seed, hits in ((1, 8), (2, 1)):
        found = found_lines(10, seed=seed, drive=open_map.drives()[0].id)
        open_map.all_runs = (*open_map.all_runs, found.run)
        features += [
            replace(one, status=Status.ACCEPTED if n < hits else Status.REJECTED)
            for n, one in enumerate(found.change.added)
        ]
    return evaluate_runs(features, open_map.all_runs, open_map.drives(), {})


def table_of(panel: EvaluationPanel) -> QTableWidget:
    table = panel.findChild(QTableWidget)
    assert isinstance(table, QTableWidget)
    return table


def row_of(panel: EvaluationPanel, row: int) -> dict[str, str]:
    table = table_of(panel)
    return {
        table.horizontalHeaderItem(column).text(): table.item(row, column).text()
        for column in range(table.columnCount())
    }


def test_before_anything_is_judged_it_says_what_would_be_here(panel: EvaluationPanel) -> None:
    panel.show()
    words = [one.text() for one in panel.findChildren(QLabel) if one.isVisible()]
    assert words == ["Once candidates of a run are judged, this says how good the tool was."]


def test_it_asks_for_numbers_when_it_is_seen_and_only_then(
    qtbot: QtBot, panel: EvaluationPanel, open_map: OpenMap
) -> None:
    asked = []
    panel.evaluation_wanted.connect(lambda: asked.append(True))
    with qtbot.waitSignal(panel._refresh.timeout):
        open_map.shared.map_changes.features_changed.emit(("a",))
    assert not asked
    with qtbot.waitSignal(panel.evaluation_wanted, timeout=30_000):
        panel.show()
    panel.show_evaluations(())
    for _ in range(5):  # many changes, one question
        open_map.shared.map_changes.features_changed.emit(("a",))
    with qtbot.waitSignal(panel.evaluation_wanted, timeout=30_000):
        pass
    assert len(asked) == 2


def test_a_tool_is_listed_with_its_runs_below_it(panel: EvaluationPanel, open_map: OpenMap) -> None:
    panel.show_evaluations(evaluations(open_map))
    whole, first, second = (row_of(panel, row) for row in range(3))
    assert whole["Tool and run"].startswith("finder")
    assert "2 run" in whole["Tool and run"]
    assert whole["Precision"] == "45 % (26–66)"
    assert first["Tool and run"].startswith("    finder, ")
    assert (first["Accepted"], first["Rejected"], first["Undecided"]) == ("8", "2", "0")
    assert first["Recall"] == "100 % (68–100)"
    assert second["Precision"].startswith("10 %")
    assert second["Mean shift"] == ""


def test_the_curve_is_that_of_the_chosen_row_also_after_new_numbers(
    panel: EvaluationPanel, open_map: OpenMap
) -> None:
    found = evaluations(open_map)
    panel.show_evaluations(found)
    table_of(panel).setCurrentCell(2, 0)
    assert panel.plot is not None
    assert panel.plot.reliability is found[2].reliability
    panel.show_evaluations(found)
    assert panel.plot.reliability is found[2].reliability
    panel.show_evaluations(())
    assert panel.plot is None


def test_table_and_curve_stand_beside_each_other_where_there_is_room(
    panel: EvaluationPanel, open_map: OpenMap
) -> None:
    panel.show_evaluations(evaluations(open_map))
    panel.show()
    halves = panel.findChild(QSplitter)
    assert isinstance(halves, QSplitter)
    assert halves.orientation() is Qt.Orientation.Horizontal
    panel.resize(360, 640)
    assert halves.orientation() is Qt.Orientation.Vertical


def test_the_export_button_asks_for_each_format(
    qtbot: QtBot, panel: EvaluationPanel, open_map: OpenMap
) -> None:
    panel.show_evaluations(evaluations(open_map))
    button = next(one for one in panel.findChildren(QPushButton) if one.menu() is not None)
    asked = []
    panel.export_requested.connect(asked.append)
    for action in button.menu().actions():
        action.trigger()
    assert asked == ["csv", "png", "pdf"]


def painted(plot: ReliabilityPlot, side: int = 400) -> QImage:
    picture = QImage(side, side, QImage.Format.Format_RGB32)
    with QPainter(picture) as painter:
        plot.paint(painter, QRectF(0, 0, side, side), PAPER)
    return picture


def pixels_of(picture: QImage, colour: QColor) -> np.ndarray:
    """(n, 2): rows and columns of the pixels of exactly this colour."""
    values = np.frombuffer(picture.constBits(), np.uint32).reshape(picture.height(), -1)
    return np.argwhere(values == colour.rgb())


def test_a_curve_that_is_always_right_runs_along_the_top(qtbot: QtBot) -> None:
    certain = reliability_of(np.linspace(0, 1, 100), np.ones(100, bool))
    never = reliability_of(np.linspace(0, 1, 100), np.zeros(100, bool))
    top = pixels_of(painted(ReliabilityPlot(certain, WORDS)), PAPER.curve)
    bottom = pixels_of(painted(ReliabilityPlot(never, WORDS)), PAPER.curve)
    assert len(top) > 200
    assert np.median(top[:, 0]) < 100 < 200 < np.median(bottom[:, 0])


def test_curve_ground_and_bars_differ_in_grey(qtbot: QtBot) -> None:
    greys = sorted(colour.lightness() for colour in (PAPER.curve, PAPER.bars, PAPER.ground))
    assert min(np.diff(greys)) > 40


def test_without_decisions_the_plot_says_so_and_has_no_curve(qtbot: QtBot) -> None:
    empty = reliability_of(np.empty(0), np.empty(0, bool))
    assert not len(pixels_of(painted(ReliabilityPlot(empty, WORDS)), PAPER.curve))


def test_a_plot_in_no_room_paints_nothing_and_breaks_nothing(qtbot: QtBot) -> None:
    certain = reliability_of(np.linspace(0, 1, 100), np.ones(100, bool))
    assert not len(pixels_of(painted(ReliabilityPlot(certain, WORDS), 20), PAPER.curve))


def test_what_a_run_found_is_held_against_the_map_where_one_run_is_chosen(
    panel: EvaluationPanel, open_map: OpenMap
) -> None:
    found = evaluations(open_map)
    panel.show_evaluations(found)
    truth = street_curbs()
    panel.show_map_scores({found[1].runs[0]: curb_score(moved(truth, north=0.3), truth)})

    def said() -> list[str]:
        labels = [one for one in panel.findChildren(QLabel) if "Against" in one.text()]
        return [line for one in labels if not one.isHidden() for line in one.text().splitlines()]

    assert said() == []  # the first row is of both runs
    table_of(panel).setCurrentCell(1, 0)
    assert said()[1] == "2 m sections, without dropped curbs: precision 0 %, recall 0 %, F 0 %"
    table_of(panel).setCurrentCell(2, 0)
    assert said() == []
