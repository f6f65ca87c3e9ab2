"""Sections across drawn lines, and where there is nothing to cut across."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox
from pytestqt.qtbot import QtBot

from processing.monitor import SilentMonitor
from processing.points.drive import Drive
from processing.project.change import Change
from processing.project.importing import ImportRequest, import_drives
from processing.text import Text
from tests.builders import START, simulated_drive, write_laz
from tests.street_scene import CURB_AT_M
from tests.widgets.builders import OpenMap
from tests.widgets.section_view.conftest import Hand, curb_line, shown, station
from widgets.section_view.view import NO_LINE

# Drawn lines.


def test_it_stands_on_the_selected_line_until_the_trajectory_is_wanted(hand: Hand) -> None:
    line = curb_line(hand)
    hand.map.shared.selection.choose_features(frozenset({line.id}))
    hand.do(lambda: hand.view.follow(line.id))
    assert hand.view.standing is not None
    assert hand.view.standing.line.feature == line.id
    hand.do(lambda: hand.key(Qt.Key.Key_W))
    place = hand.map.shared.cursor.place
    assert place is not None
    assert place.xyz[0] == pytest.approx(START[0] - CURB_AT_M, abs=0.1)
    hand.do(lambda: hand.view.follow(""))
    assert hand.view.standing.line.drive


def test_when_the_line_is_deleted_it_goes_back_to_the_trajectory(hand: Hand) -> None:
    line = curb_line(hand)
    hand.do(lambda: hand.view.follow(line.id))
    hand.do(lambda: hand.map.apply(Text.same("delete"), Change(removed=(line,))))
    assert hand.view.followed == ""
    assert hand.view.standing is not None
    assert hand.view.standing.line.drive


def test_a_line_that_is_none_is_refused_with_a_sentence(hand: Hand) -> None:
    before = hand.view.standing
    with hand.qtbot.waitSignal(hand.view.told) as told:
        hand.view.follow("nothing")
    assert told.args == [NO_LINE]
    assert hand.view.followed == ""
    assert before is not None
    assert hand.view.standing is not None


def test_what_crosses_is_in_the_profile(hand: Hand) -> None:
    curb_line(hand)
    wish = hand.view.profile_wish()
    assert wish is not None
    profile = wish()
    assert profile.station_m == pytest.approx(station(hand))
    (crossing,) = profile.crossings
    assert crossing.name.ja == "縁石"
    assert crossing.offset_m == pytest.approx(-CURB_AT_M + 0.5, abs=0.01)
    assert profile.ground


# What there is nothing to show of.


def test_without_a_recording_it_says_what_would_be_here(qtbot: QtBot) -> None:
    hand = shown(qtbot, OpenMap())
    assert hand.pane.words() == "The section appears here once a recording is open."
    assert hand.view.cut is None
    assert hand.view.profile_wish() is None
    hand.key(Qt.Key.Key_W)
    hand.view.set_pinned(True)
    assert not hand.view.is_pinned
    hand.view.close()


def test_without_a_trajectory_a_drawn_line_is_cut_across(qtbot: QtBot, tmp_path: Path) -> None:
    points = write_laz(simulated_drive(1), tmp_path / "street.laz")
    (tmp_path / "drives").mkdir()
    (made,) = import_drives(ImportRequest((points,), ()), tmp_path / "drives", SilentMonitor())
    hand = shown(qtbot, OpenMap((Drive(made),)))
    across_site = hand.view.standing
    assert across_site is not None
    assert across_site.line.is_axis
    assert "Site axis" in {box.currentText() for box in hand.view.findChildren(QComboBox)}
    line = curb_line(hand)
    hand.do(lambda: hand.map.shared.selection.choose_features(frozenset({line.id})))
    assert hand.view.followed == line.id
    assert hand.pane.picture is not None
    assert hand.pane.picture.points.size
    hand.view.close()
