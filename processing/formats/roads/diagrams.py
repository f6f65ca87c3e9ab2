"""Diagrams over a road's stations on paper: frames, axes, curves, bands and marks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.formats.sheets.paper_shapes import (
    GREY,
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
    Pen,
    Rgb,
)

LAYER = "ROAD"
WORDS_MM, TITLE_MM = 2.6, 4.5
_TICK_MM, _GRID_MM = 1.2, 0.1
_STEPS = (1.0, 2.0, 5.0, 10.0)
_FEWEST_TICKS = 3
_MARK_MM = 0.9

INK: Rgb = (40, 40, 40)
BLUE: Rgb = (0, 90, 160)
ORANGE: Rgb = (200, 90, 0)
RED: Rgb = (200, 20, 20)
PALE: Rgb = (222, 222, 226)
GREEN: Rgb = (205, 226, 205)


@dataclass(frozen=True)
class Axis:
    """Values from the lower or left end of a frame to the upper or right one."""

    first: float
    last: float

    @staticmethod
    def around(values: Floats, least: float) -> Axis:
        """One that holds all known values and a margin, and is so long at least."""
        known = values[np.isfinite(values)]
        if not known.size:
            return Axis(0.0, least)
        low, high = float(known.min()), float(known.max())
        middle, half = (low + high) / 2, max((high - low) * 0.55, least / 2)
        return Axis(middle - half, middle + half)

    def ticks(self) -> Floats:
        """Round values, three and more."""
        rough = (self.last - self.first) / _FEWEST_TICKS
        power = 10.0 ** math.floor(math.log10(rough))
        step = max(one * power for one in _STEPS if one * power <= rough * (1 + 1e-9))
        first = math.ceil(self.first / step - 1e-9)
        last = math.floor(self.last / step + 1e-9)
        return np.arange(first, last + 1).astype(np.float64) * step


@dataclass(frozen=True)
class Diagram:
    """A frame on the paper with its axes.

    Attributes
    ----------
    low, size : (float, float)
        Lower left corner, width and height, mm.
    """

    low: PaperPlace
    size: tuple[float, float]
    across: Axis
    up: Axis

    def place(self, across: float, up: float) -> PaperPlace:
        """Where a pair of values is on the paper."""
        x = (across - self.across.first) / (self.across.last - self.across.first)
        y = (up - self.up.first) / (self.up.last - self.up.first)
        return self.low[0] + x * self.size[0], self.low[1] + y * self.size[1]

    def frame(self, title: str, *, has_numbers: bool) -> Iterator[PaperShape]:
        """The frame with its grid, ticks of values on the left, and its title above."""
        pen, grid, words = Pen(LAYER, INK, 0.2), Pen(LAYER, GREY, _GRID_MM), Pen(LAYER, INK)
        (x, y), (width, height) = self.low, self.size
        for value in self.up.ticks().tolist():
            _, at = self.place(self.across.first, value)
            yield PaperLine(grid, ((x, at), (x + width, at)))
            label = f"{value:g}" if abs(value) > 1e-9 else "0"
            yield PaperWords(words, label, (x - _TICK_MM, at), WORDS_MM, "RIGHT")
        for value in self.across.ticks().tolist():
            at, _ = self.place(value, self.up.first)
            yield PaperLine(grid, ((at, y), (at, y + height)))
            if has_numbers:
                below = (at, y - _TICK_MM - WORDS_MM / 2)
                yield PaperWords(words, f"{value:g}", below, WORDS_MM, "CENTER")
        around = ((x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y))
        yield PaperLine(pen, around)
        yield PaperWords(words, title, (x, y + height + WORDS_MM), WORDS_MM * 1.15)

    def curve(
        self, across: Floats, up: Floats, colour: Rgb, width_mm: float = 0.35
    ) -> Iterator[PaperShape]:
        """A line through known values, interrupted by the others; a lone one is a dot."""
        for part in known_parts(up):
            places = self._inside(across[part], up[part])
            if len(places) > 1:
                yield PaperLine(Pen(LAYER, colour, width_mm), tuple(places))
            elif places:
                yield PaperCircle(Pen(LAYER, colour, width_mm), places[0], width_mm)

    def band(self, across: Floats, low: Floats, high: Floats, colour: Rgb) -> Iterator[PaperShape]:
        """The area between two curves, where both are known."""
        for part in known_parts(low + high):
            if part.stop - part.start > 1:
                there = self._inside(across[part], low[part])
                back = self._inside(across[part], high[part])[::-1]
                yield PaperLine(Pen(LAYER, colour), (*there, *back, there[0]), is_filled=True)

    def level(self, value: float, colour: Rgb, dash_mm: tuple[float, ...]) -> PaperLine:
        """A line across at a value."""
        ends = (self.place(self.across.first, value), self.place(self.across.last, value))
        return PaperLine(Pen(LAYER, colour, 0.25, dash_mm, "dashed"), ends)

    def mark(self, across: float, up: float, colour: Rgb, words: str = "") -> Iterator[PaperShape]:
        """A circle, with words to the right of it."""
        x, y = self._inside(np.array([across]), np.array([up]))[0]
        yield PaperCircle(Pen(LAYER, colour, 0.4), (x, y), _MARK_MM)
        if words:
            yield PaperWords(Pen(LAYER, colour), words, (x + 0.8, y + 2.0), WORDS_MM * 0.9)

    def _inside(self, across: Floats, up: Floats) -> list[PaperPlace]:
        kept = np.clip(up, self.up.first, self.up.last)
        return [self.place(x, y) for x, y in zip(across.tolist(), kept.tolist(), strict=True)]


def known_parts(values: Floats) -> Sequence[slice]:
    """The runs of known values."""
    known = np.isfinite(values)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(np.int8)))
    return [slice(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
