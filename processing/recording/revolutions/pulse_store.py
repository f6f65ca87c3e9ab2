"""Where pulse numbers go as they are found: an array, or the column of a drive folder."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.ordering import read_chunk


class PulseStore(Protocol):
    """Takes pulses in the order of the points, then gives them back by stretches."""

    def append(self, pulses: NDArray[np.int64]) -> None:
        """Take the pulses of the next points."""

    def finish(self) -> None:
        """All pulses were appended."""

    def chunk(self, start: int, stop: int) -> NDArray[np.int64]:
        """The pulses of the points ``start … stop − 1``."""


class ArrayPulses:
    """Keeps the pulses of some points in memory."""

    def __init__(self, count: int) -> None:
        self.pulses = np.empty(count, dtype=np.int64)
        self._filled = 0

    def append(self, pulses: NDArray[np.int64]) -> None:
        """Take the pulses of the next points."""
        self.pulses[self._filled : self._filled + pulses.size] = pulses
        self._filled += pulses.size

    def finish(self) -> None:
        """All pulses were appended."""

    def chunk(self, start: int, stop: int) -> NDArray[np.int64]:
        """The pulses of the points ``start … stop − 1``: a view."""
        return self.pulses[start:stop]


class FolderPulses:
    """Writes pulses to the column ``pulse`` of a drive folder; closed at the end of a ``with``.

    A thread of its own writes, since that takes as long as finding the next ones.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._writer = ColumnWriter(folder)
        self._pool = ThreadPoolExecutor(max_workers=1)
        self._written: Future[None] | None = None

    def append(self, pulses: NDArray[np.int64]) -> None:
        """Take the pulses of the next points.

        Raises
        ------
        NoSpace
            The disk is full or refuses the write; of these or of the ones before.
        """
        if pulses.size:
            self._wait()
            self._written = self._pool.submit(self._writer.append, {"pulse": pulses})

    def finish(self) -> None:
        """All pulses were appended.

        Raises
        ------
        NoSpace
        """
        self._wait()
        self._writer.close()

    def chunk(self, start: int, stop: int) -> NDArray[np.int64]:
        """The pulses of the points ``start … stop − 1``, read into memory."""
        pulses: NDArray[np.int64] = read_chunk(self._folder, "pulse", start, stop)
        return pulses

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.shutdown()
        self._writer.close()

    def _wait(self) -> None:
        if self._written is not None:
            self._written.result()
            self._written = None
