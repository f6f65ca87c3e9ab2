"""F1 opens the manual in the program, whether the machine has a browser or not."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QDialogButtonBox, QTextBrowser, QToolButton
from pytestqt.qtbot import QtBot

from app.window.window_parts import WindowParts
from widgets.dialogs.manual import ManualWindow
from widgets.dialogs.simulate import SimulateForm

WAIT_MS = 30_000


def shown(parts: WindowParts) -> list[ManualWindow]:
    return [one for one in parts.window.findChildren(ManualWindow) if one.isVisible()]


def text_of(manual: ManualWindow) -> str:
    (page,) = manual.findChildren(QTextBrowser)
    assert isinstance(page, QTextBrowser)
    return page.toPlainText()


def press_f1(qtbot: QtBot, parts: WindowParts) -> None:
    with qtbot.waitActive(parts.window):
        parts.window.activateWindow()
    qtbot.keyClick(parts.window, Qt.Key.Key_F1)


def test_f1_shows_the_manual_and_a_second_f1_raises_it_where_it_was(
    qtbot: QtBot, parts: WindowParts, tmp_path: Path
) -> None:
    press_f1(qtbot, parts)
    (manual,) = shown(parts)
    assert "mobile mapping" in text_of(manual)
    manual.show_page("review.html")
    press_f1(qtbot, parts)
    assert shown(parts) == [manual]
    assert text_of(manual).startswith("Review")
    qtbot.waitUntil(manual.isActiveWindow, timeout=WAIT_MS)
    # It belongs to no project.
    assert parts.document.create(tmp_path / "a.zuka", "EPSG:6677")
    parts.document.close()
    assert shown(parts) == [manual]


def test_in_japanese_it_is_the_japanese_one(qtbot: QtBot, parts: WindowParts) -> None:
    press_f1(qtbot, parts)
    parts.window.actions_by_id["language-ja"].trigger()
    qtbot.waitUntil(lambda: parts.language == "ja", timeout=WAIT_MS)
    parts.window.actions_by_id["manual"].trigger()
    (manual,) = shown(parts)
    assert "図化" in text_of(manual)


def test_the_form_of_simulations_opens_its_own_page(qtbot: QtBot, parts: WindowParts) -> None:
    parts.window.actions_by_id["simulate"].trigger()
    (form,) = parts.window.findChildren(SimulateForm)
    (buttons,) = form.findChildren(QDialogButtonBox)
    help_ = buttons.button(QDialogButtonBox.StandardButton.Help)
    qtbot.mouseClick(help_, Qt.MouseButton.LeftButton)
    (manual,) = shown(parts)
    assert text_of(manual).startswith("Simulating")
    form.close()


def test_without_a_browser_it_is_said_where_the_page_is(
    qtbot: QtBot, parts: WindowParts, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[QUrl] = []

    def no_program(url: QUrl) -> bool:
        asked.append(url)
        return False

    monkeypatch.setattr(QDesktopServices, "openUrl", no_program)
    press_f1(qtbot, parts)
    (manual,) = shown(parts)
    (button,) = (
        one
        for one in manual.findChildren(QToolButton)
        if one.accessibleName() == "Open in the browser"
    )
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert [url.fileName() for url in asked] == ["index.html"]
    assert asked[0].toLocalFile() in parts.message_bar.text
    parts.window.actions_by_id["log"].trigger()
    assert asked[1].toLocalFile() in parts.message_bar.text
