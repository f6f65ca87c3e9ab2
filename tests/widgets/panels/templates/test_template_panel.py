"""The template panel: what is drawn becomes a template, seen at the cursor, fitted from there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.feature import Position
from processing.methods.templates.profile_template import MadeLine
from processing.project.project import Project
from processing.project.template_store import TemplateStore
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.tools.template import TemplateParameters
from tests.processing.methods.templates.curb_street import (
    CURB,
    CURB_FRAME,
    CURB_HEIGHT_M,
    WALL_FOOT,
    recorded,
)
from tests.widgets.builders import KINDS, OpenMap, do_now
from widgets.mouse_tools.drawing.draw_template import DrawnProfile, TemplatePart
from widgets.panels.templates.template_panel import NOWHERE, TemplatePanel
from widgets.panels.templates.template_picture import TemplatePicture
from widgets.shared.cursor import PickedPosition

EAST, NORTH, HEIGHT = CURB_FRAME.position.tolist()
RIGHT = (float(CURB_FRAME.right[0]), float(CURB_FRAME.right[1]))
CUT = Cut((EAST, NORTH, HEIGHT), RIGHT, width_m=0.5, half_length_m=6.0)


def position(across: float, up: float) -> Position:
    """A place of the section about the curb's upper edge."""
    easting, northing, height = CUT.to_space([[across, HEIGHT + up, 0.0]])[0].tolist()
    return easting, northing, height


ON_CURB = PickedPosition(position(0.0, 0.0))
DRAWN = DrawnProfile(
    TemplatePart.SHAPE,
    CUT,
    (
        (position(0.0, 0.0), position(0.0, -CURB_HEIGHT_M), position(0.3, -CURB_HEIGHT_M + 0.006)),
        (position(0.0, 0.0), position(-0.3, 0.0)),
    ),
)
ZONE = DrawnProfile(
    TemplatePart.EMPTY_ZONE,
    CUT,
    ((position(-0.2, 0.1), position(0.2, 0.1), position(0.2, 0.4), position(-0.2, 0.4)),),
)


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory.mktemp("street"))


@pytest.fixture
def store(tmp_path: Path) -> Iterator[TemplateStore]:
    project = Project.create(tmp_path / "street.zuka", "EPSG:6677")
    yield TemplateStore(project.settings)
    project.close()


@pytest.fixture
def open_map(street: Drive) -> OpenMap:
    return OpenMap((street,))


@pytest.fixture
def panel(qtbot: QtBot, open_map: OpenMap, store: TemplateStore) -> TemplatePanel:
    panel = TemplatePanel(open_map, open_map.shared, lambda: store, do_now)
    qtbot.addWidget(panel)
    panel.resize(280, 620)
    panel.show()
    return panel


def button(panel: TemplatePanel, words: str) -> QPushButton:
    return next(one for one in panel.findChildren(QPushButton) if one.text() == words)


def words(panel: TemplatePanel) -> str:
    return " ".join(one.text() for one in panel.findChildren(QLabel) if one.isVisible())


def press(qtbot: QtBot, panel: TemplatePanel, name: str) -> None:
    qtbot.mouseClick(button(panel, name), Qt.MouseButton.LeftButton)


def test_an_empty_panel_says_what_to_do(qtbot: QtBot, panel: TemplatePanel) -> None:
    assert "Draw a curb" in words(panel)
    assert not button(panel, "Fit from here").isVisible()
    with qtbot.waitSignal(panel.draw_requested) as asked:
        press(qtbot, panel, "Draw new")
    assert asked.args == [TemplatePart.SHAPE]


def test_what_was_drawn_is_kept_and_lies_where_it_was_drawn(
    panel: TemplatePanel, store: TemplateStore
) -> None:
    panel.take_drawn(DRAWN)
    (template,) = store.all()
    assert template.shape == (
        ((0.0, 0.0), (0.0, -0.15), (0.3, -0.144)),
        ((0.0, 0.0), (-0.3, 0.0)),
    )
    assert template.lines == (MadeLine("curb"),)
    assert "Score here: 1.00" in words(panel)


def test_fit_from_here_hands_over_the_template_its_place_and_direction(
    qtbot: QtBot, panel: TemplatePanel, street: Drive, store: TemplateStore
) -> None:
    store.put(CURB)
    panel.read_project()
    assert not button(panel, "Fit from here").isEnabled()
    panel.use_cut(CUT)
    panel._shared.cursor.move_to(ON_CURB)
    with qtbot.waitSignal(panel.fit_requested) as asked:
        press(qtbot, panel, "Fit from here")
    drive, parameters = asked.args
    assert drive == street.id
    assert isinstance(parameters, TemplateParameters)
    assert (parameters.easting_m, parameters.height_m) == pytest.approx((EAST, HEIGHT), abs=1e-3)
    looked = (90.0 - parameters.heading_deg) % 360.0
    assert looked == pytest.approx(CURB_FRAME.heading_rad * 180 / 3.14159265 % 360, abs=0.01)
    assert '"curb"' in parameters.template


def test_the_score_follows_the_cursor(panel: TemplatePanel, store: TemplateStore) -> None:
    store.put(CURB)
    panel.read_project()
    assert "Put the cursor" in words(panel)
    panel.use_cut(CUT)
    panel._shared.cursor.move_to(ON_CURB)
    assert "Score here: 1.00" in words(panel)
    panel._shared.cursor.move_to(PickedPosition(position(2.5, -0.1)))
    assert "Score here: 0." in words(panel)


def test_an_empty_zone_is_added_where_the_template_lies(
    qtbot: QtBot, panel: TemplatePanel, store: TemplateStore
) -> None:
    reported: list[Text] = []
    panel.reported.connect(reported.append)
    store.put(CURB)
    panel.read_project()
    panel.take_drawn(ZONE)
    assert reported == [NOWHERE]
    panel.use_cut(CUT)
    panel._shared.cursor.move_to(ON_CURB)
    with qtbot.waitSignal(panel.draw_requested) as asked:
        press(qtbot, panel, "Add empty zone")
    assert asked.args == [TemplatePart.EMPTY_ZONE]
    panel.take_drawn(ZONE)
    (zone,) = store.all()[0].empty
    for corner, wanted in zip(
        zone, [(-0.2, 0.1), (0.2, 0.1), (0.2, 0.4), (-0.2, 0.4)], strict=True
    ):
        assert corner == pytest.approx(wanted, abs=0.01)
    press(qtbot, panel, "Remove zones")
    assert store.all()[0].empty == ()


def test_a_vertex_that_is_clicked_gets_a_line_of_its_own(
    qtbot: QtBot, panel: TemplatePanel, store: TemplateStore
) -> None:
    store.put(CURB)
    panel.read_project()
    foot = (0.0, -CURB_HEIGHT_M)
    picture = panel.findChild(TemplatePicture)
    assert isinstance(picture, TemplatePicture)
    qtbot.mouseClick(picture, Qt.MouseButton.LeftButton, pos=picture.position_of(foot).toPoint())
    assert panel.form.marked == foot
    kinds = panel.form.findChild(QComboBox)
    assert isinstance(kinds, QComboBox)
    kinds.setCurrentIndex(kinds.findData("curb"))
    kinds.activated.emit(kinds.currentIndex())
    assert store.all()[0].kind_at(foot) == "curb"
    kinds.setCurrentIndex(0)
    kinds.activated.emit(0)
    assert store.all()[0].kind_at(foot) == ""
    assert panel.form.marked == foot


def test_templates_are_renamed_removed_imported_and_exported(
    panel: TemplatePanel, store: TemplateStore, tmp_path: Path
) -> None:
    refused: list[UserError] = []
    panel.refused.connect(refused.append)
    store.put(CURB)
    store.put(WALL_FOOT)
    panel.read_project()
    assert panel.list.names == ("curb", "step")
    panel.list.rename("壁の下端")
    assert panel.list.names == ("curb", "壁の下端")
    panel.list.rename("curb")
    assert len(refused) == 1
    assert panel.list.names == ("curb", "壁の下端")
    panel.list.export_to(tmp_path / "wall.json")
    panel.list.import_file(tmp_path / "wall.json")
    assert panel.list.names == ("curb", "壁の下端", "壁の下端 2")
    panel.list.remove()
    assert panel.list.names == ("curb", "壁の下端")
    panel.list.import_file(tmp_path / "none.json")
    assert len(refused) == 2


def test_the_newest_request_for_a_look_counts(
    qtbot: QtBot, open_map: OpenMap, store: TemplateStore
) -> None:
    waiting: list[tuple[Callable[[], object], Callable[[object | None], None]]] = []
    store.put(CURB)
    panel = TemplatePanel(
        open_map, open_map.shared, lambda: store, lambda w, t: waiting.append((w, t))
    )
    qtbot.addWidget(panel)
    panel.use_cut(CUT)
    panel.show()
    for across in (2.0, 1.0, 0.0):
        open_map.shared.cursor.move_to(PickedPosition(position(across, 0.0)))
    assert len(waiting) == 1
    work, take = waiting.pop()
    take(work())
    ((work, take),) = waiting
    take(work())
    assert "Score here: 1.00" in words(panel)


def test_without_a_project_nothing_can_be_drawn(qtbot: QtBot) -> None:
    empty = OpenMap()
    panel = TemplatePanel(empty, empty.shared, lambda: None, do_now, language="ja")
    qtbot.addWidget(panel)
    panel.show()
    assert not button(panel, "Draw new").isEnabled()
    panel.use_kind(KINDS["curb"])
    panel.take_drawn(DRAWN)
    assert panel.list.names == ()
