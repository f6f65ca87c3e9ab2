"""The points of drives that were recorded together, a chunk at a time, without their noise."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.labels.label_column import LABEL
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive

NOISE_CODES = (7, 18)
"""Low and high noise, as LAS 1.4 numbers classes (table 9 and 17 of its specification)."""
_CLASS = "classification"

_CHUNK_POINTS = 1 << 17
"""Points read at a time, at most: 3 MiB of coordinates, so that the search for points of a tile
leaves most of a long drive unread."""

_LEAST_POINTS = 1000
"""Points read at a time, at least: fewer cost more to ask for than to read."""

_EXTENT_MARGIN_M = 1e-6
"""Widens extents by more than coordinates round off when scale and offset are applied."""

ChunkT = TypeVar("ChunkT")
ReadT = TypeVar("ReadT")


@dataclass(frozen=True)
class Chunk:
    """Points ``start … stop − 1`` of a drive.

    Attributes
    ----------
    drive : int
        Number among the drives.
    low, high : (2,) float64
        Extent in plan, m.
    has_noise : bool
    first : int
        Number of its first point among the points of all drives.
    """

    drive: int
    start: int
    stop: int
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    has_noise: bool
    first: int


class _Span(NamedTuple):
    """Points ``start … stop − 1`` of a drive, the first of them number ``first`` among all."""

    drive: int
    start: int
    stop: int
    first: int


class DrivePoints:
    """Points of several drives as one cloud.

    Parameters
    ----------
    drives : tuple of Drive
    at_once : int
        What is held in memory at a time, as far as that is between a thousand and some 100,000.
    monitor : Monitor
        All points are gone through once; it is asked between chunks later on too.
    echoes : sequence of ((n,) bool or None), optional
        Points of each drive that are noise whatever their class says.

    Attributes
    ----------
    chunks : tuple of Chunk
        Every point is in exactly one.
    count : int
    """

    def __init__(
        self,
        drives: tuple[Drive, ...],
        at_once: int,
        monitor: Monitor,
        echoes: Sequence[NDArray[np.bool_] | None] = (),
    ) -> None:
        self.drives = drives
        self._echoes = tuple(echoes) or (None,) * len(drives)
        self._monitor = monitor
        size = int(np.clip(at_once, _LEAST_POINTS, _CHUNK_POINTS))
        self.count = sum(drive.count for drive in drives)
        firsts = np.cumsum([0, *(drive.count for drive in drives)]).tolist()
        spans = [
            _Span(number, start, min(start + size, drive.count), firsts[number] + start)
            for number, drive in enumerate(drives)
            for start in range(0, drive.count, size)
        ]
        chunks: list[Chunk] = []
        for chunk in read_ahead(self._measure, spans):
            monitor.check()
            chunks.append(chunk)
        self.chunks = tuple(chunks)
        self._lows = np.array([chunk.low for chunk in chunks]).reshape(-1, 2)
        self._highs = np.array([chunk.high for chunk in chunks]).reshape(-1, 2)

    def chunks_in(self, low: NDArray[np.float64], high: NDArray[np.float64]) -> tuple[Chunk, ...]:
        """Chunks that may have points in a rectangle, m."""
        meets = np.all((self._lows <= high) & (self._highs >= low), axis=1)
        return tuple(self.chunks[number] for number in np.flatnonzero(meets))

    def blocks(self, chunks: tuple[Chunk, ...] | None = None) -> Iterator[NDArray[np.float64]]:
        """Coordinates, (n, 3) float64, m, chunk by chunk; rows of noise are NaN."""
        for xyz in read_ahead(self.xyz, self.chunks if chunks is None else chunks):
            self._monitor.check()
            yield xyz

    def xyz(self, chunk: Chunk) -> NDArray[np.float64]:
        """Coordinates of a chunk's points, (n, 3) float64, m; rows of noise are NaN."""
        xyz = self.measured_xyz(chunk)
        if chunk.has_noise:
            xyz[np.isin(self.codes(chunk), NOISE_CODES)] = np.nan
        if self._echoes[chunk.drive] is not None:
            xyz[self.is_echo(chunk)] = np.nan
        return xyz

    def is_echo(self, chunk: Chunk) -> NDArray[np.bool_]:
        """Which of a chunk's points are noise whatever their class says: (n,) bool."""
        echoes = self._echoes[chunk.drive]
        if echoes is None:
            return np.zeros(chunk.stop - chunk.start, np.bool_)
        return echoes[chunk.start : chunk.stop]

    def measured_xyz(self, chunk: Chunk) -> NDArray[np.float64]:
        """Coordinates of a chunk's points, (n, 3) float64, m; noise too."""
        drive = self.drives[chunk.drive]
        return drive.coordinates.chunk_xyz(chunk.start, chunk.stop)

    def codes(self, chunk: Chunk) -> NDArray[np.uint8]:
        """The class of each point now: its label, or the delivered one; (n,) uint8."""
        return classes_now(self.drives[chunk.drive], chunk.start, chunk.stop)

    def _measure(self, span: _Span) -> Chunk:
        """A chunk with its extent and whether it holds noise."""
        drive, start, stop = self.drives[span.drive], span.start, span.stop
        integers = drive.coordinates.chunk(start, stop)
        ends = np.array([[part.min(), part.max()] for part in integers.T])
        low, high = drive.coordinates.quantisation.metres(ends.T)[:, :2]
        codes = classes_now(drive, start, stop)
        has_noise = bool(np.isin(codes, NOISE_CODES).any())
        low, high = low - _EXTENT_MARGIN_M, high + _EXTENT_MARGIN_M
        return Chunk(span.drive, start, stop, low, high, has_noise, span.first)


def classes_now(drive: Drive, start: int, stop: int) -> NDArray[np.uint8]:
    """Labels where points have one, delivered classes elsewhere: (n,) uint8."""
    codes = np.zeros(stop - start, np.uint8)
    if drive.columns.has(_CLASS):
        codes = read_chunk(drive.folder, _CLASS, start, stop)
    if drive.columns.has(LABEL):
        labels = np.asarray(drive.columns[LABEL])[start:stop]
        codes = np.where(labels > 0, labels, codes)
    return codes


def read_ahead(read: Callable[[ChunkT], ReadT], chunks: Iterable[ChunkT]) -> Iterator[ReadT]:
    """What ``read`` gives for each chunk, the next one read while the last is worked on."""
    with ThreadPoolExecutor(max_workers=1) as pool:
        coming = None
        for chunk in chunks:
            following = pool.submit(read, chunk)
            if coming is not None:
                yield coming.result()
            coming = following
        if coming is not None:
            yield coming.result()
