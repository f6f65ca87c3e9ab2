"""What to make of pulses without a point: missing returns stay empty, stops are closed up.

People scroll over a stop without a hole (compressed), algorithms see where it was (split by
segment): specification 3.5.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.image.rows_of_kind import RowPlan

STOP_S = 1.0
"""A longer time without a point is a stop, a shorter one missing returns."""


def closed_up(plan: RowPlan, pulses: NDArray[np.int64], pulses_per_stop: float) -> RowPlan:
    """A plan without the empty rows of stops; a new segment begins after each stop.

    Parameters
    ----------
    pulses : (n,) int64
        Pulse of every point, not decreasing.
    pulses_per_stop : float
        More pulses than this without a point are a stop.
    """
    if not plan.first_pulses.size:
        return plan
    counts = np.diff(row_starts_of(plan, pulses))
    is_kept = np.ones(counts.size, dtype=np.bool_)
    begins = np.zeros(counts.size, dtype=np.bool_)
    for first, end in _runs(counts == 0):
        begin = np.searchsorted(pulses, plan.first_pulses[first])
        is_at_end = begin in (0, pulses.size)
        if is_at_end or pulses[begin] - pulses[begin - 1] > pulses_per_stop:
            is_kept[first:end] = False
            begins[min(end, counts.size - 1)] = not is_at_end
    changes = np.diff(plan.segments, prepend=plan.segments[:1]) != 0
    segments = np.cumsum(changes | begins).astype(np.int32)
    return plan.kept(is_kept, segments)


def row_starts_of(plan: RowPlan, pulses: NDArray[np.int64]) -> NDArray[np.int64]:
    """(rows + 1,) int64: where the points of each row begin."""
    starts = np.searchsorted(pulses, plan.first_pulses)
    return np.append(starts, pulses.size).astype(np.int64)


def _runs(is_empty: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Start and stop of each run of True."""
    edges = np.flatnonzero(np.diff(is_empty, prepend=False, append=False))
    return [(int(first), int(end)) for first, end in edges.reshape(-1, 2)]
