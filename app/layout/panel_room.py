"""Room for a panel that is worked in, at the cost of those above and below it."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow, QTabBar

_LEAST_PX = 1
"""Qt makes it as high as the panel needs."""


def make_room(window: QMainWindow, panel: str, high_px: int) -> None:
    """Let a panel be so high, as far as those beside it allow.

    Parameters
    ----------
    panel : str
        Its id; nothing happens while it is a window of its own.
    """
    dock = window.findChild(QDockWidget, panel)
    if not isinstance(dock, QDockWidget) or dock.isFloating():
        return
    area, stacked = window.dockWidgetArea(dock), window.tabifiedDockWidgets(dock)
    others = [
        one
        for one in window.findChildren(
            QDockWidget, options=Qt.FindChildOption.FindDirectChildrenOnly
        )
        if one is not dock
        and one not in stacked
        and one.isVisible()
        and one.x() >= 0  # Qt keeps those behind a tab off the window
        and not one.isFloating()
        and window.dockWidgetArea(one) == area
    ]
    left_px = (window.height() - high_px) // max(len(others), 1)
    heights = [high_px, *([max(left_px, _LEAST_PX)] * len(others))]
    window.resizeDocks([dock, *others], heights, Qt.Orientation.Vertical)


def hide_stray_tabs(window: QMainWindow) -> None:
    """Hide the bars of tabs that Qt forgot when a panel joined others; each has another's tabs."""
    bars = window.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly)
    tabs = {bar: {bar.tabText(at) for at in range(bar.count())} for bar in bars}
    for bar in bars:
        if any(tabs[bar] < tabs[other] for other in bars):
            bar.hide()
