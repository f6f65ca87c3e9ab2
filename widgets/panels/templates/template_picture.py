"""TemplatePicture: a small drawing of a template, its lines, and the points it was laid on."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QBrush, QColor, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget
from typing_extensions import override

from processing.map.catalogue import Catalogue
from processing.methods.templates.profile_template import (
    ProfilePoint,
    ProfileTemplate,
    TemplateProfile,
)

_MARGIN_PX = 24
_HEIGHT_PX = 160
_NEAR_PX = 12.0
_VERTEX_PX = 4.0
_BACKGROUND = QColor("#14161a")
_SHAPE = QColor("#f0f6fc")
_POINTS = QColor("#8b949e")
_EMPTY = QColor("#d55e00")
_OTHER = QColor("#c9d1d9")
_SCALES_M = (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)


class TemplatePicture(QWidget):
    """Shows one template; a click on a vertex marks it.

    Parameters
    ----------
    catalogue : Catalogue
        For the colours of the lines.

    Signals
    -------
    vertex_chosen(vertex: ProfilePoint)
    """

    vertex_chosen = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._catalogue: Catalogue | None = None
        self._template: ProfileTemplate | None = None
        self._marked: ProfilePoint = (0.0, 0.0)
        self._points: NDArray[np.float64] = np.empty((0, 2))
        self.setMinimumSize(160, _HEIGHT_PX)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.MinimumExpanding)
        self.setToolTip(self.tr("Click a vertex to say which line is made there"))

    @override
    def sizeHint(self) -> QSize:
        return QSize(240, _HEIGHT_PX)

    def use_catalogue(self, catalogue: Catalogue) -> None:
        """Take the colours of lines from here."""
        self._catalogue = catalogue
        self.update()

    def show_template(self, template: ProfileTemplate | None, marked: ProfilePoint) -> None:
        """Show a template with one of its vertices marked; None: nothing."""
        self._template, self._marked = template, marked
        self.update()

    def show_points(self, points: NDArray[np.float64]) -> None:
        """Show (n, 2) points in the template's axes behind it."""
        self._points = points
        self.update()

    def position_of(self, position: ProfilePoint) -> QPointF:
        """Where a place of the template is in the widget."""
        scale, middle = self._fit()
        return QPointF(
            self.width() / 2 + (position[0] - middle[0]) * scale,
            self.height() / 2 - (position[1] - middle[1]) * scale,
        )

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        template = self._template
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), _BACKGROUND)
            if template is None:
                return
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._paint_points(painter)
            self._paint_zones(painter, template)
            self._paint_shape(painter, template)
            self._paint_scale(painter)

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        if self._template is None or event.button() != Qt.MouseButton.LeftButton:
            return
        away = {
            vertex: math.dist(self.position_of(vertex).toTuple(), event.position().toTuple())
            for vertex in self._template.vertices
        }
        nearest = min(away, key=lambda vertex: away[vertex])
        if away[nearest] <= _NEAR_PX:
            self.vertex_chosen.emit(nearest)

    def _fit(self) -> tuple[float, tuple[float, float]]:
        """Pixels per metre, the same both ways, and the middle of the template."""
        if self._template is None:
            return 1.0, (0.0, 0.0)
        left, right, low, high = self._template.box
        wide, tall = max(right - left, 0.05), max(high - low, 0.05)
        scale = min((self.width() - 2 * _MARGIN_PX) / wide, (self.height() - 2 * _MARGIN_PX) / tall)
        return max(scale, 1.0), ((left + right) / 2, (low + high) / 2)

    def _polygon(self, profile: TemplateProfile) -> QPolygonF:
        return QPolygonF([self.position_of(position) for position in profile])

    def _paint_points(self, painter: QPainter) -> None:
        if not len(self._points):
            return
        scale, middle = self._fit()
        x = self.width() / 2 + (self._points[:, 0] - middle[0]) * scale
        y = self.height() / 2 - (self._points[:, 1] - middle[1]) * scale
        painter.setPen(QPen(_POINTS, 2.0))
        painter.drawPoints([QPointF(*spot) for spot in np.column_stack([x, y]).tolist()])

    def _paint_zones(self, painter: QPainter, template: ProfileTemplate) -> None:
        painter.setPen(QPen(_EMPTY, 1.5, Qt.PenStyle.DashLine))
        painter.setBrush(QBrush(_EMPTY, Qt.BrushStyle.BDiagPattern))
        for zone in template.empty:
            painter.drawPolygon(self._polygon(zone))
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _paint_shape(self, painter: QPainter, template: ProfileTemplate) -> None:
        scale, _ = self._fit()
        band = QColor(_SHAPE)
        band.setAlpha(40)
        wide = QPen(band, max(1.0, 2 * template.tolerance_m * scale))
        wide.setCapStyle(Qt.PenCapStyle.FlatCap)
        for pen in (wide, QPen(_SHAPE, 2.0)):
            painter.setPen(pen)
            for profile in template.shape:
                painter.drawPolyline(self._polygon(profile))
        for vertex in template.vertices:
            at = self.position_of(vertex)
            kind = template.kind_at(vertex)
            painter.setPen(QPen(_BACKGROUND, 1.0))
            painter.setBrush(self._colour(kind) if kind else _SHAPE)
            size = 1.5 * _VERTEX_PX if kind else 0.75 * _VERTEX_PX
            painter.drawEllipse(at, size, size)
            if vertex == self._marked:
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.setPen(QPen(_SHAPE, 1.5))
                half = 2.5 * _VERTEX_PX
                painter.drawRect(QRectF(at.x() - half, at.y() - half, 2 * half, 2 * half))

    def _paint_scale(self, painter: QPainter) -> None:
        """A bar of a round length in the corner."""
        scale, _ = self._fit()
        length_m = next((one for one in _SCALES_M if one * scale <= 80), _SCALES_M[-1])
        right, y = self.width() - 8.0, self.height() - 8.0
        left = right - length_m * scale
        painter.setPen(QPen(_OTHER, 1.0))
        for start, end in (
            (QPointF(left, y), QPointF(right, y)),
            (QPointF(left, y - 3), QPointF(left, y + 3)),
            (QPointF(right, y - 3), QPointF(right, y + 3)),
        ):
            painter.drawLine(start, end)
        words = f"{length_m:g} m" if length_m >= 1 else f"{100 * length_m:g} cm"
        painter.drawText(QRectF(right - 80, y - 20, 80, 16), Qt.AlignmentFlag.AlignRight, words)

    def _colour(self, kind: str) -> QColor:
        known = self._catalogue is not None and kind in self._catalogue
        return QColor(self._catalogue[kind].colour) if known and self._catalogue else _OTHER
