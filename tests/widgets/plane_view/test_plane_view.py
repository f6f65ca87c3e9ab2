"""Looking and drawing on a plane: the same gestures as in the image."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from processing.map.catalogue import Geometry
from processing.map.feature import Status
from tests.widgets.builders import path_tool
from tests.widgets.plane_view.conftest import RIGHT, GridProjection, PlaneViewUser, grid_position
from widgets.mouse_tools.editing.edit_vertices import EditVertices
from widgets.mouse_tools.editing.select import Select
from widgets.mouse_tools.gesture import REACH_PX
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.mouse_tools.mouse_tool import DragShape, Hit, MouseTool
from widgets.shared.cursor import PickedPosition
from widgets.shared.sketch import Drawing, Note
from widgets.shared.snap_state import SnapMark, SnapMode


class ToolListener(MouseTool):
    """Remembers what it was told."""

    def __init__(self, shape: DragShape = DragShape.NONE) -> None:
        super().__init__()
        self.hits: list[Hit] = []
        self.boxed: list[object] = []
        self.shape = shape

    def press(self, hit: Hit) -> None:
        self.hits.append(hit)

    def drag_shape(self, hit: Hit) -> DragShape:
        return self.shape

    def choose_box(self, boxed: object) -> None:
        self.boxed.append(boxed)


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def hit_at(user: PlaneViewUser, spot: QPoint) -> Hit:
    tool = ToolListener()
    user.view.set_mouse_tool(tool)
    user.click(spot)
    return tool.hits[0]


def test_everything_is_shown_at_first(user: PlaneViewUser) -> None:
    corners = [user.spot(0, 0), user.spot(10, 10)]
    assert all(user.view.rect().contains(corner) for corner in corners)


def test_a_click_puts_the_cursor_on_the_measured_point_and_leaves_the_picture(
    user: PlaneViewUser,
) -> None:
    before = user.view.viewport
    user.click(user.spot(9, 9))
    assert user.map.shared.cursor.position == grid_position(9, 9)
    assert user.view.viewport == before


def test_a_click_on_nothing_does_no_harm(user: PlaneViewUser) -> None:
    user.click(QPoint(1, 1))
    assert user.map.shared.cursor.position is None
    tool = user.take(path_tool(user.map, Geometry.LINE))
    user.click(QPoint(1, 1))
    user.drag(QPoint(1, 1), QPoint(5, 590))
    tool.put_down()
    assert not user.map.stored


def test_a_cursor_put_elsewhere_comes_into_the_middle_only_when_it_is_not_there(
    user: PlaneViewUser,
) -> None:
    cursor, view = user.map.shared.cursor, user.view
    before = view.viewport
    cursor.move_to(grid_position(5, 6))
    assert view.viewport == before
    cursor.move_to(grid_position(0, 10))
    assert view.position_of(grid_position(0, 10)) == view.rect().toRectF().center()


def test_what_the_mouse_is_over_is_told(user: PlaneViewUser) -> None:
    user.move(user.spot(3, 4))
    assert user.map.shared.cursor.hover == grid_position(3, 4)
    user.move(QPoint(1, 1))
    assert user.map.shared.cursor.hover is None


def test_the_wheel_zooms_where_the_mouse_is(user: PlaneViewUser) -> None:
    spot = user.spot(2, 8)
    before = user.view.viewport.scale
    user.wheel(spot, 3)
    assert user.view.viewport.scale == pytest.approx(before * 1.25**3)
    assert user.spot(2, 8) == spot


def test_the_wheel_with_control_sizes_points_and_with_shift_moves_along(
    user: PlaneViewUser,
) -> None:
    before = user.view.viewport
    user.wheel(QPoint(400, 300), 2, Qt.KeyboardModifier.ControlModifier)
    assert user.map.shared.view_settings.look.point_size_px == 3.0
    assert user.view.viewport == before
    user.wheel(QPoint(400, 300), 1, Qt.KeyboardModifier.ShiftModifier)
    moved = user.view.viewport
    assert moved.scale == before.scale
    assert moved.centre != before.centre


@pytest.mark.parametrize("with_space", [True, False])
def test_the_middle_button_and_space_push_the_picture(
    user: PlaneViewUser, with_space: bool
) -> None:
    before = user.spot(5, 5)
    if with_space:
        user.qtbot.keyPress(user.view, Qt.Key.Key_Space)
        user.drag(QPoint(300, 300), QPoint(350, 280))
        user.qtbot.keyRelease(user.view, Qt.Key.Key_Space)
    else:
        user.drag(QPoint(300, 300), QPoint(350, 280), button=Qt.MouseButton.MiddleButton)
    assert user.spot(5, 5) - before == QPoint(50, -20)
    assert user.map.shared.cursor.position is None


def test_keys_move_zoom_and_show_everything(user: PlaneViewUser) -> None:
    before = user.view.viewport
    user.key(Qt.Key.Key_Plus)
    assert user.view.viewport.scale > before.scale
    user.key(Qt.Key.Key_Right)
    assert user.view.viewport.centre[0] > before.centre[0]
    user.key(Qt.Key.Key_Home)
    assert user.view.viewport == before


def test_f_centres_on_what_is_chosen_or_else_on_the_cursor(user: PlaneViewUser) -> None:
    line = user.add(Geometry.LINE, (0, 8), (2, 8))
    user.map.shared.selection.choose_features(frozenset({line.id}))
    user.key(Qt.Key.Key_F)
    assert user.view.viewport.centre == pytest.approx((1.0, -8.0))
    user.map.shared.selection.clear()
    user.map.shared.cursor.move_to(grid_position(5, 6))
    user.view.set_viewport(user.view.viewport.panned(40, 40))
    user.key(Qt.Key.Key_F)
    assert user.view.viewport.centre == pytest.approx((5.0, -6.0))


def test_a_hit_knows_reach_and_line_of_sight(user: PlaneViewUser) -> None:
    hit = hit_at(user, user.spot(4, 4))
    assert hit.position == grid_position(4, 4)
    assert hit.reach_m == pytest.approx(REACH_PX / user.view.viewport.scale)
    assert hit.ray is not None
    assert hit.ray.direction == (0.0, 0.0, -1.0)


def test_a_vertex_goes_before_a_segment_and_that_before_the_inside_of_an_area(
    user: PlaneViewUser,
) -> None:
    area = user.add(Geometry.AREA, (1, 1), (9, 1), (9, 9), (1, 9))
    vertex = hit_at(user, user.spot(9, 1) + QPoint(5, 0))
    assert (vertex.feature, vertex.vertex) == (area.id, 1)
    for number, middle in enumerate([(5, 1), (9, 5), (5, 9), (1, 5)]):
        side = hit_at(user, user.spot(*middle))
        assert (side.feature, side.vertex, side.segment) == (area.id, -1, number)
    inside = hit_at(user, user.spot(4, 4))
    assert (inside.feature, inside.vertex, inside.segment) == (area.id, -1, -1)
    assert hit_at(user, user.spot(10, 10)).feature == ""


def test_what_is_not_at_full_strength_cannot_be_taken_hold_of(user: PlaneViewUser) -> None:
    line = user.add(Geometry.LINE, (2, 2), (8, 2))
    far = line.with_vertices(
        tuple(type(one)((one.xyz[0], one.xyz[1], 90.0)) for one in line.vertices)
    )
    user.map.stored[line.id] = far
    user.map.shared.map_changes.features_changed.emit((line.id,))
    assert hit_at(user, user.spot(2, 2)).vertex == -1


def test_a_vertex_is_dragged_to_another_measured_point(user: PlaneViewUser) -> None:
    line = user.add(Geometry.LINE, (2, 2), (5, 5), (8, 2))
    user.take(EditVertices(user.map, user.map.shared))
    user.drag(user.spot(5, 5), user.spot(6, 8))
    (_, vertex, _) = user.map.stored[line.id].vertices
    assert vertex.xyz == grid_position(6, 8).xyz
    assert vertex.measured == grid_position(6, 8).measured


def test_a_line_is_drawn_by_clicks_and_the_right_button(user: PlaneViewUser) -> None:
    user.take(path_tool(user.map, Geometry.LINE))
    for east, north in ((1, 1), (4, 1), (4, 6)):
        user.click(user.spot(east, north))
        user.view.grab()
    user.click(user.spot(4, 6), button=RIGHT)
    (feature,) = user.map.features()
    positions = [grid_position(1, 1), grid_position(4, 1), grid_position(4, 6)]
    assert [one.xyz for one in feature.vertices] == [position.xyz for position in positions]


def test_a_box_selects_what_is_wholly_inside_and_the_points(user: PlaneViewUser) -> None:
    inside = user.add(Geometry.LINE, (3, 3), (5, 5))
    user.add(Geometry.LINE, (4, 4), (9, 9))
    user.take(Select(user.map, user.map.shared))
    user.drag(user.spot(1, 7), user.spot(7, 1))
    assert user.map.shared.selection.features == {inside.id}
    tool = ToolListener(DragShape.BOX)
    user.view.set_mouse_tool(tool)
    user.drag(user.spot(1, 7), user.spot(7, 1))
    assert tool.boxed[0].points["grid"].tolist() == [1, 2]


def test_rejected_features_are_shown_and_hit_on_request_only(user: PlaneViewUser) -> None:
    rejected = user.add(Geometry.LINE, (1, 5), (9, 5), status=Status.REJECTED)
    spot = user.spot(5, 5)
    around = [spot + QPoint(0, down) for down in (-1, 0, 1)]
    assert hit_at(user, spot).feature == ""
    user.map.shared.view_settings.set_shows_rejected(True)
    assert hit_at(user, spot).feature == rejected.id
    assert max(max(_rgb(user.colour_at(one))) for one in around) > 60
    user.map.shared.view_settings.set_shows_rejected(False)
    assert hit_at(user, spot).feature == ""


def test_features_of_hidden_kinds_and_those_being_edited_are_not_painted(
    user: PlaneViewUser,
) -> None:
    line = user.add(Geometry.LINE, (1, 5), (9, 5))
    spot = user.spot(5, 5)
    painted = user.colour_at(spot)
    background = user.colour_at(user.spot(5, 8))
    assert painted != background
    user.map.shared.view_settings.hide_kinds(frozenset({line.kind}))
    assert user.colour_at(spot) == background
    user.map.shared.view_settings.hide_kinds(frozenset())
    vertices = tuple(one for one in line.vertices[:1])
    drawing = Drawing(line.kind, Geometry.LINE, vertices, replaces=line.id)
    user.map.shared.sketch.show(drawing)
    assert user.colour_at(spot) == background


def test_a_changed_feature_is_painted_where_it_is_now(user: PlaneViewUser) -> None:
    line = user.add(Geometry.LINE, (1, 5), (9, 5))
    user.view.grab()
    other = user.add(Geometry.LINE, (1, 8), (9, 8))
    user.map.stored[line.id] = line.with_vertices(other.vertices)
    del user.map.stored[other.id]
    user.map.shared.map_changes.features_changed.emit((line.id, other.id))
    assert user.colour_at(user.spot(5, 5)) == user.colour_at(user.spot(5, 6))
    assert hit_at(user, user.spot(5, 8)).feature == line.id


def test_sketch_notes_marks_and_cursor_are_painted_over_the_map(user: PlaneViewUser) -> None:
    shared = user.map.shared
    before = user.view.grab().toImage()
    vertices = user.add(Geometry.LINE, (1, 1), (3, 1)).vertices
    note = Note((3.0, 1.0, 5.0), "2.00 m")
    preview = user.add(Geometry.POINT, (3, 3)).vertices
    shared.sketch.show(Drawing("lid", Geometry.AREA, vertices, preview, notes=(note,)))
    shared.cursor.move_to(grid_position(4, 4))
    shared.cursor.move_to(grid_position(5, 4))
    shared.snap.show_mark(SnapMark((3.0, 3.0, 5.0), SnapMode.VERTEX))
    after = user.view.grab().toImage()
    assert before != after
    red, _, blue = _rgb(user.colour_at(user.spot(5, 4) + QPoint(9, 0)))
    assert red > blue + 100


def test_what_is_not_shown_leaves_no_mark(user: PlaneViewUser) -> None:
    user.view.shown_projection = GridProjection(limit=3.0)
    user.view.set_ground_stale()
    user.map.shared.cursor.move_to(grid_position(5, 4))
    user.map.shared.snap.show_mark(SnapMark((3.0, 8.0, 5.0), SnapMode.VERTEX))
    assert user.view.position_of(grid_position(5, 4)) is None
    user.view.center_on(grid_position(5, 4))
    user.view.grab()


def test_a_move_of_the_mouse_paints_the_ground_not_again(user: PlaneViewUser) -> None:
    user.view.grab()
    before = user.view.grounds
    user.move(user.spot(3, 4))
    user.map.shared.snap.show_mark(SnapMark((3.0, 3.0, 5.0), SnapMode.VERTEX))
    user.add(Geometry.POINT, (2, 2))
    user.view.grab()
    assert user.view.grounds == before
    user.view.set_ground_stale()
    user.view.grab()
    assert user.view.grounds == before + 1


def test_only_what_changed_is_projected_again(user: PlaneViewUser) -> None:
    for north in range(1, 9):
        user.add(Geometry.LINE, (1, north), (9, north))
    user.view.grab()
    projection = user.view.projection()
    assert projection is not None
    projection.asked.clear()
    user.add(Geometry.LINE, (2, 2), (3, 3))
    user.view.grab()
    assert max(projection.asked) == 2


def test_features_outside_the_reach_of_a_view_are_not_projected(user: PlaneViewUser) -> None:
    user.view.box = np.array([[0.0, 0.0, 0.0], [4.0, 4.0, 10.0]])
    across = user.add(Geometry.LINE, (1, 1), (9, 9))
    user.add(Geometry.LINE, (6, 6), (9, 9))
    assert hit_at(user, user.spot(9, 9)).feature == across.id


def test_an_empty_view_says_why_and_takes_no_gesture(user: PlaneViewUser) -> None:
    user.view.shown_projection = None
    user.view.set_ground_stale()
    user.view.grab()
    before = user.view.viewport
    user.click(QPoint(400, 300))
    user.wheel(QPoint(400, 300), 2)
    user.key(Qt.Key.Key_Plus)
    user.view.center_on_selection()
    assert user.view.viewport == before
    assert user.map.shared.cursor.position is None
    assert user.view.position_of(PickedPosition((1.0, 1.0, 1.0))) is None


def test_the_right_button_with_nothing_under_way_asks_for_the_menu(user: PlaneViewUser) -> None:
    with user.qtbot.waitSignal(user.view.menu_requested) as asked:
        user.click(user.spot(4, 4), button=RIGHT)
    (request,) = asked.args
    assert isinstance(request, MenuRequest)
    assert request.hit.position == grid_position(4, 4)
    assert len(request.menu.actions()) == 2
    request.menu.deleteLater()


def test_another_project_is_shown_from_its_own_beginning(user: PlaneViewUser) -> None:
    user.add(Geometry.LINE, (1, 5), (9, 5))
    user.view.set_viewport(user.view.viewport.zoomed(8.0, 10.0, 10.0))
    user.map.stored.clear()
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.viewport.shows(5.0, -5.0, 0.01)
    assert hit_at(user, user.spot(5, 5)).feature == ""


def test_everything_stays_in_windows_of_other_sizes_until_one_looks_elsewhere(
    user: PlaneViewUser,
) -> None:
    def is_whole() -> bool:
        corners = [user.spot(0, 0), user.spot(10, 10)]
        return all(user.view.rect().contains(corner) for corner in corners)

    user.view.resize(200, 500)
    assert is_whole()
    user.view.resize(700, 500)
    assert is_whole()
    scale = user.view.viewport.scale
    user.view.zoom_by(1.1)
    user.view.resize(300, 200)
    assert user.view.viewport.scale == pytest.approx(1.1 * scale)
    user.view.show_everything()
    user.view.resize(500, 400)
    assert is_whole()
