"""EdgedStyle: Fusion whose edges are seen on dark ground, and whose labels show text as it is."""

from __future__ import annotations

import qtawesome
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPalette, QPen
from PySide6.QtWidgets import QApplication, QLabel, QProxyStyle, QStyle, QStyleOption, QWidget
from typing_extensions import override

_GREY = "#808790"
"""Reads on the light and on the dark ground: icons of docks don't ask for it again."""

_DOCK_ICONS = {
    QStyle.StandardPixmap.SP_TitleBarCloseButton: "mdi6.close",
    QStyle.StandardPixmap.SP_TitleBarNormalButton: "mdi6.dock-window",
}
_DARKEST_LIGHT = 128
_RADIUS_PX = 2.0


class EdgedStyle(QProxyStyle):
    """Draws an edge where Fusion makes one darker than the ground, which shows on light only.

    No label takes its text for HTML, neither in tooltips nor in message boxes: names and values
    come from files that anybody may have made, and HTML can fetch a file from another computer.
    """

    def __init__(self) -> None:
        super().__init__("Fusion")

    @override
    def polish(self, polished: QWidget | QApplication | QPalette | QColor | Qt.GlobalColor) -> None:
        # Every label comes by here before it is first measured, those that Qt makes as well.
        if isinstance(polished, QLabel):
            polished.setTextFormat(Qt.TextFormat.PlainText)
        super().polish(polished)

    @override
    def drawPrimitive(
        self,
        element: QStyle.PrimitiveElement,
        option: QStyleOption,
        painter: QPainter,
        widget: QWidget | None = None,
    ) -> None:
        super().drawPrimitive(element, option, painter, widget)
        is_box = element == QStyle.PrimitiveElement.PE_IndicatorCheckBox
        if not is_box and element != QStyle.PrimitiveElement.PE_FrameLineEdit:
            return
        if not is_box and option.state & QStyle.StateFlag.State_HasFocus:
            return  # the accent is its edge
        if option.palette.color(QPalette.ColorRole.Window).lightness() > _DARKEST_LIGHT:
            return
        role = QPalette.ColorRole.PlaceholderText if is_box else QPalette.ColorRole.Light
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(option.palette.color(role), 1.0))
        edge = QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.drawRoundedRect(edge, _RADIUS_PX, _RADIUS_PX)
        painter.restore()

    @override
    def standardIcon(
        self,
        standardIcon: QStyle.StandardPixmap,
        option: QStyleOption | None = None,
        widget: QWidget | None = None,
    ) -> QIcon:
        name = _DOCK_ICONS.get(standardIcon)
        if name is None:
            return super().standardIcon(standardIcon, option, widget)
        icon: QIcon = qtawesome.icon(name, color=_GREY)
        return icon
