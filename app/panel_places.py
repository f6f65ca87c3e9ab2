"""The panels of the window and their places."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QTabWidget, QWidget

from app.window.window_contents import DockPanel
from app.window.window_parts import WindowParts
from processing.core.text import Text
from widgets.parts.scrolled import make_scrollable

_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
_BELOW = Qt.DockWidgetArea.BottomDockWidgetArea


def panels_of(parts: WindowParts) -> tuple[DockPanel, ...]:
    """All panels; each shares its place with those that are behind it."""
    project, layers = Text("Project", "プロジェクト"), Text("Layers", "レイヤ")
    return (
        DockPanel("layers", layers, parts.layers_panel, _LEFT, 212, 600),
        DockPanel("project", project, parts.project_tree, _LEFT, 212, 200, narrow_behind="layers"),
        *_right_panels(parts),
        *_lower_panels(parts),
    )


def _right_panels(parts: WindowParts) -> tuple[DockPanel, ...]:
    """At the right of a wide window; in a narrow one with the layers or below them.

    There each place has as many tabs as can be read.
    """
    attributes = Text("Attributes", "属性")
    return (
        DockPanel("attributes", attributes, parts.attribute_panel, _RIGHT, 248, 420),
        _right("processing", Text("Processing", "処理"), parts.processing_panel, behind=""),
        _right("jobs", Text("Jobs", "ジョブ"), parts.jobs_panel, narrow_behind="layers"),
        _right("review", Text("Review", "確認"), parts.review_panel, behind="attributes"),
        _right(
            "labels",
            Text("Labels", "ラベル"),
            parts.label_panel,
            narrow_behind="layers",
            is_hidden=True,
        ),
        _right(
            "templates",
            Text("Templates", "テンプレート"),
            make_scrollable(parts.template_panel),
            narrow_behind="layers",
            is_hidden=True,
        ),
        _right(
            "volume",
            Text("Volume", "土量"),
            parts.volume_panel,
            narrow_behind="layers",
            is_hidden=True,
        ),
    )


def _right(
    id_: str,
    title: Text,
    widget: QWidget,
    *,
    behind: str = "processing",
    narrow_behind: str = "attributes",
    is_hidden: bool = False,
) -> DockPanel:
    return DockPanel(
        id_,
        title,
        widget,
        _RIGHT,
        248,
        380,
        behind=behind,
        narrow_behind=narrow_behind,
        is_hidden=is_hidden,
    )


def _evaluation_pages(parts: WindowParts) -> QTabWidget:
    """One place for everything that says how good tools are."""
    pages = QTabWidget()
    pages.setDocumentMode(True)
    for title, page in (
        (Text("Candidates", "候補"), parts.evaluation_panel),
        (Text("Point classes", "点のクラス"), make_scrollable(parts.class_panel)),
        (Text("Parameter study", "パラメータ検討"), make_scrollable(parts.study_panel)),
    ):
        pages.addTab(page, title.in_language(parts.language))
    return pages


def _lower_panels(parts: WindowParts) -> tuple[DockPanel, ...]:
    """Tables, which wait to be called."""
    evaluation, table = Text("Evaluation", "評価"), Text("Table of features", "地物一覧")
    return (
        DockPanel(
            "evaluation", evaluation, _evaluation_pages(parts), _BELOW, 900, 280, is_hidden=True
        ),
        DockPanel(
            "features", table, parts.feature_table, _BELOW, 900, 230, is_hidden=True, key="F6"
        ),
    )
