"""Features as they look on paper: lines with their pens and dashes, symbols at their size."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from processing.formats.drawings.dxf import CANDIDATE_SUFFIX
from processing.formats.drawings.sxf_looks import pen_mm_of
from processing.formats.drawings.symbol_shapes import symbol_rotation_deg, symbol_shapes
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.paper_shapes import (
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    Pen,
)
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.map.catalogue import LINE_TYPES, Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature, Status

LEVEL_SCALE = 500
"""Symbols and patterns of the catalogue are metres on the ground at this scale."""

_MM_OF_M = 1000.0 / LEVEL_SCALE
_POINT_MM = 0.5
_LUMA = (0.299, 0.587, 0.114)  # ITU-R BT.601
_LIGHTEST = 150.0


def map_pen(kind: FeatureKind, *, is_candidate: bool = False) -> Pen:
    """Layer, colour, pen and dashes of a kind's lines."""
    value = int(kind.colour[1:], 16)
    rgb = _legible((value >> 16, value >> 8 & 255, value & 255))
    dashes = tuple(abs(part) * _MM_OF_M for part in LINE_TYPES.get(kind.line_type, ()))
    layer = kind.layer + (CANDIDATE_SUFFIX if is_candidate else "")
    return Pen(layer, rgb, pen_mm_of(kind), dashes, kind.line_type)


def _legible(rgb: tuple[int, int, int]) -> tuple[int, int, int]:
    """A colour dark enough for thin lines on white paper: yellow of a screen is not."""
    luma = sum(part * share for part, share in zip(rgb, _LUMA, strict=True))
    if luma <= _LIGHTEST:
        return rgb
    red, green, blue = (int(part * _LIGHTEST / luma) for part in rgb)
    return red, green, blue


def map_shapes(
    features: Sequence[Feature], catalogue: Catalogue, sheet: DrawingSheet, layout: SheetLayout
) -> Iterator[PaperShape]:
    """What a sheet shows of the map: features already cut at its window."""
    for feature in features:
        kind = catalogue[feature.kind]
        pen = map_pen(kind, is_candidate=feature.status is Status.CANDIDATE)
        places = np.array([vertex.xyz[:2] for vertex in feature.vertices])
        placed = [(x, y) for x, y in sheet.on_paper(places, layout).tolist()]
        if feature.geometry is Geometry.POINT:
            turned = symbol_rotation_deg(feature) - sheet.turned_deg
            yield from symbol_on_paper(kind, pen, placed[0], turned)
        else:
            around = placed[:1] if feature.geometry is Geometry.AREA else []
            yield PaperLine(pen, (*placed, *around))


def symbol_on_paper(
    kind: FeatureKind, pen: Pen, place: PaperPlace, turned_deg: float = 0.0
) -> Iterable[PaperShape]:
    """The symbol of a point at a place; a ring for a kind without one."""
    solid = Pen(pen.layer, pen.colour, pen.width_mm)
    if not kind.symbol:
        yield PaperCircle(solid, place, _POINT_MM)
        return
    cos, sin = math.cos(math.radians(turned_deg)), math.sin(math.radians(turned_deg))
    for shape in symbol_shapes(kind.symbol):
        points = tuple(
            (
                place[0] + (x * cos - y * sin) * _MM_OF_M,
                place[1] + (x * sin + y * cos) * _MM_OF_M,
            )
            for x, y in shape.points
        )
        if shape.radius:
            yield PaperCircle(solid, points[0], shape.radius * _MM_OF_M)
        else:
            yield PaperLine(solid, (*points, points[0]) if shape.is_closed else points)


def symbol_reach_mm(kind: FeatureKind) -> float:
    """How far a kind's symbol reaches from its place, mm on paper."""
    if not kind.symbol:
        return _POINT_MM
    reaches = (
        math.hypot(*point) + shape.radius
        for shape in symbol_shapes(kind.symbol)
        for point in shape.points
    )
    return max(reaches, default=0.0) * _MM_OF_M
