"""MenuRequest: the right button in a view with nothing under way."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QMenu

from widgets.mouse_tools.mouse_tool import Hit


@dataclass(frozen=True)
class MenuRequest:
    """A menu that holds what the view itself offers; the window adds what can be done there.

    Attributes
    ----------
    where : QPoint
        Of the screen.
    hit : Hit
        What was under the mouse.
    """

    menu: QMenu
    where: QPoint
    hit: Hit
