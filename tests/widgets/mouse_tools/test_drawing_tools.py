"""Drawing tools alone: hits in, sketch and change out, whichever view sent the hits."""

from __future__ import annotations

import pytest

from processing.project.catalogue import Geometry
from processing.project.change import Change
from processing.project.feature import PointReference
from processing.text import Text
from tests.widgets.builders import shared_state
from widgets.mouse_tools.draw_area import DrawArea
from widgets.mouse_tools.draw_line import DrawLine
from widgets.mouse_tools.draw_point import DrawPoint
from widgets.mouse_tools.drawing_tool import NO_KIND, NO_POINT, TOO_FEW, DrawingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.cursor import Place

A, B, C, D = (
    Place((float(number), 10.5 * number, 3.25), PointReference("left", number))
    for number in range(4)
)


class Desk:
    """A tool and what comes out of it."""

    def __init__(self, kind_of_tool: type[DrawingTool]) -> None:
        self.shared = shared_state()
        self.tool = kind_of_tool(self.shared)
        self.tool.set_kind("curb")
        self.changes: list[Change] = []
        self.told: list[Text] = []
        self.finished = 0
        self.tool.change_requested.connect(lambda _, change: self.changes.append(change))
        self.tool.told.connect(self.told.append)
        self.tool.finished.connect(self._on_finished)

    def _on_finished(self) -> None:
        self.finished += 1

    def click(self, *places: Place | None) -> None:
        for place in places:
            self.tool.press(Hit(place))
            self.tool.release(Hit(place))


def test_a_line_has_the_exact_places_that_were_clicked() -> None:
    desk = Desk(DrawLine)
    desk.click(A, B, C, D)
    desk.tool.complete()
    (change,) = desk.changes
    (feature,) = change.added
    assert feature.kind == "curb"
    assert feature.geometry is Geometry.LINE
    assert [vertex.xyz for vertex in feature.vertices] == [one.xyz for one in (A, B, C, D)]
    assert [vertex.measured for vertex in feature.vertices] == [
        one.measured for one in (A, B, C, D)
    ]
    assert desk.shared.sketch.drawing is None


def test_the_sketch_follows_clicks_and_the_mouse() -> None:
    desk = Desk(DrawLine)
    desk.click(A)
    desk.tool.move(Hit(B))
    drawing = desk.shared.sketch.drawing
    assert drawing is not None
    assert [vertex.xyz for vertex in drawing.vertices] == [A.xyz]
    assert drawing.preview is not None
    assert drawing.preview.xyz == B.xyz
    desk.tool.move(Hit(None))
    assert desk.shared.sketch.drawing is not None
    assert desk.shared.sketch.drawing.preview is None


def test_backspace_takes_back_one_vertex_after_another() -> None:
    desk = Desk(DrawLine)
    desk.click(A, B, C)
    desk.tool.step_back()
    desk.click(D)
    desk.tool.complete()
    assert [vertex.xyz for vertex in desk.changes[0].added[0].vertices] == [A.xyz, B.xyz, D.xyz]
    desk.tool.step_back()
    assert desk.shared.sketch.drawing is None


def test_escape_drops_the_drawing_first_and_gives_the_hand_back_then() -> None:
    desk = Desk(DrawLine)
    desk.click(A, B)
    desk.tool.leave()
    assert (desk.shared.sketch.drawing, desk.finished, desk.changes) == (None, 0, [])
    desk.tool.leave()
    assert desk.finished == 1


def test_leaving_again_while_the_hand_is_taken_back_ends() -> None:
    desk = Desk(DrawLine)
    desk.tool.finished.connect(desk.tool.leave)
    desk.tool.leave()
    assert desk.finished == 1


def test_another_tool_is_taken_without_a_word() -> None:
    desk = Desk(DrawLine)
    desk.click(A, B)
    desk.tool.put_down()
    assert (desk.shared.sketch.drawing, desk.finished, desk.changes) == (None, 0, [])


@pytest.mark.parametrize(
    ("kind_of_tool", "clicks"), [(DrawLine, [A]), (DrawArea, [A, B]), (DrawArea, [A])]
)
def test_too_few_vertices_are_said_and_kept(
    kind_of_tool: type[DrawingTool], clicks: list[Place]
) -> None:
    desk = Desk(kind_of_tool)
    desk.click(*clicks)
    desk.tool.complete()
    assert desk.changes == []
    assert desk.told == [TOO_FEW[desk.tool.geometry]]
    assert desk.shared.sketch.drawing is not None
    assert len(desk.shared.sketch.drawing.vertices) == len(clicks)


def test_completing_nothing_says_nothing() -> None:
    desk = Desk(DrawLine)
    desk.tool.complete()
    assert (desk.changes, desk.told) == ([], [])


def test_both_presses_of_a_double_click_are_one_vertex() -> None:
    desk = Desk(DrawLine)
    desk.click(A, B, B)
    desk.tool.complete()
    assert len(desk.changes[0].added[0].vertices) == 2


def test_a_click_on_nothing_adds_nothing_and_says_so() -> None:
    desk = Desk(DrawLine)
    desk.click(A, None)
    assert desk.told == [NO_POINT]
    assert desk.shared.sketch.drawing is not None
    assert len(desk.shared.sketch.drawing.vertices) == 1


def test_without_a_kind_nothing_is_drawn() -> None:
    desk = Desk(DrawLine)
    desk.tool.set_kind("")
    desk.click(A)
    assert desk.told == [NO_KIND]
    assert desk.shared.sketch.drawing is None


def test_an_area_is_a_ring_whose_first_vertex_is_not_repeated() -> None:
    desk = Desk(DrawArea)
    desk.click(A, B, C)
    desk.tool.complete()
    (feature,) = desk.changes[0].added
    assert feature.geometry is Geometry.AREA
    assert len(feature.vertices) == 3


def test_every_click_of_the_point_tool_is_a_feature() -> None:
    desk = Desk(DrawPoint)
    desk.click(A, B)
    assert [change.added[0].vertices[0].xyz for change in desk.changes] == [A.xyz, B.xyz]
    assert desk.shared.sketch.drawing is None


def test_another_kind_colours_the_drawing_at_hand() -> None:
    desk = Desk(DrawLine)
    desk.click(A)
    desk.tool.set_kind("gutter")
    assert desk.shared.sketch.drawing is not None
    assert desk.shared.sketch.drawing.kind == "gutter"


def test_features_drawn_one_after_the_other_have_ids_of_their_own() -> None:
    desk = Desk(DrawPoint)
    desk.click(A, B)
    assert len({change.added[0].id for change in desk.changes}) == 2
