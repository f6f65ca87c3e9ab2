"""The palette: any command by a part of its name, in either language."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QLineEdit, QTreeWidget, QWidget
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from widgets.parts.command_palette import CommandPalette, NamedAction, match_rank

NAMES = (
    ("open", Text("Open project", "プロジェクトを開く")),
    ("export", Text("Export", "書き出し")),
    ("curb", Text("Draw: Curb, lower edge", "作図: 縁石下端")),
    ("close", Text("Close project", "プロジェクトを閉じる")),
)
NO_PROJECT = Text("Open a project first.", "先にプロジェクトを開いてください。")


class Bench:
    """A palette over four actions that note what was done."""

    def __init__(self, qtbot: QtBot, used: tuple[str, ...] = ()) -> None:
        self.qtbot = qtbot
        self.window = QWidget()
        self.done: list[str] = []
        self.actions = {id_: QAction(name.en, self.window) for id_, name in NAMES}
        for id_, action in self.actions.items():
            action.triggered.connect(lambda _checked, id_=id_: self.done.append(id_))
        self.actions["export"].setShortcut("Ctrl+E")
        self.actions["close"].setEnabled(False)
        named = [
            NamedAction(
                id_, name, self.actions[id_], NO_PROJECT if id_ == "close" else Text("", "")
            )
            for id_, name in NAMES
        ]
        self.palette = CommandPalette(named, "ja", self.window, used=used)
        self.palette.show()
        qtbot.waitExposed(self.palette)

    @property
    def words(self) -> QLineEdit:
        found = self.palette.findChild(QLineEdit)
        assert isinstance(found, QLineEdit)
        return found

    def lines(self) -> list[list[str]]:
        found = self.palette.findChild(QTreeWidget)
        assert isinstance(found, QTreeWidget)
        items = [found.topLevelItem(row) for row in range(found.topLevelItemCount())]
        return [[item.text(column) for column in range(3)] for item in items if item]

    def type(self, text: str) -> None:
        self.qtbot.keyClicks(self.words, text)

    def press(self, key: Qt.Key) -> None:
        self.qtbot.keyClick(self.words, key)


@pytest.fixture
def bench(qtbot: QtBot) -> Iterator[Bench]:
    bench = Bench(qtbot)
    yield bench
    bench.window.close()
    bench.window.deleteLater()


def test_every_action_is_listed_in_both_languages_with_its_key(bench: Bench) -> None:
    assert bench.lines()[1] == ["書き出し", "Export", "Ctrl+E"]


@pytest.mark.parametrize("typed", ["curb", "縁石", "CURB low", "ｃｕｒｂ", "dcle"])
def test_a_command_is_found_by_parts_of_its_name_in_either_language(
    bench: Bench, typed: str
) -> None:
    bench.words.setText(typed)
    assert [line[0] for line in bench.lines()] == ["作図: 縁石下端"]


def test_enter_does_the_chosen_command_and_tells_which(qtbot: QtBot, bench: Bench) -> None:
    bench.type("exp")
    with qtbot.waitSignal(bench.palette.chosen) as reported:
        bench.press(Qt.Key.Key_Return)
    assert reported.args == ["export"]
    assert bench.done == ["export"]


def test_the_arrows_choose_while_one_types(bench: Bench) -> None:
    bench.press(Qt.Key.Key_Down)
    bench.press(Qt.Key.Key_Down)
    bench.press(Qt.Key.Key_Return)
    assert bench.done == ["curb"]


def test_a_disabled_command_says_why_and_is_not_done(bench: Bench) -> None:
    bench.type("close")
    assert bench.lines()[0][:2] == ["プロジェクトを閉じる", "先にプロジェクトを開いてください。"]
    bench.press(Qt.Key.Key_Return)
    assert bench.done == []
    assert bench.palette.isVisible()


def test_what_was_used_last_comes_first_among_what_fits_as_well(qtbot: QtBot) -> None:
    bench = Bench(qtbot, used=("close", "export"))
    assert [line[1] for line in bench.lines()] == [
        "先にプロジェクトを開いてください。",
        "Export",
        "Open project",
        "Draw: Curb, lower edge",
    ]
    bench.words.setText("open")
    assert bench.lines()[0][1] == "Open project"
    bench.window.deleteLater()


def test_a_beginning_fits_better_than_a_middle_and_letters_in_order() -> None:
    ranks = [match_rank(typed, "Open project") for typed in ("op", "pro", "ject", "opj", "jo")]
    assert ranks == [0, 1, 2, 3, None]


def test_a_key_finds_the_command_that_has_it(bench: Bench) -> None:
    bench.type("ctrl+e")
    assert bench.lines()[0][0] == "書き出し"
