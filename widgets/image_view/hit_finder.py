"""HitFinder: from a position in the window to the measured point and the feature there."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt

from processing.project.feature import PointReference
from widgets.image_view.feature_overlay import FeatureOverlay
from widgets.image_view.picture import Picture, Span
from widgets.image_view.placed_feature import PlacedFeature
from widgets.image_view.viewport import Viewport
from widgets.mouse_tools.mouse_tool import Boxed, Hit
from widgets.shared.cursor import Place

Floats = NDArray[np.float64]

VERTEX_PX = 8.0
SEGMENT_PX = 6.0
_CLICK_PX = 3
_POINTS_AT_ONCE = 4_000_000


def place_of(picture: Picture, point: int) -> Place:
    """A measured point with its exact coordinate."""
    easting, northing, height = picture.drive.xyz(np.array([point]))[0].tolist()
    return Place((easting, northing, height), PointReference(picture.drive.id, point))


def point_under(picture: Picture, viewport: Viewport, position: QPointF) -> int:
    """The point shown at a position; −1 where the pixel is empty."""
    return _point_near(picture, viewport, position, 0)


def point_clicked(picture: Picture, viewport: Viewport, position: QPointF) -> int:
    """The point shown at a position, or the nearest of the row within 3 pixels; else −1."""
    return _point_near(picture, viewport, position, _CLICK_PX)


def _point_near(picture: Picture, viewport: Viewport, position: QPointF, within_px: int) -> int:
    row, column = picture.pixel_at(*viewport.to_picture(position.x(), position.y()))
    if not (0 <= row < picture.image.rows and 0 <= column < picture.image.width):
        return -1
    # Far out one screen pixel stands for several columns; each of them is under the mouse.
    across = viewport.zoom_v if picture.rows_go_right else viewport.zoom_u
    below_mouse = 0 if across >= 1 else math.ceil(0.5 / across)
    return picture.image.nearest_filled(row, column, max(within_px, below_mouse))


class HitFinder:
    """Finds what the mouse is over, among the features that are shown.

    Parameters
    ----------
    overlay : FeatureOverlay
    """

    def __init__(self, overlay: FeatureOverlay) -> None:
        self._overlay = overlay

    def hit(
        self,
        picture: Picture,
        viewport: Viewport,
        position: QPointF,
        modifiers: Qt.KeyboardModifier,
    ) -> Hit:
        """What is under a position; vertices go before segments, chosen features before others."""
        point = point_clicked(picture, viewport, position)
        place = None if point < 0 else place_of(picture, point)
        mouse = np.array([position.x(), position.y()])
        x, y, reach = position.x(), position.y(), VERTEX_PX
        around = viewport.span_of(x - reach, y - reach, x + reach, y + reach)
        shown = self._overlay.shown_in(around)
        vertex = _nearest_vertex(shown, viewport, mouse, self._overlay.selected)
        if vertex is not None:
            return Hit(place, vertex[0], vertex=vertex[1], modifiers=modifiers)
        segment = _nearest_segment(shown, viewport, mouse, self._overlay.selected)
        if segment is not None:
            return Hit(place, segment[0], segment=segment[1], modifiers=modifiers)
        return Hit(place, modifiers=modifiers)

    def boxed(
        self, picture: Picture, viewport: Viewport, box: QRectF, modifiers: Qt.KeyboardModifier
    ) -> Boxed:
        """The features wholly inside a rectangle of the window, and the points inside it."""
        span = viewport.span_of(box.left(), box.top(), box.right(), box.bottom())
        low, high = np.array([span.left, span.top]), np.array([span.right, span.bottom])
        features = frozenset(
            one.feature.id
            for one in self._overlay.shown_in(span)
            if bool(((one.places >= low) & (one.places <= high)).all())
        )
        points = points_within(picture, span)
        return Boxed(features, {picture.drive.id: points}, modifiers)


def points_within(picture: Picture, span: Span) -> NDArray[np.int64]:
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
    shown: Iterable[PlacedFeature], viewport: Viewport, mouse: Floats, selected: frozenset[str]
) -> tuple[str, int] | None:
    best: tuple[bool, float, str, int] | None = None
    for one in shown:
        distances = np.hypot(*(viewport.to_screen(one.places) - mouse).T)
        if not np.isfinite(distances).any():
            continue
        index = int(np.nanargmin(distances))
        found = (one.feature.id not in selected, float(distances[index]), one.feature.id, index)
        if found[1] <= VERTEX_PX and (best is None or found[:2] < best[:2]):
            best = found
    return None if best is None else best[2:]


def _nearest_segment(
    shown: Iterable[PlacedFeature], viewport: Viewport, mouse: Floats, selected: frozenset[str]
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
