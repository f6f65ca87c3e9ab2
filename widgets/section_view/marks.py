"""Crossing marks: where drawn lines pass through a section, and vertices within its slab."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from processing.project.catalogue import Geometry
from processing.project.feature import Feature
from processing.section.cut import Cut
from processing.section.profile import plane_crossings
from processing.text import Language
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.lay import SectionLay
from widgets.shared.feature_style import FeatureStyle, style_of
from widgets.shared.map_source import MapSource

Floats = NDArray[np.float64]

_HALO = QColor("#0b0d10")
_CROSSING_PX, _VERTEX_PX = 5.0, 7.0
_NAMED_PX = 9.0


@dataclass(frozen=True, eq=False)
class SectionMark:
    """What a section shows of a feature beside its line.

    Attributes
    ----------
    feature : str
        Id.
    name : str
        Of its kind, for people.
    style : FeatureStyle
    crossings : (n, 2) float64
        In the plane of the section.
    vertices : (m, 2) float64
        Of those within the slab.
    hollow : (m,) bool
        No point was measured at that vertex.
    """

    feature: str
    name: str
    style: FeatureStyle
    crossings: Floats
    vertices: Floats
    hollow: NDArray[np.bool_]


def mark_of(
    source: MapSource, feature: Feature, cut: Cut, language: Language
) -> SectionMark | None:
    """The marks of a feature in a cut; None where it has none."""
    catalogue = source.catalogue()
    lay, places = SectionLay(cut), np.array([vertex.xyz for vertex in feature.vertices])
    section = cut.to_section(places)
    is_inside = cut.holds(section)
    line = section
    if feature.geometry is Geometry.AREA:
        line = np.concatenate([section, section[:1]])
    passed = plane_crossings(line) if len(line) > 1 else np.empty((0, 2))
    passed = passed[np.abs(passed[:, 0]) <= cut.half_length_m]
    if not (len(passed) or is_inside.any()):
        return None
    kind = feature.kind
    return SectionMark(
        feature.id,
        catalogue[kind].name.spoken(language) if kind in catalogue else kind,
        style_of(catalogue, feature, is_selected=False),
        lay.on_plane(np.column_stack([passed, np.zeros(len(passed))])),
        lay.on_plane(section[is_inside]),
        np.array([vertex.is_occluded for vertex in feature.vertices])[is_inside],
    )


def paint_marks(
    painter: QPainter,
    marks: tuple[SectionMark, ...],
    viewport: PlaneViewport,
    selected: frozenset[str],
) -> None:
    """Paint discs where lines cross, and squares for vertices of what isn't chosen.

    Vertices of chosen features have their squares from the view itself.
    """
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for mark in marks:
        is_chosen = mark.feature in selected
        colour = QColor(mark.style.colour)
        for x, y in viewport.to_screen(mark.crossings).tolist():
            radius = _CROSSING_PX + (1.5 if is_chosen else 0.0)
            painter.setPen(QPen(_HALO, 3.5))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(QPointF(x, y), radius, radius)
            painter.setPen(QPen(QColor("#ffffff") if is_chosen else colour, 2.0))
            painter.setBrush(Qt.BrushStyle.NoBrush if mark.style.is_dashed else colour)
            painter.drawEllipse(QPointF(x, y), radius, radius)
        if not is_chosen:
            _paint_squares(painter, mark, viewport, colour)
    painter.setBrush(Qt.BrushStyle.NoBrush)


def mark_under(
    marks: tuple[SectionMark, ...], viewport: PlaneViewport, mouse: QPointF
) -> tuple[SectionMark, tuple[float, float]] | None:
    """The mark nearest to the mouse within a few pixels, and its place in the plane."""
    best: tuple[float, SectionMark, tuple[float, float]] | None = None
    at = np.array([mouse.x(), mouse.y()])
    for mark in marks:
        places = np.concatenate([mark.crossings, mark.vertices])
        away = np.hypot(*(viewport.to_screen(places) - at).T)
        nearest = int(away.argmin())
        if away[nearest] <= _NAMED_PX and (best is None or away[nearest] < best[0]):
            x, y = places[nearest].tolist()
            best = float(away[nearest]), mark, (x, y)
    return None if best is None else best[1:]


def _paint_squares(
    painter: QPainter, mark: SectionMark, viewport: PlaneViewport, colour: QColor
) -> None:
    half = _VERTEX_PX / 2
    spots = viewport.to_screen(mark.vertices).tolist()
    for (x, y), is_hollow in zip(spots, mark.hollow.tolist(), strict=True):
        box = QRectF(x - half, y - half, _VERTEX_PX, _VERTEX_PX)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(_HALO, 3.5))
        painter.drawRect(box)
        painter.setPen(QPen(colour if is_hollow else QColor("#ffffff"), 1.25))
        painter.setBrush(Qt.BrushStyle.NoBrush if is_hollow else colour)
        painter.drawRect(box)
