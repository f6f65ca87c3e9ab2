"""How far apart the points of a cloud lie, region by region, when nothing tells the beams.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.noise.neighbours.morton import NestedCells

_REGION_LEVELS = 5
"""A region is 2 ** 5 = 32 spacings wide: it follows how points thin out with range."""

_WIDENINGS = 4
"""Times that a region with too few points is doubled before the whole cloud's spacing serves."""

_FEWEST = 40
"""Points of a region that tell a spacing."""

_PER_CELL = 2.0
"""Points in an occupied cube as wide as the spacing, on average: on a surface a cube that holds one
point holds its neighbour's share, too."""

_TOP = 20
"""Levels of nested cells that their numbers hold."""

_LEAST_GROWTH = 1 + 1e-9
"""Keeps the share between two levels finite where cubes hold no more than before."""


def local_spacings(cells: NestedCells) -> NDArray[np.float64]:
    """Distance between neighbouring points, as it is usual around each point.

    In a region, the spacing is the size of cubes that hold two points on average where they hold
    any. A region with too few points takes the spacing of the larger region that holds it.

    Returns
    -------
    (n,) float64
        m, along the cells' curve.
    """
    count = cells.codes.size
    if count < 2:
        return np.full(count, cells.cell_m)
    numbers = np.empty(count, np.int32)
    whole, _ = _begun_cubes(cells.codes, _TOP, 1, numbers)
    usual = float(_level_of_two(whole)[0])
    base = min(round(usual) + _REGION_LEVELS, _TOP)
    regions = int(whole[0, 1 + base :].sum())
    begun, opened = _begun_cubes(cells.codes, base, regions, numbers)
    found = np.full(regions, usual)
    for level in range(min(base + _WIDENINGS, _TOP), base - 1, -1):
        firsts = np.flatnonzero(opened >= level)
        together = np.add.reduceat(begun, firsts, axis=0)
        levels = _level_of_two(together)
        levels[together.sum(axis=1) < _FEWEST] = np.nan
        levels = np.repeat(levels, np.diff(np.r_[firsts, regions]))
        found = np.where(np.isfinite(levels), levels, found)
    spacings: NDArray[np.float64] = (cells.cell_m * 2.0**found)[numbers]
    return spacings


def _begun_cubes(
    codes: NDArray[np.int64], base: int, regions: int, numbers: NDArray[np.int32]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """What :func:`begun_kernel` finds; every point's region goes to ``numbers`` (n,)."""
    begun, opened = np.zeros((regions, _TOP + 2)), np.zeros(regions, np.int64)
    begun_kernel(codes, base, begun, opened, numbers)
    return begun, opened


def _level_of_two(begun: NDArray[np.float64]) -> NDArray[np.float64]:
    """(regions,) level, with fractions, at which an occupied cube holds two points on average.

    ``begun`` (regions, levels + 2) as from :func:`begun_kernel`.
    """
    sizes = begun.sum(axis=1)
    found = np.full(sizes.size, np.nan)
    before = np.ones(sizes.size)
    for level in range(_TOP):
        cubes = begun[:, 1 + level :].sum(axis=1)
        per_cube = sizes / np.maximum(cubes, 1)
        is_new = np.isnan(found) & (per_cube >= _PER_CELL)
        growth = np.log2(np.maximum(per_cube / before, _LEAST_GROWTH))
        missing = np.log2(_PER_CELL) - np.log2(before)
        found[is_new] = level - 1 + np.clip(missing / growth, 0, 1)[is_new]
        if not np.isnan(found).any():
            break
        before = per_cube
    return found


@kernel
def begun_kernel(
    codes: NDArray[np.int64],
    base: int,
    begun: NDArray[np.float64],
    opened: NDArray[np.int64],
    numbers: NDArray[np.int32],
) -> None:
    """Count, by region, the points along the curve with which cubes begin.

    ``begun`` (regions, levels + 2): points that share every cube with the one before, then those
    that begin a cube of level 0 and none above, and so on; the very first begins one of all
    levels. ``opened`` (regions,): the highest level begun by a region's first point; a region is a
    cube of level ``base``. ``numbers`` (n,): the region of each point.
    """
    top = begun.shape[1] - 2
    region, before = -1, 0
    for position in range(codes.size):
        differing, level = codes[position] ^ before, -1
        while differing > 0:
            differing >>= 3
            level += 1
        if position == 0:
            level = top
        before = codes[position]
        if level >= base:
            region += 1
            opened[region] = level
        begun[region, 1 + level] += 1
        numbers[position] = region


def warm_up() -> None:
    """Compile the kernel."""
    _begun_cubes(np.array([0, 8], np.int64), 1, 2, np.empty(2, np.int32))
