"""Work on ranges, shared out to the computer's cores; kernels release the interpreter."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from functools import cache

from processing.core.monitor import Monitor

_here = threading.local()
_counting = threading.Lock()
_at_work = 0  # threads that have taken a share


def share_out(work: Callable[[int, int], None], count: int, at_once: int, monitor: Monitor) -> None:
    """Call ``work(start, stop)`` until the range 0 … count − 1 is done.

    Work that is shared out again from within a share takes only cores that no share is left for.

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
    starts = iter(range(0, count, at_once))
    workers = min(_free_cores(), -(-count // at_once))
    taking = threading.Lock()

    def take() -> None:
        while True:
            with taking:
                start = next(starts, None)
            if start is None:
                return
            monitor.check()
            work(start, min(start + at_once, count))

    def help_out() -> None:
        with _Share():
            take()

    helpers = [_helpers().submit(help_out) for _ in range(workers - 1)]
    try:
        if _has_share():
            take()
        else:
            help_out()
    finally:
        for one in helpers:
            one.cancel()  # of whom no thread was free is not needed any more
        wait(helpers)
    for one in helpers:
        if not one.cancelled():
            one.result()


@cache
def _helpers() -> ThreadPoolExecutor:
    """Threads that stay: to start one anew for each call takes longer than many calls."""
    return ThreadPoolExecutor(max_workers=os.cpu_count() or 1, thread_name_prefix="share")


def _free_cores() -> int:
    """How many threads may work here: all cores, or, within a share, it and those left over."""
    cores = os.cpu_count() or 1
    if not _has_share():
        return cores
    with _counting:
        return max(1, cores - _at_work + 1)


def _has_share() -> bool:
    return bool(getattr(_here, "has_share", False))


class _Share:
    """A thread takes part in work that is shared out; its own waiting doesn't count."""

    def __enter__(self) -> None:
        self._change(1)
        _here.has_share = True

    def __exit__(self, *_: object) -> None:
        _here.has_share = False
        self._change(-1)

    @staticmethod
    def _change(by: int) -> None:
        global _at_work  # one count for all threads
        with _counting:
            _at_work += by
