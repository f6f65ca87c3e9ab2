"""The export form offers the formats that it is given, and what can be chosen for them."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QCheckBox, QComboBox, QDialogButtonBox, QLabel
from pytestqt.qtbot import QtBot

from processing.formats.registry import FORMATS
from tests.processing.formats.tiny_format import TINY
from widgets.dialogs.export_map import ExportChoices, ExportForm, ExportOptions


def _form(qtbot: QtBot, folder: Path) -> ExportForm:
    formats = FORMATS.including(TINY)
    titles = tuple((one.id, one.map_title) for one in formats.maps() if one.map_title)
    choices = ExportChoices(titles, formats.map_options(), formats.map_option_owners())
    form = ExportForm(folder, choices, "en")
    qtbot.addWidget(form)
    return form


def test_an_added_format_is_offered_with_its_option(qtbot: QtBot, tmp_path: Path) -> None:
    form = _form(qtbot, tmp_path)
    assert "Tiny drawing" in [box.text() for box in form.findChildren(QCheckBox)]
    assert "Decimals of TINY" in [label.text() for label in form.findChildren(QLabel)]


def test_what_is_chosen_is_asked_for(qtbot: QtBot, tmp_path: Path) -> None:
    form = _form(qtbot, tmp_path)
    for box in form.findChildren(QCheckBox):
        box.setChecked(box.text() == "Tiny drawing")
    version, *_ = form.findChildren(QComboBox)
    version.setCurrentIndex(version.findData("R2000"))
    (buttons,) = form.findChildren(QDialogButtonBox)
    with qtbot.waitSignal(form.export_requested) as asked:
        buttons.accepted.emit()
    (request,) = asked.args
    assert isinstance(request, ExportOptions)
    assert request.formats == ("tiny",)
    expected = {
        "dxf_version": "R2000",
        "dxf_heights": "3d",
        "drawing_layers": "codes",
        "encoding": "utf-8",
        "digits": 3,
        "dm_accuracy": 34,
        "dm_company": "",
        "dm_approval": "",
        "check_points": "",
        "check_map": "",
        "map_level": "500",
        "sheet_scale": "500",
        "sheet_division": "grid",
        "sheet_paper": "A1",
        "sheet_overlap": 10.0,
        "sheet_route": "",
        "sheet_title": "",
        "sheet_client": "",
        "sheet_maker": "",
        "sheet_surveyor": "",
        "sheet_date": "",
        "sheet_heights": "",
        "delivery_start": "",
        "delivery_end": "",
        "delivery_area": "",
        "delivery_advice": "",
        "delivery_folder": "",
        "delivery_edition": "",
        "delivery_dtds": "",
        "section_scale": "100",
        "section_height_scale": "100",
        "profile_scale": "500",
        "profile_height_scale": "100",
        "section_pitch": 20.0,
        "section_stations": "",
        "section_reach": 10.0,
        "section_depth": 0.5,
        "landxml_form": "J-LandXML",
        "lane_pitch": 5.0,
        "road_pitch": 20.0,
        "road_clearance": 4.5,
        "walk_clearance": 2.5,
        "tiny_decimals": 1,
    }
    assert request.options == expected


def test_options_are_those_of_the_ticked_formats(qtbot: QtBot, tmp_path: Path) -> None:
    form = _form(qtbot, tmp_path)
    form.show()
    shown = {label.text() for label in form.findChildren(QLabel) if label.isVisible()}
    assert "Version of DXF" in shown
    assert "Decimals of TINY" not in shown
    for box in form.findChildren(QCheckBox):
        box.setChecked(box.text() == "Tiny drawing")
    shown = {label.text() for label in form.findChildren(QLabel) if label.isVisible()}
    assert "Decimals of TINY" in shown
    assert "Version of DXF" not in shown
