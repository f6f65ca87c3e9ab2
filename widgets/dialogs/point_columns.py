"""ColumnsForm: what each column of a text file of points is, chosen above its first rows."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QLabel,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.plain_buttons import remove_icons

_NEEDED = ("x", "y", "z")
_PASSED_OVER = "-"


class ColumnsForm(QDialog):
    """Asks for the columns; x, y and z must be among them, and no other twice.

    Parameters
    ----------
    why : str
        What isn't understood, with the file's name.
    choices : sequence of (str, str)
        What a column may be, and how that is called; ``-`` for one that is passed over.
    rows : sequence of sequence of str
        The first rows.

    Signals
    -------
    columns_named(columns: tuple[str, ...])
    """

    columns_named = Signal(object)

    def __init__(
        self,
        why: str,
        choices: Sequence[tuple[str, str]],
        rows: Sequence[Sequence[str]],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Columns of the points"))
        self.resize(680, 420)
        self._boxes = [QComboBox(self) for _ in rows[0]]
        for box in self._boxes:
            for value, title in choices:
                box.addItem(title, value)
            box.currentIndexChanged.connect(self._check)
        reported = QLabel(why, self)
        reported.setWordWrap(True)
        self._trouble = QLabel(self)
        self._trouble.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self._import = buttons.addButton(self.tr("Import"), QDialogButtonBox.ButtonRole.AcceptRole)
        remove_icons(buttons)
        layout = QVBoxLayout(self)
        layout.addWidget(reported)
        layout.addWidget(self._table_of(rows), 1)
        layout.addWidget(self._trouble)
        layout.addWidget(buttons)
        buttons.accepted.connect(self._on_buttons_accepted)
        buttons.rejected.connect(self.close)
        self._check()

    @property
    def columns(self) -> tuple[str, ...]:
        """What is chosen for each column."""
        return tuple(str(box.currentData()) for box in self._boxes)

    def _table_of(self, rows: Sequence[Sequence[str]]) -> QTableWidget:
        table = QTableWidget(1 + len(rows), len(self._boxes), self)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        table.verticalHeader().hide()
        for at, box in enumerate(self._boxes):
            table.setCellWidget(0, at, box)
        for number, row in enumerate(rows, 1):
            for at, cell in enumerate(row[: len(self._boxes)]):
                item = QTableWidgetItem(cell)
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                table.setItem(number, at, item)
        table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        table.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        return table

    def _check(self) -> None:
        chosen = self.columns
        named = [one for one in chosen if one != _PASSED_OVER]
        lacking = [name for name in _NEEDED if name not in named]
        trouble = ""
        if lacking:
            trouble = self.tr("Choose the columns of {names}.").format(names=", ".join(lacking))
        elif len(set(named)) < len(named):
            trouble = self.tr("Two columns have the same name.")
        self._trouble.setText(trouble)
        self._import.setEnabled(not trouble)

    def _on_buttons_accepted(self) -> None:
        self.columns_named.emit(self.columns)
        self.close()
