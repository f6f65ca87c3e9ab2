"""CommandPalette: every action by name, in both languages, with its key."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QAction, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QHeaderView,
    QLineEdit,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language, Text

_NAME, _OTHER, _KEY = range(3)
_ROW = Qt.ItemDataRole.UserRole
_WHOLE_NAME = -1
"""Before everything that only begins like what was typed; so does a whole key."""
_NATIVE = QKeySequence.SequenceFormat.NativeText
_STEPS = {
    Qt.Key.Key_Down: 1,
    Qt.Key.Key_Up: -1,
    Qt.Key.Key_PageDown: 10,
    Qt.Key.Key_PageUp: -10,
}


@dataclass(frozen=True)
class NamedAction:
    """An action and its name in both languages.

    Attributes
    ----------
    why_disabled : Text
        Why it can't be done now; empty when it can, or when nobody knows.
    """

    id: str
    name: Text
    action: QAction
    why_disabled: Text = Text("", "")


class CommandPalette(QDialog):
    """A list that is narrowed by typing; Enter does the chosen action, Escape leaves.

    Parameters
    ----------
    used : sequence of str
        Ids of the actions chosen last, the newest first; they come before others that fit as well.

    Signals
    -------
    chosen(id: str)
        An action is about to be done.
    """

    chosen = Signal(str)

    def __init__(
        self,
        actions: Sequence[NamedAction],
        language: Language,
        parent: QWidget | None = None,
        *,
        used: Sequence[str] = (),
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Commands"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        order = {id_: position for position, id_ in enumerate(used)}
        # Sorting keeps the order of those that are alike: the order of the menus.
        self._actions = sorted(actions, key=lambda named: order.get(named.id, len(order)))
        self._language = language
        self._words = QLineEdit(self)
        self._words.setPlaceholderText(self.tr("Type part of a name, or a key such as F9"))
        self._list = QTreeWidget(self)
        self._list.setColumnCount(3)
        self._list.setHeaderHidden(True)
        self._list.setRootIsDecorated(False)
        self._list.setUniformRowHeights(True)
        self._list.setAllColumnsShowFocus(True)
        self._list.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # the keys go to the words
        header = self._list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(_NAME, QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(_OTHER, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(_KEY, QHeaderView.ResizeMode.ResizeToContents)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.addWidget(self._words)
        layout.addWidget(self._list)
        self.resize(620, 420)
        self._words.textChanged.connect(self._on_words_text_changed)
        self._words.returnPressed.connect(self._on_words_return_pressed)
        self._list.itemClicked.connect(self._on_words_return_pressed)
        self._words.installEventFilter(self)
        self._on_words_text_changed("")

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = _STEPS.get(Qt.Key(event.key()))
            count = self._list.topLevelItemCount()
            if step is not None and count:
                position = self._list.currentIndex().row() + step
                # One step goes round, a page stops at the end.
                self._choose(
                    position % count if abs(step) == 1 else min(max(position, 0), count - 1)
                )
                return True
        return super().eventFilter(watched, event)

    def _choose(self, position: int) -> None:
        item = self._list.topLevelItem(position)
        if item is not None:
            self._list.setCurrentItem(item)

    def _on_words_text_changed(self, words: str) -> None:
        self._list.clear()
        ranked = [(self._rank(words, named), named) for named in self._actions]
        fitting = [(rank, named) for rank, named in ranked if rank is not None]
        for _, named in sorted(fitting, key=lambda pair: pair[0]):
            self._list.addTopLevelItem(self._item(named))
        self._choose(0)

    @staticmethod
    def _rank(words: str, named: NamedAction) -> int | None:
        ranks = [match_rank(words, name) for name in (named.name.en, named.name.ja)]
        typed = _plain(words).replace(" ", "")
        keys = [_plain(key.toString(_NATIVE)) for key in named.action.shortcuts()]
        if typed in keys or typed in (_plain(name) for name in (named.name.en, named.name.ja)):
            return _WHOLE_NAME
        if "+" in typed and any(key.startswith(typed) for key in keys):
            return 0
        return min((rank for rank in ranks if rank is not None), default=None)

    def _item(self, named: NamedAction) -> QTreeWidgetItem:
        name, other = named.name.in_language(self._language), _other(named.name, self._language)
        is_enabled = named.action.isEnabled()
        reason = named.why_disabled.in_language(self._language)
        beside = other if other != name else ""
        item = QTreeWidgetItem(
            [
                name,
                beside if is_enabled or not reason else reason,
                named.action.shortcut().toString(_NATIVE),
            ]
        )
        item.setIcon(_NAME, named.action.icon())
        item.setData(_NAME, _ROW, named)
        item.setTextAlignment(_KEY, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        item.setToolTip(_NAME, named.action.toolTip())
        grey = self.palette().placeholderText()
        for column in (_NAME, _OTHER, _KEY) if not is_enabled else (_OTHER, _KEY):
            item.setForeground(column, grey)
        return item

    def _on_words_return_pressed(self) -> None:
        item = self._list.currentItem()
        if item is None:
            return
        named: NamedAction = item.data(_NAME, _ROW)
        if named.action.isEnabled():
            self.chosen.emit(named.id)
            self.close()
            named.action.trigger()


def _other(text: Text, language: Language) -> str:
    return text.en if language == "ja" else text.ja


def match_rank(typed: str, name: str) -> int | None:
    """How far a name is from what was typed; 0 is nearest, None fits not at all.

    Every word that was typed must be found: at the beginning of the name (0), at the beginning of
    one of its words (1), within one (2), or by its letters in their order (3); the worst counts.
    Upper and lower case, full and half width are the same.

    >>> [match_rank(typed, "Open project") for typed in ("op", "pro", "ject", "opj", "jo")]
    [0, 1, 2, 3, None]
    """
    name = _plain(name)
    ranks = [_word_rank(word, name) for word in _plain(typed).split()]
    found = [rank for rank in ranks if rank is not None]
    return None if len(found) < len(ranks) else max(found, default=0)


def _word_rank(word: str, name: str) -> int | None:
    if name.startswith(word):
        return 0
    if re.search(rf"(?<!\w){re.escape(word)}", name):
        return 1
    if word in name:
        return 2
    letters = iter(name)
    return 3 if all(letter in letters for letter in word) else None


def _plain(text: str) -> str:
    return unicodedata.normalize("NFKC", text).casefold()
