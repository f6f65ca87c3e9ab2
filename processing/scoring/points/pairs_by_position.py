"""The points of two files in different orders, each with the one at the same place in the other."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.scoring.points.coded_points import (
    SAME_CLOUD,
    CodedFile,
    CodedPoints,
    CodePairs,
    both_names,
)

_BUCKET = 2_000_000
_MIXED = np.array([73_856_093, 19_349_663, 83_492_791], np.int64)
_FINEST_M = 1e-6
_DEALT = 0.6
_KEY, _CODE, _KIND = "key", "code", "kind "


def pairs_by_position(
    truth: CodedFile,
    result: CodedFile,
    scratch: Path,
    monitor: Monitor,
    *,
    points_at_once: int = _BUCKET,
) -> Iterator[CodePairs]:
    """The points of two files, each with the one at the same place in the other.

    Points at one place are paired in the order of the files. Both files are dealt to the disk by
    their coordinates first, so that memory doesn't grow with them.

    Parameters
    ----------
    truth, result : CodedFile
        With coordinates.
    scratch : Path
        An empty folder for some 30 bytes a point meanwhile; the caller deletes it.

    Raises
    ------
    Unsuitable
        A point of either file has no counterpart; says how many.
    NoSpace
    """
    step_m = max(truth.step_m, result.step_m, _FINEST_M)
    first = next((block.xyz for block in result.blocks() if len(block.codes)), None)
    origin = np.zeros(3) if first is None else first[0]
    buckets = max(1, -(-max(truth.count, result.count) // points_at_once))
    dealt = []
    for file, name in ((truth, "truth"), (result, "result")):
        dealt.append(_Dealt(scratch / name, buckets))
        for block in file.blocks():
            monitor.check()
            dealt[-1].deal(block, origin, step_m)
        monitor.report(_DEALT * len(dealt) / 2)
    alone = np.zeros(2, np.int64)
    for bucket in range(buckets):
        monitor.check()
        ours, theirs = (one.read(bucket) for one in dealt)
        if np.array_equal(ours[_KEY], theirs[_KEY]):
            yield CodePairs(_points_of(ours), _points_of(theirs))
        else:
            alone += _without_counterpart(ours[_KEY], theirs[_KEY])
        monitor.report(_DEALT + (1 - _DEALT) * (bucket + 1) / buckets)
    if alone.any():
        raise _no_counterpart(truth, result, int(alone[0]), int(alone[1]))


class _Dealt:
    """A file's points in files by a number that equal coordinates share."""

    def __init__(self, folder: Path, buckets: int) -> None:
        self._folder = folder
        self._buckets = buckets
        self._dtype = np.dtype([(_KEY, "<i8", 3), (_CODE, "u1")])
        with report_as_user_error(folder):
            folder.mkdir()

    def deal(self, block: CodedPoints, origin: NDArray[np.float64], step_m: float) -> None:
        if block.xyz is None:
            message = "points without places"
            raise ValueError(message)
        kinds = [(_KIND + name, "<i2") for name in block.kinds]
        self._dtype = np.dtype([(_KEY, "<i8", 3), (_CODE, "u1"), *kinds])
        records = np.empty(len(block.codes), self._dtype)
        records[_KEY] = np.rint((block.xyz - origin) / step_m)
        records[_CODE] = block.codes
        for name, values in block.kinds.items():
            records[_KIND + name] = values
        # Products that overflow wrap round, in the same way for both files.
        bucket = (records[_KEY] * _MIXED).sum(axis=1) % self._buckets
        order = np.argsort(bucket, kind="stable")
        ends = np.searchsorted(bucket[order], np.arange(self._buckets + 1))
        for number in range(self._buckets):
            part = records[order[ends[number] : ends[number + 1]]]
            if len(part):
                with (
                    report_as_user_error(self._file(number)),
                    self._file(number).open("ab") as file,
                ):
                    file.write(part.tobytes())

    def read(self, bucket: int) -> NDArray[Any]:
        """Records by place, those of one place in the file's order."""
        path = self._file(bucket)
        with report_as_user_error(path):
            data = path.read_bytes() if path.exists() else b""
        records = np.frombuffer(data, self._dtype)
        east, north, height = records[_KEY].T
        ordered: NDArray[Any] = records[np.lexsort((height, north, east))]
        return ordered

    def _file(self, bucket: int) -> Path:
        return self._folder / str(bucket)


# Any: records of the fields that _Dealt gave them.
def _points_of(records: NDArray[Any]) -> CodedPoints:
    names = [name for name in records.dtype.names or () if name.startswith(_KIND)]
    kinds = {name.removeprefix(_KIND): records[name].copy() for name in names}
    return CodedPoints(records[_CODE].copy(), kinds=kinds)


def _without_counterpart(ours: NDArray[np.int64], theirs: NDArray[np.int64]) -> NDArray[np.int64]:
    """(2,) how many of the points of either have none in the other, one to one."""
    both = np.concatenate([ours, theirs])
    order = np.lexsort(both.T)
    is_new = np.r_[True, np.any(np.diff(both[order], axis=0) != 0, axis=1)]
    position = np.empty(len(both), np.int64)
    position[order] = np.cumsum(is_new) - 1
    size = int(is_new.sum())
    more = np.bincount(position[: len(ours)], minlength=size) - np.bincount(
        position[len(ours) :], minlength=size
    )
    return np.array([more[more > 0].sum(), -more[more < 0].sum()])


def _no_counterpart(truth: CodedFile, result: CodedFile, ours: int, theirs: int) -> Unsuitable:
    return Unsuitable(
        Text(
            "{theirs} of the result's {result} points and {ours} of the truth's {truth} have no "
            "counterpart at the same place.",
            "結果の{result}点中{theirs}点、正解の{truth}点中{ours}点に、同じ位置の点がありません。",
        ).filled(
            theirs=f"{theirs:,}",
            result=f"{result.count:,}",
            ours=f"{ours:,}",
            truth=f"{truth.count:,}",
        ),
        both_names(truth, result),
        SAME_CLOUD,
    )
