"""RecordingWriter: one scanner's points, from delivered chunks to the columns of a drive folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.errors import told_as_user_error
from processing.points.columns import ColumnWriter
from processing.project.lattice import Lattice, move_between

_ALWAYS = ("xyz", "time", "intensity", "return_number", "number_of_returns", "classification")
_WHERE_DELIVERED = ("color", "scan_angle_deg", "origin")


class RecordingWriter:
    """Appends the points of one scanner and keeps what must be known of them.

    Parameters
    ----------
    folder : Path
        Made here; becomes the drive's folder.
    lattice : Lattice
        Of the first file; others are moved to it.

    Attributes
    ----------
    is_in_time_order : bool
        Whether times never went back so far.
    lowest, highest : (3,) int64
        Extent in integers.
    points_of_source : dict of int to int
        Points by source file number.
    """

    def __init__(self, folder: Path, lattice: Lattice, scanner: int) -> None:
        with told_as_user_error(folder):
            folder.mkdir(parents=True)
        self.folder = folder
        self.lattice = lattice
        self.scanner = scanner
        self.is_in_time_order = True
        self.has_times = True
        self.lowest = np.full(3, np.iinfo(np.int64).max)
        self.highest = np.full(3, np.iinfo(np.int64).min)
        self.points_of_source: dict[int, int] = {}
        self._last_time = -np.inf
        self._names: tuple[str, ...] = ()
        self._writer = ColumnWriter(folder)

    @property
    def count(self) -> int:
        """Points so far."""
        return self._writer.count

    @property
    def names(self) -> tuple[str, ...]:
        """The columns written."""
        return self._names

    def takes(self, lattice: Lattice, chunk: Mapping[str, NDArray[Any]]) -> bool:
        """Whether points of this lattice and these columns can be added exactly."""
        move = move_between(lattice, self.lattice)
        if move is None or move.applied(_corners(chunk["xyz"])) is None:
            return False
        return not self._names or set(self._names) == {*_column_names(chunk), *_SOURCE}

    def add(
        self,
        chunk: Mapping[str, NDArray[Any]],
        lattice: Lattice,
        source: int,
        source_index: NDArray[np.int64],
    ) -> None:
        """Add points as delivered.

        Parameters
        ----------
        chunk : mapping
            Columns of :mod:`processing.formats.point_files`; ``xyz`` in integers of ``lattice``.
        source : int
            Number of the file.
        source_index : (n,) int64
            Index of each point in it.

        Raises
        ------
        NoSpace
        """
        move = move_between(lattice, self.lattice)
        moved = None if move is None else move.applied(chunk["xyz"])
        if moved is None:
            message = "points were added that this recording does not take"
            raise ValueError(message)
        count = moved.shape[0]
        if count == 0:
            return
        columns: dict[str, NDArray[Any]] = {name: chunk[name] for name in _column_names(chunk)}
        columns["xyz"] = moved
        columns["time"] = self._times(chunk, count)
        columns["source_index"] = source_index
        columns["source_file"] = np.full(count, source, dtype=np.uint16)
        self._names = tuple(columns)
        self._writer.append(columns)
        self.lowest = np.minimum(self.lowest, moved.min(axis=0))
        self.highest = np.maximum(self.highest, moved.max(axis=0))
        self.points_of_source[source] = self.points_of_source.get(source, 0) + count

    def close(self) -> None:
        """Close the files; may be called again."""
        self._writer.close()

    def _times(self, chunk: Mapping[str, NDArray[Any]], count: int) -> NDArray[np.float64]:
        """Times, with a lost one taken from the point before it; their order is watched."""
        if "time" not in chunk:
            self.has_times = False
            return np.full(count, np.nan)
        times = np.asarray(chunk["time"], dtype=np.float64)
        # A sum is not finite where any value is not: one quick pass in the usual case.
        if not np.isfinite(times.sum()):
            times = _filled(times, self._last_time)
            if np.isnan(times).any():
                self.has_times = False
                return times
        if self.is_in_time_order:
            in_order = times[0] >= self._last_time and bool((times[1:] >= times[:-1]).all())
            self.is_in_time_order = in_order
        self._last_time = float(times[-1])
        return times


_SOURCE = ("source_index", "source_file")


def _column_names(chunk: Mapping[str, NDArray[Any]]) -> tuple[str, ...]:
    return (*_ALWAYS, *(name for name in _WHERE_DELIVERED if name in chunk))


def _corners(integers: NDArray[np.int32]) -> NDArray[np.int32]:
    if integers.shape[0] == 0:
        return integers
    return np.stack([integers.min(axis=0), integers.max(axis=0)])


def _filled(times: NDArray[np.float64], before: float) -> NDArray[np.float64]:
    good = np.isfinite(times)
    if not good.any():
        return np.full_like(times, before if np.isfinite(before) else np.nan)
    last_good = np.maximum.accumulate(np.where(good, np.arange(times.size), -1))
    first_good = float(times[np.argmax(good)])
    start = before if np.isfinite(before) else first_good
    return np.where(last_good >= 0, times[np.maximum(last_good, 0)], start)
