"""The image view's own part of the context menu."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QMenu, QWidget

from widgets.shared.orientation_menu import fill_orientation_menu
from widgets.shared.view_settings import ViewSettings


class ImageViewCommands(Protocol):
    """What the menu does with the view."""

    def show_everything(self) -> None:
        """Show all."""

    def show_one_to_one(self) -> None:
        """Show one pixel on one."""

    def center_on_selection(self) -> None:
        """Put what is chosen into the middle."""


def view_menu(parent: QWidget, view: ImageViewCommands, settings: ViewSettings) -> QMenu:
    """What one can look at, and which way; it goes when it was closed."""
    menu = QMenu(parent)
    menu.addAction(QCoreApplication.translate("ImageView", "Show everything"), view.show_everything)
    menu.addAction(
        QCoreApplication.translate("ImageView", "One pixel as one pixel"), view.show_one_to_one
    )
    menu.addAction(
        QCoreApplication.translate("ImageView", "Centre on the selection"), view.center_on_selection
    )
    menu.addSeparator()
    orientation = menu.addMenu(QCoreApplication.translate("ImageView", "Direction of the street"))
    fill_orientation_menu(orientation, settings)
    menu.aboutToHide.connect(menu.deleteLater)
    return menu
