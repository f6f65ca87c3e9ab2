"""The start page: three ways to begin, and what was opened before."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QPushButton, QToolButton, QTreeWidget
from pytestqt.qtbot import QtBot

from widgets.parts.recent_project import RecentProject
from widgets.parts.start_page import StartPage

OPENED_AT = datetime(2026, 3, 9, 17, 30).astimezone()


@pytest.fixture
def page(qtbot: QtBot) -> StartPage:
    page = StartPage("ja")
    qtbot.addWidget(page)
    page.resize(1000, 600)
    page.show()
    qtbot.waitExposed(page)
    return page


def list_of(page: StartPage) -> QTreeWidget:
    found = page.findChild(QTreeWidget)
    assert isinstance(found, QTreeWidget)
    return found


def middle_of(page: StartPage, row: int) -> QPoint:
    recent = list_of(page)
    item = recent.topLevelItem(row)
    assert item is not None
    return recent.visualItemRect(item).center()


@pytest.mark.parametrize(("position", "asked"), list(enumerate(["import", "open", "demo"])))
def test_the_start_page_has_three_ways_to_begin(
    qtbot: QtBot, page: StartPage, position: int, asked: str
) -> None:
    button = page.findChildren(QPushButton)[position]
    with qtbot.waitSignal(getattr(page, f"{asked}_requested"), timeout=30_000):
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Space])
def test_the_buttons_are_pressed_by_the_keyboard(
    qtbot: QtBot, page: StartPage, key: Qt.Key
) -> None:
    with qtbot.waitSignal(page.open_requested, timeout=30_000):
        qtbot.keyClick(page.findChildren(QPushButton)[1], key)


def test_a_click_on_a_recent_project_opens_it_once(
    qtbot: QtBot, page: StartPage, tmp_path: Path
) -> None:
    page.show_recent([RecentProject(tmp_path / "国道.zuka"), RecentProject(tmp_path / "B.zuka")])
    chosen: list[Path] = []
    page.recent_chosen.connect(chosen.append)
    qtbot.mouseClick(
        list_of(page).viewport(),
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
        middle_of(page, 0),
    )
    assert chosen == [tmp_path / "国道.zuka"]


def test_the_arrows_and_enter_open_a_recent_project(
    qtbot: QtBot, page: StartPage, tmp_path: Path
) -> None:
    page.show_recent([RecentProject(tmp_path / "A.zuka"), RecentProject(tmp_path / "B.zuka")])
    chosen: list[Path] = []
    page.recent_chosen.connect(chosen.append)
    qtbot.keyClick(list_of(page), Qt.Key.Key_Down)
    qtbot.keyClick(list_of(page), Qt.Key.Key_Return)
    assert chosen == [tmp_path / "B.zuka"]


def test_a_line_says_name_folder_and_day(page: StartPage, tmp_path: Path) -> None:
    page.show_recent([RecentProject(tmp_path / "国道.zuka", OPENED_AT)])
    item = list_of(page).topLevelItem(0)
    assert item is not None
    assert [item.text(column) for column in range(3)] == ["国道", str(tmp_path), "2026/03/09"]


def test_a_long_folder_is_cut_in_its_middle(page: StartPage) -> None:
    assert list_of(page).textElideMode() == Qt.TextElideMode.ElideMiddle


def test_a_missing_project_is_not_opened_but_taken_off_by_its_button(
    qtbot: QtBot, page: StartPage, tmp_path: Path
) -> None:
    gone = tmp_path / "gone.zuka"
    page.show_recent([RecentProject(tmp_path / "A.zuka"), RecentProject(gone, is_missing=True)])
    chosen: list[Path] = []
    page.recent_chosen.connect(chosen.append)
    recent = list_of(page)
    qtbot.mouseClick(recent.viewport(), Qt.MouseButton.LeftButton, pos=middle_of(page, 1))
    qtbot.keyClick(recent, Qt.Key.Key_Return)
    assert chosen == []
    (button,) = recent.findChildren(QToolButton)
    with qtbot.waitSignal(page.forget_requested) as asked:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert asked.args == [gone]


def test_delete_takes_a_project_off_the_list(qtbot: QtBot, page: StartPage, tmp_path: Path) -> None:
    page.show_recent([RecentProject(tmp_path / "A.zuka")])
    with qtbot.waitSignal(page.forget_requested) as asked:
        qtbot.keyClick(list_of(page), Qt.Key.Key_Delete)
    assert asked.args == [tmp_path / "A.zuka"]


def test_a_project_may_be_taken_off_while_its_button_is_pressed(
    qtbot: QtBot, page: StartPage, tmp_path: Path
) -> None:
    page.show_recent([RecentProject(tmp_path / "gone.zuka", is_missing=True)])
    page.forget_requested.connect(lambda _folder: page.show_recent(()))
    (button,) = list_of(page).findChildren(QToolButton)
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert list_of(page).topLevelItemCount() == 0


def test_without_recent_projects_there_is_no_empty_list(page: StartPage) -> None:
    assert not list_of(page).isVisible()
