"""Crossing marks: where drawn lines pass through a section, and vertices within its slab."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from processing.core.arrays import Floats, Integers
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature
from processing.section.cut import Cut
from processing.section.profile import segment_crossings
from widgets.feature_drawing.crowded_marks import marks_to_paint
from widgets.feature_drawing.feature_style import style_of
from widgets.plane_view.projected_map import PlaneFeatures
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.projection import SectionProjection

_HALO = QColor("#0b0d10")
_WHITE = QColor("#ffffff")
_CROSSING_PX, _VERTEX_PX = 5.0, 7.0
_CHOSEN_MORE_PX = 1.5
_NAMED_PX = 9.0


@dataclass(frozen=True, eq=False)
class SectionMarks:
    """What a section shows of the map beside its lines.

    Attributes
    ----------
    features : PlaneFeatures
        What is drawn; owners are numbers of its shapes.
    crossings : (k, 2) float64
        In the plane of the section.
    crossing_owners : (k,) int64
    vertices : (m, 2) float64
        Of lines and areas, within the slab.
    vertex_owners : (m,) int64
    hollow : (m,) bool
        No point was measured at that vertex.
    """

    features: PlaneFeatures
    crossings: Floats
    crossing_owners: Integers
    vertices: Floats
    vertex_owners: Integers
    hollow: NDArray[np.bool_]

    def feature(self, owner: int) -> Feature:
        """The feature of a number."""
        return self.features.shapes[owner].shape.feature


@dataclass(frozen=True)
class NamedMark:
    """A mark under the mouse.

    Attributes
    ----------
    position : tuple of float
        In the plane of the section.
    """

    feature: str
    kind: str
    position: tuple[float, float]


def marks_of(features: PlaneFeatures, cut: Cut) -> SectionMarks:
    """The marks of what is drawn in a cut."""
    flat, projection = features.flat, SectionProjection(cut)
    section = cut.to_section(flat.local_xyz)
    numbers, passed = segment_crossings(section[flat.segments[:, 0]], section[flat.segments[:, 1]])
    inside = np.abs(passed[:, 0]) <= cut.half_length_m
    is_line = np.array([one.feature.geometry is not Geometry.POINT for one in flat.shapes], bool)
    vertices = np.flatnonzero(cut.holds(section) & is_line[flat.owners])
    owners = flat.owners[vertices]
    own = (vertices - flat.first_vertices[owners]).tolist()
    hollow = [
        flat.shapes[owner].feature.vertices[number].is_occluded
        for owner, number in zip(owners.tolist(), own, strict=True)
    ]
    on_plane = projection.on_plane(np.column_stack([passed, np.zeros(len(passed))]))
    return SectionMarks(
        features,
        on_plane[inside],
        flat.segment_owners[numbers[inside]],
        projection.on_plane(section[vertices]),
        owners,
        np.array(hollow, dtype=bool),
    )


def paint_marks(
    painter: QPainter,
    marks: SectionMarks,
    viewport: PlaneViewport,
    catalogue: Catalogue,
    selected: frozenset[str],
) -> None:
    """Paint discs where lines cross, and squares for vertices of what isn't chosen.

    Vertices of chosen features have their squares from the view itself.
    """
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    size = viewport.width, viewport.height
    spots = viewport.to_screen(marks.crossings)
    for number in marks_to_paint(spots, *size).tolist():
        feature = marks.feature(int(marks.crossing_owners[number]))
        _paint_disc(painter, spots[number], catalogue, feature, is_chosen=feature.id in selected)
    spots = viewport.to_screen(marks.vertices)
    for number in marks_to_paint(spots, *size).tolist():
        feature = marks.feature(int(marks.vertex_owners[number]))
        if feature.id not in selected:
            is_hollow = bool(marks.hollow[number])
            _paint_square(painter, spots[number], catalogue, feature, is_hollow=is_hollow)
    painter.setBrush(Qt.BrushStyle.NoBrush)


def mark_under(marks: SectionMarks, viewport: PlaneViewport, mouse: QPointF) -> NamedMark | None:
    """The mark nearest to the mouse within a few pixels."""
    positions = np.concatenate([marks.crossings, marks.vertices])
    if not len(positions):
        return None
    away = np.hypot(*(viewport.to_screen(positions) - np.array([mouse.x(), mouse.y()])).T)
    nearest = int(away.argmin())
    if away[nearest] > _NAMED_PX:
        return None
    owners = np.concatenate([marks.crossing_owners, marks.vertex_owners])
    feature = marks.feature(int(owners[nearest]))
    x, y = positions[nearest].tolist()
    return NamedMark(feature.id, feature.kind, (x, y))


def _paint_disc(
    painter: QPainter, spot: Floats, catalogue: Catalogue, feature: Feature, *, is_chosen: bool
) -> None:
    style = style_of(catalogue, feature, is_selected=is_chosen)
    middle, colour = QPointF(*spot.tolist()), QColor(style.colour)
    radius = _CROSSING_PX + (_CHOSEN_MORE_PX if is_chosen else 0.0)
    painter.setPen(QPen(_HALO, 3.5))
    painter.setBrush(Qt.BrushStyle.NoBrush if style.is_dashed else colour)
    painter.drawEllipse(middle, radius, radius)
    painter.setPen(QPen(_WHITE if is_chosen else colour, 2.0))
    painter.drawEllipse(middle, radius, radius)


def _paint_square(
    painter: QPainter, spot: Floats, catalogue: Catalogue, feature: Feature, *, is_hollow: bool
) -> None:
    colour = QColor(style_of(catalogue, feature, is_selected=False).colour)
    x, y = (spot - _VERTEX_PX / 2).tolist()
    box = QRectF(x, y, _VERTEX_PX, _VERTEX_PX)
    painter.setBrush(Qt.BrushStyle.NoBrush if is_hollow else colour)
    for pen in (QPen(_HALO, 3.5), QPen(colour if is_hollow else _WHITE, 1.25)):
        painter.setPen(pen)
        painter.drawRect(box)
