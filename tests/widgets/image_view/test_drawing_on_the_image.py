"""Drawing, editing and choosing on the image with a real mouse."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from processing.image.images_of_drives import image_of
from processing.image.search.nearest import nearest_point
from processing.map.catalogue import Geometry
from processing.map.feature import Status
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.widgets.builders import KINDS, path_tool, position_on, vertex_on
from tests.widgets.image_view.conftest import ImageViewUser
from tests.widgets.image_view.test_image_view import sky_spot
from widgets.mouse_tools.drawing.draw_line import DrawLine
from widgets.mouse_tools.drawing.draw_point import DrawPoint
from widgets.mouse_tools.drawing.drawing_tool import NO_POINT, TOO_FEW
from widgets.mouse_tools.editing.edit_vertices import EditVertices
from widgets.mouse_tools.editing.select import Select
from widgets.shared.sketch import Drawing

SHIFT = Qt.KeyboardModifier.ShiftModifier


def draw_line(user: ImageViewUser) -> DrawLine:
    tool = path_tool(user.map, Geometry.LINE)
    user.take(tool)
    return tool


def xyz_of(user: ImageViewUser, points: list[int]) -> list[tuple[float, float, float]]:
    return [position_on(user.drive, point).xyz for point in points]


def drawn(user: ImageViewUser) -> list[tuple[float, float, float]]:
    (feature,) = user.map.stored.values()
    return [vertex.xyz for vertex in feature.vertices]


def test_a_line_of_four_clicks_has_the_coordinates_of_four_points(user: ImageViewUser) -> None:
    draw_line(user)
    points = user.points_across(4)
    for point in points:
        user.click(user.spot(point))
    user.key(Qt.Key.Key_Return)
    assert drawn(user) == xyz_of(user, points)
    (feature,) = user.map.stored.values()
    assert [vertex.measured.point for vertex in feature.vertices if vertex.measured] == points


def test_the_right_button_completes_a_line(user: ImageViewUser) -> None:
    draw_line(user)
    points = user.points_across(2)
    for point in points:
        user.click(user.spot(point))
    user.qtbot.mouseClick(user.view, Qt.MouseButton.RightButton, pos=user.spot(points[1]))
    assert drawn(user) == xyz_of(user, points)


def test_a_double_click_completes_and_adds_its_vertex_once(user: ImageViewUser) -> None:
    draw_line(user)
    points = user.points_across(3)
    for point in points[:2]:
        user.click(user.spot(point))
    user.click(user.spot(points[2]))
    user.qtbot.mouseDClick(user.view, Qt.MouseButton.LeftButton, pos=user.spot(points[2]))
    assert drawn(user) == xyz_of(user, points)


def test_backspace_takes_a_vertex_back_and_escape_all(user: ImageViewUser) -> None:
    draw_line(user)
    points = user.points_across(3)
    for point in points:
        user.click(user.spot(point))
    user.key(Qt.Key.Key_Backspace)
    user.key(Qt.Key.Key_Return)
    assert drawn(user) == xyz_of(user, points[:2])
    user.click(user.spot(points[0]))
    user.key(Qt.Key.Key_Escape)
    assert user.map.shared.sketch.drawing is None
    assert len(user.map.stored) == 1


def test_a_line_of_one_vertex_is_refused_with_a_word(user: ImageViewUser) -> None:
    draw_line(user)
    user.click(user.spot(user.points_across(1)[0]))
    user.key(Qt.Key.Key_Return)
    assert user.map.reported == [TOO_FEW[Geometry.LINE]]
    assert not user.map.stored


def test_a_click_into_the_sky_is_refused_with_a_word(user: ImageViewUser) -> None:
    draw_line(user)
    user.click(sky_spot(user))
    assert user.map.reported == [NO_POINT]


def test_the_sketch_leads_to_the_point_under_the_mouse(user: ImageViewUser) -> None:
    draw_line(user)
    first, second = user.points_across(2)
    user.click(user.spot(first))
    user.move(user.spot(second))
    drawing = user.map.shared.sketch.drawing
    assert drawing is not None
    assert drawing.preview == (vertex_on(user.drive, second),)


def test_areas_and_points_are_drawn_by_their_tools(user: ImageViewUser) -> None:
    points = user.points_across(3)
    area = path_tool(user.map, Geometry.AREA)
    user.take(area)
    for point in points:
        user.click(user.spot(point))
    user.key(Qt.Key.Key_Enter)
    assert drawn(user) == xyz_of(user, points)
    dot = DrawPoint(user.map, user.map.shared)
    dot.set_kind(KINDS[user.map.kind_of(Geometry.POINT)])
    user.take(dot)
    user.click(user.spot(points[0]))
    assert len(user.map.stored) == 2


def test_a_dragged_vertex_rests_on_the_point_where_it_was_let_go(user: ImageViewUser) -> None:
    points = user.points_across(4)
    feature = user.map.add(Geometry.LINE, user.drive, *points[:3])
    user.take(EditVertices(user.map, user.map.shared))
    user.drag(user.spot(points[1]), user.spot(points[3]))
    assert drawn(user) == xyz_of(user, [points[0], points[3], points[2]])
    ((_, _), (_, change)) = user.map.applied
    assert change.replaced[0].before == feature
    assert user.map.shared.sketch.drawing is None


def test_a_click_on_a_vertex_changes_nothing(user: ImageViewUser) -> None:
    points = user.points_across(2)
    user.map.add(Geometry.LINE, user.drive, *points)
    user.take(EditVertices(user.map, user.map.shared))
    user.click(user.spot(points[0]))
    assert len(user.map.applied) == 1


def test_a_press_on_a_segment_puts_a_vertex_in_and_drags_it(user: ImageViewUser) -> None:
    first, middle, last, elsewhere = user.points_across(4)
    user.map.add(Geometry.LINE, user.drive, first, last)
    user.take(EditVertices(user.map, user.map.shared))
    user.drag((user.spot(first) + user.spot(last)) / 2, user.spot(elsewhere))
    assert drawn(user) == xyz_of(user, [first, elsewhere, last])
    assert middle not in (first, last)


def test_escape_while_dragging_leaves_the_feature_alone(user: ImageViewUser) -> None:
    points = user.points_across(3)
    user.map.add(Geometry.LINE, user.drive, *points[:2])
    user.take(EditVertices(user.map, user.map.shared))
    start, end = user.spot(points[1]), user.spot(points[2])
    user.qtbot.mousePress(user.view, Qt.MouseButton.LeftButton, pos=start)
    user.move(end, Qt.MouseButton.LeftButton)
    user.key(Qt.Key.Key_Escape)
    user.qtbot.mouseRelease(user.view, Qt.MouseButton.LeftButton, pos=end)
    assert len(user.map.applied) == 1
    assert user.map.shared.sketch.drawing is None


def test_delete_takes_out_the_vertex_under_the_mouse(user: ImageViewUser) -> None:
    points = user.points_across(3)
    user.map.add(Geometry.LINE, user.drive, *points)
    user.take(EditVertices(user.map, user.map.shared))
    user.move(user.spot(points[1]))
    user.key(Qt.Key.Key_Delete)
    assert drawn(user) == xyz_of(user, [points[0], points[2]])
    user.move(user.spot(points[0]))
    user.key(Qt.Key.Key_Delete)
    assert user.map.reported == [TOO_FEW[Geometry.LINE]]
    assert len(user.map.stored) == 1


def test_delete_away_from_vertices_removes_the_chosen_feature(user: ImageViewUser) -> None:
    points = user.points_across(3)
    feature = user.map.add(Geometry.LINE, user.drive, *points[:2])
    user.take(EditVertices(user.map, user.map.shared))
    user.map.shared.selection.choose_features(frozenset({feature.id}))
    user.move(user.spot(points[2]))
    user.key(Qt.Key.Key_Delete)
    assert not user.map.stored


def test_the_pointer_chooses_adds_and_deletes(user: ImageViewUser) -> None:
    points = user.points_across(4)
    one = user.map.add(Geometry.LINE, user.drive, *points[:2])
    other = user.map.add(Geometry.LINE, user.drive, *points[2:])
    user.take(Select(user.map, user.map.shared))
    user.click(user.spot(points[0]))
    assert user.map.shared.selection.features == {one.id}
    assert user.map.shared.cursor.position == position_on(user.drive, points[0])
    user.click(user.spot(points[3]), SHIFT)
    assert user.map.shared.selection.features == {one.id, other.id}
    user.key(Qt.Key.Key_Delete)
    assert not user.map.stored
    assert len(user.map.applied) == 3


def test_a_box_chooses_the_features_and_all_points_inside(user: ImageViewUser) -> None:
    points = user.points_across(4)
    inside = user.map.add(Geometry.LINE, user.drive, *points[:2])
    user.map.add(Geometry.LINE, user.drive, *points[1:4])
    user.take(Select(user.map, user.map.shared))
    spots = [user.spot(point) for point in points[:2]]
    low = QPoint(min(spot.x() for spot in spots), min(spot.y() for spot in spots))
    high = QPoint(max(spot.x() for spot in spots), max(spot.y() for spot in spots))
    start, end = low - QPoint(10, 10), high + QPoint(10, 10)
    user.drag(start, end)
    assert user.map.shared.selection.features == {inside.id}
    picture, viewport = user.view.picture, user.view.viewport
    assert picture is not None
    corners = [picture.pixel_at(*viewport.to_picture(spot.x(), spot.y())) for spot in (start, end)]
    rows, columns = picture.image.pixel_of(np.arange(user.drive.count))
    (first_row, last_row), (low_column, high_column) = (
        sorted(pair) for pair in zip(*corners, strict=True)
    )
    expected = (rows >= first_row) & (rows <= last_row)
    expected &= (columns >= low_column) & (columns <= high_column)
    chosen = user.map.shared.selection.points[user.drive.id]
    assert np.array_equal(chosen, np.flatnonzero(expected))
    assert set(points[:2]) <= set(chosen.tolist())


def test_the_pointer_drags_a_vertex_of_a_chosen_feature(user: ImageViewUser) -> None:
    points = user.points_across(3)
    user.map.add(Geometry.LINE, user.drive, *points[:2])
    user.take(Select(user.map, user.map.shared))
    user.click(user.spot(points[1]))
    user.drag(user.spot(points[1]), user.spot(points[2]))
    assert drawn(user) == xyz_of(user, [points[0], points[2]])


def test_escape_lets_go_of_what_was_chosen(user: ImageViewUser) -> None:
    points = user.points_across(2)
    user.map.add(Geometry.LINE, user.drive, *points)
    user.take(Select(user.map, user.map.shared))
    user.click(user.spot(points[0]))
    user.key(Qt.Key.Key_Escape)
    assert not user.map.shared.selection.features


@pytest.mark.parametrize("is_hidden_by_kind", [True, False])
def test_what_is_not_shown_cannot_be_clicked(user: ImageViewUser, is_hidden_by_kind: bool) -> None:
    points = user.points_across(2)
    status = Status.ACCEPTED if is_hidden_by_kind else Status.REJECTED
    feature = user.map.add(Geometry.LINE, user.drive, *points, status=status)
    if is_hidden_by_kind:
        user.map.shared.view_settings.hide_kinds(frozenset({feature.kind}))
    user.take(Select(user.map, user.map.shared))
    user.click(user.spot(points[0]))
    assert not user.map.shared.selection.features


def test_a_feature_drawn_on_one_drive_is_clicked_on_the_other(
    user: ImageViewUser, right_drive: Drive
) -> None:
    image = image_of(right_drive, ImageKind.TRAJECTORY_CENTER)
    near = [user.points_across(3)[index] for index in (0, 2)]
    others = [nearest_point(right_drive, user.drive.xyz(np.array([p]))[0], 0.3) for p in near]
    assert image.drive_count > max(others) >= min(others) >= 0
    feature = user.map.add(Geometry.LINE, right_drive, *others)
    shown_at = [
        nearest_point(user.drive, right_drive.xyz(np.array([point]))[0], 0.3) for point in others
    ]
    user.take(Select(user.map, user.map.shared))
    with user.qtbot.waitSignal(user.view.features_placed, timeout=30_000):
        user.map.shared.map_changes.features_changed.emit((feature.id,))
    user.click(user.spot(shown_at[0]))
    assert user.map.shared.selection.features == {feature.id}


def test_what_another_view_sketches_is_painted_here(user: ImageViewUser) -> None:
    points = user.points_across(2)
    before = user.view.grab().toImage()
    vertices = tuple(vertex_on(user.drive, point) for point in points)
    kind = user.map.kind_of(Geometry.LINE)
    user.map.shared.sketch.show(Drawing(kind, Geometry.LINE, vertices))
    middle = (user.spot(points[0]) + user.spot(points[1])) / 2
    assert user.view.grab().toImage().pixel(middle) != before.pixel(middle)
