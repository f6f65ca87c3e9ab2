"""DeliveredOrder: values of points given back in the order of the delivered files.

Most recordings keep that order but for a few runs, so a stretch of a file is a few stretches of the
recording. Where scanners were interleaved or an order was restored, one pass deals the values to
files on the disk, each of which holds what belongs into one part of a delivered file.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.columns.source_order import FILE, INDEX, SourceRun, check_sources
from processing.recording.drive import Drive

# Any: each column has its own type.
Values = dict[str, NDArray[Any]]
ValueReader = Callable[[Drive, int, int], Values]

PART_POINTS = 2_000_000
_AT = "at"


class DeliveredOrder:
    """Values of the points of delivered files, a chunk at a time.

    Parameters
    ----------
    drives : sequence of Drive
        All that have points of the files.
    read : callable
        Values of the points ``start … stop − 1`` of a drive by name, (k,) or (k, width): the same
        names and types for every drive, none for ``0, 0``.
    scratch : Path
        An empty folder, for recordings that don't keep the order of their files.
    part_points : int
        So many points of a delivered file are put in order in memory at a time.
    """

    def __init__(
        self,
        drives: Sequence[Drive],
        read: ValueReader,
        scratch: Path,
        *,
        part_points: int = PART_POINTS,
    ) -> None:
        self._read = read
        self._none = read(drives[0], 0, 0) if drives else {}
        self._runs: dict[Path, list[tuple[Drive, SourceRun]]] = {}
        self._unordered: list[Drive] = []
        for drive in drives:
            if not drive.info.source_runs:
                self._unordered.append(drive)
            for run in drive.info.source_runs:
                source = drive.source_path(drive.info.sources[run.source])
                self._runs.setdefault(source, []).append((drive, run))
        for runs in self._runs.values():
            runs.sort(key=_first_index)
        self._dealt = _DealtValues(scratch, self._none, part_points)

    def prepare(self, monitor: Monitor) -> None:
        """Deal the values of recordings in another order; nothing to do for others.

        Raises
        ------
        NoSpace, Cancelled
        """
        total = max(1, sum(drive.count for drive in self._unordered))
        done = 0
        for drive in self._unordered:
            paths = [drive.source_path(source) for source in drive.info.sources]
            for start, stop in chunk_ranges(drive.count, PART_POINTS):
                monitor.check()
                monitor.report(done / total)
                done += stop - start
                files = read_chunk(drive.folder, FILE, start, stop)
                indices = read_chunk(drive.folder, INDEX, start, stop)
                check_sources(drive.folder, files, indices, len(paths))
                self._dealt.add(paths, files, indices, self._read(drive, start, stop))

    def values(self, source: Path, start: int, stop: int) -> Values:
        """Values of the points ``start … stop − 1`` of a delivered file, in its order.

        Zero for points that no drive has. Quick where stretches follow each other.
        """
        found = {
            name: np.zeros((stop - start, *none.shape[1:]), none.dtype)
            for name, none in self._none.items()
        }
        runs = self._runs.get(source, [])
        first = max(0, bisect_right(runs, start, key=_first_index) - 1)
        for drive, run in runs[first : bisect_left(runs, stop, key=_first_index)]:
            low = max(start, run.first_index)
            high = min(stop, run.first_index + run.count)
            if low < high:
                shift = run.start - run.first_index
                for name, values in self._read(drive, low + shift, high + shift).items():
                    found[name][low - start : high - start] = values
        self._dealt.put_into(found, source, start, stop)
        return found


def _first_index(run: tuple[Drive, SourceRun]) -> int:
    return run[1].first_index


class _DealtValues:
    """Records of values with their places, in a file for each part of a delivered file."""

    def __init__(self, folder: Path, none: Values, part_points: int) -> None:
        self._folder = folder
        self._part_points = part_points
        self._none = none
        self._record = np.dtype(
            [(_AT, "<u4"), *((name, one.dtype, one.shape[1:]) for name, one in none.items())]
        )
        self._sources: dict[Path, int] = {}
        self._loaded: tuple[Path, Values] | None = None

    def add(
        self,
        paths: Sequence[Path],
        files: NDArray[np.uint16],
        indices: NDArray[np.int64],
        values: Values,
    ) -> None:
        """Deal values of some points.

        Parameters
        ----------
        paths : sequence of Path
            Of the delivered files.
        files, indices : (k,)
            Which of them, and where in it.
        """
        records = np.empty(files.size, self._record)
        records[_AT] = indices % self._part_points
        for name, one in values.items():
            records[name] = one
        numbers = [self._sources.setdefault(path, len(self._sources)) for path in paths]
        parts = indices // self._part_points
        width = int(parts.max(initial=0)) + 1
        keys = np.array(numbers, np.int64)[files] * width + parts
        if (np.diff(keys) < 0).any():
            # Numbers of sixteen bits are sorted in linear time.
            is_small = keys.max() <= np.iinfo(np.uint16).max
            order = np.argsort(keys.astype(np.uint16) if is_small else keys, kind="stable")
            records, keys = records[order], keys[order]
        ends = np.append(np.flatnonzero(np.diff(keys)) + 1, keys.size)
        start = 0
        for end in ends.tolist():
            source, part = divmod(int(keys[start]), width)
            path = self._path(source, part)
            with report_as_user_error(path), path.open("ab") as file:
                file.write(records[start:end].tobytes())
            start = end

    def put_into(self, found: Values, source: Path, start: int, stop: int) -> None:
        """Put the values of the points ``start … stop − 1`` of a file where they belong."""
        if source not in self._sources:
            return
        for part in range(start // self._part_points, -(-stop // self._part_points)):
            values = self._part(self._path(self._sources[source], part))
            low, high = (
                max(start, part * self._part_points),
                min(stop, (part + 1) * self._part_points),
            )
            chosen = slice(low - part * self._part_points, high - part * self._part_points)
            is_here = values[_AT][chosen] > 0
            for name, one in found.items():
                one[low - start : high - start][is_here] = values[name][chosen][is_here]

    def _path(self, source: int, part: int) -> Path:
        return self._folder / f"{source}-{part}.part"

    def _part(self, path: Path) -> Values:
        """All values of one part, in order; ``at`` is 1 where there is one."""
        if self._loaded is None or self._loaded[0] != path:
            values = {
                name: np.zeros((self._part_points, *one.shape[1:]), one.dtype)
                for name, one in self._none.items()
            }
            values[_AT] = np.zeros(self._part_points, np.uint8)
            if path.is_file():
                with report_as_user_error(path):
                    records = np.fromfile(path, self._record)
                for name in self._none:
                    values[name][records[_AT]] = records[name]
                values[_AT][records[_AT]] = 1
            self._loaded = path, values
        return self._loaded[1]
