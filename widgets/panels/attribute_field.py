"""AttributeEditor: the field in which one attribute of a feature is typed."""

from __future__ import annotations

from PySide6.QtCore import QDate, QObject, QRegularExpression, Signal
from PySide6.QtGui import QRegularExpressionValidator
from PySide6.QtWidgets import QComboBox, QLineEdit, QWidget

from processing.project.catalogue import AttributeField
from processing.project.feature import AttributeValue
from processing.text import Language

_PATTERNS = {
    "number": r"[-+−]?\d{0,12}([.,]\d{0,9})?",
    "count": r"\d{0,9}",
    "date": r"\d{0,4}(-\d{0,2}){0,2}",
}


class AttributeEditor(QObject):
    """A line or a list; what isn't of the attribute's type can't be typed or isn't taken.

    Parameters
    ----------
    field : AttributeField
    value : str, float, int, bool or None
        None: nothing is said yet.
    language : Language

    Attributes
    ----------
    widget : QWidget
        To be put into a form; its object name is the attribute's id.

    Signals
    -------
    edited(id: str, value: AttributeValue)
        Another value was typed and the field left, or Enter pressed.
    """

    edited = Signal(str, object)

    def __init__(self, field: AttributeField, value: AttributeValue, language: Language) -> None:
        super().__init__()
        self._field = field
        self._value = value
        self.widget: QWidget
        if field.type == "choice":
            self._box = QComboBox()
            self._fill(language)
            self._box.activated.connect(self._on_box_activated)
            self.widget = self._box
        else:
            self._line = QLineEdit(_written(value))
            if field.type in _PATTERNS:
                pattern = QRegularExpression(_PATTERNS[field.type])
                self._line.setValidator(QRegularExpressionValidator(pattern, self._line))
            if field.type == "date":
                self._line.setPlaceholderText(self.tr("YYYY-MM-DD"))
            elif field.unit:
                self._line.setPlaceholderText(field.unit)
            self._line.editingFinished.connect(self._on_line_editing_finished)
            self.widget = self._line
        self.widget.setObjectName(field.id)

    def show_value(self, value: AttributeValue) -> None:
        """Show another value; tells nobody."""
        if value == self._value:
            return
        self._value = value
        if self._field.type == "choice":
            self._choose(value)
        else:
            self._line.setText(_written(value))

    def _fill(self, language: Language) -> None:
        self._box.addItem("", None)
        for choice in self._field.choices:
            self._box.addItem(self._field.name_of_choice(choice).spoken(language), choice)
        self._choose(self._value)

    def _choose(self, value: AttributeValue) -> None:
        index = self._box.findData(value)
        if value is not None and index < 0:
            # A value that the catalogue no longer has: shown as it is.
            self._box.addItem(str(value), value)
            index = self._box.count() - 1
        self._box.setCurrentIndex(max(index, 0))

    def _on_box_activated(self) -> None:
        self._tell(self._box.currentData())

    def _on_line_editing_finished(self) -> None:
        if not self._line.isModified():
            return
        self._line.setModified(False)
        text = self._line.text().strip()
        value = read_value(self._field, text)
        if text and value is None:
            self._line.setText(_written(self._value))
            return
        self._tell(value)

    def _tell(self, value: AttributeValue) -> None:
        if value != self._value:
            self._value = value
            self.edited.emit(self._field.id, value)


def read_value(field: AttributeField, text: str) -> AttributeValue:
    """What a text says as a value of the attribute; None when it says nothing valid."""
    if not text:
        return None
    if field.type == "number":
        try:
            return float(text.replace("−", "-").replace(",", "."))
        except ValueError:
            return None
    if field.type == "count":
        return int(text) if text.isdecimal() else None
    if field.type == "date":
        return text if QDate.fromString(text, "yyyy-MM-dd").isValid() else None
    return text


def _written(value: AttributeValue) -> str:
    # A float's shortest text that reads back as the same number.
    return "" if value is None else str(value)
