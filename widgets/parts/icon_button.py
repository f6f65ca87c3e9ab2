"""IconButton: a small button with a sign of the icon set, in the colour of text."""

from __future__ import annotations

import qtawesome
from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QPalette
from PySide6.QtWidgets import QToolButton, QWidget
from typing_extensions import override

_SIGN_PX = 18


class IconButton(QToolButton):
    """Says in its tool tip what it does; it never takes the keys from the view beside it.

    Parameters
    ----------
    sign : str
        Of qtawesome, such as ``"mdi6.pin-outline"``.
    name : str
        Its name, the first line of the tool tip.
    tip : str
        What it does.
    is_switch : bool
        Whether it stays down.
    """

    def __init__(
        self, sign: str, name: str, tip: str, parent: QWidget, *, is_switch: bool = False
    ) -> None:
        super().__init__(parent)
        self._sign = sign
        self.setAutoRaise(True)
        self.setCheckable(is_switch)
        self.setIconSize(QSize(_SIGN_PX, _SIGN_PX))
        self.setAccessibleName(name)
        self.setToolTip(f"{name}\n{tip}")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._colour()

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._colour()

    def _colour(self) -> None:
        role, groups = QPalette.ColorRole.WindowText, QPalette.ColorGroup
        self.setIcon(
            qtawesome.icon(
                self._sign,
                color=self.palette().color(groups.Active, role),
                color_disabled=self.palette().color(groups.Disabled, role),
            )
        )
