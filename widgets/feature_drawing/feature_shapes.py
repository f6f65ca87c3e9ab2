"""FeatureShapes: the map's features as places about a local origin, ready to project."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex


@dataclass(frozen=True)
class FeatureShape:
    """A feature and its vertices.

    Attributes
    ----------
    local_xyz : (n, 3) float64
        Metres from the view's origin.
    """

    feature: Feature
    local_xyz: Floats

    @cached_property
    def segments(self) -> Integers:
        """(m, 2): vertices at both ends; an area's last one leads back to its first vertex."""
        return segments_of(self.feature.geometry, len(self.local_xyz))

    @cached_property
    def bounds(self) -> Floats:
        """(2, 3): lowest and highest of the vertices; infinite without any."""
        if not len(self.local_xyz):
            return np.array([[np.inf] * 3, [-np.inf] * 3])
        return np.stack([self.local_xyz.min(axis=0), self.local_xyz.max(axis=0)])


@dataclass(frozen=True)
class FlatShapes:
    """All vertices and segments of some features, one after the other.

    Attributes
    ----------
    local_xyz : (n, 3) float64
    owners : (n,) int64
        Number of the feature that each vertex belongs to.
    first_vertices : (features,) int64
    segments : (m, 2) int64
        Into ``local_xyz``.
    segment_owners : (m,) int64
    """

    shapes: tuple[FeatureShape, ...]
    local_xyz: Floats
    owners: Integers
    first_vertices: Integers
    segments: Integers
    segment_owners: Integers


class FeatureShapes:
    """The features of the document; some are replaced when they change.

    Parameters
    ----------
    origin : (3,) float64
        The view's local origin, m, project CRS; subtracted in float64.
    """

    def __init__(self, origin: Floats, features: Iterable[Feature]) -> None:
        self._origin = origin
        self._shapes = {feature.id: self._shape(feature) for feature in features}

    def replace(self, id_: str, feature: Feature | None) -> None:
        """Take over one feature as it is now; None when it is no more."""
        if feature is None:
            self._shapes.pop(id_, None)
        else:
            self._shapes[id_] = self._shape(feature)

    def get(self, id_: str) -> FeatureShape | None:
        """One feature, or None."""
        return self._shapes.get(id_)

    def seen(
        self, shows: Callable[[Feature], bool], replaced: str = ""
    ) -> tuple[FeatureShape, ...]:
        """Those that are drawn: all that the settings show but the one that is being edited."""
        return tuple(
            shape for id_, shape in self._shapes.items() if id_ != replaced and shows(shape.feature)
        )

    def _shape(self, feature: Feature) -> FeatureShape:
        return FeatureShape(feature, local_positions(feature.vertices, self._origin))


def local_positions(vertices: Iterable[Vertex], origin: Floats) -> Floats:
    """(n, 3) float64: vertices in metres from the view's origin."""
    xyz = np.array([vertex.xyz for vertex in vertices], dtype=np.float64).reshape(-1, 3)
    local_xyz: Floats = xyz - origin
    return local_xyz


def segments_of(geometry: Geometry, count: int) -> Integers:
    """(m, 2): which of ``count`` vertices are joined."""
    first = np.arange(max(count - 1, 0), dtype=np.int64)
    if geometry is Geometry.POINT:
        first = first[:0]
    segments = np.column_stack([first, first + 1])
    if geometry is Geometry.AREA and count > 2:
        segments = np.vstack([segments, [[count - 1, 0]]])
    return segments


def flatten_shapes(shapes: tuple[FeatureShape, ...]) -> FlatShapes:
    """Some features as a few long arrays."""
    counts = np.array([len(shape.local_xyz) for shape in shapes], dtype=np.int64)
    starts = np.cumsum(counts) - counts
    segments = [shape.segments for shape in shapes]
    return FlatShapes(
        shapes=shapes,
        local_xyz=np.concatenate([np.empty((0, 3)), *(shape.local_xyz for shape in shapes)]),
        owners=np.repeat(np.arange(len(shapes)), counts),
        first_vertices=starts,
        segments=np.concatenate(
            [
                np.empty((0, 2), np.int64),
                *(ends + start for ends, start in zip(segments, starts, strict=True)),
            ]
        ),
        segment_owners=np.repeat(np.arange(len(shapes)), [len(ends) for ends in segments]).astype(
            np.int64
        ),
    )
