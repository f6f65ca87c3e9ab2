"""Panels share the window without a trace of where they were before."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow, QTabBar

from app.layout.panel_room import hide_stray_tabs


def test_a_bar_whose_tabs_are_all_in_another_one_is_hidden(qtbot):
    window = QMainWindow()
    qtbot.addWidget(window)
    docks = [QDockWidget(title, window) for title in ("Layers", "Attributes", "Review")]
    for dock in docks:
        window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
    window.tabifyDockWidget(docks[0], docks[1])
    window.tabifyDockWidget(docks[1], docks[2])
    stray = QTabBar(window)
    for title in ("Layers", "Attributes"):
        stray.addTab(title)
    window.show()
    qtbot.waitExposed(window)
    hide_stray_tabs(window)
    bars = window.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly)
    shown = [bar for bar in bars if bar.isVisible()]
    assert [bar.count() for bar in shown] == [3]
    assert stray not in shown
