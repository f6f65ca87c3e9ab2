"""Looking and drawing on a plane: the same gestures as in the image."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from processing.project.catalogue import Geometry
from processing.project.feature import Status
from tests.widgets.builders import path_tool
from tests.widgets.plane_view.conftest import RIGHT, GridLay, Hand, grid_place
from widgets.mouse_tools.edit_vertices import EditVertices
from widgets.mouse_tools.gesture import REACH_PX
from widgets.mouse_tools.menu_wish import MenuWish
from widgets.mouse_tools.mouse_tool import DragShape, Hit, MouseTool
from widgets.mouse_tools.select import Select
from widgets.shared.cursor import Place
from widgets.shared.sketch import Drawing, Note
from widgets.shared.snap_state import SnapMark, SnapMode


class Listener(MouseTool):
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


def hit_at(hand: Hand, spot: QPoint) -> Hit:
    tool = Listener()
    hand.view.set_mouse_tool(tool)
    hand.click(spot)
    return tool.hits[0]


def test_everything_is_shown_at_first(hand: Hand) -> None:
    corners = [hand.spot(0, 0), hand.spot(10, 10)]
    assert all(hand.view.rect().contains(corner) for corner in corners)


def test_a_click_puts_the_cursor_on_the_measured_point_and_leaves_the_picture(hand: Hand) -> None:
    before = hand.view.viewport
    hand.click(hand.spot(9, 9))
    assert hand.map.shared.cursor.place == grid_place(9, 9)
    assert hand.view.viewport == before


def test_a_click_on_nothing_does_no_harm(hand: Hand) -> None:
    hand.click(QPoint(1, 1))
    assert hand.map.shared.cursor.place is None
    tool = hand.take(path_tool(hand.map, Geometry.LINE))
    hand.click(QPoint(1, 1))
    hand.drag(QPoint(1, 1), QPoint(5, 590))
    tool.put_down()
    assert not hand.map.stored


def test_a_cursor_put_elsewhere_comes_into_the_middle_only_when_it_is_not_there(
    hand: Hand,
) -> None:
    cursor, view = hand.map.shared.cursor, hand.view
    before = view.viewport
    cursor.move_to(grid_place(5, 6))
    assert view.viewport == before
    cursor.move_to(grid_place(0, 10))
    assert view.position_of(grid_place(0, 10)) == view.rect().toRectF().center()


def test_what_the_mouse_is_over_is_told(hand: Hand) -> None:
    hand.move(hand.spot(3, 4))
    assert hand.map.shared.cursor.hover == grid_place(3, 4)
    hand.move(QPoint(1, 1))
    assert hand.map.shared.cursor.hover is None


def test_the_wheel_zooms_where_the_mouse_is(hand: Hand) -> None:
    spot = hand.spot(2, 8)
    before = hand.view.viewport.scale
    hand.wheel(spot, 3)
    assert hand.view.viewport.scale == pytest.approx(before * 1.25**3)
    assert hand.spot(2, 8) == spot


def test_the_wheel_with_control_sizes_points_and_with_shift_moves_along(hand: Hand) -> None:
    before = hand.view.viewport
    hand.wheel(QPoint(400, 300), 2, Qt.KeyboardModifier.ControlModifier)
    assert hand.map.shared.view_settings.look.point_size_px == 3.0
    assert hand.view.viewport == before
    hand.wheel(QPoint(400, 300), 1, Qt.KeyboardModifier.ShiftModifier)
    moved = hand.view.viewport
    assert moved.scale == before.scale
    assert moved.centre != before.centre


@pytest.mark.parametrize("with_space", [True, False])
def test_the_middle_button_and_space_push_the_picture(hand: Hand, with_space: bool) -> None:
    before = hand.spot(5, 5)
    if with_space:
        hand.qtbot.keyPress(hand.view, Qt.Key.Key_Space)
        hand.drag(QPoint(300, 300), QPoint(350, 280))
        hand.qtbot.keyRelease(hand.view, Qt.Key.Key_Space)
    else:
        hand.drag(QPoint(300, 300), QPoint(350, 280), Qt.MouseButton.MiddleButton)
    assert hand.spot(5, 5) - before == QPoint(50, -20)
    assert hand.map.shared.cursor.place is None


def test_keys_move_zoom_and_show_everything(hand: Hand) -> None:
    before = hand.view.viewport
    hand.key(Qt.Key.Key_Plus)
    assert hand.view.viewport.scale > before.scale
    hand.key(Qt.Key.Key_Right)
    assert hand.view.viewport.centre[0] > before.centre[0]
    hand.key(Qt.Key.Key_Home)
    assert hand.view.viewport == before


def test_f_centres_on_what_is_chosen_or_else_on_the_cursor(hand: Hand) -> None:
    line = hand.add(Geometry.LINE, (0, 8), (2, 8))
    hand.map.shared.selection.choose_features(frozenset({line.id}))
    hand.key(Qt.Key.Key_F)
    assert hand.view.viewport.centre == pytest.approx((1.0, -8.0))
    hand.map.shared.selection.clear()
    hand.map.shared.cursor.move_to(grid_place(5, 6))
    hand.view.set_viewport(hand.view.viewport.panned(40, 40))
    hand.key(Qt.Key.Key_F)
    assert hand.view.viewport.centre == pytest.approx((5.0, -6.0))


def test_a_hit_knows_reach_and_line_of_sight(hand: Hand) -> None:
    hit = hit_at(hand, hand.spot(4, 4))
    assert hit.place == grid_place(4, 4)
    assert hit.reach_m == pytest.approx(REACH_PX / hand.view.viewport.scale)
    assert hit.ray is not None
    assert hit.ray.direction == (0.0, 0.0, -1.0)


def test_a_vertex_goes_before_a_segment_and_that_before_the_inside_of_an_area(
    hand: Hand,
) -> None:
    area = hand.add(Geometry.AREA, (1, 1), (9, 1), (9, 9), (1, 9))
    vertex = hit_at(hand, hand.spot(9, 1) + QPoint(5, 0))
    assert (vertex.feature, vertex.vertex) == (area.id, 1)
    for number, middle in enumerate([(5, 1), (9, 5), (5, 9), (1, 5)]):
        side = hit_at(hand, hand.spot(*middle))
        assert (side.feature, side.vertex, side.segment) == (area.id, -1, number)
    inside = hit_at(hand, hand.spot(4, 4))
    assert (inside.feature, inside.vertex, inside.segment) == (area.id, -1, -1)
    assert hit_at(hand, hand.spot(10, 10)).feature == ""


def test_what_is_not_at_full_strength_cannot_be_taken_hold_of(hand: Hand) -> None:
    line = hand.add(Geometry.LINE, (2, 2), (8, 2))
    far = line.with_vertices(
        tuple(type(one)((one.xyz[0], one.xyz[1], 90.0)) for one in line.vertices)
    )
    hand.map.stored[line.id] = far
    hand.map.shared.map_changes.features_changed.emit((line.id,))
    assert hit_at(hand, hand.spot(2, 2)).vertex == -1


def test_a_vertex_is_dragged_to_another_measured_point(hand: Hand) -> None:
    line = hand.add(Geometry.LINE, (2, 2), (5, 5), (8, 2))
    hand.take(EditVertices(hand.map, hand.map.shared))
    hand.drag(hand.spot(5, 5), hand.spot(6, 8))
    (_, vertex, _) = hand.map.stored[line.id].vertices
    assert vertex.xyz == grid_place(6, 8).xyz
    assert vertex.measured == grid_place(6, 8).measured


def test_a_line_is_drawn_by_clicks_and_the_right_button(hand: Hand) -> None:
    hand.take(path_tool(hand.map, Geometry.LINE))
    for east, north in ((1, 1), (4, 1), (4, 6)):
        hand.click(hand.spot(east, north))
        hand.view.grab()
    hand.click(hand.spot(4, 6), RIGHT)
    (feature,) = hand.map.features()
    places = [grid_place(1, 1), grid_place(4, 1), grid_place(4, 6)]
    assert [one.xyz for one in feature.vertices] == [place.xyz for place in places]


def test_a_box_selects_what_is_wholly_inside_and_the_points(hand: Hand) -> None:
    inside = hand.add(Geometry.LINE, (3, 3), (5, 5))
    hand.add(Geometry.LINE, (4, 4), (9, 9))
    hand.take(Select(hand.map, hand.map.shared))
    hand.drag(hand.spot(1, 7), hand.spot(7, 1))
    assert hand.map.shared.selection.features == {inside.id}
    tool = Listener(DragShape.BOX)
    hand.view.set_mouse_tool(tool)
    hand.drag(hand.spot(1, 7), hand.spot(7, 1))
    assert tool.boxed[0].points["grid"].tolist() == [1, 2]


def test_rejected_features_are_shown_and_hit_on_request_only(hand: Hand) -> None:
    rejected = hand.add(Geometry.LINE, (1, 5), (9, 5), status=Status.REJECTED)
    spot = hand.spot(5, 5)
    around = [spot + QPoint(0, down) for down in (-1, 0, 1)]
    assert hit_at(hand, spot).feature == ""
    hand.map.shared.view_settings.set_shows_rejected(True)
    assert hit_at(hand, spot).feature == rejected.id
    assert max(max(_rgb(hand.colour_at(one))) for one in around) > 60
    hand.map.shared.view_settings.set_shows_rejected(False)
    assert hit_at(hand, spot).feature == ""


def test_features_of_hidden_kinds_and_those_being_edited_are_not_painted(hand: Hand) -> None:
    line = hand.add(Geometry.LINE, (1, 5), (9, 5))
    spot = hand.spot(5, 5)
    painted = hand.colour_at(spot)
    background = hand.colour_at(hand.spot(5, 8))
    assert painted != background
    hand.map.shared.view_settings.hide_kinds(frozenset({line.kind}))
    assert hand.colour_at(spot) == background
    hand.map.shared.view_settings.hide_kinds(frozenset())
    vertices = tuple(one for one in line.vertices[:1])
    drawing = Drawing(line.kind, Geometry.LINE, vertices, replaces=line.id)
    hand.map.shared.sketch.show(drawing)
    assert hand.colour_at(spot) == background


def test_a_changed_feature_is_painted_where_it_is_now(hand: Hand) -> None:
    line = hand.add(Geometry.LINE, (1, 5), (9, 5))
    hand.view.grab()
    other = hand.add(Geometry.LINE, (1, 8), (9, 8))
    hand.map.stored[line.id] = line.with_vertices(other.vertices)
    del hand.map.stored[other.id]
    hand.map.shared.map_changes.features_changed.emit((line.id, other.id))
    assert hand.colour_at(hand.spot(5, 5)) == hand.colour_at(hand.spot(5, 6))
    assert hit_at(hand, hand.spot(5, 8)).feature == line.id


def test_sketch_notes_marks_and_cursor_are_painted_over_the_map(hand: Hand) -> None:
    shared = hand.map.shared
    before = hand.view.grab().toImage()
    vertices = hand.add(Geometry.LINE, (1, 1), (3, 1)).vertices
    note = Note((3.0, 1.0, 5.0), "2.00 m")
    preview = hand.add(Geometry.POINT, (3, 3)).vertices
    shared.sketch.show(Drawing("lid", Geometry.AREA, vertices, preview, notes=(note,)))
    shared.cursor.move_to(grid_place(4, 4))
    shared.cursor.move_to(grid_place(5, 4))
    shared.snap.show_mark(SnapMark((3.0, 3.0, 5.0), SnapMode.VERTEX))
    after = hand.view.grab().toImage()
    assert before != after
    red, _, blue = _rgb(hand.colour_at(hand.spot(5, 4) + QPoint(9, 0)))
    assert red > blue + 100


def test_what_is_not_shown_leaves_no_mark(hand: Hand) -> None:
    hand.view.shown_lay = GridLay(limit=3.0)
    hand.view.set_ground_stale()
    hand.map.shared.cursor.move_to(grid_place(5, 4))
    hand.map.shared.snap.show_mark(SnapMark((3.0, 8.0, 5.0), SnapMode.VERTEX))
    assert hand.view.position_of(grid_place(5, 4)) is None
    hand.view.center_on(grid_place(5, 4))
    hand.view.grab()


def test_a_move_of_the_mouse_paints_the_ground_not_again(hand: Hand) -> None:
    hand.view.grab()
    before = hand.view.grounds
    hand.move(hand.spot(3, 4))
    hand.map.shared.snap.show_mark(SnapMark((3.0, 3.0, 5.0), SnapMode.VERTEX))
    hand.add(Geometry.POINT, (2, 2))
    hand.view.grab()
    assert hand.view.grounds == before
    hand.view.set_ground_stale()
    hand.view.grab()
    assert hand.view.grounds == before + 1


def test_only_what_changed_is_projected_again(hand: Hand) -> None:
    for north in range(1, 9):
        hand.add(Geometry.LINE, (1, north), (9, north))
    hand.view.grab()
    lay = hand.view.lay()
    assert lay is not None
    lay.asked.clear()
    hand.add(Geometry.LINE, (2, 2), (3, 3))
    hand.view.grab()
    assert max(lay.asked) == 2


def test_features_outside_the_reach_of_a_view_are_not_projected(hand: Hand) -> None:
    hand.view.box = np.array([[0.0, 0.0, 0.0], [4.0, 4.0, 10.0]])
    across = hand.add(Geometry.LINE, (1, 1), (9, 9))
    hand.add(Geometry.LINE, (6, 6), (9, 9))
    assert hit_at(hand, hand.spot(9, 9)).feature == across.id


def test_an_empty_view_says_why_and_takes_no_gesture(hand: Hand) -> None:
    hand.view.shown_lay = None
    hand.view.set_ground_stale()
    hand.view.grab()
    before = hand.view.viewport
    hand.click(QPoint(400, 300))
    hand.wheel(QPoint(400, 300), 2)
    hand.key(Qt.Key.Key_Plus)
    hand.view.center_on_selection()
    assert hand.view.viewport == before
    assert hand.map.shared.cursor.place is None
    assert hand.view.position_of(Place((1.0, 1.0, 1.0))) is None


def test_the_right_button_with_nothing_under_way_asks_for_the_menu(hand: Hand) -> None:
    with hand.qtbot.waitSignal(hand.view.menu_requested) as asked:
        hand.click(hand.spot(4, 4), RIGHT)
    (wish,) = asked.args
    assert isinstance(wish, MenuWish)
    assert wish.hit.place == grid_place(4, 4)
    assert len(wish.menu.actions()) == 2
    wish.menu.deleteLater()


def test_another_project_is_shown_from_its_own_beginning(hand: Hand) -> None:
    hand.add(Geometry.LINE, (1, 5), (9, 5))
    hand.view.set_viewport(hand.view.viewport.zoomed(8.0, 10.0, 10.0))
    hand.map.stored.clear()
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.viewport.shows(5.0, -5.0, 0.01)
    assert hit_at(hand, hand.spot(5, 5)).feature == ""


def test_everything_stays_in_windows_of_other_sizes_until_one_looks_elsewhere(hand: Hand) -> None:
    def is_whole() -> bool:
        corners = [hand.spot(0, 0), hand.spot(10, 10)]
        return all(hand.view.rect().contains(corner) for corner in corners)

    hand.view.resize(200, 500)
    assert is_whole()
    hand.view.resize(700, 500)
    assert is_whole()
    scale = hand.view.viewport.scale
    hand.view.zoom_by(1.1)
    hand.view.resize(300, 200)
    assert hand.view.viewport.scale == pytest.approx(1.1 * scale)
    hand.view.show_everything()
    hand.view.resize(500, 400)
    assert is_whole()
