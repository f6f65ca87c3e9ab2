"""Papers as SVG, which browsers show and word processors take, in millimetres."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from processing.formats.sheets.paper_shapes import (
    TYPE_OF_HEIGHT,
    PaperCircle,
    PaperLine,
    PaperShape,
    PaperWords,
    Rgb,
)

_FONT = "'ZukaPaper','Noto Sans CJK JP','Yu Gothic','Hiragino Sans','Meiryo',sans-serif"
_ANCHORS = {"LEFT": "start", "CENTER": "middle", "RIGHT": "end"}
_BASELINE = 0.36
"""Of the type's size, from the middle of capitals down to their feet."""

_DIGITS = 3


def paper_svg(shapes: Iterable[PaperShape], size_mm: tuple[float, float]) -> str:
    """A page of shapes on white."""
    width, height = size_mm
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" '
        f'width="{width:g}mm" height="{height:g}mm">',
        f'<rect width="{width:g}" height="{height:g}" fill="#ffffff"/>',
        f'<g font-family="{_FONT}" stroke-linejoin="round" stroke-linecap="round">',
        *(_shape(one, height) for one in shapes),
        "</g></svg>",
    ]
    return "\n".join(parts) + "\n"


def _shape(shape: PaperShape, height: float) -> str:
    colour = _hex(shape.pen.colour)
    stroke = f'fill="none" stroke="{colour}" stroke-width="{shape.pen.width_mm:g}"'
    match shape:
        case PaperLine():
            places = " ".join(f"{x:.{_DIGITS}f},{height - y:.{_DIGITS}f}" for x, y in shape.places)
            if shape.is_filled:
                return f'<polygon points="{places}" fill="{colour}"/>'
            dash = ",".join(f"{one:g}" for one in shape.pen.dash_mm)
            dashes = f' stroke-dasharray="{dash}"' if dash else ""
            return f'<polyline points="{places}" {stroke}{dashes}/>'
        case PaperCircle():
            x, y = shape.centre
            return (
                f'<circle cx="{x:.{_DIGITS}f}" cy="{height - y:.{_DIGITS}f}" '
                f'r="{shape.radius:g}" {stroke}/>'
            )
        case PaperWords():
            return _words(shape, height)


def _words(words: PaperWords, height: float) -> str:
    size = words.height * TYPE_OF_HEIGHT
    x, y = words.place[0], height - words.place[1]
    turned = f' transform="rotate({-words.angle_deg:g} {x:.3f} {y:.3f})"' * bool(words.angle_deg)
    return (
        f'<text x="{x:.{_DIGITS}f}" y="{y + _BASELINE * size:.{_DIGITS}f}" font-size="{size:.3f}" '
        f'text-anchor="{_ANCHORS[words.align]}" fill="{_hex(words.pen.colour)}"{turned}>'
        f"{escape(words.words)}</text>"
    )


def _hex(colour: Rgb) -> str:
    return "#{:02x}{:02x}{:02x}".format(*colour)
