"""A section on paper: ground, datum line, what is crossed with names, rows of values below."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely

from processing.core.text import Language, Text
from processing.formats.sections.route_sections import CrossedFeature, RouteSection
from processing.formats.sheets.map_looks import map_pen
from processing.formats.sheets.paper_shapes import (
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
    Pen,
    words_width,
)
from processing.map.routes.route import station_words

GROUND_LAYER, AXIS_LAYER, NAME_LAYER, BAND_LAYER = (
    "S-BGD-CRST", "S-BMK", "S-BGD-HTXT", "S-TTL-BAND",
)  # fmt: skip
"""Layers of CAD製図基準: ground, centre line, names with leaders, rows of values."""

GROUND_PEN = Pen(GROUND_LAYER, width_mm=0.35)
AXIS_PEN = Pen(AXIS_LAYER, (200, 0, 0), 0.13, (4.0, 1.0, 0.5, 1.0), "dash_dot")
_DATUM_PEN, _BAND_PEN = Pen(BAND_LAYER, width_mm=0.25), Pen(BAND_LAYER, width_mm=0.13)
_LEADER_PEN, _NAME_PEN = Pen(NAME_LAYER, (110, 110, 110), 0.13), Pen(NAME_LAYER)
_DROP_PEN = Pen(BAND_LAYER, (150, 150, 150), 0.09)
_STAFF_PEN = Pen(AXIS_LAYER, width_mm=0.18)

LEFT_MM, RIGHT_MM = 26.0, 6.0
"""Beside a section: names of rows and the staff on the left."""

_VALUE_ROW_MM, _WORD_ROW_MM, _STATION_ROW_MM, _KINK_MM = 12.0, 7.0, 16.0, 4.0
_WORDS_MM, _APART_MM, _TITLE_MM = 2.0, 2.8, 3.5
_CLEAR_MM = 4.0
_STEPS_M = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
_LEAST_STEP_MM = 5.0
_BREAK_M = 0.1
"""Ground leaves the chord between its places with values by less, where there is room for them."""


@dataclass(frozen=True)
class SectionScale:
    """Denominators of a section's scales: along it, and of heights."""

    along: int
    height: int

    @property
    def words(self) -> Text:
        """As the title block says it."""
        if self.along == self.height:
            return Text.same(f"1:{self.along}")
        return Text(
            f"H 1:{self.along}, V 1:{self.height}", f"横 1:{self.along}　縦 1:{self.height}"
        )


@dataclass(frozen=True)
class SectionBlock:
    """A section with all that belongs to it, in mm from its lower left corner."""

    shapes: tuple[PaperShape, ...]
    size: tuple[float, float]

    def moved(self, x: float, y: float) -> Iterator[PaperShape]:
        """The shapes with the corner at a place."""
        for shape in self.shapes:
            yield _moved(shape, x, y)


@dataclass(frozen=True)
class _Row:
    """Values below a section, each at its place; words stand upright where they are many."""

    name: Text
    height: float
    values: tuple[tuple[float, str], ...]  # mm, words
    is_upright: bool = True


@dataclass(frozen=True)
class _Frame:
    """How a section lies in its block."""

    first: float
    last: float
    datum: float
    scale: SectionScale
    low: float  # mm, of the datum line

    def x(self, along_m: float) -> float:
        return LEFT_MM + (along_m - self.first) * 1000 / self.scale.along

    def y(self, height_m: float) -> float:
        return self.low + (height_m - self.datum) * 1000 / self.scale.height

    @property
    def right(self) -> float:
        return self.x(self.last)


def cross_block(
    section: RouteSection, reach_m: float, scale: SectionScale, language: Language
) -> SectionBlock:
    """A cross section: heights and offsets of the centre, what is crossed and breaks of ground."""
    frame = _frame_of(section, (-reach_m, reach_m), scale, 2 * _VALUE_ROW_MM + _KINK_MM)
    middle = section.ground_at(0.0)
    places = _valued(section, frame)
    xs = spread_apart([frame.x(along) for along, _ in places], _APART_MM, LEFT_MM + 1, frame.right)
    rows = (
        _Row(Text("Height", "地盤高"), _VALUE_ROW_MM,
             tuple((x, f"{height:.3f}") for x, (_, height) in zip(xs, places, strict=True))),
        _Row(Text("Offset", "離れ"), _VALUE_ROW_MM,
             tuple((x, _signed(along)) for x, (along, _) in zip(xs, places, strict=True))),
    )  # fmt: skip
    shapes = [*_ground(section, frame), *_band(rows, frame, language)]
    for x, (along, height) in zip(xs, places, strict=True):
        path = ((frame.x(along), frame.y(height)), (frame.x(along), frame.low),
                (x, frame.low - _KINK_MM))  # fmt: skip
        shapes.append(PaperLine(_DROP_PEN, path))
    top, names = _names(section.crossed, frame, _top(section, frame), language)
    axis = frame.x(0.0)
    shapes += [*names, PaperLine(AXIS_PEN, ((axis, frame.low), (axis, top + 2.0)))]
    title = station_words(section.station_m or 0.0)
    level = "" if middle is None else f"　GH={middle:.3f}"
    y = top + _TITLE_MM + 1.5
    shapes.append(PaperWords(_NAME_PEN, title + level, (axis, y), _TITLE_MM, "CENTER"))
    return SectionBlock(tuple(shapes), (frame.right + RIGHT_MM, y + _TITLE_MM))


def profile_block(
    section: RouteSection,
    ends: tuple[float, float],
    stations: Sequence[float],
    scale: SectionScale,
    language: Language,
) -> SectionBlock:
    """A stretch of a longitudinal section with the rows that offices expect.

    Parameters
    ----------
    ends : (float, float)
        First and last station of the stretch.
    stations : sequence of float
        Those with values, on the stretch.
    """
    rows_mm = _WORD_ROW_MM + 3 * _VALUE_ROW_MM + _STATION_ROW_MM + _KINK_MM
    frame = _frame_of(section, ends, scale, rows_mm)
    xs = spread_apart([frame.x(one) for one in stations], _APART_MM, LEFT_MM + 1, frame.right)
    heights = [section.ground_at(one) for one in stations]
    steps = [None, *(after - before for before, after in pairwise(stations))]
    written = [
        ["" if one is None else f"{one:.3f}" for one in heights],
        [f"{one - section.route.start_m:.2f}" for one in stations],
        ["" if one is None else f"{one:.2f}" for one in steps],
        [station_words(one) for one in stations],
    ]
    named = (
        (Text("Height", "地盤高"), _VALUE_ROW_MM), (Text("Distance", "追加距離"), _VALUE_ROW_MM),
        (Text("Step", "単距離"), _VALUE_ROW_MM), (Text("Station", "測点"), _STATION_ROW_MM),
    )  # fmt: skip
    rows = [
        _Row(name, tall, tuple(zip(xs, values, strict=True)))
        for (name, tall), values in zip(named, written, strict=True)
    ]
    slopes = tuple(_slopes(list(zip(stations, heights, strict=True)), frame))
    gradient = _Row(Text("Gradient %", "勾配 %"), _WORD_ROW_MM, slopes, is_upright=False)
    shapes = [*_ground(section, frame), *_band((gradient, *rows), frame, language)]
    for x, station, height in zip(xs, stations, heights, strict=True):
        top = frame.low if height is None else frame.y(height)
        at = frame.x(station)
        shapes.append(PaperLine(_DROP_PEN, ((at, top), (at, frame.low), (x, frame.low - _KINK_MM))))
    top, names = _names(section.crossed, frame, _top(section, frame), language)
    title = f"{section.route.name}　{station_words(ends[0])}～{station_words(ends[1])}".strip()
    y = top + _TITLE_MM + 1.5
    shapes += [*names, PaperWords(_NAME_PEN, title, (LEFT_MM, y), _TITLE_MM)]
    return SectionBlock(tuple(shapes), (frame.right + RIGHT_MM, y + _TITLE_MM))


def spread_apart(wanted: Sequence[float], gap: float, low: float, high: float) -> list[float]:
    """Places in rising order at least a gap apart, as near to the wanted ones as can be.

    They begin at `low` and go beyond `high` only where there is no room for all. Least squares
    under order: pool adjacent violators.
    """
    blocks: list[tuple[float, int]] = []  # mean and count of shifted places
    for number, place in enumerate(wanted):
        mean, count = place - number * gap, 1
        while blocks and blocks[-1][0] > mean:
            before, many = blocks.pop()
            mean, count = (before * many + mean * count) / (many + count), many + count
        blocks.append((mean, count))
    most = max(low, high - (len(wanted) - 1) * gap)
    shifted = [mean for mean, count in blocks for _ in range(count)]
    return [min(max(one, low), most) + number * gap for number, one in enumerate(shifted)]


def _frame_of(
    section: RouteSection, ends: tuple[float, float], scale: SectionScale, low: float
) -> _Frame:
    heights = [part[:, 1] for part in section.ground]
    heights.append(np.array([one.height_m for one in section.crossed]))
    every = np.concatenate(heights)
    lowest = float(every.min()) if len(every) else 0.0
    datum = float(math.floor(lowest - _CLEAR_MM * scale.height / 1000))
    return _Frame(ends[0], ends[1], datum, scale, low)


def _top(section: RouteSection, frame: _Frame) -> float:
    heights = [float(part[:, 1].max()) for part in section.ground]
    heights += [one.height_m for one in section.crossed]
    return frame.y(max(heights)) if heights else frame.low


def _ground(section: RouteSection, frame: _Frame) -> Iterator[PaperShape]:
    """Datum line, staff and ground line, and a mark where a feature is."""
    yield PaperLine(_DATUM_PEN, ((LEFT_MM, frame.low), (frame.right, frame.low)))
    words = f"DL={frame.datum:.2f}"
    yield PaperWords(_NAME_PEN, words, (LEFT_MM - 9.0, frame.low), 2.5, "RIGHT")
    step = next(
        (one for one in _STEPS_M if one * 1000 / frame.scale.height >= _LEAST_STEP_MM), _STEPS_M[-1]
    )
    staff = LEFT_MM - 3.0
    top = max(1, math.ceil((_top(section, frame) - frame.low) * frame.scale.height / 1000 / step))
    yield PaperLine(_STAFF_PEN, ((staff, frame.low), (staff, frame.y(frame.datum + top * step))))
    for number in range(top + 1):
        height = frame.datum + number * step
        y = frame.y(height)
        yield PaperLine(_STAFF_PEN, ((staff, y), (staff + 1.5, y)))
        if number:
            digits = 1 if step < 1.0 else 0
            words = f"{height:.{digits}f}"
            yield PaperWords(_NAME_PEN, words, (staff - 0.8, y), 1.8, "RIGHT")
    for part in section.ground:
        yield PaperLine(GROUND_PEN, tuple((frame.x(x), frame.y(y)) for x, y in part.tolist()))
    for one in section.crossed:
        pen = replace(map_pen(one.kind), dash_mm=(), line_type="continuous", width_mm=0.25)
        yield PaperCircle(pen, (frame.x(one.along_m), frame.y(one.height_m)), 0.5)


def _band(rows: Sequence[_Row], frame: _Frame, language: Language) -> Iterator[PaperShape]:
    """Rows below the datum line, from above."""
    top = frame.low - _KINK_MM
    left, right = 1.0, frame.right + 1.5
    yield PaperLine(_BAND_PEN, ((left, top), (right, top)))
    high = top
    for row in rows:
        low = top - row.height
        yield PaperLine(_BAND_PEN, ((left, low), (right, low)))
        middle = (top + low) / 2
        name = row.name.in_language(language)
        letters = min(2.5, 2.5 * (LEFT_MM - 4.0) / words_width(name, 2.5))
        yield PaperWords(_NAME_PEN, name, ((left + LEFT_MM - 2.0) / 2, middle), letters, "CENTER")
        for x, words in row.values:
            if words:
                angle = 90.0 if row.is_upright else 0.0
                place = (x, middle)
                yield PaperWords(Pen(BAND_LAYER), words, place, _WORDS_MM, "CENTER", angle)
        top = low
    for x in (left, LEFT_MM - 2.0, right):
        yield PaperLine(_BAND_PEN, ((x, high), (x, top)))


def _names(
    crossed: Sequence[CrossedFeature], frame: _Frame, top: float, language: Language
) -> tuple[float, list[PaperShape]]:
    """Names upright above the section, each with a leader; gives where they end."""
    if not crossed:
        return top + _CLEAR_MM, []
    xs = spread_apart(
        [frame.x(one.along_m) for one in crossed], _APART_MM, LEFT_MM + 1, frame.right
    )
    kink, low = top + _CLEAR_MM, top + _CLEAR_MM + _KINK_MM
    shapes: list[PaperShape] = []
    longest = 0.0
    for x, one in zip(xs, crossed, strict=True):
        words = f"{one.kind.name.in_language(language)} {one.height_m:.3f}"
        at = frame.x(one.along_m)
        path: tuple[PaperPlace, ...] = ((at, frame.y(one.height_m) + 0.5), (at, kink), (x, low))
        shapes.append(PaperLine(_LEADER_PEN, path))
        shapes.append(PaperWords(_NAME_PEN, words, (x, low + 0.8), _WORDS_MM, "LEFT", 90.0))
        longest = max(longest, words_width(words, _WORDS_MM))
    return low + longest + 2.0, shapes


def _valued(section: RouteSection, frame: _Frame) -> list[tuple[float, float]]:
    """Offsets and heights that are written: ends, centre, crossed features, breaks of ground."""
    places = [(one.along_m, one.height_m) for one in section.crossed]
    middle = section.ground_at(0.0)
    if middle is not None:
        places.append((0.0, middle))
    most = int((frame.right - LEFT_MM) / _APART_MM)
    tolerance = _BREAK_M
    while True:
        breaks = [
            (x, y)
            for part in section.ground
            for x, y in shapely.get_coordinates(
                shapely.simplify(shapely.LineString(part), tolerance)
            ).tolist()
        ]
        apart = [one for one in breaks if all(abs(one[0] - x) > 0.3 for x, _ in places)]
        if len(places) + len(apart) <= most or tolerance > 100.0:
            return sorted([*places, *apart])
        tolerance *= 2


def _slopes(
    places: Sequence[tuple[float, float | None]], frame: _Frame
) -> Iterator[tuple[float, str]]:
    for (start, low), (end, high) in pairwise(places):
        if low is None or high is None:
            continue
        words = f"{100 * (high - low) / (end - start):+.2f}"
        if words_width(words, _WORDS_MM) < frame.x(end) - frame.x(start):
            yield frame.x((start + end) / 2), words


def _signed(offset_m: float) -> str:
    words = f"{offset_m:.3f}"
    return "0.000" if float(words) == 0.0 else words


def _moved(shape: PaperShape, x: float, y: float) -> PaperShape:
    match shape:
        case PaperLine():
            return replace(shape, places=tuple((a + x, b + y) for a, b in shape.places))
        case PaperCircle():
            return replace(shape, centre=(shape.centre[0] + x, shape.centre[1] + y))
        case PaperWords():
            return replace(shape, place=(shape.place[0] + x, shape.place[1] + y))
