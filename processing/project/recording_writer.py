"""RecordingWriter: one scanner's points, from delivered chunks to the columns of a drive folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.errors import told_as_user_error
from processing.kernels import kernel
from processing.points.columns import ColumnWriter
from processing.points.source_order import SourceOrder
from processing.project.lattice import Lattice, move_between

_ALWAYS = ("xyz", "time", "intensity", "return_number", "number_of_returns", "classification")
_WHERE_DELIVERED = ("color", "origin", "label", "grid")
_ANGLE = "scan_angle_deg"


class RecordingWriter:
    """Appends the points of one scanner and keeps what must be known of them.

    Parameters
    ----------
    folder : Path
        Made here; becomes the drive's folder.
    lattice : Lattice
        Of the first file; others are moved to it.
    keeps_angles : bool
        Whether scan angles are wanted: they tell the turns where there is no trajectory.

    Attributes
    ----------
    is_in_time_order : bool
        Whether times never went back so far.
    lowest, highest : (3,) int64
        Extent in integers.
    points_of_source : dict of int to int
        Points by source file number.
    sources : SourceOrder
        Where in the delivered files each point was.
    """

    def __init__(
        self, folder: Path, lattice: Lattice, scanner: int, *, keeps_angles: bool = True
    ) -> None:
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
        self.sources = SourceOrder(folder)
        self._optional = (*_WHERE_DELIVERED, *((_ANGLE,) if keeps_angles else ()))
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
        return (*self._names, *self.sources.column_names)

    def takes(self, lattice: Lattice, chunk: Mapping[str, NDArray[Any]]) -> bool:
        """Whether points of this lattice and these columns can be added exactly."""
        if lattice != self.lattice:
            move = move_between(lattice, self.lattice)
            if move is None or move.applied(_corners(chunk["xyz"])) is None:
                return False
        return not self._names or set(self._names) == set(self._column_names(chunk))

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
        moved: NDArray[np.int32] | None = chunk["xyz"]
        if lattice != self.lattice:
            move = move_between(lattice, self.lattice)
            moved = None if move is None else move.applied(chunk["xyz"])
        if moved is None:
            message = "points were added that this recording does not take"
            raise ValueError(message)
        count = moved.shape[0]
        if count == 0:
            return
        names = self._column_names(chunk)
        columns: dict[str, NDArray[Any]] = {name: chunk[name] for name in names if name in chunk}
        columns["xyz"] = moved
        columns["time"] = self._times(chunk, count)
        self._names = tuple(columns)
        self._writer.append(columns)
        self.sources.append(source, source_index)
        _widen_kernel(moved, self.lowest, self.highest)
        self.points_of_source[source] = self.points_of_source.get(source, 0) + count

    def close(self) -> None:
        """Close the files; may be called again."""
        self._writer.close()
        self.sources.close()

    def write_source_columns(self) -> None:
        """Write the points' origin as columns, before their order is changed."""
        self.sources.write_columns()
        self.sources.close()

    def _column_names(self, chunk: Mapping[str, NDArray[Any]]) -> tuple[str, ...]:
        return (*_ALWAYS, *(name for name in self._optional if name in chunk))

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
            self.is_in_time_order = bool(_rises_kernel(times, self._last_time))
        self._last_time = float(times[-1])
        return times


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


def warm_up() -> None:
    """Compile the kernels."""
    _widen_kernel(np.zeros((1, 3), np.int32), np.zeros(3, np.int64), np.zeros(3, np.int64))
    _rises_kernel(np.zeros(1), 0.0)


@kernel
def _widen_kernel(
    integers: NDArray[np.int32], lowest: NDArray[np.int64], highest: NDArray[np.int64]
) -> None:
    low_x, low_y, low_z = integers[0]
    high_x, high_y, high_z = integers[0]
    for point in range(1, integers.shape[0]):
        x, y, z = integers[point, 0], integers[point, 1], integers[point, 2]
        low_x, high_x = min(low_x, x), max(high_x, x)
        low_y, high_y = min(low_y, y), max(high_y, y)
        low_z, high_z = min(low_z, z), max(high_z, z)
    lowest[0], highest[0] = min(lowest[0], low_x), max(highest[0], high_x)
    lowest[1], highest[1] = min(lowest[1], low_y), max(highest[1], high_y)
    lowest[2], highest[2] = min(lowest[2], low_z), max(highest[2], high_z)


@kernel
def _rises_kernel(times: NDArray[np.float64], before: float) -> bool:
    for time in times:
        if time < before:
            return False
        before = time
    return True
