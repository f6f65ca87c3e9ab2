"""Sections across drawn lines, and where there is nothing to cut across."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox
from pytestqt.qtbot import QtBot

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.map.change import Change
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from tests.builders import START, simulated_drive, write_laz
from tests.street_scene import CURB_AT_M
from tests.widgets.builders import OpenMap
from tests.widgets.section_view.conftest import SectionViewUser, curb_line, shown, station
from widgets.section_view.view import NO_LINE

# Drawn lines.


def test_it_stands_on_the_selected_line_until_the_trajectory_is_wanted(
    user: SectionViewUser,
) -> None:
    line = curb_line(user)
    user.map.shared.selection.choose_features(frozenset({line.id}))
    user.do(lambda: user.view.follow(line.id))
    assert user.view.standing is not None
    assert user.view.standing.line.feature == line.id
    user.do(lambda: user.key(Qt.Key.Key_W))
    position = user.map.shared.cursor.position
    assert position is not None
    assert position.xyz[0] == pytest.approx(START[0] - CURB_AT_M, abs=0.1)
    user.do(lambda: user.view.follow(""))
    assert user.view.standing.line.drive


def test_when_the_line_is_deleted_it_goes_back_to_the_trajectory(user: SectionViewUser) -> None:
    line = curb_line(user)
    user.do(lambda: user.view.follow(line.id))
    user.do(lambda: user.map.apply(Text.same("delete"), Change(removed=(line,))))
    assert user.view.followed == ""
    assert user.view.standing is not None
    assert user.view.standing.line.drive


def test_a_line_that_is_none_is_refused_with_a_sentence(user: SectionViewUser) -> None:
    before = user.view.standing
    with user.qtbot.waitSignal(user.view.reported) as reported:
        user.view.follow("nothing")
    assert reported.args == [NO_LINE]
    assert user.view.followed == ""
    assert before is not None
    assert user.view.standing is not None


def test_what_crosses_is_in_the_profile(user: SectionViewUser) -> None:
    curb_line(user)
    request = user.view.profile_request()
    assert request is not None
    profile = request()
    assert profile.station_m == pytest.approx(station(user))
    (crossing,) = profile.crossings
    assert crossing.name.ja == "縁石"
    assert crossing.offset_m == pytest.approx(-CURB_AT_M + 0.5, abs=0.01)
    assert profile.ground


# What there is nothing to show of.


def test_without_a_recording_it_says_what_would_be_here(qtbot: QtBot) -> None:
    user = shown(qtbot, OpenMap())
    assert user.pane.words() == "The section appears here once a recording is open."
    assert user.view.cut is None
    assert user.view.profile_request() is None
    user.key(Qt.Key.Key_W)
    user.view.set_pinned(True)
    assert not user.view.is_pinned
    user.view.close()


def test_without_a_trajectory_a_drawn_line_is_cut_across(qtbot: QtBot, tmp_path: Path) -> None:
    points = write_laz(simulated_drive(1), tmp_path / "street.laz")
    (tmp_path / "drives").mkdir()
    (made,) = import_drives(ImportRequest((points,), ()), tmp_path / "drives", SilentMonitor())
    user = shown(qtbot, OpenMap((Drive(made),)))
    across_site = user.view.standing
    assert across_site is not None
    assert across_site.line.is_axis
    assert "Site axis" in {box.currentText() for box in user.view.findChildren(QComboBox)}
    line = curb_line(user)
    user.do(lambda: user.map.shared.selection.choose_features(frozenset({line.id})))
    assert user.view.followed == line.id
    assert user.pane.picture is not None
    assert user.pane.picture.points.size
    user.view.close()
