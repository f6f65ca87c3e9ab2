"""Tracing with the mouse: two clicks, gaps, corrections by dragging; a street known exactly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.map.catalogue import Geometry
from processing.map.feature import Vertex
from processing.recording.drive import Drive
from tests.processing.image.profiled_streets import UPPER, ProfiledStreet, off_line, recorded
from tests.widgets.builders import OpenMap, path_tool, position_on
from widgets.mouse_tools.drawing.draw_line import DrawLine
from widgets.mouse_tools.drawing.legs import LegMode
from widgets.mouse_tools.mouse_tool import Hit
from widgets.mouse_tools.tracing import STRAIGHT_ON, TracedLine, tracing_work
from widgets.shared.cursor import PickedPosition

STREET = ProfiledStreet(length_m=12.0)


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory.mktemp("street") / "drive", STREET)


@pytest.fixture
def source(drive: Drive) -> OpenMap:
    return OpenMap((drive,))


def tracer(source: OpenMap) -> DrawLine:
    tool = path_tool(source, Geometry.LINE)
    source.listen_to(tool)
    tool.set_mode(LegMode.TRACE)
    return tool


def hit_near(drive: Drive, position: Floats, reach_m: float = 0.2) -> Hit:
    xyz = drive.xyz(slice(0, drive.count))
    return Hit(
        position_on(drive, int(np.linalg.norm(xyz - position, axis=1).argmin())), reach_m=reach_m
    )


def drawn(source: OpenMap) -> Floats:
    drawing = source.shared.sketch.drawing
    assert drawing is not None
    return np.array([vertex.xyz for vertex in drawing.vertices])


def test_two_clicks_and_enter_are_a_curb(source: OpenMap, drive: Drive) -> None:
    tool, edge = tracer(source), STREET.edge(UPPER)
    tool.press(hit_near(drive, edge[50]))
    tool.press(hit_near(drive, edge[-50]))
    tool.complete()
    (line,) = source.stored.values()
    positions = np.array([vertex.xyz for vertex in line.vertices])
    assert off_line(positions, edge).max() < 0.03
    assert np.linalg.norm(positions[-1] - positions[0]) > 10.0
    assert all(vertex.measured is not None for vertex in line.vertices)


def test_backspace_takes_the_traced_piece_back_whole(source: OpenMap, drive: Drive) -> None:
    tool, edge = tracer(source), STREET.edge(UPPER)
    tool.press(hit_near(drive, edge[50]))
    tool.press(hit_near(drive, edge[-50]))
    assert len(drawn(source)) > 1
    tool.step_back()
    assert len(drawn(source)) == 1


def test_what_comes_after_it_was_taken_back_is_dropped(source: OpenMap, drive: Drive) -> None:
    waiting: list[tuple[Callable[[], object], Callable[[object | None], None]]] = []
    tool = DrawLine(
        source, source.shared, Geometry.LINE, lambda work, take: waiting.append((work, take))
    )
    tool.set_kind(path_tool(source, Geometry.LINE).kind)
    tool.set_mode(LegMode.TRACE)
    edge = STREET.edge(UPPER)
    tool.press(hit_near(drive, edge[50]))
    tool.press(hit_near(drive, edge[-50]))
    assert tool.is_following
    tool.step_back()
    work, take = waiting[0]
    take(work())
    assert len(drawn(source)) == 1
    assert not tool.is_following


def test_enter_before_the_trace_has_come_completes_when_it_comes(
    source: OpenMap, drive: Drive
) -> None:
    waiting: list[tuple[Callable[[], object], Callable[[object | None], None]]] = []
    tool = DrawLine(
        source, source.shared, Geometry.LINE, lambda work, take: waiting.append((work, take))
    )
    source.listen_to(tool)
    tool.set_kind(path_tool(source, Geometry.LINE).kind)
    tool.set_mode(LegMode.TRACE)
    edge = STREET.edge(UPPER)
    tool.press(hit_near(drive, edge[50]))
    tool.press(hit_near(drive, edge[-50]))
    tool.complete()
    assert source.stored == {}
    work, take = waiting[0]
    take(work())
    assert len(source.stored) == 1


def test_a_failed_trace_leaves_the_drawing_as_it_was(source: OpenMap, drive: Drive) -> None:
    tool = DrawLine(source, source.shared, Geometry.LINE, lambda work, take: take(None))
    source.listen_to(tool)
    tool.set_kind(path_tool(source, Geometry.LINE).kind)
    tool.set_mode(LegMode.TRACE)
    edge = STREET.edge(UPPER)
    tool.press(hit_near(drive, edge[50]))
    tool.press(hit_near(drive, edge[-50]))
    assert len(drawn(source)) == 1
    assert source.reported[-1].en == "The line could not be followed."


def test_where_nothing_is_to_be_followed_a_second_click_goes_straight(
    source: OpenMap, drive: Drive
) -> None:
    tool, edge = tracer(source), STREET.edge(UPPER)
    aside = STREET.edge(np.array([0.8, 0.165])) - edge  # in the middle of the sidewalk
    tool.press(hit_near(drive, (edge + aside)[50]))
    end = hit_near(drive, (edge + aside)[-50])
    tool.press(end)
    if len(drawn(source)) == 1:
        tool.press(end)
        assert source.reported[-1] == STRAIGHT_ON
    assert end.position is not None
    assert tuple(drawn(source)[-1]) == end.position.xyz


def test_a_traced_piece_is_dragged_to_where_it_should_pass(source: OpenMap, drive: Drive) -> None:
    tool, edge = tracer(source), STREET.edge(UPPER)
    tool.press(hit_near(drive, edge[50]))
    tool.press(hit_near(drive, edge[-50]))
    middle = len(edge) // 2
    grip = hit_near(drive, edge[middle])
    tool.press(grip)
    tool.release(grip)
    before = drawn(source)
    via = hit_near(drive, edge[middle + 40])
    tool.press(grip)
    tool.move(via)
    tool.release(via)
    after = drawn(source)
    assert via.position is not None
    assert len(before) > 1
    assert np.linalg.norm(after - np.array(via.position.xyz), axis=1).min() < 1e-9
    assert np.allclose(after[[0, -1]], before[[0, -1]])


def test_places_that_rest_on_no_point_give_no_work(source: OpenMap) -> None:
    assert tracing_work(source, (Vertex((0.0, 0.0, 0.0)),), across_gaps=False) is None


def test_a_place_far_from_the_drive_stops_the_trace_and_says_why(
    source: OpenMap, drive: Drive
) -> None:
    here = position_on(drive, drive.count // 2)
    far = PickedPosition((here.xyz[0] + 500.0, here.xyz[1], here.xyz[2]))
    through = (Vertex(far.xyz), Vertex(here.xyz, here.measured))
    work = tracing_work(source, through, across_gaps=False)
    assert work is not None
    found = work()
    assert isinstance(found, TracedLine)
    assert not found.is_complete
    assert "no measured point" in found.reason.en
