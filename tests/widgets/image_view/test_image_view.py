"""The image view by mouse and keys: positions are computed from points, answers are points."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QPushButton, QWidget
from pytestqt.qtbot import QtBot

from processing.image.attributes.attributes import colours
from processing.image.attributes.tile_cache import TileCache
from processing.image.images_of_drives import image_of
from processing.image.search.nearest import nearest_point
from processing.map.catalogue import Geometry
from processing.map.own_points import own_points
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.widgets.builders import OpenMap, position_on
from tests.widgets.image_view.conftest import ImageViewUser
from widgets.image_view.minimap import Minimap
from widgets.image_view.view import ImageView

SHIFT = Qt.KeyboardModifier.ShiftModifier


def empty_spot(user: ImageViewUser) -> QPoint:
    """Somewhere in the window where the row has no point within ten pixels."""
    picture, viewport = user.view.picture, user.view.viewport
    assert picture is not None
    span = viewport.span
    rows, columns = picture.rows_columns(span)
    for row in rows[1:-1]:
        for column in columns[12:-12]:
            if picture.image.nearest_filled(row, column, 10) < 0:
                position = picture.positions(np.array([row]), np.array([column]))
                x, y = viewport.to_screen(position)[0].tolist()
                if 0 < x < viewport.width and viewport.top < y < viewport.top + viewport.height:
                    return QPoint(int(x), int(y))
    pytest.fail("the street has no gap in the window")


def test_a_click_puts_the_cursor_on_the_exact_point(user: ImageViewUser) -> None:
    (point,) = user.points_across(1)
    user.click(user.spot(point))
    assert user.map.shared.cursor.position == position_on(user.drive, point)


def test_the_mouse_tells_the_point_below_it_and_nothing_over_empty_pixels(
    user: ImageViewUser,
) -> None:
    (point,) = user.points_across(1)
    user.move(user.spot(point))
    assert user.map.shared.cursor.hover == position_on(user.drive, point)
    user.view.center_on(position_on(user.drive, point))
    sky = sky_spot(user)
    user.move(sky)
    assert user.map.shared.cursor.hover is None


def sky_spot(user: ImageViewUser) -> QPoint:
    user.view.show_everything()
    return empty_spot(user)


def test_a_click_into_the_sky_leaves_the_cursor(user: ImageViewUser) -> None:
    user.click(sky_spot(user))
    assert user.map.shared.cursor.position is None


@pytest.mark.parametrize("notches", [1, 3, -1])
def test_the_wheel_zooms_at_the_mouse(user: ImageViewUser, notches: int) -> None:
    (point,) = user.points_across(1)
    spot = user.spot(point)
    before = user.view.viewport.zoom
    user.wheel(spot, notches)
    assert user.view.viewport.zoom == pytest.approx(before * 1.25**notches)
    after = user.spot(point)
    assert abs(after.x() - spot.x()) <= 40  # half of a wide pixel of the row
    user.move(spot)
    assert user.map.shared.cursor.hover == position_on(user.drive, point)


def test_shift_and_the_wheel_move_along_the_drive(user: ImageViewUser) -> None:
    before = user.view.viewport
    user.wheel(QPoint(400, 300), 1, SHIFT)
    after = user.view.viewport
    assert after.centre[0] < before.centre[0]
    assert (after.centre[1], after.zoom) == (before.centre[1], before.zoom)


def test_the_middle_button_pushes_the_picture(user: ImageViewUser) -> None:
    (point,) = user.points_across(1)
    spot = user.spot(point)
    user.drag(spot, spot + QPoint(60, 40), button=Qt.MouseButton.MiddleButton)
    assert user.spot(point) == spot + QPoint(60, 40)
    assert user.map.shared.cursor.position is None


def test_space_and_a_drag_push_the_picture(user: ImageViewUser) -> None:
    (point,) = user.points_across(1)
    spot = user.spot(point)
    user.qtbot.keyPress(user.view, Qt.Key.Key_Space)
    user.drag(spot, spot + QPoint(60, 40))
    user.qtbot.keyRelease(user.view, Qt.Key.Key_Space)
    assert user.spot(point) == spot + QPoint(60, 40)
    user.click(user.spot(point))
    assert user.map.shared.cursor.position == position_on(user.drive, point)


def test_arrows_move_and_plus_and_minus_zoom(user: ImageViewUser) -> None:
    before = user.view.viewport
    user.key(Qt.Key.Key_Right)
    assert user.view.viewport.centre[0] > before.centre[0]
    user.key(Qt.Key.Key_Left)
    user.key(Qt.Key.Key_Plus)
    assert user.view.viewport.zoom > before.zoom
    user.key(Qt.Key.Key_Minus)
    assert user.view.viewport.zoom == pytest.approx(before.zoom)


def test_home_shows_the_whole_drive(user: ImageViewUser) -> None:
    user.key(Qt.Key.Key_Home)
    span = user.view.viewport.span
    assert user.view.picture is not None
    assert span.left <= 0
    assert span.right >= user.view.picture.size[0]


def test_one_to_one_shows_a_pixel_on_a_pixel(user: ImageViewUser) -> None:
    user.view.show_one_to_one()
    assert (user.view.viewport.zoom_u, user.view.viewport.zoom_v) == (1.0, 1.0)


def test_pixels_have_the_colours_of_their_points(user: ImageViewUser, qtbot: QtBot) -> None:
    points = np.array(user.points_across(4))
    with qtbot.waitSignal(user.view.sharpened, raising=False, timeout=2_000):
        user.view.update()
    look = user.map.shared.view_settings.look
    expected = colours(
        user.drive, points, look.attribute, look.low_percent, look.high_percent
    ).tolist()
    image = user.view.grab().toImage()
    for point, colour in zip(points.tolist(), expected, strict=True):
        shown = QColor(image.pixel(user.spot(point)))
        assert [shown.red(), shown.green(), shown.blue()] == colour


def test_the_left_side_of_the_drive_is_up_and_the_way_leads_right(
    user: ImageViewUser, right_drive: Drive, qtbot: QtBot
) -> None:
    for drive in (user.drive, right_drive):
        user.map.shared.view_settings.show_image(drive.id, ImageKind.TRAJECTORY_CENTER)
        picture = user.view.picture
        assert picture is not None
        image = picture.image
        row = image.rows // 2
        points = np.arange(image.row_starts[row], image.row_starts[row + 1])
        assert drive.trajectory is not None
        local = drive.trajectory.to_vehicle(drive.xyz(points), drive.columns["time"][points])
        on_ground = np.abs(local[:, 1]) < 3
        rows, columns = image.pixel_of(points[on_ground])
        v = picture.positions(rows, columns.astype(np.int64))[:, 1]
        assert np.corrcoef(local[on_ground, 1], v)[0, 1] < -0.9
        first, last = drive.trajectory.positions_at(image.row_times[[0, -1]])
        u = picture.positions(np.array([0, image.rows - 1]), np.array([0, 0]))[:, 0]
        assert (u[1] - u[0] > 0) == bool(last[1] > first[1])


def test_the_cursor_of_another_view_is_brought_into_the_window(user: ImageViewUser) -> None:
    picture = user.view.picture
    assert picture is not None
    image = picture.image
    far = int(image.row_starts[image.rows - 3] + 40)
    moves: list[object] = []
    user.map.shared.cursor.moved.connect(moves.append)
    user.map.shared.cursor.move_to(position_on(user.drive, far))
    position = user.view.position_of(position_on(user.drive, far))
    assert position is not None
    assert user.view.rect().contains(position.toPoint())
    assert len(moves) == 1


def test_a_visible_cursor_does_not_scroll_the_picture(user: ImageViewUser) -> None:
    (point,) = user.points_across(1)
    before = user.view.viewport
    user.map.shared.cursor.move_to(position_on(user.drive, point))
    assert user.view.viewport == before


def test_the_cursor_on_another_drive_is_shown_at_the_nearest_point(
    user: ImageViewUser, right_drive: Drive
) -> None:
    image = image_of(right_drive, ImageKind.TRAJECTORY_CENTER)
    other = image.nearest_filled(image.rows // 2, image.width // 2, 20)
    position = position_on(right_drive, other)
    user.map.shared.cursor.move_to(position)
    pixel = user.view.position_of(position)
    assert pixel is not None
    nearest = nearest_point(user.drive, np.array(position.xyz), 1.0)
    assert user.spot(nearest) == QPoint(int(pixel.x()), int(pixel.y()))


def test_another_kind_of_image_shows_the_same_rows(user: ImageViewUser) -> None:
    picture = user.view.picture
    assert picture is not None
    row, _ = picture.pixel_at(*user.view.viewport.centre)
    point = int(picture.image.row_starts[row])
    user.map.shared.view_settings.show_image(user.drive.id, ImageKind.FEATURE_CENTER)
    after = user.view.picture
    assert after is not None
    assert after.image.kind is ImageKind.FEATURE_CENTER
    rows, _ = after.image.pixel_of(np.array([point]))
    assert abs(after.pixel_at(*user.view.viewport.centre)[0] - rows[0]) <= 1


def test_the_minimap_leads_to_where_it_is_pressed(user: ImageViewUser) -> None:
    minimap = user.view.findChild(Minimap)
    assert minimap is not None
    user.qtbot.mouseClick(
        minimap, Qt.MouseButton.LeftButton, pos=QPoint(minimap.width() * 3 // 4, 10)
    )
    assert user.view.picture is not None
    share = user.view.viewport.centre[0] / user.view.picture.size[0]
    assert share == pytest.approx(0.75, abs=0.01)


def test_f_puts_the_chosen_feature_in_the_middle(user: ImageViewUser) -> None:
    points = user.points_across(2)
    feature = user.map.add(Geometry.LINE, user.drive, *points)
    user.map.shared.selection.choose_features(frozenset({feature.id}))
    user.view.show_everything()
    user.key(Qt.Key.Key_F)
    middle = (user.spot(points[0]) + user.spot(points[1])) / 2
    assert (middle - QPoint(450, 20 + 320)).manhattanLength() < 12


def test_f_on_a_feature_larger_than_the_window_paints_all_of_it(user: ImageViewUser) -> None:
    image = image_of(user.drive, ImageKind.TRAJECTORY_CENTER)
    points = [image.nearest_filled(row, image.width // 2, 40) for row in (2, image.rows - 3)]
    feature = user.map.add(Geometry.LINE, user.drive, *points)
    user.map.shared.selection.choose_features(frozenset({feature.id}))
    user.view.zoom_by(16.0)
    user.key(Qt.Key.Key_F)
    # Paint: numbers of numpy instead of Python's would be refused by Qt here.
    user.view.grab()
    for point in points:
        assert user.view.rect().contains(user.spot(point))


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
    assert nothing.shared.cursor.position is None


def test_closing_the_project_empties_the_view(user: ImageViewUser) -> None:
    user.map.all_drives = ()
    user.map.shared.view_settings.show_image("", ImageKind.TRAJECTORY_CENTER)
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.picture is None
    assert all(button.isVisible() for button in user.view.findChildren(QPushButton))
    minimap: QWidget | None = user.view.findChild(Minimap)
    assert minimap is not None
    assert not minimap.isVisible()


def test_an_attribute_that_the_points_lack_gives_way_to_one_that_they_have(
    user: ImageViewUser,
) -> None:
    (point,) = user.points_across(1)
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.view_settings.change_look(attribute="intensity")
    before = QColor(user.view.grab().toImage().pixel(user.spot(point)))
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.view_settings.change_look(attribute="segment")
    assert user.view._images.refusal is None
    assert QColor(user.view.grab().toImage().pixel(user.spot(point))) == before


def test_chosen_points_are_tinted(user: ImageViewUser) -> None:
    (point,) = user.points_across(1)
    with user.qtbot.waitSignal(user.view.sharpened, raising=False, timeout=2_000):
        user.view.repaint()
    before = QColor(user.view.grab().toImage().pixel(user.spot(point)))
    user.map.shared.selection.choose_points({user.drive.id: np.array([point])})
    after = QColor(user.view.grab().toImage().pixel(user.spot(point)))
    assert after.blue() - after.red() > before.blue() - before.red() + 40
    user.map.shared.selection.choose_points({})
    assert QColor(user.view.grab().toImage().pixel(user.spot(point))) == before


def test_own_points_of_a_chosen_feature_are_dotted(user: ImageViewUser) -> None:
    foot, of_trunk = user.points_across(2)
    tree = user.map.add(
        Geometry.POINT, user.drive, foot, own_points=(own_points(user.drive.id, [of_trunk]),)
    )
    before = QColor(user.view.grab().toImage().pixel(user.spot(of_trunk)))
    user.map.shared.selection.choose_features(frozenset({tree.id}))
    dot = QColor(user.view.grab().toImage().pixel(user.spot(of_trunk)))
    assert dot.getRgb()[:3] == pytest.approx(QColor("#009e73").getRgb()[:3], abs=40)
    assert dot != before
    user.map.shared.selection.choose_features(frozenset())
    assert QColor(user.view.grab().toImage().pixel(user.spot(of_trunk))) == before


def test_a_drive_shown_again_is_painted_again(user: ImageViewUser, right_drive: Drive) -> None:
    settings = user.map.shared.view_settings
    first = user.view.grab().toImage()
    settings.show_image(right_drive.id, ImageKind.TRAJECTORY_CENTER)
    user.view.grab()
    viewport = user.view.viewport
    settings.show_image(user.drive.id, ImageKind.TRAJECTORY_CENTER)
    with user.qtbot.waitSignal(user.view.sharpened, raising=False, timeout=2_000):
        user.view.grab()
    again = user.view.grab().toImage()
    assert again.size() == first.size()
    assert user.view.viewport.width == viewport.width
    picture = user.view.picture
    assert picture is not None
    assert picture.drive is user.drive
