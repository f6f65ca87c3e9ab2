"""DrawingSheet: the part of the map that a sheet of paper shows, and how it lies on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.formats.sheets.paper_shapes import PaperPlace
from processing.formats.sheets.sheet_layout import SheetLayout


@dataclass(frozen=True)
class MatchLine:
    """A line at which two sheets are joined.

    Attributes
    ----------
    start, end : (float, float)
        Easting and northing, m.
    station : str
        Where the route is there.
    to : int
        Number of the other sheet.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    station: str
    to: int


@dataclass(frozen=True)
class DrawingSheet:
    """A sheet.

    Attributes
    ----------
    name : str
        Identifier in the map grid, row and column of a plain grid, stretch of a route.
    centre : (float, float)
        Easting and northing of the window's middle, m.
    size_m : (float, float)
        Width and height of the window on the ground.
    scale : int
        Its denominator.
    turned_deg : float
        Direction of the paper's lower edge on the ground, counter-clockwise from east.
    matches : tuple of MatchLine
    """

    name: str
    centre: tuple[float, float]
    size_m: tuple[float, float]
    scale: int
    turned_deg: float = 0.0
    matches: tuple[MatchLine, ...] = ()

    @property
    def window(self) -> shapely.Polygon:
        """The window on the ground, m."""
        width, height = self.size_m
        corners = [(-width / 2, -height / 2), (width / 2, -height / 2),
                   (width / 2, height / 2), (-width / 2, height / 2)]  # fmt: skip
        return shapely.Polygon(_turned(np.array(corners), self.turned_deg) + self.centre)

    def on_paper(self, places: Floats, layout: SheetLayout) -> Floats:
        """Places (n, 2) on the ground, m, as millimetres on paper."""
        local = _turned(np.asarray(places, dtype=np.float64) - self.centre, -self.turned_deg)
        placed: Floats = local * (1000.0 / self.scale) + layout.window_centre
        return placed

    def on_ground(self, places: Sequence[PaperPlace], layout: SheetLayout) -> Floats:
        """Places (n, 2) on paper, mm, as metres on the ground."""
        local = np.asarray(places, dtype=np.float64) - layout.window_centre
        placed: Floats = _turned(local * (self.scale / 1000.0), self.turned_deg) + self.centre
        return placed


def _turned(places: Floats, degrees: float) -> Floats:
    if not degrees:
        return places
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turned: Floats = places @ np.array([[cos, sin], [-sin, cos]])
    return turned
