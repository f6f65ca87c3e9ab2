"""Stretches of strips that are barriers, and the lines of their feet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.barriers.barrier_facts import (
    FactWindow,
    VehicleWay,
    WindowFacts,
    facts_between,
)
from processing.methods.road.barriers.barrier_types import (
    BarrierLayers,
    BarrierType,
    layers_of,
    posts_of,
    rails_of,
    type_of,
)
from processing.methods.road.barriers.strip_kernels import STEP_M
from processing.methods.road.barriers.strip_profiles import (
    COLUMN_M,
    LAYER_M,
    StripProfile,
    ways_of,
)

_LEAST_CHANCE = 0.5
"""Of a column's windows in the mean, from which it is one of a barrier."""

_LONGEST_GAP_M = 1.0
"""Columns without points: what stands before a barrier hides so much of it."""

_SMOOTH = 8
"""Columns to both sides that tell with one where the line lies: 2 m."""

_POST_M, _BEAM_M = 0.045, 0.1
"""From the seen side of a post to its axis, and from the seen side of a beam to its posts' axis:
posts are 11 to 14 cm thick, and beams hang 7 to 15 cm before their axis."""

_FEWEST_CELLS, _LEAST_DEEP_M = 6, 0.015
"""Cells in which posts are seen below a beam, and how far behind it they stand at least."""

_NEAR_M = 0.1
"""Columns that lie farther from the middle of those about them are of something else."""

_STRAIGHT_M = 0.01


class BarrierStretch(NamedTuple):
    """A stretch of a strip that is a barrier.

    Attributes
    ----------
    profile : StripProfile
    columns : (k,) int64
        Of its profile, rising, those in which something of it was measured.
    facts : WindowFacts
        Of the whole stretch.
    chance : float
    type : str
    posts_m : float or None
    line : (n, 3) float64
        Its foot, m about the origin of the plan.
    """

    profile: StripProfile
    columns: Integers
    facts: WindowFacts
    chance: float
    type: BarrierType
    posts_m: float | None
    line: Floats

    @property
    def long_m(self) -> float:
        """Its length in plan."""
        return float(np.hypot(*np.diff(self.line[:, :2], axis=0).T).sum())


def stretches_of(
    profile: StripProfile, windows: Sequence[tuple[FactWindow, float]], way: VehicleWay
) -> list[BarrierStretch]:
    """The stretches of a strip that are barriers.

    Parameters
    ----------
    windows : sequence of (FactWindow, float)
        With the chance of each.
    """
    chance = column_chances(len(profile.counts), windows)
    is_filled = profile.counts[:, 6:48].any(axis=1) & (chance >= _LEAST_CHANCE)
    filled = np.flatnonzero(is_filled)
    found = []
    cuts = np.flatnonzero(np.diff(filled) * COLUMN_M > _LONGEST_GAP_M) + 1
    for columns in np.split(filled, cuts):
        if columns.size > 1:
            one = _stretch(profile, columns, chance, way)
            found += [one] if one is not None else []
    return found


def column_chances(count: int, windows: Sequence[tuple[FactWindow, float]]) -> Floats:
    """(c,) the mean chance of the windows over each column; 0 where there are none."""
    total, number = np.zeros(count), np.zeros(count)
    for window, chance in windows:
        total[window.first : window.last] += chance
        number[window.first : window.last] += 1
    return np.asarray(total / np.maximum(number, 1))


def _stretch(
    profile: StripProfile, columns: Integers, chance: Floats, way: VehicleWay
) -> BarrierStretch | None:
    found = facts_between(profile, int(columns[0]), int(columns[-1]) + 1, (0.0, 0.5))
    if found is None:
        return None
    facts = found[0]
    chosen = np.zeros(len(profile.counts), np.bool_)
    chosen[columns] = True
    layers = layers_of(profile, chosen, facts)
    sort = type_of(layers, facts)
    line = _foot_line(profile, columns, (layers, sort), way)
    posts = posts_of(profile, chosen, layers)
    return BarrierStretch(profile, columns, facts, float(chance[columns].mean()), sort, posts, line)


def _foot_line(
    profile: StripProfile,
    columns: Integers,
    known: tuple[BarrierLayers, BarrierType],
    way: VehicleWay,
) -> Floats:
    """The line on the ground on which it stands, from end to end."""
    import shapely

    layers, sort = known
    chosen = slice(int(columns[0]), int(columns[-1]) + 1)
    aside = _aside(profile, chosen, layers, sort)
    if sort == "guard_rail":
        aside = _to_posts(profile, chosen, layers, aside, way)
    at = (np.arange(chosen.start, chosen.stop) * COLUMN_M) / STEP_M
    numbers = np.arange(len(profile.nodes))
    ways = ways_of(profile.nodes)
    place, way_there = (
        np.column_stack([np.interp(at, numbers, axis) for axis in values.T])
        for values in (profile.nodes, ways)
    )
    plan = place + aside[:, None] * np.column_stack([-way_there[:, 1], way_there[:, 0]])
    line = np.column_stack([plan, np.interp(at, numbers, profile.foot)])
    return np.asarray(
        shapely.get_coordinates(shapely.LineString(line).simplify(_STRAIGHT_M), include_z=True)
    )


def _aside(
    profile: StripProfile, chosen: slice, layers: BarrierLayers, sort: BarrierType
) -> Floats:
    """How far to the left of the strip's middle it stands, column by column."""
    first = layers.top - 2 if sort == "parapet" else 4
    part = slice(max(first, 4), layers.top + 2)
    return _smoothed(
        profile.aside[chosen, part].sum(axis=1), profile.counts[chosen, part].sum(axis=1)
    )


def _to_posts(
    profile: StripProfile,
    chosen: slice,
    layers: BarrierLayers,
    aside: Floats,
    way: VehicleWay,
) -> Floats:
    """From a beam to the axis of the posts that it hangs on."""
    rails = rails_of(layers)
    below = slice(3, max(4, rails[0][0] - 1 if rails else 6))
    beam = float(np.median(aside))
    counts = profile.counts[chosen, below]
    seen = counts > 0
    if seen.sum() >= _FEWEST_CELLS:
        post = float(np.median(profile.aside[chosen, below][seen] / counts[seen]))
        if abs(post - beam) > _LEAST_DEEP_M:
            return aside + (post - beam + math.copysign(_POST_M, post - beam))
    return aside + _BEAM_M * _away(profile, chosen, way)


def _away(profile: StripProfile, chosen: slice, way: VehicleWay) -> float:
    """1 if the vehicle's way lies to the right of a strip, −1: to the left, 0: unknown."""
    middle = min(int((chosen.start + chosen.stop) / 2 * COLUMN_M / STEP_M), len(profile.nodes) - 1)
    near = way.nearest(profile.nodes[middle : middle + 1])
    if near is None:
        return 0.0
    to_way = near[0][0] - profile.nodes[middle]
    own = ways_of(profile.nodes)[middle]
    return -float(np.sign(own[0] * to_way[1] - own[1] * to_way[0]))


def _smoothed(sums: Floats, counts: Floats) -> Floats:
    """Means of columns, each with those about it, along a line through them."""
    result = np.zeros(len(sums))
    known = np.flatnonzero(counts > 0)
    means = sums[known] / counts[known]
    for column in range(len(sums)):
        low, high = np.searchsorted(known, [column - _SMOOTH, column + _SMOOTH + 1])
        if high - low < 1:
            continue
        t, v = known[low:high] - column, means[low:high]
        middle = np.median(v)
        kept = np.abs(v - middle) <= max(_NEAR_M, float(np.abs(v - middle).min()))
        t, v = t[kept], v[kept]
        spread = ((t - t.mean()) ** 2).sum()
        slope = ((t - t.mean()) * (v - v.mean())).sum() / spread if spread > 0 else 0.0
        result[column] = v.mean() - slope * t.mean()
    return result


def height_of(stretch: BarrierStretch) -> float:
    """How high its top lies above its foot, m: the middle of what its columns show."""
    local = stretch.profile.local
    column = (local[:, 0] / COLUMN_M + 0.5).astype(np.int64)
    top = stretch.facts.top
    chosen = (
        np.isin(column, stretch.columns)
        & (np.abs(local[:, 1]) < 0.25)
        & (local[:, 2] > top - 2 * LAYER_M)
        & (local[:, 2] < top + 2 * LAYER_M)
    )
    if not chosen.any():
        return top
    highest = np.full(len(stretch.profile.counts), -np.inf)
    np.maximum.at(highest, column[chosen], local[chosen, 2])
    return float(np.median(highest[np.isfinite(highest)]))
