"""RecentMenu: the projects opened last, in the file menu."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from app.window.action import Action
from app.window.window_parts import WindowParts
from processing.core.text import Text
from widgets.parts.literal_text import literal


class RecentMenu:
    """Entries that are made anew whenever the menu opens, above the one that clears the list."""

    def __init__(self, parts: WindowParts) -> None:
        self._parts = parts
        self._shown: list[QAction] = []

    def action(self) -> Action:
        """The last entry, by which the menu comes to be."""
        return Action(
            "forget-recent",
            Text("Clear the list", "一覧を消去"),
            self._forget,
            "file/recent",
            hint=Text("The projects themselves stay.", "プロジェクト自体は残ります。"),
        )

    def connect(self) -> None:
        """Fill the menu when it opens; again for a window's new menus."""
        menu = self._parts.window.actions_made.menu("file/recent")
        self._shown = []
        menu.aboutToShow.connect(partial(self._fill, menu))

    def _fill(self, menu: QMenu) -> None:
        for old in self._shown:
            menu.removeAction(old)
            old.deleteLater()
        below = self._parts.window.actions_by_id["forget-recent"]
        recent = self._parts.settings.recent_projects
        below.setEnabled(bool(recent))
        self._shown = []
        for project in recent:
            entry = QAction(literal(project.folder.stem), menu)
            entry.setToolTip(str(project.folder))
            entry.setEnabled(not project.is_missing)
            entry.triggered.connect(partial(self._open, project.folder))
            self._shown.append(entry)
        if recent:
            line = QAction(menu)
            line.setSeparator(True)
            self._shown.append(line)
        menu.insertActions(below, self._shown)

    def _open(self, folder: Path, _is_checked: object = None) -> None:
        self._parts.document.open(folder)

    def _forget(self) -> None:
        for project in self._parts.settings.recent_projects:
            self._parts.settings.forget_project(project.folder)
        self._parts.start_page.show_recent(())
