"""ParameterRow: the field of one parameter and the button that restores its default."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFileDialog,
    QHBoxLayout,
    QLineEdit,
    QToolButton,
    QWidget,
)

from processing.core.parameters import MOST_LETTERS, Parameter, ParameterValue
from processing.core.text import Language
from widgets.parts.number_field import NumberField, decimals_for

_LEAST_LETTERS, _LIST_MARGIN_PX = 8, 24


class ParameterRow(QWidget):
    """One parameter.

    Parameters
    ----------
    parameter : Parameter
    language : Language

    Attributes
    ----------
    field : QWidget
        Number field, combo box, check box or line, by the parameter's kind. A line of text is
        emptied in itself, the others have a button that restores the default.

    Signals
    -------
    changed()
        The user set another value.
    """

    changed = Signal()

    def __init__(self, parameter: Parameter, language: Language, parent: QWidget) -> None:
        super().__init__(parent)
        self._parameter = parameter
        self._layout = QHBoxLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setSpacing(4)
        self._get: Callable[[], ParameterValue]
        self._set: Callable[[ParameterValue], None]
        self.field: QWidget
        make = {
            "number": self._make_number,
            "count": self._make_number,
            "choice": self._make_choice,
            "switch": self._make_switch,
            "file": self._make_file,
            "text": self._make_text,
        }
        make[parameter.kind](language)
        self._restore = QToolButton(self)
        self._restore.setText("↺")
        self._restore.setAutoRaise(True)
        self._restore.setToolTip(self.tr("Back to the default"))
        self._restore.clicked.connect(self._on_restore_clicked)
        self._restore.setVisible(parameter.kind != "text")
        self._layout.addWidget(self._restore)
        self.restore()

    @property
    def value(self) -> ParameterValue:
        """What is set."""
        return self._get()

    def set_value(self, value: ParameterValue) -> None:
        """Set it; tells nobody."""
        with QSignalBlocker(self.field):
            self._set(value)
        self._mark()

    def restore(self) -> None:
        """Set the default; tells nobody."""
        self.set_value(self._parameter.default)

    def _make_number(self, language: Language) -> None:
        parameter = self._parameter
        is_count = parameter.kind == "count"
        default = float(parameter.default)
        decimals = 0 if is_count else decimals_for(default, parameter.low, parameter.high)
        field = NumberField(
            parameter.low, parameter.high, unit=parameter.unit, decimals=decimals, parent=self
        )
        if parameter.zero.en:
            field.setSpecialValueText(parameter.zero.in_language(language))
        field.valueChanged.connect(self._on_field_changed)

        def get() -> ParameterValue:
            return round(field.value()) if is_count else field.value()

        def put(value: ParameterValue) -> None:
            field.setValue(float(value))

        self._take(field, get, put)

    def _make_choice(self, language: Language) -> None:
        field = QComboBox(self)
        for option in self._parameter.choices:
            field.addItem(option.name.in_language(language), option.value)
        # A long word must not make a form wider than its panel; the list shows it whole.
        field.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        field.setMinimumContentsLength(_LEAST_LETTERS)
        widest = max(field.fontMetrics().horizontalAdvance(one) for one in _words_of(field))
        field.view().setMinimumWidth(widest + _LIST_MARGIN_PX)
        field.currentIndexChanged.connect(self._on_field_changed)

        def get() -> ParameterValue:
            return str(field.currentData())

        def put(value: ParameterValue) -> None:
            field.setCurrentIndex(field.findData(value))

        self._take(field, get, put)

    def _make_switch(self, language: Language) -> None:  # noqa: ARG002 - as the others are called
        field = QCheckBox(self)
        field.toggled.connect(self._on_field_changed)

        def put(value: ParameterValue) -> None:
            field.setChecked(bool(value))

        self._take(field, field.isChecked, put)

    def _make_text(self, language: Language) -> None:  # noqa: ARG002 - as the others are called
        field = QLineEdit(self)
        field.setMaxLength(MOST_LETTERS)
        field.setClearButtonEnabled(True)
        self._take_line(field)

    def _make_file(self, language: Language) -> None:
        field = QLineEdit(self)
        field.setPlaceholderText(self.tr("None"))

        def choose() -> None:
            path, _ = QFileDialog.getOpenFileName(self, self._parameter.name.in_language(language))
            if path:
                field.setText(path)

        self._take_line(field)
        browse = QToolButton(self)
        browse.setText("…")
        browse.setToolTip(self.tr("Choose a file"))
        browse.clicked.connect(choose)
        self._layout.addWidget(browse)

    def _take_line(self, field: QLineEdit) -> None:
        field.textChanged.connect(self._on_field_changed)

        def put(value: ParameterValue) -> None:
            field.setText(str(value))

        self._take(field, field.text, put)

    def _take(
        self,
        field: QWidget,
        get: Callable[[], ParameterValue],
        put: Callable[[ParameterValue], None],
    ) -> None:
        self.field, self._get, self._set = field, get, put
        field.setObjectName(self._parameter.id)
        self._layout.addWidget(field, 1)

    def _mark(self) -> None:
        self._restore.setEnabled(self._get() != self._parameter.default)

    def _on_field_changed(self) -> None:
        self._mark()
        self.changed.emit()

    def _on_restore_clicked(self) -> None:
        self.restore()
        self.changed.emit()


def _words_of(field: QComboBox) -> list[str]:
    return [field.itemText(number) for number in range(field.count())]
