"""Drawing tools alone: hits in, sketch and change out, whichever view sent the hits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt

from processing.core.text import Text
from processing.map.catalogue import AttributeField, Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex
from tests.widgets.builders import KINDS, OpenMap, do_now
from widgets.mouse_tools.drawing.draw_line import DROPPED, RESTORED, DrawLine
from widgets.mouse_tools.drawing.draw_point import DrawPoint
from widgets.mouse_tools.drawing.draw_row import NO_LID, DrawRow
from widgets.mouse_tools.drawing.draw_shape import DrawShape, ThreePointShape
from widgets.mouse_tools.drawing.drawing_tool import NO_KIND, NO_POINT, TOO_FEW, DrawingTool
from widgets.mouse_tools.drawing.legs import LegMode
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.cursor import PickedPosition

A, B, C, D = (
    PickedPosition((float(number), 10.5 * number**2, 3.25), PointReference("left", number))
    for number in range(4)
)


def line_tool(source: OpenMap) -> DrawLine:
    return DrawLine(source, source.shared, Geometry.LINE, do_now)


def area_tool(source: OpenMap) -> DrawLine:
    return DrawLine(source, source.shared, Geometry.AREA, do_now)


def point_tool(source: OpenMap) -> DrawPoint:
    return DrawPoint(source, source.shared)


class DrawingSession:
    """A tool and what comes out of it."""

    def __init__(self, make: Callable[[OpenMap], DrawingTool]) -> None:
        self.map = OpenMap()
        self.shared = self.map.shared
        self.tool = make(self.map)
        (geometry,) = self.tool.draws
        self.tool.set_kind(KINDS[self.map.kind_of(geometry)])
        self.changes: list[Change] = []
        self.reported: list[Text] = []
        self.finished = 0
        self.tool.change_requested.connect(lambda _, change: self.changes.append(change))
        self.tool.reported.connect(self.reported.append)
        self.tool.finished.connect(self._on_finished)

    def _on_finished(self) -> None:
        self.finished += 1

    def click(self, *positions: PickedPosition | None) -> None:
        for position in positions:
            self.tool.press(Hit(position))
            self.tool.release(Hit(position))


def test_a_line_has_the_exact_places_that_were_clicked() -> None:
    desk = DrawingSession(line_tool)
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
    desk = DrawingSession(line_tool)
    desk.click(A)
    desk.tool.move(Hit(B))
    drawing = desk.shared.sketch.drawing
    assert drawing is not None
    assert [vertex.xyz for vertex in drawing.vertices] == [A.xyz]
    assert [vertex.xyz for vertex in drawing.preview] == [B.xyz]
    desk.tool.move(Hit(None))
    assert desk.shared.sketch.drawing is not None
    assert desk.shared.sketch.drawing.preview == ()


def test_backspace_takes_back_one_vertex_after_another() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B, C)
    desk.tool.step_back()
    desk.click(D)
    desk.tool.complete()
    assert [vertex.xyz for vertex in desk.changes[0].added[0].vertices] == [A.xyz, B.xyz, D.xyz]
    desk.tool.step_back()
    assert desk.shared.sketch.drawing is None


def test_escape_drops_the_drawing_first_and_gives_the_hand_back_then() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B)
    desk.tool.leave()
    assert desk.reported == [DROPPED]
    assert (desk.shared.sketch.drawing, desk.finished, desk.changes) == (None, 0, [])
    desk.tool.leave()
    assert desk.finished == 1


def test_leaving_again_while_the_hand_is_taken_back_ends() -> None:
    desk = DrawingSession(line_tool)
    desk.tool.finished.connect(desk.tool.leave)
    desk.tool.leave()
    assert desk.finished == 1


def test_another_tool_is_taken_without_a_word() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B)
    desk.tool.put_down()
    assert (desk.shared.sketch.drawing, desk.finished, desk.changes) == (None, 0, [])


@pytest.mark.parametrize(
    ("make", "clicks"), [(line_tool, [A]), (area_tool, [A, B]), (area_tool, [A])]
)
def test_too_few_vertices_are_said_and_kept(
    make: Callable[[OpenMap], DrawingTool], clicks: list[PickedPosition]
) -> None:
    desk = DrawingSession(make)
    desk.click(*clicks)
    desk.tool.complete()
    assert desk.changes == []
    assert desk.reported == [TOO_FEW[next(iter(desk.tool.draws))]]
    assert desk.shared.sketch.drawing is not None
    assert len(desk.shared.sketch.drawing.vertices) == len(clicks)


def test_completing_nothing_says_nothing() -> None:
    desk = DrawingSession(line_tool)
    desk.tool.complete()
    assert (desk.changes, desk.reported) == ([], [])


def test_both_presses_of_a_double_click_are_one_vertex() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B, B)
    desk.tool.complete()
    assert len(desk.changes[0].added[0].vertices) == 2


def test_a_click_on_nothing_adds_nothing_and_says_so() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, None)
    assert desk.reported == [NO_POINT]
    assert desk.shared.sketch.drawing is not None
    assert len(desk.shared.sketch.drawing.vertices) == 1


def test_without_a_kind_nothing_is_drawn() -> None:
    source = OpenMap()
    tool = line_tool(source)
    reported: list[Text] = []
    tool.reported.connect(reported.append)
    tool.press(Hit(A))
    assert reported == [NO_KIND]
    assert source.shared.sketch.drawing is None


def test_an_area_is_a_ring_whose_first_vertex_is_not_repeated() -> None:
    desk = DrawingSession(area_tool)
    desk.click(A, B, C)
    desk.tool.complete()
    (feature,) = desk.changes[0].added
    assert feature.geometry is Geometry.AREA
    assert len(feature.vertices) == 3


def test_every_click_of_the_point_tool_is_a_feature() -> None:
    desk = DrawingSession(point_tool)
    desk.click(A, B)
    assert [change.added[0].vertices[0].xyz for change in desk.changes] == [A.xyz, B.xyz]
    assert desk.shared.sketch.drawing is None


def test_another_kind_colours_the_drawing_at_hand() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A)
    desk.tool.set_kind(replace(KINDS["curb"], id="gutter"))
    assert desk.shared.sketch.drawing is not None
    assert desk.shared.sketch.drawing.kind == "gutter"


def test_features_drawn_one_after_the_other_have_ids_of_their_own() -> None:
    desk = DrawingSession(point_tool)
    desk.click(A, B)
    assert len({change.added[0].id for change in desk.changes}) == 2


def test_a_dropped_drawing_comes_back_by_backspace() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B, C)
    desk.tool.leave()
    desk.tool.step_back()
    assert desk.reported == [DROPPED, RESTORED]
    desk.tool.complete()
    assert [vertex.xyz for vertex in desk.changes[0].added[0].vertices] == [A.xyz, B.xyz, C.xyz]


def test_closing_a_line_leads_it_back_to_its_first_vertex() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B, C)
    assert isinstance(desk.tool, DrawLine)
    desk.tool.close()
    vertices = desk.changes[0].added[0].vertices
    assert [vertex.xyz for vertex in vertices] == [A.xyz, B.xyz, C.xyz, A.xyz]


def test_a_click_on_the_first_vertex_closes_the_line() -> None:
    desk = DrawingSession(line_tool)
    desk.click(A, B, C, A)
    assert len(desk.changes[0].added[0].vertices) == 4


def test_an_area_that_crosses_itself_is_not_made_but_kept_in_the_hand() -> None:
    corners = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]
    desk = DrawingSession(area_tool)
    desk.click(*(PickedPosition((x, y, 1.0)) for x, y in corners))
    desk.tool.complete()
    assert desk.changes == []
    assert "E 1.00, N 1.00" in desk.reported[-1].en
    desk.tool.step_back()
    desk.tool.complete()
    assert len(desk.changes[0].added[0].vertices) == 3


def test_an_arc_passes_its_three_clicks_and_goes_on_straight() -> None:
    desk = DrawingSession(line_tool)
    assert isinstance(desk.tool, DrawLine)
    desk.click(PickedPosition((0.0, 0.0, 1.0)))
    desk.tool.set_mode(LegMode.ARC)
    desk.click(PickedPosition((1.0, 1.0, 1.0)), PickedPosition((2.0, 0.0, 1.0)))
    desk.tool.set_mode(LegMode.STRAIGHT)
    desk.click(PickedPosition((5.0, 0.0, 1.0)))
    desk.tool.complete()
    xyz = np.array([vertex.xyz for vertex in desk.changes[0].added[0].vertices])
    assert np.allclose(xyz[-1], (5.0, 0.0, 1.0))
    on_arc = np.hypot(xyz[:-1, 0] - 1.0, xyz[:-1, 1])
    assert len(xyz) > 6
    assert np.abs(on_arc - 1.0).max() < 1e-6


def test_heights_of_a_curve_without_points_are_marked() -> None:
    desk = DrawingSession(line_tool)
    assert isinstance(desk.tool, DrawLine)
    desk.click(PickedPosition((0.0, 0.0, 1.0)))
    desk.tool.set_mode(LegMode.SPLINE)
    desk.click(PickedPosition((1.0, 1.0, 2.0)), PickedPosition((2.0, 0.0, 3.0)))
    desk.tool.complete()
    vertices = desk.changes[0].added[0].vertices
    assert [vertex.is_occluded for vertex in vertices].count(False) == 3
    assert all(1.0 <= vertex.xyz[2] <= 3.0 for vertex in vertices)


def test_taking_back_a_click_of_a_spline_leaves_the_others() -> None:
    desk = DrawingSession(line_tool)
    assert isinstance(desk.tool, DrawLine)
    desk.tool.set_mode(LegMode.SPLINE)
    desk.click(*(PickedPosition((float(n), float(n % 2), 1.0)) for n in range(5)))
    desk.tool.step_back()
    drawing = desk.shared.sketch.drawing
    assert drawing is not None
    assert drawing.vertices[-1].xyz == (3.0, 1.0, 1.0)


def test_shift_holds_the_direction_or_the_one_across() -> None:
    desk = DrawingSession(line_tool)
    desk.click(PickedPosition((0.0, 0.0, 1.0)), PickedPosition((4.0, 0.0, 1.0)))
    shift = Qt.KeyboardModifier.ShiftModifier
    for wanted, reached in (((9.0, 0.3), (9.0, 0.0)), ((9.2, 5.0), (9.0, 5.0))):
        desk.tool.press(Hit(PickedPosition((*wanted, 1.0)), modifiers=shift))
        drawing = desk.shared.sketch.drawing
        assert drawing is not None
        assert drawing.vertices[-1].xyz[:2] == pytest.approx(reached)


def test_a_sign_is_turned_by_dragging() -> None:
    kind = replace(
        KINDS["pole"], attributes=(AttributeField("facing_deg", Text.same("f"), "number"),)
    )
    desk = DrawingSession(point_tool)
    desk.tool.set_kind(kind)
    desk.tool.press(Hit(PickedPosition((0.0, 0.0, 1.0))))
    desk.tool.move(Hit(PickedPosition((2.0, 0.0, 1.0))))
    desk.tool.release(Hit(PickedPosition((2.0, 0.0, 1.0))))
    (feature,) = desk.changes[0].added
    assert feature.vertices[0].xyz == (0.0, 0.0, 1.0)
    assert feature.attributes == {"facing_deg": 90.0}


def test_a_line_that_is_chosen_goes_on_from_its_first_vertex_in_its_own_direction() -> None:
    desk = DrawingSession(line_tool)
    desk.click(B, C)
    desk.tool.complete()
    (line,) = desk.changes[0].added
    desk.map.apply(Text.same("test"), desk.changes[0])
    desk.shared.selection.choose_features(frozenset({line.id}))
    desk.tool.press(Hit(B, line.id, vertex=0))
    desk.click(A)
    desk.tool.complete()
    (pair,) = desk.changes[1].replaced
    assert [vertex.xyz for vertex in pair.after.vertices] == [A.xyz, B.xyz, C.xyz]


@pytest.mark.parametrize(
    ("geometry", "count"), [(Geometry.AREA, 4), (Geometry.LINE, 5), (Geometry.POINT, 1)]
)
def test_a_rectangle_becomes_what_the_kind_is(geometry: Geometry, count: int) -> None:
    source = OpenMap()
    tool = DrawShape(source, source.shared, ThreePointShape.RECTANGLE)
    changes: list[Change] = []
    tool.change_requested.connect(lambda _, change: changes.append(change))
    tool.set_kind(KINDS[source.kind_of(geometry)])
    for xy in ((0.0, 0.0), (2.0, 0.0), (1.0, 0.5)):
        tool.press(Hit(PickedPosition((*xy, 1.0))))
    vertices = changes[0].added[0].vertices
    assert len(vertices) == count
    if geometry is Geometry.POINT:
        assert vertices[0].xyz == pytest.approx((1.0, 0.25, 1.0))


def test_three_points_in_one_line_make_no_circle_and_say_so() -> None:
    source = OpenMap()
    tool = DrawShape(source, source.shared, ThreePointShape.CIRCLE)
    reported: list[Text] = []
    tool.reported.connect(reported.append)
    tool.set_kind(KINDS["lid"])
    for x in (0.0, 1.0, 2.0):
        tool.press(Hit(PickedPosition((x, 0.0, 1.0))))
    assert len(reported) == 1


def test_a_refused_shape_has_its_first_clicks_again() -> None:
    source = OpenMap()
    tool = DrawShape(source, source.shared, ThreePointShape.CIRCLE)
    tool.set_kind(KINDS["lid"])
    tool.change_requested.connect(lambda *_: tool.take_back())
    for position in (A, B, C):
        tool.press(Hit(position))
    drawing = source.shared.sketch.drawing
    assert drawing is not None
    assert [vertex.xyz for vertex in drawing.vertices] == [A.xyz, B.xyz]


def lids_of_a_run(*numbers: int) -> list[Feature]:
    """Lids of 0.5 × 0.4 m that lie one behind another eastwards."""
    corners = ((-0.25, -0.2), (0.25, -0.2), (0.25, 0.2), (-0.25, 0.2))
    return [
        Feature(
            f"lid{number}",
            "lid",
            Geometry.AREA,
            tuple(Vertex((0.5 * number + x, y, 3.0)) for x, y in corners),
        )
        for number in numbers
    ]


def over(east: float) -> Hit:
    return Hit(PickedPosition((east, 0.0, 3.0), PointReference("left", 1)))


@pytest.fixture
def row() -> DrawingSession:
    made = DrawingSession(lambda source: DrawRow(source, source.shared))
    made.map.stored = {one.id: one for one in lids_of_a_run(0, 1, 3)}
    return made


def middles(change: Change) -> list[float]:
    return [float(np.mean([v.xyz[0] for v in one.vertices])) for one in change.added]


def test_two_clicks_give_a_row_as_one_step(row: DrawingSession) -> None:
    row.tool.press(over(10.0))
    row.tool.move(over(11.4))
    assert row.shared.sketch.drawing is not None
    row.tool.press(over(12.0))
    (change,) = row.changes
    assert middles(change) == pytest.approx([10.0, 10.5, 11.0, 11.5, 12.0])
    assert {one.kind for one in change.added} == {"lid"}
    assert row.shared.sketch.drawing is None


def test_one_click_into_a_gap_gives_the_missed_lid(row: DrawingSession) -> None:
    row.tool.press(over(1.1))
    (change,) = row.changes
    assert middles(change) == pytest.approx([1.0])
    assert not row.tool.is_busy


def test_enter_after_the_first_click_gives_one_lid_and_escape_none(row: DrawingSession) -> None:
    row.tool.press(over(10.0))
    row.tool.leave()
    assert row.changes == []
    row.tool.press(over(10.0))
    row.tool.complete()
    assert middles(row.changes[0]) == pytest.approx([10.0])


def test_without_a_lid_the_row_says_what_to_do(row: DrawingSession) -> None:
    row.map.stored = {}
    row.tool.press(over(10.0))
    assert row.reported == [NO_LID]
    assert row.changes == []
