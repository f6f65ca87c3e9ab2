"""RoadPlotView: pages of a plot, one at a time, as large as the dialog."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QByteArray, QRectF, QSize
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QHBoxLayout, QLabel, QVBoxLayout, QWidget
from typing_extensions import override

from widgets.parts.plain_buttons import remove_icons

_USUAL_PX = QSize(1120, 800)


class RoadPlotView(QDialog):
    """Shows what was plotted of roads."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Road model"))
        self._pages: list[QSvgRenderer] = []
        self._number = 0
        self._picture = _PlotPicture(self)
        self._where = QLabel(self)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        kind = QDialogButtonBox.ButtonRole.ActionRole
        self._before = buttons.addButton(self.tr("Previous"), kind)
        self._after = buttons.addButton(self.tr("Next"), kind)
        remove_icons(buttons)
        below = QHBoxLayout()
        below.addWidget(self._where, 1)
        below.addWidget(buttons)
        layout = QVBoxLayout(self)
        layout.addWidget(self._picture, 1)
        layout.addLayout(below)
        self.resize(_USUAL_PX)
        self._before.clicked.connect(lambda: self._turn(-1))
        self._after.clicked.connect(lambda: self._turn(1))
        buttons.rejected.connect(self.close)

    @property
    def page(self) -> int:
        """Number of the page that is shown, from 0."""
        return self._number

    def show_pages(self, pages: Sequence[bytes]) -> None:
        """Show pages of SVG from the first on."""
        self._pages = [QSvgRenderer(QByteArray(one)) for one in pages]
        self._number = 0
        self._turn(0)

    def _turn(self, by: int) -> None:
        last = max(0, len(self._pages) - 1)
        self._number = min(max(self._number + by, 0), last)
        self._before.setEnabled(self._number > 0)
        self._after.setEnabled(self._number < last)
        count = len(self._pages)
        # Both are numbers of pages, which no language counts otherwise.
        self._where.setText(f"{self._number + 1} / {count}" if count > 1 else "")
        self._picture.show_picture(self._pages[self._number] if self._pages else None)


class _PlotPicture(QWidget):
    """One page, in its own shape."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._renderer: QSvgRenderer | None = None

    def show_picture(self, renderer: QSvgRenderer | None) -> None:
        self._renderer = renderer
        self.update()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        if self._renderer is None or not self._renderer.isValid():
            return
        size = self._renderer.viewBoxF().size()
        scale = min(self.width() / size.width(), self.height() / size.height())
        wide, high = size.width() * scale, size.height() * scale
        frame = QRectF((self.width() - wide) / 2, (self.height() - high) / 2, wide, high)
        with QPainter(self) as painter:
            self._renderer.render(painter, frame)
