"""What tells trunks and poles from other columns where few points show them, in decimetres."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.coarse.column_sums import (
    AROUND,
    EAST,
    EAST_EAST,
    EAST_NORTH,
    HIGH_SLAB,
    LOW_SLABS,
    LOWEST_M,
    MOST_GAP,
    NEAR,
    NORTH,
    NORTH_NORTH,
    ON,
    RING,
    SECTORS,
    SLAB_M,
    ColumnSums,
)

_FEWEST = 3
"""Points of a slab that tell how far it spreads."""

_HEAD_SLAB = 4
"""From 1.8 m on hang plates of signs (道路標識設置基準), and crowns above walks."""


class ColumnFacts(NamedTuple):
    """What speaks for a trunk, for a pole, or for something else.

    Attributes
    ----------
    points : float
        Decimal logarithm of those on the axis.
    per_m : float
        Decimal logarithm of those in a metre of height.
    top_m : float
        How far up the axis shows.
    room_m : float
        How much higher something else about it was seen.
    slabs : float
        Share of its heights that show it.
    free_low, free_high : float
        Share of the heights that have less beside it than on it: up to 2.6 m, and above.
    first_m : float
        Where it comes in sight.
    lean : float
        Run over rise.
    wide_m, flat : float
        Spread of the points up to 2.6 m across the axis where it is greatest, standard deviation;
        and how much less it is in the other direction, 0 to 1.
    thick_m : float
        The same spread within single heights, of the middle one of those that stand free: half of
        the diameter over the square root of 3, where points lie evenly on it.
    bends_m : float
        How far the middles of its slabs lie off the axis, root mean square.
    beside : float
        Decimal logarithm of the points in the ring beside it for each one on it, up to 2.6 m.
    hedge : float
        Share of the directions in which something stands beside it up to 2.6 m.
    crown : float
        Share of the directions in which something is around it above.
    leaves : float
        Decimal logarithm of the points around it above for each one on it there.
    widens : float
        How much more is around it above than up to 2.6 m, decimal logarithm.
    head_m, head_flat : float
        Spread of what is within a metre of the axis above 1.8 m where it is greatest in plan,
        standard deviation; and how much less it is in the other direction, 0 to 1: of plates and
        walls nearly nothing.
    """

    points: float
    per_m: float
    top_m: float
    room_m: float
    slabs: float
    free_low: float
    free_high: float
    first_m: float
    lean: float
    wide_m: float
    flat: float
    thick_m: float
    bends_m: float
    beside: float
    hedge: float
    crown: float
    leaves: float
    widens: float
    head_m: float
    head_flat: float


def facts_of(sums: ColumnSums, column: int) -> ColumnFacts | None:
    """The facts of one column; None of one with no more than two points on its axis."""
    slabs = sums.slabs[column]
    on = slabs[:, ON]
    last = _last_slab(on)
    shown = np.flatnonzero(on[: last + 1])
    if on[: last + 1].sum() <= 2 or not shown.size:
        return None
    first, top_m = int(shown[0]), LOWEST_M + (last + 1) * SLAB_M
    ring, around = slabs[:, RING], slabs[:, AROUND]
    wide, flat = _spread(slabs[:LOW_SLABS])
    above = slice(HIGH_SLAB, None)
    head, head_flat = _head(slabs[_HEAD_SLAB:])
    return ColumnFacts(
        points=math.log10(on[: last + 1].sum()),
        per_m=math.log10(on[: last + 1].sum() / ((last - first + 1) * SLAB_M)),
        top_m=top_m,
        room_m=max(0.0, float(sums.highest_m[column]) - top_m),
        slabs=shown.size / (last - first + 1),
        free_low=_free_share(on[:LOW_SLABS], ring[:LOW_SLABS]),
        free_high=_free_share(on[LOW_SLABS : last + 1], ring[LOW_SLABS : last + 1]),
        first_m=LOWEST_M + first * SLAB_M,
        lean=float(np.hypot(*sums.axes.lean[column])),
        wide_m=wide,
        flat=flat,
        thick_m=_thick(slabs[: last + 1], wide),
        bends_m=_bends(slabs[: last + 1]),
        beside=math.log10((1 + ring[:LOW_SLABS].sum()) / (1 + on[:LOW_SLABS].sum())),
        hedge=int(sums.low[column]).bit_count() / SECTORS,
        crown=int(sums.high[column]).bit_count() / SECTORS,
        leaves=math.log10((1 + around[above].sum()) / (1 + on[above].sum())),
        widens=math.log10((1 + around[above].sum()) / (1 + around[:LOW_SLABS].sum())),
        head_m=head,
        head_flat=head_flat,
    )


def _last_slab(on: Floats) -> int:
    """The highest slab of the axis, before a gap."""
    last, gap = -1, 0
    for slab, points in enumerate(on.tolist()):
        gap = 0 if points else gap + 1
        if points:
            last = slab
        elif gap > MOST_GAP and last >= 0:
            break
    return last


def _free_share(on: Floats, ring: Floats) -> float:
    """Share of the slabs with points on the axis that have fewer beside it; a half of none."""
    shown = on > 0
    return float((on > ring)[shown].mean()) if shown.any() else 0.5


def _spread(slabs: Floats) -> tuple[float, float]:
    """Greatest standard deviation across the axis, and how much less it is across that."""
    many = max(slabs[:, ON].sum() - np.count_nonzero(slabs[:, ON]), 1.0)
    return _wide_and_flat(_moments(slabs).sum(axis=0) / many)


def _thick(slabs: Floats, wide_m: float) -> float:
    """Middle one of the spreads within slabs that stand free; of all together without such."""
    is_free = (slabs[:, ON] >= _FEWEST) & (slabs[:, ON] > slabs[:, RING])
    if not is_free.any():
        return wide_m
    moments = _moments(slabs[is_free]) / (slabs[is_free, ON, None] - 1)
    return float(np.median(_deviations(moments)[0]))


def _head(slabs: Floats) -> tuple[float, float]:
    """Greatest standard deviation in plan of all that is near, and how much less the other is."""
    sums = slabs[:, NEAR:].sum(axis=0)
    if sums[0] < _FEWEST:
        return 0.0, 0.0
    east, north, *squares = sums[1:] / sums[0]
    moments = np.array(squares) - (east * east, north * north, east * north)
    return _wide_and_flat(moments)


def _wide_and_flat(moments: Floats) -> tuple[float, float]:
    wide, thin = _deviations(moments)
    return float(wide), float(1.0 - thin / wide) if wide > 0 else 0.0


def _moments(slabs: Floats) -> Floats:
    """(n, 3) second moments about the middle of each slab: east, north and both."""
    counts = np.maximum(slabs[:, ON], 1)
    east, north = slabs[:, EAST], slabs[:, NORTH]
    return np.column_stack(
        [
            slabs[:, EAST_EAST] - east * east / counts,
            slabs[:, NORTH_NORTH] - north * north / counts,
            slabs[:, EAST_NORTH] - east * north / counts,
        ]
    )


def _deviations(moments: Floats) -> tuple[Floats, Floats]:
    """Greatest and least standard deviation, of variances: (..., 3)."""
    xx, yy, xy = np.moveaxis(moments, -1, 0)
    middle, half = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    return np.sqrt(np.maximum(middle + half, 0.0)), np.sqrt(np.maximum(middle - half, 0.0))


def _bends(slabs: Floats) -> float:
    shown = slabs[:, ON] > 0
    middles = slabs[shown][:, (EAST, NORTH)] / slabs[shown][:, ON, None]
    return float(np.sqrt((middles**2).sum(axis=1).mean()))
