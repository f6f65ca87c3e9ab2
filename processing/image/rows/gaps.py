"""What to make of pulses without a point: missing returns stay empty, stops are closed up.

People scroll over a stop without a hole (compressed), algorithms see where it was (split by
segment): Takahashi 2022, section 3.5.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.image.rows.rows_of_kind import RowPlan

STOP_S = 1.0
"""A longer time without a point is a stop, a shorter one missing returns: open sky lasts a fraction
of a revolution. As `LONGEST_MISSING_S` of `pulse_clock`."""


def close_gaps(
    plan: RowPlan,
    row_starts: NDArray[np.int64],
    pulses: NDArray[np.int64],
    pulses_per_stop: float,
) -> tuple[RowPlan, NDArray[np.int64]]:
    """A plan without the empty rows of stops; a new segment begins after each stop.

    Parameters
    ----------
    row_starts : (rows + 1,) int64
        Where the points of each row begin.
    pulses : (n,) int64
        Pulse of every point, not decreasing.
    pulses_per_stop : float
        More pulses than this without a point are a stop.

    Returns
    -------
    RowPlan
    (rows + 1,) int64
        Where the points of its rows begin.
    """
    if not plan.first_pulses.size:
        return plan, row_starts
    counts = np.diff(row_starts)
    is_kept = np.ones(counts.size, dtype=np.bool_)
    begins = np.zeros(counts.size, dtype=np.bool_)
    for first, end in _runs(counts == 0):
        begin = row_starts[first]
        is_at_end = begin in (0, pulses.size)
        if is_at_end or pulses[begin] - pulses[begin - 1] > pulses_per_stop:
            is_kept[first:end] = False
            begins[min(end, counts.size - 1)] = not is_at_end
    changes = np.diff(plan.segments, prepend=plan.segments[:1]) != 0
    segments = np.cumsum(changes | begins).astype(np.int32)
    return plan.kept(is_kept, segments), row_starts[np.append(is_kept, True)]


def _runs(is_empty: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Start and stop of each run of True."""
    edges = np.flatnonzero(np.diff(is_empty, prepend=False, append=False))
    return [(int(first), int(end)) for first, end in edges.reshape(-1, 2)]
