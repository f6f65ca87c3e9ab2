"""Where lines meet in plan: with themselves, with one another, and near the cursor."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.map.drafting.plan_sides import (
    crossing_fractions,
    first_meeting,
    meeting_pairs,
    nearest_fractions,
)
from processing.map.drafting.polyline import SAME_POSITION_M, Polyline, end_direction, position_of
from processing.map.feature import Position

SnapTarget = Literal["vertex", "line", "intersection", "extension", "perpendicular"]

EXTENSION_M = 5.0
"""How far a line is thought to go on beyond its ends."""

LEVEL_M = 0.5
"""Places that lie further above or below the cursor belong to another level."""


@dataclass(frozen=True)
class LinePosition:
    """A place on drawn lines that the cursor may snap to.

    Attributes
    ----------
    xyz : Position
        m, project CRS; the height is the line's.
    what : {"vertex", "line", "intersection", "extension", "perpendicular"}
    distance_m : float
        From the cursor, in plan.
    """

    xyz: Position
    what: SnapTarget
    distance_m: float


def crosses_itself(positions: Sequence[Position], *, is_closed: bool) -> tuple[float, float] | None:
    """Where a line or ring first meets itself in plan; None where it doesn't.

    Sides that are neighbours meet at their common place, which doesn't count; nor does it where
    an open line ends on itself.

    Returns
    -------
    easting, northing : float
        m, project CRS.
    """
    line = Polyline.of(positions, is_closed=is_closed)
    sides = line.plan_sides
    sides = sides[(sides[:, 0] != sides[:, 1]).any(axis=1)]
    if len(sides) < 3:
        return None
    found = first_meeting(sides, is_closed=is_closed)
    if found is None:
        return None
    one, other = sides[found[0]], sides[found[1]]
    fractions, _ = crossing_fractions(one[None], other[None])
    if np.isnan(fractions[0]):
        # They lie on one another: the first place that both have.
        shared = shapely.get_coordinates(
            shapely.intersection(shapely.LineString(one), shapely.LineString(other))
        )
        position = shared[0]
    else:
        position = one[0] + fractions[0].clip(0, 1) * (one[1] - one[0])
    east, north = (position + line.origin[:2]).tolist()
    return float(east), float(north)


def line_positions(
    near: Position,
    lines: Sequence[Sequence[Position]],
    reach_m: float,
    *,
    from_: Position | None = None,
) -> tuple[LinePosition, ...]:
    """The places on drawn lines that a cursor may snap to.

    Vertices; the nearest place on each line; crossings of lines in plan; straight continuations
    of open lines for 5 m beyond their ends and where those cross; the feet of perpendiculars.

    Parameters
    ----------
    near : Position
        The cursor, m, project CRS.
    lines : sequence of sequences of Position
        A ring repeats its first place at the end; a point is a line of one place.
    reach_m : float
        Most distance from the cursor in plan. Places more than 0.5 m above or below the cursor
        are no candidates.
    from_ : Position, optional
        Where perpendiculars start: the last place drawn.

    Returns
    -------
    tuple of LinePosition
        The nearest first; of places of different sorts within a millimetre of each other only a
        vertex, then an intersection, is given.
    """
    drawn = _Drawn.of(near, lines)
    nearby = _Nearby.of(drawn, reach_m)
    found: list[tuple[Floats, SnapTarget]] = [
        *((position, "vertex") for position in drawn.vertices_within(reach_m)),
        *((position, "intersection") for position in nearby.crossings()),
        *((position, "perpendicular") for position in nearby.feet(from_, near)),
        *((position, "line") for position in nearby.nearest_of_lines()),
        *((position, "extension") for position in nearby.nearest_of_extensions()),
    ]
    kept: list[tuple[Floats, SnapTarget]] = []
    for position, what in found:
        is_near = np.hypot(position[0], position[1]) <= reach_m and abs(position[2]) <= LEVEL_M
        if is_near and not any(_is_shown(position, what, other) for other in kept):
            kept.append((position, what))
    origin = np.array(near)
    positions = [
        LinePosition(
            position_of(position + origin), what, float(np.hypot(position[0], position[1]))
        )
        for position, what in kept
    ]
    return tuple(sorted(positions, key=lambda one: one.distance_m))


def _is_shown(position: Floats, what: SnapTarget, other: tuple[Floats, SnapTarget]) -> bool:
    """Whether another place already stands for this one."""
    if what == "vertex":
        # Vertices of two lines in one place are one target only where their heights agree.
        return other[1] == "vertex" and bool(np.abs(position - other[0]).max() < SAME_POSITION_M)
    return float(np.hypot(*(position - other[0])[:2])) < SAME_POSITION_M


@dataclass(frozen=True)
class _Drawn:
    """All lines about the cursor, so that distances are lengths.

    Attributes
    ----------
    xyz : (n, 3) float64
        The places of all lines, one line after the other.
    starts : (lines + 1,) int64
        Where each line begins in ``xyz``.
    """

    xyz: Floats
    starts: NDArray[np.int64]

    @staticmethod
    def of(near: Position, lines: Sequence[Sequence[Position]]) -> _Drawn:
        """Take the lines as one array: a map has thousands of places, a cursor moves often."""
        starts = np.concatenate([[0], np.cumsum([len(line) for line in lines], dtype=np.int64)])
        numbers = chain.from_iterable(chain.from_iterable(lines))
        flat = np.fromiter(numbers, dtype=np.float64, count=3 * int(starts[-1]))
        return _Drawn(flat.reshape(-1, 3) - np.array(near), starts)

    def vertices_within(self, reach_m: float) -> Floats:
        """(k, 3): the places within reach in plan."""
        return self.xyz[np.hypot(self.xyz[:, 0], self.xyz[:, 1]) <= reach_m]

    def sides(self) -> tuple[Floats, NDArray[np.int64]]:
        """The sides of all lines, (m, 2, 3), and the line of each."""
        owner = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        inside = owner[1:] == owner[:-1]
        return np.stack([self.xyz[:-1], self.xyz[1:]], axis=1)[inside], owner[:-1][inside]

    def extensions(self, reach_m: float) -> Iterator[tuple[int, Floats]]:
        """The continuations, (2, 3) each, of open lines that end near the cursor."""
        firsts, ends = self.starts[:-1], self.starts[1:]
        chosen = np.flatnonzero(ends - firsts > 1)
        corners = self.xyz[np.stack([firsts[chosen], ends[chosen] - 1])]
        is_open = (corners[0] != corners[1]).any(axis=1)
        may_reach = np.hypot(corners[..., 0], corners[..., 1]) <= EXTENSION_M + reach_m
        for number in chosen[is_open & may_reach.any(axis=0)]:
            xyz = self.xyz[firsts[number] : ends[number]]
            for ordered in (xyz[::-1], xyz):
                beyond = end_direction(Polyline(np.zeros(3), ordered))
                if beyond is not None:
                    direction, slope = beyond
                    end = ordered[-1] + EXTENSION_M * np.append(direction, slope)
                    yield int(number), np.stack([ordered[-1], end])


@dataclass(frozen=True)
class _Nearby:
    """The sides within reach of the cursor and the continuations, which are sides as well.

    Attributes
    ----------
    sides : (m, 2, 3) float64
        About the cursor.
    owner : (m,) int64
        The line of each side.
    is_extension : (m,) bool
    """

    sides: Floats
    owner: NDArray[np.int64]
    is_extension: NDArray[np.bool_]

    @staticmethod
    def of(drawn: _Drawn, reach_m: float) -> _Nearby:
        """Collect what comes within reach in plan."""
        sides, owner = drawn.sides()
        beyond = list(drawn.extensions(reach_m))
        sides = np.concatenate([sides, *(side[None] for _, side in beyond)])
        owner = np.concatenate([owner, np.array([line for line, _ in beyond], np.int64)])
        is_extension = np.arange(len(sides)) >= len(sides) - len(beyond)
        near = nearest_fractions(sides[:, :, :2], np.zeros(2))[1] <= reach_m
        return _Nearby(sides[near], owner[near], is_extension[near])

    def nearest_of_lines(self) -> Iterator[Floats]:
        """The place nearest to the cursor on each line."""
        chosen = np.flatnonzero(~self.is_extension)
        fractions, distances = nearest_fractions(self.sides[chosen, :, :2], np.zeros(2))
        for owner in np.unique(self.owner[chosen]):
            own = np.flatnonzero(self.owner[chosen] == owner)
            best = own[distances[own].argmin()]
            yield self._at(int(chosen[best]), float(fractions[best]))

    def nearest_of_extensions(self) -> Iterator[Floats]:
        """The place nearest to the cursor on each continuation."""
        fractions, _ = nearest_fractions(self.sides[:, :, :2], np.zeros(2))
        for side in np.flatnonzero(self.is_extension):
            yield self._at(int(side), float(fractions[side]))

    def crossings(self) -> Iterator[Floats]:
        """Where sides cross in plan; the height is that of the one nearer to the cursor's."""
        if not len(self.sides):
            return
        one, other = meeting_pairs(self.sides[:, :, :2], self.sides[:, :, :2])
        chosen = one < other
        one, other = one[chosen], other[chosen]
        on_one, on_other = crossing_fractions(self.sides[one, :, :2], self.sides[other, :, :2])
        for i, j, s, t in zip(one, other, on_one, on_other, strict=True):
            is_corner = self.owner[i] == self.owner[j] and s in (0.0, 1.0) and t in (0.0, 1.0)
            if np.isnan(s) or is_corner:
                continue
            heights = self._at(i, s), self._at(j, t)
            yield min(heights, key=lambda position: abs(float(position[2])))

    def feet(self, start: Position | None, near: Position) -> Iterator[Floats]:
        """The feet of perpendiculars from a start, where they fall inside a side."""
        if start is None or not len(self.sides):
            return
        plan = self.sides[:, :, :2]
        fractions, _ = nearest_fractions(plan, (np.array(start) - np.array(near))[:2])
        for side in np.flatnonzero((fractions > 0) & (fractions < 1)):
            yield self._at(int(side), float(fractions[side]))

    def _at(self, side: int, fraction: float) -> Floats:
        start, end = self.sides[side]
        position: Floats = start + fraction * (end - start)
        return position
