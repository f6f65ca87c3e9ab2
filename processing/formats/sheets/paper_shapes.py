"""What is drawn on a sheet of paper, for every form in which sheets are written.

Places are millimetres on paper from the sheet's lower left corner, y upwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from processing.formats.reports.pdf_page import POINTS_OF_MM, break_lines, leading_mm, width_of

PaperPlace = tuple[float, float]
Rgb = tuple[int, int, int]

BLACK: Rgb = (0, 0, 0)
GREY: Rgb = (200, 200, 200)

TYPE_OF_HEIGHT = 1.1
"""Size of the type for a height of letters: kanji fill some nine tenths of their box."""

_SHRINKS = (1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.3)


@dataclass(frozen=True)
class Pen:
    """Layer, colour, width and dashes of a line.

    Attributes
    ----------
    dash_mm : tuple of float
        Dash and gap in turn; empty for a full line.
    line_type : str
        The same as a key of :data:`processing.map.catalogue.LINE_TYPES`.
    """

    layer: str
    colour: Rgb = BLACK
    width_mm: float = 0.15
    dash_mm: tuple[float, ...] = ()
    line_type: str = "continuous"


@dataclass(frozen=True)
class PaperLine:
    """A line through places; a filled area where it says so."""

    pen: Pen
    places: tuple[PaperPlace, ...]
    is_filled: bool = False


@dataclass(frozen=True)
class PaperCircle:
    """A circle."""

    pen: Pen
    centre: PaperPlace
    radius: float


@dataclass(frozen=True)
class PaperWords:
    """A line of words.

    Attributes
    ----------
    align : "LEFT", "CENTER" or "RIGHT"
        Which part is at the place; its middle in height.
    height : float
        Of the letters, mm.
    angle_deg : float
        Counter-clockwise from the paper's lower edge.
    """

    pen: Pen
    words: str
    place: PaperPlace
    height: float
    align: str = "LEFT"
    angle_deg: float = 0.0


PaperShape = PaperLine | PaperCircle | PaperWords


def type_points(height: float) -> float:
    """The size of type, points, of letters of a height in mm."""
    return height * TYPE_OF_HEIGHT * POINTS_OF_MM


def words_width(words: str, height: float) -> float:
    """How wide a line of words is, mm."""
    return width_of(words, type_points(height))


def box_line(pen: Pen, low: PaperPlace, size: PaperPlace, *, is_filled: bool = False) -> PaperLine:
    """A rectangle from its lower left corner."""
    (x, y), (width, height) = low, size
    around = ((x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y))
    return PaperLine(pen, around, is_filled)


def words_in_box(
    words: str,
    low: PaperPlace,
    size: PaperPlace,
    height: float,
    *,
    layer: str,
    align: str = "LEFT",
) -> Iterable[PaperWords]:
    """Words in a box, in lines and smaller where they are long; cut with … as a last resort."""
    width, room = size
    lines: Sequence[str] = ()
    shrunk = height
    for share in _SHRINKS:
        shrunk = height * share
        lines = break_lines(words, type_points(shrunk), width)
        most = max(room, leading_mm(type_points(height)))
        if len(lines) * leading_mm(type_points(shrunk)) <= most:
            break
    else:
        count = max(1, int(room / leading_mm(type_points(shrunk))))
        lines = [*lines[: count - 1], lines[count - 1][:-1] + "…"]
    step = leading_mm(type_points(shrunk))
    x = low[0] + {"LEFT": 0.0, "CENTER": width / 2, "RIGHT": width}[align]
    top = low[1] + room / 2 + (len(lines) - 1) / 2 * step
    pen = Pen(layer)
    for number, line in enumerate(lines):
        yield PaperWords(pen, line, (x, top - number * step), shrunk, align)
