"""SourceOrder: where in the delivered files the points of a recording were.

Most recordings keep the order of their files, so a few runs of consecutive points say it all; two
columns are written only where scanners were interleaved or an order was restored.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.points.columns import Columns, ColumnWriter

_MOST_RUNS = 1_000
_STRETCH = 4_000_000
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


class SourceOrder:
    """Notes the origin of points while they are written.

    Parameters
    ----------
    folder : Path
        The drive's folder, for the columns.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._runs: list[SourceRun] = []
        self._count = 0
        self._writer: ColumnWriter | None = None

    @property
    def runs(self) -> tuple[SourceRun, ...]:
        """The runs; empty where columns say it."""
        return () if self._writer is not None else tuple(self._runs)

    @property
    def column_names(self) -> tuple[str, ...]:
        """The columns written for it, if any."""
        return () if self._writer is None else (FILE, INDEX)

    def append(self, source: int, indices: NDArray[np.int64]) -> None:
        """Note the next points of the recording.

        Parameters
        ----------
        indices : (n,) int64
            Their indices in the file, rising.
        """
        first, last = int(indices[0]), int(indices[-1])
        is_run = last - first == indices.size - 1
        if self._writer is None and not (is_run and len(self._runs) < _MOST_RUNS):
            self.write_columns()
        if self._writer is not None:
            self._writer.append(_columns_of(source, indices))
        elif self._continues(source, first):
            run = self._runs[-1]
            grown = SourceRun(run.start, run.count + indices.size, source, run.first_index)
            self._runs[-1] = grown
        else:
            self._runs.append(SourceRun(self._count, indices.size, source, first))
        self._count += indices.size

    def write_columns(self) -> None:
        """Write columns from now on, and what the runs said before."""
        if self._writer is not None:
            return
        self._writer = ColumnWriter(self._folder)
        for run in self._runs:
            for start in range(0, run.count, _STRETCH):
                first = run.first_index + start
                stop = run.first_index + min(start + _STRETCH, run.count)
                self._writer.append(_columns_of(run.source, np.arange(first, stop)))

    def close(self) -> None:
        """Close the columns; may be called again."""
        if self._writer is not None:
            self._writer.close()

    def _continues(self, source: int, first: int) -> bool:
        if not self._runs:
            return False
        run = self._runs[-1]
        return run.source == source and run.first_index + run.count == first


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
    for run in runs:
        low, high = max(start, run.start), min(stop, run.start + run.count)
        if low < high:
            files[low - start : high - start] = run.source
            first = run.first_index + low - run.start
            indices[low - start : high - start] = np.arange(first, first + high - low)
    return files, indices


def _columns_of(source: int, indices: NDArray[np.int64]) -> dict[str, NDArray[np.generic]]:
    return {FILE: np.full(indices.size, source, np.uint16), INDEX: indices}
