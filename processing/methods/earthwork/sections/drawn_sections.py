"""Sections of a volume along a line as papers and drawings take them."""

from __future__ import annotations

import math

from processing.methods.earthwork.sections.cross_sections import SectionLayout
from processing.methods.earthwork.sections.drawing_parts import DrawnSection, SectionedLine
from processing.methods.earthwork.sections.end_areas import EndAreaVolume

_STAKES_M = 20.0
"""Between stations (測点 No.), as road offices set them."""

_SAME_M = 0.005
"""A section nearer to a station is at it: names of stations have centimetres."""


def drawn_line(volume: EndAreaVolume, line: SectionLayout, name: str) -> SectionedLine:
    """A line with the sections that its volume was had from."""
    sections = tuple(
        DrawnSection(
            one.station_m,
            station_name(one.station_m),
            one.offsets_m,
            one.before,
            one.after,
            one.cut_m2,
            one.fill_m2,
            one.is_inside,
        )
        for one in volume.sections
    )
    return SectionedLine(name, line.xy, 0.0, sections)


def volumes_between(volume: EndAreaVolume) -> tuple[tuple[float, float], ...]:
    """Cut and fill, m³, stated at each section but the first; NaN at those halfway only."""
    stated = [(part.cut, part.fill) for part in volume.between]
    if len(stated) == len(volume.sections) - 1:
        return tuple(stated)
    halfway = (math.nan, math.nan)
    return tuple(pair for end in stated for pair in (halfway, end))


def station_name(station_m: float) -> str:
    """A station by the stake before it, one every 20 m: ``No.1+5.00``."""
    stake = math.floor((station_m + _SAME_M) / _STAKES_M)
    rest = station_m - stake * _STAKES_M
    return f"No.{stake}" if abs(rest) < _SAME_M else f"No.{stake}+{rest:.2f}"
