"""The panels of the window and their places."""

from __future__ import annotations

from PySide6.QtCore import Qt

from app.window_contents import Panel
from app.window_parts import WindowParts
from processing.text import Text

_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
_BELOW = Qt.DockWidgetArea.BottomDockWidgetArea


def panels_of(parts: WindowParts) -> tuple[Panel, ...]:
    """All panels; each shares its place with those that are behind it."""
    project, layers = Text("Project", "プロジェクト"), Text("Layers", "レイヤ")
    processing, attributes = Text("Processing", "処理"), Text("Attributes", "属性")
    jobs, table = Text("Jobs", "ジョブ"), Text("Table of features", "地物一覧")
    return (
        Panel("layers", layers, parts.layers_panel, _LEFT, 212, 600),
        Panel("project", project, parts.project_tree, _LEFT, 212, 200, narrow_behind="layers"),
        Panel("attributes", attributes, parts.attribute_panel, _RIGHT, 248, 420),
        Panel(
            "processing",
            processing,
            parts.processing_panel,
            _RIGHT,
            248,
            380,
            narrow_behind="attributes",
        ),
        Panel(
            "jobs",
            jobs,
            parts.jobs_panel,
            _RIGHT,
            248,
            380,
            behind="processing",
            narrow_behind="attributes",
        ),
        Panel(
            "review",
            Text("Review", "確認"),
            parts.review_panel,
            _RIGHT,
            248,
            380,
            behind="attributes",
            narrow_behind="attributes",
        ),
        Panel(
            "labels",
            Text("Labels", "ラベル"),
            parts.label_panel,
            _RIGHT,
            248,
            380,
            behind="processing",
            narrow_behind="attributes",
            is_hidden=True,
        ),
        Panel(
            "evaluation",
            Text("Evaluation", "評価"),
            parts.evaluation_panel,
            _BELOW,
            900,
            260,
            is_hidden=True,
        ),
        Panel(
            "features",
            table,
            parts.feature_table,
            _BELOW,
            900,
            230,
            is_hidden=True,
            key="F6",
        ),
    )
