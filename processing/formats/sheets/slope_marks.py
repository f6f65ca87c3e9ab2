"""Hachures of slopes (ケバ): long and short ones by turns, from a slope's top towards its foot.

References
----------
公共測量標準図式, 6101 人工斜面: long ones as long as the slope is wide in plan, short ones half of
it, half of the width apart; at most 10.0 mm on paper; slopes narrower than 0.5 mm have none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.map_looks import map_pen
from processing.formats.sheets.paper_shapes import PaperLine, Pen
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature, Status

TOP_KIND, FOOT_KIND = "slope_top", "slope_foot"

_LONGEST_MM, _NARROWEST_MM = 10.0, 0.5
_REACH_MM = 60.0
"""A foot farther from the top is another slope's: 30 m at 1:500."""
_CLOSEST_MM = 1.0  # closer lines run together in print


def slope_shapes(
    features: Sequence[Feature], catalogue: Catalogue, sheet: DrawingSheet, layout: SheetLayout
) -> Iterator[PaperLine]:
    """The hachures of a sheet's slopes, whose features were cut at its window.

    They lie on the side on which the foot is; a top without one has none.
    """
    feet = [_on_paper(one, sheet, layout) for one in features if one.kind == FOOT_KIND]
    if not feet:
        return
    tree = shapely.STRtree([shapely.LineString(one) for one in feet])
    for feature in features:
        if feature.kind == TOP_KIND:
            kind = catalogue[feature.kind]
            looks = map_pen(kind, is_candidate=feature.status is Status.CANDIDATE)
            pen = Pen(looks.layer, looks.colour, looks.width_mm)
            yield from _marks(_on_paper(feature, sheet, layout), tree, pen)


def _on_paper(feature: Feature, sheet: DrawingSheet, layout: SheetLayout) -> Floats:
    places = np.array([vertex.xyz[:2] for vertex in feature.vertices])
    return sheet.on_paper(places, layout)


def _marks(top: Floats, feet: shapely.STRtree, pen: Pen) -> Iterator[PaperLine]:
    """Along a top from its start, as far apart as the slope is wide there."""
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(top, axis=0).T))])
    along, is_long = 0.0, True
    while along <= reached[-1]:
        side = min(int(np.searchsorted(reached, along, side="right")), len(top) - 1)
        way = top[side] - top[side - 1]
        length = float(np.hypot(*way))
        if not length:
            along += _CLOSEST_MM
            continue
        way /= length
        start = top[side - 1] + way * (along - reached[side - 1])
        found = _width(start, np.array([way[1], -way[0]]), feet)
        if found is None:
            along += _CLOSEST_MM
            continue
        down, width = found
        end = start + down * min(width, _LONGEST_MM) * (1.0 if is_long else 0.5)
        (x, y), (to_x, to_y) = start.tolist(), end.tolist()
        yield PaperLine(pen, ((x, y), (to_x, to_y)))
        is_long = not is_long
        along += max(min(width, _LONGEST_MM) / 2, _CLOSEST_MM)


def _width(start: Floats, right: Floats, feet: shapely.STRtree) -> tuple[Floats, float] | None:
    """Which way the foot lies and how far, mm; the right side, which is the low one, goes first."""
    for down in (right, -right):
        ray = shapely.LineString([start, start + down * _REACH_MM])
        crossed = feet.query(ray, predicate="intersects")
        if crossed.size:
            common = shapely.intersection(feet.geometries[crossed], ray)
            away = np.hypot(*(shapely.get_coordinates(common) - start).T)
            width = float(away.min())
            return (down, width) if width >= _NARROWEST_MM else None
    return None
