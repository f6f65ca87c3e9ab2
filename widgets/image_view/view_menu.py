"""The image view's own part of the context menu."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QMenu, QWidget

from widgets.shared.lay_menu import fill_lay_menu
from widgets.shared.view_settings import ViewSettings


class Looking(Protocol):
    """What the menu does with the view."""

    def show_everything(self) -> None:
        """Show all."""

    def show_one_to_one(self) -> None:
        """Show one pixel on one."""

    def center_on_selection(self) -> None:
        """Put what is chosen into the middle."""


def view_menu(parent: QWidget, view: Looking, settings: ViewSettings) -> QMenu:
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
    lay = menu.addMenu(QCoreApplication.translate("ImageView", "Direction of the street"))
    fill_lay_menu(lay, settings)
    menu.aboutToHide.connect(menu.deleteLater)
    return menu
