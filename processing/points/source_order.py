"""Where in the delivered files the points of a recording were.

Most recordings keep the order of their files, so a few runs of consecutive points say it all; two
columns are written only where scanners were interleaved or an order was restored.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.points.columns import Columns

FILE, INDEX = "source_file", "source_index"


@dataclass(frozen=True)
class SourceRun:
    """Consecutive points that were consecutive in one file.

    Attributes
    ----------
    start : int
        First point of the recording.
    count : int
    source : int
        Number of the file.
    first_index : int
        The first point's index in it.
    """

    start: int
    count: int
    source: int
    first_index: int


def sources_of(
    columns: Columns, runs: tuple[SourceRun, ...], start: int, stop: int
) -> tuple[NDArray[np.uint16], NDArray[np.int64]]:
    """File numbers and indices of the points ``start … stop − 1`` of a recording.

    Returns
    -------
    files : (n,) uint16
    indices : (n,) int64
    """
    if not runs:
        return columns[FILE][start:stop], columns[INDEX][start:stop]
    files = np.empty(stop - start, np.uint16)
    indices = np.empty(stop - start, np.int64)
    first_run = bisect_right(runs, start, key=_start_of) - 1
    for run in runs[max(first_run, 0) : bisect_left(runs, stop, key=_start_of)]:
        low, high = max(start, run.start), min(stop, run.start + run.count)
        if low < high:
            files[low - start : high - start] = run.source
            first = run.first_index + low - run.start
            indices[low - start : high - start] = np.arange(first, first + high - low)
    return files, indices


def _start_of(run: SourceRun) -> int:
    return run.start
