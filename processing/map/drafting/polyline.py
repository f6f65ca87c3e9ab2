"""Polyline: the positions of a line or ring as arrays about its first place.

Products of survey coordinates lose the millimetres, so everything is computed about an origin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.map.feature import Position

SAME_POSITION_M = 1e-3
"""Places nearer than this are one place: a millimetre, as coordinates are delivered."""

_SLOPE_OVER_M = 1.0
_ZERO_M = 1e-9


@dataclass(frozen=True)
class Polyline:
    """A line or ring about an origin.

    Attributes
    ----------
    origin : (3,) float64
        m, project CRS.
    xyz : (n, 3) float64
        Easting, northing, height about ``origin``; a ring's first place is not repeated.
    is_closed : bool
        Whether a side leads from the last place to the first.
    """

    origin: Floats
    xyz: Floats
    is_closed: bool = False

    @classmethod
    def of(
        cls,
        positions: Sequence[Position],
        *,
        is_closed: bool = False,
        origin: Position | None = None,
    ) -> Polyline:
        """The positions about the first of them, or about a given origin."""
        absolute = np.array(positions, dtype=np.float64).reshape(-1, 3)
        first = absolute[0] if origin is None and absolute.size else np.array(origin or (0, 0, 0))
        return cls(first.astype(np.float64), absolute - first, is_closed)

    @cached_property
    def starts(self) -> Floats:
        """(m, 3): where each side begins."""
        return self.xyz if self.is_closed else self.xyz[:-1]

    @cached_property
    def ends(self) -> Floats:
        """(m, 3): where each side ends."""
        return np.roll(self.xyz, -1, axis=0) if self.is_closed else self.xyz[1:]

    @cached_property
    def plan_sides(self) -> Floats:
        """(m, 2, 2): start and end of each side seen from above."""
        return np.stack([self.starts[:, :2], self.ends[:, :2]], axis=1)

    @cached_property
    def plan_distances(self) -> Floats:
        """(m + 1,): plan length from the first place to the start of each side, and the whole."""
        lengths = np.linalg.norm(self.ends[:, :2] - self.starts[:, :2], axis=1)
        return np.concatenate([[0.0], np.cumsum(lengths)])

    def local(self, position: Position) -> Floats:
        """A place about the origin: (3,)."""
        return np.array(position, dtype=np.float64) - self.origin

    def between(self, sides: NDArray[np.int64], fractions: Floats) -> Floats:
        """Places on sides, (k, 3) about the origin; a fraction of 0 is the side's start."""
        starts, ends = self.starts[sides], self.ends[sides]
        positions: Floats = starts + fractions[:, None] * (ends - starts)
        return positions

    def positions(self, local: Floats) -> tuple[Position, ...]:
        """Places about the origin, (k, 3), as positions in the project's system."""
        absolute = (local + self.origin).tolist()
        return tuple((x, y, z) for x, y, z in absolute)


def position_of(position: Floats) -> Position:
    """A position from (3,) absolute coordinates."""
    return (float(position[0]), float(position[1]), float(position[2]))


def end_direction(line: Polyline) -> tuple[Floats, float] | None:
    """How an open line goes on straight beyond its last place.

    The direction is that of the last side that has a length in plan; the slope is taken over the
    last metre, since a short side says little about it.

    Returns
    -------
    direction : (2,) float64
        Unit vector in plan.
    slope : float
        Metres of height per metre in plan.

    or None where the line has no length in plan.
    """
    plan = line.xyz[:, :2] - line.xyz[-1, :2]
    away = np.linalg.norm(plan, axis=1)
    before = np.flatnonzero(away > _ZERO_M)
    if not before.size:
        return None
    direction = -plan[before[-1]] / away[before[-1]]
    along = line.plan_distances[-1] - line.plan_distances
    far = np.flatnonzero(along >= _SLOPE_OVER_M)
    start = int(far[-1]) if far.size else 0
    slope = float((line.xyz[-1, 2] - line.xyz[start, 2]) / along[start])
    return direction, slope


def name_position(position: Position) -> Text:
    """Where a message is about."""
    return Text("Easting {e:.3f}, northing {n:.3f}", "東距 {e:.3f}、北距 {n:.3f}").filled(
        e=position[0], n=position[1]
    )
