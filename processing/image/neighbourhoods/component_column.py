"""Components of blocks, numbered as those of the whole recording, in a file as long as it.

What stays in memory is the last block's numbers and the few pairs of numbers that turned out to be
one component: two arms that only a later block joins. The size of the recording doesn't matter.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.errors import OutOfRange, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.neighbourhoods.segment_kernels import (
    renumber_kernel,
    roots_kernel,
    unite_kernel,
)
from processing.recording.columns.columns import ColumnWriter, column_path

_POINTS_AT_ONCE = 2_000_000
_MOST = int(np.iinfo(np.int32).max)


class ComponentColumn:
    """The column of components, written while blocks come.

    Parameters
    ----------
    folder : Path
        Where the column is written.
    name : str

    Notes
    -----
    1. A component gets its number in the block where its first point lies, so numbers rise with
       first points. In the next block it is known by the points that both blocks have.
    2. Where such a component touches several numbers they are one: the pairs are kept.
    3. At the end the higher number of each pair becomes the lower one, and numbers above close up,
       in a second pass over the file; there is none where nothing was paired.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self._path = column_path(folder, name)
        self._name = name
        self._writer = ColumnWriter(folder)
        self._last: Integers = np.empty(0, np.int64)
        self._known_end = 0
        self._used = 0
        self._pairs: list[Integers] = []

    def add(self, labels: NDArray[np.int32], first: int, end: int) -> None:
        """Take in the labels of the points ``first … end − 1``, which begin in the last block.

        Parameters
        ----------
        labels : (end − first,) int32
            Numbered by the components' first points.

        Raises
        ------
        NoSpace
        OutOfRange
            There are more components than numbers.
        """
        known = max(0, min(self._known_end, end) - first)
        earlier = self._last[self._last.size - known :]
        old = self._numbers_of(labels[:known], earlier)
        new = int(labels.max(initial=-1)) + 1 - old.size
        if self._used + new > _MOST:
            raise _too_many()
        table = np.concatenate([old, np.arange(self._used, self._used + new)])
        numbers = table[labels]
        self._used += new
        self._last = numbers
        self._known_end = first + labels.size
        self._writer.append({self._name: numbers[known:]})

    def finish(self, monitor: Monitor) -> None:
        """Make the numbers those of the whole recording.

        Raises
        ------
        NoSpace, Cancelled
        """
        self._writer.append({self._name: np.empty(0, np.int32)})
        self.close()
        if not self._pairs:
            return
        gone, ranks = _unite_numbers(np.concatenate(self._pairs, axis=1))
        with report_as_user_error(self._path), self._path.open("r+b") as file:
            start = 0
            while data := file.read(4 * _POINTS_AT_ONCE):
                monitor.check()
                numbers = np.frombuffer(data, np.int32).copy()
                renumber_kernel(numbers, gone, ranks)
                file.seek(start)
                file.write(numbers.data)
                start += len(data)

    def close(self) -> None:
        """Close the file; may be called again."""
        self._writer.close()

    def _numbers_of(self, labels: NDArray[np.int32], earlier: Integers) -> Integers:
        """The number of each label that points of the last block have; notes what is one."""
        count = int(labels.max(initial=-1)) + 1
        numbers = np.full(count, np.iinfo(np.int64).max)
        np.minimum.at(numbers, labels, earlier)
        lower = numbers[labels]
        differ = lower != earlier
        if differ.any():
            pairs = np.stack([lower[differ], earlier[differ]])
            self._pairs.append(np.unique(pairs, axis=1))
        return numbers


def _unite_numbers(pairs: Integers) -> tuple[Integers, Integers]:
    """Numbers that give way, rising, and the final number of each."""
    numbers, positions = np.unique(pairs, return_inverse=True)
    positions = positions.reshape(pairs.shape)
    parents = np.arange(numbers.size, dtype=np.int64)
    unite_kernel(parents, np.ascontiguousarray(positions[0]), np.ascontiguousarray(positions[1]))
    roots_kernel(parents)
    gives_way = parents != np.arange(parents.size)
    gone = numbers[gives_way]
    roots = numbers[parents[gives_way]]
    return gone, roots - np.searchsorted(gone, roots)


def _too_many() -> OutOfRange:
    return OutOfRange(
        Text(
            "The recording falls into more segments than can be numbered.",
            "セグメントの数が多すぎて番号を付けられません。",
        ),
        Text.same(f"{_MOST:,}"),
        Text(
            "Use a larger joining distance or a larger bend.",
            "結合距離か最大屈曲角を大きくしてください。",
        ),
    )
