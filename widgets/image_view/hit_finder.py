"""HitFinder: from a position in the window to the measured point and the feature there."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPolygonF

from processing.core.arrays import Floats
from processing.image.edges.beam import beam_at
from processing.map.catalogue import Geometry
from processing.map.feature import PointReference
from processing.recording.columns.counted_classes import class_columns, seen_points
from widgets.feature_drawing.outlines import are_inside, is_rectangle
from widgets.image_view.features.feature_overlay import FeatureOverlay
from widgets.image_view.features.picture_feature import PictureFeature
from widgets.image_view.orientation.oriented_image import OrientedImage, Span
from widgets.image_view.orientation.viewport import Viewport
from widgets.mouse_tools.gesture import REACH_PX
from widgets.mouse_tools.mouse_tool import EnclosedHits, Hit, Ray
from widgets.shared.cursor import PickedPosition
from widgets.shared.snap_state import SnapState
from widgets.shared.view_settings import ViewSettings

VERTEX_PX = 8.0
SEGMENT_PX = 6.0
_CLICK_PX = 3
_POINTS_AT_ONCE = 4_000_000


def position_of(picture: OrientedImage, point: int) -> PickedPosition:
    """A measured point with its exact coordinate."""
    easting, northing, height = picture.drive.xyz(np.array([point]))[0].tolist()
    return PickedPosition((easting, northing, height), PointReference(picture.drive.id, point))


def point_under(
    picture: OrientedImage, viewport: Viewport, position: QPointF, *, hides_noise: bool = False
) -> int:
    """The point shown at a position; −1 where the pixel is empty."""
    return _point_near(picture, viewport, position, 0, hides_noise=hides_noise)


def point_clicked(
    picture: OrientedImage, viewport: Viewport, position: QPointF, *, hides_noise: bool = False
) -> int:
    """The point shown at a position, or the nearest of the row within 3 pixels; else −1."""
    return _point_near(picture, viewport, position, _CLICK_PX, hides_noise=hides_noise)


def _point_near(
    picture: OrientedImage,
    viewport: Viewport,
    position: QPointF,
    within_px: int,
    *,
    hides_noise: bool,
) -> int:
    row, column = picture.pixel_at(*viewport.to_picture(position.x(), position.y()))
    if not (0 <= row < picture.image.rows and 0 <= column < picture.image.width):
        return -1
    # Far out one screen pixel stands for several columns; each of them is under the mouse.
    across = viewport.zoom_v if picture.rows_go_right else viewport.zoom_u
    below_mouse = 0 if across >= 1 else math.ceil(0.5 / across)
    classes = class_columns(picture.drive.columns) if hides_noise else None
    within_px = max(within_px, below_mouse)
    return picture.image.nearest_filled(row, column, within_px, without_noise=classes)


class HitFinder:
    """Finds what the mouse is over, among the features that are shown.

    Parameters
    ----------
    overlay : FeatureOverlay
    snap : SnapState
    settings : ViewSettings
        Say whether noise is hidden.

    Attributes
    ----------
    picture : Picture or None
        What is shown; the view keeps it up to date, as the viewport.
    viewport : Viewport
    """

    def __init__(self, overlay: FeatureOverlay, snap: SnapState, settings: ViewSettings) -> None:
        self._overlay = overlay
        self._snap = snap
        self._settings = settings
        self.picture: OrientedImage | None = None
        self.viewport = Viewport()

    def exact_hit(self, mouse: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a position; vertices go before segments, chosen features before others."""
        picture, viewport = self.picture, self.viewport
        if picture is None:
            return Hit(None, modifiers=modifiers)
        point = point_clicked(picture, viewport, mouse, hides_noise=self._hides_noise)
        position = None if point < 0 else position_of(picture, point)
        feature, vertex, segment = self._feature_at(mouse)
        return Hit(
            position,
            feature,
            vertex,
            segment,
            modifiers,
            reach_m=_reach_m(picture, viewport),
            # Only a working plane asks for the line of sight, which takes half a millisecond.
            ray=None if self._snap.plane is None else self._ray(picture, mouse),
        )

    def position_under(self, position: QPointF) -> PickedPosition | None:
        """The point shown at a position; None where the pixel is empty."""
        if self.picture is None:
            return None
        point = point_under(self.picture, self.viewport, position, hides_noise=self._hides_noise)
        return None if point < 0 else position_of(self.picture, point)

    def quick_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """The same: in the image every point is at hand."""
        return self.exact_hit(position, modifiers)

    def enclosed(self, outline: QPolygonF, modifiers: Qt.KeyboardModifier) -> EnclosedHits:
        """The features wholly inside an outline in the window, and the points inside it."""
        picture, viewport = self.picture, self.viewport
        if picture is None:
            return EnclosedHits(frozenset(), {}, modifiers)
        bounds = outline.boundingRect()
        span = viewport.span_of(bounds.left(), bounds.top(), bounds.right(), bounds.bottom())
        features = frozenset(
            one.feature.id
            for one in self._overlay.shown_in(span)
            if bool(are_inside(viewport.to_screen(one.positions), outline).all())
        )
        points = points_within(picture, span)
        if not is_rectangle(outline):
            rows, columns = picture.image.pixel_of(points)
            positions = picture.positions(rows, columns.astype(np.int64))
            points = points[are_inside(viewport.to_screen(positions), outline)]
        points = seen_points(picture.drive.columns, points, hides_noise=self._hides_noise)
        return EnclosedHits(features, {picture.drive.id: points}, modifiers)

    @property
    def _hides_noise(self) -> bool:
        return self._settings.look.hides_noise

    def _feature_at(self, position: QPointF) -> tuple[str, int, int]:
        """Id, vertex and segment of the feature under the mouse; an area also by its inside."""
        viewport, selected = self.viewport, self._overlay.selected
        x, y, reach = position.x(), position.y(), VERTEX_PX
        mouse = np.array([x, y])
        around = viewport.span_of(x - reach, y - reach, x + reach, y + reach)
        shown = self._overlay.shown_in(around)
        vertex = _nearest_vertex(shown, viewport, mouse, selected)
        if vertex is not None:
            return vertex[0], vertex[1], -1
        segment = _nearest_segment(shown, viewport, mouse, selected)
        if segment is not None:
            return segment[0], -1, segment[1]
        at = QPointF(*viewport.to_picture(x, y))
        areas = (one for one in reversed(shown) if one.feature.geometry is Geometry.AREA)
        inside = next((one.feature.id for one in areas if one.path.contains(at)), "")
        return inside, -1, -1

    def _ray(self, picture: OrientedImage, position: QPointF) -> Ray | None:
        if not picture.image.kind.follows_path:
            return None
        row, column = picture.pixel_at(*self.viewport.to_picture(position.x(), position.y()))
        beam = beam_at(picture.drive, picture.image, row, column)
        return None if beam is None else Ray(*beam)


def _reach_m(picture: OrientedImage, viewport: Viewport) -> float:
    """How far the mouse's circle reaches on the ground, near the trajectory."""
    step_m = picture.orientation.length_m / max(picture.size[0], 1)
    along = REACH_PX / viewport.zoom_u * step_m
    across = REACH_PX / viewport.zoom_v * step_m / picture.stretch
    return (along + across) / 2


def points_within(picture: OrientedImage, span: Span) -> NDArray[np.int64]:
    """(n,) sorted: all points whose pixels a rectangle touches, hidden returns included."""
    rows, columns = picture.rows_columns(span)
    image = picture.image
    found = [np.empty(0, np.int64)]
    row = rows.start
    while row < rows.stop:
        start = int(image.row_starts[row])
        limit = int(np.searchsorted(image.row_starts, start + _POINTS_AT_ONCE, side="right")) - 1
        row = min(max(limit, row + 1), rows.stop)
        of_points = image.columns_of(start, int(image.row_starts[row]))
        inside = (of_points >= columns.start) & (of_points < columns.stop)
        found.append(start + np.flatnonzero(inside))
    return np.concatenate(found)


def _nearest_vertex(
    shown: Iterable[PictureFeature], viewport: Viewport, mouse: Floats, selected: frozenset[str]
) -> tuple[str, int] | None:
    best: tuple[bool, float, str, int] | None = None
    for one in shown:
        distances = np.hypot(*(viewport.to_screen(one.positions) - mouse).T)
        if not np.isfinite(distances).any():
            continue
        index = int(np.nanargmin(distances))
        found = (one.feature.id not in selected, float(distances[index]), one.feature.id, index)
        if found[1] <= VERTEX_PX and (best is None or found[:2] < best[:2]):
            best = found
    return None if best is None else best[2:]


def _nearest_segment(
    shown: Iterable[PictureFeature], viewport: Viewport, mouse: Floats, selected: frozenset[str]
) -> tuple[str, int] | None:
    best: tuple[bool, float, str, int] | None = None
    for one in shown:
        if not one.segments.size:
            continue
        distances = _distances_to(
            viewport.to_screen(one.segments[:, :2]), viewport.to_screen(one.segments[:, 2:4]), mouse
        )
        index = int(np.argmin(distances))
        number = int(one.segments[index, 4])
        found = (one.feature.id not in selected, float(distances[index]), one.feature.id, number)
        if found[1] <= SEGMENT_PX and (best is None or found[:2] < best[:2]):
            best = found
    return None if best is None else best[2:]


def _distances_to(starts: Floats, ends: Floats, mouse: Floats) -> Floats:
    """(n,) distances of a position from segments."""
    along = ends - starts
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip(((mouse - starts) * along).sum(axis=1) / squared, 0.0, 1.0)
    away: Floats = np.hypot(*(starts + share[:, None] * along - mouse).T)
    return away
