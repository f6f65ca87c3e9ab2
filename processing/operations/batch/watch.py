"""A job that waits for deliveries: each is worked on once it has arrived whole.

A delivery is whole when the job's marker lies in it; without a marker, when for some time nothing
of it has changed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor
from processing.operations.batch.batch import BatchOperation, BatchOutcome, run_deliveries
from processing.operations.batch.deliveries import BatchDelivery, matches, named
from processing.operations.batch.job import JobFile, read_job

_LOOK_S = 5.0
_WAIT_S = 0.1

Files = tuple[tuple[str, int, int], ...]
"""Name, size and time of each file of a delivery."""


@dataclass(frozen=True)
class _Seen:
    """What a delivery was when it was looked at, and since when it is so."""

    files: Files
    since_s: float


class Arrivals:
    """Which deliveries of a job are there whole; asked again and again.

    Parameters
    ----------
    file : JobFile
    """

    def __init__(self, file: JobFile) -> None:
        self._file = file
        self._seen: dict[Path, _Seen] = {}

    def whole(self, now_s: float) -> dict[BatchDelivery, Files]:
        """The deliveries that are whole, with their files.

        Parameters
        ----------
        now_s : float
            On any clock that goes on.

        Raises
        ------
        UserError
            The folder can't be looked at.
        """
        patterns = self._file.job.deliveries
        paths = sorted({path for one in patterns for path in matches(self._file, one)})
        deliveries = named(paths)
        before, self._seen = self._seen, {}
        found: dict[BatchDelivery, Files] = {}
        for delivery in deliveries:
            files = tuple(_files_of(delivery.path))
            old = before.get(delivery.path)
            is_same = old is not None and old.files == files
            seen = old if old is not None and is_same else _Seen(files, now_s)
            self._seen[delivery.path] = seen
            if self._is_whole(seen, now_s):
                found[delivery] = files
        return found

    def _is_whole(self, seen: _Seen, now_s: float) -> bool:
        marker = self._file.job.marker
        if marker:
            return any(name == marker for name, _, _ in seen.files)
        return bool(seen.files) and now_s - seen.since_s >= self._file.job.settled_s


def watch(
    operation: BatchOperation, monitor: Monitor, tell: Callable[[BatchOutcome], None]
) -> None:
    """Do a job for deliveries as they arrive, until it is cancelled.

    Parameters
    ----------
    tell : callable
        Called with what came of the job each time that deliveries were worked on.

    Raises
    ------
    MissingInput, BadFile, OutOfRange, InUse
        As :func:`processing.operations.batch.batch.run_batch`; a pattern may match nothing yet.
    Cancelled
        This is how it ends.
    """
    file = read_job(operation.job)
    arrivals = Arrivals(file)
    worked: dict[BatchDelivery, Files] = {}
    while True:
        whole = arrivals.whole(time.monotonic())
        if whole and whole != worked:
            tell(run_deliveries(file, tuple(whole), operation, monitor))
            worked = whole
        until = time.monotonic() + _LOOK_S
        while time.monotonic() < until:
            monitor.check()
            time.sleep(_WAIT_S)


def _files_of(path: Path) -> Iterator[tuple[str, int, int]]:
    try:
        for one in sorted(path.iterdir()) if path.is_dir() else [path]:
            status = one.stat()
            yield one.name, status.st_size, status.st_mtime_ns
    except OSError:  # it is being written or taken away: the next look tells
        return
