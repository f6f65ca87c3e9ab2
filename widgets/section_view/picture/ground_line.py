"""The line of the found ground in a section: solid where measured, dashed where filled in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from processing.core.text import Language, Text
from processing.methods.ground.surface_line import SurfaceLine
from processing.section.cut import Cut
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.feed import SectionPicture
from widgets.section_view.picture.projection import SectionProjection

_MEASURED = Text("Ground, measured", "地面（計測）")
_FILLED = Text("Ground, filled in", "地面（補間）")

_OF_EPOCH = Text("Ground {epoch}", "地面 {epoch}")

_COLOURS = tuple(map(QColor, ("#f0e442", "#ff8c5a", "#56b4e9", "#cc79a7")))
"""Of the surveys, the older ones first: a volume's two grounds have the first two."""

_EDGE = QColor(16, 18, 22, 150)
_PLATE = QColor(16, 18, 22, 205)
_WORDS = QColor("#eef2f6")
_LINE_PX, _EDGE_PX = 1.5, 3.0
_DASHES = [4.0, 3.0]
_SAMPLE_PX, _GAP_PX, _MARGIN_PX = 26.0, 8.0, 6.0


def paint_ground_lines(
    painter: QPainter, viewport: PlaneViewport, cut: Cut, lines: Sequence[SurfaceLine]
) -> None:
    """Paint the ground over the points.

    Parameters
    ----------
    lines : sequence of SurfaceLine
        In the plane of the cut.
    """
    projection = SectionProjection(cut)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for is_edge in (True, False):
        for line in lines:
            section = np.column_stack([line.positions, np.zeros(len(line.positions))])
            pixels = viewport.to_screen(projection.on_plane(section))
            inside = _near_window(pixels[:, 0], viewport.width)
            outline = QPolygonF([QPointF(x, y) for x, y in pixels[inside].tolist()])
            painter.setPen(_pen(line.epoch, is_edge=is_edge, is_filled=line.is_filled))
            painter.drawPolyline(outline)


def paint_ground_legend(
    painter: QPainter, viewport: PlaneViewport, picture: SectionPicture, language: Language
) -> None:
    """Say at the top right what the lines are; nothing where there are none."""
    rows = [
        (name.in_language(language), epoch, is_filled)
        for name, epoch, is_filled in _legend_of(picture)
    ]
    if not rows:
        return
    metrics = QFontMetricsF(painter.font())
    wide = max(metrics.horizontalAdvance(name) for name, _, _ in rows)
    wide += _SAMPLE_PX + 3 * _MARGIN_PX
    high = metrics.height() + 2.0
    plate = QRectF(viewport.width - wide - _MARGIN_PX, 34.0, wide, len(rows) * high + 4.0)
    painter.fillRect(plate, _PLATE)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for number, (name, epoch, is_filled) in enumerate(rows):
        top = plate.top() + 2.0 + number * high
        left = plate.left() + _MARGIN_PX
        middle = top + high / 2
        painter.setPen(_pen(epoch, is_edge=False, is_filled=is_filled))
        painter.drawLine(QLineF(left, middle, left + _SAMPLE_PX, middle))
        painter.setPen(_WORDS)
        words = QRectF(left + _SAMPLE_PX + _MARGIN_PX, top, wide, high)
        painter.drawText(words, int(Qt.AlignmentFlag.AlignVCenter), name)


def _legend_of(picture: SectionPicture) -> list[tuple[Text, int, bool]]:
    """Names of the lines with the epoch and the kind whose line stands beside them."""
    lines = picture.ground
    shown = sorted({line.epoch for line in lines})
    filled = [(_FILLED, shown[0], True)] if any(line.is_filled for line in lines) else []
    if len(shown) > 1:
        names = [_OF_EPOCH.filled(epoch=picture.epochs[epoch]) for epoch in shown]
        return [(name, epoch, False) for name, epoch in zip(names, shown, strict=True)] + filled
    measured = [(_MEASURED, shown[0], False)] if not all(one.is_filled for one in lines) else []
    return measured + filled


def _near_window(x: NDArray[np.float64], width: float) -> slice:
    """Places in the window and one on either side of it: far outside Qt's lines go wrong."""
    first, end = np.searchsorted(x, [0.0, width]).tolist()
    return slice(max(first - 1, 0), end + 1)


def _pen(epoch: int, *, is_edge: bool, is_filled: bool) -> QPen:
    colour = _COLOURS[epoch % len(_COLOURS)]
    pen = QPen(_EDGE if is_edge else colour, _EDGE_PX if is_edge else _LINE_PX)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    if is_filled and not is_edge:
        pen.setDashPattern(_DASHES)
    return pen
