"""Forms made from declarations: limits hold, defaults come back, both languages are there."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel, QLineEdit, QPushButton, QToolButton
from pytestqt.qtbot import QtBot

from processing.core.errors import OutOfRange
from processing.core.parameters import (
    ParameterChoice,
    choice,
    count,
    file,
    length,
    parameters_of,
    switch,
)
from processing.core.text import Language, Text
from processing.tools.listed.registry import TOOLS
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.panels.processing.processing_panel import ProcessingPanel
from widgets.parts.number_field import NumberField
from widgets.parts.search_field import SearchField


@dataclass(frozen=True)
class FormSettings:
    radius_m: float = length(
        0.5,
        low=0.05,
        high=5.0,
        name=Text("Radius", "半径"),
        explanation=Text("How far to look.", "探索する範囲。"),
    )
    neighbours: int = count(113, low=1, high=999, name=Text("Neighbours", "近傍点数"))
    method: str = choice(
        "fast",
        choices=(
            ParameterChoice("fast", Text("Fast", "高速")),
            ParameterChoice("exact", Text("Exact", "正確")),
        ),
        name=Text("Method", "方法"),
    )
    is_strict: bool = switch(default=False, name=Text("Strict", "厳密"))
    boundary: str = file(name=Text("Boundary", "範囲"))


@pytest.fixture
def form(qtbot: QtBot) -> ParameterForm:
    form = ParameterForm(FormSettings, "en")
    qtbot.addWidget(form)
    form.show()
    return form


def type_into(qtbot: QtBot, field: NumberField, text: str) -> None:
    field.setFocus()
    field.selectAll()
    qtbot.keyClicks(field, text)
    qtbot.keyClick(field, Qt.Key.Key_Return)


def test_an_untouched_form_gives_the_defaults(form: ParameterForm) -> None:
    assert form.value() == FormSettings()


def test_what_is_set_comes_back(form: ParameterForm) -> None:
    values = {"radius_m": 1.25, "neighbours": 7, "method": "exact", "is_strict": True}
    form.set_values(values)
    assert form.value() == FormSettings(1.25, 7, "exact", is_strict=True)


def test_what_is_typed_is_the_value(qtbot: QtBot, form: ParameterForm) -> None:
    field = form.field("radius_m")
    assert isinstance(field, NumberField)
    with qtbot.waitSignal(form.changed, timeout=30_000):
        type_into(qtbot, field, "2.125")
    assert form.value() == FormSettings(radius_m=2.125)


@pytest.mark.parametrize("text", ["99", "-1", "0.001", "abc"])
def test_a_number_outside_its_limits_is_not_taken(
    qtbot: QtBot, form: ParameterForm, text: str
) -> None:
    field = form.field("radius_m")
    assert isinstance(field, NumberField)
    type_into(qtbot, field, text)
    assert 0.05 <= form.value().radius_m <= 5.0


@pytest.mark.parametrize(
    "values", [{"radius_m": 99.0}, {"method": "other"}, {"neighbours": 0}, {"nothing": 1}]
)
def test_bad_values_are_refused_as_a_whole(
    form: ParameterForm, values: dict[str, float | str]
) -> None:
    with pytest.raises(OutOfRange):
        form.set_values({"is_strict": True, **values})
    assert form.value() == FormSettings()


def test_every_kind_has_its_field(qtbot: QtBot, form: ParameterForm) -> None:
    assert isinstance(form.field("method"), QComboBox)
    assert isinstance(form.field("is_strict"), QCheckBox)
    assert isinstance(form.field("boundary"), QLineEdit)
    qtbot.keyClicks(form.field("boundary"), "area.geojson")
    assert form.value().boundary == "area.geojson"


def test_the_unit_and_the_limits_are_shown(form: ParameterForm) -> None:
    field = form.field("radius_m")
    assert isinstance(field, NumberField)
    assert field.text() == "0.5 m"
    assert "How far to look." in field.toolTip()
    assert "0.05 to 5 m" in field.toolTip()


def test_a_default_can_be_restored(qtbot: QtBot, form: ParameterForm) -> None:
    form.set_values({"radius_m": 3.0})
    button = form.field("radius_m").parentWidget().findChild(QToolButton)
    assert button is not None
    assert button.isEnabled()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert form.value() == FormSettings()
    assert not button.isEnabled()


@pytest.mark.parametrize(("language", "word"), [("en", "Radius"), ("ja", "半径")])
def test_the_form_speaks_both_languages(qtbot: QtBot, language: Language, word: str) -> None:
    form = ParameterForm(FormSettings, language)
    qtbot.addWidget(form)
    assert word in [label.text() for label in form.findChildren(QLabel)]


@pytest.mark.parametrize("tool", TOOLS)
def test_every_tool_has_a_form_that_gives_its_defaults(qtbot: QtBot, tool: str) -> None:
    parameters = TOOLS[tool].parameters
    form = ParameterForm(parameters, "ja")
    qtbot.addWidget(form)
    value = form.value()
    for parameter in parameters_of(parameters):
        assert getattr(value, parameter.id) == pytest.approx(parameter.default)


def run_button(panel: ProcessingPanel) -> QPushButton:
    return next(one for one in panel.findChildren(QPushButton) if one.text() == "Run")


@pytest.fixture
def panel(qtbot: QtBot) -> ProcessingPanel:
    panel = ProcessingPanel("en")
    qtbot.addWidget(panel)
    panel.show()
    return panel


def test_run_asks_for_the_chosen_tool_with_its_parameters(
    qtbot: QtBot, panel: ProcessingPanel
) -> None:
    tool = list(TOOLS)[-1]
    panel.show_tool(tool)
    with qtbot.waitSignal(panel.run_requested) as asked:
        qtbot.mouseClick(run_button(panel), Qt.MouseButton.LeftButton)
    assert asked.args == [tool, TOOLS[tool].parameters()]


def test_a_tool_that_cannot_run_says_why(panel: ProcessingPanel) -> None:
    reason = Text("The drive has no turns.", "走行データに回転がありません。")
    panel.ask_reasons_from(lambda tool: reason if tool == next(iter(TOOLS)) else None)
    panel.show_tool(next(iter(TOOLS)))
    assert not run_button(panel).isEnabled()
    shown = [label.text() for label in panel.findChildren(QLabel) if label.isVisible()]
    assert reason.en in shown
    panel.show_tool(list(TOOLS)[-1])
    assert run_button(panel).isEnabled()


def test_what_a_tool_must_be_given_is_said_and_it_can_run(panel: ProcessingPanel) -> None:
    remark = Text("Give the direction.", "方位角を指定してください。")
    first, last = next(iter(TOOLS)), list(TOOLS)[-1]
    panel.ask_remarks_from(lambda tool: remark if tool == first else None)
    for tool in (first, last):
        panel.show_tool(tool)
        assert run_button(panel).isEnabled()
        shown = [label.text() for label in panel.findChildren(QLabel) if label.isVisible()]
        assert (remark.en in shown) == (tool == first)


def test_the_search_finds_tools_in_both_languages(qtbot: QtBot, panel: ProcessingPanel) -> None:
    wanted = list(TOOLS.values())[-1]
    search = panel.findChild(SearchField)
    assert search is not None
    search.setText(wanted.name.ja)
    assert panel.tool == wanted.id
    search.setText("there is no such tool")
    assert panel.form is None or panel.tool != ""


def test_forms_keep_what_was_set_while_another_tool_is_looked_at(
    panel: ProcessingPanel,
) -> None:
    first, last = next(iter(TOOLS)), list(TOOLS)[-1]
    panel.show_tool(first)
    form = panel.form
    assert form is not None
    parameter = next(p for p in parameters_of(TOOLS[first].parameters) if p.kind == "number")
    form.set_values({parameter.id: parameter.high})
    panel.show_tool(last)
    panel.show_tool(first)
    assert panel.form is form
    assert getattr(form.value(), parameter.id) == parameter.high


def test_a_low_panel_opens_its_list_to_choose_and_then_shows_the_whole_form(
    qtbot: QtBot, panel: ProcessingPanel
) -> None:
    panel.resize(270, 420)
    panel.show()
    qtbot.waitExposed(panel)
    (button,) = [
        one
        for one in panel.findChildren(QToolButton)
        if one.isVisible() and one.toolTip() == "Choose another tool"
    ]
    search = panel.findChild(SearchField)
    assert search is not None
    assert not search.isVisible()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert search.isVisible()
    qtbot.keyClicks(search, "noise")
    qtbot.keyClick(search, Qt.Key.Key_Return)
    assert panel.tool == "noise"
    assert not search.isVisible()
    assert panel.form is not None
    assert panel.form.isVisible()
    panel.resize(270, 700)
    assert search.isVisible()
    assert panel.form.isVisible()


def test_zero_is_shown_as_what_it_stands_for(qtbot: QtBot) -> None:
    form = ParameterForm(TOOLS["ground"].parameters, "en")
    qtbot.addWidget(form)
    field = form.field("grid_m")
    assert isinstance(field, NumberField)
    assert field.text() == "Automatic"
    field.setValue(0.5)
    assert field.text() == "0.5 m"
