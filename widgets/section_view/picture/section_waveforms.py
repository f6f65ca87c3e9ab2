"""Waveforms in a section: each pulse's samples along its ray, painted as a curve beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from processing.core.arrays import Floats, Integers
from processing.core.errors import UserError
from processing.recording.drive import Drive
from processing.recording.waveform_packets.echo_shapes import echo_shapes
from processing.recording.waveforms import PulseBlock, Waveforms, waveforms_of
from processing.section.cut import Cut
from processing.section.points_in_cut import SectionPoints
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.projection import SectionProjection

MOST_PULSES = 400
"""More curves than these hide each other on a screen."""

_CLEAR_SIGMAS = 3.0
"""So far above the baseline a sample is of an echo."""

_MARGIN = 4
"""Samples shown before the first echo and behind the last one."""

_LEAST_PEAK_PX, _MOST_PEAK_PX = 6.0, 26.0
_SPACINGS = 3.0
"""The highest peak reaches over so many neighbours, so that curves stay apart on the screen."""
_CURVE, _RAY = QColor("#f0e442"), QColor(240, 228, 66, 60)


@dataclass(frozen=True, eq=False)
class SectionWaveform:
    """One pulse in a section.

    Attributes
    ----------
    section : (m, 3) float64
        Places of the samples: offset, height, distance from the plane, m.
    above_base : (m,) float64
        Counts over the baseline.
    """

    section: Floats
    above_base: Floats


def waveforms_in(
    drives: Sequence[Drive], parts: Sequence[SectionPoints], cut: Cut
) -> tuple[SectionWaveform, ...]:
    """The pulses whose first return lies in a cut, evenly thinned where they are too many.

    Parameters
    ----------
    parts : sequence of SectionPoints
        The points of each drive in the cut.
    """
    shown: list[SectionWaveform] = []
    for drive, part in zip(drives, parts, strict=True):
        try:
            waveforms = waveforms_of(drive)
            if waveforms is None or not part.points.size:
                continue
            owned = part.points[waveforms.are_owners(part.points)]
            shown += _shown(waveforms, waveforms.pulse_of(owned), cut)
        except UserError:  # the panel of the waveform says why; here there is just none
            continue
    return tuple(shown)


def _shown(waveforms: Waveforms, numbers: Integers, cut: Cut) -> list[SectionWaveform]:
    chosen = np.sort(numbers)[:: max(1, -(-numbers.size // MOST_PULSES))]
    pulses = waveforms.pulses(chosen)
    block = PulseBlock(pulses, waveforms.samples_of(chosen))
    places = waveforms.location_ns(pulses.owners)
    shapes = echo_shapes(block.samples, pulses.lengths, pulses.interval_ns, places)
    shown = []
    for row in range(chosen.size):
        above = block.samples[row, : pulses.lengths[row]].astype(np.float64)
        above -= shapes.baseline[row]
        clear = np.flatnonzero(above > _CLEAR_SIGMAS * shapes.noise[row])
        if not clear.size or not np.isfinite(pulses.direction[row]).all():
            continue
        first, last = max(0, clear[0] - _MARGIN), min(above.size, clear[-1] + _MARGIN + 1)
        times = np.arange(first, last) * pulses.interval_ns[row]
        xyz = pulses.xyz_at(np.full(times.size, row), times)
        shown.append(SectionWaveform(cut.to_section(xyz), above[first:last]))
    return shown


def paint_waveforms(
    painter: QPainter,
    waveforms: Sequence[SectionWaveform],
    projection: SectionProjection,
    viewport: PlaneViewport,
) -> None:
    """Paint each ray, and its samples as a curve to the right of it; all at one scale."""
    highest = max((float(one.above_base.max()) for one in waveforms), default=0.0)
    if highest <= 0:
        return
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    rays = [viewport.to_screen(projection.on_plane(one.section)) for one in waveforms]
    spacing = float(np.ptp([spots[0, 0] for spots in rays])) / len(rays)
    peak_px = min(max(_SPACINGS * spacing, _LEAST_PEAK_PX), _MOST_PEAK_PX)
    for one, spots in zip(waveforms, rays, strict=True):
        way = spots[-1] - spots[0]
        length = float(np.hypot(*way))
        if length == 0:
            continue
        beside = np.array([way[1], -way[0]]) / length
        curve = spots + one.above_base[:, None] / highest * peak_px * beside
        painter.setPen(QPen(_RAY, 1.0))
        painter.drawLine(QPointF(*spots[0].tolist()), QPointF(*spots[-1].tolist()))
        painter.setPen(QPen(_CURVE, 1.2))
        painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in curve.tolist()]))
