"""What stands on trunks: whether it is a crown, whose it is, its height, spread, lowest branch.

A crown fills space on all sides of the trunk's axis and hangs together with it. The arm of a lamp
is a line on one side, a sign a plane on two opposite ones, the house behind a post a plane on one
(Takahashi 2022, 5.2, asks for the spread of the wires' directions, which tells the same). Crowns
of neighbours touch, and hang over posts that have none: what hangs together is shared out.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.trees.crown_cells import CELL_M, LOW_M, CrownCells
from processing.methods.road.trees.rises import StemRise
from processing.methods.road.trees.trunks import Trunk

CROWN_M = 8.0
"""Points so near to the axis may be of its crown: those of old zelkovas are 15 m wide."""

_LOW_M = 1.4
"""Crowns are looked for above: what is lower is hedge, stake or guard."""

_AXIS_M = 0.6
"""What is so near to the axis above the stem belongs to what stands on it."""

_ABOVE_M = 2.5
"""So far above the highest point that was seen of the stem: the crown hides what goes on."""

_BARE_LINK = 2
"""Cells from one to the next of a bare crown, boughs included: its gaps are half a metre. Leafy
ones touch; by boughs and gaps they would reach houses and wires."""

_WHOLE = 20
"""Cells of a part that may be a crown: 1.3 m³."""

_LOWEST_SHARE = 0.01
"""Of the crown's points: lower ones are single leaves."""

_TOP_M = 1.5
"""A crown's top is so near to its middle or above its trunk; what is higher beside may be a house
that it touches."""

_FEWEST = 3
"""Points of the cell that is the top of a crown: what is higher is a single shoot or a bird."""

_STRONGER = 2 / 3
"""Power of the diameter by which trunks share out what hangs together: the crown's width grows so
with the trunk (Tao et al. 2015, Segmenting tree crowns from terrestrial and mobile lidar, ISPRS
Journal 110, eq. 2)."""


_DIRECTIONS, _OFF_AXIS_M = 12, 0.5
"""About the axis in which a crown is looked for, beyond what may be the trunk's own."""

_SLENDEREST, _SLENDER_ROOM_M = 80.0, 1.5
"""Height over diameter of slender trees that stand by themselves (Wang, Titus, LeMay 1998, Canadian
Journal of Forest Research 28: those beyond 100 are blown over), and m that stakes add to a young
one: what is higher belongs to another tree."""


class CrownShape(NamedTuple):
    """How what a trunk carries lies about its axis, cells included whose own shape isn't told.

    Attributes
    ----------
    sides : float
        Share of twelve directions in which some of it is.
    off_m : float
        How far the middle of its points lies from the axis in plan. 0 of nothing, as the other.
    """

    sides: float
    off_m: float


@dataclass(frozen=True)
class Crown:
    """What was measured above and about a trunk.

    Attributes
    ----------
    cells : int
        That twigs fill: 0.064 m³ each.
    flat_share : float
        Of the cells near the axis up to the crown's end whose shape is told, those that are planes
        or level lines.
    aside : float
        How far its middle lies from the axis, over its radius.
    rival : float
        How much farther the crown of a neighbour's trunk would lie aside if this were a part of
        it, over that crown's radius; negative: it would lie more about its trunk; 1 without one.
    gap_m : float
        The longest piece between stem and crown where nothing was measured about the axis.
    height_m : float
        Of the highest point above the foot.
    spread_m : tuple of float
        The crown's widest extent in plan and that square to it.
    lowest_m : float
        Where branches begin above the foot; NaN without any.
    underside : (n, 3) float64
        The lowest point of each 0.4 m of the plan, m about the plan's origin.
    shape : CrownShape
    """

    cells: int
    flat_share: float
    aside: float
    rival: float
    gap_m: float
    height_m: float
    spread_m: tuple[float, float]
    lowest_m: float
    underside: Floats
    shape: CrownShape


@dataclass(frozen=True)
class UprightTrunk:
    """A trunk where it stands.

    Attributes
    ----------
    trunk : Trunk
    foot : (3,) float64
        m about the plan's origin.
    rise : StemRise
        How its thickest stem goes on above.
    """

    trunk: Trunk
    foot: Floats
    rise: StemRise

    @property
    def top_m(self) -> float:
        """How high it was seen."""
        return max(stem.high_m for stem in self.trunk.stems)

    @property
    def top(self) -> Floats:
        """(2,) where its stems end in plan, in the middle of them, m about the plan's origin."""
        ends = [stem.middle_at(self.top_m) for stem in self.trunk.stems_about_foot]
        place: Floats = self.foot[:2] + np.mean(ends, axis=0)
        return place


class CrownShares:
    """The cells above trunks, and which of them hang together with which trunk.

    Notes
    -----
    1. Cells above 1.4 m that are no planes and no lines hang together where they touch; where that
       isn't enough for a crown, boughs too, and with one cell between.
    2. A trunk belongs to the largest part that comes near to its axis above the stem.
    3. Trunks of one part share it out: each cell goes to the trunk that is nearest, measured by
       the width that crowns of such trunks have.
    """

    def __init__(self, cells: CrownCells, trunks: Sequence[UprightTrunk], monitor: Monitor) -> None:
        monitor.check()
        self._cells, self._trunks = cells, trunks
        self._middles = cells.middles
        self._tops = np.array([one.top for one in trunks]).reshape(-1, 2)
        self._feet = np.array([one.foot[2] for one in trunks])
        wide = np.array([one.trunk.diameter_m for one in trunks]) ** _STRONGER
        self._reach = wide
        diameters = np.array([one.trunk.diameter_m for one in trunks])
        self._highest = self._feet + _SLENDEREST * diameters + _SLENDER_ROOM_M
        above = self._middles[:, 2] - self._feet[cells.trunks]
        self._is_high = above > _LOW_M
        is_open = self._is_high & ~cells.is_flat
        self._parts = np.stack(
            [cells.components(is_open & ~cells.is_bough, 1), cells.components(is_open, _BARE_LINK)]
        )
        monitor.check()
        plan = cKDTree(self._middles[:, :2])
        self._near = [
            np.array(plan.query_ball_point(top, 2 * _AXIS_M, return_sorted=True), np.int64)
            for top in self._tops
        ]
        self._stands = cKDTree(self._tops)
        self._sizes = [np.bincount(parts[parts >= 0]) for parts in self._parts]
        self._low = self._low_cells()
        touched = [self._touched(number) for number in range(len(trunks))]
        # By each link the part that a trunk comes near to; which link counts, and its part.
        self._touches = np.array(touched, np.int64).reshape(-1, 2)
        self._part_of = np.array([self._chosen(*one) for one in touched], np.int64).reshape(-1, 2)

    def crowns(self, is_asked: NDArray[np.bool_], monitor: Monitor) -> list[Crown]:
        """What each trunk carries if only those that are asked for share."""
        strips = np.floor(self._tops[:, 0] / CROWN_M).astype(np.int64)
        order = np.lexsort((self._tops[:, 1], strips))
        order = order[is_asked[order]]
        shares = np.full(len(self._cells), -1, np.int64)
        share_kernel(
            self._middles,
            self._parts,
            (order, strips, self._tops, self._reach, self._highest, self._part_of),
            shares,
        )
        by_trunk = np.argsort(shares, kind="stable")
        starts = np.searchsorted(shares[by_trunk], np.arange(len(self._trunks) + 1))
        of = [by_trunk[a:b] for a, b in itertools.pairwise(starts.tolist())]
        middles = [_PlanMoments.of(self._middles[cells, :2]) for cells in of]
        found = []
        for number in range(len(self._trunks)):
            monitor.check()
            rival = self._rival(number, middles, is_asked)
            found.append(self._crown(number, of[number], rival))
        return found

    def _touched(self, number: int) -> tuple[int, int]:
        """By each link the largest part near the axis above the stem; −1: none."""
        about = self._about(number, _AXIS_M)
        up = self._middles[about, 2] - self._feet[number]
        trunk = self._trunks[number]
        seeds = about[(up > _LOW_M) & (up < max(trunk.top_m, trunk.rise.high_m) + _ABOVE_M)]
        best = [-1, -1]
        for link, sizes in enumerate(self._sizes):
            parts = np.unique(self._parts[link, seeds])
            parts = parts[parts >= 0]
            if parts.size:
                best[link] = int(parts[sizes[parts].argmax()])
        return best[0], best[1]

    def _chosen(self, leafy: int, bare: int) -> tuple[int, int]:
        """Which of both links, and which part: leafy ones that are a crown, else bare ones."""
        is_whole = leafy >= 0 and self._sizes[0][leafy] >= _WHOLE
        return (0, leafy) if is_whole or bare < 0 else (1, bare)

    def _about(self, number: int, reach_m: float) -> Integers:
        """Cells near the end of a trunk in plan."""
        near = self._near[number]
        beside = self._middles[near, :2] - self._tops[number]
        return np.asarray(near[np.hypot(beside[:, 0], beside[:, 1]) < reach_m])

    def _rival(
        self, number: int, middles: Sequence[_PlanMoments], is_asked: NDArray[np.bool_]
    ) -> float:
        """How ill this trunk's share suits the neighbour that it suits best."""
        if self._part_of[number, 1] < 0:
            return 1.0
        link, part = self._part_of[number].tolist()
        beside = self._stands.query_ball_point(self._tops[number], CROWN_M, return_sorted=True)
        near = np.array(beside, np.int64)
        is_rival = is_asked[near] & (self._touches[near, link] == part) & (near != number)
        rivals: Integers = near[is_rival]
        worse: list[float] = [
            (middles[one] + middles[number]).aside(self._tops[one])
            - middles[one].aside(self._tops[one])
            for one in rivals.tolist()
            if middles[one].count
        ]
        return min([1.0, *worse])

    def _crown(self, number: int, share: Integers, rival: float) -> Crown:
        cells, one = self._cells, self._trunks[number]
        foot, top = float(self._feet[number]), one.top_m
        near = self._about(number, 2 * _AXIS_M)
        near = near[self._is_high[near]]
        ends = cells.highest[share, 2].max(initial=foot + top + _ABOVE_M)
        told = near[cells.is_told[near] & (cells.lowest[near, 2] < ends)]
        flat_share = float(cells.is_flat[told].mean()) if told.size else 1.0
        leafy = share[cells.is_told[share]]
        shape = _shape_of(self._middles[share] - (*self._tops[number], foot), cells.counts[share])
        if leafy.size == 0:
            highest = cells.highest[self._about(number, _AXIS_M), 2].max(initial=foot + top)
            return _bare(max(top, float(highest) - foot), flat_share, shape)
        dense = share[cells.counts[share] >= _FEWEST]
        inner = dense[self._is_inner(dense, number)]
        top_of = inner if inner.size else dense if dense.size else share
        highest = cells.highest[top_of, 2].max()
        return Crown(
            cells=int(leafy.size),
            flat_share=flat_share,
            aside=_PlanMoments.of(self._middles[leafy, :2]).aside(self._tops[number]),
            rival=rival,
            gap_m=self._gap(near, share, number),
            height_m=max(top, float(highest) - foot),
            spread_m=_spread(cells.lowest[share, :2], cells.highest[share, :2]),
            lowest_m=self._lowest(share, number) - foot,
            underside=_underside(cells, dense),
            shape=shape,
        )

    def _is_inner(self, share: Integers, number: int) -> NDArray[np.bool_]:
        """Which cells are near the middle of a crown or above the trunk."""
        if share.size == 0:
            return np.zeros(0, np.bool_)
        places = self._middles[share, :2]
        near = np.hypot(*(places - np.median(places, axis=0)).T) < _TOP_M
        above = np.hypot(*(places - self._tops[number]).T) < _TOP_M
        return np.asarray(near | above)

    def _low_cells(self) -> dict[tuple[int, int, int], int]:
        """Cells below 1.4 m that may be branches, by their place.

        The lowest of all heights hold shrubs and shoots, and what stands on those is theirs.
        """
        cells = self._cells
        bottom = cells.places[:, 2] * CELL_M - self._feet[cells.trunks]
        # Legs of a tripod rise as boughs do.
        is_leafy = cells.is_told & ~cells.is_flat & ~cells.is_bough
        is_low = ~self._is_high & is_leafy & (bottom >= LOW_M) & (cells.counts >= _FEWEST)
        low = np.flatnonzero(is_low)
        low = low[~cells.are_above(low, ~self._is_high)]
        places = zip(low.tolist(), cells.places[low].tolist(), strict=True)
        return {(i, j, k): cell for cell, (i, j, k) in places}

    def _lowest(self, share: Integers, number: int) -> float:
        """Where branches begin, m about the plan's origin: those that hang below the crown too."""
        cells, lowest = self._cells, _lowest(self._cells, share)
        waiting = cells.places[share[cells.lowest[share, 2] < lowest + 2 * CELL_M]].tolist()
        seen: set[int] = set()
        while waiting:
            i, j, k = waiting.pop()
            for place in itertools.product((i - 1, i, i + 1), (j - 1, j, j + 1), (k - 1, k)):
                cell = self._low.get(place)
                if cell is not None and cell not in seen and cells.trunks[cell] == number:
                    seen.add(cell)
                    waiting.append(list(place))
        return min([lowest, *(float(cells.lowest[cell, 2]) for cell in seen)])

    def _gap(self, near: Integers, share: Integers, number: int) -> float:
        """The longest piece of the axis between stem and crown about which nothing was measured."""
        cells, foot = self._cells, float(self._feet[number])
        crown = near[np.isin(near, share)]
        if crown.size == 0:
            return float("inf")
        top = max(self._trunks[number].top_m, self._trunks[number].rise.high_m)
        begins = float(cells.lowest[crown, 2].min()) - foot
        order = near[np.argsort(cells.lowest[near, 2], kind="stable")]
        reached, gap = top, 0.0
        for cell in order.tolist():
            low = float(cells.lowest[cell, 2]) - foot
            if low >= begins:
                break
            gap = max(gap, low - reached)
            reached = max(reached, float(cells.highest[cell, 2]) - foot)
        return max(gap, begins - reached)


@dataclass(frozen=True)
class _PlanMoments:
    """Number, sums and sum of squares of places in plan."""

    count: int
    total: Floats
    square: float

    @staticmethod
    def of(places: Floats) -> _PlanMoments:
        return _PlanMoments(len(places), places.sum(axis=0), float((places**2).sum()))

    def __add__(self, other: _PlanMoments) -> _PlanMoments:
        return _PlanMoments(
            self.count + other.count, self.total + other.total, self.square + other.square
        )

    def aside(self, axis: Floats) -> float:
        """How far their middle lies from an axis, over the radius of a disc that spreads so far."""
        if self.count == 0:
            return 1.0
        middle = self.total / self.count
        spread = max(self.square / self.count - float(middle @ middle), 0.0)
        return float(np.hypot(*(middle - axis))) / max(math.sqrt(2 * spread), CELL_M)


def _shape_of(about: Floats, counts: Integers) -> CrownShape:
    """The shape of cells about a trunk's axis and foot, (n, 3) float64 m, with so many points."""
    if not len(about):
        return CrownShape(0.0, 0.0)
    off = about[np.hypot(about[:, 0], about[:, 1]) > _OFF_AXIS_M]
    turns = (np.arctan2(off[:, 1], off[:, 0]) + np.pi) / (2 * np.pi) * _DIRECTIONS
    middle = np.average(about[:, :2], axis=0, weights=counts)
    return CrownShape(
        sides=np.unique(turns.astype(np.int64) % _DIRECTIONS).size / _DIRECTIONS,
        off_m=float(np.hypot(*middle)),
    )


def _bare(height_m: float, flat_share: float, shape: CrownShape) -> Crown:
    """Of what carries none."""
    return Crown(
        cells=0,
        flat_share=flat_share,
        aside=1.0,
        rival=1.0,
        gap_m=np.inf,
        height_m=height_m,
        spread_m=(0.0, 0.0),
        lowest_m=float("nan"),
        underside=np.empty((0, 3)),
        shape=shape,
    )


@kernel
def share_kernel(
    middles: Floats,
    parts: Integers,
    trunks: tuple[Integers, Integers, Floats, Floats, Floats, Integers],
    shares: Integers,
) -> None:
    """Give each cell to a trunk of its part.

    Parameters
    ----------
    trunks : (order, strips, tops, reach, highest, part_of)
        Numbers of those that share, by strips `CROWN_M` wide from west to east, in each from south
        to north; of all, their strip, where they end, the width that crowns of such have, how high
        such trees can be, and their part: of which row of ``parts``, and which.
    shares : (n,) int64
        Written; −1 where no trunk of the part is near.
    """
    order, strips, tops, reach, highest, part_of = trunks
    for cell in range(len(middles)):
        if parts[1, cell] < 0:
            continue
        east, north = middles[cell, 0], middles[cell, 1]
        best = np.inf
        own = math.floor(east / CROWN_M)
        for strip in range(own - 1, own + 2):
            for rank in range(_first_rank(trunks, strip, north - CROWN_M), order.size):
                trunk = order[rank]
                if strips[trunk] > strip or tops[trunk, 1] > north + CROWN_M:
                    break
                if (
                    part_of[trunk, 1] != parts[part_of[trunk, 0], cell]
                    or middles[cell, 2] > highest[trunk]
                ):
                    continue
                away = math.hypot(east - tops[trunk, 0], north - tops[trunk, 1])
                if away < CROWN_M and away / reach[trunk] < best:
                    best = away / reach[trunk]
                    shares[cell] = trunk


@kernel
def _first_rank(
    trunks: tuple[Integers, Integers, Floats, Floats, Floats, Integers], strip: int, north: float
) -> int:
    """The first trunk in order that is not before a place."""
    order, strips, tops = trunks[:3]
    low, high = 0, order.size
    while low < high:
        middle = (low + high) // 2
        trunk = order[middle]
        if strips[trunk] < strip or (strips[trunk] == strip and tops[trunk, 1] < north):
            low = middle + 1
        else:
            high = middle
    return low


def _lowest(cells: CrownCells, share: Integers) -> float:
    """The height below which hardly any points of a crown lie, m about the plan's origin."""
    order = share[np.argsort(cells.lowest[share, 2], kind="stable")]
    below = np.cumsum(cells.counts[order])
    first = int(np.searchsorted(below, _LOWEST_SHARE * below[-1]))
    return float(cells.lowest[order[first], 2])


def _underside(cells: CrownCells, share: Integers) -> Floats:
    """The lowest point of each column of cells of a crown, (n, 3)."""
    order = share[np.lexsort((cells.places[share, 2], *cells.places[share, :2].T))]
    places = cells.places[order, :2]
    first = np.ones(len(order), np.bool_)
    first[1:] = (np.diff(places, axis=0) != 0).any(axis=1)
    lowest = order[first]
    below: Floats = np.column_stack([(places[first] + 0.5) * CELL_M, cells.lowest[lowest, 2]])
    return below


def _spread(low: NDArray[np.float32], high: NDArray[np.float32]) -> tuple[float, float]:
    """Extent of boxes along the direction in which it is widest, and square to it."""
    turns = np.radians(np.arange(0, 180, 10))
    axes = np.array([np.cos(turns), np.sin(turns)])
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    along, room = middle @ axes, half @ np.abs(axes)
    extents = (along + room).max(axis=0) - (along - room).min(axis=0)
    widest = int(extents.argmax())
    across = (widest + len(turns) // 2) % len(turns)
    return float(extents[widest]), float(extents[across])
