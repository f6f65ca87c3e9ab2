"""The manual in the program: links, search, and nothing from outside its folder."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt, QUrl
from PySide6.QtGui import QImage, QTextCursor, QTextDocument
from PySide6.QtWidgets import QLineEdit, QTextBrowser, QTreeWidget
from pytestqt.qtbot import QtBot

from resources import path_of
from widgets.dialogs.manual import ManualWindow
from widgets.parts.manual_pages import found_sections, sections

WAIT_MS = 10_000
LANGUAGES = ("en", "ja")


def open_manual(qtbot: QtBot, folder: Path) -> ManualWindow:
    window = ManualWindow(folder)
    qtbot.addWidget(window)
    window.show()
    qtbot.waitExposed(window)
    return window


@pytest.fixture
def manual(qtbot: QtBot) -> ManualWindow:
    return open_manual(qtbot, path_of("manual/en"))


def page_of(manual: ManualWindow) -> QTextBrowser:
    (page,) = manual.findChildren(QTextBrowser)
    assert isinstance(page, QTextBrowser)
    return page


def heading(manual: ManualWindow) -> str:
    return page_of(manual).document().firstBlock().text()


def spot_of(page: QTextBrowser, words: str) -> QPoint:
    """Where words stand on the screen."""
    cursor = page.document().find(words)
    assert not cursor.isNull(), words
    page.setTextCursor(cursor)
    page.ensureCursorVisible()
    middle = QTextCursor(page.document())
    middle.setPosition((cursor.selectionStart() + cursor.selectionEnd()) // 2)
    return page.cursorRect(middle).center()


def test_a_click_on_a_link_leads_to_its_page_and_the_keys_lead_back(
    qtbot: QtBot, manual: ManualWindow
) -> None:
    page = page_of(manual)
    assert heading(manual) == "Zuka"
    spot = spot_of(page, "Reference system")
    qtbot.mouseClick(page.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert heading(manual) == "Start"
    assert page.source().fragment() == "reference-system"
    assert page.verticalScrollBar().value() > 0
    with qtbot.waitActive(manual):
        manual.activateWindow()
    qtbot.keyClick(page, Qt.Key.Key_Left, Qt.KeyboardModifier.AltModifier)
    assert heading(manual) == "Zuka"
    qtbot.keyClick(page, Qt.Key.Key_Right, Qt.KeyboardModifier.AltModifier)
    assert heading(manual) == "Start"


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_place_of_the_contents_is_there(qtbot: QtBot, language: str) -> None:
    folder = path_of(f"manual/{language}")
    manual = open_manual(qtbot, folder)
    page = page_of(manual)
    for section in sections(folder):
        manual.show_page(f"{section.page.name}#{section.anchor}")
        assert heading(manual) == section.page_title
        assert section.title in page.toPlainText()
        # What belongs to the browser isn't shown.
        assert page.toPlainText().startswith(section.page_title)
    assert {one.page.name for one in sections(folder)} == {
        one.name for one in folder.glob("*.html") if one.name != "index.html"
    }


def test_words_are_searched_on_all_pages_and_marked_one_after_the_other(
    qtbot: QtBot, manual: ManualWindow
) -> None:
    page = page_of(manual)
    (words,) = (one for one in manual.findChildren(QLineEdit))
    with qtbot.waitActive(manual):
        manual.activateWindow()
    qtbot.keyClick(page, Qt.Key.Key_F, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(words.hasFocus, timeout=WAIT_MS)
    qtbot.keyClicks(words, "covered gutters")
    qtbot.keyClick(words, Qt.Key.Key_Return)
    assert heading(manual) == "Curbs and covered gutters"
    marks = page.extraSelections()
    assert len(marks) > 2
    assert {one.cursor.selectedText().casefold() for one in marks} == {"covered", "gutters"}
    ends = [one.cursor.position() for one in marks]
    reached = []
    for _ in ends:
        qtbot.keyClick(words, Qt.Key.Key_Return)
        reached.append(page.textCursor().position())
    assert sorted(set(reached)) == sorted(set(ends))
    qtbot.keyClick(manual, Qt.Key.Key_F3, Qt.KeyboardModifier.ShiftModifier)
    assert page.textCursor().position() in ends


def test_a_search_for_what_is_nowhere_says_so_and_an_empty_one_shows_the_contents(
    qtbot: QtBot, manual: ManualWindow
) -> None:
    (words,) = (one for one in manual.findChildren(QLineEdit))
    (tree,) = manual.findChildren(QTreeWidget)
    pages = tree.topLevelItemCount()
    qtbot.keyClicks(words, "qwertz")
    assert [tree.topLevelItem(0).text(0), tree.topLevelItemCount()] == ["Nothing found.", 1]
    words.clear()
    assert tree.topLevelItemCount() == pages > 15


def test_a_section_with_the_words_in_its_heading_comes_first() -> None:
    (first, *others) = found_sections(path_of("manual/ja"), "スナップ")
    assert "スナップ" in first.title
    assert others


def test_nothing_outside_the_manual_is_read_or_fetched(qtbot: QtBot, tmp_path: Path) -> None:
    folder = tmp_path / "manual" / "en"
    folder.mkdir(parents=True)
    picture = QImage(8, 8, QImage.Format.Format_RGB32)
    picture.fill(Qt.GlobalColor.red)
    assert picture.save(str(folder / "inside.png"))
    assert picture.save(str(tmp_path / "outside.png"))
    (folder / "index.html").write_text(
        '<html><body><main><h1>A</h1><img src="inside.png"><img src="../../outside.png">'
        '<img src="http://127.0.0.1:1/x.png"></main></body></html>',
        encoding="utf-8",
    )
    manual = open_manual(qtbot, folder)
    page = page_of(manual)
    kind = QTextDocument.ResourceType.ImageResource.value
    for name, is_read in (
        ("inside.png", True),
        ("../../outside.png", False),
        ("http://127.0.0.1:1/x.png", False),
    ):
        assert bool(page.loadResource(kind, QUrl(name))) is is_read


def test_escape_closes_it(qtbot: QtBot) -> None:
    manual = ManualWindow(path_of("manual/en"))
    manual.show()
    qtbot.waitExposed(manual)
    with qtbot.waitActive(manual):
        manual.activateWindow()
    with qtbot.waitSignal(manual.destroyed):
        qtbot.keyClick(page_of(manual), Qt.Key.Key_Escape)
