"""Papers as PNG, in the font that papers carry."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from processing.formats.pictures.png import write_png
from processing.formats.sheets.paper_shapes import (
    TYPE_OF_HEIGHT,
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
)
from resources import path_of

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

_PX_OF_MM, _FINER = 6.0, 2
"""150 dots an inch; drawn twice as fine, so that lines are smooth."""

_FONT = "fonts/ZukaPaper-Regular.ttf"
_ANCHORS = {"LEFT": "lm", "CENTER": "mm", "RIGHT": "rm"}


def write_paper_png(path: Path, shapes: Iterable[PaperShape], size_mm: tuple[float, float]) -> None:
    """Write a page of shapes on white; words lie level.

    Raises
    ------
    NoSpace
        The disk is full or refuses the write.
    """
    from PIL import Image, ImageDraw

    scale = _PX_OF_MM * _FINER
    width, height = (round(one * scale) for one in size_mm)
    image = Image.new("RGB", (width, height), "white")
    sheet = _Sheet(ImageDraw.Draw(image), scale, size_mm[1])
    for shape in shapes:
        sheet.draw(shape)
    small = image.resize((width // _FINER, height // _FINER), Image.Resampling.LANCZOS)
    pixels = np.asarray(small)
    write_png(path, (pixels.shape[0], pixels.shape[1]), [pixels])


class _Sheet:
    """What draws shapes in pixels."""

    def __init__(self, draw: ImageDraw, scale: float, height_mm: float) -> None:
        self._draw, self._scale, self._height = draw, scale, height_mm

    def draw(self, shape: PaperShape) -> None:
        colour = shape.pen.colour
        width = max(1, round(shape.pen.width_mm * self._scale))
        match shape:
            case PaperLine():
                places = [self._pixel(one) for one in shape.places]
                if shape.is_filled:
                    self._draw.polygon(places, fill=colour)
                else:
                    for part in _dashed(places, [one * self._scale for one in shape.pen.dash_mm]):
                        self._draw.line(part, fill=colour, width=width, joint="curve")
            case PaperCircle():
                x, y = self._pixel(shape.centre)
                radius = shape.radius * self._scale
                box = (x - radius, y - radius, x + radius, y + radius)
                self._draw.ellipse(box, outline=colour, width=width)
            case PaperWords():
                self._words(shape)

    def _words(self, words: PaperWords) -> None:
        from PIL import ImageFont

        size = words.height * TYPE_OF_HEIGHT * self._scale
        font = ImageFont.truetype(str(path_of(_FONT)), size)
        self._draw.text(
            self._pixel(words.place), words.words, fill=words.pen.colour, font=font,
            anchor=_ANCHORS[words.align],
        )  # fmt: skip

    def _pixel(self, place: PaperPlace) -> tuple[float, float]:
        return place[0] * self._scale, (self._height - place[1]) * self._scale


def _dashed(
    places: list[tuple[float, float]], dash: list[float]
) -> Iterable[list[tuple[float, float]]]:
    """A line in its dashes; whole without any."""
    if not dash:
        yield places
        return
    xy = np.array(places)
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(xy, axis=0).T))])
    at, number = 0.0, 0
    while at < reached[-1]:
        end = min(at + dash[number % len(dash)], float(reached[-1]))
        if number % 2 == 0:
            inner = reached[(reached > at) & (reached < end)]
            along = np.concatenate([[at], inner, [end]])
            both = np.column_stack([np.interp(along, reached, axis) for axis in xy.T])
            yield [(x, y) for x, y in both.tolist()]
        at, number = end, number + 1
