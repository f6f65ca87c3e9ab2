"""WindowActions: the menus, the toolbar and the keys of a window, made from actions as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import qtawesome
from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QActionGroup, QIcon, QKeySequence, QPalette
from PySide6.QtWidgets import QMainWindow, QMenu, QToolBar

from app.window.action import MENUS, NEEDS_PROJECT, NOTHING, SUBMENUS, Action
from processing.core.text import Language, Text
from widgets.parts.literal_text import literal

_NATIVE = QKeySequence.SequenceFormat.NativeText


@dataclass(frozen=True)
class ActionEntry:
    """An action and the ``QAction`` that was made of it."""

    action: Action
    made: QAction


class WindowActions(QObject):
    """All actions of a window in one language; they go when it goes.

    Parameters
    ----------
    window : QMainWindow
        Whose menu bar gets the menus, and where the keys work.
    toolbar : QToolBar
    language : Language
    """

    def __init__(self, window: QMainWindow, toolbar: QToolBar, language: Language) -> None:
        super().__init__(window)
        self._window = window
        self._toolbar = toolbar
        self._language = language
        self._entries: dict[str, ActionEntry] = {}
        self._groups: dict[str, QActionGroup] = {}
        self._toolbar_group = 0
        self._has_project = False
        self._forbidden: dict[str, Text] = {}  # and why
        self._menus: dict[str, QMenu] = {
            id_: window.menuBar().addMenu(title.in_language(language)) for id_, title in MENUS
        }
        for menu in self._menus.values():
            menu.setToolTipsVisible(True)  # which say why an entry is grey

    @property
    def entries(self) -> tuple[ActionEntry, ...]:
        """All actions, in the order in which they were added."""
        return tuple(self._entries.values())

    def __getitem__(self, id_: str) -> QAction:
        return self._entries[id_].made

    def __contains__(self, id_: str) -> bool:
        return id_ in self._entries

    def why_disabled(self, entry: ActionEntry) -> Text:
        """Why an action can't be done now; empty when it can, or when that isn't known."""
        if entry.made.isEnabled():
            return NOTHING
        if entry.action.needs_project and not self._has_project:
            return NEEDS_PROJECT
        why = self._forbidden.get(entry.action.id, NOTHING)
        return why if why.en else entry.action.why_disabled

    def add(self, actions: Sequence[Action]) -> None:
        """Put actions into menus and toolbar, in their order."""
        for action in actions:
            made = QAction(literal(action.text.in_language(self._language)), self)
            made.setObjectName(action.id)
            made.setCheckable(action.is_checkable)
            made.setChecked(action.is_checked)
            if action.group:
                self._group(action.group).addAction(made)
            made.triggered.connect(_without_argument(action.run))
            if action.toolbar:
                if self._toolbar_group and action.toolbar != self._toolbar_group:
                    self._toolbar.addSeparator()
                self._toolbar_group = action.toolbar
                self._toolbar.addAction(made)
            self.adopt(action, made)

    def adopt(self, action: Action, made: QAction) -> None:
        """Take in an action that a widget has made itself."""
        self._entries[action.id] = ActionEntry(action, made)
        if action.menu:
            if action.begins_group:
                self._divide(action.menu)
            self._menu(action.menu).addAction(made)
        self._window.addAction(made)  # its key works though no menu may show it
        self._enable(self._entries[action.id])
        self._give_keys(action.id, action.keys)
        self._colour(self._entries[action.id])

    def menu(self, id_: str) -> QMenu:
        """A menu by its id, for entries that come and go."""
        return self._menu(id_)

    def give_keys(self, keys: Mapping[str, tuple[str, ...]]) -> None:
        """Let these actions be reached by these keys from now on."""
        for id_, sequences in keys.items():
            if id_ in self._entries:
                self._give_keys(id_, sequences)

    def know_project(self, *, is_open: bool) -> None:
        """Enable what needs a project while one is open, disable it while none is."""
        self._has_project = is_open
        for entry in self._entries.values():
            self._enable(entry)
            self._explain(entry)

    def allow(self, id_: str, *, is_allowed: bool) -> None:
        """Say whether there is anything for an action to do, project or not."""
        self.forbid(id_, None if is_allowed else NOTHING)

    def forbid(self, id_: str, why: Text | None) -> None:
        """Say why an action can't be done now, which its tooltip tells too; None: it can."""
        if why is None:
            self._forbidden.pop(id_, None)
        else:
            self._forbidden[id_] = why
        self._enable(self._entries[id_])
        self._explain(self._entries[id_])

    def recolour(self) -> None:
        """Draw the icons in the colours of the window's palette."""
        for entry in self._entries.values():
            self._colour(entry)

    def _group(self, name: str) -> QActionGroup:
        return self._groups.setdefault(name, QActionGroup(self))

    def _menu(self, id_: str) -> QMenu:
        if id_ not in self._menus:
            above = self._menus[id_.partition("/")[0]]
            self._menus[id_] = above.addMenu(SUBMENUS[id_].in_language(self._language))
            self._menus[id_].setToolTipsVisible(True)
        return self._menus[id_]

    def _divide(self, id_: str) -> None:
        """Draw a line below what a menu holds, or below what stands above a new submenu."""
        menu = self._menus.get(id_, self._menus[id_.partition("/")[0]])
        if menu.actions():
            menu.addSeparator()

    def _give_keys(self, id_: str, keys: tuple[str, ...]) -> None:
        self._entries[id_].made.setShortcuts([QKeySequence(key) for key in keys])
        self._explain(self._entries[id_])

    def _explain(self, entry: ActionEntry) -> None:
        """Tell name, key, what it does and why it can't be done, as far as there is any."""
        keys = [key.toString(_NATIVE) for key in entry.made.shortcuts()]
        name = entry.action.name.in_language(self._language)
        why_not = self.why_disabled(entry)
        reported = (
            f"{name} ({keys[0]})" if keys else name,
            entry.action.hint.in_language(self._language),
            why_not.in_language(self._language),
        )
        entry.made.setToolTip("\n".join(line for line in reported if line))

    def _enable(self, entry: ActionEntry) -> None:
        action = entry.action
        is_possible = self._has_project or not action.needs_project
        entry.made.setEnabled(is_possible and action.id not in self._forbidden)

    def _colour(self, entry: ActionEntry) -> None:
        if entry.action.icon:
            entry.made.setIcon(icon_of(entry.action.icon, self._window.palette()))


def icon_of(name: str, palette: QPalette) -> QIcon:
    """An icon of the set in the colours of text."""
    icon: QIcon = qtawesome.icon(
        name,
        color=palette.color(QPalette.ColorGroup.Active, QPalette.ColorRole.WindowText),
        color_disabled=palette.color(QPalette.ColorGroup.Disabled, QPalette.ColorRole.WindowText),
    )
    return icon


def _without_argument(run: Callable[[], object]) -> Callable[[], None]:
    """Qt sends whether the action is checked; what is run doesn't ask for it."""

    def called() -> None:
        run()

    return called
