"""What tools make of a section: its normalised scanline, and the places that they look at there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import UserError
from processing.image.scan_lines.scanlines import Scanlines, ScanlineSettings, scanline_through
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.tools.registry import TOOLS
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
    """

    tool: str
    diagnostic: Diagnostic
    section: Floats
    outline: Floats = field(default_factory=lambda: np.empty((0, 3)))


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
    diagnostics: tuple[ShownDiagnostic, ...]


def diagnostics_at(
    drives: Sequence[Drive], standing: SectionPosition, cut: Cut, parameters: Mapping[str, object]
) -> tuple[SectionDiagnostics, ...]:
    """What is to be shown in a section; of drives that lack revolutions or a trajectory nothing.

    Parameters
    ----------
    parameters : mapping of str to object
        Of the tools, by their ids, as they would run now.
    """
    position = np.array(cut.middle if standing.through is None else standing.through)
    found = []
    for drive in drives:
        if drive.trajectory is None or drive.revolutions is None:
            continue
        try:
            scanlines = scanline_through(drive, position, ScanlineSettings())
            if scanlines is not None:
                found.append(
                    _find_diagnostics(
                        RequestedPosition(drive, position, scanlines), cut, parameters
                    )
                )
        except UserError:  # whoever runs the tool is told; here there is just nothing to show
            continue
    return tuple(found)


def _find_diagnostics(
    asked: RequestedPosition, cut: Cut, parameters: Mapping[str, object]
) -> SectionDiagnostics:
    diagnostics = [
        _shown(tool.id, diagnostic, cut)
        for tool in TOOLS.values()
        if tool.diagnostics is not None and tool.id in parameters
        for diagnostic in tool.diagnostics(asked, parameters[tool.id])
    ]
    return SectionDiagnostics(
        asked.drive.info.name, _lines(asked.scanlines, cut), tuple(diagnostics)
    )


def _shown(tool: str, diagnostic: Diagnostic, cut: Cut) -> ShownDiagnostic:
    ring = np.empty((0, 3)) if diagnostic.outline is None else diagnostic.outline
    section = cut.to_section(diagnostic.xyz.reshape(1, 3))[0]
    return ShownDiagnostic(tool, diagnostic, section, cut.to_section(ring))


def _lines(scanlines: Scanlines, cut: Cut) -> tuple[Floats, ...]:
    vertices = np.arange(scanlines.across_m.size)
    section = cut.to_section(scanlines.xyz(vertices))
    return tuple(np.split(section, np.flatnonzero(scanlines.is_break)[1:]))
