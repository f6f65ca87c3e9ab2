"""Feet of things: the parts of cells in which what stands holds its share of the points."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cells import CellGrid

SIDE_PARTS = 4
"""A cell is looked at in four by four parts, as many as a 16-bit number has bits: with the finest
cells, of 0.2 m, parts of 5 cm, about as wide as a post."""

_PARTS = SIDE_PARTS * SIDE_PARTS

_BAND_PER_FOOT = 5
"""Points of the band for each point over a part, up to which that part is a foot. By trial, on
sites with thousands of points in a cell, where each part had a stray over it: a foot hides the
ground below it from the scanner, dense ground with a stray does not."""


class _FootCells(NamedTuple):
    """For each cell: its row among those with feet or −1, and what the band and a foot reach, m."""

    rows: NDArray[np.int32]
    thick: NDArray[np.float32]
    top: NDArray[np.float32]


def attached_feet(
    offsets: Iterable[tuple[NDArray[np.float64], NDArray[np.float64]]],
    grid: CellGrid,
    thick: NDArray[np.float32],
    top: NDArray[np.float32],
    feet: NDArray[np.uint16],
) -> NDArray[np.uint16]:
    """Of the parts over which any point stands, those where such points are no few strays.

    Parameters
    ----------
    offsets : iterable of ((n, 3) float64, (n,) float64)
        Points, m, and how far each lies above the ground, block by block.
    thick, top : (rows, columns) float32
        The ground's band, m, and how far above the ground a foot is looked for.
    feet : (rows, columns) uint16
        Bit ``4 r + c`` is set where a point stands on that sixteenth of a cell.

    Notes
    -----
    Ground under a foot isn't seen: the band holds few points there. A part whose band holds more
    than five times as many is ground with a stray above it, as every part of dense ground has.
    """
    stood = feet > 0
    rows = np.full(feet.shape, -1, np.int32)
    rows[stood] = np.arange(np.count_nonzero(stood), dtype=np.int32)
    excess = np.zeros((int(np.count_nonzero(stood)), _PARTS), np.int32)
    cells = _FootCells(rows, thick, top)
    for xyz, above in offsets:
        _excess_kernel(np.ascontiguousarray(xyz), above, grid.origin, grid.size_m, cells, excess)
    bits = np.left_shift(np.uint16(1), np.arange(_PARTS, dtype=np.uint16))
    held = np.zeros_like(feet)
    held[stood] = np.where(excess >= 0, bits, np.uint16(0)).sum(axis=1).astype(np.uint16)
    return feet & held


@kernel
def _excess_kernel(
    xyz: NDArray[np.float64],
    above: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    cells: _FootCells,
    excess: NDArray[np.int32],
) -> None:
    """Points over each part's foot, five times each, less those in the band."""
    thick, top = cells.thick, cells.top
    for point in range(xyz.shape[0]):
        offset = above[point]
        if not np.isfinite(offset):
            continue
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        row, column = int(y), int(x)
        own = cells.rows[row, column]
        if own < 0:
            continue
        part = int(SIDE_PARTS * (y - row)) * SIDE_PARTS + int(SIDE_PARTS * (x - column))
        if thick[row, column] < offset < top[row, column]:
            excess[own, part] += _BAND_PER_FOOT
        elif abs(offset) <= thick[row, column]:
            excess[own, part] -= 1


def warm_up() -> None:
    """Compile the kernel of this file."""
    grid = CellGrid(np.zeros(3), 1.0, 1, 1)
    one = np.ones((1, 1), np.float32)
    xyz = np.array([[0.5, 0.5, 1.5]])
    attached_feet([(xyz, xyz[:, 2])], grid, one, 2 * one, np.ones((1, 1), np.uint16))
