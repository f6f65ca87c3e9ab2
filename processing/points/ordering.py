"""Putting the points of a drive folder into another order without holding them all in memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.errors import told_as_user_error
from processing.monitor import Monitor
from processing.points.columns import COLUMN_TYPES, ColumnWriter, column_path
from processing.points.replacing import new_columns, replace_columns

POINTS_AT_ONCE = 8_000_000
"""Points sorted in memory at a time: some 0.5 GiB with all columns."""

Keys = Callable[[Mapping[str, NDArray[Any]]], tuple[NDArray[Any], NDArray[Any]]]
"""Gives the first and the second sort key of a stretch of points, each (n,)."""


def sort_points(
    folder: Path, names: tuple[str, ...], count: int, keys: Keys, monitor: Monitor
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
    2. One pass deals the points to bucket folders in their order.
    3. Each bucket is sorted in memory and appended to the result.
    4. The result takes the columns' places; a kill leaves the old order or the new one, see
       :mod:`processing.points.replacing`. Sorted again, the points stay as they are.
    """
    limits = _bucket_limits(folder, names, count, keys)
    sorted_folder = new_columns(folder)
    bucket_folders = [sorted_folder / f"bucket{number}" for number in range(limits.size + 1)]
    counts = _deal(
        folder, names, count, keys=keys, limits=limits, buckets=bucket_folders, monitor=monitor
    )
    with ColumnWriter(sorted_folder) as writer:
        for bucket, size in zip(bucket_folders, counts, strict=True):
            monitor.check()
            if size:
                columns = {name: read_stretch(bucket, name, 0, size) for name in names}
                first, second = keys(columns)
                order = np.lexsort((second, first))
                writer.append({name: values[order] for name, values in columns.items()})
            _remove_columns(bucket)
    replace_columns(folder)


def read_stretch(folder: Path, name: str, start: int, stop: int) -> NDArray[Any]:
    """The points ``start … stop − 1`` of a column, read into memory.

    Unlike a map, what is read does not stay resident when it is no longer used.
    """
    dtype, width = COLUMN_TYPES[name]
    item = np.dtype(dtype).itemsize * width
    with told_as_user_error(folder):
        values: NDArray[Any] = np.fromfile(
            column_path(folder, name),
            dtype=dtype,
            count=(stop - start) * width,
            offset=start * item,
        )
    return values if width == 1 else values.reshape(-1, width)


def stretches(count: int, size: int = POINTS_AT_ONCE) -> list[tuple[int, int]]:
    """Start and stop of consecutive stretches of at most ``size`` points."""
    return [(start, min(start + size, count)) for start in range(0, count, size)]


def _bucket_limits(folder: Path, names: tuple[str, ...], count: int, keys: Keys) -> NDArray[Any]:
    buckets = -(-count // POINTS_AT_ONCE)
    if buckets <= 1:
        return np.empty(0)
    sample = []
    for start, stop in stretches(count, POINTS_AT_ONCE // 4):
        columns = {name: read_stretch(folder, name, start, stop) for name in names}
        sample.append(keys(columns)[0][::64])
    # Twice as many buckets as needed, since a sample's quantiles are not the points' own.
    shares = np.linspace(0, 1, 2 * buckets + 1)[1:-1]
    return np.unique(np.quantile(np.concatenate(sample), shares, method="nearest"))


def _deal(
    folder: Path,
    names: tuple[str, ...],
    count: int,
    *,
    keys: Keys,
    limits: NDArray[Any],
    buckets: list[Path],
    monitor: Monitor,
) -> list[int]:
    writers = []
    for bucket in buckets:
        with told_as_user_error(bucket):
            bucket.mkdir()
        writers.append(ColumnWriter(bucket))
    try:
        for start, stop in stretches(count, POINTS_AT_ONCE // 4):
            monitor.check()
            columns = {name: read_stretch(folder, name, start, stop) for name in names}
            bucket_of_point = np.searchsorted(limits, keys(columns)[0], side="right")
            for number, writer in enumerate(writers):
                chosen = np.flatnonzero(bucket_of_point == number)
                if chosen.size:
                    writer.append({name: values[chosen] for name, values in columns.items()})
    finally:
        for writer in writers:
            writer.close()
    return [writer.count for writer in writers]


def _remove_columns(folder: Path) -> None:
    with told_as_user_error(folder):
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()
