"""MarkPainter: lines, vertices and symbols of the picture, in screen pixels at any zoom."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QBrush, QColor, QPainter, QPainterPath, QPen

from processing.core.arrays import Floats
from widgets.feature_drawing.feature_marks import FeatureMarks
from widgets.feature_drawing.feature_style import FeatureStyle
from widgets.image_view.orientation.viewport import Viewport

_FILL_ALPHA = 34


class MarkPainter:
    """Paints features; makes each pen once."""

    def __init__(self) -> None:
        self._pens: dict[FeatureStyle, tuple[QPen, QPen]] = {}
        self._marks = FeatureMarks()

    def paint_line(
        self,
        painter: QPainter,
        path: QPainterPath,
        viewport: Viewport,
        style: FeatureStyle,
        *,
        is_area: bool,
    ) -> None:
        """Paint a path in picture coordinates: halo, then line; areas are filled lightly."""
        if path.isEmpty():
            return
        if style not in self._pens:
            self._pens[style] = style.halo_pen(), style.pen()
        # Mapped first: the pen's width then counts screen pixels in both directions.
        screen = viewport.transform().map(path)
        if is_area:
            fill = QColor(style.colour)
            fill.setAlpha(_FILL_ALPHA)
            painter.fillPath(screen, QBrush(fill))
        for pen in self._pens[style]:
            painter.strokePath(screen, pen)

    def paint_marks(
        self,
        painter: QPainter,
        positions: Floats,
        viewport: Viewport,
        style: FeatureStyle,
        *,
        is_point: bool,
        hollow: NDArray[np.bool_] | None = None,
    ) -> None:
        """Paint the symbols of points, and squares where vertices are shown.

        Parameters
        ----------
        hollow : (n,) bool or None
            Vertices whose squares are open: no measured point is there.
        """
        spots = viewport.to_screen(positions)
        self._marks.paint(painter, spots, style, is_point=is_point, hollow=hollow)
