"""The 3D view's own part of the context menu."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QMenu, QWidget


class Looking(Protocol):
    """What the menu does with the view."""

    def look_along_drive(self) -> None:
        """Look along the drive."""

    def look_from_above(self) -> None:
        """Look straight down."""

    def show_everything(self) -> None:
        """Show all."""

    def center_on_selection(self) -> None:
        """Put what is chosen into the middle."""

    def set_shading(self, *, is_on: bool) -> None:
        """Turn eye-dome lighting on or off."""


def view_menu(parent: QWidget, view: Looking, *, is_shading_wanted: bool) -> QMenu:
    """From where one can look; it goes when it was closed."""

    def shade(is_on: bool) -> None:  # noqa: FBT001 - Qt's signal
        view.set_shading(is_on=is_on)

    menu = QMenu(parent)
    menu.addAction(
        QCoreApplication.translate("SceneView", "Along the drive"), view.look_along_drive
    )
    menu.addAction(QCoreApplication.translate("SceneView", "From above"), view.look_from_above)
    menu.addAction(QCoreApplication.translate("SceneView", "Show everything"), view.show_everything)
    menu.addAction(
        QCoreApplication.translate("SceneView", "Centre on the selection"), view.center_on_selection
    )
    menu.addSeparator()
    shading = menu.addAction(
        QCoreApplication.translate("SceneView", "Shade by depth (eye-dome lighting)")
    )
    shading.setCheckable(True)
    shading.setChecked(is_shading_wanted)
    shading.toggled.connect(shade)
    menu.aboutToHide.connect(menu.deleteLater)
    return menu
