"""What drawings and exchange files of earthwork make of sections along a line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.earthwork.cross_sections import CrossSection

Floats = NDArray[np.float64]

_INTERVAL_M, _LEAST_REST_M = 20.0, 0.005


@dataclass(frozen=True)
class SectionedLine:
    """A line in plan with the sections across it.

    Attributes
    ----------
    xy : (k, 2) float64
        Easting and northing of its corners, m, project CRS; stations count from the first.
    """

    name: str
    xy: Floats
    sections: tuple[CrossSection, ...]


def station_name(station_m: float) -> str:
    """A station as road offices name it: No. 1 is at 20 m, No.1+5.00 five metres on."""
    number, rest = divmod(round(station_m, 2), _INTERVAL_M)
    return f"No.{number:.0f}" + (f"+{rest:.2f}" if rest >= _LEAST_REST_M else "")


def parts_with_ground(offsets: Floats, heights: Floats) -> list[Floats]:
    """The stretches of a section that have ground: each (k, 2), offset and height, k > 1."""
    has_ground = np.isfinite(heights)
    breaks = np.flatnonzero(np.diff(has_ground.astype(np.int8))) + 1
    both = np.column_stack([offsets, heights])
    return [part for part in np.split(both, breaks) if len(part) > 1 and np.isfinite(part).all()]


def moved_parts(section: CrossSection) -> list[tuple[bool, Floats]]:
    """What lies between the two grounds of a section within the boundary, cut where they cross.

    Returns
    -------
    list of (bool, (k, 2) float64)
        True for cut; corners, offset and height, along the earlier ground and back along the
        later one.
    """
    places = np.column_stack([section.offsets_m, section.before, section.after])
    is_known = np.isfinite(places.sum(axis=1))
    counts = section.is_inside & is_known[:-1] & is_known[1:]
    bounds = np.flatnonzero(np.diff(counts.astype(np.int8), prepend=0, append=0))
    stretches = [places[start : end + 1] for start, end in bounds.reshape(-1, 2).tolist()]
    return [lens for stretch in stretches for lens in _lenses(stretch)]


def _lenses(part: Floats) -> list[tuple[bool, Floats]]:
    """Cut and fill between two lines: (n, 3), offset, earlier and later height, all known."""
    change = part[:, 2] - part[:, 1]
    crosses = np.flatnonzero(change[:-1] * change[1:] < 0)
    share = change[crosses] / (change[crosses] - change[crosses + 1])
    between = part[crosses] + share[:, None] * (part[crosses + 1] - part[crosses])
    between[:, 2] = between[:, 1]
    places = np.insert(part, crosses + 1, between, axis=0)
    change = places[:, 2] - places[:, 1]
    side = np.sign(change[:-1] + change[1:])  # of each stretch
    bounds = np.flatnonzero(np.diff(side)) + 1
    lenses = []
    for start, end in zip([0, *bounds], [*bounds, len(side)], strict=True):
        if end > start and side[start]:
            stretch = places[start : end + 1]
            outline = np.concatenate([stretch[:, [0, 1]], stretch[::-1][:, [0, 2]]])
            lenses.append((bool(side[start] < 0), outline))
    return lenses
