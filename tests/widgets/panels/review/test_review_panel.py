"""The review panel shows a queue and says what the operator wants; it decides nothing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QCheckBox, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Status
from processing.project.photos import photo_folder, photo_name, write_photos
from processing.project.review.review_state import ReviewOrder, ReviewProgress, ReviewState
from tests.processing.project.candidates import found_lines
from tests.widgets.builders import OpenMap
from widgets.panels.attributes.photo_row import PhotoRow
from widgets.panels.review.candidate_card import CandidateCard
from widgets.panels.review.review_panel import ReviewPanel
from widgets.panels.review.run_chooser import RunChooser
from widgets.parts.number_field import NumberField
from widgets.parts.share_bar import ShareBar


@pytest.fixture
def open_map() -> OpenMap:
    return OpenMap()


@pytest.fixture
def panel(qtbot: QtBot, open_map: OpenMap) -> ReviewPanel:
    panel = ReviewPanel(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.resize(300, 620)
    panel.show()
    return panel


def store(open_map: OpenMap, count: int = 8, *, seed: int = 1) -> tuple[str, tuple[Feature, ...]]:
    found = found_lines(count, seed=seed)
    open_map.all_runs = (*open_map.all_runs, found.run)
    open_map.apply(found.run.summary, found.change)
    return found.run.id, found.change.added


def button(panel: ReviewPanel, words: str) -> QPushButton:
    return next(one for one in panel.findChildren(QPushButton) if one.text().startswith(words))


def labels(panel: ReviewPanel) -> list[str]:
    return [one.text() for one in panel.findChildren(QLabel) if one.isVisible()]


def card(panel: ReviewPanel) -> CandidateCard:
    found = panel.findChild(CandidateCard)
    assert isinstance(found, CandidateCard)
    return found


def chooser(panel: ReviewPanel) -> RunChooser:
    found = panel.findChild(RunChooser)
    assert isinstance(found, RunChooser)
    return found


def run_actions(panel: ReviewPanel) -> list[QAction]:
    menu = chooser(panel).menu
    menu.aboutToShow.emit()
    return [one for one in menu.actions() if not one.isSeparator()]


def test_an_empty_map_says_what_would_be_here_and_offers_the_way(
    qtbot: QtBot, panel: ReviewPanel
) -> None:
    assert any("judged here" in words for words in labels(panel))
    with qtbot.waitSignal(panel.processing_requested, timeout=30_000):
        qtbot.mouseClick(button(panel, "Find something"), Qt.MouseButton.LeftButton)


def test_candidates_that_wait_are_counted_and_one_click_starts(
    qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap
) -> None:
    first, _ = store(open_map)
    second, features = store(open_map, seed=2)
    for one in features:
        accepted = replace(one, status=Status.ACCEPTED)
        open_map.apply(Text.same("a"), Change(replaced=(Replacement(one, accepted),)))
    assert any(words.startswith("8 candidate") for words in labels(panel))
    with qtbot.waitSignal(panel.open_requested) as asked:
        qtbot.mouseClick(button(panel, "Start"), Qt.MouseButton.LeftButton)
    assert asked.args == [(first,), ReviewOrder.CONFIDENCE]
    assert second != first


def test_the_queue_is_shown_in_numbers(panel: ReviewPanel, open_map: OpenMap) -> None:
    run, features = store(open_map)
    state = ReviewState((run,), last_s=(2.0, 2.0, 2.0))
    progress = ReviewProgress(state, accepted=2, rejected=1, left=5, position=4)
    panel.show_review(progress, features[3])
    assert "5 left · 0:10" in labels(panel)
    assert "2 accepted · 1 rejected · 30 a minute" in labels(panel)
    bar = panel.findChild(ShareBar)
    assert isinstance(bar, ShareBar)
    assert bar.share == pytest.approx(3 / 8)
    lines = card(panel).lines()
    assert lines[:2] == ("curb_lower", "4 / 8")
    assert "height_m: 0.15" in lines
    assert "Length: 2.000 m" in lines
    assert "Found by: finder" in lines
    assert card(panel).confidence.value == features[3].provenance.confidence


def test_a_candidate_that_was_decided_already_says_so(
    panel: ReviewPanel, open_map: OpenMap
) -> None:
    run, features = store(open_map)
    progress = ReviewProgress(ReviewState((run,)), rejected=1, left=7, position=1)
    panel.show_review(progress, replace(features[0], status=Status.REJECTED))
    assert "Decided: Rejected" in card(panel).lines()


def test_when_all_are_decided_the_evaluation_is_offered(
    qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap
) -> None:
    run, _ = store(open_map)
    panel.show_review(ReviewProgress(ReviewState((run,)), accepted=8), None)
    assert "All candidates are decided." in labels(panel)
    assert not card(panel).isVisible()
    assert not button(panel, "Accept  (").isEnabled()
    with qtbot.waitSignal(panel.evaluation_requested, timeout=30_000):
        qtbot.mouseClick(button(panel, "See how good"), Qt.MouseButton.LeftButton)


@pytest.mark.parametrize(
    ("words", "signal"),
    [
        ("Accept  (Enter)", "accept_requested"),
        ("Reject  (Del)", "reject_requested"),
        ("Edit  (E)", "edit_requested"),
        ("Next  (N)", "next_requested"),
        ("Back  (B)", "back_requested"),
    ],
)
def test_every_button_names_its_key_and_asks_for_its_deed(
    qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap, words: str, signal: str
) -> None:
    run, features = store(open_map)
    panel.show_review(ReviewProgress(ReviewState((run,)), left=8, position=1), features[0])
    with qtbot.waitSignal(getattr(panel, signal), timeout=30_000):
        qtbot.mouseClick(button(panel, words), Qt.MouseButton.LeftButton)
    assert not button(panel, words).hasFocus()


def test_accepting_many_says_how_many_before_it_is_done(
    qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap
) -> None:
    run, features = store(open_map)
    sure = [one.provenance.confidence for one in features]
    panel.ask_count_from(lambda least: sum(one >= least for one in sure))
    panel.show_review(ReviewProgress(ReviewState((run,)), left=8, position=1), features[0])
    assert button(panel, "Accept 1").isEnabled()
    number = panel.findChild(NumberField)
    assert isinstance(number, NumberField)
    number.setValue(0.5)
    with qtbot.waitSignal(panel.accept_from_requested) as asked:
        qtbot.mouseClick(button(panel, "Accept 4"), Qt.MouseButton.LeftButton)
    assert asked.args == [0.5]
    number.setValue(1.0)
    assert not button(panel, "Accept 0").isEnabled()


def test_enter_in_the_number_ends_typing_and_judges_nothing(
    qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap
) -> None:
    run, features = store(open_map)
    panel.show_review(ReviewProgress(ReviewState((run,)), left=8, position=1), features[0])
    judge = QAction(panel)
    judge.setShortcut("Return")
    judge.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
    panel.addAction(judge)
    judged = []
    judge.triggered.connect(lambda: judged.append(True))
    number = panel.findChild(NumberField)
    assert isinstance(number, NumberField)
    with qtbot.waitActive(panel):
        panel.activateWindow()
    number.setFocus()
    number.selectAll()
    qtbot.keyClicks(number, "0.75")
    qtbot.keyClick(number, Qt.Key.Key_Return)
    assert panel.least == 0.75
    assert not judged
    assert panel.hasFocus()
    qtbot.keyClick(panel, Qt.Key.Key_Return)
    assert judged


def test_runs_are_marked_in_a_menu_one_at_least(
    qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap
) -> None:
    (first, features), (second, _) = store(open_map), store(open_map, 5, seed=2)
    panel.show_review(ReviewProgress(ReviewState((first,)), left=8, position=1), features[0])
    assert chooser(panel).words.startswith("finder, ")
    everything, one, other = run_actions(panel)
    assert [action.isChecked() for action in (one, other)] == [True, False]
    assert "(8 left)" in one.text()
    assert "(5 left)" in other.text()
    with qtbot.waitSignal(panel.open_requested) as asked:
        other.trigger()
    assert asked.args == [(first, second), ReviewOrder.CONFIDENCE]
    with qtbot.waitSignal(panel.open_requested) as asked:
        everything.trigger()
    assert asked.args[0] == (first, second)
    with qtbot.assertNotEmitted(panel.open_requested):
        run_actions(panel)[1].trigger()  # the last one that is marked
    panel.show_review(ReviewProgress(ReviewState((first, second)), left=13), features[0])
    assert chooser(panel).words == "All runs"


def test_rejected_features_are_shown_on_request(panel: ReviewPanel, open_map: OpenMap) -> None:
    box = panel.findChild(QCheckBox)
    assert isinstance(box, QCheckBox)
    box.click()
    assert open_map.shared.view_settings.shows_rejected
    open_map.shared.view_settings.set_shows_rejected(False)
    assert not box.isChecked()


def test_the_review_can_be_ended(qtbot: QtBot, panel: ReviewPanel, open_map: OpenMap) -> None:
    run, features = store(open_map)
    panel.show_review(ReviewProgress(ReviewState((run,)), left=8, position=1), features[0])
    with qtbot.waitSignal(panel.open_requested) as asked:
        qtbot.mouseClick(button(panel, "End"), Qt.MouseButton.LeftButton)
    assert asked.args == [(), ReviewOrder.CONFIDENCE]
    panel.show_review(ReviewProgress(ReviewState()), None)
    assert any("wait for a decision" in words for words in labels(panel))


def test_the_picture_of_a_candidate_is_seen_while_it_is_judged(
    qtbot: QtBot, tmp_path: Path
) -> None:
    open_map = OpenMap(folder=tmp_path)
    panel = ReviewPanel(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.resize(300, 620)
    panel.show()
    run, (first, second, *_) = store(open_map)
    (tmp_path / photo_folder(run)).mkdir(parents=True)
    face = np.full((40, 40, 3), (215, 0, 15), np.uint8)
    write_photos({photo_name(run, 1): face}, tmp_path / photo_folder(run))
    pictured = replace(first, attributes={**first.attributes, "photo": photo_name(run, 1)})
    progress = ReviewProgress(ReviewState((run,)), left=8, position=1)
    panel.show_review(progress, pictured)
    row = card(panel).findChild(PhotoRow)
    assert isinstance(row, PhotoRow)
    assert row.isVisible()
    shown = row.pixmap().toImage()
    assert shown.pixelColor(shown.width() // 2, shown.height() // 2).name() == "#d7000f"
    assert row.width() >= shown.width()
    assert shown.height() <= 120
    assert not any("photo" in line for line in card(panel).lines())
    assert "height_m: 0.15" in card(panel).lines()
    panel.show_review(progress, second)
    assert not row.isVisible()
