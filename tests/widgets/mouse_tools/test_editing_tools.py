"""Editing tools alone: features on a map, hits in, changes out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex, new_feature_id
from tests.widgets.builders import KINDS, OpenMap
from widgets.mouse_tools.drawing.draw_parallel import DrawParallel
from widgets.mouse_tools.drawing.measure import NO_SUCH_KIND, MeasureTool
from widgets.mouse_tools.editing.cut_lines import (
    PICK_REST,
    PICK_TARGET,
    ExtendLine,
    SplitLine,
    TrimLine,
)
from widgets.mouse_tools.editing.edit_vertices import EditVertices
from widgets.mouse_tools.editing.move_features import MoveFeatures
from widgets.mouse_tools.editing_tool import PICK_LINE
from widgets.mouse_tools.mouse_tool import Hit, MouseTool
from widgets.shared.cursor import PickedPosition

XYZ = tuple[float, float, float]


class EditingSession:
    """A map and a tool that works on it."""

    def __init__(self, make: Callable[[OpenMap], MouseTool]) -> None:
        self.map = OpenMap()
        self.tool = make(self.map)
        self.map.listen_to(self.tool)

    def draw(self, geometry: Geometry, *positions: XYZ) -> Feature:
        vertices = tuple(Vertex(xyz, PointReference("left", n)) for n, xyz in enumerate(positions))
        kind = self.map.kind_of(geometry)
        feature = Feature(new_feature_id(), kind, geometry, vertices)
        self.map.apply(Text.same("test"), Change(added=(feature,)))
        return feature

    def line(self, *positions: XYZ) -> Feature:
        return self.draw(Geometry.LINE, *positions)

    def shape(self, id_: str) -> list[XYZ]:
        return [vertex.xyz for vertex in self.map.stored[id_].vertices]

    @property
    def lines(self) -> list[Feature]:
        return list(self.map.stored.values())


def _splitter(source: OpenMap) -> MouseTool:
    return SplitLine(source, source.shared)


def _extender(source: OpenMap) -> MouseTool:
    return ExtendLine(source, source.shared)


def _trimmer(source: OpenMap) -> MouseTool:
    return TrimLine(source, source.shared)


def _mover(source: OpenMap) -> MouseTool:
    return MoveFeatures(source, source.shared)


def _copier(source: OpenMap) -> DrawParallel:
    return DrawParallel(source, source.shared)


def test_a_line_is_split_where_it_is_clicked() -> None:
    desk = EditingSession(_splitter)
    line = desk.line((0.0, 0.0, 1.0), (10.0, 0.0, 2.0))
    desk.tool.press(Hit(PickedPosition((4.0, 0.05, 1.4)), line.id, segment=0))
    first, second = desk.lines
    assert first.id == line.id
    assert desk.shape(first.id)[-1] == pytest.approx((4.0, 0.0, 1.4))
    assert desk.shape(second.id) == [pytest.approx((4.0, 0.0, 1.4)), (10.0, 0.0, 2.0)]
    assert first.vertices[0].measured == line.vertices[0].measured
    assert len(desk.map.applied) == 2  # drawn, split: one step


def test_a_click_beside_every_line_asks_for_one() -> None:
    desk = EditingSession(_splitter)
    desk.tool.press(Hit(PickedPosition((4.0, 0.05, 1.4))))
    assert desk.map.reported == [PICK_LINE]


def test_a_line_is_extended_to_another() -> None:
    desk = EditingSession(_extender)
    short = desk.line((0.0, 0.0, 1.0), (4.0, 0.0, 1.0))
    wall = desk.line((9.0, -5.0, 1.0), (9.0, 5.0, 1.0))
    desk.tool.press(Hit(PickedPosition((3.5, 0.0, 1.0)), short.id, segment=0))
    assert desk.map.reported == [PICK_TARGET]
    desk.tool.press(Hit(PickedPosition((9.0, 3.0, 1.0)), wall.id, segment=0))
    assert desk.shape(short.id)[-1][:2] == pytest.approx((9.0, 0.0))


def test_a_line_that_never_meets_the_other_says_so_and_stays() -> None:
    desk = EditingSession(_extender)
    one = desk.line((0.0, 0.0, 1.0), (4.0, 0.0, 1.0))
    beside = desk.line((0.0, 3.0, 1.0), (9.0, 3.0, 1.0))
    desk.tool.press(Hit(PickedPosition((3.5, 0.0, 1.0)), one.id, segment=0))
    desk.tool.press(Hit(PickedPosition((3.5, 3.0, 1.0)), beside.id, segment=0))
    assert desk.map.stored[one.id] == one
    assert len(desk.map.reported) == 2


def test_of_a_line_that_is_trimmed_the_clicked_part_stays() -> None:
    desk = EditingSession(_trimmer)
    cutter = desk.line((5.0, -5.0, 1.0), (5.0, 5.0, 1.0))
    line = desk.line((0.0, 0.0, 1.0), (10.0, 0.0, 1.0))
    desk.tool.press(Hit(PickedPosition((5.0, 3.0, 1.0)), cutter.id, segment=0))
    assert desk.map.reported == [PICK_REST]
    desk.tool.press(Hit(PickedPosition((8.0, 0.0, 1.0)), line.id, segment=0))
    assert [xyz[0] for xyz in desk.shape(line.id)] == pytest.approx([5.0, 10.0])


@pytest.mark.parametrize("is_copy", [False, True])
def test_features_are_moved_or_copied_from_point_to_point(is_copy: bool) -> None:
    desk = EditingSession(_mover)
    line = desk.line((0.0, 0.0, 1.0), (4.0, 0.0, 1.0))
    keys = Qt.KeyboardModifier.ControlModifier if is_copy else Qt.KeyboardModifier.NoModifier
    desk.tool.press(Hit(PickedPosition((0.0, 0.0, 1.0)), line.id, vertex=0))
    desk.tool.move(Hit(PickedPosition((1.0, 2.0, 1.5))))
    desk.tool.release(Hit(PickedPosition((1.0, 2.0, 1.5)), modifiers=keys))
    moved = desk.lines[-1]
    assert desk.shape(moved.id) == [(1.0, 2.0, 1.5), (5.0, 2.0, 1.5)]
    assert all(vertex.measured is None for vertex in moved.vertices)
    assert len(desk.lines) == (2 if is_copy else 1)
    if is_copy:
        assert desk.map.stored[line.id] == line


def test_a_parallel_copy_runs_where_the_mouse_is_or_at_the_distance_that_was_set() -> None:
    desk = EditingSession(_copier)
    line = desk.line((0.0, 0.0, 1.0), (10.0, 0.0, 1.0))
    tool = desk.tool
    assert isinstance(tool, DrawParallel)
    tool.press(Hit(PickedPosition((5.0, 0.0, 1.0)), line.id, segment=0))
    tool.move(Hit(PickedPosition((5.0, 0.7, 1.0))))
    drawing = desk.map.shared.sketch.drawing
    assert drawing is not None
    assert [note.text for note in drawing.notes] == ["0.700 m"]
    tool.press(Hit(PickedPosition((5.0, 0.7, 1.0))))
    assert [xyz[1] for xyz in desk.shape(desk.lines[-1].id)] == pytest.approx([0.7, 0.7])
    tool.fix_distance(0.15)
    tool.press(Hit(PickedPosition((5.0, 3.0, 1.0))))
    assert [xyz[1] for xyz in desk.shape(desk.lines[-1].id)] == pytest.approx([0.85, 0.85])
    assert desk.lines[-1].kind == line.kind


def test_a_copy_over_nothing_has_marked_heights() -> None:
    desk = EditingSession(_copier)
    line = desk.line((0.0, 0.0, 1.0), (10.0, 0.0, 1.0))
    desk.tool.press(Hit(PickedPosition((5.0, 0.0, 1.0)), line.id, segment=0))
    desk.tool.press(Hit(PickedPosition((5.0, 0.7, 1.0))))
    assert all(vertex.is_occluded for vertex in desk.lines[-1].vertices)


def test_an_edit_that_would_make_an_area_cross_itself_is_not_done() -> None:
    desk = EditingSession(lambda source: EditVertices(source, source.shared))
    area = desk.draw(
        Geometry.AREA, (0.0, 0.0, 1.0), (4.0, 0.0, 1.0), (4.0, 4.0, 1.0), (0.0, 4.0, 1.0)
    )
    desk.tool.press(Hit(PickedPosition((4.0, 4.0, 1.0)), area.id, vertex=2))
    desk.tool.move(Hit(PickedPosition((-3.0, 1.0, 1.0))))
    desk.tool.release(Hit(PickedPosition((-3.0, 1.0, 1.0))))
    assert desk.map.stored[area.id] == area
    assert len(desk.map.reported) == 1


def test_what_is_measured_is_told_and_kept_on_demand() -> None:
    source = OpenMap()
    tool = MeasureTool(source, source.shared)
    source.listen_to(tool)
    measured: list[tuple[object, ...]] = []
    tool.measured.connect(measured.append)
    tool.press(Hit(PickedPosition((0.0, 0.0, 1.0))))
    tool.press(Hit(PickedPosition((3.0, 4.0, 1.0))))
    values = {one.id: one.value for one in measured[-1]}
    assert values["distance_m"] == pytest.approx(5.0)
    assert values["height_difference_m"] == pytest.approx(0.0)
    tool.keep()
    assert source.reported == [NO_SUCH_KIND.filled(name="measurement")]
    assert source.stored == {}


def test_a_mouse_that_rests_where_it_clicked_measures_no_leg_of_nothing() -> None:
    source = OpenMap()
    tool = MeasureTool(source, source.shared)
    measured: list[tuple[object, ...]] = []
    tool.measured.connect(measured.append)
    for position in (PickedPosition((0.0, 0.0, 1.0)), PickedPosition((3.0, 4.0, 1.0))):
        tool.move(Hit(position))
        tool.press(Hit(position))
        tool.move(Hit(position))
    names = {one.id for one in measured[-1]}
    assert "slope_percent" in names
    assert "last_leg_m" not in names


def test_a_copy_becomes_the_kind_that_is_chosen_after_the_line() -> None:
    desk = EditingSession(_copier)
    line = desk.line((0.0, 0.0, 1.0), (10.0, 0.0, 1.0))
    tool = desk.tool
    assert isinstance(tool, DrawParallel)
    taken: list[str] = []
    tool.kind_taken.connect(taken.append)
    tool.press(Hit(PickedPosition((5.0, 0.0, 1.0)), line.id, segment=0))
    assert taken == [line.kind]
    upper = replace(KINDS["curb"], id="curb_upper")
    assert tool.makes(upper)
    assert not tool.makes(KINDS["pole"])
    tool.set_kind(upper)
    tool.press(Hit(PickedPosition((5.0, 0.2, 1.0))))
    assert desk.lines[-1].kind == "curb_upper"
    assert desk.lines[-1].attributes == {}


def test_a_rise_lifts_the_copy() -> None:
    desk = EditingSession(_copier)
    line = desk.line((0.0, 0.0, 1.0), (10.0, 0.0, 1.0))
    tool = desk.tool
    assert isinstance(tool, DrawParallel)
    tool.set_rise(0.15)
    tool.press(Hit(PickedPosition((5.0, 0.0, 1.0)), line.id, segment=0))
    tool.press(Hit(PickedPosition((5.0, 0.2, 1.0))))
    assert [xyz[2] for xyz in desk.shape(desk.lines[-1].id)] == pytest.approx([1.15, 1.15])
