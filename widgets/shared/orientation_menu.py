"""The choices of how the street runs in an image, for any menu."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu

from widgets.shared.image_orientation import ImageOrientation
from widgets.shared.view_settings import ViewSettings


def fill_orientation_menu(menu: QMenu, settings: ViewSettings) -> None:
    """Add the choices to a menu, marked as they are now."""
    orientation = settings.image_orientation
    horizontal = QCoreApplication.translate("ImageOrientation", "Street from left to right")
    vertical = QCoreApplication.translate("ImageOrientation", "Street upwards")
    ways = QActionGroup(menu)
    _add(
        menu,
        settings,
        horizontal,
        replace(orientation, is_vertical=False),
        is_set=not orientation.is_vertical,
    )
    _add(
        menu,
        settings,
        vertical,
        replace(orientation, is_vertical=True),
        is_set=orientation.is_vertical,
    )
    for way in menu.actions()[-2:]:
        ways.addAction(way)
    menu.addSeparator()
    is_mirrored, is_reversed = orientation.is_mirrored_across, orientation.is_reversed_along
    mirrored = QCoreApplication.translate("ImageOrientation", "Exchange left and right sides")
    other = replace(orientation, is_mirrored_across=not is_mirrored)
    _add(menu, settings, mirrored, other, is_set=is_mirrored)
    against = QCoreApplication.translate("ImageOrientation", "Against the direction of travel")
    _add(
        menu,
        settings,
        against,
        replace(orientation, is_reversed_along=not is_reversed),
        is_set=is_reversed,
    )


def _add(
    menu: QMenu, settings: ViewSettings, text: str, orientation: ImageOrientation, *, is_set: bool
) -> None:
    action = QAction(text, menu)
    action.setCheckable(True)
    action.setChecked(is_set)
    action.triggered.connect(lambda: settings.orient_image(orientation))
    menu.addAction(action)
