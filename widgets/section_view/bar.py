"""SectionBar: width, step and exaggeration, along or across, live and pinned."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QSignalBlocker, Signal, SignalInstance
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QComboBox, QDoubleSpinBox, QHBoxLayout, QLabel, QToolBar, QWidget

from widgets.parts.number_field import NumberField
from widgets.section_view.settings import EXAGGERATIONS, SectionSettings
from widgets.section_view.standing import LEAST_WIDTH_M, MOST_WIDTH_M

_LEAST_STEP_M, _MOST_STEP_M = 0.05, 100.0
_TYPED = 2


class SectionBar(QToolBar):
    """The line above the section; what doesn't fit is behind the arrow at its end.

    Signals
    -------
    settings_chosen(settings: SectionSettings)
        Something was set by hand.
    line_wanted(is_drawn: bool)
        Across the selected line, or across the trajectory.
    pin_toggled(is_pinned: bool)
    profile_export_requested, template_requested
        The buttons “Profile as DXF…” and “Template…”.
    """

    settings_chosen = Signal(object)
    line_wanted = Signal(bool)
    pin_toggled = Signal(bool)
    profile_export_requested = Signal()
    template_requested = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._settings = SectionSettings()
        self._lying = self._choice(
            [self.tr("Across"), self.tr("Along")],
            self.tr("Cut across the line or along it"),
        )
        self._line = self._choice(
            [self.tr("Trajectory"), self.tr("Drawn line")],
            self.tr("The line that the section stands on"),
        )
        self._width = self._metres(LEAST_WIDTH_M, MOST_WIDTH_M, 0.1)
        self._width.setToolTip(self.tr("Thickness of the slab"))
        self._step = self._metres(_LEAST_STEP_M, _MOST_STEP_M, 0.5)
        self._step.setToolTip(self.tr("Distance of a step along the line (Q and W; Shift: ten)"))
        self._heights = self._choice(
            [f"{factor:g}×" for factor in EXAGGERATIONS],
            self.tr("How many times heights are drawn larger"),
        )
        self._lay_out()
        for box in (self._lying, self._heights):
            box.activated.connect(self._on_settings_edited)
        for field in (self._width, self._step):
            field.valueChanged.connect(self._on_settings_edited)
        self._line.activated.connect(self._on_line_activated)
        self.show_settings(self._settings)

    def _lay_out(self) -> None:
        self.setMovable(False)
        self.addWidget(self._lying)
        self.addWidget(self._line)
        self._named(self.tr("Width"), self._width)
        self._named(self.tr("Step"), self._step)
        self._named(self.tr("Heights"), self._heights)
        self.addSeparator()
        self._live = self._switch(
            self.tr("Live"), self.tr("Follow the mouse over lines in any view")
        )
        self._live.toggled.connect(self._on_settings_edited)
        self._pin = self._switch(
            self.tr("Pin"), self.tr("Hold the place as two windows, across and along")
        )
        self._pin.toggled.connect(self.pin_toggled)
        self.addSeparator()
        self._button(
            self.tr("Template…"),
            self.tr("Draw a profile once and fit it along the street"),
            self.template_requested,
        )
        self._button(
            self.tr("Profile as DXF…"),
            self.tr("Write the ground line with heights, and what crosses it"),
            self.profile_export_requested,
        )

    def show_settings(self, settings: SectionSettings) -> None:
        """Show what holds."""
        self._settings = settings
        # The model changed, not the user.
        blocked = [
            QSignalBlocker(one)
            for one in (self._lying, self._width, self._step, self._heights, self._live)
        ]
        self._lying.setCurrentIndex(int(settings.is_along))
        self._width.setValue(settings.width_m)
        self._step.setValue(settings.step_m)
        if settings.exaggeration in EXAGGERATIONS:
            self._heights.setCurrentIndex(EXAGGERATIONS.index(settings.exaggeration))
        self._live.setChecked(settings.is_live)
        for one in blocked:
            one.unblock()

    def show_line(self, *, is_drawn: bool) -> None:
        """Show which line the section stands on."""
        self._line.setCurrentIndex(int(is_drawn))

    def show_pinned(self, *, is_pinned: bool) -> None:
        """Show whether the section is held."""
        with QSignalBlocker(self._pin):
            self._pin.setChecked(is_pinned)

    def _on_settings_edited(self) -> None:
        self._settings = replace(
            self._settings,
            width_m=self._width.value(),
            step_m=self._step.value(),
            exaggeration=EXAGGERATIONS[self._heights.currentIndex()],
            is_along=bool(self._lying.currentIndex()),
            is_live=self._live.isChecked(),
        )
        self.settings_chosen.emit(self._settings)

    def _on_line_activated(self, index: int) -> None:
        self.line_wanted.emit(bool(index))

    def _named(self, name: str, field: QWidget) -> None:
        together = QWidget(self)  # so that neither goes behind the arrow alone
        label = QLabel(name, together)
        label.setBuddy(field)
        layout = QHBoxLayout(together)
        layout.setContentsMargins(6, 0, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(label)
        layout.addWidget(field)
        self.addWidget(together)

    def _choice(self, names: list[str], tip: str) -> QComboBox:
        box = QComboBox(self)
        box.addItems(names)
        box.setToolTip(tip)
        box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        return box

    def _metres(self, low: float, high: float, step: float) -> QDoubleSpinBox:
        field = NumberField(low, high, unit="m", decimals=_TYPED, parent=self)
        field.setSingleStep(step)
        return field

    def _button(self, name: str, tip: str, wish: SignalInstance) -> None:
        action = QAction(name, self)
        action.setIconText(name)  # or the dots would be taken off
        action.setToolTip(tip)
        action.triggered.connect(wish)
        self.addAction(action)

    def _switch(self, name: str, tip: str) -> QAction:
        action = QAction(name, self)
        action.setCheckable(True)
        action.setToolTip(tip)
        self.addAction(action)
        return action
