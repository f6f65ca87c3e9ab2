"""The section view by mouse and keys: places are known, answers are points."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QPolygonF
from PySide6.QtWidgets import QApplication, QMenu
from pytestqt.qtbot import QtBot

from processing.map.catalogue import Geometry
from processing.map.feature import Vertex
from processing.map.own_points import own_points
from processing.section.cut import Cut
from tests.builders import START
from tests.mouse_events import NO_KEYS, move_mouse
from tests.street_scene import CURB_AT_M, CURB_HEIGHT_M
from tests.widgets.builders import OpenMap, position_on
from tests.widgets.section_view.conftest import (
    SectionViewUser,
    curb_line,
    on_road,
    shown,
    station,
)
from tests.widgets.view_user import LEFT
from widgets.mouse_tools.editing.edit_vertices import EditVertices
from widgets.mouse_tools.snapping import SnappingTool
from widgets.section_view.picture.marks import mark_under
from widgets.shared.cursor import PickedPosition

SHIFT = Qt.KeyboardModifier.ShiftModifier


def cut_of(user: SectionViewUser) -> Cut:
    assert user.view.cut is not None
    return user.view.cut


def test_own_points_of_a_chosen_feature_are_dotted(user: SectionViewUser) -> None:
    picture = user.pane.picture
    assert picture is not None
    drive = user.map.all_drives[0]
    foot, *_, of_it = picture.points[picture.drive_numbers == 0].tolist()
    tree = user.map.add(Geometry.POINT, drive, foot, own_points=(own_points(drive.id, [of_it]),))
    spot = user.spot(position_on(drive, of_it))
    user.map.shared.selection.choose_features(frozenset({tree.id}))
    dot = QColor(user.pane.grab().toImage().pixel(spot))
    assert dot.getRgb()[:3] == pytest.approx(QColor("#009e73").getRgb()[:3], abs=40)


# Where it stands.


def test_it_begins_at_the_drive_without_being_asked(qtbot: QtBot, open_map: OpenMap) -> None:
    user = shown(qtbot, open_map)
    assert user.pane.picture is not None
    assert user.pane.picture.points.size
    user.view.close()


def test_the_slab_goes_through_the_cursor(user: SectionViewUser) -> None:
    position = PickedPosition(tuple((START + np.array([2.0, 6.3, 0.0])).tolist()))
    user.do(lambda: user.map.shared.cursor.move_to(position))
    ((offset, _, away),) = cut_of(user).to_section([position.xyz])
    assert away == pytest.approx(0.0, abs=1e-3)
    assert offset == pytest.approx(2.5, abs=0.05)  # the lane lies half a metre to the left


def test_left_of_the_drive_is_left_in_the_picture(user: SectionViewUser) -> None:
    west, east = (
        PickedPosition(tuple((np.array(on_road(user, 5.0).xyz) + np.array([east, 0, -2])).tolist()))
        for east in (-3.0, 3.0)
    )
    left, right = user.pane.position_of(west), user.pane.position_of(east)
    assert left is not None
    assert right is not None
    assert left.x() < right.x()
    user.view.use_settings(replace(user.view.settings, is_along=True))
    user.qtbot.waitSignal(user.view.sharpened).wait()
    back, ahead = (
        user.pane.position_of(PickedPosition(on_road(user, at).xyz)) for at in (4.0, 6.0)
    )
    assert back is not None
    assert ahead is not None
    assert back.x() < ahead.x()


def test_both_heads_show_the_curb_as_high_as_it_is(user: SectionViewUser) -> None:
    picture = user.pane.picture
    assert picture is not None
    assert set(picture.drive_numbers.tolist()) == {0, 1}
    offset, height, _ = picture.section.T
    walk = np.median(height[np.abs(offset + CURB_AT_M + 0.1) < 0.2])
    road = np.median(height[np.abs(offset + CURB_AT_M - 0.9) < 0.2])
    assert walk - road == pytest.approx(CURB_HEIGHT_M - 0.012, abs=0.015)


def test_beyond_the_end_of_the_trajectory_it_goes_straight_on(user: SectionViewUser) -> None:
    assert user.view.standing is not None
    length_m = user.view.standing.line.stations.length_m
    user.do(lambda: user.view.show_position(on_road(user, length_m + 4.0)))
    assert user.view.standing.beyond_m == pytest.approx(4.0, abs=0.01)
    for _ in range(4):
        user.key(Qt.Key.Key_W, SHIFT)
    assert user.view.standing.beyond_m == pytest.approx(30.0)
    user.do(lambda: user.key(Qt.Key.Key_Q, SHIFT))
    assert user.view.standing.beyond_m == pytest.approx(20.0)


# Steps.


def test_q_and_w_step_exactly_and_every_view_follows(user: SectionViewUser) -> None:
    before = station(user)
    user.do(lambda: user.key(Qt.Key.Key_W))
    assert station(user) == before + 1.0
    position = user.map.shared.cursor.position
    assert position is not None
    assert position.measured is not None, "on the ground below the vehicle"
    ((offset, height, away),) = cut_of(user).to_section([position.xyz])
    assert abs(offset) < 0.5
    assert abs(away) <= 0.5
    assert cut_of(user).middle[2] - height == pytest.approx(2.01, abs=0.05)
    user.do(lambda: user.key(Qt.Key.Key_Q))
    assert station(user) == before


def test_shift_steps_ten_times_as_far_and_the_step_can_be_set(user: SectionViewUser) -> None:
    before = station(user)
    user.view.use_settings(replace(user.view.settings, step_m=0.25))
    user.do(lambda: user.key(Qt.Key.Key_W, SHIFT))
    assert station(user) == before + 2.5
    user.do(lambda: user.view.step(-1))
    assert station(user) == before + 2.25


# The hand.


def test_a_click_gives_the_exact_point(user: SectionViewUser) -> None:
    user.look_closely()
    position, before = user.lone_point(), cut_of(user)
    user.qtbot.mouseClick(user.pane, LEFT, NO_KEYS, user.spot(position))
    assert user.map.shared.cursor.position == position
    assert cut_of(user) == before, "a click in the section doesn't move it"


@pytest.mark.parametrize("exaggeration", [1.0, 5.0])
def test_of_points_at_one_spot_the_one_nearest_to_the_plane_is_meant(
    user: SectionViewUser, exaggeration: float
) -> None:
    user.view.use_settings(replace(user.view.settings, exaggeration=exaggeration))
    picture, projection = user.pane.picture, user.pane.projection()
    assert picture is not None
    assert projection is not None
    section = picture.section
    reach = 0.3
    at = (
        1.0,
        projection.cut.middle[2] - float(np.median(section[np.abs(section[:, 0] - 1) < 0.2, 1])),
    )
    found = user.pane.position_at(at, reach, exact=True)
    assert found is not None
    away = np.hypot(
        section[:, 0] - at[0], (section[:, 1] - projection.height_of(at[1])) * exaggeration
    )
    (here,) = cut_of(user).to_section([found.xyz])
    of_found = np.hypot(here[0] - at[0], (here[1] - projection.height_of(at[1])) * exaggeration)
    assert of_found <= away.min() + reach / 24
    rivals = section[away <= of_found - reach / 24]
    assert not len(rivals)
    assert abs(here[2]) <= np.abs(section[away <= away.min(), 2]).min() + 1e-9


def test_a_dragged_vertex_becomes_the_point_under_the_mouse(user: SectionViewUser) -> None:
    user.look_closely()
    start = user.lone_point()
    vertex = Vertex(start.xyz, start.measured)
    far = Vertex(tuple((np.array(start.xyz) + np.array([0.0, 8.0, 0.0])).tolist()))
    feature = user.line(vertex, far)
    user.take(SnappingTool(user.map, user.map.shared, listened(user)))
    user.map.shared.snap.choose_modes(frozenset())
    target = user.lone_point(avoid=user.spot(start))
    user.drag(user.spot(start), user.spot(target))
    moved = user.map.stored[feature.id]
    assert moved.vertices == (Vertex(target.xyz, target.measured), far)


def test_where_nothing_was_measured_a_vertex_keeps_what_the_section_does_not_show(
    user: SectionViewUser,
) -> None:
    user.look_closely()
    start = user.lone_point()
    far = Vertex(tuple((np.array(start.xyz) + np.array([0.0, 8.0, 0.0])).tolist()))
    feature = user.line(Vertex(start.xyz, start.measured), far)
    user.take(listened(user))
    sky = QPoint(600, 70)
    user.drag(user.spot(start), sky)
    moved = user.map.stored[feature.id].vertices[0]
    cut, projection = cut_of(user), user.pane.projection()
    assert projection is not None
    ((offset, height, away),) = cut.to_section([moved.xyz])
    x, y = user.pane.viewport.to_plane(sky.x(), sky.y())
    assert (offset, height) == pytest.approx((x, projection.height_of(y)))
    assert away == pytest.approx(cut.to_section([start.xyz])[0, 2])
    assert moved.is_occluded
    assert moved.measured is None


def listened(user: SectionViewUser) -> EditVertices:
    tool = EditVertices(user.map, user.map.shared)
    user.map.listen_to(tool)
    return tool


def test_a_line_that_crosses_has_a_mark_with_its_name(user: SectionViewUser) -> None:
    line = curb_line(user)
    crossing = PickedPosition(
        (line.vertices[0].xyz[0], cut_of(user).middle[1], line.vertices[0].xyz[2])
    )
    spot = user.spot(crossing)
    move_mouse(user.pane, spot)
    assert user.pane.marks is not None
    found = mark_under(user.pane.marks, user.pane.viewport, spot.toPointF())
    assert found is not None
    assert (found.feature, found.kind) == (line.id, "curb")
    user.map.shared.view_settings.hide_kinds(frozenset({line.kind}))
    assert user.pane.marks is not None
    assert not len(user.pane.marks.crossings)


def test_a_lasso_holds_points_of_both_heads(user: SectionViewUser) -> None:
    inside = user.pane.points_inside(QPolygonF(user.pane.rect().toRectF()))
    assert set(inside) == {drive.id for drive in user.map.all_drives}


# Live and pinned.


def test_the_slab_follows_a_line_under_the_mouse_in_any_view(user: SectionViewUser) -> None:
    line = curb_line(user)
    over = tuple((START + np.array([-CURB_AT_M + 0.2, 6.5, 0.0])).tolist())
    user.do(lambda: user.map.shared.cursor.hover_over(PickedPosition(over)))
    standing = user.view.standing
    assert standing is not None
    assert standing.line.feature == line.id
    assert standing.station_m == pytest.approx(5.5)
    assert cut_of(user).middle[1] == pytest.approx(START[1] + 6.5)


def test_the_mouse_over_no_line_or_in_the_section_itself_moves_nothing(
    user: SectionViewUser,
) -> None:
    curb_line(user)
    before = user.view.standing
    far = tuple((START + np.array([3.0, 6.5, 0.0])).tolist())
    on_line = tuple((START + np.array([-CURB_AT_M, 6.5, 0.0])).tolist())
    with user.qtbot.assertNotEmitted(user.view.cut_changed, wait=100):
        user.map.shared.cursor.hover_over(PickedPosition(far))
    move_mouse(user.pane, QPoint(400, 300))
    with user.qtbot.assertNotEmitted(user.view.cut_changed, wait=100):
        user.map.shared.cursor.hover_over(PickedPosition(on_line))
    user.view.use_settings(replace(user.view.settings, is_live=False))
    assert user.view.standing == before


def test_a_place_is_held_as_two_windows_and_released(user: SectionViewUser) -> None:
    before = cut_of(user)
    with user.qtbot.waitSignal(user.view.pinned_changed, timeout=30_000):
        user.view.set_pinned(True)
    across, along = user.view.panes
    assert [pane.isVisible() for pane in (across, along)] == [True, True]
    assert across.standing is not None
    assert along.standing is not None
    assert (across.standing.is_along, along.standing.is_along) == (False, True)
    assert across.standing.cut.middle == along.standing.cut.middle == before.middle
    user.map.shared.cursor.move_to(on_road(user, 8.0))
    assert cut_of(user) == before, "held against the cursor"
    user.key(Qt.Key.Key_W)
    assert cut_of(user) != before, "but a step is meant"
    user.view.set_pinned(False)
    assert len(user.view.panes) == 1
    assert not along.isVisible()


# What changes.


def test_other_drives_are_cut_once_they_are_open(user: SectionViewUser) -> None:
    user.view.set_pinned(True)
    user.map.all_drives = ()
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.cut is None
    assert user.pane.picture is None
    assert not user.view.is_pinned


def test_what_is_hidden_is_looked_for_when_it_is_shown(user: SectionViewUser) -> None:
    user.view.hide()
    with user.qtbot.assertNotEmitted(user.view.sharpened, wait=100):
        user.map.shared.cursor.move_to(on_road(user, 8.0))
    user.do(user.view.show)
    assert user.pane.cut == user.view.cut


def test_the_width_is_that_of_the_slab(user: SectionViewUser) -> None:
    user.do(lambda: user.view.use_settings(replace(user.view.settings, width_m=0.4)))
    assert cut_of(user).width_m == pytest.approx(0.4)
    picture = user.pane.picture
    assert picture is not None
    assert np.abs(picture.section[:, 2]).max() <= 0.2


def test_the_ground_stays_where_it_is_when_heights_grow(user: SectionViewUser) -> None:
    ground = PickedPosition((*cut_of(user).middle[:2], cut_of(user).middle[2] - 2.0))
    before = user.pane.position_of(ground)
    user.view.use_settings(replace(user.view.settings, exaggeration=10.0))
    after = user.pane.position_of(ground)
    assert before is not None
    assert after is not None
    assert after.y() == pytest.approx(before.y(), abs=60)
    assert user.pane.viewport.exaggeration == pytest.approx(10.0)


def test_the_menu_offers_heights_and_colours(user: SectionViewUser) -> None:
    chosen: list[object] = []
    user.view.settings_changed.connect(chosen.append)
    menu = user.pane.view_menu()
    (heights,) = (one for one in menu.actions() if one.menu() is not None)
    submenu = heights.menu()
    assert isinstance(submenu, QMenu)
    next(one for one in submenu.actions() if one.text() == "5×").trigger()
    assert user.pane.viewport.exaggeration == pytest.approx(5.0)
    assert chosen == [user.view.settings]
    menu = user.pane.view_menu()
    colours, *_ = (one for one in menu.actions() if one.isCheckable())
    user.do(colours.trigger)
    assert user.pane.picture is not None
    in_plane = np.abs(user.pane.picture.section[:, 2]).argmin()
    assert user.pane.picture.colours[in_plane].min() > 200


def test_it_is_told_once_where_the_slab_is(user: SectionViewUser) -> None:
    cuts: list[object] = []
    user.view.cut_changed.connect(cuts.append)
    user.do(lambda: user.view.step(1))
    user.view.use_settings(replace(user.view.settings, step_m=2.0, exaggeration=2.0))
    assert cuts == [cut_of(user)], "neither a step to come nor larger heights move it"


def test_closing_stops_its_threads(qtbot: QtBot, open_map: OpenMap) -> None:
    before = {thread.ident for thread in threading.enumerate()}
    user = shown(qtbot, open_map)
    user.view.close()
    QApplication.processEvents()
    left = [one for one in threading.enumerate() if one.ident not in before]
    assert not [one for one in left if one.name == "section"]
