"""What is clipped off is neither drawn nor hit; the rest stays as it was."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF
from PySide6.QtWidgets import QDoubleSpinBox, QMenu

from processing.image.attributes import colours
from processing.image.clip import Clip
from processing.image.corridor import Corridor, Slab
from processing.points.drive import Drive
from processing.project.catalogue import Geometry
from tests.mouse_events import NO_KEYS
from tests.widgets.builders import place_on
from tests.widgets.scene_view.conftest import RIGHT, Hand
from widgets.mouse_tools.menu_wish import MenuWish
from widgets.mouse_tools.mouse_tool import Boxed, DragShape, Hit, MouseTool
from widgets.scene_view.clipping import MARGIN_M, ClipChoice
from widgets.scene_view.slab_form import SlabForm

Floats = NDArray[np.float64]


def drawn_xyz(hand: Hand) -> Floats:
    """Places of all points that are drawn, m, project CRS."""
    cloud = hand.view.cloud
    assert cloud is not None
    places = [one.tile.local_xyz for one in cloud.drawn]
    return np.concatenate([np.empty((0, 3)), *places]) + hand.map.origin()


def clip(hand: Hand, choose: Callable[[], None]) -> None:
    choose()
    hand.sharpen()


def way_of(drive: Drive) -> Floats:
    assert drive.trajectory is not None
    xyz = drive.xyz(slice(None))
    way = drive.trajectory.xyz
    inside = (way[:, :2] >= xyz[:, :2].min(axis=0)) & (way[:, :2] <= xyz[:, :2].max(axis=0))
    return way[inside.all(axis=1)]


def test_only_what_is_near_the_drive_is_drawn(hand: Hand) -> None:
    before = len(drawn_xyz(hand))
    clip(hand, lambda: hand.view.clipping.set_slab(Slab(2.0, 3.0, -0.5, 1.5)))
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.DRIVE))
    xyz = drawn_xyz(hand)
    assert 0 < len(xyz) < before
    corridor = Corridor(hand.drive, Slab(2.05, 3.05, -0.55, 1.55))
    assert corridor.holds(xyz).all()


def test_a_wider_slab_brings_points_back(hand: Hand) -> None:
    view = hand.view
    view.clipping.set_slab(Slab(1.0, 1.0))
    clip(hand, lambda: view.clipping.choose(ClipChoice.DRIVE))
    narrow = len(drawn_xyz(hand))
    clip(hand, lambda: view.clipping.set_slab(Slab(4.0, 4.0)))
    assert len(drawn_xyz(hand)) > narrow


def test_all_points_are_back_when_nothing_is_clipped(hand: Hand) -> None:
    before = np.sort(drawn_xyz(hand), axis=0)
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.DRIVE))
    clip(hand, hand.view.clipping.show_everything)
    assert np.sort(drawn_xyz(hand), axis=0) == pytest.approx(before)


def test_colours_stay_with_their_points(hand: Hand) -> None:
    hand.view.clipping.set_slab(Slab(2.0, 2.0))
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.DRIVE))
    hand.map.shared.view_settings.change_look(attribute="height")
    hand.sharpen()
    cloud = hand.view.cloud
    assert cloud is not None
    for one in cloud.drawn:
        tile = one.tile
        drive = hand.map.drive(tile.id.drive_id)
        if tile.points.size:
            wanted = colours(drive, tile.points, "height", 2.0, 98.0)
            assert tile.colours.tolist() == wanted.tolist()


def test_a_click_hits_no_point_that_is_clipped_off(hand: Hand) -> None:
    near, far = hand.road_points(4)[0], hand.road_points(4)[3]
    hand.map.shared.cursor.move_to(place_on(hand.drive, near))
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.SELECTION))
    hand.look_at(place_on(hand.drive, far))
    hand.click(hand.spot(place_on(hand.drive, far)))
    assert hand.map.shared.cursor.place == place_on(hand.drive, near)
    clip(hand, hand.view.clipping.show_everything)
    hand.click(hand.spot(place_on(hand.drive, far)))
    assert hand.map.shared.cursor.place == place_on(hand.drive, far)


def test_around_what_is_chosen_is_so_much_more(hand: Hand) -> None:
    points = hand.road_points(4)
    feature = hand.map.add(Geometry.LINE, hand.drive, points[1], points[2])
    hand.map.shared.selection.choose_features(frozenset({feature.id}))
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.SELECTION))
    xyz, places = drawn_xyz(hand), hand.drive.xyz(np.array(points[1:3]))
    assert len(xyz)
    assert (xyz >= places.min(axis=0) - MARGIN_M - 1e-3).all()
    assert (xyz <= places.max(axis=0) + MARGIN_M + 1e-3).all()


def test_the_section_is_followed_while_it_is_chosen(hand: Hand) -> None:
    clipping, middle = hand.view.clipping, way_of(hand.drive).mean(axis=0)[:2]
    square = np.array([[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]])
    assert not clipping.can_choose(ClipChoice.SECTION)
    clipping.know_section(middle + square)
    clip(hand, lambda: clipping.choose(ClipChoice.SECTION))
    first = drawn_xyz(hand)
    assert len(first)
    assert (np.abs(first[:, :2] - middle) <= [1.001, 0.501]).all()
    clip(hand, lambda: clipping.know_section(middle + square + [0.0, 2.0]))
    assert (drawn_xyz(hand)[:, 1] >= middle[1] + 1.499).all()
    clip(hand, lambda: clipping.know_section(None))
    assert clipping.choice is ClipChoice.EVERYTHING


class _Lasso(MouseTool):
    """Keeps what was drawn round."""

    def __init__(self) -> None:
        super().__init__()
        self.boxed: Boxed | None = None

    def drag_shape(self, hit: Hit) -> DragShape:
        return DragShape.BOX

    def choose_box(self, boxed: Boxed) -> None:
        self.boxed = boxed


def box_all(hand: Hand) -> Boxed:
    tool = _Lasso()
    hand.take(tool)
    size = hand.view.size()
    hand.drag(QPoint(2, 2), QPoint(size.width() - 3, size.height() - 3))
    assert tool.boxed is not None
    return tool.boxed


def test_a_box_knows_all_points_inside_and_not_only_those_drawn(hand: Hand) -> None:
    hand.look_at(place_on(hand.drive, hand.road_points(3)[1]), 12.0)
    boxed = box_all(hand)
    every = boxed.every()
    projection = hand.view._hits.projection
    outline = QRectF(2, 2, hand.view.width() - 5, hand.view.height() - 5)
    for drive in hand.map.drives():
        pixels, depth = projection.to_screen(drive.xyz(slice(None)) - hand.map.origin())
        inside = np.array([outline.contains(QPointF(x, y)) for x, y in pixels.tolist()])
        assert every[drive.id].tolist() == np.flatnonzero(inside & (depth > 0.05)).tolist()
        assert set(boxed.points[drive.id].tolist()) <= set(every[drive.id].tolist())


def test_a_box_leaves_out_what_is_clipped_off(hand: Hand) -> None:
    hand.view.clipping.set_slab(Slab(2.0, 2.0, -0.5, 0.5))
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.DRIVE))
    boxed = box_all(hand)
    clip_now = hand.view.clipping.clip
    assert clip_now is not None
    for points in (boxed.points, boxed.every()):
        assert points
        for id_, of_drive in points.items():
            xyz = hand.map.drive(id_).xyz(of_drive)
            grown = Corridor(hand.drive, Slab(2.001, 2.001, -0.501, 0.501))
            assert grown.holds(xyz).all()


def test_a_lasso_of_two_corners_holds_nothing(hand: Hand) -> None:
    boxed = hand.view._hits.enclosed(QPolygonF([QPointF(1, 1), QPointF(99, 99)]), NO_KEYS)
    assert boxed.every() == {}


def test_another_project_is_shown_whole(hand: Hand) -> None:
    clip(hand, lambda: hand.view.clipping.choose(ClipChoice.DRIVE))
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.clipping.choice is ClipChoice.EVERYTHING
    assert hand.view.clipping.clip is None


def test_the_menu_offers_what_can_be_shown(hand: Hand) -> None:
    wishes: list[MenuWish] = []
    hand.view.menu_requested.connect(wishes.append)
    hand.click(QPoint(300, 300), button=RIGHT)
    menu = wishes[0].menu
    (part,) = (one for one in menu.findChildren(QMenu) if one.title() == "Show only")
    choices = {action.text(): action for action in part.actions() if action.text()}
    assert {text for text, action in choices.items() if action.isEnabled()} == {
        "All points",
        "Around the drive",
    }
    choices["Around the drive"].trigger()
    assert hand.view.clipping.choice is ClipChoice.DRIVE
    form = part.findChild(SlabForm)
    assert isinstance(form, SlabForm)
    left = form.findChildren(QDoubleSpinBox)[0]
    left.setValue(4.0)
    assert hand.view.clipping.slab == Slab(left_m=4.0)
    menu.deleteLater()


def test_from_above_there_is_no_perspective_and_clicks_stay_exact(hand: Hand) -> None:
    road = hand.road_points(4)
    hand.map.shared.cursor.move_to(place_on(hand.drive, road[1]))
    hand.view.look_from_above()
    hand.view.zoom_by(6.0)
    hand.sharpen()
    assert hand.view.camera.is_parallel
    for point in road[1:3]:
        hand.view.center_on(place_on(hand.drive, point))
        hand.sharpen()
        spot = hand.spot(place_on(hand.drive, point))
        hand.click(spot)
        place = hand.map.shared.cursor.place
        assert place is not None
        shown = hand.view.position_of(place)
        assert shown is not None
        away = shown - QPointF(spot)
        assert abs(away.x()) <= 2
        assert abs(away.y()) <= 2


def test_perspective_comes_and_goes_without_a_jump(hand: Hand) -> None:
    place = place_on(hand.drive, hand.road_points(3)[1])
    hand.look_at(place, 12.0)
    before = hand.spot(place)
    hand.view.set_perspective(is_on=False)
    assert hand.spot(place) == before
    hand.key(Qt.Key.Key_Plus)
    assert hand.view.camera.distance_m == pytest.approx(12.0 / 1.25)
    hand.view.set_perspective(is_on=True)
    assert hand.spot(place) == before


def test_a_box_of_space_is_known_by_its_planes() -> None:
    part = Clip.box(np.array([0.0, 0.0, 0.0]), np.array([2.0, 3.0, 4.0]))
    inside = part.holds(np.array([[1.0, 1.0, 1.0], [-0.1, 1, 1], [1, 3.1, 1], [1, 1, 4.1]]))
    assert inside.tolist() == [True, False, False, False]
