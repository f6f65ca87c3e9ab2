"""Work that is shared out is done whole and once, ends at once, and waits for no thread forever."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.methods.noise.neighbours.sharing import share_out
from tests.monitors import CancelledAfter

COUNT = 10_007


def counted(inner: int = 0) -> np.ndarray:
    """How often each number of the range was worked on, shared out again within if asked."""
    seen = np.zeros(COUNT, np.int64)

    def work(start: int, stop: int) -> None:
        def add(first: int, last: int) -> None:
            seen[start + first : start + last] += 1

        if inner:
            share_out(add, stop - start, inner, SilentMonitor())
        else:
            add(0, stop - start)

    share_out(work, COUNT, 100, SilentMonitor())
    return seen


@pytest.mark.parametrize("inner", [0, 7])
def test_every_range_is_worked_on_once_also_from_within_a_share(inner: int) -> None:
    assert (counted(inner) == 1).all()


def test_many_that_share_out_at_a_time_wait_for_each_other_not_forever() -> None:
    with ThreadPoolExecutor(8) as pool:
        assert all((one == 1).all() for one in pool.map(counted, [13] * 24))


def test_nothing_is_no_work() -> None:
    share_out(lambda start, stop: pytest.fail("work"), 0, 10, SilentMonitor())


def test_a_cancel_ends_it_before_the_next_range() -> None:
    done: list[int] = []
    with pytest.raises(Cancelled):
        share_out(lambda start, stop: done.append(start), 1_000, 1, CancelledAfter(20))
    assert len(done) < 25


def test_what_a_range_raises_is_raised() -> None:
    def work(start: int, stop: int) -> None:
        if start <= 7 < stop:
            raise ArithmeticError(start)

    with pytest.raises(ArithmeticError):
        share_out(work, 20, 1, SilentMonitor())
    assert (counted() == 1).all()
