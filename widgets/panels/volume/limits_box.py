"""LimitsBox: by which limits a ground is judged: a work type of the table, or another table."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QComboBox, QSizePolicy, QWidget

from processing.core.text import Language, Text


class _Other(Enum):
    """What can be chosen besides a work type."""

    FILE = "file"
    BUNDLED = "bundled"
    COPY = "copy"


class LimitsBox(QComboBox):
    """Lists the work types of the table that counts, and the ways to another table.

    Signals
    -------
    work_type_chosen(id: str)
    table_wanted()
        An office's table is to be opened.
    bundled_wanted()
        The table that comes with the program is to count again.
    copy_wanted()
        The table that counts is to be written to a file.
    """

    work_type_chosen = Signal(str)
    table_wanted = Signal()
    bundled_wanted = Signal()
    copy_wanted = Signal()

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language: Language = language
        self._chosen = ""
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.activated.connect(self._on_activated)

    def show_table(
        self, work_types: Sequence[tuple[str, Text]], chosen: str, file_name: str
    ) -> None:
        """List the work types of a table.

        Parameters
        ----------
        work_types : sequence of (str, Text)
            Ids and names.
        chosen : str
            Id of the one whose limits count.
        file_name : str
            Of the table; empty for the one that comes with the program.
        """
        self._chosen = chosen
        with QSignalBlocker(self):
            self.clear()
            for id_, name in work_types:
                in_language = name.in_language(self._language)
                self.addItem(f"{in_language}  [{file_name}]" if file_name else in_language, id_)
                self.setItemData(self.count() - 1, in_language, Qt.ItemDataRole.ToolTipRole)
            self.insertSeparator(self.count())
            if file_name:
                self.addItem(self.tr("Table of the program"), _Other.BUNDLED)
            self.addItem(self.tr("Other table…"), _Other.FILE)
            if work_types:
                self.addItem(self.tr("Write this table as a file…"), _Other.COPY)
            self._choose()
        reported = self.tr("The work type whose limits the as-built form has")
        if file_name:
            reported += "\n" + self.tr("Limits from {name}").format(name=file_name)
        self.setToolTip(reported)

    def _choose(self) -> None:
        self.setCurrentIndex(self.findData(self._chosen))

    def _on_activated(self, number: int) -> None:
        data = self.itemData(number)
        if not isinstance(data, _Other):
            self._chosen = str(data)
            self.work_type_chosen.emit(self._chosen)
            return
        self._choose()  # nothing else counts before there is a table
        signals = {
            _Other.FILE: self.table_wanted,
            _Other.BUNDLED: self.bundled_wanted,
            _Other.COPY: self.copy_wanted,
        }
        signals[data].emit()
