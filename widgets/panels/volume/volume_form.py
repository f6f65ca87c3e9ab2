"""VolumeForm: what is compared with what, within what, and how."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language, Text
from processing.project.volumes.epochs import Epoch
from processing.project.volumes.volume import ChosenSide, SideKind
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.panels.volume.side_box import SideBox
from widgets.parts.number_field import NumberField
from widgets.parts.scrolled import make_scrollable

_HIGHEST_M = 9000.0


class AreaChoice(Enum):
    """Where earth counts."""

    EVERYTHING = "everything"
    SELECTED = "selected"
    FILE = "file"


@dataclass(frozen=True)
class FileArea:
    """An area of a file: of one of its layers, where it has areas on several."""

    path: Path
    layer: str = ""

    @property
    def title(self) -> str:
        """What people call it."""
        return f"{self.path.name}: {self.layer}" if self.layer else self.path.name


class VolumeForm(QWidget):
    """Two grounds, a boundary, lines, and the parameters of the tool.

    Parameters
    ----------
    parameters : type
        The tool's frozen dataclass of fields.
    language : Language

    Signals
    -------
    changed()
        Something is chosen otherwise.
    run_requested(), ground_requested()
        The buttons.
    boundary_wanted()
        A file is to be chosen; :meth:`take_boundaries` gives its areas.

    Attributes
    ----------
    before, after : SideBox
    parameters : ParameterForm
    """

    changed = Signal()
    run_requested = Signal()
    ground_requested = Signal()
    boundary_wanted = Signal()

    def __init__(
        self,
        parameters: type[Any],  # each tool has a dataclass of its own
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._language: Language = language
        self._areas: tuple[FileArea, ...] = ()
        self._chosen: AreaChoice | FileArea = AreaChoice.EVERYTHING
        self._reason: Callable[[], Text | None] | None = None
        self._needs_ground: Callable[[], bool] | None = None
        self.before, self.after = SideBox(self), SideBox(self)
        self._within = QComboBox(self)
        self._within.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._with_lines = QCheckBox(self.tr("Use the selected lines"), self)
        self._with_lines.setToolTip(
            self.tr("As break lines of triangles; a single one also as the axis of sections")
        )
        self.parameters = ParameterForm(parameters, language, self, has_typed=False)
        self._level = NumberField(-_HIGHEST_M, _HIGHEST_M, unit="m", parent=self)
        self._level_name = QLabel(self.tr("Level"), self)
        self._why_not = QLabel(self)
        self._why_not.setWordWrap(True)
        self._ground = QPushButton(self.tr("Find the ground of both"), self)
        self._run = QPushButton(self.tr("Compute the volume"), self)
        self._lay_out()
        self._fill_within()
        for box in (self.before, self.after):
            box.chosen.connect(self.refresh)
        self._within.activated.connect(self._on_within_activated)
        self.parameters.changed.connect(self.changed)
        self._run.clicked.connect(self.run_requested)
        self._ground.clicked.connect(self.ground_requested)
        self.refresh()

    def _lay_out(self) -> None:
        rows = QFormLayout()
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setHorizontalSpacing(8)
        rows.setVerticalSpacing(4)
        rows.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        rows.addRow(self.tr("Before"), self.before)
        rows.addRow(self.tr("After"), self.after)
        rows.addRow(self._level_name, self._level)
        rows.addRow(self.tr("Within"), self._within)
        rows.addRow(self._with_lines)
        fields = QWidget(self)
        above = QVBoxLayout(fields)
        above.setContentsMargins(8, 8, 8, 4)
        above.setSpacing(4)
        above.addLayout(rows)
        above.addWidget(self.parameters)
        above.addStretch(1)
        below = QVBoxLayout()
        below.setContentsMargins(8, 4, 8, 8)
        below.setSpacing(4)
        # Below what scrolls: they stay in sight whatever field is at hand.
        for widget in (self._why_not, self._ground, self._run):
            below.addWidget(widget)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(make_scrollable(fields), 1)
        layout.addLayout(below)

    @property
    def sides(self) -> tuple[ChosenSide | None, ChosenSide | None]:
        """What was before and what came after; a level with its height."""
        before, after = (self._with_height(box.side) for box in (self.before, self.after))
        return before, after

    @property
    def within(self) -> AreaChoice:
        """Where earth counts."""
        return AreaChoice.FILE if isinstance(self._chosen, FileArea) else self._chosen

    @property
    def boundary(self) -> FileArea | None:
        """The area of a file, where the boundary comes from one."""
        return self._chosen if isinstance(self._chosen, FileArea) else None

    @property
    def uses_lines(self) -> bool:
        """Whether the selected lines of the map count."""
        return self._with_lines.isChecked()

    def ask_reason_from(self, reason: Callable[[], Text | None]) -> None:
        """Ask this why nothing can be computed now; None: it can."""
        self._reason = reason
        self.refresh()

    def ask_ground_from(self, needs_ground: Callable[[], bool]) -> None:
        """Ask this whether the ground of an epoch is still to be found."""
        self._needs_ground = needs_ground
        self.refresh()

    def show_epochs(self, epochs: Sequence[Epoch]) -> None:
        """List the epochs of the project, the older one as what was before."""
        self.before.show_epochs(epochs, 0)
        self.after.show_epochs(epochs, 1)
        self.refresh()

    def choose_sides(self, before: ChosenSide | None, after: ChosenSide | None) -> None:
        """Choose both grounds, a level with its height; None leaves one as it is."""
        for box, side in ((self.before, before), (self.after, after)):
            if side is not None:
                box.choose(side)
            if side is not None and side.kind is SideKind.LEVEL:
                self._level.setValue(side.height_m)

    def take_boundaries(self, path: Path, layers: Sequence[str]) -> None:
        """List the areas of a file, one for each of several layers, and choose the first one."""
        several = layers if len(layers) > 1 else ("",)
        self._areas = tuple(FileArea(path, layer) for layer in several)
        self._choose(self._areas[0])

    def start_anew(self) -> None:
        """Another project is open, or none."""
        for box in (self.before, self.after):
            box.forget_designs()
        self._areas, self._chosen = (), AreaChoice.EVERYTHING
        self._fill_within()

    def refresh(self) -> None:
        """Ask again whether it can be computed."""
        has_level = any(
            box.side is not None and box.side.kind is SideKind.LEVEL
            for box in (self.before, self.after)
        )
        self._level.setVisible(has_level)
        self._level_name.setVisible(has_level)
        reason = None if self._reason is None else self._reason()
        lacks_ground = reason is None and self._needs_ground is not None and self._needs_ground()
        self._run.setEnabled(reason is None and not lacks_ground)
        said = "" if reason is None else reason.in_language(self._language)
        if lacks_ground:
            said = self.tr("The ground has not been separated from what stands on it yet.")
        self._why_not.setText(said)
        self._why_not.setVisible(bool(said))
        self._ground.setVisible(lacks_ground)

    def _with_height(self, side: ChosenSide | None) -> ChosenSide | None:
        if side is None or side.kind is not SideKind.LEVEL:
            return side
        return replace(side, height_m=self._level.value())

    def _fill_within(self) -> None:
        self._within.clear()
        self._within.addItem(self.tr("Everything"), AreaChoice.EVERYTHING)
        self._within.addItem(self.tr("Selected areas"), AreaChoice.SELECTED)
        for area in self._areas:
            self._within.addItem(area.title, area)
        self._within.addItem(self.tr("Area from a file…"), AreaChoice.FILE)
        offered = [self._within.itemData(number) for number in range(self._within.count())]
        self._within.setCurrentIndex(offered.index(self._chosen))

    def _choose(self, chosen: AreaChoice | FileArea) -> None:
        self._chosen = chosen
        self._fill_within()
        self.changed.emit()

    def _on_within_activated(self, number: int) -> None:
        chosen = self._within.itemData(number)
        if chosen is AreaChoice.FILE:
            self._fill_within()  # nothing else is chosen before there is an area
            self.boundary_wanted.emit()
        else:
            self._choose(chosen)
