"""MainWindow: docks, menus and layout; it decides nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import qtawesome
from PySide6.QtCore import QByteArray, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QAction,
    QActionGroup,
    QCloseEvent,
    QDragEnterEvent,
    QDropEvent,
    QIcon,
    QKeySequence,
)
from PySide6.QtWidgets import (
    QDockWidget,
    QMainWindow,
    QMenu,
    QSplitter,
    QStackedWidget,
    QStatusBar,
    QToolBar,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from app.actions.action import MENUS, Action
from processing.text import Language, Text

_ICON_PX = 20


@dataclass(frozen=True)
class Panel:
    """A widget in a dock.

    Attributes
    ----------
    area : Qt.DockWidgetArea
        Where it is at first.
    width, height : int
        Its share there, in pixels of a usual window.
    behind : str
        Id of the panel with which it shares a place, as a tab; empty for a place of its own.
    """

    id: str
    title: Text
    widget: QWidget
    area: Qt.DockWidgetArea
    width: int
    height: int
    behind: str = ""


class MainWindow(QMainWindow):
    """The window; what it holds is handed over.

    Parameters
    ----------
    start_page : QWidget
        Shown while nothing is open.
    views : sequence of QWidget
        From top to bottom.
    header : QWidget
        The line above the views.
    message : QWidget
        The line above everything.
    status : QStatusBar
        The last line.
    """

    files_dropped = Signal(object)  # tuple[Path, ...]
    closed = Signal()

    def __init__(
        self,
        language: Language,
        *,
        start_page: QWidget,
        views: Sequence[QWidget],
        header: QWidget,
        message: QWidget,
        status: QStatusBar,
    ) -> None:
        super().__init__()
        self._language = language
        self._actions: dict[str, QAction] = {}
        self._in_front: list[QDockWidget] = []
        # Only docks that are laid out can come to the front.
        self._when_laid_out = QTimer(self)
        self._when_laid_out.setSingleShot(True)
        self._when_laid_out.timeout.connect(self._bring_forward)
        self._menus: dict[str, QMenu] = {}
        self._toolbar = QToolBar(self.tr("Tools"), self)
        self._toolbar.setObjectName("toolbar")
        self._toolbar.setIconSize(QSize(_ICON_PX, _ICON_PX))
        self.addToolBar(self._toolbar)
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self._splitter = QSplitter(Qt.Orientation.Vertical, self)
        for view in views:
            self._splitter.addWidget(view)
        work = QWidget(self)
        column = QVBoxLayout(work)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(header)
        column.addWidget(self._splitter, 1)
        self._pages = QStackedWidget(self)
        self._pages.addWidget(start_page)
        self._pages.addWidget(work)
        centre = QWidget(self)
        whole = QVBoxLayout(centre)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        whole.addWidget(message)
        whole.addWidget(self._pages, 1)
        self.setCentralWidget(centre)
        self.setStatusBar(status)
        self.resize(1600, 1000)
        self.show_title("")

    @property
    def actions_by_id(self) -> dict[str, QAction]:
        """All actions by their id; a copy."""
        return dict(self._actions)

    def add_actions(self, actions: Sequence[Action]) -> None:
        """Put actions into menus and toolbar, in their order."""
        for id_, title in MENUS:
            self._menus[id_] = self.menuBar().addMenu(title.spoken(self._language))
        groups: dict[str, QActionGroup] = {}
        toolbar_group = 0
        for action in actions:
            made = self._made(action)
            if action.group:
                group = groups.setdefault(action.group, QActionGroup(self))
                group.addAction(made)
            if action.menu:
                self._menus[action.menu].addAction(made)
            if action.toolbar:
                if toolbar_group and action.toolbar != toolbar_group:
                    self._toolbar.addSeparator()
                toolbar_group = action.toolbar
                self._toolbar.addAction(made)

    def add_panels(self, panels: Sequence[Panel]) -> None:
        """Put panels into docks; docks of one area stand above each other."""
        docks: dict[str, QDockWidget] = {}
        self._menus["view"].addSeparator()
        for panel in panels:
            dock = QDockWidget(panel.title.spoken(self._language), self)
            dock.setObjectName(panel.id)
            dock.setWidget(panel.widget)
            self.addDockWidget(panel.area, dock)
            if panel.behind:
                self.tabifyDockWidget(docks[panel.behind], dock)
                self._in_front.append(docks[panel.behind])
            self._menus["view"].addAction(dock.toggleViewAction())
            docks[panel.id] = dock
        placed = [panel for panel in panels if not panel.behind]
        own = [docks[panel.id] for panel in placed]
        across, down = Qt.Orientation.Horizontal, Qt.Orientation.Vertical
        self.resizeDocks(own, [panel.width for panel in placed], across)
        self.resizeDocks(own, [panel.height for panel in placed], down)

    def show_work(self, *, is_open: bool) -> None:
        """Show the views, or the start page; docks belong to the views."""
        self._pages.setCurrentIndex(1 if is_open else 0)
        for dock in self.findChildren(QDockWidget):
            dock.setVisible(is_open)
        if is_open:
            self._when_laid_out.start()

    def _bring_forward(self) -> None:
        for dock in self._in_front:
            dock.raise_()

    def show_title(self, name: str) -> None:
        """Name the window after the project."""
        self.setWindowTitle(f"{name} – Zuka" if name else self.tr("Zuka"))

    def stand_side_by_side(self, *, beside: bool) -> None:
        """Put the views beside each other, or one above the other."""
        turned = Qt.Orientation.Horizontal if beside else Qt.Orientation.Vertical
        self._splitter.setOrientation(turned)

    def layout_to_keep(self) -> tuple[QByteArray, QByteArray]:
        """Geometry and docks, to be given to :meth:`restore_layout`."""
        return self.saveGeometry(), self.saveState()

    def restore_layout(self, layout: tuple[QByteArray, QByteArray]) -> None:
        """Stand as it was left."""
        self.restoreGeometry(layout[0])
        self.restoreState(layout[1])

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
        self.closed.emit()
        super().closeEvent(event)

    def _made(self, action: Action) -> QAction:
        text = action.text.spoken(self._language)
        made = QAction(text, self)
        made.setObjectName(action.id)
        made.setShortcuts([QKeySequence(keys) for keys in action.keys])
        if action.icon:
            made.setIcon(self._icon(action.icon))
        if action.keys:
            made.setToolTip(f"{text} ({action.keys[0]})")
        made.setCheckable(action.is_checkable)
        made.triggered.connect(_without_argument(action.run))
        self._actions[action.id] = made
        return made

    def _icon(self, name: str) -> QIcon:
        palette = self.palette()
        icon: QIcon = qtawesome.icon(
            name,
            color=palette.windowText().color(),
            color_disabled=palette.placeholderText().color(),
        )
        return icon


def _without_argument(run: Callable[[], object]) -> Callable[[], None]:
    """Qt sends whether the action is checked; what is run doesn't ask for it."""

    def called() -> None:
        run()

    return called
