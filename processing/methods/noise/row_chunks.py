"""A drive taken a chunk of rows at a time, with what lies a few metres before and behind.

The stretches are part of the method: neither the memory of a computer nor who asks changes them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

POINTS = 1_000_000
"""Points of a chunk: enough that what hangs together is whole, few enough for all cores."""

OVERLAP_M = 6.0
"""What a chunk sees beyond its own rows, along the vehicle's path: of the points near the cuts of a
street two in a thousand are then judged otherwise than in one piece."""


@dataclass(frozen=True)
class RowChunk:
    """Rows that a stretch answers for, and those that it looks at."""

    rows: range
    with_overlap: range


def row_chunks_of(
    row_starts: NDArray[np.int64], along_m: NDArray[np.float64], points: int = POINTS
) -> Iterator[RowChunk]:
    """Stretches that own every row once.

    Parameters
    ----------
    row_starts : (rows + 1,) int64
    along_m : (rows,) float64
        How far the scanner had come at each row, m; not decreasing.
    points : int
        About how many points a stretch owns; with what it looks at it has at most twice as many,
        or a few rows.
    """
    rows = row_starts.size - 1
    first = 0
    while first < rows:
        wanted = int(np.searchsorted(row_starts, row_starts[first] + points, "right")) - 1
        end = min(rows, max(first + 1, wanted))
        before = int(np.searchsorted(along_m, along_m[first] - OVERLAP_M))
        behind = int(np.searchsorted(along_m, along_m[end - 1] + OVERLAP_M, "right"))
        least = int(np.searchsorted(row_starts, row_starts[first] - points // 2))
        most = int(np.searchsorted(row_starts, row_starts[end] + points // 2, "right")) - 1
        overlap = range(min(first, max(before, least)), max(end, min(behind, most, rows)))
        yield RowChunk(range(first, end), overlap)
        first = end
