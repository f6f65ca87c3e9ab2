"""Words from files are shown as they are: no label makes HTML of them, no button a key."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QHelpEvent, QImage
from PySide6.QtWidgets import (
    QApplication,
    QInputDialog,
    QLabel,
    QListWidget,
    QMessageBox,
    QProgressDialog,
    QToolButton,
    QToolTip,
    QTreeWidget,
    QWidget,
)
from pytestqt.qtbot import QtBot

from app.application import make_application
from app.window.window_parts import WindowParts
from processing.core.errors import BadFile
from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Status, Vertex
from tests.widgets.builders import OpenMap
from tests.widgets.panels.table_user import menu_of
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.panels.jobs_panel import JobsPanel
from widgets.panels.project.layers_panel import LayersPanel
from widgets.panels.review.candidate_card import CandidateCard
from widgets.panels.table.feature_table import FeatureTable
from widgets.parts.drawing_bar import DrawingBar
from widgets.parts.job_view import JobView
from widgets.parts.message_bar import MessageBar
from widgets.parts.recent_project import RecentProject
from widgets.parts.start_page import StartPage

TALL_PX = 400
HARMLESS = "R&D <b>kerb"
SHOWN_HARMLESS = "R&&D <b>kerb"


@pytest.fixture(autouse=True)
def application(qapp: QApplication) -> QApplication:
    """The application with the program's look; a test's own may have had another before."""
    assert make_application() is qapp
    return qapp


@pytest.fixture
def harm(tmp_path: Path) -> str:
    """Words that a label takes for HTML with a picture in it, which is there and tall."""
    picture = QImage(40, TALL_PX, QImage.Format.Format_RGB32)
    picture.fill(QColor("red"))
    assert picture.save(str(tmp_path / "tall.png"))
    words = f'R&D <img src="{(tmp_path / "tall.png").as_uri()}"><b>x</b>'
    assert Qt.mightBeRichText(words)
    return words


def labels_below(widget: QWidget) -> list[QLabel]:
    widget.show()
    found = widget.findChildren(QLabel)
    for label in found:
        label.sizeHint()
    return found


def check_labels(widget: QWidget, *words: str) -> None:
    """Every label is plain, and these words are in one of them, in no picture's height."""
    labels = labels_below(widget)
    assert {one.textFormat() for one in labels} <= {Qt.TextFormat.PlainText}
    for each in words:
        (first, *_) = [one for one in labels if each in one.text()]
        assert first.sizeHint().height() < TALL_PX
        assert first.heightForWidth(5_000) < TALL_PX


def tooltip_over(qtbot: QtBot, widget: QWidget, position: QPoint) -> QLabel:
    event = QHelpEvent(QHelpEvent.Type.ToolTip, position, widget.mapToGlobal(position))
    QApplication.sendEvent(widget, event)
    qtbot.waitUntil(lambda: bool(QToolTip.text()))
    (label,) = [
        one
        for one in QApplication.allWidgets()
        if isinstance(one, QLabel) and one.metaObject().className() == "QTipLabel"
    ]
    return label


def check_tooltip(label: QLabel, words: str) -> None:
    assert words in label.text()
    assert label.textFormat() is Qt.TextFormat.PlainText
    assert label.height() < TALL_PX
    label.hide()
    label.deleteLater()


class MapOfHarm(OpenMap):
    """A map of an office's catalogue whose names are harmful."""

    kinds: Catalogue

    def catalogue(self) -> Catalogue:
        return self.kinds


@pytest.fixture
def open_map(harm: str) -> MapOfHarm:
    made = MapOfHarm()
    note = AttributeField("note", Text.same(harm), "text", harm)
    made.kinds = Catalogue(
        tuple(
            FeatureKind(
                id_, Text.same(name), Geometry.LINE, "", id_, "#009e73", 96, attributes=(note,)
            )
            for id_, name in (("curb", harm), ("wall", HARMLESS))
        )
    )
    return made


@pytest.fixture
def feature(open_map: MapOfHarm, harm: str) -> Feature:
    positions = (Vertex((0.0, 0.0, 0.0)), Vertex((1.0, 0.0, 0.0)))
    made = Feature("f", "curb", Geometry.LINE, positions, {"note": harm, harm: harm})
    made = replace(made, status=Status.CANDIDATE)
    open_map.apply(Text.same("d"), Change(added=(made,)))
    return made


def test_a_label_shows_its_words_also_when_they_change(qtbot: QtBot, harm: str) -> None:
    page = QWidget()
    qtbot.addWidget(page)
    label = QLabel(harm, page)
    label.setWordWrap(True)
    check_labels(page, harm)
    label.setText(f"<p>{harm}")
    check_labels(page, f"<p>{harm}")


def test_forms_that_qt_makes_show_their_words(qtbot: QtBot, harm: str) -> None:
    box = QMessageBox()
    box.setText(harm)
    box.setInformativeText(f"2 {harm}")
    progress = QProgressDialog()
    progress.setLabelText(harm)
    asking = QInputDialog()
    asking.setLabelText(harm)
    for form in (box, progress, asking):
        qtbot.addWidget(form)
        check_labels(form, harm)
    check_labels(box, f"2 {harm}")
    progress.cancel()


def test_any_tooltip_shows_its_words(qtbot: QtBot, harm: str) -> None:
    lists = QListWidget()
    qtbot.addWidget(lists)
    lists.addItem("one")
    lists.item(0).setToolTip(harm)
    lists.show()
    position = lists.visualItemRect(lists.item(0)).center()
    check_tooltip(tooltip_over(qtbot, lists.viewport(), position), harm)
    lists.setToolTip(f"1 {harm}")
    check_tooltip(tooltip_over(qtbot, lists, QPoint(2, 2)), f"1 {harm}")


def test_errors_show_the_names_of_files(qtbot: QtBot, harm: str) -> None:
    bar = MessageBar("en")
    qtbot.addWidget(bar)
    bar.show_error(BadFile(Text.same(harm), Text.same(f"2 {harm}"), Text.same(f"3 {harm}")))
    check_labels(bar, harm, f"2 {harm}", f"3 {harm}")


def test_projects_show_their_folders(qtbot: QtBot, tmp_path: Path) -> None:
    page = StartPage("en")
    qtbot.addWidget(page)
    page.resize(900, 600)
    page.show_recent([RecentProject(tmp_path / f"{HARMLESS}.zuka")])
    page.show()
    check_labels(page)
    (tree,) = page.findChildren(QTreeWidget)
    item = tree.topLevelItem(0)
    assert item is not None
    label = tooltip_over(qtbot, tree.viewport(), tree.visualItemRect(item).center())
    check_tooltip(label, HARMLESS)


def test_features_show_their_kinds_attributes_and_values(
    qtbot: QtBot, open_map: MapOfHarm, feature: Feature, harm: str
) -> None:
    panel = AttributePanel(open_map, open_map.shared, "en")
    table = FeatureTable(open_map, open_map.shared, "en")
    layers = LayersPanel(open_map, open_map.shared, "en")
    for one in (panel, table, layers):
        qtbot.addWidget(one)
        one.resize(700, 500)
        one.show()
    open_map.shared.selection.choose_features(frozenset({feature.id}))
    check_labels(panel, harm)
    check_labels(table)
    check_labels(layers)


def test_a_candidate_shows_its_kind_and_its_attributes(
    qtbot: QtBot, open_map: MapOfHarm, feature: Feature, harm: str
) -> None:
    page = QWidget()
    qtbot.addWidget(page)
    card = CandidateCard("en", page)
    card.show_feature(feature, open_map.catalogue(), 1, 1)
    check_labels(page, harm)


def test_jobs_show_what_they_work_on(qtbot: QtBot, harm: str) -> None:
    panel = JobsPanel("en")
    qtbot.addWidget(panel)
    panel.show_job(JobView("1", harm, 0.5, f"2 {harm}", None, "running"))
    check_labels(panel, harm, f"2 {harm}")


def test_menus_and_buttons_show_an_ampersand(
    qtbot: QtBot, open_map: MapOfHarm, feature: Feature
) -> None:
    table = FeatureTable(open_map, open_map.shared, "en")
    bar = DrawingBar(open_map.shared, {}, "en")
    for one in (table, bar):
        qtbot.addWidget(one)
    table.show()
    open_map.shared.selection.choose_features(frozenset({feature.id}))
    menu = table.menu()
    assert menu is not None
    (kinds,) = [one for one in menu.actions() if one.text() == "Change kind to"]
    names = [one.text() for one in menu_of(kinds).actions()]
    assert SHOWN_HARMLESS in names
    bar.show_kind(open_map.kinds["wall"])
    assert bar.kind_name == HARMLESS
    assert SHOWN_HARMLESS in [one.text() for one in bar.findChildren(QToolButton)]


def test_the_window_shows_names_of_projects_and_steps(
    qtbot: QtBot, parts: WindowParts, tmp_path: Path
) -> None:
    document = parts.document
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=30_000):
        document.create(tmp_path / f"{HARMLESS}.zuka", "EPSG:6677")
    positions = (Vertex((0.0, 0.0, 0.0)), Vertex((1.0, 0.0, 0.0)))
    drawn = Feature("f", "curb", Geometry.LINE, positions, {})
    document.undo_stack.push(Text.same(HARMLESS), Change(added=(drawn,)))
    check_labels(parts.window)
    assert HARMLESS in parts.window.windowTitle()
    qtbot.waitUntil(lambda: parts.window.actions_by_id["undo"].text() == f"Undo: {SHOWN_HARMLESS}")
