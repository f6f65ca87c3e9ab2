"""What stands on a map besides the map: paths with stations, scale bar, north arrow, views."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from processing.core.arrays import Floats
from widgets.map_view.vehicle_path import VehiclePath
from widgets.plane_view.line_pieces import as_lines, clip_pieces
from widgets.plane_view.viewport import PlaneViewport

_INK = QColor("#eef2f6")
_SHADOW = QColor(11, 13, 16)
_PLATE = QColor(16, 18, 22, 190)
_WAY = QColor("#d7c4ff")
_VIEW = QColor("#f0e442")
_SLAB = QColor("#56b4e9")

_MARGIN_PX = 12.0
_MOST_BAR_PX = 160.0
_STATION_PX = 110.0
_MOST_STATIONS = 100_000
_TICK_PX, _ARROW_PX = 5.0, 6.0
_NORTH_PX = 34.0


def round_step(least: float) -> float:
    """The smallest of 1, 2, 5, 10, 20 … that is no less."""
    ten = 10.0 ** math.floor(math.log10(least))
    return next(step * ten for step in (1.0, 2.0, 5.0, 10.0) if step * ten >= least * (1 - 1e-9))


def round_down(most: float) -> float:
    """The largest of 1, 2, 5, 10, 20 … that is no more."""
    ten = 10.0 ** math.floor(math.log10(most))
    return next(step * ten for step in (5.0, 2.0, 1.0) if step * ten <= most * (1 + 1e-9))


def metres(length_m: float) -> str:
    """A round length with its unit: 5 km, 200 m, 0.5 m, 2 cm."""
    for unit, size in (("km", 1000.0), ("m", 0.1), ("cm", 0.01), ("mm", 0.0)):
        if length_m >= size * (1 - 1e-9):
            in_metres = {"km": 1e-3, "m": 1.0, "cm": 100.0, "mm": 1000.0}[unit]
            return f"{length_m * in_metres:g} {unit}"
    return ""


def paint_vehicle_paths(
    painter: QPainter, viewport: PlaneViewport, vehicle_paths: Iterable[VehiclePath]
) -> None:
    """Paint paths; ticks stand at round stations, arrowheads between them show the direction."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    low = np.full(2, -_MARGIN_PX)
    high = np.array([viewport.width, viewport.height]) + _MARGIN_PX
    for vehicle_path in vehicle_paths:
        pixels = _thin_path(viewport.to_screen(vehicle_path.positions))
        pieces, _, _ = clip_pieces(np.stack([pixels[:-1], pixels[1:]], axis=1), low, high)
        lines = as_lines(pieces)
        for colour, width in ((_SHADOW, 4.0), (_WAY, 1.5)):
            pen = QPen(colour, width)
            pen.setCapStyle(Qt.PenCapStyle.RoundCap)
            painter.setPen(pen)
            painter.drawLines(lines)
        _paint_stations(painter, viewport, vehicle_path)


def paint_scale_bar(painter: QPainter, viewport: PlaneViewport) -> None:
    """A bar of a round length at the lower left."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=False)
    length_m = round_down(_MOST_BAR_PX / viewport.scale)
    wide = length_m * viewport.scale
    text = metres(length_m)
    metrics = QFontMetricsF(painter.font())
    high = metrics.height() + 12.0
    plate_wide = max(wide, metrics.horizontalAdvance(text)) + 16.0
    plate = QRectF(8, viewport.height - high - 8, plate_wide, high)
    painter.fillRect(plate, _PLATE)
    left, base = plate.left() + 8.0, plate.bottom() - 5.0
    painter.setPen(QPen(_INK, 1.0))
    painter.drawLines(
        [
            QLineF(left, base, left + wide, base),
            QLineF(left, base - 4, left, base),
            QLineF(left + wide, base - 4, left + wide, base),
        ]
    )
    label = QRectF(plate.left(), plate.top() + 1, plate_wide, metrics.height())
    painter.drawText(label, int(Qt.AlignmentFlag.AlignCenter), text)


def paint_north(painter: QPainter, viewport: PlaneViewport) -> None:
    """An arrow to the grid's north at the upper right."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    metrics = QFontMetricsF(painter.font())
    high = _NORTH_PX + metrics.height() + 4.0
    plate = QRectF(viewport.width - 36.0, 8.0, 28.0, high)
    painter.fillRect(plate, _PLATE)
    middle, top = plate.center().x(), plate.top() + metrics.height()
    bottom = top + _NORTH_PX
    painter.setPen(_INK)
    label = QRectF(plate.left(), plate.top() + 1, plate.width(), metrics.height())
    painter.drawText(label, int(Qt.AlignmentFlag.AlignCenter), "N")
    tip, notch = QPointF(middle, top), QPointF(middle, bottom - 8.0)
    painter.setPen(QPen(_INK, 1.0))
    painter.setBrush(_INK)
    painter.drawPolygon(QPolygonF([tip, QPointF(middle + 7.0, bottom), notch]))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolygon(QPolygonF([tip, QPointF(middle - 7.0, bottom), notch]))


def paint_fields_of_view(
    painter: QPainter, viewport: PlaneViewport, polygons: Sequence[Floats], best: int
) -> None:
    """Paint what images see: outlines, the best one filled and last.

    Parameters
    ----------
    polygons : sequence of (n, 2) float64
        On the plane.
    best : int
        Which of them; −1 for none.
    """
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for number in sorted(range(len(polygons)), key=lambda number: number == best):
        pixels = viewport.to_screen(polygons[number])
        window = QPolygonF(QRectF(-50, -50, viewport.width + 100, viewport.height + 100))
        outline = QPolygonF([QPointF(x, y) for x, y in pixels.tolist()]).intersected(window)
        is_best = number == best
        fill = QColor(_VIEW)
        fill.setAlpha(46 if is_best else 0)
        painter.setBrush(fill)
        line = QColor(_VIEW)
        line.setAlpha(255 if is_best else 110)
        painter.setPen(QPen(line, 1.75 if is_best else 1.0))
        painter.drawPolygon(outline)
    painter.setBrush(Qt.BrushStyle.NoBrush)


def paint_slab(painter: QPainter, viewport: PlaneViewport, corners: Floats) -> None:
    """Paint where the section cuts: the slab's outline, and its plane.

    Parameters
    ----------
    corners : (4, 2) float64
        Of the slab on the plane, one after the other.
    """
    pixels = viewport.to_screen(corners)
    middles = (pixels[[0, 1]] + pixels[[3, 2]]) / 2
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    outline = QPolygonF([QPointF(x, y) for x, y in pixels.tolist()])
    plane = QLineF(QPointF(*middles[0].tolist()), QPointF(*middles[1].tolist()))
    for colour, wider in ((_SHADOW, 2.0), (_SLAB, 0.0)):
        painter.setPen(QPen(colour, 1.0 + wider))
        painter.drawPolygon(outline)
        painter.setPen(QPen(colour, 1.75 + wider))
        painter.drawLine(plane)


def _thin_path(pixels: Floats) -> Floats:
    """A path of kilometres has more places than the window has pixels."""
    whole = np.rint(pixels)
    moves = (np.diff(whole, axis=0) != 0).any(axis=1)
    thinned: Floats = pixels[np.concatenate([[True], moves])]
    return thinned


def _paint_stations(painter: QPainter, viewport: PlaneViewport, vehicle_path: VehiclePath) -> None:
    step_m = round_step(_STATION_PX / viewport.scale)
    first, last = vehicle_path.ends
    if (last - first) / step_m > _MOST_STATIONS:
        return
    stations = np.arange(np.ceil(first / step_m), np.floor(last / step_m) + 1) * step_m
    between = np.arange(np.ceil(first / step_m - 0.5), last / step_m - 0.5) * step_m + step_m / 2
    over_m = max(2.0 / viewport.scale, 0.5)
    for at, is_tick in ((between, False), (stations, True)):
        spots = viewport.to_screen(vehicle_path.at(at))
        vehicle_paths = vehicle_path.directions(at, over_m)
        inside = ((spots > -20) & (spots < [viewport.width + 20, viewport.height + 20])).all(axis=1)
        for number in np.flatnonzero(inside).tolist():
            if is_tick:
                text = f"{stations[number]:g} m"
                _paint_tick(painter, spots[number], vehicle_paths[number], text)
            else:
                _paint_arrow(painter, spots[number], vehicle_paths[number])


def _paint_tick(painter: QPainter, spot: Floats, vehicle_path: Floats, text: str) -> None:
    across = np.array([-vehicle_path[1], vehicle_path[0]])
    ends = [*(spot - _TICK_PX * across).tolist(), *(spot + _TICK_PX * across).tolist()]
    for colour, width in ((_SHADOW, 4.0), (_WAY, 1.5)):
        painter.setPen(QPen(colour, width))
        painter.drawLine(QLineF(*ends))
    metrics = QFontMetricsF(painter.font())
    wide, high = metrics.horizontalAdvance(text) + 6.0, metrics.height()
    # Beside the path, on the right of who drives it.
    away = _TICK_PX + 3.0 + (abs(across[0]) * wide + abs(across[1]) * high) / 2
    middle = spot + across * away
    plate = QRectF(middle[0] - wide / 2, middle[1] - high / 2, wide, high)
    painter.fillRect(plate, _PLATE)
    painter.setPen(_WAY)
    painter.drawText(plate, int(Qt.AlignmentFlag.AlignCenter), text)


def _paint_arrow(painter: QPainter, spot: Floats, vehicle_path: Floats) -> None:
    across = np.array([-vehicle_path[1], vehicle_path[0]])
    tip = spot + _ARROW_PX * vehicle_path
    wings = [spot - _ARROW_PX * vehicle_path + side * 0.75 * _ARROW_PX * across for side in (1, -1)]
    head = QPolygonF([QPointF(*corner.tolist()) for corner in (tip, *wings)])
    painter.setPen(QPen(_SHADOW, 2.5))
    painter.setBrush(_WAY)
    painter.drawPolygon(head)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawPolygon(head)
    painter.setBrush(Qt.BrushStyle.NoBrush)
