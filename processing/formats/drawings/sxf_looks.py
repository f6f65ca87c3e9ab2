"""How a map looks in SXF: its predefined colours, line types and widths, layers by code.

Layers are those of the standard for CAD drawings in electronic delivery (CAD製図基準): surveying
(S), an object, an element. The table gives a layer by the class code's beginning, the longest
first; a city's own list replaces it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from processing.map.catalogue import Catalogue, FeatureKind

FRAME_LAYER, TITLE_LAYER, NOTE_LAYER = "S-TTL-FRAM", "S-TTL-TXT", "S-BGD-TXT"

_LAYERS: Mapping[str, str] = {
    "7101": "S-BGD-HICN",  # index contours
    "7102": "S-BGD-LWCN",  # contours between them
    "73": "S-BMK-SRVR",  # control points and spot heights
    "4211": "S-BMK-ROW",  # boundary stakes
    "6522": "S-BMK-ROW",  # boundary of the road's land
    "": "S-BGD-EXST",  # what exists
}
LABEL_SUFFIX = "_文字"
_DIMENSION_LAYER = "S-STR-DIM"
_WIDTH_KIND = "width_line"

COLOURS: Mapping[str, tuple[int, int, int]] = {
    "black": (0, 0, 0),
    "red": (255, 0, 0),
    "green": (0, 255, 0),
    "blue": (0, 0, 255),
    "yellow": (255, 255, 0),
    "magenta": (255, 0, 255),
    "cyan": (0, 255, 255),
    "white": (255, 255, 255),
    "deeppink": (192, 0, 128),
    "brown": (192, 128, 64),
    "orange": (255, 128, 0),
    "lightgreen": (128, 192, 128),
    "lightblue": (0, 128, 255),
    "lavender": (128, 64, 255),
    "lightgray": (192, 192, 192),
    "darkgray": (128, 128, 128),
}
"""The predefined colours in the order of their codes, from 1."""

_ON_WHITE = {name: rgb for name, rgb in COLOURS.items() if name != "white"}
"""A drawing is printed on white."""

LINE_TYPES: Mapping[str, int] = {
    "continuous": 1,
    "dashed": 2,
    "dashed spaced": 3,
    "long dashed dotted": 4,
    "dotted": 7,
    "chain": 8,
}
"""Of the predefined line types those that are used, with their codes."""

_TYPES: Mapping[str, str] = {
    "continuous": "continuous",
    "dashed": "dashed",
    "short_dashed": "dashed",
    "gutter_dashed": "dashed",
    "long_dashed": "dashed",
    "boundary": "dashed spaced",
    "dotted": "dotted",
    "dash_dot": "chain",
    "dash_two_dots": "long dashed dotted",
}
"""The nearest to a pattern of the catalogue."""

WIDTHS_MM = (0.13, 0.18, 0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0)
"""The predefined widths in the order of their codes, from 1."""

_PENS_MM: Mapping[str, float] = {
    "1106": 0.20,
    "3002": 0.30,
    "6141": 0.30,
    "7101": 0.20,
    "7102": 0.10,
}
_PEN_MM = 0.15
"""Pens of level 500 by class code, and the usual one (公共測量標準図式, 線号)."""


def layer_of(kind: FeatureKind) -> str:
    """The layer that a kind is drawn on."""
    if kind.id == _WIDTH_KIND:
        return _DIMENSION_LAYER
    begins = (code for code in _LAYERS if kind.dm_code.startswith(code))
    return _LAYERS[max(begins, key=len)]


def cad_catalogue(catalogue: Catalogue) -> Catalogue:
    """The same kinds on the layers of CAD製図基準."""
    return Catalogue(tuple(replace(kind, layer=layer_of(kind)) for kind in catalogue))


def label_layer(layer: str) -> str:
    """The layer of the words beside what lies on a layer."""
    is_cad = layer == _DIMENSION_LAYER or layer in _LAYERS.values()
    return NOTE_LAYER if is_cad else f"{layer}{LABEL_SUFFIX}"


def colour_of(kind: FeatureKind) -> int:
    """The code of the predefined colour nearest to a kind's."""
    value = int(kind.colour[1:], 16)
    own = (value >> 16, value >> 8 & 255, value & 255)
    nearest = min(
        _ON_WHITE,
        key=lambda name: sum((a - b) ** 2 for a, b in zip(own, _ON_WHITE[name], strict=True)),
    )
    return list(COLOURS).index(nearest) + 1


def line_type_of(kind: FeatureKind) -> int:
    """The code of the predefined line type for a kind."""
    return LINE_TYPES[_TYPES[kind.line_type]]


def pen_mm_of(kind: FeatureKind) -> float:
    """The width of a kind's pen on a map of level 500."""
    return _PENS_MM.get(kind.dm_code, _PEN_MM)


def width_of(kind: FeatureKind) -> int:
    """The code of the predefined width nearest to a kind's pen."""
    pen = pen_mm_of(kind)
    nearest = min(WIDTHS_MM, key=lambda width: abs(width - pen))
    return WIDTHS_MM.index(nearest) + 1
