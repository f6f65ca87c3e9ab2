"""VolumeStyleForm: how the map of change is shown: its range, its opacity, its contours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QCheckBox, QComboBox, QFormLayout, QSlider, QWidget

from widgets.parts.number_field import NumberField
from widgets.shared.shown_volume import (
    LEAST_LIMIT_M,
    MOST_LIMIT_M,
    ContourOf,
    ShownVolume,
    VolumeStyle,
)

_LEAST_INTERVAL_M, _MOST_INTERVAL_M = 0.01, 50.0
_PERCENT = 100


class VolumeStyleForm(QWidget):
    """Sets what all views show of a volume, at once.

    Parameters
    ----------
    volume : ShownVolume
    """

    def __init__(self, volume: ShownVolume, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._volume = volume
        self._is_shown = QCheckBox(self.tr("Show the heat map"), self)
        self._limit = NumberField(LEAST_LIMIT_M, MOST_LIMIT_M, unit="m", parent=self)
        self._limit.setPrefix("± ")
        self._limit.setToolTip(self.tr("Where the outermost colours begin"))
        self._opacity = QSlider(Qt.Orientation.Horizontal, self)
        self._opacity.setRange(10, _PERCENT)
        self._opacity.setToolTip(self.tr("How much of the points shines through"))
        self._contours = QComboBox(self)
        for of, name in (
            (ContourOf.NOTHING, self.tr("None")),
            (ContourOf.CHANGE, self.tr("Of the difference")),
            (ContourOf.BEFORE, self.tr("Of the ground before")),
            (ContourOf.AFTER, self.tr("Of the ground after")),
        ):
            self._contours.addItem(name, of.value)
        self._interval = NumberField(_LEAST_INTERVAL_M, _MOST_INTERVAL_M, unit="m", parent=self)
        self._interval.setToolTip(self.tr("Between contours; every fifth one is thicker"))
        self._lay_out()
        self._show_look(volume.look)
        volume.look_changed.connect(self._show_look)
        self._is_shown.toggled.connect(self._on_changed)
        self._limit.valueChanged.connect(self._on_changed)
        self._opacity.valueChanged.connect(self._on_changed)
        self._contours.activated.connect(self._on_changed)
        self._interval.valueChanged.connect(self._on_changed)

    def _lay_out(self) -> None:
        rows = QFormLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setHorizontalSpacing(8)
        rows.setVerticalSpacing(4)
        rows.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        rows.addRow(self._is_shown)
        rows.addRow(self.tr("Range"), self._limit)
        rows.addRow(self.tr("Opacity"), self._opacity)
        rows.addRow(self.tr("Contours"), self._contours)
        rows.addRow(self.tr("Interval"), self._interval)

    def _show_look(self, look: VolumeStyle) -> None:
        shown: tuple[tuple[QWidget, Callable[[], object]], ...] = (
            (self._is_shown, lambda: self._is_shown.setChecked(look.is_shown)),
            (self._limit, lambda: self._limit.setValue(look.limit_m)),
            (self._opacity, lambda: self._opacity.setValue(round(look.opacity * _PERCENT))),
            (
                self._contours,
                lambda: self._contours.setCurrentIndex(list(ContourOf).index(look.contours)),
            ),
            (self._interval, lambda: self._interval.setValue(look.interval_m)),
        )
        for field, show in shown:
            with QSignalBlocker(field):  # nobody typed it
                show()
        self._interval.setEnabled(look.contours is not ContourOf.NOTHING)

    def _on_changed(self) -> None:
        self._volume.use_look(
            replace(
                self._volume.look,
                is_shown=self._is_shown.isChecked(),
                limit_m=self._limit.value(),
                opacity=self._opacity.value() / _PERCENT,
                contours=ContourOf(self._contours.currentData()),
                interval_m=self._interval.value(),
            )
        )
