"""The panel of volumes: what is compared, what came of it, how it is shown, by its widgets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import UTC, date, datetime
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel, QPushButton, QToolButton
from pytestqt.qtbot import QtBot

from processing.core.parameters import length
from processing.core.text import Text
from processing.methods.earthwork.volumes.volume_result import Registration, Volumes
from processing.project.volumes.epochs import Epoch
from processing.project.volumes.volume import ChosenSide, KeptVolume, SideKind, VolumeRequest
from tests.widgets.builders import OpenMap
from widgets.panels.volume.side_box import SideBox
from widgets.panels.volume.style_form import VolumeStyleForm
from widgets.panels.volume.volume_form import AreaChoice, FileArea
from widgets.panels.volume.volume_panel import VolumePanel
from widgets.parts.number_field import NumberField
from widgets.shared.shown_volume import ContourOf

LEFT = Qt.MouseButton.LeftButton
APRIL = Epoch((), "before", date(2026, 4, 1))
MAY = Epoch((), "after", date(2026, 5, 1))
SHIFT = Registration((0.003, -0.002, 0.0514), (0.001, 0.001, 0.0005), 812.0, True, False)
VOLUMES = Volumes(1234.56, 2345.67, 3210.0, 321.0, 45.6, 1200.0, 2300.0)


@dataclass(frozen=True)
class MeshParameters:
    """Parameters of a tool."""

    grid_m: float = length(0.5, low=0.05, high=5.0, name=Text("Mesh", "メッシュ"))


def _kept(id_: str, registration: Registration | None = SHIFT, *, hour: int = 9) -> KeptVolume:
    request = VolumeRequest(APRIL.side, MAY.side, {"grid_m": 0.5})
    made = datetime(2026, 5, 2, hour, tzinfo=UTC)
    notes = (Text("Much was filled in.", "補間が多くあります。"),)
    return KeptVolume(id_, made, 1, "EPSG:6677", request, VOLUMES, "grid", 0.5, registration, notes)


@pytest.fixture
def street() -> OpenMap:
    return OpenMap()


@pytest.fixture
def panel(qtbot: QtBot, street: OpenMap) -> VolumePanel:
    exports = (("report", Text("Report", "報告書")), ("xml", Text("Surface", "面")))
    shown = VolumePanel(street.shared, MeshParameters, exports, language="en")
    qtbot.addWidget(shown)
    shown.resize(280, 700)
    shown.show()
    qtbot.waitExposed(shown)
    return shown


def _button(panel: VolumePanel, words: str) -> QPushButton:
    return next(one for one in panel.findChildren(QPushButton) if one.text() == words)


def _pick(box: QComboBox, words: str) -> None:
    """Choose as the mouse would."""
    number = box.findText(words)
    assert number >= 0, [box.itemText(at) for at in range(box.count())]
    box.setCurrentIndex(number)
    box.activated.emit(number)


def test_the_older_epoch_is_what_was_before(panel: VolumePanel) -> None:
    panel.form.show_epochs((APRIL, MAY))
    assert panel.form.before.side == APRIL.side
    assert panel.form.after.side == MAY.side
    assert panel.form.before.currentText() == "before (2026-04-01)"


def test_what_was_chosen_stays_when_another_epoch_arrives(panel: VolumePanel) -> None:
    panel.form.show_epochs((APRIL, MAY))
    _pick(panel.form.after, "Level")
    panel.form.show_epochs((APRIL, Epoch((), "third", None), MAY))
    assert panel.form.after.side == ChosenSide(SideKind.LEVEL)
    assert panel.form.before.side == APRIL.side


def test_a_design_is_asked_for_and_then_chosen(qtbot: QtBot, panel: VolumePanel) -> None:
    panel.form.show_epochs((APRIL, MAY))
    box: SideBox = panel.form.after
    with qtbot.waitSignal(box.design_wanted):
        _pick(box, "Design from LandXML…")
    assert box.side == MAY.side, "until there is one"
    box.take_designs(Path("/x/設計.xml"), ("天端", "法面"))
    assert box.currentText() == "設計.xml: 天端"
    assert box.side == ChosenSide(
        SideKind.DESIGN, "設計.xml: 天端", path=str(Path("/x/設計.xml")), surface="天端"
    )
    _pick(box, "設計.xml: 法面")
    assert box.side is not None
    assert box.side.surface == "法面"


def test_a_level_has_its_height_in_a_field_that_is_there_for_it_alone(panel: VolumePanel) -> None:
    panel.form.show_epochs((APRIL, MAY))
    field = panel.form.findChildren(NumberField)[0]
    assert not field.isVisible()
    panel.form.choose_sides(None, ChosenSide(SideKind.LEVEL, height_m=4.25))
    assert field.isVisible()
    assert field.value() == 4.25
    field.setValue(6.5)
    assert panel.form.sides == (APRIL.side, ChosenSide(SideKind.LEVEL, height_m=6.5))


def test_a_reason_against_is_said_and_nothing_can_be_run(panel: VolumePanel) -> None:
    reasons = [Text("Both are the same.", "同じです。")]
    panel.form.ask_reason_from(lambda: reasons[0] if reasons else None)
    assert not _button(panel, "Compute the volume").isEnabled()
    assert any(one.text() == "Both are the same." for one in panel.findChildren(QLabel))
    reasons.clear()
    panel.form.refresh()
    assert _button(panel, "Compute the volume").isEnabled()


def test_ground_that_is_not_known_is_found_by_a_button(qtbot: QtBot, panel: VolumePanel) -> None:
    button = _button(panel, "Find the ground of both")
    assert not button.isVisible()
    panel.form.ask_reason_from(lambda: None)
    panel.form.ask_ground_from(lambda: True)
    assert button.isVisible()
    assert not _button(panel, "Compute the volume").isEnabled()
    with qtbot.waitSignal(panel.form.ground_requested):
        qtbot.mouseClick(button, LEFT)


def test_the_area_of_a_file_counts_once_there_is_one(qtbot: QtBot, panel: VolumePanel) -> None:
    box = next(one for one in panel.findChildren(QComboBox) if one.findText("Everything") >= 0)
    with qtbot.waitSignal(panel.form.boundary_wanted):
        _pick(box, "Area from a file…")
    assert panel.form.within is AreaChoice.EVERYTHING
    panel.form.take_boundaries(Path("/x/site.geojson"), ())
    assert panel.form.within is AreaChoice.FILE
    assert panel.form.boundary == FileArea(Path("/x/site.geojson"))
    assert box.currentText() == "site.geojson"
    _pick(box, "Selected areas")
    assert panel.form.within is AreaChoice.SELECTED
    assert panel.form.boundary is None
    _pick(box, "site.geojson")
    assert panel.form.boundary == FileArea(Path("/x/site.geojson"))


def test_of_a_file_with_several_layers_one_is_chosen(qtbot: QtBot, panel: VolumePanel) -> None:
    box = next(one for one in panel.findChildren(QComboBox) if one.findText("Everything") >= 0)
    plan = Path("/x/計画.dxf")
    panel.form.take_boundaries(plan, ("工区1", "工区2"))
    assert box.currentText() == "計画.dxf: 工区1"
    with qtbot.waitSignal(panel.form.changed):
        _pick(box, "計画.dxf: 工区2")
    assert panel.form.boundary == FileArea(plan, "工区2")
    with qtbot.waitSignal(panel.form.boundary_wanted):
        _pick(box, "Area from a file…")
    assert panel.form.boundary == FileArea(plan, "工区2"), "until there is another"
    panel.form.take_boundaries(Path("/x/b.gpkg"), ("工区3",))
    assert panel.form.boundary == FileArea(Path("/x/b.gpkg"))
    assert box.findText("計画.dxf: 工区1") < 0
    panel.form.start_anew()
    assert panel.form.within is AreaChoice.EVERYTHING
    assert box.findText("b.gpkg") < 0


def test_numbers_have_units_signs_and_their_digits(panel: VolumePanel) -> None:
    panel.show_volumes((_kept("a"),), "a")
    reported = {
        id_: panel.table.value(id_) for id_ in ("cut", "fill", "net", "uncertainty", "area")
    }
    assert reported == {
        "cut": "1,234.6",
        "fill": "2,345.7",
        "net": "+1,111.1",
        "uncertainty": "± 45.6",
        "area": "3,210.0",
    }
    assert panel.table.shift == "Shift of the epochs: E +3, N −2, H +51 mm"
    assert panel.table.notes == "Much was filled in."


def test_a_shift_is_corrected_by_a_button(qtbot: QtBot, panel: VolumePanel) -> None:
    panel.show_volumes((_kept("a"),), "a")
    button = _button(panel, "Correct and compute again")
    with qtbot.waitSignal(panel.table.correction_requested):
        qtbot.mouseClick(button, LEFT)
    panel.show_volumes((_kept("b", replace(SHIFT, is_corrected=True)),), "b")
    assert not button.isVisible()
    panel.show_volumes((_kept("c", None),), "c")
    assert not button.isVisible()


def test_results_are_listed_the_newest_first_chosen_and_removed(
    qtbot: QtBot, panel: VolumePanel
) -> None:
    assert panel.chosen == ""
    panel.show_volumes((_kept("old"), _kept("new", hour=10)), "new")
    (box,) = [one for one in panel.findChildren(QComboBox) if one.findData("old") >= 0]
    assert [box.itemData(at) for at in range(box.count())] == ["new", "old"]
    with qtbot.waitSignal(panel.volume_chosen) as reported:
        _pick(box, box.itemText(1))
    assert reported.args == ["old"]
    panel.show_volumes((_kept("old"), _kept("new", hour=10)), "old")
    (remove,) = [one for one in panel.findChildren(QToolButton) if one.text() == "✕"]
    with qtbot.waitSignal(panel.removal_requested) as reported:
        qtbot.mouseClick(remove, LEFT)
    assert reported.args == ["old"]


def test_exports_are_offered_by_name(qtbot: QtBot, panel: VolumePanel) -> None:
    panel.show_volumes((_kept("a"),), "a")
    actions = panel.export_menu.actions()
    assert [action.text() for action in actions] == ["Report", "Surface"]
    with qtbot.waitSignal(panel.export_requested) as reported:
        actions[1].trigger()
    assert reported.args == ["xml"]


def test_only_what_suits_a_volume_is_offered(panel: VolumePanel) -> None:
    panel.show_volumes((_kept("a"),), "a")
    panel.offer_exports({"xml"})
    assert [one.text() for one in panel.export_menu.actions() if one.isVisible()] == ["Surface"]
    panel.limits.setVisible(True)
    panel.show_volumes((_kept("b"),), "b")
    assert not panel.limits.isVisible(), "until it is said what was compared"


def test_range_and_contours_are_what_all_views_show(panel: VolumePanel, street: OpenMap) -> None:
    panel.show_volumes((_kept("a"),), "a")
    volume = street.shared.volume
    limit, interval = panel.findChildren(VolumeStyleForm)[0].findChildren(NumberField)
    limit.setValue(0.25)
    assert volume.look.limit_m == 0.25
    assert not interval.isEnabled()
    contours = next(
        one for one in panel.findChildren(QComboBox) if one.findText("Of the ground after") >= 0
    )
    _pick(contours, "Of the ground after")
    assert volume.look.contours is ContourOf.AFTER
    assert interval.isEnabled()
    shows = next(one for one in panel.findChildren(QCheckBox) if one.text() == "Show the heat map")
    shows.click()
    assert volume.drawn is None
    assert not volume.look.is_shown
    volume.use_look(replace(volume.look, limit_m=2.0))
    assert limit.value() == 2.0, "the field follows what others set"
