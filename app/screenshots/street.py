"""The sample street as scenes see it: places along the curb of its right side, and its drawing."""

from __future__ import annotations

from app.demo.sample_drawing import read_sample_drawing
from app.screenshots.screenshot_window import ScreenshotWindow
from processing.map.feature import Position

RIGHT, LEFT = "right", "left"
CARRIAGEWAY_M, MARKING_M, SIDEWALK_M = -2.0, -0.7, 1.2
"""Metres beside the curb: on the road, on its white line, on the sidewalk."""

_BEGIN, _DIRECTION = (-11384.13, -35133.87), (-0.6192, -0.7852)
_ROAD_HEIGHT_M, _SIDEWALK_HEIGHT_M = 125.62, 125.74


def at(along_m: float, aside_m: float) -> Position:
    """A place so far along the right curb and beside it; the road is at the negative side."""
    east, north = _DIRECTION
    return (
        _BEGIN[0] + along_m * east - aside_m * north,
        _BEGIN[1] + along_m * north + aside_m * east,
        _SIDEWALK_HEIGHT_M if aside_m > 0 else _ROAD_HEIGHT_M,
    )


def open_street(studio: ScreenshotWindow) -> None:
    """Import the street as a new project."""
    parts = studio.parts
    parts.start_page.demo_requested.emit()
    studio.wait(lambda: bool(parts.document.drives()))
    studio.wait(lambda: not parts.jobs.is_busy)
    studio.settle()


def draw_street(studio: ScreenshotWindow) -> None:
    """Draw what is on the street by clicks, as ``zuka demo`` does."""
    parts = studio.parts
    for wanted in read_sample_drawing():
        studio.show_drive(wanted.drive)
        parts.toolbox.choose_kind(parts.document.catalogue()[wanted.kind])
        for xyz in wanted.positions:
            parts.image_view.show_one_to_one()
            parts.image_view.center_on(studio.position(wanted.drive, xyz))
            studio.draw(wanted.drive, [xyz])
        parts.toolbox.complete()
    studio.tidy()
    studio.letter("S")
    studio.show_drive(RIGHT)
