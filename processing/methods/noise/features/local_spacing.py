"""How far apart the points of a cloud lie, region by region, when nothing tells the beams.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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
    whole = _level_of_two(cells.codes, np.zeros(count, np.int64), 1)[0]
    base = min(round(float(whole)) + _REGION_LEVELS, _TOP)
    found = np.full(count, whole)
    for level in range(min(base + _WIDENINGS, _TOP), base - 1, -1):
        regions = cells.codes >> (3 * level)
        numbers = np.cumsum(np.r_[False, regions[1:] != regions[:-1]])
        sizes = np.bincount(numbers)
        levels = _level_of_two(cells.codes, numbers, sizes.size)
        is_known = (sizes >= _FEWEST) & np.isfinite(levels)
        found = np.where(is_known[numbers], levels[numbers], found)
    spacings: NDArray[np.float64] = cells.cell_m * 2.0**found
    return spacings


def _level_of_two(
    codes: NDArray[np.int64], numbers: NDArray[np.int64], regions: int
) -> NDArray[np.float64]:
    """(regions,) level, with fractions, at which an occupied cube holds two points on average."""
    sizes = np.bincount(numbers, minlength=regions).astype(np.float64)
    found = np.full(regions, np.nan)
    before = np.ones(regions)
    for level in range(_TOP):
        part = codes >> (3 * level)
        is_first = np.r_[True, part[1:] != part[:-1]]
        cubes = np.bincount(numbers[is_first], minlength=regions)
        per_cube = sizes / np.maximum(cubes, 1)
        is_new = np.isnan(found) & (per_cube >= _PER_CELL)
        growth = np.log2(np.maximum(per_cube / before, _LEAST_GROWTH))
        missing = np.log2(_PER_CELL) - np.log2(before)
        found[is_new] = level - 1 + np.clip(missing / growth, 0, 1)[is_new]
        if not np.isnan(found).any():
            break
        before = per_cube
    return found
