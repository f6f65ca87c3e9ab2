"""ExportForm: which files to write, where, and how."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from processing.core.parameters import Parameter, ParameterValue
from processing.core.text import Language, Text
from widgets.panels.processing.parameter_row import ParameterRow
from widgets.parts.plain_buttons import remove_icons


@dataclass(frozen=True)
class ExportOptions:
    """What the form asks for.

    Attributes
    ----------
    formats : tuple of str
        Their ids.
    options : mapping of str to value
        What is chosen for them.
    """

    formats: tuple[str, ...]
    folder: Path
    options: Mapping[str, ParameterValue]
    candidates: bool


@dataclass(frozen=True)
class ExportChoices:
    """What the form offers.

    Attributes
    ----------
    formats : tuple of (str, Text)
        The id of each and its title.
    options : tuple of Parameter
        What can be chosen for them.
    owners : mapping of str to tuple of str
        By the id of a format the ids of its options.
    """

    formats: tuple[tuple[str, Text], ...]
    options: tuple[Parameter, ...]
    owners: Mapping[str, tuple[str, ...]]

    def options_of(self, formats: Iterable[str]) -> frozenset[str]:
        """Ids of what can be chosen for some formats."""
        return frozenset(id_ for one in formats for id_ in self.owners.get(one, ()))


class ExportForm(QDialog):
    """A form beside the window."""

    export_requested = Signal(object)  # ExportOptions

    def __init__(
        self,
        folder: Path,
        choices: ExportChoices,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Export"))
        self._boxes = {
            id_: QCheckBox(title.in_language(language), self) for id_, title in choices.formats
        }
        for id_ in ("dxf", "csv"):
            if id_ in self._boxes:
                self._boxes[id_].setChecked(True)
        self._choices = choices
        self._form = QFormLayout()
        self._folder = QLineEdit(str(folder), self)
        self._options = [
            (option, ParameterRow(option, language, self)) for option in choices.options
        ]
        self._candidates = QCheckBox(self.tr("Unchecked candidates as well"), self)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self._export = self._buttons.addButton(
            self.tr("Export"), QDialogButtonBox.ButtonRole.AcceptRole
        )
        remove_icons(self._buttons)
        self._lay_out(language)
        self._buttons.accepted.connect(self._on_buttons_accepted)
        self._buttons.rejected.connect(self.close)
        for box in self._boxes.values():
            box.toggled.connect(self._on_boxes_toggled)
        self._on_boxes_toggled()

    def _lay_out(self, language: Language) -> None:
        choose = QPushButton(self.tr("Choose…"), self)
        choose.clicked.connect(self._on_choose_clicked)
        folder = QHBoxLayout()
        folder.addWidget(self._folder, 1)
        folder.addWidget(choose)
        boxes = QVBoxLayout()
        for box in self._boxes.values():
            boxes.addWidget(box)
        form = self._form
        form.addRow(self.tr("Files"), boxes)
        form.addRow(self.tr("Folder"), folder)
        for option, row in self._options:
            row.field.setToolTip(option.explanation.in_language(language))
            form.addRow(option.name.in_language(language), row)
        form.addRow("", self._candidates)
        body = QWidget(self)
        body.setLayout(form)
        scroll = QScrollArea(self)  # the options of many formats are higher than small screens
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setWidgetResizable(True)
        scroll.setWidget(body)
        layout = QVBoxLayout(self)
        layout.addWidget(scroll)
        layout.addWidget(self._buttons)
        self.resize(540, 640)

    def _on_boxes_toggled(self) -> None:
        ticked = [id_ for id_, box in self._boxes.items() if box.isChecked()]
        self._export.setEnabled(bool(ticked))
        shown = self._choices.options_of(ticked)
        for option, row in self._options:
            self._form.setRowVisible(row, option.id in shown)

    def _on_choose_clicked(self) -> None:
        name = QFileDialog.getExistingDirectory(self, self.tr("Folder"), self._folder.text())
        if name:
            self._folder.setText(name)

    def _on_buttons_accepted(self) -> None:
        formats = tuple(id_ for id_, box in self._boxes.items() if box.isChecked())
        request = ExportOptions(
            formats,
            Path(self._folder.text().strip()),
            {option.id: row.value for option, row in self._options},
            self._candidates.isChecked(),
        )
        self.export_requested.emit(request)
        self.close()
