"""The look: Fusion, the system's light or dark, one accent colour, tabular digits."""

from __future__ import annotations

from PySide6.QtGui import QColor, QFont, QPalette
from PySide6.QtWidgets import QApplication

_ACCENT = "#2f81c7"
_FONT_PX = 13


def apply_theme(application: QApplication) -> None:
    """Dress the whole application."""
    application.setStyle("Fusion")
    font = QFont()
    font.setFamilies(["Noto Sans", "Noto Sans CJK JP", "Yu Gothic UI", "Hiragino Sans"])
    font.setPixelSize(_FONT_PX)
    application.setFont(font)
    palette = application.palette()
    for group in (QPalette.ColorGroup.Active, QPalette.ColorGroup.Inactive):
        palette.setColor(group, QPalette.ColorRole.Highlight, QColor(_ACCENT))
        palette.setColor(group, QPalette.ColorRole.HighlightedText, QColor("#ffffff"))
        palette.setColor(group, QPalette.ColorRole.Link, QColor(_ACCENT))
    application.setPalette(palette)
