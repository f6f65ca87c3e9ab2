"""DrivePropertiesForm: what is known of a drive, and the ways to mend or complete it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from widgets.parts.plain_buttons import remove_icons

_SIZE_PX = QSize(560, 460)


class DrivePropertiesForm(QDialog):
    """A form beside the window; the window stays usable while it is open.

    Parameters
    ----------
    drive : str
        Its id.

    Signals
    -------
    described(drive: str, name: str, measured_on: str)
        The drive is to be called so, and to count as measured on that day.
    trajectory_requested(drive: str), images_requested(drive: str), system_requested(drive: str)
    replacement_requested(drive: str)
        A new delivery is to take the drive's place.
    removal_requested(drive: str)
    """

    described = Signal(str, str, str)
    trajectory_requested = Signal(str)
    images_requested = Signal(str)
    system_requested = Signal(str)
    replacement_requested = Signal(str)
    removal_requested = Signal(str)

    def __init__(self, drive: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.drive = drive
        self.setWindowTitle(self.tr("Properties of a drive"))
        self.name = QLineEdit(self)
        self.day = QLineEdit(self)
        self._said = ("", "")
        self.trouble = QLabel(self)
        self.trouble.setWordWrap(True)
        self.trouble.hide()
        self._facts = QScrollArea(self)
        self._facts.setWidgetResizable(True)
        self._facts.setFrameShape(QScrollArea.Shape.NoFrame)
        kinds = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(kinds.Ok | kinds.Cancel, self)
        remove_icons(buttons)
        buttons.accepted.connect(self._on_buttons_accepted)
        buttons.rejected.connect(self.close)
        fields = QFormLayout()
        fields.addRow(self.tr("Name"), self.name)
        fields.addRow(self.tr("Measured on"), self.day)
        layout = QVBoxLayout(self)
        layout.addLayout(fields)
        layout.addWidget(self._facts, 1)
        layout.addLayout(self._mending())
        layout.addWidget(self.trouble)
        layout.addWidget(buttons)
        self.resize(_SIZE_PX)

    def show_drive(self, said: tuple[str, str], day: str, facts: Sequence[tuple[str, str]]) -> None:
        """Show what is known now; what was typed and isn't given yet stays.

        Parameters
        ----------
        said : tuple of str
            The drive's name, and the day that somebody said; empty where nobody did.
        day : str
            The one that its times name; empty where they name none.
        """
        for field, before, now in zip((self.name, self.day), self._said, said, strict=True):
            if field.text() == before:
                field.setText(now)
        self._said = said
        self.day.setPlaceholderText(day or self.tr("unknown, for instance 2026-04-01"))
        page = QWidget(self._facts)
        rows = QFormLayout(page)
        rows.setContentsMargins(0, 0, 0, 0)
        for name, value in facts:
            label = QLabel(value, page)
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            rows.addRow(name, label)
        self._facts.setWidget(page)

    def show_trouble(self, words: str) -> None:
        """Say why what was typed can't be taken."""
        self.trouble.setText(words)
        self.trouble.show()

    @override
    def sizeHint(self) -> QSize:
        return _SIZE_PX

    def _mending(self) -> QVBoxLayout:
        """The buttons that complete, replace and remove."""
        completing, whole = QHBoxLayout(), QHBoxLayout()
        for row, words, ask in (
            (completing, self.tr("Trajectory…"), self.trajectory_requested),
            (completing, self.tr("Camera images…"), self.images_requested),
            (completing, self.tr("Reference system…"), self.system_requested),
            (whole, self.tr("Replace by a new delivery…"), self.replacement_requested),
            (whole, self.tr("Remove from the project"), self.removal_requested),
        ):
            button = QPushButton(words, self)
            button.setAutoDefault(False)
            button.clicked.connect(partial(ask.emit, self.drive))
            row.addWidget(button)
        rows = QVBoxLayout()
        rows.addLayout(completing)
        rows.addLayout(whole)
        return rows

    def _on_buttons_accepted(self) -> None:
        self.described.emit(self.drive, self.name.text(), self.day.text())
