"""Times of what is compared: one after the other in turns, judged by medians."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence

import numpy as np

TimedCall = Callable[[], object]


def seconds_of(act: TimedCall) -> float:
    """How long a call takes."""
    start = time.perf_counter()
    act()
    return time.perf_counter() - start


def median_seconds(act: TimedCall, repeats: int) -> float:
    """The median of so many calls."""
    return statistics.median(seconds_of(act) for _ in range(repeats))


def alternating(acts: Sequence[TimedCall], repeats: int) -> list[float]:
    """The median seconds of each of several acts that take turns, so that all meet the same day.

    Each is done once before, unmeasured: kernels are compiled, files are in memory.
    """
    for act in acts:
        act()
    rounds = [[seconds_of(act) for act in acts] for _ in range(repeats)]
    return [statistics.median(column) for column in zip(*rounds, strict=True)]


def percentile(values: Sequence[float], percent: float) -> float:
    """The value that so many of a hundred don't exceed."""
    return float(np.percentile(np.asarray(values), percent))
