"""FeaturePainter: the map's features in a plane view, in the same looks as in the image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from processing.core.arrays import Floats, Integers
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Status
from widgets.feature_drawing.feature_marks import FeatureMarks
from widgets.feature_drawing.feature_style import FeatureStyle, style_of
from widgets.plane_view.line_pieces import as_lines, clip_pieces, dash_pieces, thin_pieces
from widgets.plane_view.projected_map import PlaneFeatures, ProjectedShape
from widgets.plane_view.viewport import PlaneViewport

MARGIN_PX = 16.0
_MOST_SMOOTH = 4_000
"""More pieces than these are painted without smoothed edges."""
_THINNED_PX = {0: 0.0, 12_000: 1.0, 20_000: 2.0}
"""From so many pieces on, their ends lie on steps of so many pixels; the shortest are left out."""
_FILL_ALPHA = 34
_LEAST_FILL_PX = 3.0


@dataclass(frozen=True, eq=False)
class _Looks:
    """How the features are drawn: once for each choice, not once for each picture.

    Attributes
    ----------
    styles : list of FeatureStyle
        In the order in which they are painted.
    style_of : (features,) int64
        Into ``styles``.
    areas : list of (number of the style, ring on the plane)
    points : list of (number of the style, numbers of vertices)
    with_vertices : list of (number of the style, ProjectedShape)
    """

    styles: list[FeatureStyle]
    style_of: Integers
    areas: list[tuple[int, QPolygonF]]
    points: list[tuple[int, Integers]]
    with_vertices: list[tuple[int, ProjectedShape]]


class FeaturePainter:
    """Paints features; remembers the looks of those painted last."""

    def __init__(self) -> None:
        self._marks = FeatureMarks()
        self._looks: _Looks | None = None
        self._looks_of: tuple[PlaneFeatures, Catalogue, frozenset[str]] | None = None

    def paint(
        self,
        painter: QPainter,
        features: PlaneFeatures,
        viewport: PlaneViewport,
        catalogue: Catalogue,
        selected: frozenset[str],
    ) -> None:
        """Paint all features: areas, lines, points and the vertices of the chosen ones."""
        looks = self._looks_for(features, catalogue, selected)
        _paint_areas(painter, looks, viewport)
        _paint_lines(painter, features, looks, viewport)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        spots = viewport.to_screen(features.positions)
        spots[~features.is_near] = np.nan
        for number, vertices in looks.points:
            self._marks.paint(painter, spots[vertices], looks.styles[number], is_point=True)
        for number, one in looks.with_vertices:
            own = np.where(one.is_near[:, None], viewport.to_screen(one.positions), np.nan)
            hollow = np.array([vertex.is_occluded for vertex in one.shape.feature.vertices])
            self._marks.paint(painter, own, looks.styles[number], is_point=False, hollow=hollow)

    def _looks_for(
        self, features: PlaneFeatures, catalogue: Catalogue, selected: frozenset[str]
    ) -> _Looks:
        key = (features, catalogue, selected)
        known = self._looks_of
        if self._looks is None or known is None or not _is_same(known, key):
            self._looks, self._looks_of = _looks_of(*key), key
        return self._looks


def _is_same(
    one: tuple[PlaneFeatures, Catalogue, frozenset[str]],
    other: tuple[PlaneFeatures, Catalogue, frozenset[str]],
) -> bool:
    return one[0] is other[0] and one[1] is other[1] and one[2] == other[2]


def _looks_of(features: PlaneFeatures, catalogue: Catalogue, selected: frozenset[str]) -> _Looks:
    order: dict[FeatureStyle, tuple[bool, bool]] = {}
    alike: dict[tuple[str, Status, float, bool], FeatureStyle] = {}
    own_styles = []
    for one in features.shapes:
        feature = one.shape.feature
        is_selected = feature.id in selected
        key = feature.kind, feature.status, feature.provenance.confidence, is_selected
        style = alike.get(key)
        if style is None:
            style = alike[key] = style_of(catalogue, feature, is_selected=is_selected)
            order.setdefault(style, (is_selected, feature.status is not Status.REJECTED))
        own_styles.append(style)
    styles = sorted(order, key=lambda style: order[style])
    numbers = {style: number for number, style in enumerate(styles)}
    style_numbers = np.array([numbers[style] for style in own_styles], dtype=np.int64)
    areas, with_vertices = [], []
    points: dict[int, list[int]] = {}
    firsts = features.flat.first_vertices.tolist()
    for index, one in enumerate(features.shapes):
        number = int(style_numbers[index])
        geometry = one.shape.feature.geometry
        if geometry is Geometry.POINT:
            points.setdefault(number, []).append(firsts[index])
            continue
        if geometry is Geometry.AREA and one.is_whole:
            areas.append((number, one.ring))
        if styles[number].has_vertices:
            with_vertices.append((number, one))
    return _Looks(
        styles,
        style_numbers,
        areas,
        [(number, np.array(points[number], dtype=np.int64)) for number in sorted(points)],
        with_vertices,
    )


def _paint_areas(painter: QPainter, looks: _Looks, viewport: PlaneViewport) -> None:
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=False)
    window, seen = QRectF(0, 0, viewport.width, viewport.height), viewport.seen
    transform = viewport.transform()
    for number, ring in looks.areas:
        box = ring.boundingRect()
        if not box.intersects(seen):
            continue
        box = transform.mapRect(box)
        if min(box.width(), box.height()) < _LEAST_FILL_PX:
            continue
        shape = transform.map(ring)
        if not window.adjusted(-8e3, -8e3, 8e3, 8e3).contains(box):
            shape = shape.intersected(QPolygonF(window))  # Qt goes wrong beyond 32,767 px
        fill = QColor(looks.styles[number].colour)
        fill.setAlpha(_FILL_ALPHA)
        painter.setBrush(fill)
        painter.drawPolygon(shape)
    painter.setBrush(Qt.BrushStyle.NoBrush)


def _paint_lines(
    painter: QPainter, features: PlaneFeatures, looks: _Looks, viewport: PlaneViewport
) -> None:
    low = np.array([-MARGIN_PX, -MARGIN_PX])
    high = np.array([viewport.width + MARGIN_PX, viewport.height + MARGIN_PX])
    pixels = viewport.to_screen(features.pieces)
    pieces, numbers, starts = clip_pieces(pixels, low, high)
    styles = looks.style_of[features.piece_owners[numbers]]
    is_smooth = len(pieces) <= _MOST_SMOOTH
    step_px = max(step for count, step in _THINNED_PX.items() if len(pieces) >= count)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, is_smooth)
    begins = starts
    if any(style.is_dashed for style in looks.styles):
        begins = starts + _begins(pixels, features.piece_owners)[numbers]
    for number, style in enumerate(looks.styles):
        own = np.flatnonzero(styles == number)
        if own.size:
            dashes = dash_pieces(pieces[own], begins[own]) if style.is_dashed else None
            paint_pieces(painter, pieces[own], style, dashes, step_px=step_px)


def paint_pieces(
    painter: QPainter,
    pieces: Floats,
    style: FeatureStyle,
    dashes: Floats | None = None,
    *,
    step_px: float = 0.0,
) -> None:
    """Paint the pieces of lines: the dark halo below, then the line or its dashes.

    Parameters
    ----------
    pieces : (k, 2, 2) float64
        px, within the window.
    dashes : (d, 2, 2) float64 or None
    step_px : float
        Thin what is shorter; 0: nothing.
    """
    lines = as_lines(thin_pieces(pieces, step_px) if step_px else pieces)
    halo = style.halo_pen()
    halo.setCapStyle(Qt.PenCapStyle.SquareCap)
    painter.setPen(halo)
    painter.drawLines(lines)
    pen = QPen(QColor(style.colour), style.width_px)
    if dashes is not None:
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        lines = as_lines(thin_pieces(dashes, step_px) if step_px else dashes)
    painter.setPen(pen)
    painter.drawLines(lines)


def _begins(pixels: Floats, owners: Integers) -> Floats:
    """(k,) how far along its feature each piece begins, px."""
    lengths: Floats = np.nan_to_num(np.hypot(*(pixels[:, 1] - pixels[:, 0]).T))
    before = np.cumsum(lengths) - lengths
    if not len(owners):
        return before
    is_first = np.concatenate([[True], owners[1:] != owners[:-1]])
    first_of = np.flatnonzero(is_first)[np.cumsum(is_first) - 1]
    begins: Floats = before - before[first_of]
    return begins
