"""Tracks of steps along the vehicle's path, and tracks joined over what hides them: chains."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_profile import PassSteps, StepSettings
from processing.methods.road.curbs.steps.link_kernels import (
    END_COLUMNS,
    ends_kernel,
    joins_kernel,
    link_kernel,
)
from processing.methods.road.curbs.steps.step_columns import (
    LOWER_ACROSS,
    LOWER_HEIGHT,
    SECTION,
    SIGN,
    SIGNIFICANCE,
    UPPER_ACROSS,
    UPPER_HEIGHT,
)

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

WITHIN_M = 0.8
"""Longest gap within a track, eight scanlines: a sign's post or some pulses lost on a wet curb.
Longer ones are judged by what goes before and after. By trial: no measurement is recorded."""

_FEWEST = 5
"""Steps of a track: half a metre of a curb, half of what a lone one must have (`LEAST_LENGTH_M` of
`curb_filters`), since tracks are joined."""

_USUAL_SPACING_M = 0.1
"""Between scanlines where there is only one: that of `ScanlineSettings`."""

_ROOM = 8
"""Pairs of ends for each track for which there is room at first; where there are more the tables
are made anew."""


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


def chains_of(steps: PassSteps, settings: StepSettings) -> Iterator[Chain]:
    """Chains of one pass."""
    table = steps.table
    if not table.shape[0]:
        return
    order, bounds = _tracks(steps)
    tracks = [order[begin:end] for begin, end in bounds]
    following = dict(_joins(steps, (order, bounds), settings))
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
    order = np.lexsort((-table[rows, SIGNIFICANCE], table[rows, SECTION]))
    sections = table[rows[order], SECTION]
    is_first = np.append(True, np.diff(sections) > 0)
    kept: Integers = rows[order[is_first]]
    return kept


def _tracks(steps: PassSteps) -> tuple[Integers, Integers]:
    """Rows of the table that are followed without a gap: all of them, and (t, 2) their bounds."""
    table = steps.table
    number = np.empty(table.shape[0], np.int64)
    spacing = (
        float(np.median(np.diff(steps.stations_m)))
        if steps.stations_m.size > 1
        else _USUAL_SPACING_M
    )
    parts = [_middles(table), table[:, LOWER_HEIGHT], table[:, UPPER_HEIGHT], table[:, SIGN]]
    count = link_kernel(
        steps.sections,
        np.column_stack(parts),
        spacing,
        WITHIN_M,
        number,
    )
    order = np.argsort(number, kind="stable")
    bounds = np.searchsorted(number[order], np.arange(count + 1))
    is_long = np.diff(bounds) >= _FEWEST
    return order, np.column_stack([bounds[:-1][is_long], bounds[1:][is_long]])


def _middles(table: Floats) -> Floats:
    middles: Floats = (table[:, LOWER_ACROSS] + table[:, UPPER_ACROSS]) / 2
    return middles


def _joins(
    steps: PassSteps, tracks: tuple[Integers, Integers], settings: StepSettings
) -> list[tuple[int, int]]:
    """Which track goes on as which: the best fitting ends first, each end once."""
    table, (rows, bounds) = steps.table, tracks
    ends = np.empty((bounds.shape[0], 2, END_COLUMNS))
    stations = steps.stations_m[steps.sections]
    ends_kernel(
        stations, np.column_stack([_middles(table), table[:, LOWER_HEIGHT]]), rows, bounds, ends
    )
    costs, pairs = _pairs(ends, table[rows[bounds[:, 0]], SIGN], settings.join_m)
    left, right, joined = set(), set(), []
    for i, j in pairs[np.lexsort((pairs[:, 1], pairs[:, 0], costs))].tolist():
        if i not in left and j not in right:
            left.add(i)
            right.add(j)
            joined.append((i, j))
    return joined


def _pairs(ends: Floats, signs: Floats, join_m: float) -> tuple[Floats, Integers]:
    room = _ROOM * signs.size
    while True:
        costs, pairs = np.empty(room), np.empty((room, 2), np.int64)
        count = joins_kernel(ends, signs, join_m, costs, pairs)
        if count <= room:
            return costs[:count], pairs[:count]
        room = count
