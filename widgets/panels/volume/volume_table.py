"""VolumeTable: the numbers of a volume, how its epochs fit, and what a reader has to know."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from processing.core.text import Language
from processing.methods.earthwork.volumes.volume_result import Registration
from processing.project.volumes.volume import KeptVolume
from widgets.parts.change_words import format_difference

_MM = 1000.0


class VolumeTable(QWidget):
    """Cut, fill and net with their units, each number under the other.

    Parameters
    ----------
    language : Language

    Signals
    -------
    correction_requested()
        The later epoch is to be moved back, and all computed again.
    """

    correction_requested = Signal()

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language: Language = language
        self._values: dict[str, QLabel] = {}
        self._shift, self._notes = QLabel(self), QLabel(self)
        self._correct = QPushButton(self.tr("Correct and compute again"), self)
        self._correct.clicked.connect(self.correction_requested)
        for label in (self._shift, self._notes):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        grid = QGridLayout()
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(2)
        grid.setColumnStretch(1, 1)
        for number, (id_, name, unit) in enumerate(self._rows()):
            self._add_row(grid, number, (id_, name, unit))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addLayout(grid)
        layout.addWidget(self._shift)
        layout.addWidget(self._correct)
        layout.addWidget(self._notes)

    def value(self, id_: str) -> str:
        """What stands in a row; ids as in `Volumes`, without their units."""
        return self._values[id_].text()

    @property
    def notes(self) -> str:
        """What a reader has to know."""
        return self._notes.text()

    @property
    def shift(self) -> str:
        """How the epochs fit."""
        return self._shift.text()

    def show_volume(self, kept: KeptVolume) -> None:
        """Show these numbers."""
        volumes = kept.volumes
        values = {
            "cut": f"{volumes.cut_m3:,.1f}",
            "fill": f"{volumes.fill_m3:,.1f}",
            "net": format_difference(volumes.net_m3, 1),
            "uncertainty": f"± {volumes.uncertainty_m3:,.1f}",
            "area": f"{volumes.area_m2:,.1f}",
            "unmeasured": f"{volumes.unmeasured_area_m2:,.1f}",
            "left_out": f"{volumes.left_out_area_m2:,.1f}",
        }
        for id_, text in values.items():
            self._values[id_].setText(text)
        self._show_shift(kept.registration)
        notes = "\n".join(note.in_language(self._language) for note in kept.notes)
        self._notes.setText(notes)
        self._notes.setVisible(bool(notes))

    def _show_shift(self, shift: Registration | None) -> None:
        self._shift.setVisible(shift is not None)
        self._correct.setVisible(
            shift is not None and shift.is_significant and not shift.is_corrected
        )
        if shift is None:
            return
        east, north, up = (format_difference(value * _MM, 0) for value in shift.shift_m)
        words = self.tr("Shift of the epochs: E {east}, N {north}, H {up} mm")
        if shift.is_corrected:
            words = self.tr("Shift of the epochs: E {east}, N {north}, H {up} mm (corrected)")
        self._shift.setText(words.format(east=east, north=north, up=up))
        sure = max(shift.sure_m) * _MM
        tip = self.tr("From {area} m² of unchanged ground, each within {sure} mm")
        self._shift.setToolTip(
            tip.format(area=f"{shift.stable_area_m2:,.0f}", sure=f"{2 * sure:.1f}")
        )

    def _rows(self) -> tuple[tuple[str, str, str], ...]:
        return (
            ("cut", self.tr("Cut"), "m³"),
            ("fill", self.tr("Fill"), "m³"),
            ("net", self.tr("Net (fill less cut)"), "m³"),
            ("uncertainty", self.tr("Uncertainty (95 %)"), "m³"),
            ("area", self.tr("Area"), "m²"),
            ("unmeasured", self.tr("Not measured on a date"), "m²"),
            ("left_out", self.tr("Of it left out"), "m²"),
        )

    def _add_row(self, grid: QGridLayout, number: int, row: tuple[str, str, str]) -> None:
        id_, name, unit = row
        value = self._values[id_] = QLabel(self)
        font = QFont(value.font())
        font.setFeature(QFont.Tag("tnum"), 1)
        value.setFont(font)
        value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        value.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        grid.addWidget(QLabel(name, self), number, 0)
        grid.addWidget(value, number, 1)
        grid.addWidget(QLabel(unit, self), number, 2)
