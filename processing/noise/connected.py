"""How much hangs together: cubes that touch, joined."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel
from processing.noise.morton import nested_cells

_X = 0x1249249249249249


def connected_counts(
    xyz: NDArray[np.float64], is_counted: NDArray[np.bool_], cell_m: float
) -> NDArray[np.float64]:
    """How many counted points there are in the part of the cloud to which a point belongs.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    is_counted : (n,) bool
        Cubes join only through cubes that hold such points.
    cell_m : float
        Cubes that share a face, an edge or a corner belong together.

    Returns
    -------
    (n,) float64
        Of the part in a point's own cube or in the largest beside it; 0 where there is none.
    """
    cells = nested_cells(xyz, cell_m)
    if not cells.codes.size:
        return np.zeros(0)
    is_first = np.r_[True, cells.codes[1:] != cells.codes[:-1]]
    firsts = np.flatnonzero(is_first)
    counts = np.add.reduceat(is_counted[cells.order].astype(np.int64), firsts)
    codes = cells.codes[firsts]
    parents = np.arange(codes.size)
    join_kernel(codes, counts, parents)
    totals = np.bincount(parents, weights=counts, minlength=codes.size).astype(np.float64)
    found = np.zeros(codes.size)
    largest_kernel(codes, counts, totals[parents], found)
    result = np.empty(xyz.shape[0])
    result[cells.order] = found[np.cumsum(is_first) - 1]
    return result


@kernel
def join_kernel(
    codes: NDArray[np.int64], counts: NDArray[np.int64], parents: NDArray[np.int64]
) -> None:
    """Give every cube the number of the first cube of its part."""
    for cell in range(codes.size):
        if counts[cell] == 0:
            continue
        for side in range(27):
            other = _beside(codes, cell, side)
            if 0 <= other < cell and counts[other] > 0:
                a, b = _root(parents, cell), _root(parents, other)
                if a < b:
                    parents[b] = a
                else:
                    parents[a] = b
    for cell in range(codes.size):
        parents[cell] = _root(parents, cell)


@kernel
def largest_kernel(
    codes: NDArray[np.int64],
    counts: NDArray[np.int64],
    totals: NDArray[np.float64],
    found: NDArray[np.float64],
) -> None:
    """Each cube's part, or the largest part beside it where the cube counts nothing."""
    for cell in range(codes.size):
        found[cell] = totals[cell] if counts[cell] > 0 else 0.0
        if counts[cell] > 0:
            continue
        for side in range(27):
            other = _beside(codes, cell, side)
            if other >= 0 and counts[other] > 0:
                found[cell] = max(found[cell], totals[other])


@kernel
def _root(parents: NDArray[np.int64], cell: int) -> int:
    while parents[cell] != cell:
        parents[cell] = parents[parents[cell]]
        cell = parents[cell]
    return cell


@kernel
def _beside(codes: NDArray[np.int64], cell: int, side: int) -> int:
    """The cube beside one, or −1."""
    code = 0
    for axis in range(3):
        mask = _X << axis
        value = codes[cell] & mask
        step = side % 3 - 1
        side //= 3
        if step < 0:
            if value == 0:
                return -1
            value = (value - (1 << axis)) & mask
        elif step > 0:
            value = ((value | ~mask) + (1 << axis)) & mask
        code |= value
    place = int(np.searchsorted(codes, code))
    return place if place < codes.size and codes[place] == code else -1


def warm_up() -> None:
    """Compile the kernels."""
    connected_counts(np.eye(3), np.ones(3, np.bool_), 1.0)
