"""ProjectedMap: the map's features on the plane of a view, kept until they or the lay change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF
from PySide6.QtGui import QPolygonF

from processing.core.arrays import Floats, Integers
from widgets.feature_drawing.feature_shapes import (
    FeatureShape,
    FeatureShapes,
    FlatShapes,
    flatten_shapes,
)
from widgets.plane_view.projection import PlaneProjection
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


@dataclass(frozen=True, eq=False)
class ProjectedShape:
    """One feature on the plane.

    Attributes
    ----------
    positions : (n, 2) float64
        Of its vertices; NaN where they aren't shown.
    is_near : (n,) bool
        Which vertices are drawn at full strength and can be taken hold of.
    pieces : (k, 2, 2) float64
        Both ends of the straight pieces that its segments are made of.
    segments : (k,) int64
        Which of its segments each piece belongs to.
    """

    shape: FeatureShape
    positions: Floats
    is_near: NDArray[np.bool_]
    pieces: Floats
    segments: Integers

    @cached_property
    def is_whole(self) -> bool:
        """Whether no segment is missing: an area can be filled."""
        return len(np.unique(self.segments)) == len(self.shape.segments)

    @cached_property
    def ring(self) -> QPolygonF:
        """The outline of an area on the plane, where it is whole."""
        return QPolygonF(list(map(QPointF, *self.pieces[:, 0].T.tolist())))

    @cached_property
    def bounds(self) -> Floats | None:
        """(4,) left, top, right, bottom on the plane; None when nothing of it is there."""
        all_ = np.concatenate([self.positions, self.pieces.reshape(-1, 2)])
        all_ = all_[np.isfinite(all_).all(axis=1)]
        return np.concatenate([all_.min(axis=0), all_.max(axis=0)]) if len(all_) else None


@dataclass(frozen=True, eq=False)
class PlaneFeatures:
    """The features that are drawn, as a few long arrays.

    Attributes
    ----------
    shapes : tuple of ProjectedShape
    flat : FlatShapes
        The same features in space.
    positions : (n, 2) float64
        On the plane, in the order of ``flat``.
    is_near : (n,) bool
    pieces : (k, 2, 2) float64
    piece_numbers : (k,) int64
        The segment of ``flat`` that each piece is a part of.
    piece_owners : (k,) int64
        The feature that each piece is a part of.
    """

    shapes: tuple[ProjectedShape, ...]
    flat: FlatShapes
    positions: Floats
    is_near: NDArray[np.bool_]
    pieces: Floats
    piece_numbers: Integers
    piece_owners: Integers


class ProjectedMap:
    """Reads features from the document and projects those that are new since it was asked last.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    """

    def __init__(self, source: MapSource, shared: SharedState) -> None:
        self._source = source
        self._shared = shared
        self._shapes = FeatureShapes(np.zeros(3), ())
        self._projection: PlaneProjection | None = None
        self._projected: dict[str, ProjectedShape] = {}
        self._joined: PlaneFeatures | None = None
        self._replaced = ""

    def read_all(self) -> None:
        """Take over all features."""
        self._shapes = FeatureShapes(np.zeros(3), self._source.features())
        self._projected.clear()
        self._joined = None

    def read(self, ids: Iterable[str]) -> None:
        """Take over these features as they are now."""
        for id_ in ids:
            self._shapes.replace(id_, self._source.feature(id_))
            self._projected.pop(id_, None)
        self._joined = None

    def show_others(self) -> None:
        """Choose anew what is drawn: the settings are others."""
        self._joined = None

    def drawn(self, projection: PlaneProjection, box: Floats | None = None) -> PlaneFeatures:
        """What is drawn now, on this lay, but for the feature that is being edited.

        Parameters
        ----------
        box : (2, 3) float64 or None
            Features wholly outside it are nowhere in the picture; m, project CRS.
        """
        drawing = self._shared.sketch.drawing
        replaced = "" if drawing is None else drawing.replaces
        if projection is not self._projection:
            self._projection = projection
            self._projected.clear()
            self._joined = None
        if self._joined is None or replaced != self._replaced:
            self._replaced = replaced
            shapes = self._shapes.seen(self._shared.view_settings.shows, replaced)
            if box is not None:
                shapes = tuple(shape for shape in shapes if _touches(shape, box))
            self._joined = self._join(projection, shapes)
        return self._joined

    def get(self, projection: PlaneProjection, id_: str) -> ProjectedShape | None:
        """One feature, whether it is drawn or not; None when there is none of that id."""
        shape = self._shapes.get(id_)
        return None if shape is None else self._of(projection, (shape,))[0]

    def _join(self, projection: PlaneProjection, shapes: tuple[FeatureShape, ...]) -> PlaneFeatures:
        projected = self._of(projection, shapes)
        flat = flatten_shapes(shapes)
        counts = np.array([len(one.pieces) for one in projected], dtype=np.int64)
        firsts = np.cumsum([0, *(len(shape.segments) for shape in shapes)])[:-1]
        return PlaneFeatures(
            shapes=tuple(projected),
            flat=flat,
            positions=np.concatenate([np.empty((0, 2)), *(one.positions for one in projected)]),
            is_near=np.concatenate([np.empty(0, bool), *(one.is_near for one in projected)]),
            pieces=np.concatenate([np.empty((0, 2, 2)), *(one.pieces for one in projected)]),
            piece_numbers=np.concatenate(
                [
                    np.empty(0, np.int64),
                    *(one.segments + first for one, first in zip(projected, firsts, strict=True)),
                ]
            ).astype(np.int64),
            piece_owners=np.repeat(np.arange(len(projected)), counts),
        )

    def _of(
        self, projection: PlaneProjection, shapes: Sequence[FeatureShape]
    ) -> list[ProjectedShape]:
        lacking = tuple(
            shape
            for shape in shapes
            if shape.feature.id not in self._projected or projection is not self._projection
        )
        made = {one.shape.feature.id: one for one in _project_shapes(projection, lacking)}
        if projection is self._projection:
            self._projected.update(made)
        return [made.get(one.feature.id) or self._projected[one.feature.id] for one in shapes]


def pieces_of(projection: PlaneProjection, xyz: Floats, ends: Integers) -> tuple[Floats, Integers]:
    """Segments as straight pieces of the plane.

    Returns
    -------
    pieces : (k, 2, 2) float64
    numbers : (k,) int64
        The segment that each is a part of, rising.
    """
    lines = projection.lines_on_plane(xyz, ends) if len(ends) else []
    counts = np.array([len(line) for line in lines], dtype=np.int64)
    positions = np.concatenate([np.empty((0, 2)), *lines])
    line_of = np.repeat(np.arange(len(lines)), counts)
    goes_on = np.flatnonzero(line_of[1:] == line_of[:-1])
    pieces = np.stack([positions[goes_on], positions[goes_on + 1]], axis=1)
    return pieces, line_of[goes_on]


def _project_shapes(
    projection: PlaneProjection, shapes: tuple[FeatureShape, ...]
) -> list[ProjectedShape]:
    """All of them in one call of the lay."""
    if not shapes:
        return []
    flat = flatten_shapes(shapes)
    positions, is_near = projection.to_plane(flat.local_xyz), projection.is_near(flat.local_xyz)
    pieces, numbers = pieces_of(projection, flat.local_xyz, flat.segments)
    numbers_of = np.arange(len(shapes) + 1)
    vertex_cuts = np.searchsorted(flat.owners, numbers_of)
    piece_cuts = np.searchsorted(flat.segment_owners[numbers], numbers_of)
    segment_cuts = np.searchsorted(flat.segment_owners, numbers_of)
    made = []
    for index, shape in enumerate(shapes):
        vertices = slice(vertex_cuts[index], vertex_cuts[index + 1])
        own = slice(piece_cuts[index], piece_cuts[index + 1])
        segments = numbers[own] - segment_cuts[index]
        made.append(
            ProjectedShape(shape, positions[vertices], is_near[vertices], pieces[own], segments)
        )
    return made


def _touches(shape: FeatureShape, box: Floats) -> bool:
    low, high = shape.bounds
    return bool((low <= box[1]).all() and (high >= box[0]).all())
