"""The image view's own part of the context menu."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QMenu, QWidget


def view_menu(
    view: QWidget,
    show_everything: Callable[[], None],
    show_one_to_one: Callable[[], None],
    center: Callable[[], None],
) -> QMenu:
    """What one can look at; it goes when it was closed."""
    menu = QMenu(view)
    menu.addAction(QCoreApplication.translate("ImageView", "Show everything"), show_everything)
    menu.addAction(
        QCoreApplication.translate("ImageView", "One pixel as one pixel"), show_one_to_one
    )
    menu.addAction(QCoreApplication.translate("ImageView", "Centre on the selection"), center)
    menu.aboutToHide.connect(menu.deleteLater)
    return menu
