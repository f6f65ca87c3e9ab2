"""VolumeLayer: change between two grounds on the map: colours, contours, legend, a reading."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import (
    QBrush,
    QColor,
    QFontMetricsF,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPen,
)
from typing_extensions import override

from processing.core.text import Language, Text
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.maps.heat_map import change_classes
from widgets.feature_drawing.screen_marks import paint_note
from widgets.map_view.heat_picture import UNMEASURED, HeatPicture
from widgets.map_view.plan_projection import on_plan
from widgets.parts.change_words import change_words
from widgets.plane_view.view import PlaneView
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.shown_volume import ShownVolume
from widgets.shared.sketch import Note

_TITLE = Text("Height difference", "標高差")
_UNMEASURED = Text("filled in, not measured", "補間（未計測）")
_NOTHING_CHANGED = "#f6f6f6"

_INK = QColor("#eef2f6")
_PLATE = QColor(16, 18, 22, 205)
_EDGE = QColor(16, 18, 22, 190)
_LINE = QColor("#fff7d6")
_LINE_PX, _INDEX_PX, _EDGE_MORE_PX = 1.0, 2.0, 1.5
_SWATCH_PX, _GAP_PX, _MARGIN_PX = 18.0, 6.0, 8.0
_TOP_PX = 72.0
"""Above is the arrow to the north."""


class VolumeLayer(QObject):
    """Paints what is shown of a volume, and reads it below the mouse.

    Parameters
    ----------
    volume : ShownVolume
    view : PlaneView
        The map, whose mouse it follows.
    language : Language

    Signals
    -------
    outdated()
        Something else is to be painted below the features.
    """

    outdated = Signal()

    def __init__(self, volume: ShownVolume, view: PlaneView, language: Language) -> None:
        super().__init__(view)
        self._volume = volume
        self._view = view
        self._language: Language = language
        self._mouse: QPointF | None = None
        self._heat = HeatPicture()
        self._held: tuple[LevelLine, ...] = ()
        self._paths: tuple[QPainterPath, QPainterPath] = QPainterPath(), QPainterPath()
        volume.changed.connect(self.outdated)
        volume.look_changed.connect(self.outdated)
        volume.contours_changed.connect(self.outdated)
        volume.hovered.connect(view.update)
        view.installEventFilter(self)

    def paint(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Colours and contours, below the features."""
        change, look = self._volume.drawn, self._volume.look
        if change is None:
            return
        self._heat.paint(painter, viewport, change, limit_m=look.limit_m, opacity=look.opacity)
        self._paint_contours(painter, viewport)

    def paint_frame(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """What the colours say, at the lower right; and what the map says beside the mouse."""
        if self._volume.drawn is None:
            return
        self._paint_legend(painter, viewport)
        reading = self._volume.reading
        if reading is not None and self._mouse is not None:
            words = change_words(reading).in_language(self._language)
            paint_note(painter, (self._mouse.x(), self._mouse.y()), Note((0.0, 0.0, 0.0), words))

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QMouseEvent) and event.type() == QEvent.Type.MouseMove:
            self._mouse = event.position()
            east, south = self._view.viewport.to_plane(self._mouse.x(), self._mouse.y())
            self._volume.hover_over((east, -south))
            if self._volume.reading is not None:
                self._view.update()
        elif event.type() == QEvent.Type.Leave:
            self._mouse = None
            self._volume.hover_over(None)
        return super().eventFilter(watched, event)

    def _paint_legend(self, painter: QPainter, viewport: PlaneViewport) -> None:
        limit_m = self._volume.look.limit_m
        classes = change_classes(limit_m)
        digits = max(_digits_of(one.low) for one in classes[1:])
        rows = [
            (QColor(*one.rgb), one.label(digits, "m").in_language(self._language))
            for one in reversed(classes)
        ]
        unmeasured = _UNMEASURED.in_language(self._language)
        title = _TITLE.in_language(self._language)
        metrics = QFontMetricsF(painter.font())
        widest = max(map(metrics.horizontalAdvance, (*(words for _, words in rows), unmeasured)))
        wide = max(widest + _SWATCH_PX + _GAP_PX, metrics.horizontalAdvance(title))
        line = metrics.height() + 1.0
        wide, high = wide + 2 * _MARGIN_PX, (len(rows) + 2) * line + _MARGIN_PX + 2.0
        plate = QRectF(viewport.width - wide - 8.0, viewport.height - high - 8.0, wide, high)
        if plate.top() < _TOP_PX or plate.left() < 0:
            return  # in a small window the map itself is more
        painter.fillRect(plate, _PLATE)
        left, top = plate.left() + _MARGIN_PX, plate.top() + _MARGIN_PX / 2
        painter.setPen(_INK)
        _write(painter, QRectF(left, top, wide, line), title)
        for number, (colour, words) in enumerate(rows, start=1):
            at = QRectF(left, top + number * line, _SWATCH_PX, line)
            painter.fillRect(at, colour)
            _write(painter, at.translated(_SWATCH_PX + _GAP_PX, 0).adjusted(0, 0, wide, 0), words)
        at = QRectF(left, top + (len(rows) + 1) * line + 2.0, _SWATCH_PX, line)
        painter.fillRect(at, QColor(_NOTHING_CHANGED))
        painter.fillRect(at, QBrush(UNMEASURED, Qt.BrushStyle.BDiagPattern))
        _write(painter, at.translated(_SWATCH_PX + _GAP_PX, 0).adjusted(0, 0, wide, 0), unmeasured)

    def _paint_contours(self, painter: QPainter, viewport: PlaneViewport) -> None:
        contours = self._volume.contours
        if contours is not self._held:
            self._held = contours
            self._paths = _path_of(contours, is_index=False), _path_of(contours, is_index=True)
        if not contours:
            return
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        painter.setTransform(viewport.transform(), combine=True)
        for is_edge in (True, False):
            for path, wide in zip(self._paths, (_LINE_PX, _INDEX_PX), strict=True):
                pen = QPen(_EDGE if is_edge else _LINE, wide + (_EDGE_MORE_PX if is_edge else 0.0))
                pen.setCosmetic(True)
                painter.setPen(pen)
                painter.drawPath(path)
        painter.restore()


def _path_of(contours: tuple[LevelLine, ...], *, is_index: bool) -> QPainterPath:
    path = QPainterPath()
    for contour in contours:
        if contour.is_index is is_index and len(contour.xyz) > 1:
            positions = np.asarray(on_plan(contour.xyz)).tolist()
            path.moveTo(*positions[0])
            for position in positions[1:]:
                path.lineTo(*position)
    return path


def _digits_of(value: float) -> int:
    """Digits behind the point that tell a limit exactly: two at least, at most four."""
    return next((count for count in (2, 3) if abs(round(value, count) - value) < 1e-9), 4)


def _write(painter: QPainter, at: QRectF, words: str) -> None:
    painter.drawText(at, int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft), words)
