"""The section view by mouse and keys: places are known, answers are points."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QPolygonF
from PySide6.QtWidgets import QApplication, QMenu
from pytestqt.qtbot import QtBot

from processing.project.feature import Vertex
from processing.section.cut import Cut
from tests.builders import START
from tests.mouse_events import NO_KEYS, move_mouse
from tests.street_scene import CURB_AT_M, CURB_HEIGHT_M
from tests.widgets.builders import OpenMap
from tests.widgets.section_view.conftest import LEFT, Hand, curb_line, on_road, shown, station
from widgets.mouse_tools.edit_vertices import EditVertices
from widgets.mouse_tools.snapping import SnappingHand
from widgets.section_view.marks import mark_under
from widgets.shared.cursor import Place

SHIFT = Qt.KeyboardModifier.ShiftModifier


def cut_of(hand: Hand) -> Cut:
    assert hand.view.cut is not None
    return hand.view.cut


# Where it stands.


def test_it_begins_at_the_drive_without_being_asked(qtbot: QtBot, open_map: OpenMap) -> None:
    hand = shown(qtbot, open_map)
    assert hand.pane.picture is not None
    assert hand.pane.picture.points.size
    hand.view.close()


def test_the_slab_goes_through_the_cursor(hand: Hand) -> None:
    place = Place(tuple((START + np.array([2.0, 6.3, 0.0])).tolist()))
    hand.do(lambda: hand.map.shared.cursor.move_to(place))
    ((offset, _, away),) = cut_of(hand).to_section([place.xyz])
    assert away == pytest.approx(0.0, abs=1e-3)
    assert offset == pytest.approx(2.5, abs=0.05)  # the lane lies half a metre to the left


def test_left_of_the_drive_is_left_in_the_picture(hand: Hand) -> None:
    west, east = (
        Place(tuple((np.array(on_road(hand, 5.0).xyz) + np.array([east, 0, -2])).tolist()))
        for east in (-3.0, 3.0)
    )
    left, right = hand.pane.position_of(west), hand.pane.position_of(east)
    assert left is not None
    assert right is not None
    assert left.x() < right.x()
    hand.view.use_settings(replace(hand.view.settings, is_along=True))
    hand.qtbot.waitSignal(hand.view.sharpened).wait()
    back, ahead = (hand.pane.position_of(Place(on_road(hand, at).xyz)) for at in (4.0, 6.0))
    assert back is not None
    assert ahead is not None
    assert back.x() < ahead.x()


def test_both_heads_show_the_curb_as_high_as_it_is(hand: Hand) -> None:
    picture = hand.pane.picture
    assert picture is not None
    assert set(picture.drive_numbers.tolist()) == {0, 1}
    offset, height, _ = picture.section.T
    walk = np.median(height[np.abs(offset + CURB_AT_M + 0.1) < 0.2])
    road = np.median(height[np.abs(offset + CURB_AT_M - 0.9) < 0.2])
    assert walk - road == pytest.approx(CURB_HEIGHT_M - 0.012, abs=0.015)


def test_beyond_the_end_of_the_trajectory_it_goes_straight_on(hand: Hand) -> None:
    assert hand.view.standing is not None
    length_m = hand.view.standing.line.stations.length_m
    hand.do(lambda: hand.view.show_place(on_road(hand, length_m + 4.0)))
    assert hand.view.standing.beyond_m == pytest.approx(4.0, abs=0.01)
    for _ in range(4):
        hand.key(Qt.Key.Key_W, SHIFT)
    assert hand.view.standing.beyond_m == pytest.approx(30.0)
    hand.do(lambda: hand.key(Qt.Key.Key_Q, SHIFT))
    assert hand.view.standing.beyond_m == pytest.approx(20.0)


# Steps.


def test_q_and_w_step_exactly_and_every_view_follows(hand: Hand) -> None:
    before = station(hand)
    hand.do(lambda: hand.key(Qt.Key.Key_W))
    assert station(hand) == before + 1.0
    place = hand.map.shared.cursor.place
    assert place is not None
    assert place.measured is not None, "on the ground below the vehicle"
    ((offset, height, away),) = cut_of(hand).to_section([place.xyz])
    assert abs(offset) < 0.5
    assert abs(away) <= 0.5
    assert cut_of(hand).middle[2] - height == pytest.approx(2.01, abs=0.05)
    hand.do(lambda: hand.key(Qt.Key.Key_Q))
    assert station(hand) == before


def test_shift_steps_ten_times_as_far_and_the_step_can_be_set(hand: Hand) -> None:
    before = station(hand)
    hand.view.use_settings(replace(hand.view.settings, step_m=0.25))
    hand.do(lambda: hand.key(Qt.Key.Key_W, SHIFT))
    assert station(hand) == before + 2.5
    hand.do(lambda: hand.view.step(-1))
    assert station(hand) == before + 2.25


# The hand.


def test_a_click_gives_the_exact_point(hand: Hand) -> None:
    hand.look_closely()
    place, before = hand.lone_point(), cut_of(hand)
    hand.qtbot.mouseClick(hand.pane, LEFT, NO_KEYS, hand.spot(place))
    assert hand.map.shared.cursor.place == place
    assert cut_of(hand) == before, "a click in the section doesn't move it"


@pytest.mark.parametrize("exaggeration", [1.0, 5.0])
def test_of_points_at_one_spot_the_one_nearest_to_the_plane_is_meant(
    hand: Hand, exaggeration: float
) -> None:
    hand.view.use_settings(replace(hand.view.settings, exaggeration=exaggeration))
    picture, lay = hand.pane.picture, hand.pane.lay()
    assert picture is not None
    assert lay is not None
    section = picture.section
    reach = 0.3
    at = 1.0, lay.cut.middle[2] - float(np.median(section[np.abs(section[:, 0] - 1) < 0.2, 1]))
    found = hand.pane.place_at(at, reach, exact=True)
    assert found is not None
    away = np.hypot(section[:, 0] - at[0], (section[:, 1] - lay.height_of(at[1])) * exaggeration)
    (here,) = cut_of(hand).to_section([found.xyz])
    of_found = np.hypot(here[0] - at[0], (here[1] - lay.height_of(at[1])) * exaggeration)
    assert of_found <= away.min() + reach / 24
    rivals = section[away <= of_found - reach / 24]
    assert not len(rivals)
    assert abs(here[2]) <= np.abs(section[away <= away.min(), 2]).min() + 1e-9


def test_a_dragged_vertex_becomes_the_point_under_the_mouse(hand: Hand) -> None:
    hand.look_closely()
    start = hand.lone_point()
    vertex = Vertex(start.xyz, start.measured)
    far = Vertex(tuple((np.array(start.xyz) + np.array([0.0, 8.0, 0.0])).tolist()))
    feature = hand.line(vertex, far)
    hand.take(SnappingHand(hand.map, hand.map.shared, listened(hand)))
    hand.map.shared.snap.choose_modes(frozenset())
    target = hand.lone_point(avoid=hand.spot(start))
    hand.drag(hand.spot(start), hand.spot(target))
    moved = hand.map.stored[feature.id]
    assert moved.vertices == (Vertex(target.xyz, target.measured), far)


def test_where_nothing_was_measured_a_vertex_keeps_what_the_section_does_not_show(
    hand: Hand,
) -> None:
    hand.look_closely()
    start = hand.lone_point()
    far = Vertex(tuple((np.array(start.xyz) + np.array([0.0, 8.0, 0.0])).tolist()))
    feature = hand.line(Vertex(start.xyz, start.measured), far)
    hand.take(listened(hand))
    sky = QPoint(600, 70)
    hand.drag(hand.spot(start), sky)
    moved = hand.map.stored[feature.id].vertices[0]
    cut, lay = cut_of(hand), hand.pane.lay()
    assert lay is not None
    ((offset, height, away),) = cut.to_section([moved.xyz])
    x, y = hand.pane.viewport.to_plane(sky.x(), sky.y())
    assert (offset, height) == pytest.approx((x, lay.height_of(y)))
    assert away == pytest.approx(cut.to_section([start.xyz])[0, 2])
    assert moved.is_occluded
    assert moved.measured is None


def listened(hand: Hand) -> EditVertices:
    tool = EditVertices(hand.map, hand.map.shared)
    hand.map.listen_to(tool)
    return tool


def test_a_line_that_crosses_has_a_mark_with_its_name(hand: Hand) -> None:
    line = curb_line(hand)
    crossing = Place((line.vertices[0].xyz[0], cut_of(hand).middle[1], line.vertices[0].xyz[2]))
    spot = hand.spot(crossing)
    move_mouse(hand.pane, spot)
    assert hand.pane.marks is not None
    found = mark_under(hand.pane.marks, hand.pane.viewport, spot.toPointF())
    assert found is not None
    assert (found.feature, found.kind) == (line.id, "curb")
    hand.map.shared.view_settings.hide_kinds(frozenset({line.kind}))
    assert hand.pane.marks is not None
    assert not len(hand.pane.marks.crossings)


def test_a_lasso_holds_points_of_both_heads(hand: Hand) -> None:
    inside = hand.pane.points_inside(QPolygonF(hand.pane.rect().toRectF()))
    assert set(inside) == {drive.id for drive in hand.map.all_drives}


# Live and pinned.


def test_the_slab_follows_a_line_under_the_mouse_in_any_view(hand: Hand) -> None:
    line = curb_line(hand)
    over = tuple((START + np.array([-CURB_AT_M + 0.2, 6.5, 0.0])).tolist())
    hand.do(lambda: hand.map.shared.cursor.hover_over(Place(over)))
    standing = hand.view.standing
    assert standing is not None
    assert standing.line.feature == line.id
    assert standing.station_m == pytest.approx(5.5)
    assert cut_of(hand).middle[1] == pytest.approx(START[1] + 6.5)


def test_the_mouse_over_no_line_or_in_the_section_itself_moves_nothing(hand: Hand) -> None:
    curb_line(hand)
    before = hand.view.standing
    far = tuple((START + np.array([3.0, 6.5, 0.0])).tolist())
    on_line = tuple((START + np.array([-CURB_AT_M, 6.5, 0.0])).tolist())
    with hand.qtbot.assertNotEmitted(hand.view.cut_changed, wait=100):
        hand.map.shared.cursor.hover_over(Place(far))
    move_mouse(hand.pane, QPoint(400, 300))
    with hand.qtbot.assertNotEmitted(hand.view.cut_changed, wait=100):
        hand.map.shared.cursor.hover_over(Place(on_line))
    hand.view.use_settings(replace(hand.view.settings, is_live=False))
    assert hand.view.standing == before


def test_a_place_is_held_as_two_windows_and_released(hand: Hand) -> None:
    before = cut_of(hand)
    with hand.qtbot.waitSignal(hand.view.pinned_changed, timeout=30_000):
        hand.view.set_pinned(True)
    across, along = hand.view.panes
    assert [pane.isVisible() for pane in (across, along)] == [True, True]
    assert across.standing is not None
    assert along.standing is not None
    assert (across.standing.is_along, along.standing.is_along) == (False, True)
    assert across.standing.cut.middle == along.standing.cut.middle == before.middle
    hand.map.shared.cursor.move_to(on_road(hand, 8.0))
    assert cut_of(hand) == before, "held against the cursor"
    hand.key(Qt.Key.Key_W)
    assert cut_of(hand) != before, "but a step is meant"
    hand.view.set_pinned(False)
    assert len(hand.view.panes) == 1
    assert not along.isVisible()


# What changes.


def test_other_drives_are_cut_once_they_are_open(hand: Hand) -> None:
    hand.view.set_pinned(True)
    hand.map.all_drives = ()
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.cut is None
    assert hand.pane.picture is None
    assert not hand.view.is_pinned


def test_what_is_hidden_is_looked_for_when_it_is_shown(hand: Hand) -> None:
    hand.view.hide()
    with hand.qtbot.assertNotEmitted(hand.view.sharpened, wait=100):
        hand.map.shared.cursor.move_to(on_road(hand, 8.0))
    hand.do(hand.view.show)
    assert hand.pane.cut == hand.view.cut


def test_the_width_is_that_of_the_slab(hand: Hand) -> None:
    hand.do(lambda: hand.view.use_settings(replace(hand.view.settings, width_m=0.4)))
    assert cut_of(hand).width_m == pytest.approx(0.4)
    picture = hand.pane.picture
    assert picture is not None
    assert np.abs(picture.section[:, 2]).max() <= 0.2


def test_the_ground_stays_where_it_is_when_heights_grow(hand: Hand) -> None:
    ground = Place((*cut_of(hand).middle[:2], cut_of(hand).middle[2] - 2.0))
    before = hand.pane.position_of(ground)
    hand.view.use_settings(replace(hand.view.settings, exaggeration=10.0))
    after = hand.pane.position_of(ground)
    assert before is not None
    assert after is not None
    assert after.y() == pytest.approx(before.y(), abs=60)
    assert hand.pane.viewport.exaggeration == pytest.approx(10.0)


def test_the_menu_offers_heights_and_colours(hand: Hand) -> None:
    chosen: list[object] = []
    hand.view.settings_changed.connect(chosen.append)
    menu = hand.pane.view_menu()
    (heights,) = (one for one in menu.actions() if one.menu() is not None)
    submenu = heights.menu()
    assert isinstance(submenu, QMenu)
    next(one for one in submenu.actions() if one.text() == "5×").trigger()
    assert hand.pane.viewport.exaggeration == pytest.approx(5.0)
    assert chosen == [hand.view.settings]
    menu = hand.pane.view_menu()
    colours, *_ = (one for one in menu.actions() if one.isCheckable())
    hand.do(colours.trigger)
    assert hand.pane.picture is not None
    in_plane = np.abs(hand.pane.picture.section[:, 2]).argmin()
    assert hand.pane.picture.colours[in_plane].min() > 200


def test_it_is_told_once_where_the_slab_is(hand: Hand) -> None:
    cuts: list[object] = []
    hand.view.cut_changed.connect(cuts.append)
    hand.do(lambda: hand.view.step(1))
    hand.view.use_settings(replace(hand.view.settings, step_m=2.0, exaggeration=2.0))
    assert cuts == [cut_of(hand)], "neither a step to come nor larger heights move it"


def test_closing_stops_its_threads(qtbot: QtBot, open_map: OpenMap) -> None:
    before = {thread.ident for thread in threading.enumerate()}
    hand = shown(qtbot, open_map)
    hand.view.close()
    QApplication.processEvents()
    left = [one for one in threading.enumerate() if one.ident not in before]
    assert not [one for one in left if one.name == "section"]
