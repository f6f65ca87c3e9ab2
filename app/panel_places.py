"""The panels of the window, each declared once: what it is, where it stands, how it is called."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QTabWidget, QWidget

from app.layout.view_docks import ViewLayout
from app.window.window_contents import DockPanel, PanelPlace
from app.window.window_parts import WindowParts
from processing.core.text import Text
from widgets.parts.scrolled import make_scrollable

_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
_BELOW = Qt.DockWidgetArea.BottomDockWidgetArea


@dataclass(frozen=True)
class Panel:
    """A panel: its dock, its switch in the menu and the palette, and its part in layouts follow.

    Attributes
    ----------
    id : str
        Names the dock; the window remembers its place by it.
    make : callable
        Gives the widget for the parts of a window, connected; again in another language.
    """

    id: str
    title: Text
    make: Callable[[WindowParts], QWidget]
    place: PanelPlace

    def docked(self, parts: WindowParts) -> DockPanel:
        """The panel of a window."""
        return DockPanel(self.id, self.title, self.make(parts), self.place)


def panels_of(parts: WindowParts) -> tuple[DockPanel, ...]:
    """All panels of a window, made of its parts."""
    return tuple(panel.docked(parts) for panel in PANELS)


def _right(
    *,
    behind: str = "processing",
    narrow_behind: str = "attributes",
    middling_behind: str | None = "processing",
    is_hidden: bool = False,
    front_px: tuple[tuple[ViewLayout, int], ...] = (),
    worked_in_px: int = 0,
) -> PanelPlace:
    """At the right of a wide window, one above the other; in a narrower one behind each other.

    In a narrow one they are with the layers or below them, where each place has as many tabs as
    can be read.
    """
    return PanelPlace(
        _RIGHT,
        248,
        380,
        behind=behind,
        narrow_behind=narrow_behind,
        middling_behind=middling_behind,
        is_hidden=is_hidden,
        front_px=front_px,
        worked_in_px=worked_in_px,
    )


def _evaluation_pages(parts: WindowParts) -> QTabWidget:
    """One place for everything that says how good results are."""
    pages = QTabWidget()
    pages.setDocumentMode(True)
    for title, page in (
        (Text("Candidates", "候補"), parts.evaluation_panel),
        (Text("Point classes", "点のクラス"), make_scrollable(parts.class_panel)),
        (Text("Parameter study", "パラメータ検討"), make_scrollable(parts.study_panel)),
        (Text("Map", "図面の点検"), parts.quality_panel),
    ):
        pages.addTab(page, title.in_language(parts.language))
    return pages


PANELS: tuple[Panel, ...] = (
    Panel(
        "layers",
        Text("Layers", "レイヤ"),
        lambda parts: parts.layers_panel,
        PanelPlace(_LEFT, 212, 600),
    ),
    Panel(
        "project",
        Text("Project", "プロジェクト"),
        lambda parts: parts.project_tree,
        PanelPlace(_LEFT, 212, 200, narrow_behind="layers"),
    ),
    Panel(
        "attributes",
        Text("Attributes", "属性"),
        lambda parts: parts.attribute_panel,
        PanelPlace(_RIGHT, 248, 420),
    ),
    Panel(
        "processing",
        Text("Processing", "処理"),
        lambda parts: parts.processing_panel,
        _right(behind="", middling_behind="", worked_in_px=480),
    ),
    Panel(
        "jobs",
        Text("Jobs", "ジョブ"),
        lambda parts: parts.jobs_panel,
        _right(narrow_behind="layers", middling_behind=None),
    ),
    Panel(
        "review",
        Text("Review", "確認"),
        lambda parts: parts.review_panel,
        _right(behind="attributes", front_px=((ViewLayout.CHECKING, 600),), worked_in_px=600),
    ),
    Panel(
        "labels",
        Text("Labels", "ラベル"),
        lambda parts: parts.label_panel,
        _right(narrow_behind="layers", is_hidden=True),
    ),
    Panel(
        "templates",
        Text("Templates", "テンプレート"),
        lambda parts: make_scrollable(parts.template_panel),
        _right(narrow_behind="layers", is_hidden=True),
    ),
    Panel(
        "volume",
        Text("Volume", "土量"),
        lambda parts: parts.volume_panel,
        _right(narrow_behind="layers", is_hidden=True, front_px=((ViewLayout.EARTHWORK, 800),)),
    ),
    Panel(
        "waveform",
        Text("Waveform", "波形"),
        lambda parts: parts.pulse_panel,
        PanelPlace(_BELOW, 900, 230, is_hidden=True, key="Shift+F6"),
    ),
    Panel(
        "evaluation",
        Text("Evaluation", "評価"),
        _evaluation_pages,
        PanelPlace(_BELOW, 900, 280, is_hidden=True),
    ),
    Panel(
        "features",
        Text("Table of features", "地物一覧"),
        lambda parts: parts.feature_table,
        PanelPlace(_BELOW, 900, 230, is_hidden=True, key="F6"),
    ),
)
"""All panels, in the order of their docks; another one is another entry."""
