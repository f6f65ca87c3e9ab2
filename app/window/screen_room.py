"""Room on the screen: a window is never larger than what is free of it, nor outside."""

from __future__ import annotations

from PySide6.QtCore import QRect
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QStyle, QWidget


def bring_onto_screen(window: QWidget) -> None:
    """Make a window so small, and move it so far, that all of it can be seen.

    That is the screen on which most of its middle is, or the first one where it is on none.
    """
    screen = QGuiApplication.screenAt(window.geometry().center()) or window.screen()
    if screen is None:
        return
    room = screen.availableGeometry()
    if not window.isVisible():
        # Only a shown window knows its frame.
        title = window.style().pixelMetric(QStyle.PixelMetric.PM_TitleBarHeight)
        room.setTop(room.top() + title)
    window.setGeometry(fitted(window.geometry(), room))


def fitted(wanted: QRect, room: QRect) -> QRect:
    """A rectangle in a room, as large as wanted and as near to where it was as the room allows."""
    size = wanted.size().boundedTo(room.size())
    left = min(max(wanted.left(), room.left()), room.right() + 1 - size.width())
    top = min(max(wanted.top(), room.top()), room.bottom() + 1 - size.height())
    return QRect(left, top, size.width(), size.height())
