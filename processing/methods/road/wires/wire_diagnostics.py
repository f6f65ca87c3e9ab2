"""Why a line in the air is a wire or none, with its residuals, for the diagnostic layer."""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.methods.road.asked_points import stretch_about
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.wires.solid_cells import SolidCells, solid_keys
from processing.methods.road.wires.spans import MOST_OFF_M, WireSpan, spans_of
from processing.methods.road.wires.street_wires import WireSettings
from processing.methods.road.wires.wire_confidence import chance_of, facts_of
from processing.methods.road.wires.wire_points import (
    WirePoints,
    points_on_lines,
    pulse_interval,
    thin_points,
)

_STRETCH_M = 12.0
"""Along the path to either side: a piece that tells how a wire hangs, and what tilted heads see of
the place before and after."""

_NEAR_M = 0.5
"""m along a wire from the section to points whose residuals are told: two scan lines to either
side."""

_GROUND_SHARE = 0.02
"""Of the points about the place: about the ground."""

_LONG = Text("Length seen within 12 m", "前後12 m以内で計測された長さ")
_HIGH = Text("Height above the ground", "地面からの高さ")
_NOISE = Text("Scatter of its points", "点のばらつき")
_SAG = Text("Sag of what was seen", "計測された範囲の弛度")
_CHANCE = Text("Likelihood of a wire", "架線である見込み")
_RESIDUAL = Text("Off the hanging curve", "懸垂線からのずれ")


def wire_diagnostics(
    asked: RequestedPosition, settings: WireSettings, least_confidence: float
) -> tuple[Diagnostic, ...]:
    """The lines through the section at a place: each where it crosses it, with the points there."""
    drive, (start, stop) = asked.drive, stretch_about(asked, _STRETCH_M)
    if stop <= start:
        return ()
    local = drive.coordinates.chunk_about(start, stop, asked.xyz)
    ground = float(np.quantile(local[:, 2], _GROUND_SHARE))
    thin = thin_points(drive, pulse_interval(drive), start, local)
    high = local[:, 2] > ground + settings.lowest_m
    kept = np.flatnonzero(thin & high)
    no_drive = np.zeros(kept.size, np.int64)
    solid = SolidCells([solid_keys(local, high & ~thin)])
    lines = points_on_lines(local[kept], no_drive, start + kept, solid, SilentMonitor())
    right = asked.scanlines.rights[len(asked.scanlines.rights) // 2]
    forward = np.array([-right[1], right[0]])
    found: list[Diagnostic] = []
    for span in spans_of(lines, SilentMonitor()):
        at = _crossing(span, forward)
        if at is not None:
            chance = chance_of(facts_of(span, solid))
            whole = _whole(span, at, (ground, settings), (chance, least_confidence))
            found += [whole, *_residuals(span, lines, at, is_wire=whole.is_taken)]
    # The places are about the asked one; the layer is drawn in the project's own system.
    return tuple(Diagnostic(one.xyz + asked.xyz, one.outcomes, one.is_taken) for one in found)


def _crossing(span: WireSpan, forward: Floats) -> float | None:
    """Where along a span it meets the section; None where it was not seen there."""
    slope = float(span.way @ forward)
    if abs(slope) < 1e-3:
        at = float(span.along(np.zeros((1, 2)))[0])
    else:
        at = -float(span.middle @ forward) / slope
    return at if span.start_m <= at <= span.end_m else None


def _whole(
    span: WireSpan,
    at_m: float,
    over: tuple[float, WireSettings],
    sure: tuple[float, float],
) -> Diagnostic:
    """A line at the section, and what makes it a wire."""
    ground, settings = over
    place = span.at(np.array([at_m]))[0]
    high = float(place[2] - ground)
    tests = (
        _at_least(_LONG, span.long_m, settings.shortest_m, "m"),
        _at_least(_HIGH, high, settings.lowest_m, "m"),
        _at_most(_NOISE, span.noise_m, MOST_OFF_M),
        _at_least(_SAG, span.sag_m, 0.0, "m"),
        _at_least(_CHANCE, *sure, ""),
    )
    # A short piece of a taut wire may seem to bulge; its likelihood weighs that.
    needed = (tests[0], tests[1], tests[2], tests[4])
    return Diagnostic(place, tests, all(one.is_met for one in needed))


def _residuals(
    span: WireSpan, lines: WirePoints, at_m: float, *, is_wire: bool
) -> list[Diagnostic]:
    """The points of a line about the section."""
    points = lines.local[span.lines]
    along = span.along(points)
    near = np.abs(along - at_m) <= _NEAR_M
    off = np.linalg.norm(points[near] - span.at(along[near]), axis=1)
    limit = max(3 * span.noise_m, MOST_OFF_M / 2)
    return [
        Diagnostic(place, (_at_most(_RESIDUAL, one, limit),), is_wire and one <= limit)
        for place, one in zip(points[near], off.tolist(), strict=True)
    ]


def _at_least(name: Text, value: float, limit: float, unit: str) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, unit, bool(math.isfinite(value) and value >= limit))


def _at_most(name: Text, value: float, limit: float) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, "m", value <= limit)
