"""Stretches of strips that are barriers, and the lines of their feet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.methods.road.barriers.barrier_facts import (
    VehicleWay,
    WindowFacts,
    facts_below,
)
from processing.methods.road.barriers.barrier_types import (
    BarrierLayers,
    BarrierType,
    layers_of,
    posts_of,
    rails_of,
    type_of,
)
from processing.methods.road.barriers.fact_kernels import RAIL_LAYER
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

_BRIDGED_M, _SAME_TOP_M, _OTHER_TOP_M = 6.0, 0.12, 0.3
"""Gaps that are bridged between stretches so alike in height, and a step that parts two of them."""

_SMOOTH = 8
"""Columns to both sides that tell with one where the line lies: 2 m."""

_POST_M, _BEAM_M = 0.045, 0.06
"""From the seen side of a post to its axis, and from the seen side of a beam to its posts' axis:
posts are 11 to 14 cm thick, and beams hang 7 to 15 cm before their axis."""

_FARTHEST_M = 0.09
"""What seems to stand farther behind a beam isn't its posts: a plant."""

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


class LikelyWindow(NamedTuple):
    """A window of a strip: its columns, the likeliest of its facts, and their chance."""

    first: int
    last: int
    facts: WindowFacts
    chance: float


class _Columns(NamedTuple):
    """Of each column of a strip: the mean chance of its windows, and their usual top, m."""

    chance: Floats
    top_m: Floats

    @staticmethod
    def of(count: int, windows: Sequence[LikelyWindow]) -> _Columns:
        total, number, weight, tops = (np.zeros(count) for _ in range(4))
        for one in windows:
            part = slice(one.first, one.last)
            total[part] += one.chance
            number[part] += 1
            weight[part] += one.chance + 1e-6
            tops[part] += (one.chance + 1e-6) * one.facts.top
        return _Columns(total / np.maximum(number, 1), tops / np.maximum(weight, 1e-9))


def stretches_of(
    profile: StripProfile, windows: Sequence[LikelyWindow], way: VehicleWay
) -> list[BarrierStretch]:
    """The stretches of a strip that are barriers.

    Notes
    -----
    1. A column is one of a barrier where its windows mostly are.
    2. What is unlikely between two likely stretches of the same height belongs to them, as far as
       something is filled up to their height: a pole or a plant stands before it.
    3. Stretches end where a metre shows nothing, or their height changes.
    """
    columns = _Columns.of(len(profile.counts), windows)
    is_likely = _bridged(columns)
    found = []
    for part in _pieces(columns, is_likely):
        top_m = float(np.median(columns.top_m[part]))
        layers = slice(RAIL_LAYER, round(top_m / LAYER_M) + 1)
        filled = part[(profile.counts[part, layers] > 0).any(axis=1)]
        cuts = np.flatnonzero(np.diff(filled) * COLUMN_M > _LONGEST_GAP_M) + 1
        found += [
            _stretch(profile, one, (top_m, float(columns.chance[one].mean())), way)
            for one in np.split(filled, cuts)
            if one.size > 1
        ]
    return found


def _bridged(columns: _Columns) -> Flags:
    """Which columns are likely, with short gaps between likely ones of the same height."""
    is_likely = columns.chance >= _LEAST_CHANCE
    ends = np.flatnonzero(np.diff(np.r_[False, is_likely, False].astype(np.int8)))
    for last, first in zip(ends[1:-1:2], ends[2::2], strict=True):
        before, after = columns.top_m[last - 1], columns.top_m[first]
        if (first - last) * COLUMN_M <= _BRIDGED_M and abs(before - after) <= _SAME_TOP_M:
            is_likely[last:first] = True
            columns.top_m[last:first] = (before + after) / 2
    return is_likely


def _pieces(columns: _Columns, is_likely: Flags) -> list[Integers]:
    """Likely columns that follow each other and are about as high."""
    likely = np.flatnonzero(is_likely)
    if likely.size == 0:
        return []
    apart = np.diff(likely) > 1
    steps = np.abs(np.diff(columns.top_m[likely])) > _OTHER_TOP_M
    return np.split(likely, np.flatnonzero(apart | steps) + 1)


def _stretch(
    profile: StripProfile, columns: Integers, known: tuple[float, float], way: VehicleWay
) -> BarrierStretch:
    top_m, chance = known
    facts = facts_below(profile, int(columns[0]), int(columns[-1]) + 1, top_m)
    chosen = np.zeros(len(profile.counts), np.bool_)
    chosen[columns] = True
    layers = layers_of(profile, chosen, facts)
    sort = type_of(layers, facts)
    line = _foot_line(profile, columns, (layers, sort), way)
    posts = posts_of(profile, chosen, layers)
    return BarrierStretch(profile, columns, facts, chance, sort, posts, line)


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
            behind = min(abs(post - beam) + _POST_M, _FARTHEST_M)
            return aside + math.copysign(behind, post - beam)
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
