"""Scenes of what is drawn and measured."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QPoint, Qt

from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import CONTROL, SHIFT
from app.screenshots.street import CARRIAGEWAY_M, LEFT, MARKING_M, RIGHT, SIDEWALK_M, at
from processing.map.feature import Position
from widgets.mouse_tools.drawing.draw_line import DrawLine

_FOLLOWED_MS = 20_000


def line(studio: ScreenshotWindow) -> None:
    """A white line being drawn, the mouse drawn to its edge."""
    studio.look(RIGHT, at(9.0, MARKING_M), 8)
    studio.letter("0")
    studio.draw(RIGHT, [at(4.0, MARKING_M), at(6.5, MARKING_M), at(9.0, MARKING_M)])
    studio.hover(studio.spot(RIGHT, at(11.5, 0.03)))


def line_to_vertex(studio: ScreenshotWindow) -> None:
    """A gutter that is to end at a vertex of the curb."""
    studio.look(RIGHT, at(7.5, 0.0), 9)
    studio.letter("4")
    studio.draw(RIGHT, [at(4.0, SIDEWALK_M), at(6.0, 0.9)])
    studio.hover(_vertex_of_curb(studio, 4))


def line_in_3d(studio: ScreenshotWindow) -> None:
    """The same tool in 3D."""
    studio.look(RIGHT, at(9.0, MARKING_M), 6)
    studio.mouse.click(studio.view, studio.spot(RIGHT, at(9.0, MARKING_M)), CONTROL)
    studio.letter("F")
    picture = studio.parts.scene_view.picture
    if picture is not None:
        studio.mouse.wheel(picture, picture.rect().center(), 8)
    studio.settle()
    studio.letter("0")
    studio.draw(RIGHT, [at(5.0, MARKING_M), at(7.0, MARKING_M), at(9.0, MARKING_M)])
    if picture is not None:
        spot = studio.spot_3d(RIGHT, at(11.0, MARKING_M))
        studio.mouse.move(picture, spot - QPoint(7, 3))
        studio.mouse.move(picture, spot)


def point(studio: ScreenshotWindow) -> None:
    """A sign and where it faces."""
    sign = (-11396.84, -35134.68, 127.94)
    studio.look(RIGHT, sign, 8)
    studio.letter("6")
    spot = studio.spot(RIGHT, sign)
    studio.mouse.drag(studio.view, [spot, spot + QPoint(60, 46)], CONTROL)


def trace(studio: ScreenshotWindow) -> None:
    """A curb that is followed."""
    _trace_line(
        studio, LEFT, (-11385.871, -35121.449, 125.696), (-11389.463, -35126.003, 125.712), 6
    )
    studio.hover(studio.spot(LEFT, (-11389.85, -35126.5, 125.62)))


def trace_stopped(studio: ScreenshotWindow) -> None:
    """A curb that ends before the second click."""
    begin, end = (-11393.104, -35130.616, 125.726), (-11404.609, -35145.199, 125.646)
    _trace_line(studio, LEFT, begin, end, 4)


def arc(studio: ScreenshotWindow) -> None:
    """An arc over a click."""
    studio.look(RIGHT, at(9.0, SIDEWALK_M), 8)
    studio.letter("3")
    studio.letter("A", SHIFT)
    studio.draw(RIGHT, [at(6.0, 0.5), at(9.0, 1.6)])
    studio.hover(studio.spot(RIGHT, at(11.5, 0.6)), CONTROL)


def spline(studio: ScreenshotWindow) -> None:
    """A smooth curve through clicks."""
    studio.look(RIGHT, at(9.0, SIDEWALK_M), 8)
    studio.letter("3")
    studio.letter("L", SHIFT)
    studio.draw(RIGHT, [at(5.0, 0.6), at(7.0, 1.7), at(9.0, 0.8)])
    studio.hover(studio.spot(RIGHT, at(11.5, 1.6)), CONTROL)


def area(studio: ScreenshotWindow) -> None:
    """An area, corner by corner."""
    studio.look(RIGHT, at(9.0, CARRIAGEWAY_M), 6)
    studio.choose_kind("Road marking")
    corners = [at(6.0, -1.4), at(10.0, -1.4), at(10.0, -2.8)]
    studio.draw(RIGHT, corners)
    studio.hover(studio.spot(RIGHT, at(6.3, -2.8)), CONTROL)


def rectangle(studio: ScreenshotWindow) -> None:
    """A rectangle by three points, with its size."""
    studio.look(RIGHT, at(9.0, -0.6), 10)
    studio.choose_kind("Grating")
    studio.letter("R")
    studio.draw(RIGHT, [at(8.0, -0.2), at(9.0, -0.2)])
    studio.hover(studio.spot(RIGHT, at(9.0, -0.6)), CONTROL)


def row_of_lids(studio: ScreenshotWindow) -> None:
    """A row that goes on as the one grating that is there."""
    studio.look(RIGHT, at(9.5, -0.6), 10)
    studio.choose_kind("Grating")
    studio.letter("R")
    studio.draw(RIGHT, [at(8.0, -0.2), at(8.5, -0.2), at(8.5, -0.6)])
    studio.letter("G", SHIFT)
    studio.draw(RIGHT, [at(9.25, -0.4)])
    studio.hover(studio.spot(RIGHT, at(10.75, -0.4)), CONTROL)


def circle(studio: ScreenshotWindow) -> None:
    """A circle by three points, with its diameter."""
    studio.look(RIGHT, at(9.0, CARRIAGEWAY_M), 10)
    studio.letter("9")
    studio.letter("R", SHIFT)
    studio.draw(RIGHT, [at(8.7, -2.0), at(9.0, -1.7)])
    studio.hover(studio.spot(RIGHT, at(9.3, -2.0)), CONTROL)


def parallel(studio: ScreenshotWindow) -> None:
    """A copy beside a curb, at a distance."""
    studio.look(RIGHT, at(9.0, 0.3), 7)
    studio.letter("O")
    studio.mouse.click(studio.view, _middle_of_curb(studio, 4))
    studio.hover(studio.spot(RIGHT, at(9.0, 0.6)), CONTROL)


def plane(studio: ScreenshotWindow) -> None:
    """Vertices on a working plane, where no point was measured."""
    studio.look(RIGHT, at(9.0, SIDEWALK_M), 6)
    studio.mouse.click(studio.view, studio.spot(RIGHT, at(9.0, SIDEWALK_M)))
    studio.letter("H")
    studio.letter("4")
    for along_m in (6.0, 8.0, 10.0):
        studio.mouse.click(studio.view, studio.spot(RIGHT, at(along_m, 1.7)), CONTROL)
    studio.hover(studio.spot(RIGHT, at(12.0, 1.7)), CONTROL)


def measure(studio: ScreenshotWindow) -> None:
    """A distance with its read-out."""
    studio.look(RIGHT, at(9.0, 0.0), 7)
    studio.letter("M")
    studio.draw(RIGHT, [at(6.0, -0.05), at(9.0, 0.3)])
    studio.hover(studio.spot(RIGHT, at(11.0, 1.5)), CONTROL)


def measure_area(studio: ScreenshotWindow) -> None:
    """An area with its read-out, ended."""
    studio.look(RIGHT, at(9.0, CARRIAGEWAY_M), 6)
    studio.letter("M", SHIFT)
    studio.draw(RIGHT, [at(6.0, -1.4), at(10.0, -1.4), at(10.0, -2.8), at(6.3, -2.8)])
    studio.key(Qt.Key.Key_Return)


def _trace_line(
    studio: ScreenshotWindow, drive: str, begin: Position, end: Position, notches: int
) -> None:
    studio.look(drive, begin, notches)
    studio.letter("1")
    studio.letter("T")
    studio.mouse.click(studio.view, studio.spot(drive, begin))
    studio.mouse.click(studio.view, studio.spot(drive, end))
    tool = studio.parts.toolbox.tool
    if isinstance(tool, DrawLine):
        studio.wait(lambda: not tool.is_following, _FOLLOWED_MS)


def _vertex_of_curb(studio: ScreenshotWindow, number: int) -> QPoint:
    """Where a vertex of the drawn lower edge is."""
    curb = studio.feature("curb_lower", RIGHT)
    return studio.spot(RIGHT, curb.vertices[number].xyz)


def _middle_of_curb(studio: ScreenshotWindow, number: int) -> QPoint:
    """The middle of a segment of the drawn lower edge."""
    one, other = _vertex_of_curb(studio, number), _vertex_of_curb(studio, number + 1)
    return (one + other) / 2


DRAWING: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "draw-arc": arc,
    "draw-area": area,
    "draw-circle": circle,
    "draw-line": line,
    "draw-line-3d": line_in_3d,
    "draw-line-vertex": line_to_vertex,
    "draw-parallel": parallel,
    "draw-plane": plane,
    "draw-point": point,
    "draw-rectangle": rectangle,
    "draw-row": row_of_lids,
    "draw-spline": spline,
    "draw-trace": trace,
    "draw-trace-stopped": trace_stopped,
    "measure-area": measure_area,
    "measure-line": measure,
}
