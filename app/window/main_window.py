"""MainWindow: docks, menus and layout; it decides nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QByteArray, QEvent, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QDockWidget,
    QMainWindow,
    QMenuBar,
    QStackedWidget,
    QToolBar,
    QToolButton,
    QWidget,
)
from typing_extensions import override

from app.layout.panel_room import hide_stray_tabs, make_room
from app.layout.view_area import ViewArea
from app.layout.view_docks import ViewLayout
from app.settings.settings import WindowLayout
from app.window.action import Action
from app.window.screen_room import bring_onto_screen
from app.window.window_actions import WindowActions
from app.window.window_contents import DockPanel, PlainToolBar, WindowContents, stack_widgets
from processing.core.text import Language, Text

_ICON_PX = 20
_BESIDE = "side-by-side"
_NARROW_PX = 1500
"""Narrower windows have panels at one side only, so that the street keeps its room."""
_WIDE_PX = 1800
"""Wider ones have two panels above each other at the right; between, one that is tall."""
_COLUMN_PX = 280
_MIDDLING_PX = (240, 290)
"""Of the columns at the left and the right, which leave two thirds to the street."""
_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_BELOW = Qt.DockWidgetArea.BottomDockWidgetArea
_HOLDS_NOTHING = "the window holds nothing yet"


class MainWindow(QMainWindow):
    """The window; what it holds is handed over, and may be replaced while it is shown.

    Signals
    -------
    files_dropped(paths: tuple[Path, ...])
    closed()
    """

    files_dropped = Signal(object)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._actions: WindowActions | None = None
        self._docks: dict[str, QDockWidget] = {}
        self._in_front: list[QDockWidget] = []
        self._waiting: list[QDockWidget] = []
        self._panels: tuple[DockPanel, ...] = ()
        self._had_room: set[str] = set()
        self._toolbar: QToolBar | None = None
        self._tools: QAction | None = None
        self._area: ViewArea | None = None
        self._pages = QStackedWidget()
        self._is_open = False
        self._may_close: Callable[[], bool] | None = None
        self._docks_when_open: QByteArray | None = None
        # Docks take their sizes, and come to the front, only once they are laid out.
        self._when_laid_out = QTimer(self, singleShot=True)
        self._when_laid_out.timeout.connect(self._on_laid_out)
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self.resize(1600, 1000)
        bring_onto_screen(self)
        self.show_title("")

    @property
    def actions_by_id(self) -> dict[str, QAction]:
        """All actions by their id; a copy."""
        return {entry.action.id: entry.made for entry in self.actions_made.entries}

    @property
    def actions_made(self) -> WindowActions:
        """The actions of what the window holds now.

        Raises
        ------
        ValueError
            Before it holds anything.
        """
        if self._actions is None:
            raise ValueError(_HOLDS_NOTHING)
        return self._actions

    @property
    def area(self) -> ViewArea:
        """The views in its middle.

        Raises
        ------
        ValueError
            Before it holds anything.
        """
        if self._area is None:
            raise ValueError(_HOLDS_NOTHING)
        return self._area

    def hold(self, contents: WindowContents) -> None:
        """Hold this in place of what there was, which is deleted, and stand as before.

        Actions, panels and :meth:`show_work` follow.

        What belongs to the contents and is no widget of theirs may have ``centralWidget()`` for
        a parent, so that it goes with them.
        """
        views = None
        if self._area is not None:
            views = self._area.keep()
            self._area.take_in()
        self._let_go()
        self._area = contents.views
        self._pages = QStackedWidget()
        self._pages.addWidget(contents.start_page)
        self._pages.addWidget(stack_widgets(contents.header, contents.views))
        # The old widget is deleted by Qt in each of these.
        self.setCentralWidget(stack_widgets(contents.message, self._pages))
        self.setMenuBar(QMenuBar(self))
        self.setStatusBar(contents.status)
        self._toolbar = PlainToolBar(self.tr("Tools"), self)
        self._toolbar.setObjectName("toolbar")
        self._toolbar.setIconSize(QSize(_ICON_PX, _ICON_PX))
        self.addToolBar(self._toolbar)
        if views is not None:
            contents.views.restore(views)
        self._actions = WindowActions(self, self._toolbar, contents.language)

    def add_actions(self, actions: Sequence[Action]) -> None:
        """Put actions into menus and toolbar, in their order."""
        self.actions_made.add(actions)
        self.actions_made.know_project(is_open=self._is_open)

    def end_toolbar(self, tools: QWidget) -> None:
        """Put a widget behind the toolbar's buttons, for the time that a project is open."""
        if self._toolbar is not None:
            self._tools = self._toolbar.addWidget(tools)

    def show_in_corner(self, id_: str) -> None:
        """Show an action at the end of the menu bar as well."""
        button = QToolButton(self)
        button.setAutoRaise(True)
        button.setDefaultAction(self.actions_made[id_])
        self.menuBar().setCornerWidget(button)

    def add_panels(self, panels: Sequence[DockPanel], language: Language) -> None:
        """Put panels into docks; docks of one area stand above each other."""
        self._panels = tuple(panels)
        for panel in panels:
            dock = QDockWidget(panel.title.in_language(language), self)
            dock.setObjectName(panel.id)
            dock.setWidget(panel.widget)
            self.addDockWidget(panel.place.area, dock)
            if panel.place.is_hidden:
                self._waiting.append(dock)
            self._docks[panel.id] = dock
            if panel.place.worked_in_px:
                dock.visibilityChanged.connect(partial(self._give_room, panel))
            self._adopt_toggle(panel, dock)

    def show_panel(self, id_: str) -> None:
        """Bring a panel to the front."""
        dock = self._docks[id_]
        dock.show()
        dock.raise_()

    def bring_panels(self, layout: ViewLayout) -> None:
        """Bring the panels that belong to a layout to the front."""
        for panel in self._panels:
            for known, high_px in panel.place.front_px:
                if known is layout:
                    self.show_panel(panel.id)
                    make_room(self, panel.id, high_px)

    def give_keys(self, keys: Mapping[str, tuple[str, ...]]) -> None:
        """Let actions be reached by these keys from now on."""
        self.actions_made.give_keys(keys)

    def show_work(self, *, is_open: bool) -> None:
        """Show the views, or the start page; docks and most actions belong to the views."""
        self._remember_docks()
        was_open, self._is_open = self._is_open, is_open
        self.actions_made.know_project(is_open=is_open)
        if self._tools is not None:
            self._tools.setVisible(is_open)
        self._pages.setCurrentIndex(1 if is_open else 0)
        self.area.show_apart(is_shown=is_open)
        if is_open and was_open:
            return
        for dock in self._docks.values():
            dock.setVisible(is_open and dock not in self._waiting)
        if is_open:
            self._place_docks()
            self._restore_docks()

    def show_title(self, name: str) -> None:
        """Name the window after the project."""
        self.setWindowTitle(f"{name} – Zuka" if name else self.tr("Zuka"))

    def layout_to_keep(self) -> WindowLayout:
        """How the window stands, to be given to :meth:`restore_layout`."""
        self._remember_docks()
        docks = self.saveState() if self._docks_when_open is None else self._docks_when_open
        return WindowLayout(self.saveGeometry(), docks, self.area.keep())

    def restore_layout(self, layout: WindowLayout) -> None:
        """Stand as it was left; called while no project is open."""
        self.restoreGeometry(layout.geometry)
        if not self.isMaximized() and not self.isFullScreen():
            bring_onto_screen(self)
        self._docks_when_open = layout.docks
        self.area.restore(layout.views)
        self.area.show_apart(is_shown=False)
        if _BESIDE in self.actions_made:
            self.actions_made[_BESIDE].setChecked(self.area.is_beside)

    def ask_before_closing(self, may_close: Callable[[], bool]) -> None:
        """Close only where this says so."""
        self._may_close = may_close

    def close_at_once(self) -> None:
        """Close without asking, as the system wants it or the user has answered."""
        self._may_close = None
        self.close()

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self._actions is not None:
            self._actions.recolour()

    @override
    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    @override
    def dropEvent(self, event: QDropEvent) -> None:
        paths = tuple(Path(url.toLocalFile()) for url in event.mimeData().urls())
        event.acceptProposedAction()
        self.files_dropped.emit(paths)

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        if self._may_close is not None and not self._may_close():
            event.ignore()
            return
        self.closed.emit()
        super().closeEvent(event)

    def _let_go(self) -> None:
        """Delete what is not deleted by being replaced."""
        self._remember_docks()
        self._is_open = False
        self._in_front.clear()
        self._waiting.clear()
        # Children are found by their names when a layout is restored, so the old ones leave now.
        old = (*self._docks.values(), self._toolbar, self.menuBar().cornerWidget())
        for widget in old:
            if widget is not None:
                widget.setParent(None)
                widget.deleteLater()
        self._docks.clear()
        if self._actions is not None:
            self._actions.deleteLater()

    def _give_room(self, panel: DockPanel, is_visible: object) -> None:
        """Let a panel that comes to the front for the first time be as high as its work needs."""
        is_first = panel.id not in self._had_room
        if not (is_visible and is_first and self._is_open) or self.width() >= _NARROW_PX:
            return
        self._had_room.add(panel.id)
        if self._docks[panel.id].height() < panel.place.worked_in_px:
            make_room(self, panel.id, panel.place.worked_in_px)

    def _adopt_toggle(self, panel: DockPanel, dock: QDockWidget) -> None:
        toggle = dock.toggleViewAction()
        toggle.triggered.connect(dock.raise_)
        action = Action(
            f"panel-{panel.id}",
            Text("Panel: {title}", "パネル: {title}").filled(title=panel.title),
            toggle.trigger,
            "view/panels",
            (panel.place.key,) if panel.place.key else (),
            needs_project=True,
        )
        self.actions_made.adopt(action, toggle)

    def _place_docks(self) -> None:
        """Put the docks where they belong at first, in a window as wide as this."""
        self._in_front.clear()
        placed: list[DockPanel] = []
        for panel in self._panels:
            dock, (area, behind) = self._docks[panel.id], self._standing_of(panel)
            self.addDockWidget(area, dock)
            if behind:
                self.tabifyDockWidget(self._docks[behind], dock)
                self._in_front.append(self._docks[behind])
            else:
                placed.append(panel)
        own = [self._docks[panel.id] for panel in placed]
        self.resizeDocks(
            own, [self._width_of(panel) for panel in placed], Qt.Orientation.Horizontal
        )
        self.resizeDocks(own, [panel.place.height for panel in placed], Qt.Orientation.Vertical)

    def _standing_of(self, panel: DockPanel) -> tuple[Qt.DockWidgetArea, str]:
        """At which side a panel is in a window as wide as this, and behind which other."""
        place = panel.place
        if self.width() >= _WIDE_PX or place.area is _BELOW:
            return place.area, place.behind
        if self.width() < _NARROW_PX:
            return _LEFT, place.narrow_behind
        if place.middling_behind is not None:
            return place.area, place.middling_behind
        return _LEFT, place.narrow_behind

    def _width_of(self, panel: DockPanel) -> int:
        if self.width() >= _WIDE_PX:
            return panel.place.width
        is_narrow = self.width() < _NARROW_PX
        return _COLUMN_PX if is_narrow else _MIDDLING_PX[panel.place.middling_behind is not None]

    def _remember_docks(self) -> None:
        """Keep how the docks stand, for the next time that a project is open."""
        if self._is_open:
            self._docks_when_open = self.saveState()

    def _restore_docks(self) -> None:
        """Put the docks where they were left; a window without any would look broken."""
        if self._docks_when_open is not None:
            self.restoreState(self._docks_when_open)
            if all(dock.isHidden() for dock in self._docks.values()):
                self._docks_when_open = None
                for dock in self._docks.values():
                    dock.setVisible(dock not in self._waiting)
        self._when_laid_out.start()

    def _on_laid_out(self) -> None:
        if self._is_open and self._docks_when_open is not None:
            self.restoreState(self._docks_when_open)
        elif self._is_open:
            for dock in self._in_front:
                dock.raise_()
        self._had_room.clear()
        hide_stray_tabs(self)
