"""Help actions: the manual, every command by name, the language, the log."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices

from app.actions.action import Action
from app.error_log import log_path
from app.window_parts import WindowParts
from processing.text import Language, Text
from resources import path_of
from widgets.parts.command_palette import CommandPalette, NamedAction


class HelpActions:
    """What the help menu does."""

    def __init__(self, parts: WindowParts) -> None:
        self._parts = parts
        self._named: tuple[Action, ...] = ()

    def actions(self) -> tuple[Action, ...]:
        """The help menu, from top to bottom."""
        return (
            Action("manual", Text("Manual", "マニュアル"), self.show_manual, "help", ("F1",)),
            Action(
                "palette",
                Text("All commands…", "すべてのコマンド…"),
                self.show_palette,
                "help",
                ("Ctrl+Shift+P",),
            ),
            Action(
                "japanese",
                Text("日本語 (from the next start)", "日本語（次回の起動から）"),
                self._speaking("ja"),
                "help",
            ),
            Action(
                "english",
                Text("English (from the next start)", "English（次回の起動から）"),
                self._speaking("en"),
                "help",
            ),
            Action("log", Text("Show the log", "ログを表示"), self.show_log, "help"),
        )

    def list_in_palette(self, actions: tuple[Action, ...]) -> None:
        """Tell which actions the palette offers."""
        self._named = actions

    def show_palette(self) -> None:
        """Show every action by name."""
        made = self._parts.window.actions_by_id
        named = [NamedAction(action.text, made[action.id]) for action in self._named]
        CommandPalette(named, self._parts.language, self._parts.window).show()

    def show_manual(self) -> None:
        """Open the manual's first page in the user's language."""
        page = path_of(f"manual/{self._parts.language}") / "index.html"
        QDesktopServices.openUrl(QUrl.fromLocalFile(str(page)))

    def show_log(self) -> None:
        """Open the folder of the log."""
        QDesktopServices.openUrl(QUrl.fromLocalFile(str(log_path().parent)))

    def _speaking(self, language: Language) -> Callable[[], None]:
        def speak() -> None:
            self._parts.settings.choose_language(language)

        return speak
