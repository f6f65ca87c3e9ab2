"""The map is checked on demand; a row goes to its place, what is mended is one step."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Position, Vertex
from tests.widgets.builders import OpenMap
from widgets.panels.quality.quality_panel import QualityPanel

LEFT = Qt.MouseButton.LeftButton


def curb(id_: str, *positions: Position) -> Feature:
    return Feature(id_, "curb", Geometry.LINE, tuple(map(Vertex, positions)))


def at_once(work: Callable[[], object], take: Callable[[object | None], None]) -> None:
    take(work())


@pytest.fixture
def open_map() -> OpenMap:
    return OpenMap()


@pytest.fixture
def panel(qtbot: QtBot, open_map: OpenMap) -> QualityPanel:
    made = QualityPanel(open_map, open_map.shared, at_once, "en")
    qtbot.addWidget(made)
    made.change_requested.connect(open_map.apply)
    made.show()
    return made


def draw(open_map: OpenMap, *features: Feature) -> None:
    open_map.apply(Text.same("draw"), Change(added=features))


ACROSS = (
    curb("a", (0.0, 0.0, 5.0), (10.0, 10.0, 5.0)),
    curb("b", (0.0, 10.0, 5.0), (10.0, 0.0, 5.0)),
)


def test_an_empty_map_has_nothing_to_check(panel: QualityPanel) -> None:
    assert not panel.check_button.isEnabled()
    assert panel.words() == "Nothing is drawn yet."


def test_a_row_goes_to_its_place_and_chooses_its_features(
    qtbot: QtBot, panel: QualityPanel, open_map: OpenMap
) -> None:
    draw(open_map, *ACROSS)
    qtbot.mouseClick(panel.check_button, LEFT)
    assert panel.words() == "1 errors, 0 to look at"
    assert open_map.shared.selection.features == frozenset()
    item = panel.table.item(0, 0)
    assert item is not None
    assert item.text() == "Lines of one kind cross"
    spot = panel.table.visualItemRect(item).center()
    qtbot.mouseClick(panel.table.viewport(), LEFT, pos=spot)
    assert open_map.shared.selection.features == {"a", "b"}
    position = open_map.shared.cursor.position
    assert position is not None
    assert position.xyz == pytest.approx((5.0, 5.0, 5.0))
    assert not panel.mend_button.isEnabled()


def test_what_can_be_mended_is_mended_in_one_step_and_checked_again(
    qtbot: QtBot, panel: QualityPanel, open_map: OpenMap
) -> None:
    copy = curb("c", *(vertex.xyz for vertex in ACROSS[0].vertices))
    draw(open_map, ACROSS[0], copy, curb("d", (50.0, 0.0, 5.0), (50.001, 0.0, 5.0)))
    qtbot.mouseClick(panel.check_button, LEFT)
    before = len(open_map.applied)
    qtbot.mouseClick(panel.mend_button, LEFT)
    assert len(open_map.applied) == before + 1
    assert set(open_map.stored) == {"a"}
    assert panel.words() == "Nothing was found."


def test_a_change_makes_the_findings_old(
    qtbot: QtBot, panel: QualityPanel, open_map: OpenMap
) -> None:
    draw(open_map, *ACROSS)
    qtbot.mouseClick(panel.check_button, LEFT)
    open_map.apply(Text.same("delete"), Change(removed=(ACROSS[0],)))
    assert panel.findings == ()
    assert panel.words().startswith("Finds crossings")
