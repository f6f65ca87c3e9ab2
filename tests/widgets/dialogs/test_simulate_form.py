"""The form of a simulation: what is filled in is what is asked for; what can't be is said."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QDialogButtonBox, QLabel, QLineEdit, QPushButton, QTabBar
from pytestqt.qtbot import QtBot

from processing.laboratory.simulate.forecast import forecast_site, forecast_street
from processing.laboratory.simulate.requests import SiteRequest, StreetRequest
from widgets.dialogs.simulate import SimulateForm
from widgets.parts.density_view import DensityView
from widgets.parts.number_field import NumberField

PLENTY = 10**13


@pytest.fixture
def form(qtbot: QtBot, tmp_path: Path) -> SimulateForm:
    form = SimulateForm(tmp_path, "en")
    form.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, on=False)
    qtbot.addWidget(form)
    form.show()
    qtbot.waitExposed(form)
    form.ask_forecast()
    return form


def said(form: SimulateForm) -> str:
    return " ".join(one.text() for one in form.findChildren(QLabel) if one.isVisible())


def folder_of(form: SimulateForm) -> QLineEdit:
    (field,) = [one for one in form.findChildren(QLineEdit) if one.text().startswith("/")]
    return field


def create(form: SimulateForm) -> QPushButton:
    (button,) = [one for one in form.findChildren(QPushButton) if one.text() == "Create"]
    return button


def field(form: SimulateForm, order: str, id_: str, kind: type) -> object:
    found = form.form(order).field(id_)
    assert isinstance(found, kind)
    return found


def test_what_is_set_is_asked_for(qtbot: QtBot, form: SimulateForm, tmp_path: Path) -> None:
    field(form, "street", "length_m", NumberField).setValue(35.0)
    style = field(form, "street", "style", QComboBox)
    style.setCurrentIndex(style.findData("rural"))
    with qtbot.waitSignal(form.simulation_requested) as asked:
        qtbot.mouseClick(create(form), Qt.MouseButton.LeftButton)
    (request,) = asked.args
    assert request.order == "street"
    assert request.request == StreetRequest(length_m=35.0, style="rural")
    assert request.folder == tmp_path / "street-rural-1"
    assert not form.isVisible()


def test_the_proposed_folder_is_new_and_follows_the_values_until_one_is_typed(
    form: SimulateForm, tmp_path: Path, qtbot: QtBot
) -> None:
    (tmp_path / "street-urban-7").mkdir()
    field(form, "street", "seed", NumberField).setValue(7)
    assert form.request.folder == tmp_path / "street-urban-7-2"
    line = folder_of(form)
    line.selectAll()
    qtbot.keyClicks(line, str(tmp_path / "mine"))
    field(form, "street", "seed", NumberField).setValue(8)
    assert form.request.folder == tmp_path / "mine"


def test_every_change_asks_for_what_it_gives(qtbot: QtBot, form: SimulateForm) -> None:
    with qtbot.waitSignal(form.forecast_wanted) as asked:
        field(form, "street", "speed_km_h", NumberField).setValue(25.0)
    assert asked.args[0].request == StreetRequest(speed_km_h=25.0)
    with qtbot.waitSignal(form.forecast_wanted) as asked:
        form.findChild(QTabBar).setCurrentIndex(1)
    assert asked.args[0].request == SiteRequest()
    assert asked.args[0].folder.name == "site-levee-1"


def test_a_street_has_a_density_and_a_site_none(form: SimulateForm) -> None:
    form.show_forecast(forecast_street(StreetRequest(speed_km_h=36.0)), PLENTY)
    assert "Scan lines every 10.0 cm at 36 km/h" in said(form)
    assert form.findChild(DensityView).isVisible()
    form.show_forecast(forecast_site(SiteRequest()), PLENTY)
    assert not form.findChild(DensityView).isVisible()
    assert "points" in said(form)


def test_too_little_room_is_said_and_nothing_can_be_made(form: SimulateForm) -> None:
    form.show_forecast(forecast_street(StreetRequest()), 1_000_000)
    assert "The disk has only" in said(form)
    assert not create(form).isEnabled()
    form.show_forecast(forecast_street(StreetRequest()), PLENTY)
    assert "The disk has only" not in said(form)
    assert create(form).isEnabled()


def test_a_folder_in_use_and_none_are_refused(
    qtbot: QtBot, form: SimulateForm, tmp_path: Path
) -> None:
    (tmp_path / "used").mkdir()
    (tmp_path / "used" / "file").touch()
    for words, trouble in ((str(tmp_path / "used"), "not empty"), ("", "Give a folder")):
        line = next(one for one in form.findChildren(QLineEdit) if one.parent() is form)
        line.setText(words)
        with qtbot.assertNotEmitted(form.simulation_requested):
            form.findChild(QDialogButtonBox).accepted.emit()
        assert trouble in said(form)
        assert form.isVisible()


def test_f1_and_the_button_ask_for_help(qtbot: QtBot, form: SimulateForm) -> None:
    with qtbot.waitSignal(form.help_requested):
        qtbot.keyClick(form, Qt.Key.Key_F1)
    with qtbot.waitSignal(form.help_requested):
        form.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Help).click()
