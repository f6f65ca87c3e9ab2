"""PrintForm: which sheets to print, and how they are made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QFrame,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from processing.core.parameters import ParameterValue
from processing.core.text import Language
from widgets.dialogs.export_map import ExportChoices
from widgets.panels.processing.parameter_row import ParameterRow
from widgets.parts.plain_buttons import remove_icons


@dataclass(frozen=True)
class PrintOptions:
    """What the form asks for.

    Attributes
    ----------
    format : str
        Id of the format whose sheets are printed.
    options : mapping of str to value
        What is chosen for it.
    """

    format: str
    options: Mapping[str, ParameterValue]
    candidates: bool


class PrintForm(QDialog):
    """A form beside the window; the printer is asked for when the sheets are made."""

    print_requested = Signal(object)  # PrintOptions

    def __init__(
        self, choices: ExportChoices, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Print"))
        self._choices = choices
        self._formats = QComboBox(self)
        for id_, title in choices.formats:
            self._formats.addItem(title.in_language(language), id_)
        self._rows = [(option, ParameterRow(option, language, self)) for option in choices.options]
        self._candidates = QCheckBox(self.tr("Unchecked candidates as well"), self)
        self._form = QFormLayout()
        self._form.addRow(self.tr("Sheets"), self._formats)
        for option, row in self._rows:
            row.field.setToolTip(option.explanation.in_language(language))
            self._form.addRow(option.name.in_language(language), row)
        self._form.addRow("", self._candidates)
        body = QWidget(self)
        body.setLayout(self._form)
        scroll = QScrollArea(self)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setWidgetResizable(True)
        scroll.setWidget(body)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        buttons.addButton(self.tr("Print…"), QDialogButtonBox.ButtonRole.AcceptRole)
        remove_icons(buttons)
        layout = QVBoxLayout(self)
        layout.addWidget(scroll)
        layout.addWidget(buttons)
        self.resize(540, 560)
        self._formats.currentIndexChanged.connect(self._on_formats_changed)
        buttons.accepted.connect(self._on_buttons_accepted)
        buttons.rejected.connect(self.close)
        self._on_formats_changed()

    @property
    def format(self) -> str:
        """Id of the format that is chosen."""
        return str(self._formats.currentData())

    def _on_formats_changed(self) -> None:
        shown = self._choices.options_of((self.format,))
        for option, row in self._rows:
            self._form.setRowVisible(row, option.id in shown)

    def _on_buttons_accepted(self) -> None:
        own = self._choices.options_of((self.format,))
        values = {option.id: row.value for option, row in self._rows if option.id in own}
        self.print_requested.emit(PrintOptions(self.format, values, self._candidates.isChecked()))
        self.close()
