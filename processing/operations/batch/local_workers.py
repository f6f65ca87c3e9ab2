"""The drives of a job on this machine: so many processes at a time as the job says."""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from contextlib import suppress

from processing.core.errors import UserError
from processing.operations.batch.unit_process import Stopped, work_apart
from processing.operations.batch.unit_state import UnitState
from processing.operations.written_values import Table


def worker_count(asked: int) -> int:
    """How many drives are worked on at a time: as asked, or one a core."""
    return asked or max(1, os.cpu_count() or 1)


class LocalWorkers:
    """Threads that each see to one process at a time.

    Parameters
    ----------
    count : int
    """

    dashboard = ""

    def __init__(self, count: int) -> None:
        self._pool = ThreadPoolExecutor(max_workers=count, thread_name_prefix="batch")
        self._stop = threading.Event()
        self._futures: dict[str, Future[UnitState]] = {}

    def begin(self, orders: Sequence[Table]) -> None:
        """Hand all drives over; they are begun in this order."""
        for order in orders:
            self._futures[str(order["name"])] = self._pool.submit(
                work_apart, order, self._stop.is_set
            )

    def ended(self) -> Mapping[str, UnitState | str]:
        """Drives that are over since it was asked last, by name; or why one could not be noted."""
        found: dict[str, UnitState | str] = {}
        for name, future in list(self._futures.items()):
            if future.done():
                del self._futures[name]
                error = future.exception()
                is_told = isinstance(error, UserError)
                found[name] = str(error) if is_told else future.result()
        return found

    def close(self) -> None:
        """End the processes that are still at work, and wait for that."""
        self._stop.set()
        for future in self._futures.values():
            future.cancel()
        self._pool.shutdown()
        for future in self._futures.values():
            with suppress(CancelledError, Stopped, UserError):
                future.result()
