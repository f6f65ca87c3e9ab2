"""A drawing as SXF holds it, for both of its forms: a sheet, the map on it as a partial figure.

The partial figure holds the map in millimetres on the ground, east and north of its origin; it is
placed on the sheet at the drawing's scale.
"""

from __future__ import annotations

from dataclasses import dataclass, field

Place = tuple[float, float]

PAPERS_MM = ((841, 1189), (594, 841), (420, 594), (297, 420), (210, 297))
"""A0 to A4; their numbers are the sheet types."""

FONT = "ＭＳ ゴシック"
MAP_FIGURE = "平面図"


@dataclass(frozen=True)
class SxfStyle:
    """A layer's name and codes of a colour, a line type and a width."""

    layer: str
    colour: int
    line_type: int = 1
    width: int = 1


@dataclass(frozen=True)
class SxfLine:
    """A polyline of at least two different places, mm."""

    style: SxfStyle
    places: tuple[Place, ...]


@dataclass(frozen=True)
class SxfCircle:
    """A circle, mm."""

    style: SxfStyle
    centre: Place
    radius: float


@dataclass(frozen=True)
class SxfText:
    """A line of words.

    Attributes
    ----------
    base : int
        Which part of the words is at their place: 1 to 3 below, 4 to 6 in the middle, 7 to 9
        above; left, centre, right.
    height, width : float
        mm, of all words together.
    angle_deg : float
        Counter-clockwise from east.
    """

    style: SxfStyle
    words: str
    place: Place
    height: float
    width: float
    angle_deg: float = 0.0
    base: int = 1


SxfShape = SxfLine | SxfCircle | SxfText


@dataclass
class SxfDrawing:
    """A sheet.

    Attributes
    ----------
    paper : int
        0 to 4, A0 to A4; landscape.
    scale : int
        Its denominator.
    placed_at : Place
        Where the partial figure's origin is on the sheet, mm on paper.
    on_map, on_paper : list of shapes
        In the partial figure, mm on the ground; beside it, mm on paper.
    """

    title: str
    paper: int
    scale: int
    placed_at: Place
    date: tuple[int, int, int]
    time: str
    on_map: list[SxfShape] = field(default_factory=list)
    on_paper: list[SxfShape] = field(default_factory=list)

    @property
    def size_mm(self) -> tuple[int, int]:
        """Width and height of the sheet."""
        short, long = PAPERS_MM[self.paper]
        return long, short

    @property
    def styles(self) -> tuple[SxfStyle, ...]:
        """All that are used."""
        return tuple(shape.style for shape in (*self.on_map, *self.on_paper))

    @property
    def layers(self) -> tuple[str, ...]:
        """The names of the layers that are used; their codes are their places, from 1."""
        return tuple(dict.fromkeys(style.layer for style in self.styles))
