"""Buttons of forms in words alone, where the style would give some of them icons."""

from __future__ import annotations

from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QDialogButtonBox


def remove_icons(buttons: QDialogButtonBox) -> None:
    """Take the icons off all buttons that are there."""
    for button in buttons.buttons():
        button.setIcon(QIcon())
