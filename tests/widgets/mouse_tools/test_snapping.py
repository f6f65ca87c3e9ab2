"""Snapping: where a hit lands, whichever view sent it, and what is shown before the click."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt

from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex, new_feature_id
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.widgets.builders import OpenMap, path_tool, position_on
from widgets.mouse_tools.mouse_tool import Hit, Ray
from widgets.mouse_tools.snapping import SnappingTool
from widgets.shared.cursor import PickedPosition
from widgets.shared.snap_state import SnapMode, WorkingPlane

REACH_M = 0.3


class SnappingSession:
    """A map with a line tool in a snapping hand."""

    def __init__(self, *drives: Drive) -> None:
        self.map = OpenMap(drives)
        self.tool = path_tool(self.map, Geometry.LINE)
        self.hand = SnappingTool(self.map, self.map.shared, self.tool)
        self.snap = self.map.shared.snap

    def line(self, *positions: tuple[float, float, float]) -> Feature:
        vertices = tuple(
            Vertex(position, PointReference("left", number))
            for number, position in enumerate(positions)
        )
        line = Feature(new_feature_id(), "curb", Geometry.LINE, vertices)
        self.map.apply(Text.same("test"), Change(added=(line,)))
        return line

    def at(self, *xyz: float, modifiers=Qt.KeyboardModifier.NoModifier) -> Hit:
        east, north, up = xyz
        hit = Hit(PickedPosition((east, north, up)), reach_m=REACH_M, modifiers=modifiers)
        return self.hand.snapped(hit)


def _xyz(hit: Hit) -> tuple[float, float, float]:
    assert hit.position is not None
    return hit.position.xyz


def test_a_vertex_is_taken_with_the_measured_point_it_rests_on() -> None:
    desk = SnappingSession()
    line = desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    hit = desk.at(9.9, 0.1, 5.05)
    assert hit.position is not None
    assert hit.position.xyz == (10.0, 0.0, 5.0)
    assert hit.position.measured == line.vertices[1].measured
    assert desk.snap.mark is not None
    assert desk.snap.mark.mode is SnapMode.VERTEX


def test_a_crossing_goes_before_the_lines_that_cross() -> None:
    desk = SnappingSession()
    desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    desk.line((4.0, -3.0, 5.0), (4.0, 3.0, 5.0))
    assert _xyz(desk.at(4.1, 0.15, 5.0)) == pytest.approx((4.0, 0.0, 5.0))
    assert desk.snap.mark is not None
    assert desk.snap.mark.mode is SnapMode.CROSSING


def test_beside_a_line_the_nearest_place_on_it() -> None:
    desk = SnappingSession()
    desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 6.0))
    assert _xyz(desk.at(3.0, 0.2, 5.3)) == pytest.approx((3.0, 0.0, 5.3))


@pytest.mark.parametrize("mode", [SnapMode.VERTEX, SnapMode.LINE])
def test_a_mode_that_is_off_draws_nothing(mode: SnapMode) -> None:
    desk = SnappingSession()
    desk.snap.choose_modes(frozenset({mode}))
    desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    desk.snap.turn(mode, is_on=False)
    assert _xyz(desk.at(9.9, 0.1, 5.0)) == (9.9, 0.1, 5.0)
    assert desk.snap.mark is None


def test_ctrl_is_the_point_itself() -> None:
    desk = SnappingSession()
    desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    control = Qt.KeyboardModifier.ControlModifier
    assert _xyz(desk.at(9.9, 0.1, 5.0, modifiers=control)) == (9.9, 0.1, 5.0)


def test_a_line_on_another_level_is_not_meant() -> None:
    desk = SnappingSession()
    desk.line((0.0, 0.0, 12.0), (10.0, 0.0, 12.0))
    assert _xyz(desk.at(9.9, 0.1, 5.0)) == (9.9, 0.1, 5.0)


def test_a_feature_that_is_gone_draws_nothing_any_more() -> None:
    desk = SnappingSession()
    line = desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    assert _xyz(desk.at(9.9, 0.1, 5.0)) == (10.0, 0.0, 5.0)
    desk.map.apply(Text.same("test"), Change(removed=(line,)))
    assert _xyz(desk.at(9.9, 0.1, 5.0)) == (9.9, 0.1, 5.0)


def test_a_pointer_snaps_to_nothing() -> None:
    desk = SnappingSession()
    desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    tool = path_tool(desk.map, Geometry.LINE)
    tool._kind = None  # as before a kind was chosen
    desk.hand.tool = tool
    assert _xyz(desk.at(9.9, 0.1, 5.0)) == (9.9, 0.1, 5.0)


def test_a_curb_is_met_from_beside_it(left_drive: Drive) -> None:
    desk = SnappingSession(left_drive)
    desk.snap.choose_modes(frozenset({SnapMode.EDGE}))
    image = image_of(left_drive, ImageKind.TRAJECTORY_REVERSIBLE)
    xyz = left_drive.xyz(slice(0, left_drive.count))
    found = 0
    for point in np.random.default_rng(5).integers(0, left_drive.count, 400):
        hit = Hit(position_on(left_drive, int(point)), reach_m=REACH_M)
        snapped = desk.hand.snapped(hit)
        if desk.snap.mark is None:
            continue
        found += 1
        assert snapped.position is not None
        assert snapped.position.measured is not None
        near = snapped.position.measured.point
        assert np.linalg.norm(xyz[near] - snapped.position.xyz) <= 0.2
        rows, columns = image.pixel_of(np.array([point, near]))
        assert abs(int(columns[1]) - int(columns[0])) <= 24
        assert abs(int(rows[1]) - int(rows[0])) <= 10
    assert found


def test_lowest_and_highest_points_of_the_circle(left_drive: Drive) -> None:
    desk = SnappingSession(left_drive)
    xyz = left_drive.xyz(slice(0, left_drive.count))
    point = left_drive.count // 2
    near = np.hypot(*(xyz - xyz[point])[:, :2].T) <= REACH_M
    for mode, limit in (
        (SnapMode.LOWEST, xyz[near, 2].min()),
        (SnapMode.HIGHEST, xyz[near, 2].max()),
    ):
        desk.snap.choose_modes(frozenset({mode}))
        snapped = desk.hand.snapped(Hit(position_on(left_drive, point), reach_m=REACH_M))
        assert _xyz(snapped)[2] == pytest.approx(limit, abs=0.02)


def test_on_a_working_plane_the_line_of_sight_counts_and_the_vertex_is_marked() -> None:
    desk = SnappingSession()
    desk.snap.work_on(WorkingPlane((0.0, 0.0, 2.0)))
    ray = Ray((0.0, 0.0, 4.0), (1.0, 0.0, -1.0))
    snapped = desk.hand.snapped(Hit(PickedPosition((1.0, 0.0, 3.0)), ray=ray))
    assert _xyz(snapped) == pytest.approx((2.0, 0.0, 2.0))
    desk.hand.press(Hit(None, ray=ray))
    drawing = desk.map.shared.sketch.drawing
    assert drawing is not None
    assert drawing.vertices[0].is_occluded


def test_away_from_the_plane_there_is_no_place() -> None:
    desk = SnappingSession()
    desk.snap.work_on(WorkingPlane((0.0, 0.0, 2.0)))
    up = Ray((0.0, 0.0, 4.0), (1.0, 0.0, 1.0))
    assert desk.hand.snapped(Hit(None, ray=up)).position is None


def test_an_occluded_vertex_that_is_taken_stays_marked() -> None:
    desk = SnappingSession()
    line = desk.line((0.0, 0.0, 5.0), (10.0, 0.0, 5.0))
    hollow = replace(line.vertices[1], measured=None, is_occluded=True)
    changed = line.with_vertices((line.vertices[0], hollow))
    desk.map.stored[line.id] = changed
    hit = desk.at(9.9, 0.1, 5.0)
    assert hit.as_vertex() == hollow
