"""Names, numbers and heights on a sheet, placed so that none covers another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from processing.formats.drawings.dxf_labels import label_of
from processing.formats.drawings.sxf_looks import label_layer
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.label_places import SheetLabel, place_labels
from processing.formats.sheets.map_looks import map_pen, symbol_reach_mm
from processing.formats.sheets.paper_shapes import PaperWords, Pen
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature

_HEIGHTS_MM = {"30": 3.0, "811": 4.5}
"""Of names of buildings and places, by their code's beginning (公共測量標準図式, 注記)."""
_HEIGHT_MM = 2.0


@dataclass(frozen=True)
class UnplacedLabel:
    """Words for which a sheet has no room.

    Attributes
    ----------
    sheet : int
        From 1.
    place : (float, float)
        Easting and northing of the feature there, m.
    """

    sheet: int
    feature: Feature
    words: str
    place: tuple[float, float]


@dataclass(frozen=True)
class SheetLabels:
    """The words of a sheet's map, and the features whose words have no room there."""

    placed: tuple[PaperWords, ...]
    unplaced: tuple[UnplacedLabel, ...]


def label_sheet(
    number: int,
    features: Sequence[Feature],
    catalogue: Catalogue,
    sheet: DrawingSheet,
    layout: SheetLayout,
) -> SheetLabels:
    """Place the words of features that were cut at a sheet's window.

    A line that the window cuts into parts is named once, at the longest.
    """
    shapes = [_on_paper(feature, sheet, layout) for feature in features]
    longest: dict[str, int] = {}
    for at, feature in enumerate(features):
        if feature.id not in longest or shapes[at].length > shapes[longest[feature.id]].length:
            longest[feature.id] = at
    chosen, labels = [], []
    for at in longest.values():
        kind = catalogue[features[at].kind]
        label = label_of(kind, features[at])
        if label is not None:
            chosen.append(at)
            labels.append(_label(features[at], kind, label.words, shapes[at]))
    (x, y), (width, height) = layout.window_low, layout.window_size
    symbols = [
        shape.buffer(symbol_reach_mm(catalogue[feature.kind]), quad_segs=4)
        for feature, shape in zip(features, shapes, strict=True)
        if shape.geom_type == "Point"
    ]
    lines = [
        shapely.boundary(one) if one.geom_type == "Polygon" else one
        for one in shapes
        if one.geom_type != "Point"
    ]
    lines += [
        shapely.LineString(sheet.on_paper(np.array([one.start, one.end]), layout))
        for one in sheet.matches
    ]
    window = shapely.box(x, y, x + width, y + height)
    places = place_labels(labels, window, lines, symbols)
    placed, unplaced = [], []
    for at, wanted, place in zip(chosen, labels, places, strict=True):
        feature = features[at]
        if place is None:
            east, north, _ = feature.vertices[0].xyz
            unplaced.append(UnplacedLabel(number, feature, wanted.words, (east, north)))
            continue
        pen = map_pen(catalogue[feature.kind])
        words = Pen(label_layer(pen.layer), pen.colour)
        placed.append(PaperWords(
            words, wanted.words, place.middle, wanted.height, "CENTER", place.angle_deg
        ))  # fmt: skip
    return SheetLabels(tuple(placed), tuple(unplaced))


def _label(feature: Feature, kind: FeatureKind, words: str, shape: shapely.Geometry) -> SheetLabel:
    begins = (code for code in _HEIGHTS_MM if kind.dm_code.startswith(code))
    height = next((_HEIGHTS_MM[code] for code in begins), _HEIGHT_MM)
    reach = symbol_reach_mm(kind) if feature.geometry is Geometry.POINT else 0.0
    return SheetLabel(feature.id, " ".join(words.split()), height, shape, reach)


def _on_paper(feature: Feature, sheet: DrawingSheet, layout: SheetLayout) -> shapely.Geometry:
    places = sheet.on_paper(np.array([vertex.xyz[:2] for vertex in feature.vertices]), layout)
    if feature.geometry is Geometry.POINT or len(np.unique(places, axis=0)) < 2:
        return shapely.Point(places[0])
    if feature.geometry is Geometry.AREA and len(places) > 2:
        area = shapely.Polygon(places)
        return area if area.is_valid and area.area else shapely.LineString(places)
    return shapely.LineString(places)
