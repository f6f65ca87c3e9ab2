"""ChangePainter: both grounds of the volume that is shown, with cut and fill between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from processing.core.arrays import Floats
from processing.core.text import Language, Text
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.change_reading import ChangeLine, change_along
from processing.section.cut import Cut
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.projection import SectionProjection
from widgets.shared.shown_volume import ShownVolume

_BEFORE, _AFTER = Text("Before", "前"), Text("After", "後")
_CUT, _FILL = Text("Cut", "切土"), Text("Fill", "盛土")

_BEFORE_COLOUR, _AFTER_COLOUR = QColor("#f0e442"), QColor("#ff8c5a")
_CUT_COLOUR, _FILL_COLOUR = QColor(95, 159, 211, 110), QColor(243, 166, 79, 110)
_EDGE, _PLATE, _WORDS = QColor(16, 18, 22, 150), QColor(16, 18, 22, 205), QColor("#eef2f6")
_LINE_PX, _EDGE_PX = 1.75, 3.5
_DASHES = [4.0, 3.0]
_SAMPLE_PX, _MARGIN_PX, _TOP_PX = 26.0, 6.0, 34.0
_STEPS_PER_CELL, _MOST_POSITIONS = 2, 4000


class ChangePainter:
    """Paints them for any cut; looks a cut up once.

    Parameters
    ----------
    volume : ShownVolume
    """

    def __init__(self, volume: ShownVolume) -> None:
        self._volume = volume
        self._held: tuple[ChangeGrid, Cut, ChangeLine] | None = None

    def line_in(self, cut: Cut) -> ChangeLine | None:
        """Both grounds in a cut; None where the volume that is shown has none there."""
        change = self._volume.drawn
        if change is None:
            self._held = None
            return None
        held = self._held
        if held is None or held[0] is not change or held[1] != cut:
            held = self._held = change, cut, _line_in(change, cut)
        line = held[2]
        return line if np.isfinite(line.after - line.before).any() else None

    def paint(self, painter: QPainter, viewport: PlaneViewport, cut: Cut, line: ChangeLine) -> None:
        """Cut and fill, and the two lines over them."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        before, after = (
            _on_screen(viewport, cut, line.offsets, heights)
            for heights in (line.before, line.after)
        )
        lower, higher = np.maximum(before, after), np.minimum(before, after)  # y points down
        painter.setPen(Qt.PenStyle.NoPen)
        for between, colour in ((lower, _CUT_COLOUR), (higher, _FILL_COLOUR)):
            painter.setBrush(colour)
            for piece in _pieces(np.isfinite(between[:, 1]), line.is_measured, joins=True):
                outline = np.concatenate([before[piece], between[piece][::-1]])
                painter.drawPolygon(_polygon(outline))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for is_edge in (True, False):
            for positions, colour in ((before, _BEFORE_COLOUR), (after, _AFTER_COLOUR)):
                for piece in _pieces(np.isfinite(positions[:, 1]), line.is_measured, joins=False):
                    is_measured = bool(line.is_measured[piece][1:].all())
                    painter.setPen(_pen(colour, is_edge=is_edge, is_measured=is_measured))
                    painter.drawPolyline(_polygon(positions[piece]))

    def paint_legend(self, painter: QPainter, viewport: PlaneViewport, language: Language) -> None:
        """Say at the top right what is what."""
        metrics = QFontMetricsF(painter.font())
        rows = [
            (_BEFORE.in_language(language), _BEFORE_COLOUR, _LINE_PX),
            (_AFTER.in_language(language), _AFTER_COLOUR, _LINE_PX),
            (_CUT.in_language(language), _CUT_COLOUR, metrics.height() - 6.0),
            (_FILL.in_language(language), _FILL_COLOUR, metrics.height() - 6.0),
        ]
        widest = max(metrics.horizontalAdvance(name) for name, _, _ in rows)
        wide, high = widest + _SAMPLE_PX + 3 * _MARGIN_PX, metrics.height() + 2.0
        plate = QRectF(viewport.width - wide - _MARGIN_PX, _TOP_PX, wide, len(rows) * high + 4.0)
        painter.fillRect(plate, _PLATE)
        for number, (name, colour, thick) in enumerate(rows):
            left, top = plate.left() + _MARGIN_PX, plate.top() + 2.0 + number * high
            painter.fillRect(QRectF(left, top + (high - thick) / 2, _SAMPLE_PX, thick), colour)
            painter.setPen(_WORDS)
            words = QRectF(left + _SAMPLE_PX + _MARGIN_PX, top, wide, high)
            painter.drawText(words, int(Qt.AlignmentFlag.AlignVCenter), name)


def _line_in(change: ChangeGrid, cut: Cut) -> ChangeLine:
    half_m = cut.half_length_m
    count = int(np.ceil(2 * half_m / change.grid.size_m)) * _STEPS_PER_CELL
    offsets = np.linspace(-half_m, half_m, min(max(count, 2), _MOST_POSITIONS))
    nothing = np.zeros_like(offsets)
    xy = cut.to_space(np.column_stack([offsets, nothing, nothing]))[:, :2]
    return change_along(change, offsets, xy)


def _on_screen(viewport: PlaneViewport, cut: Cut, offsets: Floats, heights: Floats) -> Floats:
    section = np.column_stack([offsets, heights, np.zeros_like(offsets)])
    positions: Floats = viewport.to_screen(SectionProjection(cut).on_plane(section))
    # Far outside the window Qt's lines go wrong.
    positions[(positions[:, 0] < -viewport.width) | (positions[:, 0] > 2 * viewport.width)] = np.nan
    return positions


def _pieces(
    is_there: NDArray[np.bool_], is_measured: NDArray[np.bool_], *, joins: bool
) -> list[slice]:
    """Stretches of two places at least; where they don't join, one is measured or none of it."""
    between = is_there[1:] & is_there[:-1]
    state = between.astype(np.int8)
    if not joins:
        state = np.where(between, 1 + (is_measured[1:] & is_measured[:-1]), 0).astype(np.int8)
    ends = np.flatnonzero(np.diff(state)) + 1
    starts = np.concatenate([[0], ends]).tolist()
    stops = np.concatenate([ends, [state.size]]).tolist()
    return [
        slice(start, stop + 1)
        for start, stop in zip(starts, stops, strict=True)
        if state.size and state[start]
    ]


def _polygon(positions: Floats) -> QPolygonF:
    return QPolygonF([QPointF(x, y) for x, y in positions.tolist()])


def _pen(colour: QColor, *, is_edge: bool, is_measured: bool) -> QPen:
    pen = QPen(_EDGE if is_edge else colour, _EDGE_PX if is_edge else _LINE_PX)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    if not (is_measured or is_edge):
        pen.setDashPattern(_DASHES)
    return pen
