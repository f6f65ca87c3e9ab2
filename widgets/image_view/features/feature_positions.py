"""FeaturePositions: all features of the map in picture coordinates, kept until they change."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.search.nearest import NearestSearch, nearest_point, nearest_points
from processing.map.feature import Feature, Vertex
from widgets.feature_drawing.own_point_marks import MOST_FEATURES, points_in
from widgets.image_view.features.picture_feature import PictureFeature, join_vertices
from widgets.image_view.features.waiting_features import WaitingFeatures
from widgets.image_view.orientation.oriented_image import OrientedImage, Span
from widgets.shared.map_source import MapSource

NEAR_M = 0.3
"""How far a vertex may be from the measured point that stands for it in another drive."""

_UNKNOWN = -2
_SEARCHED_AT_ONCE = 4_096
_MOST_SEARCHED = 100_000


@dataclass(frozen=True)
class _Batch:
    """Features whose unknown vertices are searched together, and those vertices."""

    features: list[Feature]
    vertices: list[Vertex]
    search: NearestSearch


class FeaturePositions:
    """Looks up the measured points of vertices once and places them in the picture shown.

    A vertex that rests on a point of the drive shown is placed at once. For others the nearest
    point is searched, which takes time: :meth:`search` does as much as a moment allows.

    Parameters
    ----------
    source : MapSource
    """

    def __init__(self, source: MapSource) -> None:
        self._source = source
        self._picture: OrientedImage | None = None
        self._features: dict[str, Feature] = {}
        self._points: dict[tuple[str, str], NDArray[np.int64]] = {}
        self._placed: dict[str, PictureFeature] = {}
        self._waiting = WaitingFeatures()
        self._bounds: Floats | None = None
        self._ids: list[str] = []
        self._searched: dict[tuple[str, Vertex], int] = {}
        self._batch: _Batch | None = None
        self._own: dict[str, tuple[Feature, Floats]] = {}

    @property
    def is_searching(self) -> bool:
        """Whether vertices wait for their nearest point."""
        return bool(self._waiting) or self._batch is not None

    def show(self, picture: OrientedImage | None) -> None:
        """Place everything in another picture."""
        self._picture, self._batch = picture, None
        self._own.clear()
        self._position(self._features.values())

    def read_all(self) -> None:
        """Read all features anew, when another project is open."""
        self._batch = None
        self._points.clear()
        self._own.clear()
        self._features = {feature.id: feature for feature in self._source.features()}
        self._placed.clear()
        self._position(self._features.values())

    def read(self, ids: Iterable[str]) -> None:
        """Read the features that were added, replaced or removed."""
        changed = []
        for id_ in ids:
            for key in [key for key in self._points if key[1] == id_]:
                del self._points[key]
            feature = self._source.feature(id_)
            if feature is None:
                self._features.pop(id_, None)
                self._placed.pop(id_, None)
            else:
                self._features[id_] = feature
                changed.append(feature)
        self._bounds = None
        self._position(changed)

    def get(self, id_: str) -> PictureFeature | None:
        """A feature in the picture; None when it isn't there."""
        return self._placed.get(id_)

    def span_of(self, ids: Iterable[str]) -> Span | None:
        """The smallest rectangle that holds features; None when none of them is in the picture."""
        found = [self._placed[id_].bounds for id_ in ids if id_ in self._placed]
        bounds = np.array(found).reshape(-1, 4)
        bounds = bounds[np.isfinite(bounds[:, 0])]
        if not bounds.size:
            return None
        left, top = bounds[:, :2].min(axis=0).tolist()
        right, bottom = bounds[:, 2:].max(axis=0).tolist()
        return Span(left, top, right, bottom)

    def within(self, span: Span) -> Iterator[PictureFeature]:
        """Features whose bounds touch a rectangle."""
        if self._bounds is None:
            self._ids = list(self._placed)
            self._bounds = np.array([one.bounds for one in self._placed.values()]).reshape(-1, 4)
        bounds = self._bounds
        touches = (
            (bounds[:, 0] <= span.right)
            & (bounds[:, 2] >= span.left)
            & (bounds[:, 1] <= span.bottom)
            & (bounds[:, 3] >= span.top)
        )
        return (self._placed[self._ids[index]] for index in np.flatnonzero(touches))

    def places_of(self, vertices: tuple[Vertex, ...]) -> Floats:
        """(n, 2) places of a few vertices, searched at once; NaN for those without."""
        picture = self._picture
        if picture is None:
            return np.full((len(vertices), 2), np.nan)
        points = _own_points(picture, vertices)
        for index in np.flatnonzero(points == _UNKNOWN):
            points[index] = self._point_for(picture, vertices[index])
        return _positions(picture, points)

    def own_places(self, feature: Feature) -> Floats:
        """(n, 2) places of the measured points that a chosen feature consists of, in this drive."""
        picture = self._picture
        if picture is None:
            return np.empty((0, 2))
        known = self._own.get(feature.id)
        if known is None or known[0] is not feature:
            known = feature, _positions(picture, points_in(picture.drive, feature))
            if len(self._own) > MOST_FEATURES:
                self._own.clear()
            self._own[feature.id] = known
        return known[1]

    def search(self, for_s: float, near: tuple[float, float]) -> bool:
        """Search nearest points for a while; says whether any feature got its place.

        Parameters
        ----------
        near : tuple of float
            Easting and northing; features near it come first.
        """
        picture, until = self._picture, time.perf_counter() + for_s
        if picture is None:
            return False
        has_found = False
        while time.perf_counter() < until:
            if self._batch is None:
                self._batch = self._next_batch(picture, near)
            if self._batch is None:
                break
            if not self._batch.search.step():
                self._take(picture, self._batch)
                self._batch, has_found = None, True
        return has_found

    def _next_batch(self, picture: OrientedImage, near: tuple[float, float]) -> _Batch | None:
        """The features that wait next to a place, as many as are searched together."""
        features: list[Feature] = []
        vertices: dict[Vertex, None] = {}
        while len(vertices) < _SEARCHED_AT_ONCE:
            feature = self._features.get(self._waiting.next_to(near))
            if not self._waiting.done():
                break
            points = None if feature is None else self._points.get((picture.drive.id, feature.id))
            if feature is not None and points is not None:
                features.append(feature)
                unknown = np.flatnonzero(points == _UNKNOWN)
                vertices.update(dict.fromkeys(feature.vertices[index] for index in unknown))
        if not features:
            return None
        new = [one for one in vertices if (picture.drive.id, one) not in self._searched]
        xyz = np.array([one.xyz for one in new]).reshape(-1, 3)
        return _Batch(features, new, nearest_points(picture.drive, xyz, NEAR_M))

    def _take(self, picture: OrientedImage, batch: _Batch) -> None:
        """Place the features of a batch; those that have changed meanwhile wait again anyway."""
        self._remember(picture, batch.vertices, batch.search)
        known = [one for one in batch.features if self._features.get(one.id) is one]
        for feature in known:
            points = self._points[picture.drive.id, feature.id]
            for index in np.flatnonzero(points == _UNKNOWN):
                points[index] = self._point_for(picture, feature.vertices[index])
        self._position_known(picture, known)

    def _remember(
        self, picture: OrientedImage, vertices: list[Vertex], search: NearestSearch
    ) -> None:
        if len(self._searched) > _MOST_SEARCHED:
            self._searched.clear()
        for vertex, point in zip(vertices, search.points.tolist(), strict=True):
            self._searched[picture.drive.id, vertex] = point

    def _point_for(self, picture: OrientedImage, vertex: Vertex) -> int:
        """The nearest point, remembered: what was searched to be shown is dragged at once."""
        key = (picture.drive.id, vertex)
        if key not in self._searched:
            if len(self._searched) > _MOST_SEARCHED:
                self._searched.clear()
            self._searched[key] = nearest_point(picture.drive, np.array(vertex.xyz), NEAR_M)
        return self._searched[key]

    def _position(self, features: Iterable[Feature]) -> None:
        picture = self._picture
        self._bounds = None
        if picture is None:
            self._placed.clear()
            self._waiting.clear()
            return
        known = []
        for feature in features:
            key = (picture.drive.id, feature.id)
            if key not in self._points:
                self._points[key] = _own_points(picture, feature.vertices)
            if (self._points[key] == _UNKNOWN).any():
                self._waiting.add(feature)
            known.append(feature)
        self._position_known(picture, known)

    def _position_known(self, picture: OrientedImage, features: list[Feature]) -> None:
        if not features:
            return
        self._bounds = None
        points = [self._points[picture.drive.id, feature.id] for feature in features]
        positions = _positions(picture, np.concatenate(points))
        ends = np.cumsum([one.size for one in points])
        for feature, own in zip(features, np.split(positions, ends[:-1]), strict=True):
            self._placed[feature.id] = join_vertices(feature, own, picture)


def _own_points(picture: OrientedImage, vertices: tuple[Vertex, ...]) -> NDArray[np.int64]:
    """(n,) points of the drive on which vertices rest; unknown for the others."""
    drive = picture.drive
    return np.array(
        [
            vertex.measured.point
            if vertex.measured is not None
            and vertex.measured.drive == drive.id
            and 0 <= vertex.measured.point < drive.count
            else _UNKNOWN
            for vertex in vertices
        ],
        dtype=np.int64,
    )


def _positions(picture: OrientedImage, points: NDArray[np.int64]) -> Floats:
    positions = np.full((points.size, 2), np.nan)
    is_known = points >= 0
    if is_known.any():
        rows, columns = picture.image.pixel_of(points[is_known])
        own = picture.positions(rows, columns.astype(np.int64))
        own[rows < 0] = np.nan
        positions[is_known] = own
    return positions
