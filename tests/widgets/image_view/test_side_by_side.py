"""Several images of one street: each has its own drive and look, all show the same stretch."""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import SIGNAL, QPoint, Qt
from PySide6.QtWidgets import QComboBox, QToolButton
from pytestqt.qtbot import QtBot

from processing.core.monitor import SilentMonitor
from processing.image.attributes.tile_cache import TileCache
from processing.image.images_of_drives import image_of
from processing.image.search.nearest import nearest_point
from processing.map.catalogue import Geometry
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.mouse_events import move_mouse, turn_wheel
from tests.widgets.builders import OpenMap, path_tool, position_on
from widgets.image_view.orientation.locked_scrolling import following, position_along
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.panes import ShownImage
from widgets.image_view.side_by_side import MOST, ImageViews
from widgets.image_view.view import ImageView
from widgets.shared.image_orientation import ImageOrientation

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def views(
    qtbot: QtBot, open_map: OpenMap, tiles: TileCache, left_drive: Drive
) -> Iterator[ImageViews]:
    open_map.shared.view_settings.show_image(left_drive.id, ImageKind.TRAJECTORY_CENTER)
    views = ImageViews(open_map, open_map.shared, tiles)
    qtbot.addWidget(views)
    views.resize(900, 800)
    with qtbot.waitSignal(views.sharpened, timeout=30_000):
        views.show()
    yield views
    views.close()


def moment_of(view: ImageView) -> float:
    """When what is in the middle was measured."""
    picture = view.picture
    assert picture is not None
    times = picture.image.row_times
    return float(np.interp(view.viewport.centre[0], np.arange(times.size), times))


def metres_per_px(view: ImageView) -> float:
    picture = view.picture
    assert picture is not None
    return picture.orientation.length_m / picture.size[0] / view.viewport.zoom_u


def far_in(view: ImageView) -> None:
    """Show a few metres about the middle of the drive."""
    viewport = view.viewport
    middle = viewport.extent[0] / 2, viewport.extent[1] / 2
    view.look_through(replace(viewport, zoom=2.0).centred_on(*middle))


def test_one_image_stands_alone_without_a_header(views: ImageViews) -> None:
    assert views.views == (views.main,)
    assert views.main.geometry() == views.rect()
    assert [box for box in views.findChildren(QComboBox) if box.isVisible()] == []


def test_the_next_image_is_of_the_other_drive(views: ImageViews, right_drive: Drive) -> None:
    other = views.add()
    assert other is not None
    assert other.picture is not None
    assert other.picture.drive.id == right_drive.id
    third = views.add()
    assert third is not None
    assert views.images[1].attribute == "height"
    assert len(views.views) == MOST
    assert not views.can_add
    assert views.add() is None


def test_an_image_is_closed_by_its_button(qtbot: QtBot, views: ImageViews) -> None:
    views.add()
    (close,) = (
        button
        for button in views.findChildren(QToolButton)
        if button.text() == "✕" and button.isVisible()
    )
    with qtbot.waitSignal(views.images_changed, timeout=30_000):
        qtbot.mouseClick(close, LEFT)
    assert views.views == (views.main,)
    assert views.images == ()


def test_all_show_the_same_moment_at_the_same_scale(views: ImageViews) -> None:
    other = views.add()
    assert other is not None
    far_in(views.main)
    row_s = 0.01
    assert moment_of(other) == pytest.approx(moment_of(views.main), abs=row_s)
    assert metres_per_px(other) == pytest.approx(metres_per_px(views.main), rel=1e-4)


def test_the_image_that_is_turned_leads(qtbot: QtBot, views: ImageViews) -> None:
    other = views.add()
    assert other is not None
    far_in(views.main)
    before = views.main.viewport
    turn_wheel(other, QPoint(300, 100), 2, Qt.KeyboardModifier.ShiftModifier)
    assert views.active is other
    assert views.main.viewport.centre[0] < before.centre[0]
    assert views.main.viewport.centre[1] == before.centre[1]
    assert moment_of(views.main) == pytest.approx(moment_of(other), abs=0.01)


def test_unlocked_images_go_their_own_ways(views: ImageViews) -> None:
    other = views.add()
    assert other is not None
    far_in(views.main)
    views.lock(False)
    before = other.viewport
    views.main.look_through(views.main.viewport.panned(-200, 0))
    assert other.viewport == before
    views.lock(True)
    assert moment_of(other) == pytest.approx(moment_of(views.main), abs=0.01)


def test_a_click_in_one_image_moves_no_other_along(
    qtbot: QtBot, views: ImageViews, left_drive: Drive
) -> None:
    other = views.add()
    assert other is not None
    far_in(views.main)
    image = image_of(left_drive, ImageKind.TRAJECTORY_CENTER)
    point = image.nearest_filled(image.rows // 2 + 5, image.width // 2, 5)
    spot = views.main.position_of(position_on(left_drive, point))
    assert spot is not None
    seen = views.main.viewport, other.viewport.centre[0]
    qtbot.mouseClick(views.main, LEFT, pos=spot.toPoint())
    assert views.main.viewport == seen[0]
    assert other.viewport.centre[0] == pytest.approx(seen[1], abs=0.5)


def test_a_line_is_begun_in_one_image_and_ended_in_another(
    qtbot: QtBot, views: ImageViews, open_map: OpenMap, left_drive: Drive, right_drive: Drive
) -> None:
    views.set_mouse_tool(open_map.listen_to(path_tool(open_map, Geometry.LINE)))
    other = views.add()
    assert other is not None
    far_in(views.main)
    clicked = []
    for view, drive, step in ((views.main, left_drive, 0), (other, right_drive, 4)):
        image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
        point = image.nearest_filled(image.rows // 2 + step, image.width // 2, 5)
        spot = view.position_of(position_on(drive, point))
        assert spot is not None
        qtbot.mouseClick(view, LEFT, Qt.KeyboardModifier.ControlModifier, spot.toPoint())
        clicked.append(position_on(drive, point))
    qtbot.keyClick(other, Qt.Key.Key_Return)
    (line,) = open_map.stored.values()
    assert [vertex.xyz for vertex in line.vertices] == [position.xyz for position in clicked]
    assert [vertex.measured for vertex in line.vertices] == [
        position.measured for position in clicked
    ]


def test_what_is_hidden_is_hidden_in_all(views: ImageViews, open_map: OpenMap) -> None:
    views.add()
    own = views._beside[0].settings
    settings = open_map.shared.view_settings
    settings.hide_kinds(frozenset({"curb"}))
    settings.set_shows_rejected(True)
    settings.change_look(low_percent=10.0)
    assert own.hidden_kinds == {"curb"}
    assert own.shows_rejected
    assert own.look.low_percent == 10.0


def test_attribute_and_sides_belong_to_an_image_direction_to_all(
    views: ImageViews, open_map: OpenMap
) -> None:
    settings = open_map.shared.view_settings
    views.add()
    own = views._beside[0].settings
    own.orient_image(ImageOrientation(is_mirrored_across=True))
    own.change_look(attribute="height")
    settings.change_look(attribute="normal")
    settings.orient_image(ImageOrientation(is_vertical=True))
    assert own.look.attribute == "height"
    assert own.image_orientation == ImageOrientation(is_vertical=True, is_mirrored_across=True)
    assert settings.image_orientation == ImageOrientation(is_vertical=True)


@pytest.mark.parametrize("is_vertical", [False, True])
def test_the_same_place_is_on_one_line_in_all_images(
    views: ImageViews, open_map: OpenMap, is_vertical: bool
) -> None:
    other = views.add()
    assert other is not None
    open_map.shared.view_settings.orient_image(ImageOrientation(is_vertical=is_vertical))
    views.grab()
    far_in(views.main)
    middles = [view.mapTo(views, QPoint(0, 0)) for view in views.views]
    axis = QPoint.y if is_vertical else QPoint.x
    assert len({axis(corner) for corner in middles}) == 1
    sizes = {view.viewport.along_px for view in views.views}
    assert len(sizes) == 1


def test_images_are_kept_and_shown_again(
    qtbot: QtBot, views: ImageViews, open_map: OpenMap, right_drive: Drive
) -> None:
    shown = (
        ShownImage(
            right_drive.id, ImageKind.REVERSIBLE, "height", ImageOrientation(is_vertical=True)
        ),
        ShownImage("gone", ImageKind.REVERSIBLE, "height", ImageOrientation()),
    )
    views.arrange(shown)
    assert views.images == shown[:1]
    views.arrange(())
    assert views.images == ()


def test_an_image_goes_with_its_drive(
    views: ImageViews, open_map: OpenMap, left_drive: Drive
) -> None:
    views.add()
    open_map.all_drives = (left_drive,)
    open_map.shared.map_changes.drives_changed.emit()
    assert views.views == (views.main,)


def test_the_mouse_of_any_image_is_told(
    views: ImageViews, open_map: OpenMap, right_drive: Drive
) -> None:
    other = views.add()
    assert other is not None
    far_in(views.main)
    image = image_of(right_drive, ImageKind.TRAJECTORY_CENTER)
    point = image.nearest_filled(image.rows // 2, image.width // 2, 5)
    spot = other.position_of(position_on(right_drive, point))
    assert spot is not None
    move_mouse(other, spot.toPoint())
    assert open_map.shared.cursor.hover == position_on(right_drive, point)


def test_a_second_pass_follows_by_the_place_in_plan(left_drive: Drive) -> None:
    picture = OrientedImage.of(left_drive, ImageKind.TRAJECTORY_CENTER)
    image = copy(picture.image)
    image.row_times = image.row_times + 3600.0
    orientation = replace(picture.orientation, plan=picture.orientation.plan + np.array([3.0, 0.0]))
    beside = replace(picture, image=image, orientation=orientation)
    found = position_along(picture, (200.3, 100.0), beside)
    assert found is not None
    u, v = found
    assert v is None
    assert np.hypot(
        *(picture.orientation.plan_at(200.3) - orientation.plan_at(u))
    ) == pytest.approx(3.0, abs=0.01)
    viewport = Viewport(900, 700, tuple(map(float, picture.size)), picture.stretch)
    assert following(picture, viewport, beside, viewport) is not None
    far = replace(beside, orientation=replace(orientation, plan=orientation.plan + 1000.0))
    assert position_along(picture, (200.3, 100.0), far) is None
    assert following(picture, viewport, far, viewport) is None


@pytest.fixture
def surveyed(tmp_path: Path, left_drive: Drive) -> Drive:
    """Give the same street as a cloud without rows, which is shown from above."""
    random = np.random.default_rng(1)
    points = random.choice(left_drive.count, 20_000, replace=False)
    cloud = tmp_path / "cloud.xyz"
    np.savetxt(cloud, left_drive.xyz(points), fmt="%.3f")
    into = tmp_path / "drives"
    into.mkdir()
    (made,) = import_drives(ImportRequest((cloud,), ()), into, SilentMonitor())
    return Drive(made)


def test_a_view_from_above_follows_and_leads(left_drive: Drive, surveyed: Drive) -> None:
    street = OrientedImage.of(left_drive, ImageKind.TRAJECTORY_CENTER)
    above = OrientedImage.of(surveyed, ImageKind.TOP_VIEW)
    image = street.image
    point = image.nearest_filled(image.rows // 2, image.width // 2, image.width)
    xyz = left_drive.xyz(np.array([point]))[0]
    rows, columns = image.pixel_of(np.array([point]))
    position = street.positions(rows, columns.astype(np.int64))[0]
    found = position_along(street, (float(position[0]), float(position[1])), above)
    near = nearest_point(surveyed, xyz, 2.0)
    rows, columns = above.image.pixel_of(np.array([near]))
    centre = tuple(above.positions(rows, columns.astype(np.int64))[0].tolist())
    assert found == centre
    back = position_along(above, centre, street)
    assert back is not None
    assert back[1] is None
    away_m = np.diff(street.orientation.distance_m(np.array([back[0], position[0]])))[0]
    assert abs(away_m) < 2.0


def test_an_image_that_was_closed_listens_no_longer(
    qtbot: QtBot, views: ImageViews, open_map: OpenMap
) -> None:
    shared = open_map.shared

    def listeners() -> list[int]:
        return [
            shared.cursor.receivers(SIGNAL("moved(PyObject)")),
            shared.view_settings.receivers(SIGNAL("look_changed(PyObject)")),
            shared.map_changes.receivers(SIGNAL("drives_changed()")),
            shared.sketch.receivers(SIGNAL("changed()")),
        ]

    before = listeners()
    other = views.add()
    assert other is not None
    assert all(now > then for now, then in zip(listeners(), before, strict=True))
    views.close_image(other)
    qtbot.waitUntil(lambda: not shiboken6.isValid(other), timeout=30_000)
    assert listeners() == before
