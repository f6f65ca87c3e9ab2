"""The line along an edge or a marking: a shortest path over the places where it is found again.

The search doesn't walk blindly on: every place that was found waits with the price of the path to
it and the distance still to go, and the cheapest goes on first (A*). So a branch that leads astray
is left when another one comes nearer to the end.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from processing.core.arrays import Floats

STEP_M = 0.25
"""Places are looked for at this distance from each other: half a section, so that neighbours share
points."""

HOLE_M = 1.0
"""A line isn't followed over more than this without finding it again: beyond it another edge may
begin. By trial; no measurement is recorded."""

_SLACK_M, _SLACK_RATIO = 0.03, 0.20
"""How far off what lies straight ahead a line may go on: at once, m, and per metre (11°). By trial;
no measurement is recorded."""

_SHARPEST_TURN = math.radians(20.0)
"""At one step: a curb's smallest radius is about 0.7 m."""

_CELL_M = 0.08
"""Places found in one cell, in one direction, are one: less than half a step."""

_DETOUR, _DETOUR_M = 1.3, 4.0
"""A line may be so much longer than the straight one, a share and m: round a corner. By trial; no
measurement is recorded."""

_HOLE_PRICE = 3.0
"""A metre without the line is as dear as three more with it. By trial; no measurement is
recorded."""

_DEAREST = 3.0
"""Times the longest line that is followed: dearer ones are given up. By trial; no measurement is
recorded."""

_MOST_POSITIONS = 20_000
"""Places found before a search ends: 5 km of line, some seconds."""


@dataclass(frozen=True)
class TracePoint:
    """Where a line was found.

    Attributes
    ----------
    xyz : (3,) float64
        m, project CRS.
    heading_rad, grade, curvature : float
        Its direction there.
    look : tuple of float
        What the line looks like across that direction; the follower's own.
    """

    xyz: Floats
    heading_rad: float
    grade: float
    curvature: float
    look: tuple[float, ...]

    @property
    def direction(self) -> Floats:
        """(3,) unit vector."""
        along = np.array([math.cos(self.heading_rad), math.sin(self.heading_rad), self.grade])
        return np.asarray(along / np.linalg.norm(along))

    def ahead(self, distance_m: float) -> TracePoint:
        """Where it would be so much farther on."""
        turn = self.curvature * distance_m
        middle = self.heading_rad + turn / 2
        step = distance_m * np.array([math.cos(middle), math.sin(middle), self.grade])
        return TracePoint(
            self.xyz + step, self.heading_rad + turn, self.grade, self.curvature, self.look
        )


class Follower(Protocol):
    """Finds one kind of line in the points."""

    def positions_at(self, xyz: Floats) -> Sequence[TracePoint]:
        """Lines that pass near a place, in either direction."""

    def positions_near(
        self, expected: TracePoint, slack_m: float
    ) -> Sequence[tuple[TracePoint, float]]:
        """The line again near an expected place, with how unlike it looks: 0 the same."""

    def turned(self, position: TracePoint) -> TracePoint:
        """The same place for the opposite direction."""


@dataclass(frozen=True)
class TracePath:
    """Places from the start on; whether they lead to the end."""

    positions: tuple[TracePoint, ...]
    is_complete: bool


def find_trace(follower: Follower, starts: Sequence[TracePoint], end: Floats) -> TracePath:
    """The cheapest way from one of some places to the end, or the way that comes nearest to it.

    Parameters
    ----------
    end : (3,) float64
        m.

    Notes
    -----
    A step costs its length, more where it turns off the way ahead or looks different. Of all
    places the one with the least cost so far plus the straight distance to the end goes on.
    """
    search = _Search(follower, end)
    for start in starts:
        search.wait(_Waiting(0.0, start, -1, STEP_M), _distance(start.xyz, end))
    return search.vehicle_path()


@dataclass(frozen=True)
class _Waiting:
    """A place and what the way to it costs, where it was reached from, how far to look ahead."""

    cost: float
    position: TracePoint
    before: int
    look_m: float


class _Search:
    """Places reached, and places that wait."""

    def __init__(self, follower: Follower, end: Floats) -> None:
        self._follower, self._end = follower, end
        self._waiting: list[tuple[float, int, _Waiting]] = []
        self._numbers = itertools.count()
        self._reached: list[tuple[TracePoint, int]] = []
        self._seen: set[tuple[int, ...]] = set()
        self._dearest = 0.0

    def wait(self, waiting: _Waiting, left_m: float) -> None:
        """Let a place wait by its cost and what is left to the end."""
        if waiting.before < 0:
            self._dearest = max(self._dearest, _DEAREST * (_DETOUR * left_m + _DETOUR_M))
        if waiting.cost + left_m <= self._dearest:
            heapq.heappush(self._waiting, (waiting.cost + left_m, next(self._numbers), waiting))

    def vehicle_path(self) -> TracePath:
        nearest, least = -1, math.inf
        while self._waiting and len(self._reached) < _MOST_POSITIONS:
            waiting = heapq.heappop(self._waiting)[2]
            left = _distance(waiting.position.xyz, self._end)
            if waiting.look_m <= STEP_M:
                if not self._is_new(waiting.position):
                    continue
                self._reached.append((waiting.position, waiting.before))
                waiting = replace(waiting, before=len(self._reached) - 1)
                if _passes(waiting.position, self._end):
                    return TracePath(_back(self._reached, waiting.before), is_complete=True)
                if left < least:
                    nearest, least = waiting.before, left
            self._look_ahead(waiting, left)
        if nearest < 0:
            return TracePath((), is_complete=False)
        is_near = _leads_to(self._reached[nearest][0], self._end)
        return TracePath(_back(self._reached, nearest), is_complete=is_near)

    def _is_new(self, position: TracePoint) -> bool:
        cell = (*np.floor(position.xyz / _CELL_M).astype(int), _way_round(position))
        is_new = cell not in self._seen
        self._seen.add(cell)
        return is_new

    def _look_ahead(self, waiting: _Waiting, left_m: float) -> None:
        for after, price in _found_at(self._follower, waiting.position, waiting.look_m):
            found = _Waiting(waiting.cost + price, after, waiting.before, STEP_M)
            self.wait(found, _distance(after.xyz, self._end))
        farther = waiting.look_m + STEP_M
        if farther <= HOLE_M:
            # What is found farther ahead waits till all that was found nearer leads nowhere.
            self.wait(replace(waiting, look_m=farther), left_m + _hole_price(farther))


def find_again(follower: Follower, position: TracePoint, end: Floats) -> TracePoint | None:
    """Where a line goes on beyond a hole: the first place ahead from which it can be followed."""
    left = _distance(position.xyz, end)
    distance = HOLE_M + STEP_M
    while distance < left:
        expected = position.ahead(distance)
        slack = _SLACK_M + _SLACK_RATIO * distance
        for found, _ in follower.positions_near(expected, slack):
            if _found_at(follower, found, STEP_M):
                return found
        distance += STEP_M
    return None


def _found_at(
    follower: Follower, position: TracePoint, distance_m: float
) -> list[tuple[TracePoint, float]]:
    """Where the line is found again so far ahead, with prices."""
    expected = position.ahead(distance_m)
    slack = _SLACK_M + _SLACK_RATIO * distance_m
    found = []
    for after, unlike in follower.positions_near(expected, slack):
        turn = _angle(after.heading_rad - position.heading_rad)
        if abs(turn) <= _SHARPEST_TURN * distance_m / STEP_M:
            off = _distance(after.xyz, expected.xyz) / slack
            turned = abs(turn - position.curvature * distance_m) / _SHARPEST_TURN
            worse = off**2 + turned**2 + unlike
            found.append((after, distance_m * (1 + worse) + _hole_price(distance_m)))
    return found


def _hole_price(distance_m: float) -> float:
    return _HOLE_PRICE * (distance_m - STEP_M)


def _passes(position: TracePoint, end: Floats) -> bool:
    """Whether the end lies beside a place."""
    along = float((end - position.xyz) @ position.direction)
    return off_line(end, position) <= _SLACK_M + _SLACK_RATIO and abs(along) <= STEP_M


def off_line(xyz: Floats, position: TracePoint) -> float:
    """Distance of a place from the straight line through another in its direction, m."""
    away = xyz - position.xyz
    return float(np.linalg.norm(away - (away @ position.direction) * position.direction))


def _leads_to(position: TracePoint, end: Floats) -> bool:
    """Whether the end lies ahead, no farther than a hole is wide."""
    ahead = float((end - position.xyz) @ position.direction)
    slack = _SLACK_M + _SLACK_RATIO * HOLE_M
    return -STEP_M <= ahead <= HOLE_M and off_line(end, position) <= slack


def _back(reached: Sequence[tuple[TracePoint, int]], last: int) -> tuple[TracePoint, ...]:
    positions = []
    while last >= 0:
        position, last = reached[last]
        positions.append(position)
    return tuple(reversed(positions))


def _way_round(position: TracePoint) -> int:
    return round(position.heading_rad / (math.pi / 2)) % 4


def _angle(turned: float) -> float:
    return (turned + math.pi) % (2 * math.pi) - math.pi


def _distance(one: Floats, other: Floats) -> float:
    return float(np.linalg.norm(one - other))
