"""Lines along the stations that tell an edge, and what closes the carriageway between them."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.methods.road.edges.cross_cells import CrossCells
from processing.methods.road.edges.edge_courses import LEFT, TOLD, EdgeCourse
from processing.methods.road.edges.edge_facts import PlaceFacts
from processing.methods.road.edges.edge_outside import Outside, outsides
from processing.methods.road.edges.fact_kernels import FACTS

EdgeType = Literal["walk", "gutter", "soil", "grass", "bridged"]
"""What lies outside; ``bridged``: a gap between what was seen."""

Neighbour = Literal["edge", "curb", "gap", "end"]
"""What closes the carriageway next to a line's end."""

_BRIDGE_STATIONS = 16
"""Of an edge that goes on behind what hides it: 8 m, as curbs do behind parked cars."""

_ASIDE_M, _TURNS = 0.1, 0.15
"""How far an edge may lie aside behind a gap, and the slope that it may have across it."""

_FAR_M = 1.0
"""Ends of a gap that lie farther aside are joined by nothing."""

_INSIDE = (-4, -1)
_SHORTEST_GAP = 2


@dataclass(frozen=True)
class CarriagewayLine:
    """A stretch of the carriageway's edge.

    Attributes
    ----------
    type : str
    side : int
        `LEFT` or `RIGHT` of the way.
    stations : (n,) int64
    away_m : (n,) float64
        From the way outwards, m.
    line : (n, 3) float64
        About the plan's origin, m.
    told : (n,) bool
        Stations that tell it.
    chances : (n,) float64
    facts : (FACTS,) float64
        Means over the stations that tell it.
    ends : (str, str)
        What closes the carriageway before and after it.
    curb_share : float
        Of its stations behind which a step was seen.
    """

    type: EdgeType
    side: int
    stations: Integers
    away_m: Floats
    line: Floats
    told: NDArray[np.bool_]
    chances: Floats
    facts: Floats
    ends: tuple[Neighbour, Neighbour]

    @property
    def length_m(self) -> float:
        """Its length in plan."""
        return float(np.hypot(*np.diff(self.line[:, :2], axis=0).T).sum())

    @property
    def bridged_m(self) -> float:
        """How much of it wasn't seen."""
        return float(self.length_m * np.mean(~self.told))


@dataclass(frozen=True)
class _Stretch:
    """Some stations of a course that follow each other."""

    first: int
    end: int
    type: EdgeType


def lines_of(
    cells: CrossCells, places: PlaceFacts, course: EdgeCourse
) -> Iterator[CarriagewayLine]:
    """The lines of one side of a way, in their order along it."""
    is_told = (course.chances >= TOLD) & ~course.curbs
    kinds = outsides(cells, course)
    seen = [
        part for group in _groups(np.flatnonzero(is_told), course) for part in _alike(group, kinds)
    ]
    heights = _heights(cells, course)
    closed = course.curbs.copy()
    for one in seen:
        closed[one.first : one.end] = True
    stretches = sorted([*seen, *_gaps(closed)], key=lambda one: one.first)
    for one in stretches:
        chosen = np.arange(one.first, one.end)
        told = is_told[chosen] if one.type != "bridged" else np.zeros(len(chosen), np.bool_)
        away = _away(course, one, told)
        if away is None:
            continue
        side = course.side
        yield CarriagewayLine(
            one.type,
            side,
            course.stations[chosen],
            away,
            np.column_stack([cells.ways.beside(course.stations[chosen], side * away),
                             heights[chosen]]),
            told,
            course.chances[chosen],
            _mean_facts(places, course, chosen[told] if told.any() else chosen),
            (_neighbour(closed, course, one.first - 1), _neighbour(closed, course, one.end)),
        )  # fmt: skip


def _groups(told: Integers, course: EdgeCourse) -> Iterator[Integers]:
    """Told stations that go on from one to the next, over gaps."""
    if not told.size:
        return
    steps = np.diff(told)
    aside = np.abs(np.diff(course.away_m[told]))
    goes_on = (steps <= _BRIDGE_STATIONS) & (aside <= _ASIDE_M + _TURNS * 0.5 * steps)
    curbs = np.r_[0, np.cumsum(course.curbs)]
    goes_on &= curbs[told[1:]] - curbs[told[:-1]] == 0
    for part in np.split(told, np.flatnonzero(~goes_on) + 1):
        if part.size > 1:
            yield part


def _alike(group: Integers, kinds: NDArray[np.str_]) -> Iterator[_Stretch]:
    """Parts of a group of one type each; they meet at a station that both have."""
    own = kinds[group]
    starts = np.flatnonzero(np.r_[True, own[1:] != own[:-1]])
    for first, end in itertools.pairwise([*starts.tolist(), len(group)]):
        last = min(end, len(group) - 1)
        kind: Outside = str(own[first])  # type: ignore[assignment]  # one of its four words
        yield _Stretch(int(group[first]), int(group[last]) + 1, kind)


def _gaps(closed: Flags) -> Iterator[_Stretch]:
    """Stretches between others that nothing closes."""
    turns = np.flatnonzero(np.diff(np.r_[1, closed.astype(np.int64), 1])).reshape(-1, 2)
    for first, end in turns.tolist():
        if first > 0 and end < len(closed) and end - first >= _SHORTEST_GAP:
            yield _Stretch(first - 1, end + 1, "bridged")


def _away(course: EdgeCourse, one: _Stretch, told: Flags) -> Floats | None:
    """How far from the way a stretch lies: where nothing tells it, between those that do."""
    at = np.arange(one.first, one.end)
    if one.type == "bridged":
        ends = course.away_m[[one.first, one.end - 1]]
        is_near = abs(float(ends[1] - ends[0])) <= _FAR_M
        return np.asarray(np.linspace(ends[0], ends[1], len(at))) if is_near else None
    return np.asarray(np.interp(at, at[told], course.away_m[at[told]]))


def _heights(cells: CrossCells, course: EdgeCourse) -> Floats:
    """Height of the carriageway at its edge, m about the plan's origin; between known ones."""
    from scipy.ndimage import median_filter

    half = cells.counts.shape[1] // 2
    at = np.clip(course.places[:, None] + np.arange(*_INSIDE), 0, half - 1)
    columns = half + at if course.side == LEFT else half - 1 - at
    values = cells.heights[course.stations[:, None], columns]
    known = np.isfinite(values)
    count = known.sum(axis=1)
    means = np.where(known, values, 0.0).sum(axis=1) / np.maximum(count, 1)
    if not (count > 0).any():
        means = np.zeros(len(means))
    else:
        rows = np.arange(len(means))
        means = np.interp(rows, rows[count > 0], means[count > 0])
    path = cells.ways.places[course.stations, 2] - cells.under_m
    return np.asarray(median_filter(means, 5, mode="nearest") + path)


def _mean_facts(places: PlaceFacts, course: EdgeCourse, chosen: Integers) -> Floats:
    number = 0 if course.side == LEFT else 1
    rows = places.facts[course.stations[chosen], number, course.places[chosen]]
    return np.asarray(rows.mean(axis=0, dtype=np.float64)) if len(rows) else np.zeros(FACTS)


def _neighbour(closed: Sequence[bool] | Flags, course: EdgeCourse, at: int) -> Neighbour:
    if at < 0 or at >= len(closed):
        return "end"
    if course.curbs[at]:
        return "curb"
    return "edge" if closed[at] else "gap"
