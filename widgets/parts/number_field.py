"""NumberField: a number with its unit; what lies outside its limits can't be typed."""

from __future__ import annotations

import math

from PySide6.QtCore import QLocale, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QAbstractSpinBox, QDoubleSpinBox, QWidget
from typing_extensions import override

_MOST_DECIMALS = 9


class NumberField(QDoubleSpinBox):
    """A field for one number.

    Parameters
    ----------
    low, high : float
        Limits, both allowed.
    unit : str
        Shown behind the number.
    decimals : int
        Digits behind the point; 0 for counts.
    """

    def __init__(
        self,
        low: float,
        high: float,
        *,
        unit: str = "",
        decimals: int = 3,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setDecimals(decimals)
        self.setRange(low, high)
        self.setSingleStep(_step(low, high, decimals))
        self.setKeyboardTracking(False)
        self.setCorrectionMode(QAbstractSpinBox.CorrectionMode.CorrectToPreviousValue)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        if unit:
            self.setSuffix(unit if unit == "°" else f" {unit}")
        self.setAlignment(Qt.AlignmentFlag.AlignRight)

    @override
    def textFromValue(self, value: float) -> str:
        # No zeros that say nothing: 0.5, not 0.500.
        text = f"{value:.{self.decimals()}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        return text.replace(".", self.locale().decimalPoint())

    @override
    def wheelEvent(self, event: QWheelEvent) -> None:
        # A form that is scrolled must not change numbers on its way.
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()


def decimals_for(*values: float) -> int:
    """Digits behind the point by which all values can be written exactly, at least 3."""
    for decimals in range(3, _MOST_DECIMALS):
        if all(math.isclose(round(value, decimals), value, abs_tol=1e-12) for value in values):
            return decimals
    return _MOST_DECIMALS


def coordinate(value_m: float) -> str:
    """A coordinate as surveyors read it: ``−11,394.608``, with a dot in every language."""
    text = QLocale.c().toString(abs(value_m), "f", 3)
    whole, _, part = text.partition(".")
    digits = f"{int(whole.replace(',', '')):,}.{part}"
    return f"−{digits}" if value_m < 0 and digits.strip("0.,") else digits


def _step(low: float, high: float, decimals: int) -> float:
    if decimals == 0:
        return 1.0
    width = (high - low) / 100
    return max(10.0 ** math.floor(math.log10(width)), 10.0**-decimals) if width > 0 else 1.0
