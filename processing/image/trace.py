"""Following a line of the street between two clicks: a curb's edge, a wall's foot, a marking."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.image.trace_edges import EdgeFollower
from processing.image.trace_markings import MarkingFollower
from processing.image.trace_points import PointsBetween
from processing.image.trace_search import Follower, Place, find_again, find_way, off_line
from processing.text import Text

if TYPE_CHECKING:  # processing.points.drive makes images, so importing it here would be a circle
    from processing.points.drive import Drive

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

TOLERANCE_M = 0.01
"""The polyline through the points stays this near to all points that were followed."""

_NOTHING = Text("", "")
_NO_LINE = Text(
    "There is no edge or marking that passes both points.",
    "両方の点を通る縁や標示が見つかりません。",
)
_SPARSE = Text("The points become sparse here.", "ここで点がまばらになっています。")
_LOST = Text("The edge can't be made out here.", "ここで縁を判別できなくなりました。")
_ALONG_M = 0.15
_ON_LINE_M = 0.005
_FARTHEST_M = 0.02
_FEW_POINTS = 12
_MOST_STARTS = 4


@dataclass(frozen=True)
class Traced:
    """A line that was followed.

    Attributes
    ----------
    points : (k,) int64
        Measured points of the drive along the line, the start first; the polyline through them
        stays within `TOLERANCE_M` of all that were followed.
    is_complete : bool
        Whether it leads to the end.
    reason : Text
        Why it doesn't; empty when it does.
    """

    points: _Integers
    is_complete: bool
    reason: Text


def trace(drive: Drive, start: int, end: int, *, across_gaps: bool = False) -> Traced:
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
    3. The measured points nearest to the places are the line.
    """
    if start == end:
        return Traced(np.array([start]), is_complete=True, reason=_NOTHING)
    cloud = PointsBetween(drive, start, end)
    goal = drive.xyz(np.array([end]))[0] - cloud.origin
    line = _line_at_both((EdgeFollower(cloud), _marking_follower(drive, cloud)), goal)
    if line is None:
        return Traced(np.array([start]), is_complete=False, reason=_NO_LINE)
    places, is_complete = _places_between(line, goal, across_gaps=across_gaps)
    if not places:
        return Traced(np.array([start]), is_complete=False, reason=_reason(cloud, np.zeros(3)))
    followed = _points_along(cloud, places)
    ends = [np.array([start]), followed, np.array([end] if is_complete else [], np.int64)]
    points = _without_repeats(np.concatenate(ends))
    kept = _thinned(drive.xyz(points))
    reason = _NOTHING if is_complete else _reason(cloud, places[-1].ahead(0.5).xyz)
    return Traced(points[kept], is_complete, reason)


@dataclass(frozen=True)
class _Line:
    """How a line is followed, and where it begins and ends."""

    follower: Follower
    starts: tuple[Place, ...]
    ends: tuple[Place, ...]


def _marking_follower(drive: Drive, cloud: PointsBetween) -> MarkingFollower:
    intensity = np.asarray(drive.columns["intensity"][cloud.points], dtype=np.float64)
    return MarkingFollower(cloud, intensity)


def _line_at_both(followers: Sequence[Follower], goal: _Floats) -> _Line | None:
    """What passes both points; or one of them, where nothing is found at the other."""
    only_one: _Line | None = None
    for follower in followers:
        starts, ends = follower.places_at(np.zeros(3)), follower.places_at(goal)
        either_way = [*ends, *(follower.turned(place) for place in ends)]
        kind = _kind_at_both(starts, either_way, goal)
        if kind is not None:
            return _Line(
                follower, _of_kind(follower, starts, kind), _of_kind(follower, either_way, kind)
            )
        if only_one is None and bool(starts) != bool(ends):
            kind = (starts or ends)[0].look[0]
            only_one = _Line(
                follower, _of_kind(follower, starts, kind), _of_kind(follower, ends, kind)
            )
    return only_one


def _kind_at_both(starts: Sequence[Place], ends: Sequence[Place], goal: _Floats) -> float | None:
    """The kind of line that passes nearest to both."""
    pairs = [
        (off_line(np.zeros(3), first) + off_line(goal, last), first.look[0])
        for first, last in itertools.product(starts, ends)
        if first.look[0] == last.look[0]
    ]
    return min(pairs)[1] if pairs else None


def _of_kind(follower: Follower, places: Sequence[Place], kind: float) -> tuple[Place, ...]:
    """Some of the places, to be left in either direction."""
    chosen = [place for place in places if place.look[0] == kind][:_MOST_STARTS]
    return tuple(way for place in chosen for way in (place, follower.turned(place)))


def _places_between(line: _Line, goal: _Floats, *, across_gaps: bool) -> tuple[list[Place], bool]:
    """Places from the start on, and whether they lead to the end."""
    way = find_way(line.follower, line.starts, goal)
    if not way.is_complete and line.ends:
        # Where two lines part, the way back may be plain.
        back = find_way(line.follower, line.ends, np.zeros(3))
        if back.is_complete:
            turned = [line.follower.turned(place) for place in reversed(back.places)]
            return turned, True
    places, is_complete = list(way.places), way.is_complete
    while places and across_gaps and not is_complete:
        again = find_again(line.follower, places[-1], goal)
        if again is None:
            return places, True
        way = find_way(line.follower, [again], goal)
        places += way.places
        is_complete = way.is_complete
    return places, is_complete


def _points_along(cloud: PointsBetween, places: Sequence[Place]) -> _Integers:
    """The measured points that lie best on the line, one for each place where one does."""
    points, offs = [], []
    for place in places:
        near = cloud.near(place.xyz, _ALONG_M)
        if near.size:
            away = cloud.xyz[near] - place.xyz
            along = away @ place.direction
            off_all = np.linalg.norm(away - along[:, None] * place.direction, axis=1)
            best = int(off_all.argmin())
            points.append(int(cloud.points[near[best]]))
            offs.append(float(off_all[best]))
    # One that lies well tells more than its neighbours that lie beside the line.
    kept = []
    for k, off in enumerate(offs):
        least = min(offs[max(0, k - 2) : k + 3])
        if off <= max(_ON_LINE_M, least) and off <= _FARTHEST_M:
            kept.append(points[k])
    return np.array(kept, dtype=np.int64)


def _without_repeats(points: _Integers) -> _Integers:
    _, first = np.unique(points, return_index=True)
    return np.asarray(points[np.sort(first)])


def _thinned(xyz: _Floats) -> _Integers:
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


def _reason(cloud: PointsBetween, ahead: _Floats) -> Text:
    return _SPARSE if cloud.near(ahead, 0.4).size < _FEW_POINTS else _LOST
