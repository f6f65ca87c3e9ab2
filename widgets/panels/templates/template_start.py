"""Where a template is fitted from: a place, a drive, and the section through it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from processing.image.search.nearest import nearest_point
from processing.map.feature import Position
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.slab import SectionFrame
from processing.methods.templates.template_text import template_line
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.tools.template import TemplateParameters
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource

_NEAREST_M = 0.5


@dataclass(frozen=True)
class TemplateStart:
    """A place in a section where a template's anchor is.

    Attributes
    ----------
    drive : Drive
        Whose points are followed.
    position : Position
        m, project CRS.
    cut : Cut or None
        The section; None: the trajectory says which way the line goes.
    """

    drive: Drive
    position: Position
    cut: Cut | None

    @property
    def frame(self) -> SectionFrame | None:
        """Where the section is taken; None without one."""
        if self.cut is None:
            return None
        east, north = self.cut.normal
        return SectionFrame(np.array(self.position), math.atan2(north, east))

    def parameters(self, template: ProfileTemplate) -> TemplateParameters:
        """What the tool is to be run with."""
        easting, northing, height = self.position
        heading = {}
        if self.cut is not None:
            east, north = self.cut.normal
            heading = {"heading_deg": round(math.degrees(math.atan2(east, north)) % 360.0, 4)}
        return TemplateParameters(
            template=template_line(template),
            easting_m=round(easting, 4),
            northing_m=round(northing, 4),
            height_m=round(height, 4),
            **heading,
        )


def start_at(
    source: MapSource, position: PickedPosition, cut: Cut | None, shown: str
) -> TemplateStart | None:
    """Begin at a place of the map.

    Parameters
    ----------
    cut : Cut or None
        The section that is shown; it counts where the place lies in it.
    shown : str
        Id of the drive that is looked at, used where the place rests on no point.
    """
    drives = {drive.id: drive for drive in source.drives() if drive.count}
    if not drives:
        return None
    id_ = shown if position.measured is None else position.measured.drive
    drive = drives.get(id_) or next(iter(drives.values()))
    if nearest_point(drive, np.array(position.xyz), _NEAREST_M) < 0:
        # Another scanner may have seen what this one didn't.
        near = (
            one for one in drives.values() if nearest_point(one, np.array(position.xyz), 0.5) >= 0
        )
        drive = next(near, drive)
    holds = cut is not None and bool(cut.holds(cut.to_section([position.xyz]))[0])
    return TemplateStart(drive, position.xyz, cut if holds else None)
