"""Volume along a line from the areas of its cross-sections: the traditional check.

Sections stand square to the line, so along a curve they fan out: outside of it they are farther
apart than the stations say, inside nearer. Every area therefore counts with the way that its
centroid goes (Pappus), as the quantity rules ask for by the distance of centroids: with the
bend k between two sections, the area A and its moment M about the line, A becomes A + k M. On a
straight line nothing changes.

References
----------
土木工事数量算出要領, 平均断面法: V = (A1 + A2) / 2 · L; prismoidal: V = L / 6 · (A1 + 4 Am + A2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.sections.cross_sections import (
    CrossSection,
    Moments,
    SectionLayout,
    cross_sections,
    stations_of,
)
from processing.methods.earthwork.sections.height_surfaces import HeightSurface

Floats = NDArray[np.float64]

END_AREA, PRISMOIDAL = "end-area", "prismoidal"

_NOTHING = Moments(0.0, 0.0, 0.0, 0.0)
_SIMPSON_WEIGHTS = (1 / 6, 4 / 6, 1 / 6)
"""Of both ends and the middle in the prismoidal formula: exact for areas of the second degree."""


@dataclass(frozen=True)
class EndAreaVolume:
    """Earth between two grounds along a line.

    Attributes
    ----------
    method : str
        ``end-area`` or ``prismoidal``.
    sections : tuple of CrossSection
        Along the line; with ``prismoidal`` every second one is halfway between two stations.
    cut_m3, fill_m3 : float
        Neither is negative.
    area_m2, missing_m2 : float
        Seen from above, between the first and the last section: where both grounds are, and
        where one is missing.
    notes : tuple of Text
        What a reader of the number has to know.
    between : tuple of Moments
        What lies between each station and the next: cut and fill, m³, and widths, m².
    """

    method: str
    sections: tuple[CrossSection, ...]
    cut_m3: float
    fill_m3: float
    area_m2: float
    missing_m2: float
    notes: tuple[Text, ...]
    between: tuple[Moments, ...]

    @property
    def net_m3(self) -> float:
        """Fill less cut."""
        return self.fill_m3 - self.cut_m3


def end_area_volume(
    line: SectionLayout,
    grounds: tuple[HeightSurface, HeightSurface],
    monitor: Monitor,
    boundary: shapely.Geometry | None = None,
) -> EndAreaVolume:
    """Volume by the mean of the areas at both ends of each interval.

    Parameters
    ----------
    grounds : HeightSurface, HeightSurface
        Before and after.
    boundary : shapely.Polygon or shapely.MultiPolygon or None
        Sections are clipped to it; m, project CRS.

    Raises
    ------
    Unsuitable
        The line has no length or a position that is no number; no section meets both grounds.
    OutOfRange
        A width, interval or step that isn't positive, or more positions than can be worked on.
    """
    sections = cross_sections(line, stations_of(line), grounds, monitor, boundary)
    parts = [
        _swept((first, last), (0.5, 0.5), _bend(first, last)) for first, last in pairwise(sections)
    ]
    return _volume(END_AREA, sections, parts, list(pairwise(sections)))


def prismoidal_volume(
    line: SectionLayout,
    grounds: tuple[HeightSurface, HeightSurface],
    monitor: Monitor,
    boundary: shapely.Geometry | None = None,
) -> EndAreaVolume:
    """Volume by the areas at both ends and halfway; parameters and errors as end areas have them.

    Exact where straight lines lead from each section to the next, as in a wedge or a frustum.
    """
    stations = stations_of(line)
    halfway = (stations[:-1] + stations[1:]) / 2
    every = np.sort(np.concatenate([stations, halfway]))
    sections = cross_sections(line, every, grounds, monitor, boundary)
    ends = list(zip(sections[:-2:2], sections[2::2], strict=True))
    parts = [
        _swept((first, middle, last), _SIMPSON_WEIGHTS, _bend(first, last))
        for (first, last), middle in zip(ends, sections[1::2], strict=True)
    ]
    return _volume(PRISMOIDAL, sections, parts, ends)


def _bend(first: CrossSection, last: CrossSection) -> float:
    """By how much the line turns to the left from one section to the next, rad."""
    (east, north), (further_east, further_north) = first.direction, last.direction
    across = east * further_north - north * further_east
    return math.atan2(across, east * further_east + north * further_north)


def _swept(sections: tuple[CrossSection, ...], shares: tuple[float, ...], bend: float) -> Moments:
    """What lies between the first and the last of some sections."""
    long = sections[-1].station_m - sections[0].station_m
    total = _NOTHING
    for section, share in zip(sections, shares, strict=True):
        total = total.plus(share * long, section.areas).plus(share * bend, section.moments)
    return total


def _volume(
    method: str,
    sections: tuple[CrossSection, ...],
    parts: list[Moments],
    ends: list[tuple[CrossSection, CrossSection]],
) -> EndAreaVolume:
    if not any(section.areas.width > 0.0 for section in sections):
        raise Unsuitable(
            Text("No cross-section meets both grounds.", "前後の地盤と交わる横断がありません。"),
            Text("Line of the sections", "横断の基準線"),
            Text(
                "Draw the line over the ground, within the boundary.",
                "境界内の地盤の上に線を引いてください。",
            ),
        )
    cut, fill, area, missing = (
        math.fsum(getattr(part, name) for part in parts)
        for name in ("cut", "fill", "width", "missing")
    )
    # Where sections cross each other a part may count negatively; a sum never should.
    cut, fill, area, missing = (max(0.0, value) for value in (cut, fill, area, missing))
    notes = _notes(sections, ends)
    return EndAreaVolume(method, sections, cut, fill, area, missing, notes, tuple(parts))


def _notes(
    sections: tuple[CrossSection, ...], ends: list[tuple[CrossSection, CrossSection]]
) -> tuple[Text, ...]:
    notes = []
    partly = [section for section in sections if section.missing_m > 0.0]
    if partly:
        worst = max(partly, key=lambda section: section.missing_m)
        notes.append(
            Text(
                f"{len(partly)} of {len(sections)} sections lack ground on part of their width; "
                f"most at station {worst.station_m:.2f} m: {worst.missing_m:.2f} m.",
                f"{len(sections)}か所中{len(partly)}か所の横断で、幅の一部に地盤がありません。"
                f"最大は測点{worst.station_m:.2f} mの{worst.missing_m:.2f} mです。",
            )
        )
    crossing = [pair for pair in ends if _cross_each_other(*pair)]
    if crossing:
        notes.append(
            Text(
                f"The line bends so sharply after station {crossing[0][0].station_m:.2f} m that "
                "its sections cross each other within their width.",
                f"測点{crossing[0][0].station_m:.2f} m以降で線の曲がりが急なため、"
                "横断どうしが幅の中で交差しています。",
            )
        )
    return tuple(notes)


def _cross_each_other(first: CrossSection, last: CrossSection) -> bool:
    """Whether two sections meet on the inside of the bend, within what counts of them."""
    bend = _bend(first, last)
    long = last.station_m - first.station_m
    for section in (first, last):
        counted = np.append(section.is_inside, False) | np.append(False, section.is_inside)
        inner = -np.sign(bend) * section.offsets_m[counted]
        if abs(bend) * inner.max(initial=0.0) > long:
            return True
    return False
