"""Why the carriageway ends at a place of a section or not, for the diagnostic layer."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.methods.road.asked_points import points_beside, stretch_about
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.edges.edge_confidence import EdgeLineFacts, chance_of
from processing.methods.road.edges.edge_facts import EdgeFacts
from processing.methods.road.edges.edge_lines import CarriagewayLine
from processing.methods.road.edges.street_edges import edges_along
from processing.methods.road.edges.way import road_ways
from processing.methods.road.objects.drive_chunks import DriveChunk
from processing.methods.road.objects.ground_heights import ground_of_chunks
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import SurveyGround
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.columns.counted_classes import class_columns

_STRETCH_M = 15.0
"""Along the path to either side: what tells where the likeliest course of an edge is."""

_BAND_M, _HIGH_M = 0.3, 0.1
"""To each side of an edge: what is compared; and the height of the outline that shows it."""

_ASKED_M = 20.0
_SHARP = Text("Change of brightness", "反射強度の変化")
_FAR = Text("Difference of brightness 0.2 to 0.5 m outside", "外側0.2～0.5 mでの反射強度の差")
_ROUGH = Text("Difference of roughness 0.2 to 0.5 m outside", "外側0.2～0.5 mでの粗さの差")
_BEND = Text("Change of slope", "勾配の変化")
_UNLIKE = Text("Difference of brightness to the lane", "車線の反射強度との差")
_CHANCE = Text("Likelihood of an edge", "車道の縁である見込み")

_LEAST_CHANGE, _LEAST_BEND, _MOST_UNLIKE = 0.25, 0.02, 0.3
"""A ninth more, 2 %, a third more: none of them decides alone, the likelihood does. Changes are
told as shares, half where something grows by a third."""


def edge_diagnostics(asked: RequestedPosition, least_confidence: float) -> tuple[Diagnostic, ...]:
    """Where the carriageway ends in the section at a place, and what speaks for it."""
    drive, (start, stop) = asked.drive, stretch_about(asked, _STRETCH_M)
    if stop <= start:
        return ()
    plan = SparsePlan(
        np.asarray(drive.info.lowest, np.float64), np.asarray(drive.info.highest, np.float64)
    )
    local = drive.coordinates.chunk_about(start, stop, plan.origin)
    is_noise = class_columns(drive.columns).noise_between(start, stop)

    def chunks(_number: int, _part: Monitor) -> Iterable[DriveChunk]:
        return (DriveChunk(0, start, local, is_noise),)

    monitor = SilentMonitor()
    ground = SurveyGround(plan, ground_of_chunks(chunks(0, monitor), plan, monitor))
    place = np.asarray(asked.xyz - plan.origin)
    ways = road_ways([drive], plan).about(place, _STRETCH_M + _ASKED_M)
    seen = edges_along(ways, ([drive], chunks), ground, monitor)
    right = asked.scanlines.rights[len(asked.scanlines.rights) // 2]
    forward = np.array([-right[1], right[0]])
    found = []
    for line, facts in seen.lines:
        at = _crossing(line.line, place[:2], forward)
        if at is not None and line.type != "bridged":
            found.append(_diagnostic(asked, (line, facts), at + plan.origin, least_confidence))
    return tuple(found)


def _crossing(line: Floats, place: Floats, forward: Floats) -> Floats | None:
    """Where a line meets the section; None where it doesn't."""
    ahead = (line[:, :2] - place) @ forward
    crossed = np.flatnonzero((ahead[:-1] <= 0) != (ahead[1:] <= 0))
    if not crossed.size or np.hypot(*(line[crossed[0], :2] - place)) > _ASKED_M:
        return None
    first = int(crossed[0])
    share = ahead[first] / (ahead[first] - ahead[first + 1])
    at: Floats = line[first] + share * (line[first + 1] - line[first])
    return at


def _diagnostic(
    asked: RequestedPosition,
    edge: tuple[CarriagewayLine, EdgeLineFacts],
    at: Floats,
    least: float,
) -> Diagnostic:
    """An edge at the section, and what makes it one."""
    line, facts = edge
    means, chance = EdgeFacts(*line.facts.tolist()), chance_of(facts)
    tests = (
        _at_least(_SHARP, means.sharp, _LEAST_CHANGE),
        _at_least(_FAR, means.far_tone, _LEAST_CHANGE),
        _at_least(_ROUGH, means.far_rough, _LEAST_CHANGE),
        _at_least(_BEND, 0.1 * means.bend, _LEAST_BEND),
        DiagnosticTest(_UNLIKE, means.unlike, _MOST_UNLIKE, "", means.unlike <= _MOST_UNLIKE),
        _at_least(_CHANCE, chance, least),
    )
    right = asked.scanlines.rights[len(asked.scanlines.rights) // 2]
    across = np.array([right[0], right[1], 0.0])
    ring = np.array(
        [
            at + side * _BAND_M * across + [0.0, 0.0, up]
            for side, up in ((-1, -_HIGH_M), (1, -_HIGH_M), (1, _HIGH_M), (-1, _HIGH_M))
        ]
    )
    points = points_beside(asked, _ASKED_M) + asked.xyz
    near = np.abs((points - at) @ across) <= _BAND_M
    near &= (np.abs(points[:, 2] - at[2]) <= _HIGH_M) & (_ahead(points - at, right) <= _BAND_M)
    return Diagnostic(at, tests, tests[-1].is_met, ring, points[near])


def _ahead(off: Floats, right: Floats) -> Floats:
    """How far places lie before or behind a section."""
    return np.asarray(np.abs(off[:, 1] * right[0] - off[:, 0] * right[1]))


def _at_least(name: Text, value: float, limit: float) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, "", value >= limit)
