"""Which delivered points are returns of one pulse, and how they share packets of samples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers

HALF_LIGHT_M_NS = 0.149896229
"""Range that light covers there and back in a nanosecond, in vacuum."""

SAMPLES, FIRST_SAMPLE_NS = 160, 12.5
"""Of a packet, 1 ns apart, and where its first return lies (Shinohara 2022, section 3.2: 160)."""

LAST_NS = SAMPLES - FIRST_SAMPLE_NS
"""After the first return: a return farther on lies behind the packet's end and begins its own."""


class GroupedReturns(NamedTuple):
    """Points in the order of pulses and ranges, and the packets they lie in.

    ``order`` (n,) int64: the points as they were given; ``packet`` (n,) int64, rising from 0;
    ``after_ns`` (n,) float32, after the packet's first return; ``owner`` (k,) int64: where in
    ``order`` each packet's first return is.
    """

    order: Integers
    packet: Integers
    after_ns: NDArray[np.float32]
    owner: Integers


def packets_of_returns(xyz: Floats, time: Floats, number: NDArray[np.uint8]) -> GroupedReturns:
    """Returns that were measured at the same time are of one pulse.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    time : (n,) float64
        s; not a number where it isn't known: such a point is a pulse of its own.
    number : (n,) uint8
        Which of its pulse's returns each is; all 0 where that wasn't delivered.
    """
    order = np.lexsort((number, time))
    times, numbers = time[order], number[order].astype(np.int64)
    is_new = np.ones(order.size, np.bool_)
    # Pulses without a number, and two scanners at the same instant, are told apart by it.
    is_new[1:] = ~(times[1:] == times[:-1]) | (numbers[1:] <= numbers[:-1])
    placed = xyz[order]
    first = np.flatnonzero(is_new)
    for _ in range(_MOST_PACKETS):
        owner = first[np.cumsum(is_new) - 1]
        after = np.linalg.norm(placed - placed[owner], axis=1) / HALF_LIGHT_M_NS
        late = after > LAST_NS
        late[1:] &= ~late[:-1] | is_new[1:]
        if not late.any():
            break
        is_new |= late
        first = np.flatnonzero(is_new)
    packet = np.cumsum(is_new) - 1
    return GroupedReturns(order, packet, after.astype(np.float32), first)


_MOST_PACKETS = 16
"""Of one pulse: LAS counts 15 returns."""
