"""What drawings and exchange files of earthwork make of sections along a line."""

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
        As offices name it (``No.1+5.00``).
    offsets : (n,) float64
        m, ascending; left of the line is negative.
    before, after : (n,) float64
        Heights there, m; NaN without ground.
    cut_m2, fill_m2 : float
        Between the two within the boundary, neither negative.
    is_inside : (n − 1,) bool or None
        Which of the steps from one offset to the next are within the boundary; None for all.
    """

    station_m: float
    name: str
    offsets: Floats
    before: Floats
    after: Floats
    cut_m2: float
    fill_m2: float
    is_inside: NDArray[np.bool_] | None = None


@dataclass(frozen=True)
class SectionedLine:
    """A line in plan with the sections across it.

    Attributes
    ----------
    xy : (k, 2) float64
        Easting and northing of its corners, m, project CRS.
    start_m : float
        Station of the first corner.
    ground : tuple of (k, 2) float64
        Stations and heights along it, a part for each stretch without gap.
    """

    name: str
    xy: Floats
    start_m: float
    sections: tuple[DrawnSection, ...]
    ground: tuple[Floats, ...] = ()


def parts_with_ground(offsets: Floats, heights: Floats) -> list[Floats]:
    """The stretches of a section that have ground: each (k, 2), offset and height, k > 1."""
    has_ground = np.isfinite(heights)
    breaks = np.flatnonzero(np.diff(has_ground.astype(np.int8))) + 1
    both = np.column_stack([offsets, heights])
    return [part for part in np.split(both, breaks) if len(part) > 1 and np.isfinite(part).all()]


def earth_moved(section: DrawnSection) -> list[tuple[bool, Floats]]:
    """What lies between the two grounds of a section within the boundary, cut where they cross.

    Returns
    -------
    list of (bool, (k, 2) float64)
        True for cut; corners, offset and height, along the earlier ground and back along the
        later one.
    """
    positions = np.column_stack([section.offsets, section.before, section.after])
    is_known = np.isfinite(positions.sum(axis=1))
    counts = is_known[:-1] & is_known[1:]
    if section.is_inside is not None:
        counts &= section.is_inside
    bounds = np.flatnonzero(np.diff(counts.astype(np.int8), prepend=0, append=0))
    stretches = [positions[start : end + 1] for start, end in bounds.reshape(-1, 2).tolist()]
    return [lens for stretch in stretches for lens in _lenses(stretch)]


def _lenses(part: Floats) -> list[tuple[bool, Floats]]:
    """Cut and fill between two lines: (n, 3), offset, earlier and later height, all known."""
    change = part[:, 2] - part[:, 1]
    crosses = np.flatnonzero(change[:-1] * change[1:] < 0)
    share = change[crosses] / (change[crosses] - change[crosses + 1])
    between = part[crosses] + share[:, None] * (part[crosses + 1] - part[crosses])
    between[:, 2] = between[:, 1]
    positions = np.insert(part, crosses + 1, between, axis=0)
    change = positions[:, 2] - positions[:, 1]
    side = np.sign(change[:-1] + change[1:])  # of each stretch
    bounds = np.flatnonzero(np.diff(side)) + 1
    lenses = []
    for start, end in zip([0, *bounds], [*bounds, len(side)], strict=True):
        if end > start and side[start]:
            stretch = positions[start : end + 1]
            outline = np.concatenate([stretch[:, [0, 1]], stretch[::-1][:, [0, 2]]])
            lenses.append((bool(side[start] < 0), outline))
    return lenses
