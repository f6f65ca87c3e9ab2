"""The choices of how the street runs in an image, for any menu."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu

from widgets.shared.image_lay import ImageLay
from widgets.shared.view_settings import ViewSettings


def fill_lay_menu(menu: QMenu, settings: ViewSettings) -> None:
    """Add the choices to a menu, marked as they are now."""
    lay = settings.image_lay
    horizontal = QCoreApplication.translate("ImageLay", "Street from left to right")
    vertical = QCoreApplication.translate("ImageLay", "Street upwards")
    ways = QActionGroup(menu)
    _add(menu, settings, horizontal, replace(lay, is_vertical=False), is_set=not lay.is_vertical)
    _add(menu, settings, vertical, replace(lay, is_vertical=True), is_set=lay.is_vertical)
    for way in menu.actions()[-2:]:
        ways.addAction(way)
    menu.addSeparator()
    is_mirrored, is_reversed = lay.is_mirrored_across, lay.is_reversed_along
    mirrored = QCoreApplication.translate("ImageLay", "Exchange left and right sides")
    other = replace(lay, is_mirrored_across=not is_mirrored)
    _add(menu, settings, mirrored, other, is_set=is_mirrored)
    against = QCoreApplication.translate("ImageLay", "Against the direction of travel")
    _add(
        menu, settings, against, replace(lay, is_reversed_along=not is_reversed), is_set=is_reversed
    )


def _add(menu: QMenu, settings: ViewSettings, text: str, lay: ImageLay, *, is_set: bool) -> None:
    action = QAction(text, menu)
    action.setCheckable(True)
    action.setChecked(is_set)
    action.triggered.connect(lambda: settings.lay_image(lay))
    menu.addAction(action)
