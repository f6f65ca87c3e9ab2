"""ScenePicture: paints frames that were drawn beside the window, as any other view is painted."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QCoreApplication, QEvent, QPointF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from widgets.scene_view.rendering.backdrop import BACKGROUND

_DRAW = QEvent.Type(QEvent.registerEventType())
# Qt posts its requests to paint with low priority: what else changed is on the screen before a
# frame of 3D, which takes longer than all other views together, is begun.
_AFTER_PAINTING = Qt.EventPriority.LowEventPriority.value - 1


class ScenePicture(QWidget):
    """The widget that shows the 3D view and gets its mouse and keys.

    Nothing is drawn while it can't be seen.

    Parameters
    ----------
    draw_frame : callable
        Given width and height in device pixels, draws a frame.

    Signals
    -------
    frame_painted(seconds: float)
        A new frame was painted; how long that took, from its beginning.
    """

    frame_painted = Signal(float)

    def __init__(self, parent: QWidget, draw_frame: Callable[[QSize], QImage]) -> None:
        super().__init__(parent)
        self._draw_frame = draw_frame
        self._frame = QImage()
        self._is_outdated = True
        self._is_requested = False
        self._began_at = 0.0
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setFocusPolicy(Qt.FocusPolicy.WheelFocus)
        self.setMouseTracking(True)

    @property
    def size_px(self) -> QSize:
        """In device pixels."""
        scale = self.devicePixelRatioF()
        return QSize(round(self.width() * scale), round(self.height() * scale))

    def redraw(self) -> None:
        """Draw a frame soon; when it can be seen again, if it can't now."""
        self._is_outdated = True
        if not self._is_requested:
            self._is_requested = True
            QCoreApplication.postEvent(self, QEvent(_DRAW), _AFTER_PAINTING)

    @override
    def event(self, event: QEvent) -> bool:
        if event.type() == _DRAW:
            self._is_requested = False
            if self._is_outdated and self._is_seen():
                self._draw()
            return True
        return super().event(event)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            if self._frame.isNull():
                painter.fillRect(self.rect(), QColor(BACKGROUND))
            elif self._frame.size() == self.size_px:
                painter.drawImage(QPointF(0, 0), self._frame)
            else:
                painter.drawImage(self.rect(), self._frame)
        if self._is_outdated or self._frame.size() != self.size_px:
            self.redraw()
        if self._began_at:
            seconds, self._began_at = time.perf_counter() - self._began_at, 0.0
            self.frame_painted.emit(seconds)

    def _draw(self) -> None:
        self._is_outdated = False
        self._began_at = time.perf_counter()
        self._frame = self._draw_frame(self.size_px)
        self._frame.setDevicePixelRatio(self.devicePixelRatioF())
        self.update()

    def _is_seen(self) -> bool:
        window = self.window().windowHandle()
        is_exposed = window is not None and window.isExposed()
        return is_exposed and not self.visibleRegion().isEmpty()
