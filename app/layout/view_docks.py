"""ViewDocks: the views beside the image, in docks of their own, within the window or on a screen.

The image is the drawing surface and stays in the window's middle; the others are moved, stacked,
taken out, and put on a second screen as a whole.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

from PySide6.QtCore import QByteArray, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QCloseEvent, QGuiApplication, QResizeEvent, QScreen
from PySide6.QtWidgets import QDockWidget, QMainWindow, QTabWidget, QWidget
from typing_extensions import override

from processing.core.text import Language, Text

_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
_APART = Qt.WindowType.Tool | Qt.WindowType.WindowCloseButtonHint
_SECOND_SCREEN_SHARE = 0.9


class ViewLayout(Enum):
    """Which views stand where; ids as in `DockedView`."""

    DRAWING = "drawing"
    CHECKING = "checking"
    EARTHWORK = "earthwork"
    TWO_SCREENS = "two-screens"


LAYOUT_NAMES: Mapping[ViewLayout, Text] = {
    ViewLayout.DRAWING: Text("Drawing", "作図"),
    ViewLayout.CHECKING: Text("Checking", "確認"),
    ViewLayout.EARTHWORK: Text("Earthwork", "土量"),
    ViewLayout.TWO_SCREENS: Text("Two screens", "2画面"),
}


@dataclass(frozen=True)
class DockedView:
    """A view in a dock of its own."""

    id: str
    title: Text
    widget: QWidget


@dataclass(frozen=True)
class _Standing:
    """How a layout places the views.

    Attributes
    ----------
    columns : tuple of tuple of str
        From left to right; views of one column share a place, the first one in front.
    shares : tuple of int
        Widths of the columns.
    image_share : float
        Of the window's middle that the image gets; 0 hides it.
    """

    columns: tuple[tuple[str, ...], ...]
    shares: tuple[int, ...]
    image_share: float

    def of(self, there: Container[str]) -> _Standing:
        """The same for the views that there are."""
        held = tuple(tuple(id_ for id_ in column if id_ in there) for column in self.columns)
        filled = [
            (column, share) for column, share in zip(held, self.shares, strict=True) if column
        ]
        return replace(
            self,
            columns=tuple(column for column, _ in filled),
            shares=tuple(share for _, share in filled),
        )


_STANDINGS: Mapping[ViewLayout, _Standing] = {
    ViewLayout.DRAWING: _Standing((("scene",), ("section", "camera", "map")), (3, 2), 0.5),
    ViewLayout.CHECKING: _Standing((("section",), ("camera",), ("scene", "map")), (1, 1, 1), 0.42),
    ViewLayout.EARTHWORK: _Standing((("map", "camera"), ("section", "scene")), (1, 1), 0.0),
    ViewLayout.TWO_SCREENS: _Standing((("scene", "map"), ("section", "camera")), (1, 1), 1.0),
}


class ViewDocks(QMainWindow):
    """Holds the views; part of a window, or a window beside it.

    Parameters
    ----------
    views : sequence of DockedView
    language : Language

    Signals
    -------
    came_back()
        The window beside was closed: the views belong into their window again.
    """

    came_back = Signal()

    def __init__(self, views: Sequence[DockedView], language: Language) -> None:
        super().__init__(None, Qt.WindowType.Widget)
        self._views = tuple(views)
        self._standing: _Standing | None = None
        self._docks: dict[str, QDockWidget] = {}
        self.setDockNestingEnabled(True)
        self.setTabPosition(Qt.DockWidgetArea.AllDockWidgetAreas, QTabWidget.TabPosition.North)
        self.setDockOptions(
            QMainWindow.DockOption.AllowNestedDocks
            | QMainWindow.DockOption.AllowTabbedDocks
            | QMainWindow.DockOption.GroupedDragging
        )
        self._when_stacked = QTimer(self, singleShot=True)
        self._when_stacked.timeout.connect(self._show_titles)
        for view in views:
            dock = QDockWidget(view.title.in_language(language), self)
            dock.setObjectName(f"view-{view.id}")
            dock.setWidget(view.widget)
            self._docks[view.id] = dock
            self.addDockWidget(_RIGHT, dock)
            for changed in (dock.dockLocationChanged, dock.topLevelChanged, dock.visibilityChanged):
                changed.connect(self._on_dock_changed)
        self._when_laid_out = QTimer(self, singleShot=True)
        self._when_laid_out.timeout.connect(self._on_laid_out)
        self.setMinimumSize(200, 120)
        self.place(ViewLayout.DRAWING)

    @property
    def is_apart(self) -> bool:
        """Whether the views stand in a window beside their own."""
        return self.isWindow()

    def toggles(self) -> dict[str, tuple[Text, QAction]]:
        """Title of each view and Qt's own action that shows and hides it, by the view's id."""
        return {
            view.id: (view.title, self._docks[view.id].toggleViewAction()) for view in self._views
        }

    def show_view(self, id_: str) -> None:
        """Bring a view to the front."""
        dock = self._docks[id_]
        dock.show()
        dock.raise_()

    def place(self, layout: ViewLayout) -> float:
        """Stand in a layout; gives the share of the window's middle that is the image's."""
        standing = self._standing = _STANDINGS[layout].of(self._docks)
        for dock in self._docks.values():
            dock.setFloating(False)
            self.removeDockWidget(dock)
        fronts = [self._docks[column[0]] for column in standing.columns]
        # All in one area, split: columns of one row keep their shares when it is resized.
        self.addDockWidget(_LEFT, fronts[0])
        for before, front in pairwise(fronts):
            self.splitDockWidget(before, front, Qt.Orientation.Horizontal)
        # Afterwards: a dock that is split while it shares its place takes the other in as a tab.
        for front, column in zip(fronts, standing.columns, strict=True):
            for behind in column[1:]:
                self.tabifyDockWidget(front, self._docks[behind])
        for dock in self._docks.values():
            dock.show()
        self._when_laid_out.start()
        return standing.image_share

    def go_apart(self, window: QWidget) -> None:
        """Become a window beside this one, on the second screen where there is one."""
        if self.is_apart:
            return
        # A tool window leaves the keys of its parent working.
        self.setParent(window, _APART | Qt.WindowType.WindowMaximizeButtonHint)
        self.setWindowTitle(self.tr("Zuka – views"))
        room = _second_screen(window).availableGeometry()
        size = room.size() * _SECOND_SCREEN_SHARE
        self.resize(size)
        self.move(room.center() - self.rect().center())
        self.show()

    def keep(self) -> QByteArray:
        """How the docks stand, for :meth:`restore`."""
        return self.saveState()

    def restore(self, state: QByteArray) -> bool:
        """Stand as kept; says whether it could."""
        self._standing = None
        return self.restoreState(state)

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._standing is not None:
            self._when_laid_out.start()

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        if self.is_apart:
            event.ignore()
            self.came_back.emit()
        else:
            super().closeEvent(event)

    def _on_laid_out(self) -> None:
        """Docks take their sizes, and come to the front, only once they are laid out."""
        standing, self._standing = self._standing, None
        if standing is None:
            return
        fronts = [self._docks[column[0]] for column in standing.columns]
        total = sum(standing.shares)
        widths = [max(self.width() * share // total, 1) for share in standing.shares]
        self.resizeDocks(fronts, widths, Qt.Orientation.Horizontal)
        for dock in fronts:
            dock.raise_()

    def _on_dock_changed(self) -> None:
        # While Qt moves docks about, their titles stay as they are.
        self._when_stacked.start()

    def _show_titles(self) -> None:
        """Tabs name the docks that share a place; a title below would say it twice."""
        for dock in self._docks.values():
            others = [one for one in self.tabifiedDockWidgets(dock) if not one.isHidden()]
            is_tab = bool(others) and not dock.isFloating()
            empty = dock.titleBarWidget()
            if is_tab and empty is None:
                dock.setTitleBarWidget(_NoTitle(dock))
            elif not is_tab and empty is not None:
                dock.setTitleBarWidget(None)  # type: ignore[arg-type]  # Qt's own again
                empty.deleteLater()


class _NoTitle(QWidget):
    """Stands for a title and takes no room; an empty widget would have a size below zero."""

    @override
    def sizeHint(self) -> QSize:
        return QSize(0, 0)

    @override
    def minimumSizeHint(self) -> QSize:
        return QSize(0, 0)


def _second_screen(window: QWidget) -> QScreen:
    """A screen that the window isn't on; its own where there is no other.

    ``QWidget.screen`` isn't asked: Python may then delete the screen, and Qt crashes later.
    """
    own = QGuiApplication.screenAt(window.frameGeometry().center())
    screens = QGuiApplication.screens()
    here = screens[0].geometry() if own is None else own.geometry()
    return next((one for one in screens if one.geometry() != here), screens[0])
