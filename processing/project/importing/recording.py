"""Recording: one scanner's points in a folder that becomes a drive's, and what is known of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.project.importing.file_record import NO_HIGHEST, NO_LOWEST, Stream
from processing.project.importing.file_recorder import write_indices
from processing.project.importing.quantisation import shift_between
from processing.recording.columns.offset_columns import OffsetColumnWriter
from processing.recording.columns.quantisation import Quantisation
from processing.recording.columns.source_order import FILE, INDEX, SourceRun

_MOST_RUNS = 10_000
_STRETCH = 2_000_000


@dataclass(frozen=True)
class RecordingPart:
    """The points of a recording from one file.

    Attributes
    ----------
    source : int
        Number of the file.
    at : int
        Number of the stream in it.
    """

    source: int
    at: int
    stream: Stream


@dataclass
class Recording:
    """The points of one scanner, from one file or several that follow one another.

    Attributes
    ----------
    folder : Path
        Of the columns.
    delivered_names : tuple of str
        The columns that came with the points.
    parts : list of RecordingPart
        In the order of the recording.
    has_source_columns : bool
        Whether columns say where each point was delivered.
    """

    folder: Path
    quantisation: Quantisation
    scanner: int
    delivered_names: tuple[str, ...]
    parts: list[RecordingPart] = field(default_factory=list)
    has_source_columns: bool = False

    @property
    def count(self) -> int:
        """Number of points."""
        return sum(part.stream.count for part in self.parts)

    @property
    def names(self) -> tuple[str, ...]:
        """The columns in the folder."""
        own = (FILE, INDEX) if self.has_source_columns else ()
        return (*self.delivered_names, *own)

    @property
    def has_times(self) -> bool:
        """Whether every point has a time."""
        return all(part.stream.has_times for part in self.parts)

    @property
    def times_differ(self) -> bool:
        """Whether the points have times, and not one for all, which is a filler."""
        streams = [part.stream for part in self.parts]
        first, last = streams[0].first_time, streams[-1].last_time
        return self.has_times and not (self.is_in_time_order and first == last)

    @property
    def is_in_time_order(self) -> bool:
        """Whether times never go back."""
        streams = [part.stream for part in self.parts]
        follows = all(before.last_time <= after.first_time for before, after in pairwise(streams))
        return follows and all(stream.is_in_time_order for stream in streams)

    @property
    def lowest(self) -> NDArray[np.int64]:
        """(3,) lowest integers."""
        lowest = [NO_LOWEST, *(part.stream.lowest for part in self.parts)]
        return np.asarray(np.array(lowest).min(axis=0))

    @property
    def highest(self) -> NDArray[np.int64]:
        """(3,) highest integers."""
        highest = [NO_HIGHEST, *(part.stream.highest for part in self.parts)]
        return np.asarray(np.array(highest).max(axis=0))

    @property
    def points_of_source(self) -> dict[int, int]:
        """Points by number of the file."""
        points: dict[int, int] = {}
        for part in self.parts:
            points[part.source] = points.get(part.source, 0) + part.stream.count
        return points

    @property
    def sources(self) -> tuple[int, ...]:
        """Numbers of its files; the drive counts them from 0 in this order."""
        return tuple(sorted(number for number, points in self.points_of_source.items() if points))

    @property
    def source_runs(self) -> tuple[SourceRun, ...]:
        """Where the points were delivered; empty where columns say it."""
        if self.has_source_columns:
            return ()
        own = {number: position for position, number in enumerate(self.sources)}
        runs, first = [], 0
        for part in self.parts:
            file = own.get(part.source, 0)
            runs += [SourceRun(first + at, n, file, index) for at, n, index in part.stream.runs]
            first += part.stream.count
        return tuple(runs)

    @property
    def needs_source_columns(self) -> bool:
        """Whether runs can't say where the points were delivered."""
        streams = [part.stream for part in self.parts]
        runs = sum(len(stream.runs) for stream in streams)
        return runs > _MOST_RUNS or any(stream.is_indexed for stream in streams)

    def write_source_columns(self) -> None:
        """Write where each point was delivered, before the order is changed; may be repeated.

        Raises
        ------
        NoSpace
        """
        own = {number: position for position, number in enumerate(self.sources)}
        first = 0
        for part in self.parts:
            stream = part.stream
            columns = OffsetColumnWriter(self.folder, first)
            try:
                for start in range(0, stream.count, _STRETCH):
                    size = min(_STRETCH, stream.count - start)
                    columns.write(start, {FILE: np.full(size, own[part.source], np.uint16)})
                write_indices(columns, stream)
            finally:
                columns.close()
            first += stream.count
        self.has_source_columns = True

    def takes(self, quantisation: Quantisation, stream: Stream) -> bool:
        """Whether points of this lattice can be added exactly."""
        if (stream.scanner, stream.names) != (self.scanner, self.delivered_names):
            return False
        if quantisation == self.quantisation:
            return True
        move = shift_between(quantisation, self.quantisation)
        corners = np.array([stream.lowest, stream.highest], dtype=np.int32)
        return move is not None and move.applied(corners) is not None
