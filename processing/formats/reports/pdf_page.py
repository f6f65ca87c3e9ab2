"""Papers: PDF pages in millimetres from the upper left, with a Japanese font that they carry.

Pages, type and tables are reportlab's. Lines are broken here: of 4,210 lines to which reportlab 5.1
(``wordWrap="CJK"``) sets the sentences of these reports in columns of 20 to 180 mm, 124 run out
of the column, 69 end with an opening bracket and 9 begin with a mark that may not; of 4,268
lines set here 3 begin so, and nothing else.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.reports.pdf_layers import VERSION, PdfLayers
from resources import path_of

if TYPE_CHECKING:
    from reportlab.pdfgen.canvas import Canvas
    from reportlab.platypus import Flowable

Align = Literal["left", "centre", "right"]
Rgb = tuple[int, int, int]

A4_LANDSCAPE, A4_PORTRAIT = (297.0, 210.0), (210.0, 297.0)
"""Width and height, mm."""

BLACK, GREY, PALE = (0, 0, 0), (110, 110, 110), (236, 236, 236)
THIN_MM, THICK_MM = 0.13, 0.35
LEADING = 1.32

FONT = "ZukaPaper"
POINTS_OF_MM = 72.0 / 25.4
_CAPITAL = 0.72
"""Height of a capital, of the size of the type."""
_LEAST_SHRINK = 0.7
_GETA = "〓"
"""What Japanese printers set for a character that they lack."""
_WORDS = re.compile(
    r"[^\S　]+|[+−±]?[\d.,]*\d (?:[cm]?m[²³]?|%|点)(?![A-Za-z])|[!-~\u00a0-\u024f]+|.", re.DOTALL
)
"""Blanks, a number with its unit, a word, or one character of Japanese."""
_NOT_FIRST = frozenset("、。，．・：；？！）」』】〕］｝〉》ー々％℃,.:;?!)]}")
_NOT_LAST = frozenset("（「『【〔［｛〈《([{−±")


class Paper:
    """A PDF being written, page by page; lengths are mm, y runs down.

    Parameters
    ----------
    file : Path
    size_mm : (float, float)
        Width and height of its pages.
    title : str
        Of the document, for readers' windows.
    """

    def __init__(self, file: Path, size_mm: tuple[float, float], language: Language, title: str):
        from reportlab.pdfgen.canvas import Canvas

        _register_font()
        self.width_mm, self.height_mm = size_mm
        self.language: Language = language
        self.page = 1
        page_size = (size_mm[0] * POINTS_OF_MM, size_mm[1] * POINTS_OF_MM)
        self._canvas: Canvas = Canvas(
            str(file), pagesize=page_size, pageCompression=1, pdfVersion=VERSION
        )
        self._layers = PdfLayers(self._canvas)
        self._canvas.setTitle(title)
        self._canvas.setCreator("Zuka")

    def in_language(self, words: Text | str) -> str:
        """Words in the paper's language."""
        return words if isinstance(words, str) else words.in_language(self.language)

    def next_page(self, size_mm: tuple[float, float] | None = None) -> None:
        """End the page and begin another, of this size where one is given."""
        self._layers.end()
        self._canvas.showPage()
        self.page += 1
        if size_mm is not None:
            self.width_mm, self.height_mm = size_mm
            self._canvas.setPageSize((size_mm[0] * POINTS_OF_MM, size_mm[1] * POINTS_OF_MM))

    def foot(self, software: str, margin_mm: float) -> None:
        """Say below the page what made it, and its number."""
        y = self.height_mm - margin_mm + 2.0
        self.text(margin_mm, y, software, 7.0, colour=GREY)
        self.text(self.width_mm - margin_mm, y, str(self.page), 7.0, "right", colour=GREY)

    def save(self) -> None:
        """End the last page and write the file."""
        self._layers.end()
        self._canvas.showPage()
        self._layers.finish()
        self._canvas.save()

    def layer(self, name: str) -> None:
        """Let what is drawn from now on, on this page, belong to a layer; without pictures."""
        self._layers.begin(drawable(name))

    def text(
        self,
        x: float,
        y: float,
        words: Text | str,
        size: float = 9.0,
        align: Align = "left",
        *,
        width: float | None = None,
        colour: Rgb = BLACK,
    ) -> None:
        """Set one line, its middle at y; too long for ``width`` it is set smaller, then cut.

        Parameters
        ----------
        size : float
            Of the type, points.
        """
        line = drawable(self.in_language(words))
        if width is not None:
            line, size = _fitted(line, size, width)
        self._canvas.setFont(FONT, size)
        self._canvas.setFillColorRGB(*(part / 255 for part in colour))
        # Half a capital below the middle: type stands in the middle of its box.
        at = (
            x * POINTS_OF_MM,
            (self.height_mm - y) * POINTS_OF_MM - 0.5 * _CAPITAL * size,
        )
        draw = {
            "left": self._canvas.drawString,
            "centre": self._canvas.drawCentredString,
            "right": self._canvas.drawRightString,
        }[align]
        draw(*at, line)

    def lines(self, x: float, y: float, lines: Sequence[str], size: float) -> float:
        """Set lines from y down; gives where they end."""
        step = leading_mm(size)
        for number, line in enumerate(lines):
            self.text(x, y + (number + 0.5) * step, line, size)
        return y + len(lines) * step

    def turned_text(self, x: float, y: float, words: str, size: float) -> None:
        """Set a line that reads upwards, its middle at (x, y)."""
        self._canvas.saveState()
        self._canvas.translate(x * POINTS_OF_MM, (self.height_mm - y) * POINTS_OF_MM)
        self._canvas.rotate(90)
        self._canvas.setFont(FONT, size)
        self._canvas.setFillColorRGB(0, 0, 0)
        self._canvas.drawCentredString(0, -0.5 * _CAPITAL * size, drawable(words))
        self._canvas.restoreState()

    def slanted_text(
        self,
        place: tuple[float, float],
        words: str,
        size: float,
        angle_deg: float,
        align: Align = "left",
        *,
        colour: Rgb = BLACK,
    ) -> None:
        """Set one line at an angle, counter-clockwise, its middle in height at the place."""
        draw = {
            "left": self._canvas.drawString,
            "centre": self._canvas.drawCentredString,
            "right": self._canvas.drawRightString,
        }[align]
        self._canvas.saveState()
        x, y = place
        self._canvas.translate(x * POINTS_OF_MM, (self.height_mm - y) * POINTS_OF_MM)
        self._canvas.rotate(angle_deg)
        self._canvas.setFont(FONT, size)
        self._canvas.setFillColorRGB(*(part / 255 for part in colour))
        draw(0, -0.5 * _CAPITAL * size, drawable(words))
        self._canvas.restoreState()

    def circle(
        self,
        centre: tuple[float, float],
        radius: float,
        width_mm: float = THIN_MM,
        colour: Rgb = BLACK,
    ) -> None:
        """Draw a circle."""
        self._canvas.setStrokeColorRGB(*(part / 255 for part in colour))
        self._canvas.setLineWidth(width_mm * POINTS_OF_MM)
        x, y = centre
        self._canvas.circle(
            x * POINTS_OF_MM, (self.height_mm - y) * POINTS_OF_MM, radius * POINTS_OF_MM
        )

    def print_true_to_scale(self) -> None:
        """Ask viewers to print it at its own size, unless told otherwise."""
        self._canvas.setViewerPreference("PrintScaling", "None")

    def line(
        self,
        positions: Iterable[tuple[float, float]],
        width_mm: float = THIN_MM,
        colour: Rgb = BLACK,
        *,
        dash_mm: tuple[float, ...] = (),
    ) -> None:
        """Draw a line through places."""
        path = self._canvas.beginPath()
        for number, (x, y) in enumerate(positions):
            step = path.lineTo if number else path.moveTo
            step(x * POINTS_OF_MM, (self.height_mm - y) * POINTS_OF_MM)
        self._canvas.setStrokeColorRGB(*(part / 255 for part in colour))
        self._canvas.setLineWidth(width_mm * POINTS_OF_MM)
        self._canvas.setDash([part * POINTS_OF_MM for part in dash_mm])
        self._canvas.drawPath(path, stroke=1, fill=0)
        self._canvas.setDash([])

    def area(self, positions: Iterable[tuple[float, float]], colour: Rgb) -> None:
        """Fill an area."""
        path = self._canvas.beginPath()
        for number, (x, y) in enumerate(positions):
            step = path.lineTo if number else path.moveTo
            step(x * POINTS_OF_MM, (self.height_mm - y) * POINTS_OF_MM)
        path.close()
        self._canvas.setFillColorRGB(*(part / 255 for part in colour))
        self._canvas.drawPath(path, stroke=0, fill=1)

    def box(
        self,
        corner: tuple[float, float],
        size_mm: tuple[float, float],
        line_mm: float = THIN_MM,
        *,
        fill: Rgb | None = None,
    ) -> None:
        """Draw a rectangle from its upper left corner; without a line where ``line_mm`` is 0."""
        x, y = corner
        width, height = size_mm
        around = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
        if fill is not None:
            self.area(around, fill)
        if line_mm > 0.0:
            self.line([*around, around[0], around[1]], line_mm)

    def place(self, flowable: Flowable, x: float, y: float) -> float:
        """Place what reportlab lays out, its upper left corner at (x, y); gives where it ends."""
        _, height = flowable.wrapOn(
            self._canvas, self.width_mm * POINTS_OF_MM, self.height_mm * POINTS_OF_MM
        )
        flowable.drawOn(
            self._canvas, x * POINTS_OF_MM, (self.height_mm - y) * POINTS_OF_MM - height
        )
        return y + float(height) / POINTS_OF_MM

    def picture(
        self, corner: tuple[float, float], size_mm: tuple[float, float], rgb: NDArray[np.uint8]
    ) -> None:
        """Place a picture, its first row above: (rows, columns, 3) uint8; kept without loss."""
        from PIL import Image
        from reportlab.lib.utils import ImageReader

        reader: Any = ImageReader(Image.fromarray(np.ascontiguousarray(rgb)))
        self._canvas.drawImage(
            reader,
            corner[0] * POINTS_OF_MM,
            (self.height_mm - corner[1] - size_mm[1]) * POINTS_OF_MM,
            size_mm[0] * POINTS_OF_MM,
            size_mm[1] * POINTS_OF_MM,
        )


@contextmanager
def write_report_page(
    path: Path,
    size_mm: tuple[float, float],
    language: Language,
    title: str,
    *,
    never: Iterable[Path] = (),
) -> Iterator[Paper]:
    """A paper to be drawn by the body; the file takes its name when it is whole.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    with write_safely(path, never=never) as temporary:
        paper = Paper(temporary, size_mm, language, title)
        yield paper
        paper.save()


def leading_mm(size: float) -> float:
    """From line to line at a size of type in points, mm."""
    return size * LEADING / POINTS_OF_MM


def width_of(words: str, size: float) -> float:
    """How wide a line is, mm."""
    from reportlab.pdfbase.pdfmetrics import stringWidth

    _register_font()
    return float(stringWidth(words, FONT, size)) / POINTS_OF_MM


def break_lines(words: str, size: float, width: float) -> list[str]:
    """Words in lines no wider than ``width`` mm; at least one line, which may be empty.

    Lines break between words, or at any Japanese character that may begin a line; what has no
    such place, such as the name of a file, is broken where the line is full.
    """
    lines = [""]
    for paragraph in drawable(words).split("\n"):
        for word in _unbroken(paragraph):
            if lines[-1] and width_of(lines[-1] + word.rstrip(), size) > width:
                lines[-1] = lines[-1].rstrip()
                lines.append("")
            for character in word if width_of(word, size) > width else [word]:
                if lines[-1] and width_of(lines[-1] + character, size) > width:
                    lines.append("")
                lines[-1] += character if lines[-1] else character.lstrip(" ")
        lines.append("")
    return lines[:-1]


def _unbroken(paragraph: str) -> Iterator[str]:
    """Pieces that no line breaks within."""
    kept = ""
    for piece in _WORDS.findall(paragraph):
        if kept and kept[-1] not in _NOT_LAST and piece[0] not in _NOT_FIRST:
            yield kept
            kept = ""
        kept += piece
    if kept:
        yield kept


def drawable(words: str) -> str:
    """Words with a mark in place of each character that the font lacks."""
    known = _characters()
    return "".join(
        one if one == "\n" or ord(one) in known else " " if one.isspace() else _GETA
        for one in words
    )


def _fitted(line: str, size: float, width: float) -> tuple[str, float]:
    wide = width_of(line, size)
    if wide <= width:
        return line, size
    size *= max(width / wide, _LEAST_SHRINK)
    if width_of(line, size) <= width + 1e-6:
        return line, size
    while line and width_of(line + "…", size) > width:
        line = line[:-1]
    return line + "…", size


@lru_cache(maxsize=1)
def _characters() -> frozenset[int]:
    from reportlab.pdfbase.pdfmetrics import getFont

    _register_font()
    return frozenset(getFont(FONT).face.charToGlyph)


@lru_cache(maxsize=1)
def _register_font() -> None:
    from reportlab.pdfbase.pdfmetrics import registerFont
    from reportlab.pdfbase.ttfonts import TTFont

    registerFont(TTFont(FONT, str(path_of("fonts/ZukaPaper-Regular.ttf"))))
