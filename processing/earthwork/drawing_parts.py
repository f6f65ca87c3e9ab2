"""What drawings and exchange files of earthwork are made of: sections along a line, contours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class DrawnSection:
    """Two grounds across a line at one of its stations.

    Attributes
    ----------
    station_m : float
        Along the line, in plan.
    name : str
        As offices name it (``No.1+5.0``).
    offsets : (n,) float64
        m, ascending; left of the line is negative.
    before, after : (n,) float64
        Heights there, m; NaN without ground.
    cut_m2, fill_m2 : float
        Between the two, neither negative.
    """

    station_m: float
    name: str
    offsets: Floats
    before: Floats
    after: Floats
    cut_m2: float
    fill_m2: float


@dataclass(frozen=True)
class SectionedLine:
    """A line in plan with the sections across it.

    Attributes
    ----------
    xy : (k, 2) float64
        Easting and northing of its corners, m, project CRS.
    start_m : float
        Station of the first corner.
    """

    name: str
    xy: Floats
    start_m: float
    sections: tuple[DrawnSection, ...]


@dataclass(frozen=True)
class DrawnContour:
    """A line of one height.

    Attributes
    ----------
    xy : (k, 2) float64
        m, project CRS; the last place is the first one where it is closed.
    is_index : bool
        One of those that are drawn heavier and told by their height (計曲線).
    """

    xy: Floats
    height_m: float
    is_index: bool


def parts_with_ground(offsets: Floats, heights: Floats) -> list[Floats]:
    """The stretches of a section that have ground: each (k, 2), offset and height, k > 1."""
    has_ground = np.isfinite(heights)
    breaks = np.flatnonzero(np.diff(has_ground.astype(np.int8))) + 1
    both = np.column_stack([offsets, heights])
    return [part for part in np.split(both, breaks) if len(part) > 1 and np.isfinite(part).all()]
