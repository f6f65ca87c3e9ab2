"""Tracks of steps along the way, and tracks joined over what hides them: chains."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from processing.road.curb_profile import PassSteps, StepSettings
from processing.road.link_kernels import link_kernel
from processing.road.step_columns import (
    LOWER_ACROSS,
    LOWER_HEIGHT,
    SECTION,
    SIGN,
    SURENESS,
    UPPER_ACROSS,
    UPPER_HEIGHT,
)

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

WITHIN_M = 0.8
"""Longest gap within a track; longer ones are judged by what goes before and after."""

_FEWEST = 5
_END_M = 3.0  # what tells the direction of an end
_OFF_M, _OFF_PER_M = 0.05, 0.04
_TURN = 0.12
_HIGH_M, _HIGH_PER_M = 0.05, 0.03
_BESIDE_M = 3.0  # tracks of one low step may go on beside each other
_LONG_M = 8.0
"""Longest gap that is bridged where both sides lie on one straight line: a parked lorry."""


@dataclass(frozen=True)
class Chain:
    """Steps that are one curb.

    Attributes
    ----------
    rows : (k,) int64
        Of the steps' table, one of a scanline, in order.
    sign : int
        1: the ground rises to the right.
    """

    rows: Integers
    sign: int


@dataclass(frozen=True)
class _End:
    """One end of a track: a straight line over the last metres."""

    station: float
    across: float
    slope: float
    lower: float
    upper: float
    length_m: float


def chains_of(steps: PassSteps, settings: StepSettings) -> Iterator[Chain]:
    """Chains of one pass."""
    table = steps.table
    if not table.shape[0]:
        return
    tracks = _tracks(steps)
    pairs = _joins(steps, tracks, settings)
    following = dict(pairs)
    begun = set(following.values())
    for first in range(len(tracks)):
        if first in begun:
            continue
        rows = [tracks[first]]
        at = first
        while at in following:
            at = following[at]
            rows.append(tracks[at])
        sign = int(table[tracks[first][0], SIGN])
        yield Chain(_in_order(table, np.concatenate(rows)), sign)


def _in_order(table: Floats, rows: Integers) -> Integers:
    """Rows in the order of their scanlines, of two of one scanline the surer."""
    order = np.lexsort((-table[rows, SURENESS], table[rows, SECTION]))
    sections = table[rows[order], SECTION]
    is_first = np.append(True, np.diff(sections) > 0)
    kept: Integers = rows[order[is_first]]
    return kept


def _tracks(steps: PassSteps) -> list[Integers]:
    """Rows of the table that are followed without a gap."""
    table = steps.table
    number = np.empty(table.shape[0], np.int64)
    spacing = float(np.median(np.diff(steps.stations_m))) if steps.stations_m.size > 1 else 0.1
    middle = (table[:, LOWER_ACROSS] + table[:, UPPER_ACROSS]) / 2
    parts = [middle, table[:, LOWER_HEIGHT], table[:, UPPER_HEIGHT], table[:, SIGN]]
    count = link_kernel(
        table[:, SECTION].astype(np.int64),
        np.column_stack(parts),
        np.array([spacing, WITHIN_M]),
        number,
    )
    order = np.argsort(number, kind="stable")
    bounds = np.searchsorted(number[order], np.arange(count + 1))
    return [order[begin:end] for begin, end in pairwise(bounds) if end - begin >= _FEWEST]


def _joins(
    steps: PassSteps, tracks: list[Integers], settings: StepSettings
) -> list[tuple[int, int]]:
    """Which track goes on as which: the best fitting ends first, each end once."""
    heads = [_end_of(steps, rows, last=False) for rows in tracks]
    tails = [_end_of(steps, rows, last=True) for rows in tracks]
    signs = [steps.table[rows[0], SIGN] for rows in tracks]
    starts = np.array([head.station for head in heads])
    order = np.argsort(starts)
    found = []
    for i, tail in enumerate(tails):
        low = np.searchsorted(starts[order], tail.station - _BESIDE_M)
        high = np.searchsorted(starts[order], tail.station + _LONG_M, side="right")
        for j in order[low:high]:
            if i != j and signs[i] == signs[j]:
                cost = _misfit(tail, heads[j], settings)
                is_later = starts[i] < starts[j] and tail.station < tails[j].station
                if cost < 1 and is_later:
                    found.append((cost + abs(heads[j].station - tail.station), i, int(j)))
    left, right, pairs = set(), set(), []
    for _, i, j in sorted(found):
        if i not in left and j not in right:
            left.add(i)
            right.add(j)
            pairs.append((i, j))
    return pairs


def _end_of(steps: PassSteps, rows: Integers, *, last: bool) -> _End:
    at = steps.stations_m[steps.table[rows, SECTION].astype(np.int64)]
    station = at[-1] if last else at[0]
    near = np.abs(at - station) <= _END_M
    part = steps.table[rows[near]]
    across = (part[:, LOWER_ACROSS] + part[:, UPPER_ACROSS]) / 2
    away = at[near] - station
    middle = away.mean()
    spread = float(((away - middle) ** 2).sum())
    # A short end tells no direction: held along the way, within some degrees.
    slope = float(((away - middle) * across).sum() / (spread + 0.3))
    few = max(3, min(10, part.shape[0]))
    close = part[-few:] if last else part[:few]
    return _End(
        float(station),
        float(across.mean() - slope * middle),
        slope,
        float(np.median(close[:, LOWER_HEIGHT])),
        float(np.median(close[:, UPPER_HEIGHT])),
        float(at[-1] - at[0]),
    )


def _misfit(tail: _End, head: _End, settings: StepSettings) -> float:
    """How badly two ends fit each other: 1 is the most."""
    half = (head.station - tail.station) / 2
    gap = abs(2 * half)
    off = abs(tail.across + tail.slope * half - head.across + head.slope * half)
    turn = abs(tail.slope - head.slope)
    most_off, most_turn = _OFF_M + _OFF_PER_M * min(gap, settings.join_m), _TURN
    if gap > settings.join_m:
        if min(tail.length_m, head.length_m) < gap / 3:
            return 2.0
        most_turn = _TURN / 2
    if gap < 1.0:
        most_turn = 3 * _TURN
    low = abs(tail.lower - head.lower) / (_HIGH_M + _HIGH_PER_M * gap)
    return max(off / most_off, turn / most_turn, low)
