"""Medians of many values by cell, without sorting all of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel


def cell_medians(
    cells: NDArray[np.int32], values: NDArray[np.float32], count: int
) -> NDArray[np.float32]:
    """The median of each cell's values: (count,) float32; NaN in a cell without any.

    Parameters
    ----------
    cells : (n,) int32
        Cell of each value, 0 to ``count`` − 1.
    values : (n,) float32
        Finite.
    """
    starts = np.zeros(count + 1, np.int64)
    _count_kernel(cells, starts[1:])
    np.cumsum(starts, out=starts)
    gathered = np.empty(len(values), np.float32)
    _gather_kernel(cells, values, starts[:-1].copy(), gathered)
    medians = np.full(count, np.nan, np.float32)
    _median_kernel(gathered, starts, medians)
    return medians


@kernel
def _count_kernel(cells: NDArray[np.int32], counts: NDArray[np.int64]) -> None:
    for number in range(cells.shape[0]):
        counts[cells[number]] += 1


@kernel
def _gather_kernel(
    cells: NDArray[np.int32],
    values: NDArray[np.float32],
    next_of_cell: NDArray[np.int64],
    gathered: NDArray[np.float32],
) -> None:
    for number in range(cells.shape[0]):
        cell = cells[number]
        gathered[next_of_cell[cell]] = values[number]
        next_of_cell[cell] += 1


@kernel
def _median_kernel(
    gathered: NDArray[np.float32], starts: NDArray[np.int64], medians: NDArray[np.float32]
) -> None:
    for cell in range(medians.shape[0]):
        start, stop = starts[cell], starts[cell + 1]
        if stop > start:
            ordered = np.sort(gathered[start:stop])
            middle = (stop - start) // 2
            low = ordered[middle - 1] if (stop - start) % 2 == 0 else ordered[middle]
            medians[cell] = 0.5 * (low + ordered[middle])


def warm_up() -> None:
    """Compile the kernels of this file."""
    cell_medians(np.array([0, 1, 1], np.int32), np.array([1.0, 2.0, 3.0], np.float32), 3)
