"""Profiles drawn in a section: shapes from their anchor, empty zones, what is refused."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QSignalSpy

from processing.core.text import Text
from processing.section.cut import Cut
from tests.widgets.builders import shared_state
from widgets.mouse_tools.drawing.draw_template import (
    BEGIN,
    NEEDS_SECTION,
    NOT_IN_SECTION,
    TOO_SHORT,
    TOO_SMALL,
    DrawnProfile,
    DrawTemplate,
    TemplatePart,
)
from widgets.mouse_tools.mouse_tool import Hit, Ray
from widgets.shared.cursor import PickedPosition
from widgets.shared.shared_state import SharedState

CUT = Cut((100.0, 200.0, 50.0), (0.6, -0.8), width_m=0.5, half_length_m=5.0)


def at(across: float, up: float, away: float = 0.0) -> PickedPosition:
    """A place of the section."""
    easting, northing, height = CUT.to_space([[across, 50.0 + up, away]])[0].tolist()
    return PickedPosition((easting, northing, height))


def on_point(across: float, up: float, away: float = 0.0, reach_m: float = 0.01) -> Hit:
    """A click on a measured point; the line of sight goes through the same place."""
    return Hit(at(across, up, away), reach_m=reach_m, ray=sight(across, up))


def on_nothing(across: float, up: float) -> Hit:
    return Hit(None, ray=sight(across, up))


def sight(across: float, up: float) -> Ray:
    east, north = CUT.normal
    return Ray(at(across, up, -0.25).xyz, (east, north, 0.0))


@pytest.fixture
def shared() -> SharedState:
    return shared_state()


def tool_of(shared: SharedState, part: TemplatePart) -> DrawTemplate:
    tool = DrawTemplate(shared, part)
    tool.use_cut(CUT)
    return tool


@pytest.fixture
def shape(shared: SharedState) -> DrawTemplate:
    return tool_of(shared, TemplatePart.SHAPE)


@pytest.fixture
def zone(shared: SharedState) -> DrawTemplate:
    return tool_of(shared, TemplatePart.EMPTY_ZONE)


def heard(tool: DrawTemplate) -> list[Text]:
    reported: list[Text] = []
    tool.reported.connect(reported.append)
    return reported


def drawn_by(tool: DrawTemplate, clicks: Sequence[Hit]) -> DrawnProfile:
    spy = QSignalSpy(tool.drawn)
    for hit in clicks:
        tool.press(hit)
        tool.release(hit)
    tool.complete()
    assert spy.count() == 1
    drawn = spy.at(0)[0]
    assert isinstance(drawn, DrawnProfile)
    assert not tool.is_busy
    return drawn


def test_clicks_make_a_profile_about_the_first_of_them(shape: DrawTemplate) -> None:
    reported = heard(shape)
    drawn = drawn_by(
        shape, [on_point(1.0, 0.15, 0.1), on_point(1.02, 0.0, -0.2), on_point(1.4, 0.01)]
    )
    assert drawn.about(drawn.anchor) == (((0.0, 0.0), (0.02, -0.15), (0.4, -0.14)),)
    assert drawn.cut == CUT
    assert reported == [BEGIN]


def test_a_click_back_on_the_anchor_begins_its_other_side(
    shape: DrawTemplate, shared: SharedState
) -> None:
    clicks = [on_point(1.0, 0.15), on_point(1.0, 0.0), on_point(1.005, 0.155), on_point(0.7, 0.16)]
    for hit in clicks:
        shape.press(hit)
    drawing = shared.sketch.drawing
    assert drawing is not None
    assert len(drawing.vertices) == 4
    shape.put_down()
    drawn = drawn_by(shape, clicks)
    assert drawn.about(drawn.anchor) == (((0.0, 0.0), (0.0, -0.15)), ((0.0, 0.0), (-0.3, 0.01)))


def test_over_nothing_and_with_ctrl_a_click_lands_on_the_plane(shape: DrawTemplate) -> None:
    free = Hit(
        at(1.31, 0.02, 0.2), modifiers=Qt.KeyboardModifier.ControlModifier, ray=sight(1.3, 0.0)
    )
    drawn = drawn_by(shape, [on_nothing(1.0, 0.15), on_nothing(1.0, 0.0), free])
    assert drawn.about(drawn.anchor) == (((0.0, 0.0), (0.0, -0.15), (0.3, -0.15)),)


def test_an_empty_zone_is_drawn_where_nothing_is(zone: DrawTemplate) -> None:
    corners = [(0.1, 0.1), (0.4, 0.1), (0.4, 0.5)]
    drawn = drawn_by(zone, [on_point(*corners[0]), *(on_nothing(*one) for one in corners[1:])])
    assert drawn.part is TemplatePart.EMPTY_ZONE
    assert drawn.about(at(0.1, 0.1).xyz) == (((0.0, 0.0), (0.3, 0.0), (0.3, 0.4)),)


def test_a_point_near_the_mouse_does_not_pull_a_zone(zone: DrawTemplate) -> None:
    pulled = Hit(at(0.15, 0.12), ray=sight(0.1, 0.1))
    drawn = drawn_by(zone, [pulled, on_nothing(0.4, 0.1), on_nothing(0.4, 0.5)])
    assert drawn.about(at(0.0, 0.0).xyz)[0][0] == (0.1, 0.1)


def test_too_little_is_told_and_stays_at_hand(shape: DrawTemplate, zone: DrawTemplate) -> None:
    reported = heard(shape)
    shape.press(on_point(1.0, 0.15))
    shape.press(on_point(1.001, 0.151))
    shape.complete()
    assert reported[-1] == TOO_SHORT
    assert shape.is_busy
    reported = heard(zone)
    zone.press(on_nothing(1.0, 0.0))
    zone.press(on_nothing(1.2, 0.0))
    zone.complete()
    assert reported == [TOO_SMALL]
    assert zone.is_busy


def test_without_a_section_and_beside_it_a_click_is_refused(shape: DrawTemplate) -> None:
    reported = heard(shape)
    shape.use_cut(None)
    shape.press(on_point(1.0, 0.0))
    shape.use_cut(CUT)
    shape.press(Hit(at(1.0, 0.0, 3.0)))
    shape.press(Hit(None))
    assert reported == [NEEDS_SECTION, NOT_IN_SECTION, NOT_IN_SECTION]
    assert not shape.is_busy


def test_a_section_that_moves_on_does_not_move_what_was_begun(shape: DrawTemplate) -> None:
    reported = heard(shape)
    shape.press(on_point(1.0, 0.15))
    shape.use_cut(Cut((110.0, 210.0, 50.0), (0.6, -0.8), width_m=0.5, half_length_m=5.0))
    shape.press(Hit(PickedPosition((110.0, 210.0, 50.0))))
    assert reported[-1] == NOT_IN_SECTION
    drawn = drawn_by(shape, [on_point(1.0, 0.0)])
    assert drawn.cut == CUT


def test_clicks_are_taken_back_one_by_one(shape: DrawTemplate, shared: SharedState) -> None:
    for hit in (on_point(1.0, 0.15), on_point(1.0, 0.0), on_point(1.0, 0.15), on_point(0.7, 0.15)):
        shape.press(hit)
    for _ in range(4):
        assert shape.is_busy
        shape.step_back()
    assert not shape.is_busy
    assert shared.sketch.drawing is None
    shape.step_back()
    shape.press(on_point(1.0, 0.15))
    shape.leave()
    assert shared.sketch.drawing is None


def test_the_way_to_the_mouse_is_shown_with_its_size(
    shape: DrawTemplate, shared: SharedState
) -> None:
    shape.move(on_point(1.0, 0.15))
    assert shared.sketch.drawing is None
    shape.press(on_point(1.0, 0.15))
    shape.move(on_nothing(1.25, 0.0))
    drawing = shared.sketch.drawing
    assert drawing is not None
    assert [note.text for note in drawing.notes] == ["+0.250 / -0.150 m"]
    assert drawing.preview[0].is_occluded
