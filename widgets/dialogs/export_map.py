"""ExportForm: which files to write, where, and how."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.plain_buttons import remove_icons


@dataclass(frozen=True)
class ExportOptions:
    """What the form asks for.

    Attributes
    ----------
    formats : tuple of str
        Keys of :data:`processing.operations.export.FORMATS`.
    """

    formats: tuple[str, ...]
    folder: Path
    dxf_version: str
    encoding: str
    candidates: bool


class ExportForm(QDialog):
    """A form beside the window."""

    export_requested = Signal(object)  # ExportOptions

    def __init__(
        self, folder: Path, formats: tuple[tuple[str, str], ...], parent: QWidget | None = None
    ) -> None:
        """Show the formats, each with its id and title."""
        super().__init__(parent)
        self.setWindowTitle(self.tr("Export"))
        self._boxes = {id_: QCheckBox(title, self) for id_, title in formats}
        for id_ in ("dxf", "csv"):
            if id_ in self._boxes:
                self._boxes[id_].setChecked(True)
        self._folder = QLineEdit(str(folder), self)
        self._version = QComboBox(self)
        self._version.addItem(self.tr("DXF 2018 (UTF-8)"), "R2018")
        self._version.addItem(self.tr("DXF 2000"), "R2000")
        self._encoding = QComboBox(self)
        self._encoding.addItem(self.tr("UTF-8"), "utf-8")
        self._encoding.addItem(self.tr("Shift_JIS (cp932)"), "cp932")
        self._candidates = QCheckBox(self.tr("Unchecked candidates as well"), self)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self._export = self._buttons.addButton(
            self.tr("Export"), QDialogButtonBox.ButtonRole.AcceptRole
        )
        remove_icons(self._buttons)
        self._lay_out()
        self._buttons.accepted.connect(self._on_buttons_accepted)
        self._buttons.rejected.connect(self.close)
        for box in self._boxes.values():
            box.toggled.connect(self._on_boxes_toggled)

    def _lay_out(self) -> None:
        choose = QPushButton(self.tr("Choose…"), self)
        choose.clicked.connect(self._on_choose_clicked)
        folder = QHBoxLayout()
        folder.addWidget(self._folder, 1)
        folder.addWidget(choose)
        boxes = QVBoxLayout()
        for box in self._boxes.values():
            boxes.addWidget(box)
        form = QFormLayout()
        form.addRow(self.tr("Files"), boxes)
        form.addRow(self.tr("Folder"), folder)
        form.addRow(self.tr("Version of DXF"), self._version)
        form.addRow(self.tr("Text of DXF and CSV"), self._encoding)
        form.addRow("", self._candidates)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(self._buttons)
        self.resize(480, 260)

    def _on_boxes_toggled(self) -> None:
        self._export.setEnabled(any(box.isChecked() for box in self._boxes.values()))

    def _on_choose_clicked(self) -> None:
        name = QFileDialog.getExistingDirectory(self, self.tr("Folder"), self._folder.text())
        if name:
            self._folder.setText(name)

    def _on_buttons_accepted(self) -> None:
        formats = tuple(id_ for id_, box in self._boxes.items() if box.isChecked())
        request = ExportOptions(
            formats,
            Path(self._folder.text().strip()),
            str(self._version.currentData()),
            str(self._encoding.currentData()),
            self._candidates.isChecked(),
        )
        self.export_requested.emit(request)
        self.close()
