"""The column beside the map: north arrow, scale bar, legend, key map, title block."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.text import Language, Text
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.map_looks import map_pen, symbol_on_paper
from processing.formats.sheets.paper_layers import (
    KEY_BOX,
    KEY_LINES,
    KEY_WORDS,
    LEGEND_BOX,
    LEGEND_WORDS,
    NORTH,
    NORTH_WORDS,
    SCALE,
    SCALE_BAR,
    SCALE_WORDS,
    TITLE_BOX,
    TITLE_RULES,
    TITLE_WORDS,
)
from processing.formats.sheets.paper_shapes import (
    GREY,
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
    Pen,
    box_line,
    words_in_box,
    words_width,
)
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.formats.sheets.title_block import VALUE_LAYERS
from processing.map.catalogue import FeatureKind, Geometry

_PAD_MM = 5.0
_NORTH_MM, _BAR_MM, _HEAD_MM = 30.0, 20.0, 7.0
_KEY_SHARE = 0.6  # height of the key map, of the column's width
_ROW_MM, _LEGEND_MM = 8.0, 6.0
_LEAST_ROW_MM, _LEAST_COLUMN_MM = 4.0, 45.0
"""Of the legend: letters of 2.4 mm, and room for a sample and some ten of them."""
_SAMPLE_MM = 12.0
_LABEL_SHARE = 0.3
_BARS_M = (500, 200, 100, 50, 20, 10, 5, 2, 1)
_THICK_MM, _THIN_MM = 0.35, 0.13
_KEY_PEN, _OWN_PEN = Pen(KEY_LINES, width_mm=_THIN_MM), Pen(KEY_LINES, width_mm=_THICK_MM)


@dataclass(frozen=True)
class LegendRow:
    """A row of the legend.

    Attributes
    ----------
    words : str
    sample : callable
        Gives the shapes of a sample from its left end, and the row's height.
    """

    words: str
    sample: Callable[[PaperPlace, float], Iterable[PaperShape]]


@dataclass(frozen=True)
class ColumnContent:
    """What a sheet's column says.

    Attributes
    ----------
    sheets : sequence of DrawingSheet
        All of the job, of which `number`, from 1, is this one.
    kinds : sequence of FeatureKind
        Those on this sheet.
    title_block : mapping of Text to str
        Rows from above; empty values stay empty.
    """

    sheets: Sequence[DrawingSheet]
    number: int
    kinds: Sequence[FeatureKind]
    title_block: Mapping[Text, str]
    language: Language

    @property
    def sheet(self) -> DrawingSheet:
        """The one whose column it is."""
        return self.sheets[self.number - 1]


def column_shapes(content: ColumnContent, layout: SheetLayout) -> Iterator[PaperShape]:
    """Everything in the column: north arrow above, title block below."""
    (x, y), (width, height) = layout.column_low, layout.column_size
    top = y + height
    yield from _north(content.sheet, (x + width / 2, top - _NORTH_MM / 2))
    yield from scale_bar(content.sheet.scale, (x, top - _NORTH_MM - _BAR_MM), width)
    block = _ROW_MM * len(content.title_block)
    yield from title_rows(content.title_block, content.language, (x, y), width)
    key = width * _KEY_SHARE
    yield from _key_map(content, (x, y + block), (width, key))
    legend = top - _NORTH_MM - _BAR_MM
    size = (width, legend - y - block - key)
    rows = [_legend_row(kind, content.language) for kind in content.kinds]
    yield from legend_box(rows, content.language, (x, y + block + key), size)


def plain_column(
    rows: Sequence[LegendRow],
    block: Mapping[Text, str],
    scale: int,
    language: Language,
    layout: SheetLayout,
) -> Iterator[PaperShape]:
    """The column of a sheet without a map: scale bar, legend and title block."""
    (x, y), (width, height) = layout.column_low, layout.column_size
    yield from scale_bar(scale, (x, y + height - _BAR_MM), width)
    yield from title_rows(block, language, (x, y), width)
    low = y + _ROW_MM * len(block)
    yield from legend_box(rows, language, (x, low), (width, y + height - _BAR_MM - low))


def _north(sheet: DrawingSheet, middle: PaperPlace) -> Iterator[PaperShape]:
    """An arrow to grid north; its right half filled."""
    turn = math.radians(-sheet.turned_deg)

    def at(x: float, y: float) -> PaperPlace:
        return (
            middle[0] + x * math.cos(turn) - y * math.sin(turn),
            middle[1] + x * math.sin(turn) + y * math.cos(turn),
        )

    tip, left, right, notch = at(0, 8), at(-3, -8), at(3, -8), at(0, -5)
    pen = Pen(NORTH, width_mm=_THIN_MM)
    yield PaperLine(pen, (tip, left, notch, tip))
    yield PaperLine(pen, (tip, right, notch, tip), is_filled=True)
    yield PaperWords(Pen(NORTH_WORDS), "N", at(0, 11), 4.0, "CENTER", -sheet.turned_deg)


def scale_bar(scale: int, low: PaperPlace, width: float) -> Iterator[PaperShape]:
    """Five parts, filled in turn, with metres above and the scale below."""
    most = width - 8 * _PAD_MM
    metres = next(one for one in _BARS_M if one * 1000 / scale <= most)
    part = metres / 5 * 1000 / scale
    x, y = low[0] + (width - 5 * part) / 2, low[1] + _BAR_MM / 2
    pen = Pen(SCALE_BAR, width_mm=_THIN_MM)
    for number in range(5):
        place = (x + number * part, y)
        yield box_line(pen, place, (part, 2.0))
        if number % 2 == 0:
            yield box_line(pen, place, (part, 2.0), is_filled=True)
    for number in range(6):
        words = f"{metres / 5 * number:g}" + (" m" if number == 5 else "")
        place = (x + number * part, y + 4.0)
        yield PaperWords(Pen(SCALE_WORDS), words, place, 2.0, "CENTER")
    place = (low[0] + width / 2, y - 4.0)
    yield PaperWords(Pen(SCALE), f"S = 1:{scale}", place, 3.0, "CENTER")


def _head(
    words: str, layers: tuple[str, str], low: PaperPlace, size: PaperPlace
) -> Iterator[PaperShape]:
    """A box of the column with its heading, on a layer each."""
    yield box_line(Pen(layers[0], width_mm=_THICK_MM), low, size)
    place = (low[0] + size[0] / 2, low[1] + size[1] - _HEAD_MM / 2)
    yield PaperWords(Pen(layers[1]), words, place, 3.5, "CENTER")


def _legend_row(kind: FeatureKind, language: Language) -> LegendRow:
    name = kind.name.in_language(language)
    words = f"{kind.dm_code}　{name}" if kind.dm_code else name
    return LegendRow(words, lambda place, step: _sample(kind, place, step))


def legend_box(
    rows: Sequence[LegendRow], language: Language, low: PaperPlace, size: PaperPlace
) -> Iterator[PaperShape]:
    """A sample and a name in each row, in as few columns as can be read.

    What has no room even so is counted in the last row.
    """
    title = Text("Legend", "凡例").in_language(language)
    yield from _head(title, (LEGEND_BOX, LEGEND_WORDS), low, size)
    room = size[1] - _HEAD_MM - 2.0
    most = max(1, int(room / _LEAST_ROW_MM))
    columns = max(1, min(math.ceil(len(rows) / most), int(size[0] / _LEAST_COLUMN_MM)))
    if columns == 1 and len(rows) * _LEGEND_MM > room:
        columns = 2
    left_out = max(0, len(rows) - columns * most + 1) if len(rows) > columns * most else 0
    shown = list(rows[: len(rows) - left_out])
    if left_out:
        words = Text(f"and {left_out} more kinds", f"ほか{left_out}種別")
        shown.append(LegendRow(words.in_language(language), lambda _place, _step: ()))
    deep = max(1, math.ceil(len(shown) / columns))
    step = min(_LEGEND_MM, room / deep)
    width = size[0] / columns
    for number, row in enumerate(shown):
        column, line = divmod(number, deep)
        x = low[0] + column * width + _PAD_MM / 2
        y = low[1] + size[1] - _HEAD_MM - (line + 0.5) * step
        yield from row.sample((x, y), step)
        left = (x + _SAMPLE_MM + 2.0, y - step / 2)
        letters = min(2.5, step * 0.6)
        yield from words_in_box(
            row.words, left, (width - _SAMPLE_MM - 2.0 - _PAD_MM, step), letters,
            layer=LEGEND_WORDS,
        )  # fmt: skip


def _sample(kind: FeatureKind, place: PaperPlace, step: float) -> Iterator[PaperShape]:
    pen, (x, y) = map_pen(kind), place
    match kind.geometry:
        case Geometry.POINT:
            yield from symbol_on_paper(kind, pen, (x + _SAMPLE_MM / 2, y))
        case Geometry.LINE:
            yield PaperLine(pen, (place, (x + _SAMPLE_MM, y)))
        case Geometry.AREA:
            tall = step * 0.6
            yield box_line(pen, (x + 2.0, y - tall / 2), (_SAMPLE_MM - 4.0, tall))


def _key_map(content: ColumnContent, low: PaperPlace, size: PaperPlace) -> Iterator[PaperShape]:
    """The sheet, grey, among its neighbours, with their numbers."""
    title = Text("Key map", "索引図").in_language(content.language)
    yield from _head(title, (KEY_BOX, KEY_WORDS), low, size)
    own = content.sheet
    reach = 2.0 * max(own.size_m)
    near = [
        (number, one)
        for number, one in enumerate(content.sheets, 1)
        if math.dist(one.centre, own.centre) <= reach * 1.01
    ]
    rings = [np.array(one.window.exterior.coords) for _, one in near]
    every = np.concatenate(rings)
    lowest, highest = every.min(axis=0), every.max(axis=0)
    room = (size[0] - 2 * _PAD_MM, size[1] - _HEAD_MM - _PAD_MM)
    ratio = min(room[0] / (highest[0] - lowest[0]), room[1] / (highest[1] - lowest[1]))
    ratio = min(ratio, 0.4 * room[0] / max(own.size_m))
    middle = np.array([low[0] + size[0] / 2, low[1] + (size[1] - _HEAD_MM + 2.0) / 2])

    def placed(ring: np.ndarray) -> tuple[PaperPlace, ...]:
        moved = (ring - (lowest + highest) / 2) * ratio + middle
        return tuple((x, y) for x, y in moved.tolist())

    for (number, _), ring in zip(near, rings, strict=True):
        if number == content.number:
            yield PaperLine(Pen(KEY_LINES, GREY), placed(ring), is_filled=True)
    letters = max(1.5, min(3.5, 0.4 * min(own.size_m) * ratio))
    for (number, one), ring in zip(near, rings, strict=True):
        yield PaperLine(_OWN_PEN if number == content.number else _KEY_PEN, placed(ring))
        place = placed(np.array([one.centre]))[0]
        has_name = words_width(one.name, letters * 0.5) < own.size_m[0] * ratio * 0.95
        has_name &= min(own.size_m) * ratio > 3.2 * letters and one.name != str(number)
        up = letters * 0.6 if has_name else 0.0
        yield PaperWords(Pen(KEY_WORDS), str(number), (place[0], place[1] + up), letters, "CENTER")
        if has_name:
            below = (place[0], place[1] - letters * 0.6)
            yield PaperWords(Pen(KEY_WORDS), one.name, below, letters * 0.5, "CENTER")


def title_rows(
    block: Mapping[Text, str], language: Language, low: PaperPlace, width: float
) -> Iterator[PaperShape]:
    """The rows of a title block, ruled."""
    rows = list(block.items())
    rules = Pen(TITLE_RULES, width_mm=_THIN_MM)
    yield box_line(Pen(TITLE_BOX, width_mm=_THICK_MM), low, (width, _ROW_MM * len(rows)))
    label = width * _LABEL_SHARE
    line = low[0] + label
    yield PaperLine(rules, ((line, low[1]), (line, low[1] + _ROW_MM * len(rows))))
    for number, (name, value) in enumerate(reversed(rows)):
        y = low[1] + number * _ROW_MM
        if number:
            yield PaperLine(rules, ((low[0], y), (low[0] + width, y)))
        words = name.in_language(language)
        yield from words_in_box(
            words, (low[0] + 1.0, y), (label - 2.0, _ROW_MM), 2.5,
            layer=TITLE_WORDS, align="CENTER",
        )  # fmt: skip
        layer = VALUE_LAYERS.get(name, TITLE_WORDS)
        room = (width - label - 4.0, _ROW_MM)
        yield from words_in_box(value, (line + 2.0, y), room, 3.0, layer=layer)
