"""What tools make of a section: its normalised scanline, and the places that they look at there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import UserError
from processing.image.scan_lines.scanlines import Scanlines, ScanlineSettings, scanline_through
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.tools.listed.registry import TOOLS
from processing.tools.tool import Tool
from widgets.section_view.picture.section_position import SectionPosition


@dataclass(frozen=True, eq=False)
class ShownDiagnostic:
    """A place that a tool looked at.

    Attributes
    ----------
    tool : str
        Id of the tool.
    section : (3,) float64
        Offset, height, distance from the plane, m.
    outline : (n, 3) float64
        The same of the ring that was laid on the points; none: empty.
    points : (n, 3) float64
        The same of the measured points that it rests on.
    """

    tool: str
    diagnostic: Diagnostic
    section: Floats
    outline: Floats = field(default_factory=lambda: np.empty((0, 3)))
    points: Floats = field(default_factory=lambda: np.empty((0, 3)))


@dataclass(frozen=True, eq=False)
class SectionDiagnostics:
    """The scanline of one drive in a section, and what was looked at on it.

    Attributes
    ----------
    lines : tuple of (k, 3) float64
        Its unbroken parts; offset, height, distance from the plane, m.
    diagnostics : tuple of ShownDiagnostic
    """

    drive: str
    lines: tuple[Floats, ...]
    diagnostics: tuple[ShownDiagnostic, ...] = ()


@dataclass(frozen=True, eq=False)
class FoundDiagnostics:
    """What is known so far of a section.

    Attributes
    ----------
    drives : tuple of SectionDiagnostics
    awaited : str
        Id of the tool that is asked now; empty when all have answered.
    """

    drives: tuple[SectionDiagnostics, ...]
    awaited: str = ""


def diagnostics_at(
    drives: Sequence[Drive], standing: SectionPosition, cut: Cut, parameters: Mapping[str, object]
) -> Iterator[FoundDiagnostics]:
    """What is to be shown in a section: the scanlines, then more with each tool that answers.

    Tools take seconds where much stands about; whoever has seen enough stops asking. Of drives
    that lack revolutions or a trajectory there is nothing. A section along a line has no scanline,
    and shows what was looked at in its slab.

    Parameters
    ----------
    parameters : mapping of str to object
        Of the tools, by their ids, as they would run now; asked in this order.
    """
    position = np.array(cut.middle if standing.through is None else standing.through)
    asked = [one for drive in drives if (one := _asked_position(drive, position)) is not None]
    is_along = standing.is_along
    found = [
        SectionDiagnostics(one.drive.info.name, () if is_along else _lines(one.scanlines, cut))
        for one in asked
    ]
    tools = [
        TOOLS[id_] for id_ in parameters if id_ in TOOLS and TOOLS[id_].diagnostics is not None
    ]
    for tool in tools:
        yield FoundDiagnostics(tuple(found), tool.id)
        for number, one in enumerate(asked):
            more = _looked_at(tool, one, cut, parameters[tool.id])
            if is_along:
                more = tuple(one for one in more if abs(one.section[2]) <= cut.width_m / 2)
            known = found[number]
            found[number] = replace(known, diagnostics=(*known.diagnostics, *more))
    yield FoundDiagnostics(tuple(found))


def _asked_position(drive: Drive, position: Floats) -> RequestedPosition | None:
    if drive.trajectory is None or drive.revolutions is None:
        return None
    try:
        scanlines = scanline_through(drive, position, ScanlineSettings())
    except UserError:  # whoever runs a tool is told; here there is just nothing to show
        return None
    return None if scanlines is None else RequestedPosition(drive, position, scanlines)


def _looked_at(
    tool: Tool, asked: RequestedPosition, cut: Cut, parameters: object
) -> tuple[ShownDiagnostic, ...]:
    if tool.diagnostics is None:
        return ()
    try:
        return tuple(_shown(tool.id, one, cut) for one in tool.diagnostics(asked, parameters))
    except UserError:  # as above
        return ()


def _shown(tool: str, diagnostic: Diagnostic, cut: Cut) -> ShownDiagnostic:
    nowhere = np.empty((0, 3))
    ring = nowhere if diagnostic.outline is None else diagnostic.outline
    points = nowhere if diagnostic.points is None else diagnostic.points
    section = cut.to_section(diagnostic.xyz.reshape(1, 3))[0]
    return ShownDiagnostic(tool, diagnostic, section, cut.to_section(ring), cut.to_section(points))


def _lines(scanlines: Scanlines, cut: Cut) -> tuple[Floats, ...]:
    vertices = np.arange(scanlines.across_m.size)
    section = cut.to_section(scanlines.xyz(vertices))
    return tuple(np.split(section, np.flatnonzero(scanlines.is_break)[1:]))
