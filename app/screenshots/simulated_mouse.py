"""SimulatedMouse: mouse and keyboard, as events that a person's would be."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from PySide6.QtCore import QEvent, QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
MIDDLE, NO_BUTTON = Qt.MouseButton.MiddleButton, Qt.MouseButton.NoButton
PLAIN = Qt.KeyboardModifier.NoModifier
SHIFT, CONTROL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier

_STEPS = 12
_NOTCH = 120


class SimulatedMouse:
    """Remembers which button is held where, so that it can be let go later."""

    def __init__(self) -> None:
        self._held: tuple[QWidget, QPoint] | None = None

    def move(self, widget: QWidget, spot: QPoint, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Bring the mouse over a place of a widget; with the button held, drag."""
        move(widget, spot, modifiers, NO_BUTTON if self._held is None else LEFT)

    def click(self, widget: QWidget, spot: QPoint, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Bring the mouse there and click."""
        self.move(widget, spot, modifiers)
        QTest.mouseClick(widget, LEFT, modifiers, spot)

    def right_click(self, widget: QWidget, spot: QPoint) -> None:
        """Bring the mouse there and click with the right button."""
        self.move(widget, spot)
        QTest.mouseClick(widget, RIGHT, PLAIN, spot)

    def drag(
        self, widget: QWidget, way: Sequence[QPoint], modifiers: Qt.KeyboardModifier = PLAIN
    ) -> None:
        """Press at the first place and move over the others; the button stays down."""
        self.move(widget, way[0], modifiers)
        QTest.mousePress(widget, LEFT, modifiers, way[0])
        self._held = (widget, way[-1])
        for begin, end in itertools.pairwise(way):
            for step in range(1, _STEPS + 1):
                self.move(widget, begin + (end - begin) * step / _STEPS, modifiers)

    def let_go(self) -> None:
        """Let the button up where it is."""
        if self._held is not None:
            (widget, spot), self._held = self._held, None
            QTest.mouseRelease(widget, LEFT, PLAIN, spot)

    def push(self, widget: QWidget, begin: QPoint, end: QPoint) -> None:
        """Drag with the middle button from one place to another."""
        QTest.mousePress(widget, MIDDLE, PLAIN, begin)
        move(widget, end, PLAIN, MIDDLE)
        QTest.mouseRelease(widget, MIDDLE, PLAIN, end)

    def wheel(
        self,
        widget: QWidget,
        spot: QPoint,
        notches: int,
        modifiers: Qt.KeyboardModifier = PLAIN,
    ) -> None:
        """Turn the wheel over a place."""
        event = QWheelEvent(
            QPointF(spot),
            QPointF(widget.mapToGlobal(spot)),
            QPoint(),
            QPoint(0, _NOTCH * notches),
            NO_BUTTON,
            modifiers,
            Qt.ScrollPhase.NoScrollPhase,
            False,  # noqa: FBT003 - Qt takes it by its place only
        )
        QApplication.sendEvent(widget, event)

    def key(
        self,
        widget: QWidget,
        key: Qt.Key,
        modifiers: Qt.KeyboardModifier = PLAIN,
    ) -> None:
        """Press a key; it reaches the menus of the active window as well."""
        QTest.keyClick(widget, key, modifiers)

    def type(self, widget: QWidget, words: str) -> None:
        """Type letters."""
        for letter in words:
            if letter.isascii():
                QTest.keyClicks(widget, letter)

    def drop(self, widget: QWidget, paths: Sequence[str]) -> None:
        """Drop files."""
        files = QMimeData()
        files.setUrls([QUrl.fromLocalFile(path) for path in paths])
        copy, middle = Qt.DropAction.CopyAction, widget.rect().center()
        QApplication.sendEvent(widget, QDragEnterEvent(middle, copy, files, LEFT, PLAIN))
        QApplication.sendEvent(widget, QDropEvent(QPointF(middle), copy, files, LEFT, PLAIN))


def move(
    widget: QWidget, spot: QPoint, modifiers: Qt.KeyboardModifier, held: Qt.MouseButton
) -> None:
    """Move the mouse to a spot, with a button held or none."""
    event = QMouseEvent(
        QEvent.Type.MouseMove,
        QPointF(spot),
        QPointF(widget.mapToGlobal(spot)),
        NO_BUTTON,
        held,
        modifiers,
    )
    QApplication.sendEvent(widget, event)
