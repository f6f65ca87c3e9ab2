"""The window's habits: keys, tooltips, what needs a project, and how it stands the next time."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QTreeWidget, QWidget
from pytestqt.qtbot import QtBot

from app.application import build_window, make_application
from app.keys.shortcut_editing import shortcuts_of
from app.review.review_wiring import QUEUE_ACTIONS
from app.runs.process_actions import FIND_ALL, one_click_buttons, run_action_of
from app.settings.settings import Settings
from app.window.window_parts import WindowParts
from tests.app.test_one_click import open_street
from widgets.dialogs.shortcuts import ShortcutsForm
from widgets.parts.command_palette import CommandPalette

WindowStarter = Callable[[], WindowParts]


@pytest.fixture
def start(qtbot: QtBot, tmp_path: Path) -> Iterator[WindowStarter]:
    """Starts the program with the same settings each time; the window before is closed first."""
    make_application()
    running: list[WindowParts] = []

    def stop() -> None:
        while running:
            parts = running.pop()
            parts.window.close()
            parts.window.deleteLater()

    def start() -> WindowParts:
        stop()
        parts = build_window(Settings(tmp_path / "settings.ini"), tmp_path / "projects")
        parts.window.resize(1366, 768)
        parts.window.show()
        qtbot.waitExposed(parts.window)
        running.append(parts)
        return parts

    yield start
    stop()


@pytest.fixture
def parts(start: WindowStarter) -> WindowParts:
    return start()


@pytest.fixture
def form(parts: WindowParts) -> ShortcutsForm:
    parts.window.actions_by_id["shortcuts"].trigger()
    form = parts.window.findChild(ShortcutsForm)
    assert isinstance(form, ShortcutsForm)
    return form


def keys_of(parts: WindowParts, action: str) -> list[str]:
    return [key.toString() for key in parts.window.actions_by_id[action].shortcuts()]


def test_no_two_actions_have_the_same_key(parts: WindowParts) -> None:
    keys = [key for action in parts.window.actions_by_id for key in keys_of(parts, action)]
    assert sorted(keys) == sorted(set(keys))


def test_no_action_has_a_key_that_the_views_need(parts: WindowParts) -> None:
    shortcuts = shortcuts_of(parts)
    conflicts = {
        action: shortcuts.conflict(action, key)
        for action, keys in shortcuts.all_keys().items()
        for key in keys
    }
    assert {action for action, conflict in conflicts.items() if conflict is not None} == set()


def test_what_needs_a_project_is_disabled_until_one_is_open(
    parts: WindowParts, tmp_path: Path
) -> None:
    actions = parts.window.actions_by_id
    needing = [
        entry.action.id for entry in parts.window.actions_made.entries if entry.action.needs_project
    ]
    assert {"export", "close", "everything", "panel-layers"} <= set(needing)
    assert not any(actions[name].isEnabled() for name in needing)
    assert parts.document.create(tmp_path / "p.zuka", "EPSG:6677")
    # An empty project has no drive to run on.
    drives = {run_action_of(tool) for tool in one_click_buttons()}
    nothing_to_do = {"undo", "redo", FIND_ALL, *QUEUE_ACTIONS, *drives}
    assert all(actions[name].isEnabled() for name in needing if name not in nothing_to_do)
    assert not any(actions[name].isEnabled() for name in nothing_to_do)
    parts.document.close()
    assert not any(actions[name].isEnabled() for name in needing)


def test_the_palette_says_why_something_needs_a_project(parts: WindowParts) -> None:
    parts.window.actions_by_id["palette"].trigger()
    palette = parts.window.findChild(CommandPalette)
    assert isinstance(palette, CommandPalette)
    rows = palette.findChild(QTreeWidget)
    lines = [rows.topLevelItem(at) for at in range(rows.topLevelItemCount())]
    said = {line.text(0): line.text(1) for line in lines}
    assert said["Export"] == "Open a project first."
    assert said["Open project"] == "プロジェクトを開く"
    palette.close()


def test_every_button_of_the_toolbar_says_its_name_and_its_key(parts: WindowParts) -> None:
    for entry in parts.window.actions_made.entries:
        if entry.action.toolbar:
            first, *_ = entry.made.toolTip().split("\n")
            name = entry.action.name.en
            keys = keys_of(parts, entry.action.id)
            assert first == (f"{name} ({keys[0]})" if keys else name)


def test_all_buttons_of_the_toolbar_are_seen_at_1366_pixels(
    qtbot: QtBot, parts: WindowParts
) -> None:
    for button in parts.window.findChildren(QWidget, "qt_toolbar_ext_button"):
        assert not button.isVisible()


def test_nor_is_one_hidden_in_japanese_once_a_drive_is_open(
    qtbot: QtBot, start: WindowStarter, tmp_path: Path
) -> None:
    Settings(tmp_path / "settings.ini").choose_language("ja")
    parts = start()
    open_street(parts, tmp_path, qtbot)
    qtbot.waitUntil(parts.image_view.isVisible)
    for button in parts.window.findChildren(QWidget, "qt_toolbar_ext_button"):
        assert not button.isVisible()


def test_a_new_key_works_at_once_and_at_the_next_start(
    qtbot: QtBot, start: WindowStarter, form: ShortcutsForm, parts: WindowParts
) -> None:
    form.key_chosen.emit("manual", "Ctrl+M")
    assert keys_of(parts, "manual") == ["Ctrl+M"]
    assert "Ctrl+M" in parts.window.actions_by_id["manual"].toolTip()
    assert keys_of(start(), "manual") == ["Ctrl+M"]


def test_the_pressed_key_does_what_it_was_given_to(
    qtbot: QtBot, start: WindowStarter, parts: WindowParts, tmp_path: Path
) -> None:
    parts.settings.keep_shortcuts({"show-height": ("Ctrl+J",)})
    parts = start()
    assert parts.document.create(tmp_path / "p.zuka", "EPSG:6677")
    parts.window.activateWindow()
    qtbot.waitUntil(parts.window.isActiveWindow, timeout=30_000)
    qtbot.keyClick(parts.window, Qt.Key.Key_J, Qt.KeyboardModifier.ControlModifier)
    assert parts.document.shared.view_settings.look.attribute == "height"


def test_a_key_that_is_taken_over_leaves_its_owner_without(
    form: ShortcutsForm, parts: WindowParts
) -> None:
    trouble = form._trouble("manual", "Ctrl+E")
    assert trouble.sentence == "Ctrl+E already does: Export; it would lose its key."
    assert trouble.may_be_taken
    form.key_chosen.emit("manual", "Ctrl+E")
    assert keys_of(parts, "manual") == ["Ctrl+E"]
    assert keys_of(parts, "export") == []
    form.defaults_requested.emit()
    assert keys_of(parts, "manual") == ["F1"]
    assert keys_of(parts, "export") == ["Ctrl+E"]


def test_the_keys_of_the_views_are_listed_and_not_given_away(form: ShortcutsForm) -> None:
    trouble = form._trouble("manual", "Space")
    assert not trouble.may_be_taken
    rows = form.findChild(QTreeWidget)
    menus = [rows.topLevelItem(at).text(1) for at in range(rows.topLevelItemCount())]
    assert menus.count("Views (fixed)") >= 10


def test_the_list_is_saved_for_a_spreadsheet(form: ShortcutsForm, tmp_path: Path) -> None:
    form.save_requested.emit(tmp_path / "キー.csv")
    with (tmp_path / "キー.csv").open(encoding="utf-8-sig", newline="") as file:
        lines = list(csv.reader(file))
    assert lines[0] == ["Name", "Menu", "Key"]
    assert ["Open project", "File", "Ctrl+O"] in lines


def test_a_list_that_can_not_be_saved_is_told(
    form: ShortcutsForm, parts: WindowParts, tmp_path: Path
) -> None:
    (tmp_path / "keys.csv").mkdir()
    form.save_requested.emit(tmp_path / "keys.csv")
    text = parts.message_bar.text
    assert "This is a folder" in text
    assert str(tmp_path / "keys.csv") in text


def test_a_panel_that_was_closed_stays_closed_at_the_next_start(
    qtbot: QtBot, start: WindowStarter, parts: WindowParts, tmp_path: Path
) -> None:
    assert parts.document.create(tmp_path / "p.zuka", "EPSG:6677")
    parts.window.actions_by_id["panel-jobs"].trigger()
    parts.window.area.stand_side_by_side(beside=True)
    qtbot.wait(0)
    parts = start()
    assert parts.document.open(tmp_path / "p.zuka")
    qtbot.wait(0)
    hidden = {name: parts.window.findChild(QWidget, name).isHidden() for name in ("jobs", "layers")}
    assert hidden == {"jobs": True, "layers": False}
    assert parts.window.area.is_beside
    assert parts.window.actions_by_id["side-by-side"].isChecked()


def test_a_panel_that_is_opened_stands_before_those_that_share_its_place(
    start: WindowStarter, tmp_path: Path, qtbot: QtBot
) -> None:
    parts = start()
    assert parts.document.create(tmp_path / "p.zuka", "EPSG:6677")
    qtbot.waitUntil(lambda: not parts.layers_panel.visibleRegion().isEmpty(), timeout=30_000)
    parts.window.actions_by_id["panel-labels"].trigger()
    qtbot.waitUntil(lambda: not parts.label_panel.visibleRegion().isEmpty(), timeout=30_000)


def test_a_window_left_without_a_project_shows_its_panels_the_next_time(
    qtbot: QtBot, start: WindowStarter, parts: WindowParts, tmp_path: Path
) -> None:
    parts = start()
    assert parts.document.create(tmp_path / "p.zuka", "EPSG:6677")
    qtbot.wait(0)
    names = ("project", "layers", "processing", "attributes", "jobs")
    assert not any(parts.window.findChild(QWidget, name).isHidden() for name in names)
