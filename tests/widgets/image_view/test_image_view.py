"""The image view by mouse and keys: positions are computed from points, answers are points."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QPushButton, QWidget
from pytestqt.qtbot import QtBot

from processing.image.attributes import colours
from processing.image.images_of_drives import image_of
from processing.image.kinds import ImageKind
from processing.image.nearest import nearest_point
from processing.image.tile_cache import TileCache
from processing.points.drive import Drive
from processing.project.catalogue import Geometry
from tests.widgets.builders import OpenMap, place_on
from tests.widgets.image_view.conftest import Hand
from widgets.image_view.minimap import Minimap
from widgets.image_view.view import ImageView

SHIFT = Qt.KeyboardModifier.ShiftModifier


def empty_spot(hand: Hand) -> QPoint:
    """Somewhere in the window where the row has no point within ten pixels."""
    picture, viewport = hand.view.picture, hand.view.viewport
    assert picture is not None
    span = viewport.span
    rows, columns = picture.rows_columns(span)
    for row in rows[1:-1]:
        for column in columns[12:-12]:
            if picture.image.nearest_filled(row, column, 10) < 0:
                place = picture.places(np.array([row]), np.array([column]))
                x, y = viewport.to_screen(place)[0].tolist()
                if 0 < x < viewport.width and viewport.top < y < viewport.top + viewport.height:
                    return QPoint(int(x), int(y))
    pytest.fail("the street has no gap in the window")


def test_a_click_puts_the_cursor_on_the_exact_point(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    hand.click(hand.spot(point))
    assert hand.map.shared.cursor.place == place_on(hand.drive, point)


def test_the_mouse_tells_the_point_below_it_and_nothing_over_empty_pixels(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    hand.move(hand.spot(point))
    assert hand.map.shared.cursor.hover == place_on(hand.drive, point)
    hand.view.center_on(place_on(hand.drive, point))
    sky = sky_spot(hand)
    hand.move(sky)
    assert hand.map.shared.cursor.hover is None


def sky_spot(hand: Hand) -> QPoint:
    hand.view.show_everything()
    return empty_spot(hand)


def test_a_click_into_the_sky_leaves_the_cursor(hand: Hand) -> None:
    hand.click(sky_spot(hand))
    assert hand.map.shared.cursor.place is None


@pytest.mark.parametrize("notches", [1, 3, -1])
def test_the_wheel_zooms_at_the_mouse(hand: Hand, notches: int) -> None:
    (point,) = hand.points_across(1)
    spot = hand.spot(point)
    before = hand.view.viewport.zoom
    hand.wheel(spot, notches)
    assert hand.view.viewport.zoom == pytest.approx(before * 1.25**notches)
    after = hand.spot(point)
    assert abs(after.x() - spot.x()) <= 40  # half of a wide pixel of the row
    hand.move(spot)
    assert hand.map.shared.cursor.hover == place_on(hand.drive, point)


def test_shift_and_the_wheel_move_along_the_drive(hand: Hand) -> None:
    before = hand.view.viewport
    hand.wheel(QPoint(400, 300), 1, SHIFT)
    after = hand.view.viewport
    assert after.centre[0] < before.centre[0]
    assert (after.centre[1], after.zoom) == (before.centre[1], before.zoom)


def test_the_middle_button_pushes_the_picture(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    spot = hand.spot(point)
    hand.drag(spot, spot + QPoint(60, 40), button=Qt.MouseButton.MiddleButton)
    assert hand.spot(point) == spot + QPoint(60, 40)
    assert hand.map.shared.cursor.place is None


def test_space_and_a_drag_push_the_picture(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    spot = hand.spot(point)
    hand.qtbot.keyPress(hand.view, Qt.Key.Key_Space)
    hand.drag(spot, spot + QPoint(60, 40))
    hand.qtbot.keyRelease(hand.view, Qt.Key.Key_Space)
    assert hand.spot(point) == spot + QPoint(60, 40)
    hand.click(hand.spot(point))
    assert hand.map.shared.cursor.place == place_on(hand.drive, point)


def test_arrows_move_and_plus_and_minus_zoom(hand: Hand) -> None:
    before = hand.view.viewport
    hand.key(Qt.Key.Key_Right)
    assert hand.view.viewport.centre[0] > before.centre[0]
    hand.key(Qt.Key.Key_Left)
    hand.key(Qt.Key.Key_Plus)
    assert hand.view.viewport.zoom > before.zoom
    hand.key(Qt.Key.Key_Minus)
    assert hand.view.viewport.zoom == pytest.approx(before.zoom)


def test_home_shows_the_whole_drive(hand: Hand) -> None:
    hand.key(Qt.Key.Key_Home)
    span = hand.view.viewport.span
    assert hand.view.picture is not None
    assert span.left <= 0
    assert span.right >= hand.view.picture.size[0]


def test_one_to_one_shows_a_pixel_on_a_pixel(hand: Hand) -> None:
    hand.view.show_one_to_one()
    assert (hand.view.viewport.zoom_u, hand.view.viewport.zoom_v) == (1.0, 1.0)


def test_pixels_have_the_colours_of_their_points(hand: Hand, qtbot: QtBot) -> None:
    points = np.array(hand.points_across(4))
    with qtbot.waitSignal(hand.view.sharpened, raising=False, timeout=2_000):
        hand.view.update()
    look = hand.map.shared.view_settings.look
    expected = colours(
        hand.drive, points, look.attribute, look.low_percent, look.high_percent
    ).tolist()
    image = hand.view.grab().toImage()
    for point, colour in zip(points.tolist(), expected, strict=True):
        shown = QColor(image.pixel(hand.spot(point)))
        assert [shown.red(), shown.green(), shown.blue()] == colour


def test_the_left_side_of_the_drive_is_up_and_the_way_leads_right(
    hand: Hand, right_drive: Drive, qtbot: QtBot
) -> None:
    for drive in (hand.drive, right_drive):
        hand.map.shared.view_settings.show_image(drive.id, ImageKind.TRAJECTORY_CENTER)
        picture = hand.view.picture
        assert picture is not None
        image = picture.image
        row = image.rows // 2
        points = np.arange(image.row_starts[row], image.row_starts[row + 1])
        assert drive.trajectory is not None
        local = drive.trajectory.to_vehicle(drive.xyz(points), drive.columns["time"][points])
        on_ground = np.abs(local[:, 1]) < 3
        rows, columns = image.pixel_of(points[on_ground])
        v = picture.places(rows, columns.astype(np.int64))[:, 1]
        assert np.corrcoef(local[on_ground, 1], v)[0, 1] < -0.9
        first, last = drive.trajectory.positions_at(image.row_times[[0, -1]])
        u = picture.places(np.array([0, image.rows - 1]), np.array([0, 0]))[:, 0]
        assert (u[1] - u[0] > 0) == bool(last[1] > first[1])


def test_the_cursor_of_another_view_is_brought_into_the_window(hand: Hand) -> None:
    picture = hand.view.picture
    assert picture is not None
    image = picture.image
    far = int(image.row_starts[image.rows - 3] + 40)
    moves: list[object] = []
    hand.map.shared.cursor.moved.connect(moves.append)
    hand.map.shared.cursor.move_to(place_on(hand.drive, far))
    position = hand.view.position_of(place_on(hand.drive, far))
    assert position is not None
    assert hand.view.rect().contains(position.toPoint())
    assert len(moves) == 1


def test_a_visible_cursor_does_not_scroll_the_picture(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    before = hand.view.viewport
    hand.map.shared.cursor.move_to(place_on(hand.drive, point))
    assert hand.view.viewport == before


def test_the_cursor_on_another_drive_is_shown_at_the_nearest_point(
    hand: Hand, right_drive: Drive
) -> None:
    image = image_of(right_drive, ImageKind.TRAJECTORY_CENTER)
    other = image.nearest_filled(image.rows // 2, image.width // 2, 20)
    place = place_on(right_drive, other)
    hand.map.shared.cursor.move_to(place)
    position = hand.view.position_of(place)
    assert position is not None
    nearest = nearest_point(hand.drive, np.array(place.xyz), 1.0)
    assert hand.spot(nearest) == QPoint(int(position.x()), int(position.y()))


def test_another_kind_of_image_shows_the_same_rows(hand: Hand) -> None:
    picture = hand.view.picture
    assert picture is not None
    row, _ = picture.pixel_at(*hand.view.viewport.centre)
    point = int(picture.image.row_starts[row])
    hand.map.shared.view_settings.show_image(hand.drive.id, ImageKind.FEATURE_CENTER)
    after = hand.view.picture
    assert after is not None
    assert after.image.kind is ImageKind.FEATURE_CENTER
    rows, _ = after.image.pixel_of(np.array([point]))
    assert abs(after.pixel_at(*hand.view.viewport.centre)[0] - rows[0]) <= 1


def test_the_minimap_leads_to_where_it_is_pressed(hand: Hand) -> None:
    minimap = hand.view.findChild(Minimap)
    assert minimap is not None
    hand.qtbot.mouseClick(
        minimap, Qt.MouseButton.LeftButton, pos=QPoint(minimap.width() * 3 // 4, 10)
    )
    assert hand.view.picture is not None
    share = hand.view.viewport.centre[0] / hand.view.picture.size[0]
    assert share == pytest.approx(0.75, abs=0.01)


def test_f_puts_the_chosen_feature_in_the_middle(hand: Hand) -> None:
    points = hand.points_across(2)
    feature = hand.map.add(Geometry.LINE, hand.drive, *points)
    hand.map.shared.selection.choose_features(frozenset({feature.id}))
    hand.view.show_everything()
    hand.key(Qt.Key.Key_F)
    middle = (hand.spot(points[0]) + hand.spot(points[1])) / 2
    assert (middle - QPoint(450, 20 + 320)).manhattanLength() < 12


def test_f_on_a_feature_larger_than_the_window_paints_all_of_it(hand: Hand) -> None:
    image = image_of(hand.drive, ImageKind.TRAJECTORY_CENTER)
    points = [image.nearest_filled(row, image.width // 2, 40) for row in (2, image.rows - 3)]
    feature = hand.map.add(Geometry.LINE, hand.drive, *points)
    hand.map.shared.selection.choose_features(frozenset({feature.id}))
    hand.view.zoom_by(16.0)
    hand.key(Qt.Key.Key_F)
    # Paint: numbers of numpy instead of Python's would be refused by Qt here.
    hand.view.grab()
    for point in points:
        assert hand.view.rect().contains(hand.spot(point))


def test_the_empty_view_offers_what_would_fill_it(qtbot: QtBot, tiles: TileCache) -> None:
    nothing = OpenMap()
    view = ImageView(nothing, nothing.shared, tiles)
    qtbot.addWidget(view)
    view.show()
    import_button, open_button = view.findChildren(QPushButton)
    with qtbot.waitSignal(view.import_requested, timeout=30_000):
        qtbot.mouseClick(import_button, Qt.MouseButton.LeftButton)
    with qtbot.waitSignal(view.open_requested, timeout=30_000):
        qtbot.mouseClick(open_button, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(10, 10))
    qtbot.mouseMove(view, QPoint(12, 12))
    assert nothing.shared.cursor.place is None


def test_closing_the_project_empties_the_view(hand: Hand) -> None:
    hand.map.all_drives = ()
    hand.map.shared.view_settings.show_image("", ImageKind.TRAJECTORY_CENTER)
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.picture is None
    assert all(button.isVisible() for button in hand.view.findChildren(QPushButton))
    minimap: QWidget | None = hand.view.findChild(Minimap)
    assert minimap is not None
    assert not minimap.isVisible()


def test_an_attribute_that_the_points_lack_gives_way_to_one_that_they_have(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    with hand.qtbot.waitSignal(hand.view.sharpened, raising=False, timeout=2_000):
        hand.view.repaint()
    before = QColor(hand.view.grab().toImage().pixel(hand.spot(point)))
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.map.shared.view_settings.change_look(attribute="segment")
    assert hand.view._images.refusal is None
    assert QColor(hand.view.grab().toImage().pixel(hand.spot(point))) == before


def test_chosen_points_are_tinted(hand: Hand) -> None:
    (point,) = hand.points_across(1)
    with hand.qtbot.waitSignal(hand.view.sharpened, raising=False, timeout=2_000):
        hand.view.repaint()
    before = QColor(hand.view.grab().toImage().pixel(hand.spot(point)))
    hand.map.shared.selection.choose_points({hand.drive.id: np.array([point])})
    after = QColor(hand.view.grab().toImage().pixel(hand.spot(point)))
    assert after.blue() - after.red() > before.blue() - before.red() + 40
    hand.map.shared.selection.choose_points({})
    assert QColor(hand.view.grab().toImage().pixel(hand.spot(point))) == before


def test_a_drive_shown_again_is_painted_again(hand: Hand, right_drive: Drive) -> None:
    settings = hand.map.shared.view_settings
    first = hand.view.grab().toImage()
    settings.show_image(right_drive.id, ImageKind.TRAJECTORY_CENTER)
    hand.view.grab()
    viewport = hand.view.viewport
    settings.show_image(hand.drive.id, ImageKind.TRAJECTORY_CENTER)
    with hand.qtbot.waitSignal(hand.view.sharpened, raising=False, timeout=2_000):
        hand.view.grab()
    again = hand.view.grab().toImage()
    assert again.size() == first.size()
    assert hand.view.viewport.width == viewport.width
    picture = hand.view.picture
    assert picture is not None
    assert picture.drive is hand.drive
