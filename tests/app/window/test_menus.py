"""Menus: groups with lines between them, each command once, grey entries that say why."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu
from pytestqt.qtbot import QtBot

from app.window.action import MENUS
from app.window.window_parts import WindowParts

HIGHEST_PX = 768
LONGEST_GROUP = 12


def menus_of(parts: WindowParts) -> list[QMenu]:
    found = [action.menu() for action in parts.window.menuBar().actions()]
    return [menu for menu in found if isinstance(menu, QMenu)]


def groups_of(menu: QMenu) -> list[list[QAction]]:
    groups: list[list[QAction]] = [[]]
    for action in menu.actions():
        if action.isSeparator():
            groups.append([])
        else:
            groups[-1].append(action)
    return groups


def test_every_menu_fits_a_low_screen_and_is_divided_into_short_groups(parts: WindowParts) -> None:
    menus = menus_of(parts)
    assert len(menus) == len(MENUS)
    for menu in menus:
        groups = groups_of(menu)
        assert all(groups), menu.title()
        assert max(map(len, groups)) <= LONGEST_GROUP, menu.title()
        assert menu.sizeHint().height() < HIGHEST_PX, menu.title()


def test_no_command_stands_twice_under_one_name(parts: WindowParts) -> None:
    named = Counter(entry.action.name.en for entry in parts.window.actions_made.entries)
    assert [name for name, count in named.items() if count > 1] == []


def test_a_grey_entry_says_why(parts: WindowParts) -> None:
    export = parts.window.actions_by_id["export"]
    assert not export.isEnabled()
    assert "Open a project first." in export.toolTip()
    assert all(menu.toolTipsVisible() for menu in menus_of(parts))


def test_undo_says_that_there_is_nothing_to_undo(parts: WindowParts, tmp_path: Path) -> None:
    assert parts.document.create(tmp_path / "street.zuka", "EPSG:6677")
    undo = parts.window.actions_by_id["undo"]
    assert not undo.isEnabled()
    assert "There is nothing to undo." in undo.toolTip()
    assert "Open a project first." not in undo.toolTip()


def test_the_file_menu_opens_a_recent_project(
    parts: WindowParts, qtbot: QtBot, tmp_path: Path
) -> None:
    for name in ("first", "second"):
        assert parts.document.create(tmp_path / f"{name}.zuka", "EPSG:6677")
    menu = parts.window.actions_made.menu("file/recent")
    menu.aboutToShow.emit()
    recent = [action for action in menu.actions() if action.text() in ("first", "second")]
    assert [action.text() for action in recent] == ["second", "first"]
    with qtbot.waitSignal(parts.document.opened):
        recent[1].trigger()
    assert parts.document.project is not None
    assert parts.document.project.name == "first"
    parts.window.actions_by_id["forget-recent"].trigger()
    menu.aboutToShow.emit()
    assert [one.text() for one in menu.actions() if not one.isSeparator()] == ["Clear the list"]
