"""Scenes of the views beside the image: in step with it, and each with what it alone can do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPoint, Qt

from app.layout.view_docks import ViewLayout
from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import CONTROL
from app.screenshots.street import LEFT, MARKING_M, RIGHT, at
from processing.map.feature import Position
from widgets.camera_view.stereo_measurement import StereoMeasurement
from widgets.camera_view.view import CameraView
from widgets.plane_view.view import PlaneView
from widgets.scene_view.clipping import ClipChoice
from widgets.shared.cursor import PickedPosition
from widgets.shared.image_orientation import ImageOrientation

SIGN = (-11396.84, -35134.68, 127.94)
_BEHIND = (-11375.78, -35123.31, 125.51)
_TWO = 2
_NEARER = 2.5
_AHEAD_M = -9.0
"""Along the curb, some metres in front of the first image."""


def in_step(layout: ViewLayout) -> Callable[[ScreenshotWindow], None]:
    """A vertex of a curb was clicked in the image; every view shows it."""

    def stand(studio: ScreenshotWindow) -> None:
        studio.act(f"layout-{layout.value}")
        studio.settle()
        vertex = studio.feature("curb_upper", RIGHT).vertices[4].xyz
        studio.look(RIGHT, vertex, 5)
        studio.mouse.click(studio.view, studio.spot(RIGHT, vertex))
        if layout is ViewLayout.EARTHWORK:
            studio.parts.map_view.zoom_by(1.5)

    return stand


def across(studio: ScreenshotWindow) -> None:
    """The street cut across the vehicle's path."""
    _cut(studio, at(9.0, MARKING_M))


def along(studio: ScreenshotWindow) -> None:
    """Cut along a drawn curb."""
    vertex = studio.feature("curb_upper", RIGHT).vertices[4].xyz
    _cut(studio, vertex, chooses=True)
    section = studio.parts.section_view
    section.use_settings(replace(section.settings, is_along=True))
    section.show_everything()


def pinned(studio: ScreenshotWindow) -> None:
    """One place held as two windows, in the layout for checking."""
    studio.act("layout-checking")
    studio.settle()
    _cut(studio, studio.feature("curb_upper", RIGHT).vertices[4].xyz, chooses=True)
    studio.parts.section_view.set_pinned(True)


def heights_larger(studio: ScreenshotWindow) -> None:
    """Heights drawn five times larger: the camber of the road."""
    _cut(studio, at(9.0, MARKING_M))
    section = studio.parts.section_view
    section.use_settings(replace(section.settings, exaggeration=5.0))


def live(studio: ScreenshotWindow) -> None:
    """The mouse over a curb in the image: the slab follows it."""
    vertex = studio.feature("curb_upper", RIGHT).vertices[4].xyz
    studio.look(RIGHT, vertex, 7)
    studio.bring("view-section")
    studio.settle()
    studio.hover(studio.spot(RIGHT, vertex) + QPoint(20, 0))


def dragged_in_section(studio: ScreenshotWindow) -> None:
    """A curb's vertex on its way in the section."""
    vertex = studio.feature("curb_upper", RIGHT).vertices[4].xyz
    _cut(studio, vertex, chooses=True)
    pane = studio.parts.section_view.panes[0]
    studio.letter("V")
    studio.parts.section_view.center_on(studio.position(RIGHT, vertex))
    _zoom(studio, pane, vertex, 10)
    spot = _spot(studio, pane, RIGHT, vertex)
    studio.mouse.drag(pane, [spot, spot + QPoint(46, -30)], CONTROL)


def camera(studio: ScreenshotWindow) -> None:
    """A curb in the image that sees it best, the map drawn into it."""
    _photograph(studio, LEFT, studio.features("curb_upper", LEFT)[-1].vertices[-1].xyz)


def line_in_camera(studio: ScreenshotWindow) -> None:
    """A white line being drawn in a photograph."""
    view = studio.parts.camera_view
    positions = [at(_AHEAD_M + further_m, MARKING_M) for further_m in (0.0, 2.0, 4.0, 7.0)]
    _photograph(studio, LEFT, positions[1])
    studio.letter("0")
    for position in positions[:-1]:
        studio.mouse.click(view, _spot(studio, view, LEFT, position), CONTROL)
    _hover(studio, view, _spot(studio, view, LEFT, positions[-1]))


def stereo(studio: ScreenshotWindow) -> None:
    """The first image was clicked; the other one shows the line of sight."""
    view = studio.parts.camera_view
    studio.bring("view-camera")
    position = _seen_twice(studio)
    studio.settle()
    view.set_stereo(True)
    studio.mouse.click(view, _spot_of(view, position))
    studio.wait(lambda: view.is_sharp)


def stereo_measured(studio: ScreenshotWindow) -> None:
    """Both images were clicked; the place has an error."""
    stereo(studio)
    view, position = studio.parts.camera_view, studio.parts.document.shared.cursor.position
    studio.settle()
    if position is not None:
        studio.mouse.click(view, _spot_of(view, position))


def calibration(studio: ScreenshotWindow) -> None:
    """How the camera sits on the vehicle."""
    studio.act("layout-checking")
    studio.settle()
    _photograph(studio, RIGHT, SIGN)
    studio.parts.camera_panel.show_calibration(True)  # noqa: FBT003 - a slot


def no_image(studio: ScreenshotWindow) -> None:
    """A place that no image sees."""
    studio.look(LEFT, _BEHIND, 5)
    studio.bring("view-camera")
    studio.mouse.click(studio.view, studio.spot(LEFT, _BEHIND))


def map_whole(studio: ScreenshotWindow) -> None:
    """The street from above: path with stations, what images see, scale, north."""
    studio.act("layout-earthwork")
    studio.settle()
    studio.look(RIGHT, SIGN, 5)
    studio.parts.document.shared.cursor.move_to(studio.position(RIGHT, SIGN))
    studio.parts.map_view.show_everything()


def map_small(studio: ScreenshotWindow) -> None:
    """The map as first seen, in its usual place."""
    studio.look(RIGHT, at(9.0, 0.0), 3)
    studio.bring("view-map")


def lying(orientation: ImageOrientation) -> Callable[[ScreenshotWindow], None]:
    """The image with the street running another way."""

    def lie(studio: ScreenshotWindow) -> None:
        studio.parts.document.shared.view_settings.orient_image(orientation)
        if orientation.is_vertical:
            studio.act("side-by-side")
        studio.settle()
        studio.look(RIGHT, at(9.0, 0.0), 3)

    return lie


def beside(studio: ScreenshotWindow) -> None:
    """Two images, scrolled together."""
    studio.look(RIGHT, at(9.0, 0.0), 3)
    studio.parts.image_bar.another_requested.emit()


def clipped(choice: ClipChoice) -> Callable[[ScreenshotWindow], None]:
    """3D with nothing but what is around the drive, the chosen line or the section."""

    def clip(studio: ScreenshotWindow) -> None:
        _cut(studio, studio.feature("curb_upper", RIGHT).vertices[4].xyz, chooses=True)
        studio.parts.scene_view.clipping.choose(choice)
        if choice is not ClipChoice.DRIVE:
            studio.parts.scene_view.center_on_selection()
            studio.parts.scene_view.zoom_by(_NEARER)

    return clip


def _seen_twice(studio: ScreenshotWindow) -> PickedPosition:
    """A drawn vertex that two images see from far enough apart, and nothing hides; looked at."""
    view, cursor = studio.parts.camera_view, studio.parts.document.shared.cursor
    for feature in studio.parts.document.features():
        for vertex in feature.vertices:
            if len(view.showing.images.choice.seeing(np.array(vertex.xyz))) < _TWO:
                continue
            position = PickedPosition(vertex.xyz, vertex.measured)
            cursor.move_to(position)
            studio.wait(lambda: view.is_sharp)
            if not view.showing.is_hidden and _has_partner(view, position):
                return position
    message = "no two images see the same"
    raise LookupError(message)


def _has_partner(view: CameraView, position: PickedPosition) -> bool:
    """Whether a second click would measure what the first one at a place shows."""
    projection, depth, stereo = view.projection(), view.showing.depth, StereoMeasurement()
    if projection is None or depth is None:
        return False
    across, down = projection.to_plane(np.array([position.xyz]))[0].tolist()
    stereo.mark(view.showing.number, (across, down))
    seen = depth.quick_point_at((across, down))
    near = np.array(position.xyz if seen is None else seen.xyz)
    return stereo.partner(view.showing.images.choice, near) is not None


def _cut(studio: ScreenshotWindow, xyz: Position, *, chooses: bool = False) -> None:
    """Click a place in the image, the section beside it; choose the line there as well."""
    studio.bring("view-section")
    studio.look(RIGHT, xyz, 5)
    if not chooses:
        studio.key(Qt.Key.Key_Escape)
    studio.mouse.click(studio.view, studio.spot(RIGHT, xyz))
    studio.settle()


def _photograph(studio: ScreenshotWindow, drive: str, xyz: Position) -> None:
    studio.bring("view-camera")
    studio.look(drive, xyz, 5)
    studio.parts.document.shared.cursor.move_to(studio.position(drive, xyz))
    studio.wait(lambda: studio.parts.camera_view.is_sharp)
    studio.settle()


def _spot(studio: ScreenshotWindow, view: PlaneView, drive: str, xyz: Position) -> QPoint:
    """Where a place is in a view."""
    return _spot_of(view, studio.position(drive, xyz))


def _spot_of(view: PlaneView, position: PickedPosition) -> QPoint:
    at_ = view.position_of(position)
    return QPoint() if at_ is None else at_.toPoint()


def _zoom(studio: ScreenshotWindow, view: PlaneView, xyz: Position, notches: int) -> None:
    studio.mouse.wheel(view, _spot(studio, view, RIGHT, xyz), notches)
    studio.settle()


def _hover(studio: ScreenshotWindow, view: PlaneView, spot: QPoint) -> None:
    studio.mouse.move(view, spot - QPoint(9, 5))
    studio.mouse.move(view, spot)


VIEWS: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    **{f"views-{layout.value}": in_step(layout) for layout in ViewLayout},
    "section-across": across,
    "section-along": along,
    "section-drag": dragged_in_section,
    "section-heights": heights_larger,
    "section-live": live,
    "section-pinned": pinned,
    "camera-calibration": calibration,
    "camera-features": camera,
    "camera-line": line_in_camera,
    "camera-none": no_image,
    "camera-stereo": stereo,
    "camera-stereo-measured": stereo_measured,
    "image-beside": beside,
    "image-mirrored": lying(ImageOrientation(is_mirrored_across=True)),
    "image-vertical": lying(ImageOrientation(is_vertical=True)),
    "map-small": map_small,
    "map-whole": map_whole,
    "scene-clipped-drive": clipped(ClipChoice.DRIVE),
    "scene-clipped-line": clipped(ClipChoice.SELECTION),
    "scene-clipped-section": clipped(ClipChoice.SECTION),
}
