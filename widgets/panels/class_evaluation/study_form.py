"""StudyForm: which tool is studied, over which values, where."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QSpinBox,
    QWidget,
)

from processing.core.parameters import Parameter
from processing.core.text import Language
from processing.project.evaluation.parameter_study import (
    MOST_CELLS,
    MOST_STEPS,
    VariedParameter,
    can_vary,
    steps_of,
    usual_range,
)
from processing.tools.listed.registry import asked_classes
from widgets.panels.run_words import name_of_tool
from widgets.parts.number_field import NumberField, decimals_for

_PART, _WHOLE = "part", "whole"
_FIELD_PX = 72
_USUAL_STEPS = 5
_SECOND_STEPS = 4


class RangeRow:
    """One parameter with from, to and steps, in a row of a grid.

    Parameters
    ----------
    form : QWidget
    is_second : bool
        Whether there may be none.
    """

    def __init__(self, form: QWidget, language: Language, *, is_second: bool) -> None:
        self._form = form
        self._language: Language = language
        self._is_second = is_second
        self._parameters: dict[str, Parameter] = {}
        self.choice = QComboBox(form)
        self.choice.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.choice.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.low = NumberField(0.0, 1.0, parent=form)
        self.high = NumberField(0.0, 1.0, parent=form)
        for field in (self.low, self.high):
            field.setMinimumWidth(_FIELD_PX)
        self.steps = QSpinBox(form)
        self.steps.setRange(2, MOST_STEPS)
        self.steps.setValue(_SECOND_STEPS if is_second else _USUAL_STEPS)
        self.choice.currentIndexChanged.connect(self._show_limits)

    def show_tool(self, tool: str, first: int, none: str) -> None:
        """Offer the parameters of a tool; ``none`` is the word for no second one."""
        self._parameters = {one.id: one for one in can_vary(tool)}
        self.choice.clear()
        if self._is_second:
            self.choice.addItem(none, "")
        for one in self._parameters.values():
            self.choice.addItem(one.name.in_language(self._language), one.id)
        self.choice.setCurrentIndex(first)
        self._show_limits()

    @property
    def varied(self) -> VariedParameter | None:
        """What is chosen; None for none."""
        parameter = self._parameters.get(str(self.choice.currentData() or ""))
        if parameter is None:
            return None
        return steps_of(parameter, self.low.value(), self.high.value(), self.steps.value())

    def _show_limits(self) -> None:
        parameter = self._parameters.get(str(self.choice.currentData() or ""))
        is_number = parameter is not None and parameter.kind in ("number", "count")
        for field in (self.low, self.high, self.steps):
            field.setEnabled(is_number)
        if parameter is None or not is_number:
            return
        low, high = usual_range(parameter)
        decimals = 0 if parameter.kind == "count" else decimals_for(parameter.low, low, high)
        for field, value in ((self.low, low), (self.high, high)):
            field.setDecimals(decimals)
            field.setRange(parameter.low, parameter.high)
            field.setSuffix(f" {parameter.unit}" if parameter.unit else "")
            field.setValue(value)


class StudyForm(QWidget):
    """What a study goes through.

    Parameters
    ----------
    language : Language

    Signals
    -------
    study_requested
        The button was pressed.
    tool_chosen
        Another tool.
    """

    study_requested = Signal()
    tool_chosen = Signal()

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._tool = QComboBox(self)
        for tool in asked_classes():
            self._tool.addItem(name_of_tool(tool, language), tool)
        self.first = RangeRow(self, language, is_second=False)
        self.second = RangeRow(self, language, is_second=True)
        self._where = QComboBox(self)
        self._where.addItem(self.tr("Around the points of the truth"), _PART)
        self._where.addItem(self.tr("On the whole drive"), _WHOLE)
        self._where.setToolTip(
            self.tr("Around few points it is quick; some methods look at the whole cloud, though.")
        )
        self._note = QLabel(self)
        self._note.setEnabled(False)
        self._note.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._button = QPushButton(self.tr("Study"), self)
        self._lay_out()
        self._tool.currentIndexChanged.connect(self._on_tool_changed)
        self._button.clicked.connect(self.study_requested)
        for row in (self.first, self.second):
            row.choice.currentIndexChanged.connect(self._show_count)
            row.low.valueChanged.connect(self._show_count)
            row.high.valueChanged.connect(self._show_count)
            row.steps.valueChanged.connect(self._show_count)
        self._why_not = self._settings = ""
        self._on_tool_changed()

    @property
    def tool(self) -> str:
        """Id of the tool."""
        return str(self._tool.currentData() or "")

    @property
    def varied(self) -> tuple[VariedParameter, ...]:
        """What is gone through; one or two."""
        rows = (self.first.varied, self.second.varied)
        return tuple(one for one in rows if one is not None)

    @property
    def is_part(self) -> bool:
        """Whether only the surroundings of the truth's points are looked at."""
        return str(self._where.currentData()) == _PART

    def show_settings(self, words: str) -> None:
        """Say how the tool is set otherwise."""
        self._settings = words
        self._show_count()

    def refuse(self, why_not: str) -> None:
        """Say why nothing can be studied now; empty: it can."""
        self._why_not = why_not
        self._show_count()

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(4)
        grid.addWidget(QLabel(self.tr("Tool"), self), 0, 0)
        grid.addWidget(self._tool, 0, 1)
        for column, words in enumerate((self.tr("from"), self.tr("to"), self.tr("values")), 2):
            grid.addWidget(QLabel(words, self), 0, column)
        names = (self.tr("Parameter"), self.tr("and"))
        for line, (name, row) in enumerate(zip(names, (self.first, self.second), strict=True), 1):
            grid.addWidget(QLabel(name, self), line, 0)
            fields = (row.choice, row.low, row.high, row.steps)
            for column, field in enumerate(fields, 1):
                grid.addWidget(field, line, column)
        grid.addWidget(QLabel(self.tr("Where"), self), 3, 0)
        grid.addWidget(self._where, 3, 1, 1, 4)
        grid.addWidget(self._note, 4, 0, 1, 4)
        grid.addWidget(self._button, 4, 4)
        grid.setRowStretch(5, 1)
        grid.setColumnStretch(1, 1)

    def _on_tool_changed(self) -> None:
        if self.tool:
            numbers = [
                position
                for position, one in enumerate(can_vary(self.tool))
                if one.kind in ("number", "count")
            ]
            none = self.tr("no other")
            self.first.show_tool(self.tool, numbers[0] if numbers else 0, none)
            self.second.show_tool(self.tool, 0, none)
        self._show_count()
        self.tool_chosen.emit()

    def _show_count(self) -> None:
        varied = self.varied
        count = 1
        for one in varied:
            count *= len(one.values)
        is_twice = len({one.parameter for one in varied}) < len(varied)
        is_right = bool(varied) and not is_twice and count <= MOST_CELLS
        self._button.setEnabled(is_right and not self._why_not)
        if self._why_not:
            words = self._why_not
        elif is_twice:
            words = self.tr("Choose two different parameters.")
        elif count > MOST_CELLS:
            words = self.tr("Choose fewer values: at most {most} runs.").format(most=MOST_CELLS)
        else:
            words = self.tr("{count} runs; otherwise as in Processing: {settings}").format(
                count=count, settings=self._settings or "–"
            )
        self._note.setText(words)
        self._note.setToolTip(words)
