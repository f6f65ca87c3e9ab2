"""Blocks of a recording worked on by two threads; what comes out doesn't depend on them.

Kernels release the interpreter, so while one thread reads and measures the next block another one
looks at this one. Results come in the order of the blocks, and no more are held than are worked on.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

ItemT = TypeVar("ItemT")
ResultT = TypeVar("ResultT")

_WORKERS = 2


class _End:
    """Comes after the last value."""


_END = _End()


def one_ahead(values: Iterator[ItemT]) -> Iterator[ItemT]:
    """The same values, the next one being worked out by a thread of its own.

    What the values raise, ``Cancelled`` too, is raised here; a reader that stops early waits for
    the value in hand only.
    """

    def following() -> ItemT | _End:
        return next(values, _END)

    with ThreadPoolExecutor(max_workers=1) as pool:
        coming = pool.submit(following)
        while not isinstance(value := coming.result(), _End):
            coming = pool.submit(following)
            yield value


def in_order(work: Callable[[ItemT], ResultT], items: Iterable[ItemT]) -> Iterator[ResultT]:
    """What becomes of each item, in their order; two are worked on at a time.

    Parameters
    ----------
    work : callable
        Changes nothing that another item's work reads; may raise ``Cancelled``.
    """
    with ThreadPoolExecutor(max_workers=_WORKERS) as pool:
        coming: deque[Future[ResultT]] = deque()
        try:
            for item in items:
                coming.append(pool.submit(work, item))
                if len(coming) > _WORKERS:
                    yield coming.popleft().result()
            while coming:
                yield coming.popleft().result()
        finally:
            for future in coming:
                future.cancel()
