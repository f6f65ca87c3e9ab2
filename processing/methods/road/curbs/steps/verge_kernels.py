"""A loop over scanlines that tells grass and soil beside the road from pavement by their roughness.

What the vehicle drives on shows how far points of pavement lie off the straight between those
beside them, noise of the scanner included; grass and soil do so by several times as much.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

EVERY = 4
"""Scanlines of which one is looked at, 0.4 m: tells the same as all in a quarter of the time."""

BIN_M = 0.25
"""Of ground that is called rough or not as one: a blade of grass or a stone on the road is none."""

_LAG_M, _MOST_LAG_M = 0.05, 0.15
"""How far beside a point those lie between which the ground would be straight: tufts and clods are
as wide, a step meets it at few points only. Where points are sparser than the latter nothing is
told."""

_DRIVEN_M = 1.5
"""To either side of the path the vehicle's own width, which is road."""

_ROUGHER, _LEAST_M = 3.0, 0.01
"""Times the road's own median, 2.5 standard deviations of its scatter; and the texture and evenness
of any pavement over 10 cm, m."""

_SHARE, _FEWEST = 0.4, 4
"""Share of the points of a bin that must lie off so far, and the fewest that tell: of even ground
it is 1 %, of ground three times as rough a half."""

_WALL_M = 0.5
"""What reaches so high over the lowest point of a bin is a wall, a hedge or a vehicle, which says
nothing of the ground."""


@kernel
def verges_kernel(
    across: _Floats, height: _Floats, starts: _Integers, verges: NDArray[np.float32]
) -> None:
    """How much rough ground lies between the vehicle's path and places beside it.

    Parameters
    ----------
    across, height : (n,)
        Vertices, left to right, m.
    starts : (s + 1,)
        Where the scanlines begin.
    verges : (⌈s / EVERY⌉, 2, b)
        Is filled: left and right of the path, up to the far end of each bin, m; of every so many
        scanlines, as verges go on.
    """
    room = 1
    for section in range(starts.size - 1):
        room = max(room, starts[section + 1] - starts[section])
    off, driven = np.empty(room), np.empty(room)
    sums = np.empty((4, verges.shape[2]))
    for section in range(0, starts.size - 1, EVERY):
        part = slice(starts[section], starts[section + 1])
        x, h = across[part], height[part]
        _off_straight(x, h, off)
        limit = _limit(x, off, driven)
        for side in range(2):
            _fill_bins(x * (2 * side - 1), h, (off, limit), sums)
            _add_up(sums, verges[section // EVERY, side])


@kernel
def _fill_bins(away: _Floats, h: _Floats, rough: tuple[_Floats, float], sums: _Floats) -> None:
    """Lowest heights of bins away from the path, whether walls stand there, points and rough ones.

    ``rough`` is how far each point lies off the straight, and from where on it is rough.
    """
    low, walls, counts, roughs = sums
    off, limit = rough
    low[:] = math.inf
    sums[1:] = 0.0
    for i in range(away.size):
        k = int(away[i] / BIN_M)
        if away[i] >= 0 and k < low.size:
            low[k] = min(low[k], h[i])
    for i in range(away.size):
        k = int(away[i] / BIN_M)
        if away[i] < 0 or k >= low.size:
            continue
        if h[i] > low[k] + _WALL_M:
            walls[k] = 1.0
        elif not math.isnan(off[i]):
            counts[k] += 1.0
            roughs[k] += 1.0 if off[i] > limit else 0.0


@kernel
def _add_up(sums: _Floats, wide: NDArray[np.float32]) -> None:
    """How much is rough up to the far end of each bin, m."""
    _, walls, counts, roughs = sums
    total = 0.0
    for k in range(wide.size):
        if counts[k] >= _FEWEST and walls[k] == 0.0 and roughs[k] >= _SHARE * counts[k]:
            total += BIN_M
        wide[k] = total


@kernel
def _off_straight(x: _Floats, h: _Floats, off: _Floats) -> None:
    """How far each vertex lies off the straight between those beside it, m; NaN: there are none."""
    before, behind = 0, 0
    for i in range(x.size):
        off[i] = math.nan
        while before + 1 < i and x[before + 1] <= x[i] - _LAG_M:
            before += 1
        behind = max(behind, i)
        while behind + 1 < x.size and x[behind] < x[i] + _LAG_M:
            behind += 1
        one, other = x[i] - x[before], x[behind] - x[i]
        if _LAG_M <= one <= _MOST_LAG_M and _LAG_M <= other <= _MOST_LAG_M:
            off[i] = abs(h[i] - (h[before] * other + h[behind] * one) / (one + other))


@kernel
def _limit(x: _Floats, off: _Floats, driven: _Floats) -> float:
    """What vertices of a road lie off by at most, m."""
    count = 0
    for i in range(x.size):
        if abs(x[i]) <= _DRIVEN_M and not math.isnan(off[i]):
            driven[count] = off[i]
            count += 1
    usual = float(np.median(driven[:count])) if count else 0.0
    return max(_ROUGHER * usual, _LEAST_M)


def warm_up() -> None:
    """Compile the kernel."""
    across = np.linspace(-1.0, 1.0, 9)
    verges_kernel(across, np.zeros(9), np.array([0, 9]), np.empty((1, 2, 4), np.float32))
