"""CommandPalette: every action by name, in both languages, with its key."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QAction, QKeyEvent
from PySide6.QtWidgets import QDialog, QLineEdit, QListWidget, QListWidgetItem, QVBoxLayout, QWidget
from typing_extensions import override

from processing.text import Language, Text


@dataclass(frozen=True)
class NamedAction:
    """An action and its name in both languages."""

    name: Text
    action: QAction


class CommandPalette(QDialog):
    """A list that is narrowed by typing; Enter does the chosen action, Escape leaves."""

    def __init__(
        self, actions: Sequence[NamedAction], language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Commands"))
        self._actions = tuple(actions)
        self._language = language
        self._words = QLineEdit(self)
        self._words.setPlaceholderText(self.tr("Type part of a name"))
        self._list = QListWidget(self)
        layout = QVBoxLayout(self)
        layout.addWidget(self._words)
        layout.addWidget(self._list)
        self.resize(520, 400)
        self._words.textChanged.connect(self._on_words_text_changed)
        self._words.returnPressed.connect(self._on_words_return_pressed)
        self._list.itemActivated.connect(self._on_words_return_pressed)
        self._words.installEventFilter(self)
        self._on_words_text_changed("")

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()))
            if step is not None and self._list.count():
                self._list.setCurrentRow((self._list.currentRow() + step) % self._list.count())
                return True
        return super().eventFilter(watched, event)

    def _on_words_text_changed(self, words: str) -> None:
        self._list.clear()
        wanted = words.lower().split()
        for named in self._actions:
            names = f"{named.name.en} {named.name.ja}".lower()
            if all(word in names for word in wanted):
                self._list.addItem(self._item(named))
        self._list.setCurrentRow(0)

    def _item(self, named: NamedAction) -> QListWidgetItem:
        other = named.name.en if self._language == "ja" else named.name.ja
        keys = named.action.shortcut().toString()
        text = f"{named.name.spoken(self._language)}   {other}   {keys}"
        item = QListWidgetItem(named.action.icon(), text)
        item.setData(Qt.ItemDataRole.UserRole, named)
        if not named.action.isEnabled():
            item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEnabled)
        return item

    def _on_words_return_pressed(self) -> None:
        item = self._list.currentItem()
        if item is None:
            return
        named: NamedAction = item.data(Qt.ItemDataRole.UserRole)
        if named.action.isEnabled():
            self.accept()
            named.action.trigger()
