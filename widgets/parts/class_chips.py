"""ClassChips: the classes painted most, each a click away while a paint tool is in the hand."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QHBoxLayout, QMenu, QToolButton, QWidget

from processing.core.text import Language
from processing.labels.rules import PaintRule
from processing.recording.columns.classes import class_key, point_classes
from widgets.feature_drawing.swatch import SWATCH_PX, swatch_of
from widgets.shared.label_palette import LabelPalette

INTERACTIVE = (2, 1, 7, 18)
"""Ground, what stands on it, and noise below and above: what corrections are made with."""


class ClassChips(QWidget):
    """A button for each class at hand, a list of the others, and one for the class on the brush.

    Parameters
    ----------
    palette : LabelPalette
        What the buttons show and change.
    """

    def __init__(
        self, palette: LabelPalette, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._palette = palette
        self._language: Language = language
        self._chips: dict[int, QToolButton] = {}
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        for one in point_classes():
            if one.code:
                self._chips[one.code] = self._chip(
                    one.code, one.colour, one.name.in_language(language)
                )
        others = [code for code in self._chips if code not in INTERACTIVE]
        for code in (*INTERACTIVE, *others):
            layout.addWidget(self._chips[code])
        layout.addWidget(self._list_of(others))
        palette.rule_changed.connect(self._on_palette_rule_changed)
        self._on_palette_rule_changed(palette.rule)

    def chip(self, code: int) -> QToolButton:
        """The button of a class; KeyError where the table has none."""
        return self._chips[code]

    def _chip(self, code: int, colour: str, name: str) -> QToolButton:
        chip = QToolButton(self)
        chip.setCheckable(True)
        chip.setAutoRaise(True)
        # The keys stay with the view that is painted in.
        chip.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        chip.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        chip.setIconSize(QSize(SWATCH_PX, SWATCH_PX))
        chip.setIcon(swatch_of(colour))
        chip.setText(name)
        key = class_key(code)
        words = self.tr("Paint this class")
        chip.setToolTip(f"{words} ({key})" if key else words)
        chip.clicked.connect(lambda: self._choose(code))
        return chip

    def _list_of(self, codes: Sequence[int]) -> QToolButton:
        """The button that opens a list of classes; streets have many that have no key."""
        button = QToolButton(self)
        button.setAutoRaise(True)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.setText(self.tr("More classes"))
        button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        menu = QMenu(button)
        for code in codes:
            chip = self._chips[code]
            action = menu.addAction(chip.icon(), chip.text())
            action.triggered.connect(chip.click)
        button.setMenu(menu)
        return button

    def _choose(self, code: int) -> None:
        self._palette.choose(code)
        self._on_palette_rule_changed(self._palette.rule)  # a second click leaves it pressed

    def _on_palette_rule_changed(self, rule: PaintRule) -> None:
        for code, chip in self._chips.items():
            chip.setChecked(code == rule.code)
            chip.setVisible(code in INTERACTIVE or code == rule.code)
