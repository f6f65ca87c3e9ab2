"""ShareBar: how much of something is done, as a thin bar."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize
from PySide6.QtGui import QPainter, QPaintEvent, QPalette
from PySide6.QtWidgets import QSizePolicy, QWidget
from typing_extensions import override

_HEIGHT_PX = 8


class ShareBar(QWidget):
    """Painted when there is time: a progress bar of Qt's would paint the whole window at once."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._share = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    @property
    def share(self) -> float:
        """What it shows, from 0 to 1."""
        return self._share

    def show_share(self, share: float) -> None:
        """Show a share, from 0 to 1."""
        share = min(max(share, 0.0), 1.0)
        if share != self._share:
            self._share = share
            self.update()

    @override
    def sizeHint(self) -> QSize:
        return QSize(120, _HEIGHT_PX)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            bar = QRectF(self.rect())
            painter.fillRect(bar, self.palette().color(QPalette.ColorRole.Midlight))
            bar.setWidth(bar.width() * self._share)
            painter.fillRect(bar, self.palette().color(QPalette.ColorRole.Highlight))
