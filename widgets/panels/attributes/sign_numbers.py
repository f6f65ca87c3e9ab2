"""The legal number of a sign, chosen among the plates of its shape, with a picture of each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import groupby

from PySide6.QtCore import QMargins, Qt, Signal
from PySide6.QtGui import QAction, QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import (
    QMenu,
    QWidget,
    QWidgetAction,
)
from typing_extensions import override

from processing.core.text import Language, Text
from processing.map.catalogue import Catalogue, FeatureKind
from processing.map.feature import AttributeValue, Feature
from processing.map.plate_colours import SIGN_COLOURS
from processing.map.sign_numbers import (
    FIELD,
    PlateLook,
    SignClass,
    SignNumber,
    is_kind_of_signs,
    kind_of_sign,
    offered_numbers,
    sign_numbers,
)
from widgets.panels.attributes.shared_values import common_value
from widgets.panels.attributes.sign_plates import PICTURE_PX, sign_picture

_CLASS_FIELD = "sign_class"
_CLASS_NAMES: Mapping[SignClass, Text] = {
    "guide": Text("Guide signs", "案内標識"),
    "warning": Text("Warning signs", "警戒標識"),
    "regulation": Text("Regulatory signs", "規制標識"),
    "instruction": Text("Instruction signs", "指示標識"),
    "supplement": Text("Supplementary plates", "補助標識"),
}

_MORE = Text("Other colours and sizes", "他の色・寸法")
_OTHERS = Text("Other shapes", "他の形")
_FLAT = 30
"""So many entries fit a menu of a small screen; more are listed by the classes of signs."""

_LARGE_PICTURES = f"""
QMenu {{ icon-size: {PICTURE_PX}px; }}
QMenu::item {{ padding: 2px 24px 2px 8px; }}
QMenu::item:selected {{ background: palette(highlight); color: palette(highlighted-text); }}
"""
"""Pictures are as large as they were painted only where items have a rule of their own."""

_PICTURE_PX = 150
"""Side of the picture of the sign itself, above the candidates."""


class _Photo(QWidget):
    """A picture in its own colours though it can't be chosen."""

    def __init__(self, photo: QPixmap, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("photo")
        aspect, mode = (
            Qt.AspectRatioMode.KeepAspectRatio,
            Qt.TransformationMode.SmoothTransformation,
        )
        self._photo = photo.scaled(_PICTURE_PX, _PICTURE_PX, aspect, mode)
        self.setMinimumSize(self._photo.size().grownBy(QMargins(4, 4, 4, 4)))

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        place = self._photo.rect()
        place.moveCenter(self.rect().center())
        with QPainter(self) as painter:
            painter.drawPixmap(place.topLeft(), self._photo)


class SignNumberMenu(QMenu):
    """The signs that plates of the chosen features may be, those that look like them first.

    Parameters
    ----------
    features : tuple of Feature
        Their shape, size and colour, and whether they hang below others, say what is offered; all
        signs where shapes differ or aren't known.
    language : Language
    photo : QPixmap or None
        What the sign looks like, shown above what is offered.

    Signals
    -------
    number_chosen(number: str)
    """

    number_chosen = Signal(str)

    def __init__(
        self,
        features: tuple[Feature, ...],
        language: Language,
        parent: QWidget | None = None,
        *,
        photo: QPixmap | None = None,
    ) -> None:
        super().__init__(parent)
        self._language = language
        self.setStyleSheet(_LARGE_PICTURES)
        look = look_of(features)
        offered = offered_numbers(look)
        if photo is not None and not photo.isNull():
            self._show_photo(photo)
        self._fill(self, offered.likely, look.shape)
        for title, signs in ((_MORE, offered.unlikely), (_OTHERS, offered.others)):
            if signs:
                self._fill(self._menu(self, title), signs, look.shape)

    def _show_photo(self, photo: QPixmap) -> None:
        row = QWidgetAction(self)
        row.setDefaultWidget(_Photo(photo, self))
        row.setEnabled(False)  # keys begin at the first candidate
        self.addAction(row)
        self.addSeparator()

    def _menu(self, above: QMenu, title: Text) -> QMenu:
        return above.addMenu(title.in_language(self._language))

    def _fill(self, menu: QMenu, signs: Sequence[SignNumber], shape: str) -> None:
        """Signs by their classes, in menus of their own where they are many."""
        for sign_class, group in groupby(signs, lambda one: one.sign_class):
            title = _CLASS_NAMES[sign_class]
            if len(signs) > _FLAT:
                self._add_signs(self._menu(menu, title), [*group], shape)
            else:
                menu.addSection(title.in_language(self._language))
                self._add_signs(menu, [*group], shape)

    def _add_signs(self, menu: QMenu, signs: Sequence[SignNumber], shape: str) -> None:
        for one in signs:
            picture = sign_picture(one, shape if shape in one.shapes else one.shapes[0])
            words = f"{one.number}  {one.name.in_language(self._language)}"
            action = QAction(picture, words.replace("&", "&&"), menu)
            action.setIconVisibleInMenu(True)
            action.triggered.connect(lambda _=False, n=one.number: self.number_chosen.emit(n))
            menu.addAction(action)


def look_of(features: tuple[Feature, ...]) -> PlateLook:
    """What the chosen features have in common of what tells legal signs apart."""
    shape, below, size, colour = (
        common_value(features, lambda one, id_=id_: one.attributes.get(id_))  # type: ignore[misc]
        for id_ in ("shape", "supplementary", "size_m", "colour")
    )
    return PlateLook(
        shape if isinstance(shape, str) else "",
        is_supplement=below is True,
        size_m=float(size) if isinstance(size, int | float) else math.nan,
        colour=next((one for one in SIGN_COLOURS if one == colour), None),
    )


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
