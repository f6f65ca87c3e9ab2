"""Work on ranges, shared out to the computer's cores; kernels release the interpreter."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait

from processing.monitor import Monitor

_here = threading.local()


def shared_out(
    work: Callable[[int, int], None], count: int, at_once: int, monitor: Monitor
) -> None:
    """Call ``work(start, stop)`` until the range 0 … count − 1 is done.

    Work that is shared out again from within its share stays on that core.

    Parameters
    ----------
    work : callable
        Writes into arrays of its own range only.
    at_once : int
        Length of a range; short enough for a cancel to be felt at once.

    Raises
    ------
    Cancelled
        After the calls in hand have ended.
    """
    workers = 1 if getattr(_here, "is_a_share", False) else os.cpu_count() or 1
    starts = iter(range(0, count, at_once))
    if workers == 1 or count <= at_once:
        for start in starts:
            monitor.check()
            work(start, min(start + at_once, count))
        return

    def take() -> None:
        _here.is_a_share = True
        while (start := next(starts, None)) is not None:
            monitor.check()
            work(start, min(start + at_once, count))

    with ThreadPoolExecutor(max_workers=workers) as pool:
        done = [pool.submit(take) for _ in range(workers)]
        wait(done)
    for future in done:
        future.result()
