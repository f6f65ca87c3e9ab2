"""The way along an edge or a marking: a shortest path over the places where it is found again.

The search doesn't walk blindly on: every place that was found waits with the price of the way to
it and the distance still to go, and the cheapest goes on first (A*). So a branch that leads astray
is left when another one comes nearer to the end.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

STEP_M = 0.25
"""Places are looked for at this distance from each other."""

HOLE_M = 1.0
"""A line isn't followed over more than this without finding it again."""

_SLACK_M, _SLACK_RATIO = 0.03, 0.10  # how far off the way ahead a line may go on
_SHARPEST_TURN = math.radians(20.0)  # at one step; a curb's smallest radius is about 0.7 m
_CELL_M = 0.08
_DETOUR, _DETOUR_M = 1.3, 4.0
_MOST_PLACES = 20_000


@dataclass(frozen=True)
class Place:
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

    xyz: _Floats
    heading_rad: float
    grade: float
    curvature: float
    look: tuple[float, ...]

    @property
    def direction(self) -> _Floats:
        """(3,) unit vector."""
        along = np.array([math.cos(self.heading_rad), math.sin(self.heading_rad), self.grade])
        return np.asarray(along / np.linalg.norm(along))

    def ahead(self, distance_m: float) -> Place:
        """Where it would be so much farther on."""
        turn = self.curvature * distance_m
        middle = self.heading_rad + turn / 2
        step = distance_m * np.array([math.cos(middle), math.sin(middle), self.grade])
        return Place(
            self.xyz + step, self.heading_rad + turn, self.grade, self.curvature, self.look
        )


class Follower(Protocol):
    """Finds one kind of line in the points."""

    def places_at(self, xyz: _Floats) -> Sequence[Place]:
        """Lines that pass near a place, in either direction."""

    def places_near(self, expected: Place, slack_m: float) -> Sequence[tuple[Place, float]]:
        """The line again near an expected place, with how unlike it looks: 0 the same."""

    def turned(self, place: Place) -> Place:
        """The same place for the opposite direction."""


@dataclass(frozen=True)
class Way:
    """Places from the start on; whether they lead to the end."""

    places: tuple[Place, ...]
    is_complete: bool


def find_way(follower: Follower, starts: Sequence[Place], end: _Floats) -> Way:
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
    number = itertools.count()
    waiting: list[tuple[float, int, float, Place, int]] = []
    reached: list[tuple[Place, int]] = []
    seen: set[tuple[int, ...]] = set()
    longest = _DETOUR * _distance(starts[0].xyz, end) + _DETOUR_M if starts else 0.0
    for start in starts:
        left = _distance(start.xyz, end)
        heapq.heappush(waiting, (left, next(number), 0.0, start, -1))
    nearest, least = -1, math.inf
    while waiting and len(reached) < _MOST_PLACES:
        _, _, cost, place, before = heapq.heappop(waiting)
        cell = (*np.floor(place.xyz / _CELL_M).astype(int), _way_round(place))
        if cell in seen:
            continue
        seen.add(cell)
        reached.append((place, before))
        left = _distance(place.xyz, end)
        if _passes(reached, end):
            return Way(_back(reached, len(reached) - 1), is_complete=True)
        if left < least:
            nearest, least = len(reached) - 1, left
        for after, price in _steps_from(follower, place):
            total = cost + price
            estimate = total + _distance(after.xyz, end)
            if total + 0.0 <= 3 * longest and _distance(after.xyz, end) <= longest:
                heapq.heappush(waiting, (estimate, next(number), total, after, len(reached) - 1))
    if nearest < 0:
        return Way((), is_complete=False)
    return Way(_back(reached, nearest), _leads_to(reached[nearest][0], end))


def find_again(follower: Follower, place: Place, end: _Floats) -> Place | None:
    """Where a line goes on beyond a hole: the first place ahead from which it can be followed."""
    left = _distance(place.xyz, end)
    distance = HOLE_M + STEP_M
    while distance < left:
        expected = place.ahead(distance)
        slack = _SLACK_M + _SLACK_RATIO * distance
        for found, _ in follower.places_near(expected, slack):
            if _steps_from(follower, found):
                return found
        distance += STEP_M
    return None


def _steps_from(follower: Follower, place: Place) -> list[tuple[Place, float]]:
    """Next places with their prices: as near as the line is found again."""
    distance = STEP_M
    while distance <= HOLE_M + 1e-9:
        expected = place.ahead(distance)
        slack = _SLACK_M + _SLACK_RATIO * distance
        steps = []
        for found, unlike in follower.places_near(expected, slack):
            turn = _angle(found.heading_rad - place.heading_rad)
            if abs(turn) <= _SHARPEST_TURN * distance / STEP_M:
                off = _distance(found.xyz, expected.xyz) / slack
                turned = abs(turn - place.curvature * distance) / _SHARPEST_TURN
                holes = distance / STEP_M - 1
                steps.append((found, distance * (1 + off**2 + turned**2 + unlike + holes)))
        if steps:
            return steps
        distance += STEP_M
    return []


def _passes(reached: Sequence[tuple[Place, int]], end: _Floats) -> bool:
    """Whether the last step leads by the end."""
    place, _ = reached[-1]
    along = float((end - place.xyz) @ place.direction)
    return off_line(end, place) <= _SLACK_M + _SLACK_RATIO and abs(along) <= STEP_M


def off_line(xyz: _Floats, place: Place) -> float:
    """Distance of a place from the straight line through another in its direction, m."""
    away = xyz - place.xyz
    return float(np.linalg.norm(away - (away @ place.direction) * place.direction))


def _leads_to(place: Place, end: _Floats) -> bool:
    """Whether the end lies ahead, no farther than a hole is wide."""
    ahead = float((end - place.xyz) @ place.direction)
    slack = _SLACK_M + _SLACK_RATIO * HOLE_M
    return -STEP_M <= ahead <= HOLE_M and off_line(end, place) <= slack


def _back(reached: Sequence[tuple[Place, int]], last: int) -> tuple[Place, ...]:
    places = []
    while last >= 0:
        place, last = reached[last]
        places.append(place)
    return tuple(reversed(places))


def _way_round(place: Place) -> int:
    return round(place.heading_rad / (math.pi / 2)) % 4


def _angle(turned: float) -> float:
    return (turned + math.pi) % (2 * math.pi) - math.pi


def _distance(one: _Floats, other: _Floats) -> float:
    return float(np.linalg.norm(one - other))
