"""Mouse events of our own: the pointer of the test machine stays where it is."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QWidget

NO_BUTTON = Qt.MouseButton.NoButton
NO_KEYS = Qt.KeyboardModifier.NoModifier
NOTCH = 120


def move_mouse(
    widget: QWidget,
    spot: QPoint,
    button: Qt.MouseButton = NO_BUTTON,
    keys: Qt.KeyboardModifier = NO_KEYS,
) -> None:
    """Move the mouse over a widget, with a button held or without."""
    position, where = QPointF(spot), QPointF(widget.mapToGlobal(spot))
    event = QMouseEvent(QEvent.Type.MouseMove, position, where, NO_BUTTON, button, keys)
    QApplication.sendEvent(widget, event)


def turn_wheel(
    widget: QWidget, spot: QPoint, notches: int, keys: Qt.KeyboardModifier = NO_KEYS
) -> None:
    """Turn the wheel over a widget, away from the hand."""
    position, where = QPointF(spot), QPointF(widget.mapToGlobal(spot))
    turned, phase = QPoint(0, NOTCH * notches), Qt.ScrollPhase.NoScrollPhase
    event = QWheelEvent(position, where, QPoint(), turned, NO_BUTTON, keys, phase, False)
    QApplication.sendEvent(widget, event)
