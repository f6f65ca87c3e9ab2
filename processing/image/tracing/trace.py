"""Following a line of the street between two clicks: a curb's edge, a wall's foot, a marking."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.image.tracing.trace_edges import EdgeFollower
from processing.image.tracing.trace_markings import MarkingFollower
from processing.image.tracing.trace_points import PointsBetween
from processing.image.tracing.trace_search import (
    Follower,
    TracePoint,
    find_again,
    find_trace,
    off_line,
)

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive


TOLERANCE_M = 0.01
"""The polyline stays this near to all places where the line was found."""

_NOTHING = Text("", "")
_NO_LINE = Text(
    "There is no edge or marking that passes both points.",
    "両方の点を通る縁や標示が見つかりません。",
)
_SPARSE = Text("The points become sparse here.", "ここで点がまばらになっています。")
_LOST = Text("The edge can't be made out here.", "ここで縁を判別できなくなりました。")
_AHEAD_REACH_M = 0.4
"""About a place ahead of where a line was lost points are counted."""

_FEW_POINTS = 12
"""Of fewer there no profile could be made: points are sparse, else the line is lost."""

_REACHED_M, _LOOKED_AHEAD_M = 1.0, 0.75
"""An end is reached within the first; why a line was lost is looked for so far ahead: three steps.
By trial; no measurement is recorded."""

_MOST_STARTS = 4
"""Lines near the first click that are tried: both edges of a curb and two more."""

_UNSEEN_M = 0.10
"""A line that isn't found at one click passes it by so much, maybe."""


@dataclass(frozen=True)
class TraceResult:
    """A line that was followed.

    Attributes
    ----------
    points : (k,) int64
        For each vertex the measured point nearest to it, the start first.
    xyz : (k, 3) float64
        Vertices on the fitted line, m, project CRS; the polyline through them stays within
        `TOLERANCE_M` of every place where the line was found. On the far side of a street
        measured points lie several cm apart.
    is_complete : bool
        Whether it leads to the end.
    reason : Text
        Why it doesn't; empty when it does.
    """

    points: Integers
    xyz: Floats
    is_complete: bool
    reason: Text


def trace(drive: Drive, start: int, end: int, *, across_gaps: bool = False) -> TraceResult:
    """Follow the edge or the marking on which two measured points lie.

    Parameters
    ----------
    start, end : int
        Points of the drive.
    across_gaps : bool
        Where the line is hidden for more than a metre, go straight to where it is seen again.

    Notes
    -----
    1. What lies at both points is followed: a hollow edge (lower edge of a curb, wall foot), a
       raised one (upper edge, wall top), else the border or the middle of a marking.
    2. Every 25 cm the profile across the line is cut anew from the points of several rows, and
       the place where its two surfaces cross is found; the cheapest chain of such places leads
       from the start to the end.
    """
    if start == end:
        return _only(drive, start, _NOTHING)
    cloud = PointsBetween(drive, start, end)
    goal = drive.xyz(np.array([end]))[0] - cloud.origin
    line = _line_at_both((EdgeFollower(cloud), _marking_follower(drive, cloud)), goal)
    if line is None:
        return _only(drive, start, _NO_LINE)
    positions, is_complete = _positions_between(line, goal, across_gaps=across_gaps)
    if not positions:
        return _only(drive, start, _reason(cloud, np.zeros(3)))
    beside = [_beside(positions[0], np.zeros(3))]
    last = [_beside(positions[-1], goal)] if is_complete else []
    line_xyz = np.array(beside + _between(positions, beside[0], goal) + last)
    line_xyz = line_xyz[_thin_vertices(line_xyz)]
    points = np.array([cloud.nearest(xyz) for xyz in line_xyz], dtype=np.int64)
    points[0] = start
    if is_complete:
        points[-1] = end
    reason = _NOTHING if is_complete else _reason(cloud, positions[-1].ahead(_LOOKED_AHEAD_M).xyz)
    return TraceResult(points, line_xyz + cloud.origin, is_complete, reason)


def _only(drive: Drive, start: int, reason: Text) -> TraceResult:
    points = np.array([start])
    return TraceResult(points, drive.xyz(points), reason is _NOTHING, reason)


@dataclass(frozen=True)
class _Line:
    """How a line is followed, and where it begins and ends."""

    follower: Follower
    starts: tuple[TracePoint, ...]
    ends: tuple[TracePoint, ...]


def _marking_follower(drive: Drive, cloud: PointsBetween) -> MarkingFollower:
    intensity = np.asarray(drive.columns["intensity"][cloud.points], dtype=np.float64)
    return MarkingFollower(cloud, intensity)


def _line_at_both(followers: Sequence[Follower], goal: Floats) -> _Line | None:
    """What passes both points; or one of them, where nothing is found at the other."""
    here = np.zeros(3)
    for follower in followers:
        starts, ends = follower.positions_at(here), follower.positions_at(goal)
        either_way = [*ends, *(follower.turned(position) for position in ends)]
        kinds = sorted({position.look[0] for position in (*starts, *either_way)})
        if kinds:
            kind = min(
                kinds, key=lambda kind: _off(starts, kind, here) + _off(either_way, kind, goal)
            )
            return _Line(follower, _of_kind(follower, starts, kind), _of_kind(follower, ends, kind))
    return None


def _off(positions: Sequence[TracePoint], kind: float, xyz: Floats) -> float:
    """How far the nearest line of a kind passes a place."""
    of_kind = (off_line(xyz, position) for position in positions if position.look[0] == kind)
    return min(of_kind, default=_UNSEEN_M)


def _of_kind(
    follower: Follower, positions: Sequence[TracePoint], kind: float
) -> tuple[TracePoint, ...]:
    """Some of the places, to be left in either direction."""
    chosen = [position for position in positions if position.look[0] == kind][:_MOST_STARTS]
    return tuple(
        vehicle_path
        for position in chosen
        for vehicle_path in (position, follower.turned(position))
    )


def _positions_between(
    line: _Line, goal: Floats, *, across_gaps: bool
) -> tuple[list[TracePoint], bool]:
    """Places from the start on, and whether they lead to the end."""
    vehicle_path = find_trace(line.follower, line.starts, goal)
    if not vehicle_path.is_complete and line.ends:
        # Where two lines part, the way back may be plain.
        back = find_trace(line.follower, line.ends, np.zeros(3))
        if back.is_complete:
            turned = [line.follower.turned(position) for position in reversed(back.positions)]
            return turned, True
    positions, is_complete = list(vehicle_path.positions), vehicle_path.is_complete
    while positions and across_gaps and not is_complete:
        again = find_again(line.follower, positions[-1], goal)
        if again is None:
            return positions, True
        vehicle_path = find_trace(line.follower, [again], goal)
        positions += vehicle_path.positions
        is_complete = vehicle_path.is_complete
    return positions, is_complete


def _beside(position: TracePoint, xyz: Floats) -> Floats:
    """(3,) where the line through a place passes another, if it isn't far."""
    along = float((xyz - position.xyz) @ position.direction)
    return position.ahead(max(-_REACHED_M, min(_REACHED_M, along))).xyz


def _between(positions: Sequence[TracePoint], start: Floats, goal: Floats) -> list[Floats]:
    """Places that lie ahead of the start and before the end."""
    first, last = positions[0].direction, positions[-1].direction
    return [
        position.xyz
        for position in positions
        if (_is_far(position.xyz - start) or (position.xyz - start) @ first > 0)
        and (_is_far(goal - position.xyz) or (goal - position.xyz) @ last > 0)
    ]


def _is_far(away: Floats) -> bool:
    return float(np.linalg.norm(away)) > _REACHED_M


def _thin_vertices(xyz: Floats) -> Integers:
    """Which vertices the polyline needs to stay within the tolerance of all (Douglas, Peucker)."""
    is_kept = np.zeros(xyz.shape[0], dtype=np.bool_)
    is_kept[[0, -1]] = True
    stretches = [(0, xyz.shape[0] - 1)]
    while stretches:
        first, last = stretches.pop()
        if last - first < 2:
            continue
        span = xyz[last] - xyz[first]
        away = xyz[first + 1 : last] - xyz[first]
        share = np.clip(away @ span / max(float(span @ span), 1e-12), 0.0, 1.0)
        off = np.linalg.norm(away - share[:, None] * span, axis=1)
        worst = int(off.argmax())
        if off[worst] > TOLERANCE_M:
            middle = first + 1 + worst
            is_kept[middle] = True
            stretches += [(first, middle), (middle, last)]
    return np.flatnonzero(is_kept)


def _reason(cloud: PointsBetween, ahead: Floats) -> Text:
    return _SPARSE if cloud.near(ahead, _AHEAD_REACH_M).size < _FEW_POINTS else _LOST
