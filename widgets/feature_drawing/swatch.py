"""Swatches: a kind's colour beside its name in lists, menus and buttons."""

from __future__ import annotations

from PySide6.QtGui import QColor, QIcon, QPixmap

SWATCH_PX = 12


def swatch_of(colour: str) -> QIcon:
    """A square in a colour; the same in rows that are chosen, where the style would tint it."""
    picture = QPixmap(SWATCH_PX, SWATCH_PX)
    picture.fill(QColor(colour))
    icon = QIcon(picture)
    icon.addPixmap(picture, QIcon.Mode.Selected)
    return icon
