"""Where in the delivered files the points of a recording were.

Most recordings keep the order of their files, so a few runs of consecutive points say it all; two
columns are written only where scanners were interleaved or an order was restored.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.recording.columns.columns import Columns, column_path

FILE, INDEX = "source_file", "source_index"

_MOST_POINTS = 1 << 40
"""No file has as many."""


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
    columns: Columns, runs: tuple[SourceRun, ...], start: int, stop: int, *, sources: int
) -> tuple[NDArray[np.uint16], NDArray[np.int64]]:
    """File numbers and indices of the points ``start … stop − 1`` of a recording.

    Parameters
    ----------
    sources : int
        How many files it was delivered in.

    Returns
    -------
    files : (n,) uint16
    indices : (n,) int64

    Raises
    ------
    BadFile
        As :func:`check_sources`.
    """
    if not runs:
        files, indices = columns[FILE][start:stop], columns[INDEX][start:stop]
        check_sources(columns.folder, files, indices, sources)
        return files, indices
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


def check_sources(
    folder: Path, files: NDArray[np.uint16], indices: NDArray[np.int64], sources: int
) -> None:
    """Refuse places in delivered files that no file has.

    Parameters
    ----------
    folder : Path
        The recording's.
    files, indices : (n,)
    sources : int
        How many files it was delivered in.

    Raises
    ------
    BadFile
        Names the column.
    """
    if files.size and int(files.max()) >= sources:
        raise damaged_sources(folder, FILE)
    if indices.size and not (indices.min() >= 0 and indices.max() < _MOST_POINTS):
        raise damaged_sources(folder, INDEX)


def damaged_sources(folder: Path, name: str = INDEX) -> BadFile:
    """The error for a column that names places which the delivered files don't have."""
    return BadFile(
        Text(
            "The column that says where points were delivered is damaged.",
            "点の納品ファイル内の位置を示す列データが壊れています。",
        ),
        Text.same(str(column_path(folder, name))),
        Text(
            "Import the drive again from the delivered files.",
            "納品ファイルから走行データを再インポートしてください。",
        ),
    )


def _start_of(run: SourceRun) -> int:
    return run.start
