"""What a window is given to hold: the widgets in its middle, and the panels around them."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import QStatusBar, QToolBar, QVBoxLayout, QWidget
from typing_extensions import override

from app.layout.view_area import ViewArea
from app.layout.view_docks import ViewLayout
from processing.core.text import Language, Text


@dataclass(frozen=True)
class PanelPlace:
    """Where a panel stands, and when it is seen.

    Attributes
    ----------
    area : Qt.DockWidgetArea
        Where it is at first.
    width, height : int
        Its share there, in pixels of a usual window.
    behind : str
        Id of the panel with which it shares a place, as a tab; empty for a place of its own.
    narrow_behind : str
        The same in a window too narrow for panels at both sides.
    middling_behind : str or None
        The same in a window with room for one panel at the right, as high as the window; None for
        a panel that stands as in a narrow one.
    is_hidden : bool
        Whether it waits to be called by its action.
    key : str
        The key of that action.
    front_px : tuple of (ViewLayout, int)
        The layouts that bring it to the front, and how high it is then, in pixels.
    worked_in_px : int
        How high its work wants it in a narrow window, where it shares a column; 0: as it comes.
    """

    area: Qt.DockWidgetArea
    width: int
    height: int
    behind: str = ""
    narrow_behind: str = ""
    middling_behind: str | None = None
    is_hidden: bool = False
    key: str = ""
    front_px: tuple[tuple[ViewLayout, int], ...] = ()
    worked_in_px: int = 0


@dataclass(frozen=True)
class DockPanel:
    """A widget in a dock."""

    id: str
    title: Text
    widget: QWidget
    place: PanelPlace


@dataclass(frozen=True)
class WindowContents:
    """What a window holds, in one language.

    Attributes
    ----------
    start_page : QWidget
        Shown while nothing is open.
    views : ViewArea
        Fill the middle while a project is open.
    tools : QWidget
        Stands at the end of the toolbar, while a project is open.
    header : QWidget
        The line above the views.
    message : QWidget
        The line above everything.
    status : QStatusBar
        The last line.
    """

    language: Language
    start_page: QWidget
    views: ViewArea
    tools: QWidget
    header: QWidget
    message: QWidget
    status: QStatusBar


class PlainToolBar(QToolBar):
    """A toolbar in the window's own colour, where the style would paint a gradient and a line."""

    def __init__(self, title: str, parent: QWidget) -> None:
        super().__init__(title, parent)
        self.setMovable(False)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint nothing: the window's ground is there already."""


def stack_widgets(*widgets: QWidget) -> QWidget:
    """Lines above the last widget, which fills the rest."""
    whole = QWidget()
    column = QVBoxLayout(whole)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    for line in widgets[:-1]:
        column.addWidget(line)
    column.addWidget(widgets[-1], 1)
    return whole
