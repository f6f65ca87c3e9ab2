"""Columns of varying length: each point has as many values as it has, many or none.

``<name>.bin`` holds the values of all points one behind the other, ``<name>.starts.bin`` (int64,
n + 1) where each point's begin; the last start is where all end. What belongs to a pulse, such as
its waveform, is held by the pulse's first point, and the others have none of it.
"""

from __future__ import annotations

import mmap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.recording.columns.mapped_pages import MappedPages

VARYING_TYPES: Mapping[str, str] = {"waveform": "<u2"}
"""Column name to dtype of its values."""

VALUES_AT_ONCE = 16_000_000
"""So many values are held in memory where columns are copied; more only of a single point."""

_START = np.dtype("<i8")
_STARTS_AT_ONCE = 1_000_000


def values_path(folder: Path, name: str) -> Path:
    """Where the values of a column of varying length lie in a drive folder."""
    return folder / f"{name}.bin"


def starts_path(folder: Path, name: str) -> Path:
    """Where the starts of each point's values lie."""
    return folder / f"{name}.starts.bin"


def varying_names(folder: Path) -> tuple[str, ...]:
    """The columns of varying length that a drive folder has."""
    return tuple(name for name in VARYING_TYPES if starts_path(folder, name).is_file())


def varying_bytes(folder: Path) -> int:
    """How much room they take on the disk.

    Raises
    ------
    OSError
    """
    return sum(
        path_in(folder, name).stat().st_size
        for name in varying_names(folder)
        for path_in in (values_path, starts_path)
    )


@dataclass(frozen=True, eq=False)
class VaryingValues:
    """Values of some points.

    Attributes
    ----------
    values : (m,)
        Of all of them, one point's behind the other's.
    starts : (k + 1,) int64
        Point i has ``values[starts[i] : starts[i + 1]]``; the first is 0.
    """

    values: NDArray[Any]  # the type of a column's values is the column's own
    starts: Integers

    @staticmethod
    def of(rows: Sequence[NDArray[Any]], dtype: str) -> VaryingValues:
        """The values that these arrays hold, one array a point."""
        starts = np.concatenate([[0], np.cumsum([len(row) for row in rows], dtype=np.int64)])
        values = np.concatenate([np.empty(0, dtype), *rows]).astype(dtype)
        return VaryingValues(values, starts.astype(np.int64))

    @staticmethod
    def nothing(count: int, dtype: str) -> VaryingValues:
        """So many points without values."""
        return VaryingValues(np.empty(0, dtype), np.zeros(count + 1, np.int64))

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.starts.size) - 1

    def __getitem__(self, point: int) -> NDArray[Any]:
        """The values of one of the points: a view."""
        return self.values[self.starts[point] : self.starts[point + 1]]


class VaryingWriter:
    """Appends points to columns of varying length in a drive folder that is being made.

    Parameters
    ----------
    folder : Path
        Exists, belongs to this writer alone.
    first : int
        So many points are there already. What lies behind them, as a work left it that was
        killed, goes; a column that is new gets nothing for them.
    """

    def __init__(self, folder: Path, first: int = 0) -> None:
        self._folder = folder
        self._first = first
        self._files: dict[str, tuple[BinaryIO, BinaryIO]] = {}
        self._ends: dict[str, int] = {}

    def append(self, columns: Mapping[str, VaryingValues]) -> None:
        """Append points; every call names the same columns, each with the same points.

        Raises
        ------
        NoSpace
            The disk is full or refuses the write.
        BadFile
            The column that is to be continued is damaged.
        """
        for name, added in columns.items():
            with report_as_user_error(self._folder):
                if name not in self._files:
                    self._open(name)
                values, starts = self._files[name]
                # Values first: starts never tell of more than there is.
                values.write(np.ascontiguousarray(added.values, VARYING_TYPES[name]).data)
                ends = added.starts[1:] + self._ends[name]
                starts.write(np.ascontiguousarray(ends, _START).data)
                self._ends[name] += int(added.starts[-1])

    def close(self) -> None:
        """Close the files; may be called again."""
        with report_as_user_error(self._folder):
            for pair in self._files.values():
                for file in pair:
                    file.close()
        self._files.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _open(self, name: str) -> None:
        of_values, of_starts = values_path(self._folder, name), starts_path(self._folder, name)
        if not self._is_continued(of_values, of_starts):
            self._begin(of_values, of_starts)
        end = self._end_before(name)
        values, starts = of_values.open("r+b"), of_starts.open("r+b")
        self._files[name], self._ends[name] = (values, starts), end
        values.truncate(end * np.dtype(VARYING_TYPES[name]).itemsize)
        starts.truncate((self._first + 1) * _START.itemsize)
        for file in (values, starts):
            file.seek(0, 2)

    def _is_continued(self, values: Path, starts: Path) -> bool:
        if not self._first or not starts.is_file():
            return False
        # A killed work may have left a new column that has no values yet.
        is_begun = starts.stat().st_size >= (self._first + 1) * _START.itemsize
        return is_begun or values.stat().st_size > 0

    def _begin(self, values: Path, starts: Path) -> None:
        """Write a column without values for the points that are there already."""
        values.write_bytes(b"")
        with starts.open("wb") as file:
            for start in range(0, self._first + 1, _STARTS_AT_ONCE):
                some = min(_STARTS_AT_ONCE, self._first + 1 - start)
                file.write(np.zeros(some, _START).data)

    def _end_before(self, name: str) -> int:
        """Where the values of the points end that are there already."""
        path = starts_path(self._folder, name)
        found = np.fromfile(path, _START, count=1, offset=self._first * _START.itemsize)
        size = values_path(self._folder, name).stat().st_size
        end = int(found[0]) if found.size else -1
        if not 0 <= end * np.dtype(VARYING_TYPES[name]).itemsize <= size:
            raise _make_damage_error(path, self._first)
        return end


class VaryingColumn:
    """A column of varying length, read only and mapped.

    Parameters
    ----------
    folder : Path
    count : int
        Number of points.
    pages : MappedPages, optional
        Bounds what maps hold of the memory.

    Raises
    ------
    MissingInput
        There is no such column.
    BadFile
        Its files are not as long as they should be. Starts that fall, or lead out of the file,
        are refused when they are used.
    """

    def __init__(
        self, folder: Path, name: str, count: int, pages: MappedPages | None = None
    ) -> None:
        self._pages = pages or MappedPages()
        self._path = starts_path(folder, name)
        self.count = count
        self._starts = self._map_file(self._path, _START)
        self._values = self._map_file(values_path(folder, name), np.dtype(VARYING_TYPES[name]))
        if self._starts.size != count + 1:
            raise _make_damage_error(self._path, min(self._starts.size, count + 1))
        ends = int(self._starts[0]), int(self._starts[-1])
        if ends != (0, self._values.size):
            raise _make_damage_error(self._path, 0 if ends[0] else count)

    def between(self, start: int, stop: int) -> VaryingValues:
        """Values of the points ``start … stop − 1``: a mapped view, not to be written.

        Raises
        ------
        BadFile
        """
        self._pages.look()
        starts = np.asarray(self._starts[start : stop + 1])
        self._check(starts[:-1], starts[1:], start)
        first = int(starts[0])
        return VaryingValues(self._values[first : int(starts[-1])], starts - first)

    def of(self, points: Integers) -> VaryingValues:
        """Values of points in any order: a copy.

        Raises
        ------
        BadFile
        """
        self._pages.look()
        return self._take_values(*self._ends_of(points))

    def pieces(self, points: Integers | slice) -> Iterator[VaryingValues]:
        """Values of points, so many points at a time that not too much is held in memory.

        Of no points one piece without any.

        Parameters
        ----------
        points : (k,) int64, or slice
            All of a slice, from its start to its stop.

        Raises
        ------
        BadFile
        """
        first, count = (
            (int(points.start), int(points.stop) - int(points.start))
            if isinstance(points, slice)
            else (0, points.size)
        )
        for at in range(0, max(count, 1), _STARTS_AT_ONCE):
            end = min(at + _STARTS_AT_ONCE, count)
            some = (
                np.arange(first + at, first + end, dtype=np.int64)
                if isinstance(points, slice)
                else points[at:end]
            )
            begins, ends = self._ends_of(some)
            for low, high in _bound_stretches(ends - begins):
                self._pages.look()
                yield self._take_values(begins[low:high], ends[low:high])

    def _ends_of(self, points: Integers) -> tuple[Integers, Integers]:
        begins, ends = np.asarray(self._starts[points]), np.asarray(self._starts[points + 1])
        self._check(begins, ends, points)
        return begins, ends

    def _take_values(self, begins: Integers, ends: Integers) -> VaryingValues:
        lengths = ends - begins
        starts = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        if begins.size and (begins[1:] == ends[:-1]).all():
            return VaryingValues(np.array(self._values[begins[0] : ends[-1]]), starts)
        at = np.repeat(begins - starts[:-1], lengths) + np.arange(int(starts[-1]))
        return VaryingValues(self._values[at], starts)

    def _check(self, begins: Integers, ends: Integers, points: Integers | int) -> None:
        wrong = np.flatnonzero((begins < 0) | (ends < begins) | (ends > self._values.size))
        if wrong.size:
            first = int(wrong[0])
            point = points + first if isinstance(points, int) else int(points[first])
            raise _make_damage_error(self._path, point)

    def _map_file(self, path: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
        with report_as_user_error(path):
            size = path.stat().st_size
            if size % dtype.itemsize:
                raise _make_damage_error(path, size // dtype.itemsize)
            if not size:
                return np.empty(0, dtype)
            with path.open("rb") as file:
                mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
            self._pages.add(mapped)
            return np.frombuffer(mapped, dtype)


def _bound_stretches(lengths: Integers) -> Iterator[tuple[int, int]]:
    """First and end of stretches with so many values that they may be held in memory."""
    totals, low = np.cumsum(lengths), 0
    while True:
        limit = (int(totals[low - 1]) if low else 0) + VALUES_AT_ONCE
        high = min(max(low + 1, int(np.searchsorted(totals, limit, side="right"))), lengths.size)
        yield low, high
        if high >= lengths.size:
            return
        low = high


def _make_damage_error(path: Path, point: int) -> BadFile:
    return BadFile(
        Text(
            "A column of the drive tells wrongly where the values of points begin.",
            "走行データの列データで、点ごとの値の開始位置が正しくありません。",
        ),
        Text.same(f"{path}, {point}"),
        Text(
            "Import the drive again from the delivered files. {unchanged}",
            "納品ファイルから走行データを再インポートしてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
