"""SlabForm: how far the shown part of space reaches around the drive."""

from __future__ import annotations

from PySide6.QtWidgets import QDoubleSpinBox, QFormLayout, QWidget

from processing.image.search.corridor import CorridorExtent
from widgets.scene_view.clipping import Clipping

_WIDEST_M = 100.0
_LOWEST_M, _HIGHEST_M = -50.0, 100.0
_LEAST_M = 0.5


class SlabForm(QWidget):
    """Four fields; each takes effect when it is left or stepped."""

    def __init__(self, clipping: Clipping, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._clipping = clipping
        slab = clipping.slab
        self._left = self._field(slab.left_m, 0.0, _WIDEST_M)
        self._right = self._field(slab.right_m, 0.0, _WIDEST_M)
        self._highest = self._field(slab.highest_m, _LOWEST_M + _LEAST_M, _HIGHEST_M)
        self._lowest = self._field(slab.lowest_m, _LOWEST_M, _HIGHEST_M - _LEAST_M)
        layout = QFormLayout(self)
        layout.setContentsMargins(28, 4, 12, 8)
        layout.setVerticalSpacing(4)
        layout.addRow(self.tr("To the left"), self._left)
        layout.addRow(self.tr("To the right"), self._right)
        layout.addRow(self.tr("Above the road up to"), self._highest)
        layout.addRow(self.tr("Above the road from"), self._lowest)

    def _field(self, value: float, least: float, most: float) -> QDoubleSpinBox:
        field = QDoubleSpinBox(self)
        field.setRange(least, most)
        field.setDecimals(1)
        field.setSingleStep(0.5)
        field.setSuffix(" m")
        field.setKeyboardTracking(False)
        field.setValue(value)
        field.valueChanged.connect(self._on_field_changed)
        return field

    def _on_field_changed(self) -> None:
        # The upper end never sinks below the lower one.
        self._highest.setMinimum(self._lowest.value() + _LEAST_M)
        self._lowest.setMaximum(self._highest.value() - _LEAST_M)
        self._clipping.set_slab(
            CorridorExtent(
                self._left.value(),
                self._right.value(),
                self._lowest.value(),
                self._highest.value(),
            )
        )
