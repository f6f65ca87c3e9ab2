"""ReferenceSystemBox: the plane rectangular systems of Japan by name, any other by its code."""

from __future__ import annotations

import re

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QLabel, QVBoxLayout, QWidget

from widgets.parts.plain_buttons import remove_icons

_ZONES = (
    "I",
    "II",
    "III",
    "IV",
    "V",
    "VI",
    "VII",
    "VIII",
    "IX",
    "X",
    "XI",
    "XII",
    "XIII",
    "XIV",
    "XV",
    "XVI",
    "XVII",
    "XVIII",
    "XIX",
)


class ReferenceSystemBox(QComboBox):
    """Chooses a reference system; empty means the files' own."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setEditable(True)
        self.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.addItem(self.tr("As the files say"), "")
        for number, zone in enumerate(_ZONES, start=1):
            code = f"EPSG:{6668 + number}"
            name = self.tr("{code}  Plane rectangular system {zone} (JGD2011)")
            self.addItem(name.format(code=code, zone=zone), code)

    def choose(self, code: str) -> None:
        """Stand at a code; empty for the first entry."""
        found = self.findData(code)
        if found >= 0:
            self.setCurrentIndex(found)
        else:
            self.setEditText(code)

    @property
    def code(self) -> str | None:
        """``EPSG:n``; empty for the files' own; None when what was typed is neither."""
        typed = self.currentText().strip()
        index = self.findText(typed)
        if index >= 0:
            return str(self.itemData(index))
        found = re.fullmatch(r"(?:EPSG:)?\s*(\d{4,6})", typed, flags=re.IGNORECASE)
        if found:
            return f"EPSG:{found.group(1)}"
        return "" if not typed else None


class ReferenceSystemForm(QDialog):
    """Asks for the reference system of a project."""

    system_chosen = Signal(str)

    def __init__(self, code: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Reference system"))
        self._box = ReferenceSystemBox(self)
        self._box.removeItem(0)
        self._box.choose(code)
        self._trouble = QLabel(self)
        kinds = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(kinds.Ok | kinds.Cancel, self)
        remove_icons(buttons)
        buttons.accepted.connect(self._on_buttons_accepted)
        buttons.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        layout.addWidget(self._box)
        layout.addWidget(self._trouble)
        layout.addWidget(buttons)
        self.resize(460, 110)

    def _on_buttons_accepted(self) -> None:
        code = self._box.code
        if not code:
            self._trouble.setText(self.tr("Give a code such as EPSG:6677."))
            return
        self.system_chosen.emit(code)
        self.close()
