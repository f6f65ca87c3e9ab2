"""Areas of a drawing filled with a colour or with slanting lines, and colours of old versions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

_OUTER, _HOLE = 1, 0  # DXF group 92: 1 is an external path
_EVEN_ODD = 0
_AREAS_A_HATCH = 64
_LAYER_COLOUR = 256
_INDICES = (*range(10, 250), 255)
"""Colour indices that look the same on white and black."""


@dataclass(frozen=True)
class Ink:
    """A colour of a layer.

    Attributes
    ----------
    aci : int
        AutoCAD colour index, all that R2000 knows.
    rgb : (int, int, int) or None
        None for exactly the index.
    """

    aci: int
    rgb: tuple[int, int, int] | None = None


def inks_of(colours: Sequence[tuple[int, int, int]]) -> tuple[Ink, ...]:
    """Inks for a legend: no two have the same index, each is near to its colour as eyes see it."""
    from ezdxf.colors import DXF_DEFAULT_COLORS, int2rgb
    from scipy.optimize import linear_sum_assignment

    known = np.array([int2rgb(DXF_DEFAULT_COLORS[index]) for index in _INDICES])
    apart = _lab(np.array(colours))[:, None] - _lab(known)
    _, chosen = linear_sum_assignment((apart**2).sum(axis=2))
    pairs = zip(chosen.tolist(), colours, strict=True)
    return tuple(Ink(_INDICES[index], rgb) for index, rgb in pairs)


def _lab(rgb: NDArray[np.int64]) -> NDArray[np.float32]:
    """Colours (n, 3) as CIE L*a*b*, in which distances are those that eyes see."""
    import cv2

    found = cv2.cvtColor((rgb[None] / 255.0).astype(np.float32), cv2.COLOR_RGB2LAB)
    return np.asarray(found[0], dtype=np.float32)


def add_areas(
    space: Any,  # an ezdxf layout; ezdxf is not typed here
    areas: Sequence[shapely.Polygon],
    layer: str,
    *,
    lines_m: float = 0.0,
) -> None:
    """Fill polygons, their holes left out, with the layer's colour.

    Parameters
    ----------
    areas : sequence of shapely.Polygon
        They don't overlap. Some dozen share one hatch: thousands of hatches are slow to read,
        and one of thousands of outlines is slow to draw.
    lines_m : float
        Distance of slanting lines to fill them with, m; 0 for a full fill.
    """
    for start in range(0, len(areas), _AREAS_A_HATCH):
        hatch = space.add_hatch(color=_LAYER_COLOUR, dxfattribs={"layer": layer})
        hatch.dxf.hatch_style = _EVEN_ODD
        if lines_m:
            across = lines_m * 0.5**0.5
            hatch.set_pattern_definition([[45.0, (0.0, 0.0), (-across, across), []]])
            hatch.dxf.solid_fill = 0
            hatch.dxf.pattern_name = "ANSI31"
        for area in areas[start : start + _AREAS_A_HATCH]:
            holes = [(hole, _HOLE) for hole in area.interiors]
            for ring, flags in ((area.exterior, _OUTER), *holes):
                positions = shapely.get_coordinates(ring)[:-1].tolist()
                hatch.paths.add_polyline_path(positions, is_closed=True, flags=flags)


def add_box(
    space: Any,  # as in `add_areas`
    low: tuple[float, float],
    size: tuple[float, float],
    layers: tuple[str, str],
    *,
    lines_m: float = 0.0,
) -> None:
    """Draw a filled box of a legend.

    Its frame is made of lines: only boundaries are closed polylines.

    Parameters
    ----------
    layers : (str, str)
        Of the fill and of the frame.
    """
    (x, y), (width, height) = low, size
    add_areas(space, [shapely.box(x, y, x + width, y + height)], layers[0], lines_m=lines_m)
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    for start, end in pairwise([*corners, corners[0]]):
        space.add_line(start, end, dxfattribs={"layer": layers[1]})
