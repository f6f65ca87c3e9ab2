"""ReferenceSystemBox: the plane rectangular systems of Japan by name, any other by its code."""

from __future__ import annotations

import re

from PySide6.QtWidgets import QComboBox, QWidget

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
