"""While a line is drawn, the cursor that all views share goes to each new vertex."""

from __future__ import annotations

from pytestqt.qtbot import QtBot

from app.window.window_parts import WindowParts
from processing.map.catalogue import Geometry
from processing.map.feature import Vertex
from widgets.shared.sketch import Drawing

PLACES = ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0))


def test_the_cursor_follows_each_vertex_and_stays_when_one_is_taken_back(
    parts: WindowParts, qtbot: QtBot
) -> None:
    shared = parts.document.shared
    vertices = tuple(Vertex(xyz) for xyz in PLACES)
    for count in (1, 2, 3):
        with qtbot.waitSignal(shared.cursor.moved):
            shared.sketch.show(Drawing("curb_upper", Geometry.LINE, vertices[:count]))
        assert shared.cursor.position is not None
        assert shared.cursor.position.xyz == PLACES[count - 1]
    shared.sketch.show(Drawing("curb_upper", Geometry.LINE, vertices[:2]))
    assert shared.cursor.position.xyz == PLACES[2]
    shared.sketch.show(None)
    assert shared.cursor.position.xyz == PLACES[2]


def test_the_cursor_stays_while_a_vertex_of_the_map_is_dragged(parts: WindowParts) -> None:
    shared = parts.document.shared
    vertices = tuple(Vertex(xyz) for xyz in PLACES)
    shared.sketch.show(Drawing("curb_upper", Geometry.LINE, vertices, replaces="line"))
    assert shared.cursor.position is None
    shared.sketch.show(None)
