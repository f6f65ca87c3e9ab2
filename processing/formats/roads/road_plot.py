"""The road model as a picture: its profile, widths, falls and clearance over the stations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from processing.core.arrays import Floats
from processing.core.text import Language, Text
from processing.formats.roads.diagrams import (
    BLUE,
    GREEN,
    INK,
    LAYER,
    ORANGE,
    PALE,
    RED,
    TITLE_MM,
    WORDS_MM,
    Axis,
    Diagram,
)
from processing.formats.roads.road_table import THING_NAMES
from processing.formats.sheets.paper_shapes import PaperShape, PaperWords, Pen, words_width
from processing.map.routes.route import station_words
from processing.methods.road.road_model.road_model import RoadModel, RoadStation

PAGE_MM = (420.0, 297.0)
"""A3, lying."""

_LEFT_MM, _RIGHT_MM, _TOP_MM, _BOTTOM_MM, _BETWEEN_MM = 28.0, 14.0, 26.0, 18.0, 13.0
_PAGE_M = 1000.0
"""Of road on a page: 2.6 m a millimetre."""

_CELLS = (4, 3)
"""Cross sections on a page: across and up."""

_LEAST_HEIGHT_M, _LEAST_WIDTH_M, _LEAST_FALL = 1.0, 4.0, 4.0
_SECTION_M, _RISE_SHARE = 1.0, 0.1
_HIGH_M = 1.0
_PERCENT = 100.0

_PROFILE = Text("Height of the centre line [m]", "中心線の路面高 [m]")
_WIDTHS = Text(
    "Widths: left above, right below [m] (grey carriageway, green walk)",
    "幅員: 上が左、下が右 [m]（灰: 車道、緑: 歩道）",
)
_FALLS = Text(
    "Crossfall, falling outwards positive [%] (blue left, orange right)",
    "横断勾配: 外側へ下がる向きが正 [%]（青: 左、橙: 右）",
)
_SLOPE = Text("Longitudinal slope [%]", "縦断勾配 [%]")
_CLEARANCE = Text(
    "What hangs below the clearance: lowest height over the surface [m] (dashed: to be kept free)",
    "建築限界の支障物: 路面からの最低の高さ [m]（破線: 建築限界）",
)
_STATION = Text("Station [m]", "追加距離 [m]")
_TITLE = Text("Road model", "道路モデル")
_SECTIONS = Text("Cross sections", "横断図")
_MADE = Text("centre line made midway between the edges", "中心線: 両側の縁の中間に自動作成")


@dataclass(frozen=True)
class _Page:
    """A stretch of a road, and how it is titled."""

    model: RoadModel
    stations: Sequence[RoadStation]
    title: str
    language: Language

    def values(self, value: Callable[[RoadStation], float]) -> Floats:
        return np.array([value(one) for one in self.stations], np.float64)

    @property
    def along(self) -> Axis:
        first, last = self.stations[0].station_m, self.stations[-1].station_m
        return Axis(first, max(last, first + 1.0))

    def has(self, station_m: float) -> bool:
        return self.along.first <= station_m <= self.along.last


def road_pages(
    models: Sequence[RoadModel], name: str, language: Language
) -> list[tuple[PaperShape, ...]]:
    """Pages of :data:`PAGE_MM`: diagrams of each road, then its cross sections."""
    pages: list[tuple[PaperShape, ...]] = []
    for model in models:
        pages += [tuple(diagram_page(page)) for page in pages_of(model, name, language)]
        pages += _section_pages(model, name, language)
    return pages


def pages_of(model: RoadModel, name: str, language: Language) -> list[_Page]:
    """The stretches of a road that have room on a page each."""
    first = model.stations[0].station_m
    numbers = [int((one.station_m - first) / _PAGE_M) for one in model.stations]
    pages = []
    for number in sorted(set(numbers)):
        mine = [one for one, own in zip(model.stations, numbers, strict=True) if own == number]
        if len(mine) > 1 or number == 0:
            pages.append(_Page(model, mine, _title(model, mine, name, language), language))
    return pages


def _title(model: RoadModel, stations: Sequence[RoadStation], name: str, language: Language) -> str:
    words = [_TITLE.in_language(language), name, model.name]
    words.append(f"{station_words(stations[0].station_m)}–{station_words(stations[-1].station_m)}")
    if not model.is_drawn:
        words.append(f"({_MADE.in_language(language)})")
    return "  ".join(one for one in words if one)


def diagram_page(page: _Page) -> Iterator[PaperShape]:
    """Profile, widths, falls with slope, and clearance, one above the other."""
    yield PaperWords(Pen(LAYER, INK), page.title, (_LEFT_MM, PAGE_MM[1] - 12.0), TITLE_MM)
    makers = (_profile, _widths, _falls, _slope, _clearance)
    shares = (1.2, 1.3, 1.0, 0.7, 1.0)
    room = PAGE_MM[1] - _TOP_MM - _BOTTOM_MM - _BETWEEN_MM * (len(makers) - 1)
    top = PAGE_MM[1] - _TOP_MM
    width = PAGE_MM[0] - _LEFT_MM - _RIGHT_MM
    for number, (maker, share) in enumerate(zip(makers, shares, strict=True)):
        height = room * share / sum(shares)
        frame = partial(Diagram, (_LEFT_MM, top - height), (width, height), page.along)
        yield from maker(page, frame, is_last=number == len(makers) - 1)
        top -= height + _BETWEEN_MM
    station = _STATION.in_language(page.language)
    yield PaperWords(
        Pen(LAYER, INK), station, (PAGE_MM[0] / 2, _BOTTOM_MM - 8.0), WORDS_MM, "CENTER"
    )


_FrameOf = Callable[[Axis], Diagram]


def _profile(page: _Page, frame: _FrameOf, *, is_last: bool) -> Iterator[PaperShape]:
    heights = page.values(lambda one: one.height_m)
    diagram = frame(Axis.around(heights, _LEAST_HEIGHT_M))
    yield from diagram.frame(_PROFILE.in_language(page.language), has_numbers=is_last)
    yield from diagram.curve(page.values(lambda one: one.station_m), heights, INK)


def _widths(page: _Page, frame: _FrameOf, *, is_last: bool) -> Iterator[PaperShape]:
    at = page.values(lambda one: one.station_m)
    median = page.values(lambda one: one.median_m) / 2
    edges = [
        sign * (median + page.values(partial(_side, side=side, what="carriageway")))
        for side, sign in ((0, 1.0), (1, -1.0))
    ]
    ends = [
        edge + sign * page.values(partial(_side, side=side, what="walk"))
        for edge, side, sign in zip(edges, (0, 1), (1.0, -1.0), strict=True)
    ]
    diagram = frame(Axis.around(np.concatenate([*edges, *ends]), _LEAST_WIDTH_M))
    for edge, end in zip(edges, ends, strict=True):
        yield from diagram.band(at, np.zeros_like(at), edge, PALE)
        yield from diagram.band(at, edge, end, GREEN)
    yield from diagram.frame(_WIDTHS.in_language(page.language), has_numbers=is_last)
    for edge, end in zip(edges, ends, strict=True):
        yield from diagram.curve(at, edge, INK)
        yield from diagram.curve(at, end, INK, 0.15)
    yield diagram.level(0.0, RED, (4.0, 1.0, 0.5, 1.0))


def _side(one: RoadStation, side: int, what: str) -> float:
    return float(getattr(one, what)[side])


def _falls(page: _Page, frame: _FrameOf, *, is_last: bool) -> Iterator[PaperShape]:
    at = page.values(lambda one: one.station_m)
    falls = [page.values(partial(_fall, side=side)) for side in (0, 1)]
    diagram = frame(Axis.around(np.concatenate(falls), _LEAST_FALL))
    yield from diagram.frame(_FALLS.in_language(page.language), has_numbers=is_last)
    for fall, colour in zip(falls, (BLUE, ORANGE), strict=True):
        yield from diagram.curve(at, fall, colour)


def _fall(one: RoadStation, side: int) -> float:
    return _PERCENT * one.fall[side].slope


def _slope(page: _Page, frame: _FrameOf, *, is_last: bool) -> Iterator[PaperShape]:
    slopes = page.values(lambda one: _PERCENT * one.slope.slope)
    diagram = frame(Axis.around(slopes, _LEAST_FALL))
    yield from diagram.frame(_SLOPE.in_language(page.language), has_numbers=is_last)
    yield from diagram.curve(page.values(lambda one: one.station_m), slopes, INK)


def _clearance(page: _Page, frame: _FrameOf, *, is_last: bool) -> Iterator[PaperShape]:
    places = [(at, one) for at, one in page.model.places if page.has(at)]
    limits = sorted({one.limit_m for _, one in places} or {4.5})
    diagram = frame(Axis(0.0, max(limits) + _HIGH_M))
    yield from diagram.frame(_CLEARANCE.in_language(page.language), has_numbers=is_last)
    for limit in limits:
        yield diagram.level(limit, INK, (2.0, 1.0))
    reached = -np.inf
    for at, one in places:
        words = f"{one.lowest_m:.2f} {THING_NAMES[one.type].in_language(page.language)}"
        x, _ = diagram.place(at, one.lowest_m)
        has_room = x > reached
        ends = np.clip(one.stretch_m, page.along.first, page.along.last)
        colour = BLUE if one.is_walk else RED
        yield from diagram.curve(ends, np.full(2, one.lowest_m), colour, 0.25)
        yield from diagram.mark(at, one.lowest_m, BLUE if one.is_walk else RED,
                                words if has_room else "")  # fmt: skip
        if has_room:
            reached = x + 3.0 + words_width(words, WORDS_MM * 0.9)


def _section_pages(model: RoadModel, name: str, language: Language) -> list[tuple[PaperShape, ...]]:
    """Cross sections of the stations whose surface was measured."""
    shown = [one for one in model.stations if len(one.section) > 1]
    per_page = _CELLS[0] * _CELLS[1]
    pages = []
    for first in range(0, len(shown), per_page):
        mine = shown[first : first + per_page]
        title = f"{_SECTIONS.in_language(language)}  {_title(model, mine, name, language)}"
        shapes: list[PaperShape] = [
            PaperWords(Pen(LAYER, INK), title, (_LEFT_MM, PAGE_MM[1] - 12.0), TITLE_MM)
        ]
        for number, one in enumerate(mine):
            shapes += _section(one, _cell(number), language)
        pages.append(tuple(shapes))
    return pages


def _cell(number: int) -> tuple[tuple[float, float], tuple[float, float]]:
    """Lower left corner and size of a cell, mm: from the upper left to the right."""
    wide = (PAGE_MM[0] - _LEFT_MM - _RIGHT_MM + 12.0) / _CELLS[0]
    tall = (PAGE_MM[1] - _TOP_MM - _BOTTOM_MM + 6.0) / _CELLS[1]
    column, row = number % _CELLS[0], number // _CELLS[0]
    low = (_LEFT_MM + column * wide, PAGE_MM[1] - _TOP_MM - (row + 1) * tall + 10.0)
    return low, (wide - 14.0, tall - 16.0)


def _section(
    one: RoadStation, cell: tuple[tuple[float, float], tuple[float, float]], language: Language
) -> Iterator[PaperShape]:
    """The surface from walk to walk with the edges; heights are drawn larger than widths."""
    reach = [
        _first_known((side + more, side), 6.0) + _SECTION_M
        for side, more in zip(one.carriageway, one.walk, strict=True)
    ]
    inside = (one.section[:, 0] >= -reach[0]) & (one.section[:, 0] <= reach[1])
    section = one.section[inside]
    heights = section[:, 1] if len(section) else np.array([0.0])
    diagram = Diagram(
        *cell, Axis(-reach[0], reach[1]), Axis.around(heights, _RISE_SHARE * sum(reach))
    )
    falls = " / ".join(f"{_PERCENT * fit.slope:.1f}" if np.isfinite(fit.slope) else "–"
                       for fit in one.fall)  # fmt: skip
    yield from diagram.frame(f"{station_words(one.station_m)}   {falls} %", has_numbers=True)
    yield from _surface(diagram, section)
    for away, sign in zip(one.carriageway, (-1.0, 1.0), strict=True):
        if np.isfinite(away):
            ends = (diagram.up.first, diagram.up.last)
            yield from diagram.curve(np.full(2, sign * away), np.array(ends), RED, 0.2)
    del language


def _surface(diagram: Diagram, section: Floats) -> Iterator[PaperShape]:
    """The surface, interrupted where half a metre and more wasn't measured."""
    gaps = np.flatnonzero(np.diff(section[:, 0]) > 0.5) + 1
    for part in np.split(section, gaps):
        yield from diagram.curve(part[:, 0], part[:, 1], INK, 0.3)


def _first_known(values: tuple[float, ...], otherwise: float) -> float:
    return next((one for one in values if np.isfinite(one)), otherwise)
