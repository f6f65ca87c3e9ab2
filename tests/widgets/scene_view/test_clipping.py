"""What is clipped off is neither drawn nor hit; the rest stays as it was."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF
from PySide6.QtWidgets import QDoubleSpinBox, QMenu

from processing.core.arrays import Floats
from processing.image.attributes.attributes import colours
from processing.image.search.clip import Clip
from processing.image.search.corridor import Corridor, CorridorExtent
from processing.map.catalogue import Geometry
from processing.recording.drive import Drive
from tests.mouse_events import NO_KEYS
from tests.widgets.builders import position_on
from tests.widgets.scene_view.conftest import RIGHT, SceneViewUser
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.mouse_tools.mouse_tool import DragShape, EnclosedHits, Hit, MouseTool
from widgets.scene_view.clipping import MARGIN_M, ClipChoice
from widgets.scene_view.slab_form import SlabForm


def drawn_xyz(user: SceneViewUser) -> Floats:
    """Places of all points that are drawn, m, project CRS."""
    cloud = user.view.cloud
    assert cloud is not None
    positions = [one.tile.local_xyz for one in cloud.drawn]
    return np.concatenate([np.empty((0, 3)), *positions]) + user.map.origin()


def clip(user: SceneViewUser, choose: Callable[[], None]) -> None:
    choose()
    user.sharpen()


def way_of(drive: Drive) -> Floats:
    assert drive.trajectory is not None
    xyz = drive.xyz(slice(None))
    vehicle_path = drive.trajectory.xyz
    inside = (vehicle_path[:, :2] >= xyz[:, :2].min(axis=0)) & (
        vehicle_path[:, :2] <= xyz[:, :2].max(axis=0)
    )
    return vehicle_path[inside.all(axis=1)]


def test_only_what_is_near_the_drive_is_drawn(user: SceneViewUser) -> None:
    before = len(drawn_xyz(user))
    clip(user, lambda: user.view.clipping.set_slab(CorridorExtent(2.0, 3.0, -0.5, 1.5)))
    clip(user, lambda: user.view.clipping.choose(ClipChoice.DRIVE))
    xyz = drawn_xyz(user)
    assert 0 < len(xyz) < before
    corridor = Corridor(user.drive, CorridorExtent(2.05, 3.05, -0.55, 1.55))
    assert corridor.holds(xyz).all()


def test_a_wider_slab_brings_points_back(user: SceneViewUser) -> None:
    view = user.view
    view.clipping.set_slab(CorridorExtent(1.0, 1.0))
    clip(user, lambda: view.clipping.choose(ClipChoice.DRIVE))
    narrow = len(drawn_xyz(user))
    clip(user, lambda: view.clipping.set_slab(CorridorExtent(4.0, 4.0)))
    assert len(drawn_xyz(user)) > narrow


def test_all_points_are_back_when_nothing_is_clipped(user: SceneViewUser) -> None:
    before = np.sort(drawn_xyz(user), axis=0)
    clip(user, lambda: user.view.clipping.choose(ClipChoice.DRIVE))
    clip(user, user.view.clipping.show_everything)
    assert np.sort(drawn_xyz(user), axis=0) == pytest.approx(before)


def test_colours_stay_with_their_points(user: SceneViewUser) -> None:
    user.view.clipping.set_slab(CorridorExtent(2.0, 2.0))
    clip(user, lambda: user.view.clipping.choose(ClipChoice.DRIVE))
    user.map.shared.view_settings.change_look(attribute="height")
    user.sharpen()
    cloud = user.view.cloud
    assert cloud is not None
    for one in cloud.drawn:
        tile = one.tile
        drive = user.map.drive(tile.id.drive_id)
        if tile.points.size:
            wanted = colours(drive, tile.points, "height", 2.0, 98.0)
            assert tile.colours.tolist() == wanted.tolist()


def test_a_click_hits_no_point_that_is_clipped_off(user: SceneViewUser) -> None:
    near, far = user.road_points(4)[0], user.road_points(4)[3]
    user.map.shared.cursor.move_to(position_on(user.drive, near))
    clip(user, lambda: user.view.clipping.choose(ClipChoice.SELECTION))
    user.look_at(position_on(user.drive, far))
    user.click(user.spot(position_on(user.drive, far)))
    assert user.map.shared.cursor.position == position_on(user.drive, near)
    clip(user, user.view.clipping.show_everything)
    user.click(user.spot(position_on(user.drive, far)))
    assert user.map.shared.cursor.position == position_on(user.drive, far)


def test_around_what_is_chosen_is_so_much_more(user: SceneViewUser) -> None:
    points = user.road_points(4)
    feature = user.map.add(Geometry.LINE, user.drive, points[1], points[2])
    user.map.shared.selection.choose_features(frozenset({feature.id}))
    clip(user, lambda: user.view.clipping.choose(ClipChoice.SELECTION))
    xyz, positions = drawn_xyz(user), user.drive.xyz(np.array(points[1:3]))
    assert len(xyz)
    assert (xyz >= positions.min(axis=0) - MARGIN_M - 1e-3).all()
    assert (xyz <= positions.max(axis=0) + MARGIN_M + 1e-3).all()


def test_the_section_is_followed_while_it_is_chosen(user: SceneViewUser) -> None:
    clipping, middle = user.view.clipping, way_of(user.drive).mean(axis=0)[:2]
    square = np.array([[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]])
    assert not clipping.can_choose(ClipChoice.SECTION)
    clipping.know_section(middle + square)
    clip(user, lambda: clipping.choose(ClipChoice.SECTION))
    first = drawn_xyz(user)
    assert len(first)
    assert (np.abs(first[:, :2] - middle) <= [1.001, 0.501]).all()
    clip(user, lambda: clipping.know_section(middle + square + [0.0, 2.0]))
    assert (drawn_xyz(user)[:, 1] >= middle[1] + 1.499).all()
    clip(user, lambda: clipping.know_section(None))
    assert clipping.choice is ClipChoice.EVERYTHING


class _Lasso(MouseTool):
    """Keeps what was drawn round."""

    def __init__(self) -> None:
        super().__init__()
        self.boxed: EnclosedHits | None = None

    def drag_shape(self, hit: Hit) -> DragShape:
        return DragShape.BOX

    def choose_box(self, boxed: EnclosedHits) -> None:
        self.boxed = boxed


def box_all(user: SceneViewUser) -> EnclosedHits:
    tool = _Lasso()
    user.take(tool)
    size = user.view.size()
    user.drag(QPoint(2, 2), QPoint(size.width() - 3, size.height() - 3))
    assert tool.boxed is not None
    return tool.boxed


def test_a_box_knows_all_points_inside_and_not_only_those_drawn(user: SceneViewUser) -> None:
    user.look_at(position_on(user.drive, user.road_points(3)[1]), 12.0)
    boxed = box_all(user)
    every = boxed.every()
    projection = user.view._hits.projection
    outline = QRectF(2, 2, user.view.width() - 5, user.view.height() - 5)
    for drive in user.map.drives():
        pixels, depth = projection.to_screen(drive.xyz(slice(None)) - user.map.origin())
        inside = np.array([outline.contains(QPointF(x, y)) for x, y in pixels.tolist()])
        assert every[drive.id].tolist() == np.flatnonzero(inside & (depth > 0.05)).tolist()
        assert set(boxed.points[drive.id].tolist()) <= set(every[drive.id].tolist())


def test_a_box_leaves_out_what_is_clipped_off(user: SceneViewUser) -> None:
    user.view.clipping.set_slab(CorridorExtent(2.0, 2.0, -0.5, 0.5))
    clip(user, lambda: user.view.clipping.choose(ClipChoice.DRIVE))
    boxed = box_all(user)
    clip_now = user.view.clipping.clip
    assert clip_now is not None
    for points in (boxed.points, boxed.every()):
        assert points
        for id_, of_drive in points.items():
            xyz = user.map.drive(id_).xyz(of_drive)
            grown = Corridor(user.drive, CorridorExtent(2.001, 2.001, -0.501, 0.501))
            assert grown.holds(xyz).all()


def test_a_lasso_of_two_corners_holds_nothing(user: SceneViewUser) -> None:
    boxed = user.view._hits.enclosed(QPolygonF([QPointF(1, 1), QPointF(99, 99)]), NO_KEYS)
    assert boxed.every() == {}


def test_another_project_is_shown_whole(user: SceneViewUser) -> None:
    clip(user, lambda: user.view.clipping.choose(ClipChoice.DRIVE))
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.clipping.choice is ClipChoice.EVERYTHING
    assert user.view.clipping.clip is None


def test_the_menu_offers_what_can_be_shown(user: SceneViewUser) -> None:
    requests: list[MenuRequest] = []
    user.view.menu_requested.connect(requests.append)
    user.click(QPoint(300, 300), button=RIGHT)
    menu = requests[0].menu
    (part,) = (one for one in menu.findChildren(QMenu) if one.title() == "Show only")
    choices = {action.text(): action for action in part.actions() if action.text()}
    assert {text for text, action in choices.items() if action.isEnabled()} == {
        "All points",
        "Around the drive",
    }
    choices["Around the drive"].trigger()
    assert user.view.clipping.choice is ClipChoice.DRIVE
    form = part.findChild(SlabForm)
    assert isinstance(form, SlabForm)
    left = form.findChildren(QDoubleSpinBox)[0]
    left.setValue(4.0)
    assert user.view.clipping.slab == CorridorExtent(left_m=4.0)
    menu.deleteLater()


def test_from_above_there_is_no_perspective_and_clicks_stay_exact(user: SceneViewUser) -> None:
    road = user.road_points(4)
    user.map.shared.cursor.move_to(position_on(user.drive, road[1]))
    user.view.look_from_above()
    user.view.zoom_by(6.0)
    user.sharpen()
    assert user.view.camera.is_parallel
    for point in road[1:3]:
        user.view.center_on(position_on(user.drive, point))
        user.sharpen()
        spot = user.spot(position_on(user.drive, point))
        user.click(spot)
        position = user.map.shared.cursor.position
        assert position is not None
        shown = user.view.position_of(position)
        assert shown is not None
        away = shown - QPointF(spot)
        assert abs(away.x()) <= 2
        assert abs(away.y()) <= 2


def test_perspective_comes_and_goes_without_a_jump(user: SceneViewUser) -> None:
    position = position_on(user.drive, user.road_points(3)[1])
    user.look_at(position, 12.0)
    before = user.spot(position)
    user.view.set_perspective(is_on=False)
    assert user.spot(position) == before
    user.key(Qt.Key.Key_Plus)
    assert user.view.camera.distance_m == pytest.approx(12.0 / 1.25)
    user.view.set_perspective(is_on=True)
    assert user.spot(position) == before


def test_a_box_of_space_is_known_by_its_planes() -> None:
    part = Clip.box(np.array([0.0, 0.0, 0.0]), np.array([2.0, 3.0, 4.0]))
    inside = part.holds(np.array([[1.0, 1.0, 1.0], [-0.1, 1, 1], [1, 3.1, 1], [1, 1, 4.1]]))
    assert inside.tolist() == [True, False, False, False]
