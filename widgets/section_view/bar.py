"""SectionBar: width, step and exaggeration, along or across, live and pinned."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLayout,
    QWidget,
)
from typing_extensions import override

from widgets.parts.icon_button import IconButton
from widgets.parts.number_field import NumberField
from widgets.section_view.picture.section_position import LEAST_WIDTH_M, MOST_WIDTH_M
from widgets.section_view.picture.settings import EXAGGERATIONS, SectionSettings

_LEAST_STEP_M, _MOST_STEP_M = 0.05, 100.0
_TYPED = 2
_GAP_PX = 8


class SectionBar(QWidget):
    """The line above the section; where it doesn't fit, numbers take a line of their own.

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
        self._live = self._switch(
            "mdi6.cursor-default-click-outline",
            self.tr("Live"),
            self.tr("Follow the mouse over lines in any view"),
        )
        self._pin = self._switch(
            "mdi6.pin-outline",
            self.tr("Pin"),
            self.tr("Hold the place as two windows, across and along"),
        )
        self._template = IconButton(
            "mdi6.content-duplicate",
            self.tr("Template…"),
            self.tr("Draw a profile once and fit it along the street"),
            self,
        )
        self._export = IconButton(
            "mdi6.file-export-outline",
            self.tr("Profile as DXF…"),
            self.tr("Write the ground line with heights, and what crosses it"),
            self,
        )
        self._ground = self._switch(
            "mdi6.terrain",
            self.tr("Ground"),
            self.tr("Draw the ground that was found: dashed where it is filled in"),
        )
        self._diagnostics = self._switch(
            "mdi6.clipboard-check-outline",
            self.tr("Tests"),
            self.tr("Show the normalised scanline, and why tools take a place on it or not"),
        )
        self._lay_out()
        self._connect_fields()
        self.show_settings(self._settings)

    def _connect_fields(self) -> None:
        for box in (self._lying, self._heights):
            box.activated.connect(self._on_settings_edited)
        for field in (self._width, self._step):
            field.valueChanged.connect(self._on_settings_edited)
        self._line.activated.connect(self._on_line_activated)
        self._ground.toggled.connect(self._on_settings_edited)
        self._diagnostics.toggled.connect(self._on_settings_edited)
        self._live.toggled.connect(self._on_settings_edited)
        self._pin.toggled.connect(self.pin_toggled)
        self._template.clicked.connect(self.template_requested)
        self._export.clicked.connect(self.profile_export_requested)

    def _lay_out(self) -> None:
        self._which = self._group(self._lying, self._line)
        self._numbers = self._group(
            *self._label_field(self.tr("Width"), self._width),
            *self._label_field(self.tr("Step"), self._step),
            *self._label_field(self.tr("Heights"), self._heights),
            self._ground,
            self._diagnostics,
        )
        self._buttons = self._group(self._live, self._pin, self._template, self._export)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(4, 0, 4, 4)
        self._grid.setHorizontalSpacing(_GAP_PX)
        self._grid.setVerticalSpacing(4)
        self._grid.setColumnStretch(2, 1)
        # Its width is given by the dock; how many lines it takes follows.
        self._grid.setSizeConstraint(QLayout.SizeConstraint.SetNoConstraint)
        self._stand(is_one_line=True)

    @override
    def sizeHint(self) -> QSize:
        margins = self._grid.contentsMargins()
        lines = 1 if self._is_one_line else 2
        high = max(group.sizeHint().height() for group in self._groups)
        return QSize(
            self._wide(is_one_line=self._is_one_line),
            lines * high + (lines - 1) * 4 + margins.top() + margins.bottom(),
        )

    @override
    def minimumSizeHint(self) -> QSize:
        return QSize(self._wide(is_one_line=False), self.sizeHint().height())

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        is_one_line = self.width() >= self._wide(is_one_line=True)
        if is_one_line != self._is_one_line:
            self._stand(is_one_line=is_one_line)

    @property
    def _groups(self) -> tuple[QWidget, QWidget, QWidget]:
        return self._which, self._numbers, self._buttons

    def _wide(self, *, is_one_line: bool) -> int:
        """Pixels that one line takes, or the longer of two."""
        which, numbers, buttons = (group.sizeHint().width() for group in self._groups)
        margins = self._grid.contentsMargins()
        wide = which + _GAP_PX + buttons
        wide = wide + _GAP_PX + numbers if is_one_line else max(wide, numbers)
        return wide + margins.left() + margins.right()

    def _stand(self, *, is_one_line: bool) -> None:
        self._is_one_line = is_one_line
        for group in self._groups:
            self._grid.removeWidget(group)
        self._grid.addWidget(self._which, 0, 0)
        if is_one_line:
            self._grid.addWidget(self._numbers, 0, 1)
        else:
            self._grid.addWidget(self._numbers, 1, 0, 1, 4, Qt.AlignmentFlag.AlignLeft)
        self._grid.addWidget(self._buttons, 0, 3)
        self.updateGeometry()

    def show_settings(self, settings: SectionSettings) -> None:
        """Show what holds."""
        self._settings = settings
        # The model changed, not the user.
        blocked = [
            QSignalBlocker(one)
            for one in (
                self._lying,
                self._width,
                self._step,
                self._heights,
                self._live,
                self._ground,
                self._diagnostics,
            )
        ]
        self._lying.setCurrentIndex(int(settings.is_along))
        self._width.setValue(settings.width_m)
        self._step.setValue(settings.step_m)
        if settings.exaggeration in EXAGGERATIONS:
            self._heights.setCurrentIndex(EXAGGERATIONS.index(settings.exaggeration))
        self._live.setChecked(settings.is_live)
        self._ground.setChecked(settings.shows_ground)
        self._diagnostics.setChecked(settings.shows_diagnostics)
        for one in blocked:
            one.unblock()

    def show_line(self, *, is_drawn: bool, has_axis: bool) -> None:
        """Show which line the section stands on.

        Parameters
        ----------
        has_axis : bool
            Whether it is a site's own axis where none is drawn, since nobody drove there.
        """
        self._line.setItemText(0, self.tr("Site axis") if has_axis else self.tr("Trajectory"))
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
            shows_ground=self._ground.isChecked(),
            shows_diagnostics=self._diagnostics.isChecked(),
        )
        self.settings_chosen.emit(self._settings)

    def _on_line_activated(self, index: int) -> None:
        self.line_wanted.emit(bool(index))

    def _label_field(self, name: str, field: QWidget) -> tuple[QLabel, QWidget]:
        label = QLabel(name, self)
        label.setBuddy(field)
        return label, field

    def _group(self, *parts: QWidget) -> QWidget:
        together = QWidget(self)
        layout = QHBoxLayout(together)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        for part in parts:
            layout.addWidget(part)
        return together

    def _switch(self, sign: str, name: str, tip: str) -> IconButton:
        return IconButton(sign, name, tip, self, is_switch=True)

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
