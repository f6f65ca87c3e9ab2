"""Help actions: the manual, every command by name, the keys, the log."""

from __future__ import annotations

from PySide6.QtCore import QUrl

from app.help.manual import open_outside, show_manual
from app.jobs.error_log import log_path
from app.keys.shortcut_editing import edit_shortcuts
from app.window.action import Action, grouped
from app.window.window_parts import WindowParts
from processing.core.text import Text
from widgets.parts.command_palette import CommandPalette, NamedAction


class HelpActions:
    """What the help menu does."""

    def __init__(self, parts: WindowParts) -> None:
        self._parts = parts

    def actions(self) -> tuple[Action, ...]:
        """The help menu, from top to bottom."""
        manual, *keys, log = self._entries()
        return grouped((manual,), keys, (log,))

    def _entries(self) -> tuple[Action, ...]:
        return (
            Action(
                "manual",
                Text("Manual", "マニュアル"),
                self.show_manual,
                "help",
                ("F1",),
                hint=Text(
                    "Opens the manual in a window of its own, with a search.",
                    "マニュアルを別ウィンドウで開きます。検索もできます。",
                ),
            ),
            Action(
                "palette",
                Text("All commands…", "すべてのコマンド…"),
                self.show_palette,
                "help",
                ("Ctrl+Shift+P",),
                hint=Text(
                    "Finds any command by a part of its name, in either language.",
                    "名前の一部（日本語・英語）からコマンドを探して実行します。",
                ),
            ),
            Action(
                "shortcuts",
                Text("Keyboard shortcuts…", "キーボードショートカット…"),
                self.show_shortcuts,
                "help",
                ("Ctrl+F1",),
                hint=Text(
                    "Lists all keys and changes those of commands.",
                    "すべてのキーを一覧し、コマンドのキーを変更します。",
                ),
            ),
            Action(
                "log",
                Text("Show the log", "ログを表示"),
                self.show_log,
                "help",
                hint=Text(
                    "Opens the folder of the log, to be sent with a report of a defect.",
                    "不具合の報告に添えるログのフォルダを開きます。",
                ),
            ),
        )

    def show_palette(self) -> None:
        """Show every action by name, those used last first."""
        parts = self._parts
        made = parts.window.actions_made
        named = [
            NamedAction(entry.action.id, entry.action.name, entry.made, made.why_disabled(entry))
            for entry in made.entries
            if entry.action.id != "palette"
        ]
        # A child of the window's contents goes when the language changes.
        palette = CommandPalette(
            named, parts.language, parts.window.centralWidget(), used=parts.settings.last_used
        )
        palette.chosen.connect(parts.settings.remember_use)
        palette.show()

    def show_shortcuts(self) -> None:
        """Show all keys, to be changed."""
        edit_shortcuts(self._parts)

    def show_manual(self) -> None:
        """Open the manual in the user's language."""
        show_manual(self._parts)

    def show_log(self) -> None:
        """Open the folder of the log."""
        open_outside(self._parts, QUrl.fromLocalFile(str(log_path().parent)))
