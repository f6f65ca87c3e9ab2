"""ShortcutsForm: every key and what it does; keys of commands are changed by pressing new ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QDialogButtonBox,
    QFileDialog,
    QHBoxLayout,
    QHeaderView,
    QKeySequenceEdit,
    QLabel,
    QLineEdit,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from widgets.dialogs.program_dialog import ProgramDialog
from widgets.parts.plain_buttons import remove_icons

_NAME, _MENU, _KEYS = range(3)
_ROW = Qt.ItemDataRole.UserRole
_FILE = "zuka-keys.csv"
_PORTABLE = QKeySequence.SequenceFormat.PortableText


@dataclass(frozen=True)
class ShortcutRow:
    """One line of the list.

    Attributes
    ----------
    id : str
        Of the action; empty for what is fixed.
    other_name : str
        The name in the other language, by which it is found as well.
    keys : str
        All keys, as they are shown.
    key : str
        The first key in the spelling for all systems; empty for none.
    is_changed : bool
        The user chose it.
    """

    id: str
    name: str
    other_name: str
    menu: str
    keys: str
    key: str = ""
    is_changed: bool = False


@dataclass(frozen=True)
class KeyProblem:
    """What speaks against a key.

    Attributes
    ----------
    sentence : str
    may_be_taken : bool
        Whether the user may have it so nevertheless.
    """

    sentence: str
    may_be_taken: bool


KeyCheck = Callable[[str, str], KeyProblem | None]
"""From an action's id and a key to what speaks against it."""


class ShortcutsForm(ProgramDialog):
    """A form beside the window; what is changed in it holds at once.

    Signals
    -------
    key_chosen(id: str, key: str)
        An action is to have this key, or none.
    default_requested(id: str), defaults_requested()
        One action, or all, are to have their own keys again.
    save_requested(path: Path)
        The list is to be written to a file.
    """

    key_chosen = Signal(str, str)
    default_requested = Signal(str)
    defaults_requested = Signal()
    save_requested = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Keyboard shortcuts"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._trouble: KeyCheck | None = None
        self._search = QLineEdit(self)
        self._search.setPlaceholderText(self.tr("Search by name, menu or key"))
        self._search.setClearButtonEnabled(True)
        self._list = QTreeWidget(self)
        self._list.setHeaderLabels([self.tr("Name"), self.tr("Menu"), self.tr("Key")])
        self._list.setRootIsDecorated(False)
        self._list.setUniformRowHeights(True)
        self._list.setAlternatingRowColors(True)
        header = self._list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(_NAME, QHeaderView.ResizeMode.Stretch)
        for column in (_MENU, _KEYS):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        self._words = QLabel(self)
        self._words.setWordWrap(True)
        self._key = QKeySequenceEdit(self)
        self._key.setMaximumSequenceLength(1)
        self._take = QPushButton(self.tr("Use it here"), self)
        self._none = QPushButton(self.tr("No key"), self)
        self._default = QPushButton(self.tr("Reset this one"), self)
        self._defaults = QPushButton(self.tr("Reset all"), self)
        self._save = QPushButton(self.tr("Save the list…"), self)
        self._lay_out()
        self._connect()
        self._show_chosen()
        self._search.setFocus()

    def ask_trouble_from(self, trouble: KeyCheck) -> None:
        """Ask this what speaks against a key."""
        self._trouble = trouble

    def show_rows(self, rows: Iterable[ShortcutRow]) -> None:
        """List these; the line that was chosen stays so."""
        chosen = self._row()
        with QSignalBlocker(self._list):
            self._list.clear()
            for row in rows:
                item = QTreeWidgetItem(self._list, [row.name, row.menu, row.keys])
                item.setData(_NAME, _ROW, row)
                item.setToolTip(_NAME, row.other_name)
                font = item.font(_KEYS)
                font.setBold(row.is_changed)
                item.setFont(_KEYS, font)
                if not row.id:
                    for column in range(3):
                        item.setForeground(column, self.palette().placeholderText())
                if chosen is not None and row.id and row.id == chosen.id:
                    self._list.setCurrentItem(item)
        self._filter(self._search.text())
        self._show_chosen()

    def choose(self, id_: str) -> None:
        """Choose an action, as if it had been clicked."""
        for item in self._items():
            row: ShortcutRow = item.data(_NAME, _ROW)
            if row.id == id_:
                self._list.setCurrentItem(item)

    def _lay_out(self) -> None:
        new = QHBoxLayout()
        new.addWidget(QLabel(self.tr("New key"), self))
        new.addWidget(self._key)
        new.addWidget(self._take)
        new.addStretch(1)
        new.addWidget(self._none)
        new.addWidget(self._default)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        buttons.addButton(self._defaults, QDialogButtonBox.ButtonRole.ResetRole)
        buttons.addButton(self._save, QDialogButtonBox.ButtonRole.ActionRole)
        remove_icons(buttons)
        buttons.rejected.connect(self.close)
        for button in buttons.buttons():
            if isinstance(button, QPushButton):
                button.setAutoDefault(False)  # Enter belongs to the field of the key
        for button in (self._take, self._none, self._default):
            button.setAutoDefault(False)
        layout = QVBoxLayout(self)
        layout.setSpacing(8)
        layout.addWidget(self._search)
        layout.addWidget(self._list, 1)
        layout.addLayout(new)
        layout.addWidget(self._words)
        layout.addWidget(buttons)
        # Two lines are kept free, so that nothing moves when a key has trouble.
        self._words.setMinimumHeight(2 * self.fontMetrics().lineSpacing())
        self._words.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.resize(680, 560)

    def _connect(self) -> None:
        self._search.textChanged.connect(self._filter)
        self._list.currentItemChanged.connect(self._show_chosen)
        self._list.itemActivated.connect(self._key.setFocus)
        self._key.keySequenceChanged.connect(self._on_key_sequence_changed)
        self._key.editingFinished.connect(self._on_key_editing_finished)
        self._none.clicked.connect(self._on_none_clicked)
        self._take.clicked.connect(self._on_take_clicked)
        self._default.clicked.connect(self._on_default_clicked)
        self._defaults.clicked.connect(self._on_defaults_clicked)
        self._save.clicked.connect(self._on_save_clicked)

    def _items(self) -> list[QTreeWidgetItem]:
        items = (self._list.topLevelItem(at) for at in range(self._list.topLevelItemCount()))
        return [item for item in items if item is not None]

    def _row(self) -> ShortcutRow | None:
        item = self._list.currentItem()
        return None if item is None else item.data(_NAME, _ROW)

    def _filter(self, words: str) -> None:
        wanted = words.lower().split()
        for item in self._items():
            row: ShortcutRow = item.data(_NAME, _ROW)
            text = f"{row.name} {row.other_name} {row.menu} {row.keys}".lower()
            item.setHidden(not all(word in text for word in wanted))

    def _show_chosen(self) -> None:
        row = self._row()
        is_action = row is not None and bool(row.id)
        self._key.setEnabled(is_action)
        self._none.setEnabled(row is not None and bool(row.key))
        self._default.setEnabled(row is not None and row.is_changed)
        self._take.hide()
        with QSignalBlocker(self._key):
            self._key.setKeySequence(QKeySequence("" if row is None else row.key))
        if row is None:
            self._words.setText(self.tr("Choose a command, then press its new key."))
        elif not is_action:
            self._words.setText(self.tr("This is the same in every view and can't be changed."))
        else:
            self._words.setText(self.tr("Press the new key for: {name}").format(name=row.name))

    def _on_key_sequence_changed(self) -> None:
        row, key = self._row(), self._pressed_keys()
        # The field is empty for a moment before each key, and while Ctrl or Shift is held.
        if row is None or not row.id or not key:
            return
        trouble = None if self._trouble is None else self._trouble(row.id, key)
        if trouble is not None:
            self._words.setText(trouble.sentence)
            self._take.setVisible(trouble.may_be_taken)
        elif key != row.key:
            self.key_chosen.emit(row.id, key)

    def _on_key_editing_finished(self) -> None:
        if not self._pressed_keys():
            self._show_chosen()

    def _on_none_clicked(self) -> None:
        row = self._row()
        if row is not None and row.id:
            self.key_chosen.emit(row.id, "")

    def _on_take_clicked(self) -> None:
        row = self._row()
        if row is not None and row.id:
            self.key_chosen.emit(row.id, self._pressed_keys())

    def _on_default_clicked(self) -> None:
        row = self._row()
        if row is not None and row.id:
            self.default_requested.emit(row.id)

    def _on_defaults_clicked(self) -> None:
        self.defaults_requested.emit()

    def _on_save_clicked(self) -> None:
        name, _ = QFileDialog.getSaveFileName(
            self, self.tr("Save the list"), _FILE, self.tr("Tables (*.csv)")
        )
        if name:
            self.save_requested.emit(Path(name))

    def _pressed_keys(self) -> str:
        return self._key.keySequence().toString(_PORTABLE)
