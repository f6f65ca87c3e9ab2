"""The user's own keys: given to a window's actions, shown and changed in a form."""

from __future__ import annotations

import csv
from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtGui import QKeySequence

from app.keys.shortcuts import FIXED, Shortcuts
from app.window.window_actions import ActionEntry
from app.window.window_parts import WindowParts
from processing.core.errors import UserError, report_as_user_error
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from widgets.dialogs.shortcuts import KeyProblem, ShortcutRow, ShortcutsForm

_NATIVE = QKeySequence.SequenceFormat.NativeText

_VIEWS = Text("Views (fixed)", "ビュー（固定）")
_PALETTE_ONLY = Text("By name only", "名前でのみ実行")
_TAKEN = Text(
    "{key} already does: {name}; it would lose its key.",
    "{key} は「{name}」に割り当て済みです。割り当てると元のキーはなくなります。",
)
_FIXED = Text(
    "{key} belongs to the views ({name}) and can't be given away.",
    "{key} はビューの操作（{name}）に固定されており、割り当てられません。",
)
_HEADER = (
    Text("Name", "名前"),
    Text("Menu", "メニュー"),
    Text("Key", "キー"),
)


def give_keys(parts: WindowParts) -> None:
    """Let the window's actions be reached by the keys that the user chose."""
    parts.window.give_keys(shortcuts_of(parts).all_keys())


def shortcuts_of(parts: WindowParts) -> Shortcuts:
    """The keys of the window's actions as they are now."""
    entries = parts.window.actions_made.entries
    defaults = {entry.action.id: entry.action.keys for entry in entries}
    return Shortcuts(defaults, parts.settings.shortcuts)


def edit_shortcuts(parts: WindowParts) -> None:
    """Show the form in which keys are changed; it stays beside the window."""
    open_already = parts.window.findChild(ShortcutsForm)
    if isinstance(open_already, ShortcutsForm):
        open_already.raise_()
        open_already.activateWindow()
        return
    ShortcutEditing(parts).form.show()


class ShortcutEditing(QObject):
    """Does what the form asks for: at once, and for the next start as well.

    Parameters
    ----------
    parts : WindowParts
    """

    def __init__(self, parts: WindowParts) -> None:
        # A child of the window's contents goes when the language changes.
        form = ShortcutsForm(parts.window.centralWidget())
        super().__init__(form)
        self.form = form
        self._parts = parts
        self._language: Language = parts.language
        self._shortcuts = shortcuts_of(parts)
        self._names = {
            entry.action.id: entry.action.name for entry in parts.window.actions_made.entries
        }
        self.form.ask_trouble_from(self._trouble_with)
        self.form.key_chosen.connect(self._on_form_key_chosen)
        self.form.default_requested.connect(self._on_form_default_requested)
        self.form.defaults_requested.connect(self._on_form_defaults_requested)
        self.form.save_requested.connect(self._on_form_save_requested)
        self.form.show_rows(self._rows())

    def _rows(self) -> tuple[ShortcutRow, ...]:
        made = self._parts.window.actions_made
        actions = tuple(self._row(entry) for entry in made.entries)
        fixed = tuple(
            ShortcutRow(
                id="",
                name=fixed.name.in_language(self._language),
                other_name=_other(fixed.name, self._language),
                menu=_VIEWS.in_language(self._language),
                keys=fixed.gesture.in_language(self._language),
            )
            for fixed in FIXED
        )
        return actions + fixed

    def _row(self, entry: ActionEntry) -> ShortcutRow:
        action = entry.action
        keys = self._shortcuts.keys_of(action.id)
        menu = action.menu_name if action.menu else _PALETTE_ONLY
        return ShortcutRow(
            id=action.id,
            name=action.name.in_language(self._language),
            other_name=_other(action.name, self._language),
            menu=menu.in_language(self._language),
            keys=", ".join(QKeySequence(key).toString(_NATIVE) for key in keys),
            key=keys[0] if keys else "",
            is_changed=self._shortcuts.is_changed(action.id),
        )

    def _trouble_with(self, action: str, key: str) -> KeyProblem | None:
        conflict = self._shortcuts.conflict(action, key)
        if conflict is None:
            return None
        shown = QKeySequence(key).toString(_NATIVE)
        if conflict.fixed is not None:
            text = _FIXED.filled(key=shown, name=conflict.fixed.name)
        else:
            text = _TAKEN.filled(key=shown, name=self._names[conflict.owner])
        return KeyProblem(text.in_language(self._language), may_be_taken=conflict.fixed is None)

    def _use(self, shortcuts: Shortcuts) -> None:
        self._shortcuts = shortcuts
        self._parts.settings.keep_shortcuts(shortcuts.chosen)
        self._parts.window.give_keys(shortcuts.all_keys())
        self.form.show_rows(self._rows())

    def _on_form_key_chosen(self, action: str, key: str) -> None:
        self._use(self._shortcuts.with_key(action, key))

    def _on_form_default_requested(self, action: str) -> None:
        self._use(self._shortcuts.with_default(action))

    def _on_form_defaults_requested(self) -> None:
        self._use(self._shortcuts.with_defaults())

    def _on_form_save_requested(self, path: Path) -> None:
        try:
            write_list(path, self._rows(), self._language)
        except UserError as error:
            self._parts.message_bar.show_error(error)


def write_list(path: Path, rows: tuple[ShortcutRow, ...], language: Language) -> None:
    """Write what is listed to a CSV file, UTF-8 with a mark so that spreadsheets read Japanese.

    Raises
    ------
    UserError
        The file can't be written; what was there before stays.
    """
    header = [text.in_language(language) for text in _HEADER]
    with (
        report_as_user_error(path),
        write_safely(path) as temporary,
        temporary.open("w", encoding="utf-8-sig", newline="") as file,
    ):
        lines = csv.writer(file)
        lines.writerow(header)
        lines.writerows((row.name, row.menu, row.keys) for row in rows)


def _other(text: Text, language: Language) -> str:
    return text.en if language == "ja" else text.ja
