"""The look: Fusion in light or dark, one accent colour, tabular digits."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QColor, QFont, QGuiApplication, QPalette
from PySide6.QtWidgets import QApplication

from app.settings.edged_style import EdgedStyle

_ACCENT = "#2f81c7"
_FONT_PX = 13

_Role = QPalette.ColorRole
_Group = QPalette.ColorGroup

_LIGHT: Mapping[QPalette.ColorRole, str] = {
    _Role.Window: "#f0f1f3",
    _Role.WindowText: "#1d2126",
    _Role.Base: "#ffffff",
    _Role.AlternateBase: "#f6f7f8",
    _Role.Text: "#1d2126",
    _Role.Button: "#e9ebee",
    _Role.ButtonText: "#1d2126",
    _Role.BrightText: "#ffffff",
    _Role.ToolTipBase: "#ffffff",
    _Role.ToolTipText: "#1d2126",
    _Role.PlaceholderText: "#616872",
    _Role.Light: "#ffffff",
    _Role.Midlight: "#dfe2e6",
    _Role.Mid: "#b6bcc4",
    _Role.Dark: "#9aa1aa",
    _Role.Shadow: "#6b737d",
    _Role.Link: "#1d6aab",
}
_LIGHT_DISABLED = "#9299a2"

_DARK: Mapping[QPalette.ColorRole, str] = {
    _Role.Window: "#292c31",
    _Role.WindowText: "#e3e6ea",
    _Role.Base: "#1e2125",
    _Role.AlternateBase: "#24272c",
    _Role.Text: "#e3e6ea",
    _Role.Button: "#353a41",
    _Role.ButtonText: "#e3e6ea",
    _Role.BrightText: "#ffffff",
    _Role.ToolTipBase: "#353a41",
    _Role.ToolTipText: "#e3e6ea",
    _Role.PlaceholderText: "#959ca5",
    _Role.Light: "#454b54",
    _Role.Midlight: "#3c4149",
    _Role.Mid: "#22252a",
    _Role.Dark: "#191b1f",
    _Role.Shadow: "#101215",
    _Role.Link: "#6cb2ee",
}
_DARK_DISABLED = "#757c85"


class ThemeChoice(Enum):
    """What the user wants the window to look like."""

    SYSTEM = "system"
    LIGHT = "light"
    DARK = "dark"


class Theme(QObject):
    """Dresses the application; with the system's choice it follows the system.

    Parameters
    ----------
    application : QApplication
    """

    def __init__(self, application: QApplication) -> None:
        super().__init__(application)
        self._application = application
        self._choice = ThemeChoice.SYSTEM
        application.setStyle(EdgedStyle())
        application.setFont(_font())
        application.styleHints().colorSchemeChanged.connect(self._dress)
        self._dress()

    @staticmethod
    def of(application: QApplication) -> Theme:
        """The one theme of an application, made when first asked for."""
        made = application.findChild(Theme)
        return made if isinstance(made, Theme) else Theme(application)

    @property
    def choice(self) -> ThemeChoice:
        """What was chosen last."""
        return self._choice

    @property
    def is_dark(self) -> bool:
        """Whether the look is dark now."""
        if self._choice is ThemeChoice.SYSTEM:
            return self._application.styleHints().colorScheme() == Qt.ColorScheme.Dark
        return self._choice is ThemeChoice.DARK

    def choose(self, choice: ThemeChoice) -> None:
        """Look like this from now on."""
        self._choice = choice
        hints = self._application.styleHints()
        # What the system draws, the frame of the window and its own forms, follows.
        if choice is ThemeChoice.SYSTEM:
            hints.unsetColorScheme()
        else:
            is_dark = choice is ThemeChoice.DARK
            hints.setColorScheme(Qt.ColorScheme.Dark if is_dark else Qt.ColorScheme.Light)
        self._dress()

    def _dress(self) -> None:
        palette = palette_of(is_dark=self.is_dark)
        if palette != QGuiApplication.palette():
            self._application.setPalette(palette)


def palette_of(*, is_dark: bool) -> QPalette:
    """All colours of the light or of the dark look."""
    colours, disabled = (_DARK, _DARK_DISABLED) if is_dark else (_LIGHT, _LIGHT_DISABLED)
    palette = QPalette()
    for role, colour in colours.items():
        palette.setColor(role, QColor(colour))
    for role in (_Role.Highlight, _Role.Accent):
        palette.setColor(role, QColor(_ACCENT))
    palette.setColor(_Role.HighlightedText, QColor("#ffffff"))
    for role in (_Role.WindowText, _Role.Text, _Role.ButtonText, _Role.HighlightedText):
        palette.setColor(_Group.Disabled, role, QColor(disabled))
    palette.setColor(_Group.Disabled, _Role.Highlight, QColor(colours[_Role.Midlight]))
    return palette


def _font() -> QFont:
    font = QFont()
    font.setFamilies(["Noto Sans", "Noto Sans CJK JP", "Yu Gothic UI", "Hiragino Sans"])
    font.setPixelSize(_FONT_PX)
    return font
