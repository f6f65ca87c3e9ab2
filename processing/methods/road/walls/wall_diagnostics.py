"""Why an upright face is a wall or none, with its strip and points, for the diagnostic layer."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.methods.road.asked_points import stretch_about
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.objects.drive_chunks import DriveChunk
from processing.methods.road.objects.ground_heights import ground_of_chunks
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import SurveyGround
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.walls.face_fits import FaceSurroundings
from processing.methods.road.walls.street_walls import walls_in
from processing.methods.road.walls.wall_confidence import WallFacts, chance_of
from processing.methods.road.walls.wall_lines import WallLine
from processing.recording.columns.counted_classes import class_columns

_STRETCH_M = 15.0
"""Along the path to either side: what tilted heads see of a face before and after they pass it."""

_NEAR_M = 0.5
"""m along a face from the section to the points that are shown."""

_LONG = Text("Length seen within 15 m", "前後15 m以内で計測された長さ")
_TOP = Text("Top over the foot", "下端からの高さ")
_LOW = Text("Lowest point over the foot", "計測された最も低い高さ")
_SOLID = Text("Share of consecutive points", "連続して計測された点の割合")
_FLAT = Text("Share of the points about it on it", "周囲の点のうち面上の点の割合")
_OPEN = Text("Share with something seen behind", "背後が見通せる割合")
_CHANCE = Text("Likelihood of a wall", "塀・建物である見込み")

_MOST_RAISED_M, _LEAST_SOLID, _LEAST_FLAT, _MOST_OPEN = 0.5, 0.6, 0.6, 0.5
"""Halfway between walls and other things; none of them decides alone, the likelihood does."""

WallLimits = tuple[float, float, float]
"""Shortest length, m, lowest top, m, and least likelihood."""


def wall_diagnostics(asked: RequestedPosition, limits: WallLimits) -> tuple[Diagnostic, ...]:
    """The faces through the section at a place: each from its foot to its top."""
    drive, (start, stop) = asked.drive, stretch_about(asked, _STRETCH_M)
    if stop <= start:
        return ()
    plan = SparsePlan(
        np.asarray(drive.info.lowest, np.float64), np.asarray(drive.info.highest, np.float64)
    )
    local = drive.coordinates.chunk_about(start, stop, plan.origin)
    is_noise = class_columns(drive.columns).noise_between(start, stop)

    def chunks(_: Monitor) -> Iterable[DriveChunk]:
        return (DriveChunk(0, start, local, is_noise),)

    monitor = SilentMonitor()
    ground = ground_of_chunks(chunks(monitor), plan, monitor)
    seen = walls_in([drive], chunks, SurveyGround(plan, ground), monitor)
    if seen.about is None:
        return ()
    right = asked.scanlines.rights[len(asked.scanlines.rights) // 2]
    forward = np.array([-right[1], right[0]])
    place = np.asarray(asked.xyz - plan.origin)
    found = []
    for line, facts in seen.lines:
        foot = _crossing(line, place[:2], forward)
        if foot is not None:
            found.append(_diagnostic(seen.about, (line, facts), foot, limits))
    return tuple(found)


def _crossing(line: WallLine, place: Floats, forward: Floats) -> Floats | None:
    """Where the foot of a line meets the section; None where it doesn't."""
    ahead = (line.line[:, :2] - place) @ forward
    crossed = np.flatnonzero((ahead[:-1] <= 0) != (ahead[1:] <= 0))
    if not crossed.size:
        return None
    first = int(crossed[0])
    share = ahead[first] / (ahead[first] - ahead[first + 1])
    foot: Floats = line.line[first] + share * (line.line[first + 1] - line.line[first])
    return foot


def _diagnostic(
    about: FaceSurroundings, wall: tuple[WallLine, WallFacts], foot: Floats, limits: WallLimits
) -> Diagnostic:
    """A face at the section, and what makes it a wall."""
    line, facts = wall
    face, chance = line.face, chance_of(facts)
    shortest, lowest, least = limits
    tests = (
        _at_least(_LONG, line.long_m, shortest, "m"),
        _at_least(_TOP, face.top_m, lowest, "m"),
        _at_most(_LOW, face.low_m, _MOST_RAISED_M, "m"),
        _at_least(_SOLID, face.solid, _LEAST_SOLID, ""),
        _at_least(_FLAT, face.flat, _LEAST_FLAT, ""),
        _at_most(_OPEN, face.is_open, _MOST_OPEN, ""),
        _at_least(_CHANCE, chance, least, ""),
    )
    is_taken = tests[0].is_met and tests[1].is_met and tests[-1].is_met
    before = np.append(line.normal, 0.0)
    up = np.array([0.0, 0.0, face.top_m]) - face.lean * face.top_m * before
    off = max(face.noise_m, 0.005) * before
    ring = np.array([foot + off, foot + up + off, foot + up - off, foot - off])
    origin = about.plan.origin
    points = about.points.local[line.points]
    near = np.hypot(*(points[:, :2] - foot[:2]).T) <= _NEAR_M
    return Diagnostic(foot + origin, tests, is_taken, ring + origin, points[near] + origin)


def _at_least(name: Text, value: float, limit: float, unit: str) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, unit, value >= limit)


def _at_most(name: Text, value: float, limit: float, unit: str) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, unit, value <= limit)
