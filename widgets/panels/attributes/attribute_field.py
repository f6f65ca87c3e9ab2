"""AttributeEditor: the field in which one attribute of the chosen features is typed."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QDate, QLocale, QObject, QRegularExpression, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QKeyEvent, QRegularExpressionValidator, QWheelEvent
from PySide6.QtWidgets import QComboBox, QLineEdit, QSizePolicy, QStyle, QWidget
from typing_extensions import override

from processing.core.text import Language
from processing.map.catalogue import AttributeField
from processing.map.feature import AttributeValue

# Full-width forms too: a Japanese keyboard types them unless it is told not to.
_DIGIT = "[0-9０-９]"
_PATTERNS = {
    "number": rf"[-+−－＋]?{_DIGIT}{{0,12}}([.,．，]{_DIGIT}{{0,9}})?",
    "count": rf"{_DIGIT}{{0,9}}",
    "date": rf"{_DIGIT}{{0,4}}([-/－／]{_DIGIT}{{0,2}}){{0,2}}",
}
_LEAST_LETTERS = 6
_ARROW_PX = 28


class MixedValue:
    """What is shown of an attribute that differs among the chosen features."""


SEVERAL: Final = MixedValue()
ShownValue = AttributeValue | MixedValue


class QuietBox(QComboBox):
    """A list that may be narrow, and that the wheel of a form being scrolled doesn't change."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(_LEAST_LETTERS)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMaxVisibleItems(20)

    @override
    def minimumSizeHint(self) -> QSize:
        # Qt's own has room for what stands there while nothing is chosen.
        wide = _LEAST_LETTERS * self.fontMetrics().averageCharWidth() + _ARROW_PX
        return QSize(wide, super().minimumSizeHint().height())

    @override
    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()


class TypedLine(QLineEdit):
    """A line for typing.

    Signals
    -------
    asked()
        Alt+Down, which opens a list elsewhere, too.
    """

    asked = Signal()

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        is_alt = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        if is_alt and event.key() == Qt.Key.Key_Down:
            self.asked.emit()
        else:
            super().keyPressEvent(event)


class AttributeEditor(QObject):
    """A line or a list; what isn't of the attribute's type can't be typed or isn't taken.

    Parameters
    ----------
    field : AttributeField
    value : str, float, int, bool, None or ShownValue
        None: nothing is said yet. ``SEVERAL``: the chosen features say different things.
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

    def __init__(self, field: AttributeField, value: ShownValue, language: Language) -> None:
        super().__init__()
        self._field = field
        self._value = value
        self._several = self.tr("(several values)")
        self.widget: QWidget
        if field.type == "choice":
            self._box = QuietBox()
            self._box.setPlaceholderText(self._several)
            self._fill(language)
            self._box.activated.connect(self._on_box_activated)
            self.widget = self._box
        else:
            self._line = TypedLine()
            self._add_clearing()
            if field.type in _PATTERNS:
                pattern = QRegularExpression(_PATTERNS[field.type])
                self._line.setValidator(QRegularExpressionValidator(pattern, self._line))
            self._write()
            self._line.editingFinished.connect(self._on_line_editing_finished)
            self.widget = self._line
        self.widget.setObjectName(field.id)

    def show_value(self, value: ShownValue) -> None:
        """Show another value; tells nobody."""
        if value == self._value:
            return
        self._value = value
        if self._field.type == "choice":
            self._choose()
        else:
            self._write()

    def finish(self) -> None:
        """Take what is typed as it stands, before the field goes."""
        if self._field.type != "choice":
            self._on_line_editing_finished()

    def offer(self, words: str, icon: QIcon, ask: Callable[[], None]) -> None:
        """Add a button to a line for typing, and Alt+Down, that ask for a value in another way."""
        if self._field.type == "choice":
            return
        asking = self._line.addAction(icon, QLineEdit.ActionPosition.TrailingPosition)
        asking.setToolTip(words)
        asking.triggered.connect(ask)
        self._line.asked.connect(ask)

    def take(self, value: AttributeValue) -> None:
        """Take a value as if it had been typed."""
        self._report(value)
        if self._field.type != "choice":
            self._line.setModified(False)
            self._write()

    def _add_clearing(self) -> None:
        """A button that empties a field of several values: there is no text to delete."""
        icon = self._line.style().standardIcon(QStyle.StandardPixmap.SP_LineEditClearButton)
        self._clearing = self._line.addAction(icon, QLineEdit.ActionPosition.TrailingPosition)
        self._clearing.setToolTip(self.tr("Empty this field of all selected features"))
        self._clearing.triggered.connect(self._on_clearing_triggered)

    def _write(self) -> None:
        is_several = isinstance(self._value, MixedValue)
        self._clearing.setVisible(is_several)
        self._line.setPlaceholderText(self._several if is_several else self._hint())
        self._line.setText(
            "" if isinstance(self._value, MixedValue) else format_attribute(self._value)
        )

    def _hint(self) -> str:
        return self.tr("YYYY-MM-DD") if self._field.type == "date" else ""

    def _fill(self, language: Language) -> None:
        self._box.addItem("", None)
        for choice in self._field.choices:
            self._box.addItem(self._field.name_of_choice(choice).in_language(language), choice)
        self._choose()

    def _choose(self) -> None:
        value = self._value
        if isinstance(value, MixedValue):
            self._box.setCurrentIndex(-1)
            return
        while self._box.count() > 1 + len(self._field.choices):
            self._box.removeItem(self._box.count() - 1)  # another feature's, see below
        index = 0 if value is None else self._box.findData(value)
        if index < 0:
            # A value that the catalogue no longer has: shown as it is.
            self._box.addItem(str(value), value)
            index = self._box.count() - 1
        self._box.setCurrentIndex(index)

    def _on_box_activated(self) -> None:
        self._report(self._box.currentData())

    def _on_clearing_triggered(self) -> None:
        self._line.setModified(False)
        self._report(None)
        self._write()

    def _on_line_editing_finished(self) -> None:
        if not self._line.isModified():
            return
        self._line.setModified(False)
        text = self._line.text().strip()
        value = read_value(self._field, text)
        # What can't be read is not taken; an empty line of several values says nothing.
        is_taken = value is not None or (not text and self._value is not SEVERAL)
        if is_taken:
            self._report(value)
        self._write()

    def _report(self, value: AttributeValue) -> None:
        if value != self._value:
            self._value = value
            self.edited.emit(self._field.id, value)


def read_value(field: AttributeField, text: str) -> AttributeValue:
    """What a text says as a value of the attribute; None when it says nothing valid."""
    if not text:
        return None
    if field.type in ("text", "choice"):
        return text
    plain = unicodedata.normalize("NFKC", text).replace("−", "-")
    if field.type == "number":
        try:
            return float(plain.replace(",", "."))
        except ValueError:
            return None
    if field.type == "count":
        return int(plain) if plain.isdecimal() else None
    date = QDate.fromString(plain.replace("/", "-"), "yyyy-M-d")
    return date.toString("yyyy-MM-dd") if date.isValid() else None


def format_attribute(value: AttributeValue) -> str:
    """A value as it is typed: the shortest text that reads back as the same number."""
    if value is None:
        return ""
    if not isinstance(value, float):
        return str(value)
    locale = QLocale.c()
    return locale.toString(value, "f", QLocale.FloatingPointPrecisionOption.FloatingPointShortest)
