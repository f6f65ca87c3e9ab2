"""What surrounds and crosses the map on a sheet: frame, grid with coordinates, match lines."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import shapely

from processing.core.text import Language, Text
from processing.formats.sheets.drawing_sheet import DrawingSheet, MatchLine
from processing.formats.sheets.paper_layers import (
    BORDER,
    GRID_CROSSES,
    GRID_TICKS,
    GRID_WORDS,
    MATCH_LINE,
    MATCH_WORDS,
    WINDOW,
)
from processing.formats.sheets.paper_shapes import (
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
    Pen,
    box_line,
    words_width,
)
from processing.formats.sheets.sheet_layout import SheetLayout

GRID_MM = 100.0
"""Between the grid's lines: 50 m at 1:500."""

_ARM_MM = 5.0
_TICK_MM = 3.0
_WORDS_MM = 2.0
_AWAY_MM = 2.2
"""Middle of a coordinate's letters from the window's edge."""
_FRAME_PEN, _WINDOW_PEN = Pen(BORDER, width_mm=0.7), Pen(WINDOW, width_mm=0.35)
_CROSS_PEN, _TICK_PEN = Pen(GRID_CROSSES, width_mm=0.13), Pen(GRID_TICKS, width_mm=0.13)
_MATCH_PEN = Pen(MATCH_LINE, (200, 0, 0), 0.35, (4.0, 1.0, 0.5, 1.0), "dash_dot")


def frame_shapes(
    sheet: DrawingSheet, layout: SheetLayout, language: Language
) -> Iterator[PaperShape]:
    """The frame around everything and all that has its place on the map."""
    yield from border_shapes(layout)
    yield from _grid(sheet, layout)
    for match in sheet.matches:
        yield from _match(sheet, layout, language, match)


def border_shapes(layout: SheetLayout) -> Iterator[PaperShape]:
    """The frames around everything, the window and the column beside it."""
    yield box_line(_FRAME_PEN, layout.frame_low, layout.frame_size)
    yield box_line(_WINDOW_PEN, layout.window_low, layout.window_size)
    yield box_line(_WINDOW_PEN, layout.column_low, layout.column_size)


def _grid(sheet: DrawingSheet, layout: SheetLayout) -> Iterator[PaperShape]:
    """Crosses where the grid's lines meet; ticks and coordinates where they leave the window."""
    step = GRID_MM * sheet.scale / 1000
    window = sheet.window
    west, south, east, north = window.bounds
    eastings, northings = _multiples(west, east, step), _multiples(south, north, step)
    shapely.prepare(window)
    arm = _ARM_MM * sheet.scale / 1000
    for x in eastings:
        for y in northings:
            if window.contains(shapely.Point(x, y)):
                for dx, dy in ((arm, 0.0), (0.0, arm)):
                    cross = shapely.LineString([(x - dx, y - dy), (x + dx, y + dy)])
                    yield _line(sheet, layout, cross.intersection(window))
    taken: list[shapely.Geometry] = []
    for is_easting, values in ((True, eastings), (False, northings)):
        for value in values:
            ends = (
                ((value, south), (value, north)) if is_easting else ((west, value), (east, value))
            )
            inside = shapely.LineString(ends).intersection(window)
            if inside.geom_type == "LineString" and inside.length > arm:
                words = f"{'Y' if is_easting else 'X'}={value:+.0f}"
                yield from _ends(sheet, layout, inside, words, taken)


def _multiples(low: float, high: float, step: float) -> list[float]:
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [number * step for number in range(first, last + 1)]


def _line(sheet: DrawingSheet, layout: SheetLayout, line: shapely.Geometry) -> PaperLine:
    placed = sheet.on_paper(shapely.get_coordinates(line), layout)
    return PaperLine(_CROSS_PEN, tuple((x, y) for x, y in placed.tolist()))


def _ends(
    sheet: DrawingSheet,
    layout: SheetLayout,
    inside: shapely.LineString,
    words: str,
    taken: list[shapely.Geometry],
) -> Iterator[PaperShape]:
    """A tick inwards and the coordinate outside, at both ends of a grid line."""
    first, last = sheet.on_paper(shapely.get_coordinates(inside), layout)
    way = (last - first) / np.hypot(*(last - first))
    for end, inwards in ((first, way), (last, -way)):
        tick = end + inwards * _TICK_MM
        yield PaperLine(_TICK_PEN, ((end[0], end[1]), (tick[0], tick[1])))
        outwards, angle_deg = _edge_of(layout, (float(end[0]), float(end[1])))
        middle = (end[0] + outwards[0] * _AWAY_MM, end[1] + outwards[1] * _AWAY_MM)
        half = words_width(words, _WORDS_MM) / 2 + 1.0
        reach = (half, 1.2) if angle_deg == 0.0 else (1.2, half)
        box = shapely.box(middle[0] - reach[0], middle[1] - reach[1],
                          middle[0] + reach[0], middle[1] + reach[1])  # fmt: skip
        if not any(box.intersects(one) for one in taken):
            taken.append(box)
            yield PaperWords(Pen(GRID_WORDS), words, middle, _WORDS_MM, "CENTER", angle_deg)


def _edge_of(layout: SheetLayout, place: PaperPlace) -> tuple[PaperPlace, float]:
    """Which way is out of the window at a place on its edge, and how words lie there."""
    (x, y), (width, height) = layout.window_low, layout.window_size
    edges = (
        (abs(place[1] - y), (0.0, -1.0), 0.0),
        (abs(place[0] - x), (-1.0, 0.0), 90.0),
        (abs(place[1] - y - height), (0.0, 1.0), 0.0),
        (abs(place[0] - x - width), (1.0, 0.0), 90.0),
    )
    _, outwards, angle_deg = min(edges, key=lambda edge: edge[0])
    return outwards, angle_deg


def _match(
    sheet: DrawingSheet, layout: SheetLayout, language: Language, match: MatchLine
) -> Iterator[PaperShape]:
    line = shapely.LineString([match.start, match.end]).intersection(sheet.window)
    if line.geom_type != "LineString" or line.is_empty:
        return
    placed = sheet.on_paper(shapely.get_coordinates(line), layout)
    start, end = placed[0], placed[-1]
    yield PaperLine(_MATCH_PEN, ((start[0], start[1]), (end[0], end[1])))
    low, high = (start, end) if start[1] <= end[1] else (end, start)
    way = (high - low) / np.hypot(*(high - low))
    words = (
        Text("Match line {station}, sheet {to}", "接合線 {station}　図面{to}に続く")
        .filled(station=match.station, to=match.to)
        .in_language(language)
    )
    reach = words_width(words, 2.5) / 2 + 4.0
    # On the side of the other sheet, where the map is that sheet's.
    side = np.array([-way[1], way[0]])
    middle = np.array(layout.window_centre)
    if side @ (low - middle) < 0:
        side = -side
    at = low + way * reach + side * 2.5
    angle = math.degrees(math.atan2(way[1], way[0]))
    yield PaperWords(Pen(MATCH_WORDS, (200, 0, 0)), words, (at[0], at[1]), 2.5, "CENTER", angle)
