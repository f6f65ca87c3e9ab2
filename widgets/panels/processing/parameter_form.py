"""ParameterForm: a form made from any tool's parameters; nothing about a tool is drawn by hand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QEvent, QObject, Signal
from PySide6.QtWidgets import QFormLayout, QLabel, QWidget
from typing_extensions import override

from processing.core.parameters import Parameter, ParameterValue, fill_parameters, parameters_of
from processing.core.text import Language
from widgets.panels.processing.parameter_row import ParameterRow


class ParameterForm(QWidget):
    """One line for each parameter: name, field with unit and limits, and a way back to the default.

    Parameters
    ----------
    parameters : type
        A tool's frozen dataclass of fields from :mod:`processing.core.parameters`.
    language : Language
    has_typed : bool
        Whether what is typed, files and texts, can be given; else it keeps its defaults.

    Signals
    -------
    changed()
        The user set a value.
    pictured(picture: str)
        What shows the meaning of the parameter under the mouse or, without one there, of that in
        focus; empty where neither has a picture.
    """

    changed = Signal()
    pictured = Signal(str)

    def __init__(
        self,
        parameters: type[Any],  # each tool has a dataclass of its own
        language: Language,
        parent: QWidget | None = None,
        *,
        has_typed: bool = True,
    ) -> None:
        super().__init__(parent)
        self._parameters = parameters
        self._rows: dict[str, ParameterRow] = {}
        self._pictures: dict[QObject, str] = {}
        self._lines: set[QObject] = set()
        self._hovered = self._focused = ""
        layout = QFormLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(8)
        layout.setVerticalSpacing(4)
        layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        layout.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        for parameter in parameters_of(parameters):
            if parameter.is_typed and not has_typed:
                continue
            row = ParameterRow(parameter, language, self)
            row.changed.connect(self.changed)
            name = QLabel(parameter.name.in_language(language), self)
            name.setToolTip(self._explanation(parameter, language))
            name.setBuddy(row.field)
            row.field.setToolTip(name.toolTip())
            layout.addRow(name, row)
            self._rows[parameter.id] = row
            self._watch(parameter, name, row)
        if not self._rows:
            layout.addRow(QLabel(self.tr("This tool needs no settings."), self))

    def value(self) -> Any:  # an object of the class given
        """The parameters as they are set, checked once more.

        Raises
        ------
        OutOfRange
            A value isn't allowed; the fields don't let that happen by typing.
        """
        return fill_parameters(
            self._parameters, {id_: row.value for id_, row in self._rows.items()}
        )

    def set_values(self, values: Mapping[str, ParameterValue]) -> None:
        """Set some of the fields that are shown; what is outside its limits is refused as a whole.

        Raises
        ------
        OutOfRange
            For a name that there isn't, or a value that isn't allowed; nothing is set.
        """
        checked = fill_parameters(self._parameters, values)
        for id_ in values:
            if id_ in self._rows:
                self._rows[id_].set_value(getattr(checked, id_))

    def field(self, id_: str) -> QWidget:
        """The widget in which a parameter is typed."""
        return self._rows[id_].field

    @property
    def picture(self) -> str:
        """What shows the parameter at hand; the first one's before any was at hand."""
        first = next((one for one in self._pictures.values() if one), "")
        return self._hovered or self._focused or first

    @property
    def has_pictures(self) -> bool:
        """Whether any of the parameters has one."""
        return any(self._pictures.values())

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Note which parameter the mouse or the keyboard is at."""
        picture = self._pictures.get(watched, "")
        match event.type():
            case QEvent.Type.Enter if watched in self._lines:
                self._hovered = picture
            case QEvent.Type.Leave if watched in self._lines:
                self._hovered = ""
            case QEvent.Type.FocusIn:
                self._focused = picture
            case _:
                return super().eventFilter(watched, event)
        self.pictured.emit(self.picture)
        return super().eventFilter(watched, event)

    def _watch(self, parameter: Parameter, name: QLabel, row: ParameterRow) -> None:
        # The mouse is in a row wherever in it; the focus is at what is typed into.
        self._lines.update((name, row))
        for part in (name, row, row.field, *row.field.findChildren(QWidget)):
            self._pictures[part] = parameter.picture
            part.installEventFilter(self)

    def _explanation(self, parameter: Parameter, language: Language) -> str:
        parts = [parameter.explanation.in_language(language)]
        if parameter.kind in ("number", "count"):
            limits = self.tr("{low} to {high} {unit}").format(
                low=f"{parameter.low:g}", high=f"{parameter.high:g}", unit=parameter.unit
            )
            parts.append(limits.strip())
        return "\n".join(part for part in parts if part)
