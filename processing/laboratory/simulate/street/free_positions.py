"""Where things stand beside the road: each place is given away once.

Every maker of a section draws from the same `FreePositions`, so that no tree grows through a pole
and nothing stands on the carriageway, on a gutter's lids or in a side street.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.dropped_curbs import Drop, drops_of
from processing.laboratory.simulate.street.neighbours import neighbour
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES, SidePlan
from processing.laboratory.simulate.street.section import StreetSection

_KERB_GAP_M = 0.12  # between the rear of a curb or lid and what stands behind it
_WALL_GAP_M = 0.15
_FRONT_M = 1.3  # of a walk: what stands within would block an entrance


@dataclass(frozen=True)
class FreePosition:
    """A place to stand on.

    Attributes
    ----------
    chainage_m, offset_m : float
        Offsets count to the left of the road's centre.
    side : int
        `LEFT` or `RIGHT`.
    """

    chainage_m: float
    offset_m: float

    @property
    def side(self) -> int:
        """Of the road."""
        return LEFT if self.offset_m > 0 else RIGHT


def free_from_m(side: SidePlan, *beside: SidePlan | None) -> float:
    """Distance from the road's centre where the ground behind gutter and curb begins.

    Parameters
    ----------
    beside : SidePlan or None
        The same side of the neighbouring sections: widths change gently towards theirs.
    """
    away = side.edge_m
    for band in side.bands():
        if band.name in ("drain", "curb"):
            away = band.outer_m
    others = [(away + free_from_m(one)) / 2 for one in beside if one is not None]
    return max([away, *others])


def is_entrance(drops: tuple[Drop, ...], chainage_m: float, radius_m: float) -> bool:
    """Whether a curb is lowered somewhere within a radius: nobody sets up a post there."""
    return any(one.from_m - radius_m < chainage_m < one.to_m + radius_m for one in drops)


def free_to_m(side: SidePlan) -> float:
    """Distance from the road's centre up to which things may stand: the foot of a wall."""
    outside = side.band("outside")
    if side.outside == "wall" and outside is not None:
        return outside.inner_m - _WALL_GAP_M
    return side.edge_m + 60.0


@dataclass
class FreePositions:
    """What is still free beside a section."""

    section: StreetSection
    _taken: list[tuple[float, float, float]] = field(default_factory=list)
    _blocked: list[tuple[float, float, float, float]] = field(default_factory=list)

    def is_free(self, spot: FreePosition, radius_m: float) -> bool:
        """Whether something of a radius can stand there."""
        plan = self.section.plan
        if spot.side in plan.junctions:
            return False
        side = plan.side(spot.side)
        away = abs(spot.offset_m)
        if not plan.start_m + radius_m <= spot.chainage_m <= plan.end_m - radius_m:
            return False
        near, drops = self._edges[spot.side]
        if away - radius_m < near + _KERB_GAP_M or away + radius_m > free_to_m(side):
            return False
        if away - radius_m < near + _FRONT_M and is_entrance(drops, spot.chainage_m, radius_m):
            return False
        if any(
            low - radius_m < spot.chainage_m < high + radius_m
            and near - radius_m < spot.offset_m < far + radius_m
            for low, high, near, far in self._blocked
        ):
            return False
        return all(
            np.hypot(spot.chainage_m - s, spot.offset_m - o) > radius_m + r
            for s, o, r in self._taken
        )

    def near_m(self, side: int) -> float:
        """Distance from the road's centre where a side's free ground begins."""
        return self._edges[side][0]

    @cached_property
    def _edges(self) -> dict[int, tuple[float, tuple[Drop, ...]]]:
        """Of each side: where its free ground begins, and its lowered curbs."""
        plan = self.section.plan
        beside = [neighbour(self.section, step) for step in (-1, 1)]
        edges = {}
        for side in SIDES:
            others = [None if one is None else one.side(side) for one in beside]
            near = free_from_m(plan.side(side), *others)
            edges[side] = (near, drops_of(self.section.seed, plan, side))
        return edges

    def take(self, spot: FreePosition, radius_m: float) -> bool:
        """Give a place away; False where it isn't free."""
        if not self.is_free(spot, radius_m):
            return False
        self._taken.append((spot.chainage_m, spot.offset_m, radius_m))
        return True

    def block(self, chainages_m: tuple[float, float], offsets_m: tuple[float, float]) -> None:
        """Give a rectangle away, from and to along and across the road: a building, a wall."""
        self._blocked.append((*chainages_m, *offsets_m))

    def standing_near(self, offset_m: float, room_m: float) -> Iterator[tuple[float, float]]:
        """Chainages from and to where something stands within a distance of a line.

        Parameters
        ----------
        offset_m : float
            Of the line, m to the left of the centre.
        """
        for chainage, offset, radius in self._taken:
            if abs(offset - offset_m) < radius + room_m:
                yield chainage - radius - room_m, chainage + radius + room_m
        for low, high, near, far in self._blocked:
            if near - room_m < offset_m < far + room_m:
                yield low - room_m, high + room_m

    def where(self, spot: FreePosition) -> Floats:
        """The place on the ground: (3,) float64, m, the street's frame."""
        return self.section.position(spot.chainage_m, spot.offset_m)

    def beside(
        self, random: Generator, side: int, chainage_m: float, radius_m: float
    ) -> FreePosition | None:
        """Where posts are set up at a chainage: behind the curb, or at the walk's far edge."""
        plan = self.section.plan.side(side)
        near = self.near_m(side) + _KERB_GAP_M + radius_m
        walk = plan.band("walk")
        away = near + float(random.uniform(0.0, 0.45))
        if walk is not None and random.random() < 0.25:
            away = walk.outer_m - radius_m - float(random.uniform(0.02, 0.2))
        for distance in (away, near + 0.01):
            spot = FreePosition(chainage_m, side * distance)
            if self.take(spot, radius_m):
                return spot
        return None
