"""LabelPalette: the class that is painted, over what, and how broad the brush is."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from processing.labels.rules import PaintOver, PaintRule

LEAST_RADIUS_M, MOST_RADIUS_M = 0.02, 10.0
_STEP = 1.25
_FIRST_CODE = 2


class LabelPalette(QObject):
    """What the paint tools have on their brush; setting what is already set emits nothing."""

    rule_changed = Signal(object)  # PaintRule
    radius_changed = Signal(float)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._rule = PaintRule(_FIRST_CODE)
        self._radius_m = 0.3

    @property
    def rule(self) -> PaintRule:
        """The class that is painted, and over which points."""
        return self._rule

    @property
    def radius_m(self) -> float:
        """Of the brush, in space."""
        return self._radius_m

    def choose(self, code: int) -> None:
        """Paint this class from now on; 0 takes labels away."""
        self._take(PaintRule(code, self._rule.over, self._rule.only))

    def paint_over(self, over: PaintOver, only: int = 0) -> None:
        """Paint only over these points from now on."""
        self._take(PaintRule(self._rule.code, over, only))

    def set_radius(self, radius_m: float) -> None:
        """Make the brush so broad, as far as it can be."""
        radius_m = min(max(radius_m, LEAST_RADIUS_M), MOST_RADIUS_M)
        if radius_m != self._radius_m:
            self._radius_m = radius_m
            self.radius_changed.emit(radius_m)

    def widen(self, notches: float) -> None:
        """Make the brush broader by so many notches, or narrower."""
        self.set_radius(round(self._radius_m * _STEP**notches, 3))

    def _take(self, rule: PaintRule) -> None:
        if rule != self._rule:
            self._rule = rule
            self.rule_changed.emit(rule)
