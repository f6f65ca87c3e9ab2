"""Drawing, editing and choosing on the image with a real mouse."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from processing.image.images_of_drives import image_of
from processing.image.kinds import ImageKind
from processing.image.nearest import nearest_point
from processing.points.drive import Drive
from processing.project.catalogue import Geometry
from processing.project.feature import Status
from tests.widgets.builders import KINDS, path_tool, place_on, vertex_on
from tests.widgets.image_view.conftest import Hand
from tests.widgets.image_view.test_image_view import sky_spot
from widgets.mouse_tools.draw_path import DrawPath
from widgets.mouse_tools.draw_point import DrawPoint
from widgets.mouse_tools.drawing_tool import NO_POINT, TOO_FEW
from widgets.mouse_tools.edit_vertices import EditVertices
from widgets.mouse_tools.select import Select
from widgets.shared.sketch import Drawing

SHIFT = Qt.KeyboardModifier.ShiftModifier


def draw_line(hand: Hand) -> DrawPath:
    tool = path_tool(hand.map, Geometry.LINE)
    hand.take(tool)
    return tool


def xyz_of(hand: Hand, points: list[int]) -> list[tuple[float, float, float]]:
    return [place_on(hand.drive, point).xyz for point in points]


def drawn(hand: Hand) -> list[tuple[float, float, float]]:
    (feature,) = hand.map.stored.values()
    return [vertex.xyz for vertex in feature.vertices]


def test_a_line_of_four_clicks_has_the_coordinates_of_four_points(hand: Hand) -> None:
    draw_line(hand)
    points = hand.points_across(4)
    for point in points:
        hand.click(hand.spot(point))
    hand.key(Qt.Key.Key_Return)
    assert drawn(hand) == xyz_of(hand, points)
    (feature,) = hand.map.stored.values()
    assert [vertex.measured.point for vertex in feature.vertices if vertex.measured] == points


def test_the_right_button_completes_a_line(hand: Hand) -> None:
    draw_line(hand)
    points = hand.points_across(2)
    for point in points:
        hand.click(hand.spot(point))
    hand.qtbot.mouseClick(hand.view, Qt.MouseButton.RightButton, pos=hand.spot(points[1]))
    assert drawn(hand) == xyz_of(hand, points)


def test_a_double_click_completes_and_adds_its_vertex_once(hand: Hand) -> None:
    draw_line(hand)
    points = hand.points_across(3)
    for point in points[:2]:
        hand.click(hand.spot(point))
    hand.click(hand.spot(points[2]))
    hand.qtbot.mouseDClick(hand.view, Qt.MouseButton.LeftButton, pos=hand.spot(points[2]))
    assert drawn(hand) == xyz_of(hand, points)


def test_backspace_takes_a_vertex_back_and_escape_all(hand: Hand) -> None:
    draw_line(hand)
    points = hand.points_across(3)
    for point in points:
        hand.click(hand.spot(point))
    hand.key(Qt.Key.Key_Backspace)
    hand.key(Qt.Key.Key_Return)
    assert drawn(hand) == xyz_of(hand, points[:2])
    hand.click(hand.spot(points[0]))
    hand.key(Qt.Key.Key_Escape)
    assert hand.map.shared.sketch.drawing is None
    assert len(hand.map.stored) == 1


def test_a_line_of_one_vertex_is_refused_with_a_word(hand: Hand) -> None:
    draw_line(hand)
    hand.click(hand.spot(hand.points_across(1)[0]))
    hand.key(Qt.Key.Key_Return)
    assert hand.map.told == [TOO_FEW[Geometry.LINE]]
    assert not hand.map.stored


def test_a_click_into_the_sky_is_refused_with_a_word(hand: Hand) -> None:
    draw_line(hand)
    hand.click(sky_spot(hand))
    assert hand.map.told == [NO_POINT]


def test_the_sketch_leads_to_the_point_under_the_mouse(hand: Hand) -> None:
    draw_line(hand)
    first, second = hand.points_across(2)
    hand.click(hand.spot(first))
    hand.move(hand.spot(second))
    drawing = hand.map.shared.sketch.drawing
    assert drawing is not None
    assert drawing.preview == (vertex_on(hand.drive, second),)


def test_areas_and_points_are_drawn_by_their_tools(hand: Hand) -> None:
    points = hand.points_across(3)
    area = path_tool(hand.map, Geometry.AREA)
    hand.take(area)
    for point in points:
        hand.click(hand.spot(point))
    hand.key(Qt.Key.Key_Enter)
    assert drawn(hand) == xyz_of(hand, points)
    dot = DrawPoint(hand.map, hand.map.shared)
    dot.set_kind(KINDS[hand.map.kind_of(Geometry.POINT)])
    hand.take(dot)
    hand.click(hand.spot(points[0]))
    assert len(hand.map.stored) == 2


def test_a_dragged_vertex_rests_on_the_point_where_it_was_let_go(hand: Hand) -> None:
    points = hand.points_across(4)
    feature = hand.map.add(Geometry.LINE, hand.drive, *points[:3])
    hand.take(EditVertices(hand.map, hand.map.shared))
    hand.drag(hand.spot(points[1]), hand.spot(points[3]))
    assert drawn(hand) == xyz_of(hand, [points[0], points[3], points[2]])
    ((_, _), (_, change)) = hand.map.applied
    assert change.replaced[0].before == feature
    assert hand.map.shared.sketch.drawing is None


def test_a_click_on_a_vertex_changes_nothing(hand: Hand) -> None:
    points = hand.points_across(2)
    hand.map.add(Geometry.LINE, hand.drive, *points)
    hand.take(EditVertices(hand.map, hand.map.shared))
    hand.click(hand.spot(points[0]))
    assert len(hand.map.applied) == 1


def test_a_press_on_a_segment_puts_a_vertex_in_and_drags_it(hand: Hand) -> None:
    first, middle, last, elsewhere = hand.points_across(4)
    hand.map.add(Geometry.LINE, hand.drive, first, last)
    hand.take(EditVertices(hand.map, hand.map.shared))
    hand.drag((hand.spot(first) + hand.spot(last)) / 2, hand.spot(elsewhere))
    assert drawn(hand) == xyz_of(hand, [first, elsewhere, last])
    assert middle not in (first, last)


def test_escape_while_dragging_leaves_the_feature_alone(hand: Hand) -> None:
    points = hand.points_across(3)
    hand.map.add(Geometry.LINE, hand.drive, *points[:2])
    hand.take(EditVertices(hand.map, hand.map.shared))
    start, end = hand.spot(points[1]), hand.spot(points[2])
    hand.qtbot.mousePress(hand.view, Qt.MouseButton.LeftButton, pos=start)
    hand.move(end, Qt.MouseButton.LeftButton)
    hand.key(Qt.Key.Key_Escape)
    hand.qtbot.mouseRelease(hand.view, Qt.MouseButton.LeftButton, pos=end)
    assert len(hand.map.applied) == 1
    assert hand.map.shared.sketch.drawing is None


def test_delete_takes_out_the_vertex_under_the_mouse(hand: Hand) -> None:
    points = hand.points_across(3)
    hand.map.add(Geometry.LINE, hand.drive, *points)
    hand.take(EditVertices(hand.map, hand.map.shared))
    hand.move(hand.spot(points[1]))
    hand.key(Qt.Key.Key_Delete)
    assert drawn(hand) == xyz_of(hand, [points[0], points[2]])
    hand.move(hand.spot(points[0]))
    hand.key(Qt.Key.Key_Delete)
    assert hand.map.told == [TOO_FEW[Geometry.LINE]]
    assert len(hand.map.stored) == 1


def test_delete_away_from_vertices_removes_the_chosen_feature(hand: Hand) -> None:
    points = hand.points_across(3)
    feature = hand.map.add(Geometry.LINE, hand.drive, *points[:2])
    hand.take(EditVertices(hand.map, hand.map.shared))
    hand.map.shared.selection.choose_features(frozenset({feature.id}))
    hand.move(hand.spot(points[2]))
    hand.key(Qt.Key.Key_Delete)
    assert not hand.map.stored


def test_the_pointer_chooses_adds_and_deletes(hand: Hand) -> None:
    points = hand.points_across(4)
    one = hand.map.add(Geometry.LINE, hand.drive, *points[:2])
    other = hand.map.add(Geometry.LINE, hand.drive, *points[2:])
    hand.take(Select(hand.map, hand.map.shared))
    hand.click(hand.spot(points[0]))
    assert hand.map.shared.selection.features == {one.id}
    assert hand.map.shared.cursor.place == place_on(hand.drive, points[0])
    hand.click(hand.spot(points[3]), SHIFT)
    assert hand.map.shared.selection.features == {one.id, other.id}
    hand.key(Qt.Key.Key_Delete)
    assert not hand.map.stored
    assert len(hand.map.applied) == 3


def test_a_box_chooses_the_features_and_all_points_inside(hand: Hand) -> None:
    points = hand.points_across(4)
    inside = hand.map.add(Geometry.LINE, hand.drive, *points[:2])
    hand.map.add(Geometry.LINE, hand.drive, *points[1:4])
    hand.take(Select(hand.map, hand.map.shared))
    spots = [hand.spot(point) for point in points[:2]]
    low = QPoint(min(spot.x() for spot in spots), min(spot.y() for spot in spots))
    high = QPoint(max(spot.x() for spot in spots), max(spot.y() for spot in spots))
    start, end = low - QPoint(10, 10), high + QPoint(10, 10)
    hand.drag(start, end)
    assert hand.map.shared.selection.features == {inside.id}
    picture, viewport = hand.view.picture, hand.view.viewport
    assert picture is not None
    corners = [picture.pixel_at(*viewport.to_picture(spot.x(), spot.y())) for spot in (start, end)]
    rows, columns = picture.image.pixel_of(np.arange(hand.drive.count))
    (first_row, last_row), (low_column, high_column) = (
        sorted(pair) for pair in zip(*corners, strict=True)
    )
    expected = (rows >= first_row) & (rows <= last_row)
    expected &= (columns >= low_column) & (columns <= high_column)
    chosen = hand.map.shared.selection.points[hand.drive.id]
    assert np.array_equal(chosen, np.flatnonzero(expected))
    assert set(points[:2]) <= set(chosen.tolist())


def test_the_pointer_drags_a_vertex_of_a_chosen_feature(hand: Hand) -> None:
    points = hand.points_across(3)
    hand.map.add(Geometry.LINE, hand.drive, *points[:2])
    hand.take(Select(hand.map, hand.map.shared))
    hand.click(hand.spot(points[1]))
    hand.drag(hand.spot(points[1]), hand.spot(points[2]))
    assert drawn(hand) == xyz_of(hand, [points[0], points[2]])


def test_escape_lets_go_of_what_was_chosen(hand: Hand) -> None:
    points = hand.points_across(2)
    hand.map.add(Geometry.LINE, hand.drive, *points)
    hand.take(Select(hand.map, hand.map.shared))
    hand.click(hand.spot(points[0]))
    hand.key(Qt.Key.Key_Escape)
    assert not hand.map.shared.selection.features


@pytest.mark.parametrize("is_hidden_by_kind", [True, False])
def test_what_is_not_shown_cannot_be_clicked(hand: Hand, is_hidden_by_kind: bool) -> None:
    points = hand.points_across(2)
    status = Status.ACCEPTED if is_hidden_by_kind else Status.REJECTED
    feature = hand.map.add(Geometry.LINE, hand.drive, *points, status=status)
    if is_hidden_by_kind:
        hand.map.shared.view_settings.hide_kinds(frozenset({feature.kind}))
    hand.take(Select(hand.map, hand.map.shared))
    hand.click(hand.spot(points[0]))
    assert not hand.map.shared.selection.features


def test_a_feature_drawn_on_one_drive_is_clicked_on_the_other(
    hand: Hand, right_drive: Drive
) -> None:
    image = image_of(right_drive, ImageKind.TRAJECTORY_CENTER)
    near = [hand.points_across(3)[index] for index in (0, 2)]
    others = [nearest_point(right_drive, hand.drive.xyz(np.array([p]))[0], 0.3) for p in near]
    assert image.drive_count > max(others) >= min(others) >= 0
    feature = hand.map.add(Geometry.LINE, right_drive, *others)
    shown_at = [
        nearest_point(hand.drive, right_drive.xyz(np.array([point]))[0], 0.3) for point in others
    ]
    hand.take(Select(hand.map, hand.map.shared))
    with hand.qtbot.waitSignal(hand.view.features_placed, timeout=30_000):
        hand.map.shared.map_changes.features_changed.emit((feature.id,))
    hand.click(hand.spot(shown_at[0]))
    assert hand.map.shared.selection.features == {feature.id}


def test_what_another_view_sketches_is_painted_here(hand: Hand) -> None:
    points = hand.points_across(2)
    before = hand.view.grab().toImage()
    vertices = tuple(vertex_on(hand.drive, point) for point in points)
    kind = hand.map.kind_of(Geometry.LINE)
    hand.map.shared.sketch.show(Drawing(kind, Geometry.LINE, vertices))
    middle = (hand.spot(points[0]) + hand.spot(points[1])) / 2
    assert hand.view.grab().toImage().pixel(middle) != before.pixel(middle)
