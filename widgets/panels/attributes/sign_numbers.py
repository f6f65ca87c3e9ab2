"""The legal number of a sign, chosen among the plates of its shape, with a picture of each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import groupby

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QAction, QColor, QIcon, QPainter, QPen, QPixmap, QPolygonF
from PySide6.QtWidgets import QMenu, QWidget

from processing.core.text import Language, Text
from processing.map.catalogue import Catalogue, FeatureKind
from processing.map.feature import AttributeValue, Feature
from processing.map.sign_numbers import (
    FIELD,
    SignClass,
    SignNumber,
    is_kind_of_signs,
    kind_of_sign,
    numbers_for,
    sign_numbers,
)
from widgets.panels.attributes.shared_values import common_value

_CLASS_FIELD = "sign_class"
_CLASS_NAMES: Mapping[SignClass, Text] = {
    "guide": Text("Guide signs", "案内標識"),
    "warning": Text("Warning signs", "警戒標識"),
    "regulation": Text("Regulatory signs", "規制標識"),
    "instruction": Text("Instruction signs", "指示標識"),
    "supplement": Text("Supplementary plates", "補助標識"),
}

# Of the order's safety colours (標識令, 別表第二, 備考), as screens show them.
_GROUNDS = {
    "blue": QColor("#0068b7"),
    "green": QColor("#00913a"),
    "yellow": QColor("#ffd800"),
    "red": QColor("#d7000f"),
    "white": QColor("#ffffff"),
}
_RIM = QColor("#2b2f36")
_PICTURE_PX = 24
_FLAT = 30
"""So many entries fit a menu of a small screen; more are listed by the classes of signs."""


class SignNumberMenu(QMenu):
    """The signs that plates of the chosen features' shape may be.

    Parameters
    ----------
    features : tuple of Feature
        Their shape, and whether they hang below others, say what is offered; all signs where
        shapes differ or aren't known.
    language : Language

    Signals
    -------
    number_chosen(number: str)
    """

    number_chosen = Signal(str)

    def __init__(
        self, features: tuple[Feature, ...], language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._language = language
        shape = common_value(features, lambda one: one.attributes.get("shape"))
        below = common_value(features, lambda one: one.attributes.get("supplementary"))
        known = shape if isinstance(shape, str) else ""
        offered = numbers_for(known, is_supplement=below is True) if known else sign_numbers()
        groups = [
            (sign_class, [*group])
            for sign_class, group in groupby(offered, lambda one: one.sign_class)
        ]
        for sign_class, group in groups:
            title = _CLASS_NAMES[sign_class].in_language(language)
            menu = self if len(offered) <= _FLAT else self.addMenu(title)
            if menu is self:
                menu.addSection(title)
            self._fill(menu, group, known)

    def _fill(self, menu: QMenu, group: Sequence[SignNumber], shape: str) -> None:
        for one in group:
            picture = plate_picture(shape or one.shapes[0], one.colour)
            words = f"{one.number}  {one.name.in_language(self._language)}"
            action = QAction(picture, words.replace("&", "&&"), menu)
            action.setIconVisibleInMenu(True)
            action.triggered.connect(lambda _=False, n=one.number: self.number_chosen.emit(n))
            menu.addAction(action)


def implied_values(
    features: Sequence[Feature], catalogue: Catalogue, id_: str, value: AttributeValue
) -> dict[str, AttributeValue]:
    """What a sign's number says besides: its class, where all kinds of the features ask for it."""
    found = _sign_of(id_, value)
    if found is None:
        return {}
    kinds = [catalogue[one.kind] for one in features if one.kind in catalogue]
    fields = [kind.attribute(_CLASS_FIELD) for kind in kinds]
    is_asked = all(one is not None and found.sign_class in one.choices for one in fields)
    return {_CLASS_FIELD: found.sign_class} if is_asked else {}


def implied_kind(
    features: Sequence[Feature], catalogue: Catalogue, id_: str, value: AttributeValue
) -> FeatureKind | None:
    """The kind with the official code that a sign's number says; None where it says none."""
    found = _sign_of(id_, value)
    kinds = [catalogue[one.kind] for one in features if one.kind in catalogue]
    if found is None or len(kinds) < len(features) or not all(map(is_kind_of_signs, kinds)):
        return None
    return kind_of_sign(found.sign_class, catalogue)


def _sign_of(id_: str, value: AttributeValue) -> SignNumber | None:
    """The sign that a number written into an attribute means."""
    return next((one for one in sign_numbers() if id_ == FIELD and one.number == value), None)


def plate_picture(shape: str, colour: str) -> QIcon:
    """A plate in its colour; the same in rows that are chosen, where the style would tint it."""
    picture = QPixmap(_PICTURE_PX, _PICTURE_PX)
    picture.fill(Qt.GlobalColor.transparent)
    with QPainter(picture) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        painter.setPen(QPen(_RIM, 1.5))
        painter.setBrush(_GROUNDS[colour])
        inner = QRectF(2, 2, _PICTURE_PX - 4, _PICTURE_PX - 4)
        if shape == "circle":
            painter.drawEllipse(inner)
        elif shape == "rectangle":
            painter.drawRect(inner.adjusted(0, 5, 0, -5))
        else:
            painter.drawPolygon(_outline(shape, inner))
    icon = QIcon(picture)
    icon.addPixmap(picture, QIcon.Mode.Selected)
    icon.addPixmap(picture, QIcon.Mode.Active)
    return icon


def _outline(shape: str, inner: QRectF) -> QPolygonF:
    """Corners of a plate; of a square where the shape has no own."""
    left, right, top, bottom = inner.left(), inner.right(), inner.top(), inner.bottom()
    middle = inner.center()
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
    }.get(shape, [(left, top), (right, top), (right, bottom), (left, bottom)])  # fmt: skip
    return QPolygonF([QPointF(x, y) for x, y in corners])
