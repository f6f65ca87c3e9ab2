"""SceneHits: from pixels of the 3D view to hits that mouse tools understand."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPolygonF

from processing.core.arrays import Floats
from widgets.feature_drawing.feature_shapes import FlatShapes, flatten_shapes
from widgets.feature_drawing.outlines import are_inside
from widgets.mouse_tools.gesture import REACH_PX
from widgets.mouse_tools.mouse_tool import EnclosedHits, Hit, Ray
from widgets.scene_view.map.feature_hits import feature_at, features_within
from widgets.scene_view.points.point_finder import FoundPoint, PointFinder
from widgets.scene_view.rendering.projection import SceneProjection
from widgets.scene_view.rendering.scene_tile import DrawnTile


class SceneHits:
    """What is in the picture now; the view keeps it up to date.

    Attributes
    ----------
    projection : SceneProjection
    drawn : tuple of DrawnTile
    flat : FlatShapes
        The features that are drawn.
    selected : frozenset of str
        Chosen features, which are hit before others.
    origin : (3,) float64
        The view's local origin, m, project CRS.
    """

    def __init__(self, finder: PointFinder, projection: SceneProjection) -> None:
        self._finder = finder
        self.projection = projection
        self.drawn: tuple[DrawnTile, ...] = ()
        self.flat: FlatShapes = flatten_shapes(())
        self.selected: frozenset[str] = frozenset()
        self.origin: Floats = np.zeros(3)

    def exact_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among all measured points."""
        found = self._finder.exact(self.drawn, self.projection, position.x(), position.y())
        return self._hit(found, position, modifiers)

    def quick_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among the points that are drawn."""
        return self._hit(self._drawn_point(position), position, modifiers)

    def enclosed(self, outline: QPolygonF, modifiers: Qt.KeyboardModifier) -> EnclosedHits:
        """The features wholly inside an outline, the drawn points inside it, and all of them."""
        points: dict[str, list[NDArray[np.int64]]] = {}
        for one in self.drawn:
            pixels, _ = self.projection.to_screen(one.tile.local_xyz)
            inside = one.tile.points[are_inside(pixels, outline)]
            if inside.size:
                points.setdefault(one.tile.id.drive_id, []).append(inside)
        joined = {drive: np.unique(np.concatenate(parts)) for drive, parts in points.items()}
        corners = np.array([(corner.x(), corner.y()) for corner in outline.toList()])
        return EnclosedHits(
            features_within(self.flat, self.projection, outline),
            joined,
            modifiers,
            find_every=partial(self._finder.enclosed, self.projection, corners),
        )

    def position_under(self, position: QPointF) -> Floats:
        """(3,): the drawn point under a pixel, or what is at the distance looked at.

        Metres from the view's origin; what drags turn about and the wheel zooms to.
        """
        found = self._drawn_point(position)
        camera = self.projection.camera
        depth_m = camera.distance_m if found is None else found.depth_m
        return self.projection.position_at(position.x(), position.y(), depth_m)

    def _drawn_point(self, position: QPointF) -> FoundPoint | None:
        return self._finder.drawn(self.drawn, self.projection, position.x(), position.y())

    def _hit(self, found: FoundPoint | None, pixel: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        position = None if found is None else found.position
        mouse = pixel.x(), pixel.y()
        feature = feature_at(self.flat, self.projection, mouse, self.selected)
        camera = self.projection.camera
        depth_m = camera.distance_m if found is None else found.depth_m
        direction = self.projection.ray(*mouse)
        return Hit(
            position,
            feature.feature,
            feature.vertex,
            feature.segment,
            modifiers,
            reach_m=REACH_PX * self.projection.metres_per_px(depth_m),
            ray=Ray(
                _as_position(self.origin + self.projection.eye(*mouse)), _as_position(direction)
            ),
        )


def _as_position(values: Floats) -> tuple[float, float, float]:
    east, north, up = values.tolist()
    return east, north, up
