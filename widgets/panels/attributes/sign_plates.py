"""Pictures of legal road signs: plate, rim and what stands on it, or the number instead."""

from __future__ import annotations

import math
from functools import cache

from PySide6.QtCore import QByteArray, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QIcon, QPainter, QPainterPath, QPen, QPixmap, QPolygonF
from PySide6.QtSvg import QSvgRenderer

from processing.map.sign_numbers import SignNumber
from resources import path_of

PICTURE_PX = 40
"""Side of a picture: what stands on a plate is told from its neighbours."""

_SHARP = 2.0
"""Pixels of a picture per pixel of a plain screen: sharp on fine ones."""

# Of the order's safety colours (標識令, 別表第二, 備考), as screens show them.
_COLOURS = {
    "blue": QColor("#0068b7"),
    "green": QColor("#00913a"),
    "yellow": QColor("#ffd800"),
    "red": QColor("#d7000f"),
    "white": QColor("#ffffff"),
    "black": QColor("#111111"),
}
_EDGE = QColor("#2b2f36")
_INK = {"yellow": "black", "white": "black"}
_SIDE = 100.0
"""Of the square about a plate, in which drawings are."""

_RIM = {"red": 10.0, "black": 3.0, "white": 2.0, "blue": 2.0}
"""Widths of rims: a tenth of the diameter of red ones (標識令, 別表第二)."""

_RECTANGLES_HIGH = 0.6
"""Height over width of a rectangle in pictures."""


@cache
def sign_picture(sign: SignNumber, shape: str) -> QIcon:
    """A sign on a plate of a shape that it has; the same in rows that are chosen."""
    picture = _blank()
    with QPainter(picture) as painter:
        _paint_plate(painter, shape, sign.colour, sign.rim)
        if not _paint_face(painter, sign.number):
            _paint_number(painter, sign, shape)
    return _icon(picture)


def plate_picture(shape: str, colour: str) -> QIcon:
    """A bare plate; the same in rows that are chosen, where the style would tint it."""
    picture = _blank()
    with QPainter(picture) as painter:
        _paint_plate(painter, shape, colour, None)
    return _icon(picture)


def _blank() -> QPixmap:
    side = round(PICTURE_PX * _SHARP)
    picture = QPixmap(side, side)
    picture.fill(Qt.GlobalColor.transparent)
    return picture


def _icon(picture: QPixmap) -> QIcon:
    picture.setDevicePixelRatio(_SHARP)
    icon = QIcon(picture)
    icon.addPixmap(picture, QIcon.Mode.Selected)
    icon.addPixmap(picture, QIcon.Mode.Active)
    return icon


def _paint_plate(painter: QPainter, shape: str, colour: str, rim: str | None) -> None:
    """A plate over the whole picture; afterwards the painter works in the square about it."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    side = round(PICTURE_PX * _SHARP)
    painter.scale(side / _SIDE, side / _SIDE)
    path = _outline(shape)
    painter.fillPath(path, _COLOURS[colour])
    if rim is not None:
        painter.save()
        painter.setClipPath(path)
        # Half of a pen's width lies outside of the plate.
        painter.strokePath(path, QPen(_COLOURS[rim], 2 * _RIM[rim]))
        painter.restore()
    painter.strokePath(path, QPen(_EDGE, 2.0))


def _outline(shape: str) -> QPainterPath:
    """A plate in the square about it; a square where the shape has no own."""
    inner = QRectF(2, 2, _SIDE - 4, _SIDE - 4)
    path = QPainterPath()
    if shape == "circle":
        path.addEllipse(inner)
        return path
    left, right, top, bottom = inner.left(), inner.right(), inner.top(), inner.bottom()
    middle, off = inner.center(), inner.height() * (1 - _RECTANGLES_HIGH) / 2
    eaves = top + inner.height() / 3
    corners = {
        "triangle": [
            (left, top),
            (right, top),
            (middle.x(), top + inner.width() * math.sqrt(3) / 2),
        ],
        "diamond": [(middle.x(), top), (right, middle.y()), (middle.x(), bottom),
                    (left, middle.y())],
        "pentagon": [(middle.x(), top), (right, eaves), (right, bottom), (left, bottom),
                     (left, eaves)],
        "rectangle": [(left, top + off), (right, top + off), (right, bottom - off),
                      (left, bottom - off)],
    }.get(shape, [(left, top), (right, top), (right, bottom), (left, bottom)])  # fmt: skip
    path.addPolygon(QPolygonF([QPointF(x, y) for x, y in corners]))
    path.closeSubpath()
    return path


def _paint_face(painter: QPainter, number: str) -> bool:
    """What stands on a sign; says whether it is drawn."""
    faces, id_ = _faces(), "n" + number.replace("の", "-")
    if not faces.elementExists(id_):
        return False
    faces.render(painter, id_, faces.boundsOnElement(id_))
    return True


@cache
def _faces() -> QSvgRenderer:
    return QSvgRenderer(QByteArray(path_of("catalogue/sign_faces.svg").read_bytes()))


def _paint_number(painter: QPainter, sign: SignNumber, shape: str) -> None:
    font = QFont(painter.font())
    font.setBold(True)
    font.setPixelSize(30 if len(sign.number) <= 3 else 22)
    painter.setFont(font)
    painter.setPen(_COLOURS[_INK.get(sign.colour, "white")])
    room = QRectF(0, 0, _SIDE, 0.7 * _SIDE if shape == "triangle" else _SIDE)
    painter.drawText(room, int(Qt.AlignmentFlag.AlignCenter), sign.number)
