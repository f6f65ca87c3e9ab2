"""Putting the points of a drive folder into another order without holding them all in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import refuse_damaged
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.recording.columns.columns import (
    COLUMN_TYPES,
    ColumnWriter,
    column_path,
    wrong_length,
)
from processing.recording.columns.replacing import new_columns, replace_columns

POINTS_AT_ONCE = 8_000_000
"""Points sorted in memory at a time: some 0.6 GiB with all columns."""

SortKeys = Callable[[Mapping[str, NDArray[Any]]], tuple[NDArray[Any], NDArray[Any]]]
"""Gives the first and the second sort key of a stretch of points, each (n,)."""


def sort_points(
    folder: Path, names: tuple[str, ...], count: int, keys: SortKeys, monitor: Monitor
) -> None:
    """Order the columns of a folder by two keys; equal points keep their order.

    Parameters
    ----------
    folder : Path
        A drive folder that is being made.
    names : tuple of str
        Its columns.
    keys : callable
        From columns to keys; the smallest first key comes first, NaN last.

    Raises
    ------
    NoSpace
        The disk can't hold a second copy of the points.
    Cancelled
        The columns are as they were.

    Notes
    -----
    1. The first key is sampled; its quantiles part the points into buckets that fit in memory.
    2. One pass deals the points to the buckets' files in their order.
    3. Each bucket is sorted in memory and appended to the result.
    4. The result takes the columns' places; a kill leaves the old order or the new one, see
       :mod:`processing.recording.columns.replacing`. Sorted again, the points stay as they are.
    """
    limits = _bucket_limits(folder, count, keys)
    record = _record_of(names)
    new = new_columns(folder)
    buckets = [new / f"bucket{number}" for number in range(limits.size + 1)]
    _deal(folder, record, count, keys=keys, limits=limits, buckets=buckets, monitor=monitor)
    with ColumnWriter(new) as writer:
        for done, bucket in enumerate(buckets, 1):
            monitor.check()
            if bucket.exists():
                with report_as_user_error(bucket):
                    points = np.fromfile(bucket, record)
                    bucket.unlink()
                first, second = keys(_Fields(points))
                order = np.lexsort((second, first))
                writer.append(_Fields(points, order))
            monitor.report(0.5 + 0.5 * done / len(buckets))
    replace_columns(folder)


def read_chunk(folder: Path, name: str, start: int, stop: int) -> NDArray[Any]:
    """The points ``start … stop − 1`` of a column, read into memory.

    Unlike a map, what is read does not stay resident when it is no longer used.
    """
    dtype, width = COLUMN_TYPES[name]
    item = np.dtype(dtype).itemsize * width
    path = column_path(folder, name)
    refuse_damaged(path, start * item, stop * item)
    with report_as_user_error(folder):
        values: NDArray[Any] = np.fromfile(
            path,
            dtype=dtype,
            count=(stop - start) * width,
            offset=start * item,
        )
    if values.size != (stop - start) * width:
        raise wrong_length(path)
    return values if width == 1 else values.reshape(-1, width)


def chunk_ranges(count: int, size: int = POINTS_AT_ONCE) -> list[tuple[int, int]]:
    """Start and stop of consecutive stretches of at most ``size`` points."""
    return [(start, min(start + size, count)) for start in range(0, count, size)]


def sample_column(folder: Path, name: str, count: int, step: int) -> NDArray[Any]:
    """Every so-many-th point of a column from the first on; what lies between does not stay."""
    parts = []
    for start, stop in chunk_ranges(count):
        first = -start % step
        parts.append(read_chunk(folder, name, start, stop)[first::step].copy())
    return np.concatenate(parts)


class _Stretch(Mapping[str, NDArray[Any]]):
    """Columns of a stretch of a folder's points; each is read when it is asked for."""

    def __init__(self, folder: Path, start: int, stop: int) -> None:
        self._folder, self._start, self._stop = folder, start, stop

    def __getitem__(self, name: str) -> NDArray[Any]:
        return read_chunk(self._folder, name, self._start, self._stop)

    def __iter__(self) -> Iterator[str]:
        return (path.stem for path in self._folder.glob("*.bin"))

    def __len__(self) -> int:
        return sum(1 for _ in self)


class _Fields(Mapping[str, NDArray[Any]]):
    """Columns of points that lie in records, in another order if need be; one copy at a time."""

    def __init__(self, points: NDArray[Any], order: NDArray[np.int64] | None = None) -> None:
        self._points, self._order = points, order

    def __getitem__(self, name: str) -> NDArray[Any]:
        column = self._points[name]
        return np.ascontiguousarray(column) if self._order is None else column[self._order]

    def __iter__(self) -> Iterator[str]:
        return iter(self._points.dtype.names or ())

    def __len__(self) -> int:
        return sum(1 for _ in self)


def _record_of(names: tuple[str, ...]) -> np.dtype[Any]:
    """A point as it lies in a bucket's file."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for name in names:
        dtype, width = COLUMN_TYPES[name]
        fields.append((name, dtype) if width == 1 else (name, dtype, (width,)))
    return np.dtype(fields)


def _bucket_limits(folder: Path, count: int, keys: SortKeys) -> NDArray[Any]:
    buckets = -(-count // POINTS_AT_ONCE)
    if buckets <= 1:
        return np.empty(0)
    sample = [
        keys(_Stretch(folder, start, stop))[0][::64]
        for start, stop in chunk_ranges(count, POINTS_AT_ONCE // 4)
    ]
    # Twice as many buckets as needed, since a sample's quantiles are not the points' own.
    shares = np.linspace(0, 1, 2 * buckets + 1)[1:-1]
    return np.unique(np.quantile(np.concatenate(sample), shares, method="nearest"))


def _deal(
    folder: Path,
    record: np.dtype[Any],
    count: int,
    *,
    keys: SortKeys,
    limits: NDArray[Any],
    buckets: list[Path],
    monitor: Monitor,
) -> None:
    """Append the points to their buckets' files, as records; one file is open at a time."""
    for start, stop in chunk_ranges(count, POINTS_AT_ONCE // 4):
        monitor.check()
        columns = _Stretch(folder, start, stop)
        bucket = np.searchsorted(limits, keys(columns)[0], side="right")
        # Small integers are sorted by counting.
        order = np.argsort(bucket.astype(np.uint16), kind="stable")
        points = np.empty(stop - start, record)
        for name in record.names or ():
            points[name] = columns[name][order]
        ends = np.searchsorted(bucket[order], np.arange(len(buckets) + 1))
        for path, low, high in zip(buckets, ends[:-1], ends[1:], strict=True):
            if low < high:
                with report_as_user_error(path), path.open("ab") as file:
                    file.write(points[low:high].view(np.uint8).data)
        monitor.report(0.5 * stop / count)
