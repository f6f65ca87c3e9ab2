"""What speaks for a barrier: facts of windows along strips, from their profiles."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.methods.road.barriers.fact_kernels import (
    LOW_LAYER,
    MOST_TOPS,
    RAIL_LAYER,
    LayerSums,
    ends_kernel,
    layers_kernel,
    leaning_kernel,
    tops_kernel,
)
from processing.methods.road.barriers.raised_cells import LOWEST_M, SLAB_M, SLABS
from processing.methods.road.barriers.strip_kernels import STEP_M
from processing.methods.road.barriers.strip_profiles import (
    COLUMN_M,
    LAYER_M,
    LAYERS,
    StripProfile,
    ways_of,
)

WINDOW, STRIDE = 12, 4
"""Columns: 3 m every metre; posts stand 2 to 4 m apart."""

_LEAST_SHARE = 0.2
"""Of the columns, that the fullest layer fills at least."""

_ROUGH_M, _TOE_M, _FAR_M = 0.05, 0.1, 20.0
_MOST_ROUGH, _MOST_RISE_M, _MOST_BANKED = 2.0, 1.5, 1.2
_LEAST_BESIDE_M = 0.7

_HIGH_BITS = np.uint32((1 << SLABS) - (1 << round((2.6 - LOWEST_M) / SLAB_M)))

_SAME_TOP_M, _MOST_WINDOWS = 0.11, 24
_SHORTEST_M, _DOUBLINGS = 3.0, 4
"""From 3 m to 48 m: garden walls and vehicles end after some metres, barriers go on."""


class WindowFacts(NamedTuple):
    """Facts of 3 m of a strip; all but ``top`` 0 to 1 or a little more.

    Attributes
    ----------
    top : float
        How high it stands above its foot, m.
    full : float
        Share of its columns in which something stands between 0.3 m and its top.
    even : float
        Share of those whose top is as high as the strip's, to 7 cm.
    over : float
        Share of columns with points above it.
    fill : float
        How full the layers between 0.15 m and its top are, over the fullest.
    low : float
        The same of those up to 0.3 m.
    rows : float
        How much the layers differ: rails are full, what lies between them is empty.
    rough : float
        Spread of its columns about a plane, layer by layer, over 5 cm.
    lean : float
        How far a layer lies aside for each metre that it lies higher.
    toe : float
        How far its foot stands in front of what is above, over 0.1 m: concrete of safety shape.
    through : float
        Share of the ground from 0.3 to 1.5 m beside it that was seen, on the darker side.
    free, hidden : float
        Share of its nodes with something beside it as high as it is, on the freer and the other
        side.
    roofed : float
        Share of its nodes with something higher than 2.6 m beside it: houses, crowns.
    rise : float
        How much higher the ground is on one side than on the other, m.
    banked : float
        How high the ground on its higher side lies above its foot, over its own height: land is
        held by a wall, and lies as high as it.
    across : float
        Sine of the angle between it and the nearest stretch of the vehicle's way; 0: unknown.
    far : float
        From there, over 20 m, at most 1; a half: unknown.
    long : float
        How far it goes on with the same top: 0 for 3 m, 1 for 48 m, by the logarithm.
    """

    top: float
    full: float
    even: float
    over: float
    fill: float
    low: float
    rows: float
    rough: float
    lean: float
    toe: float
    through: float
    free: float
    hidden: float
    roofed: float
    rise: float
    banked: float
    across: float
    far: float
    long: float = 0.0


class FactWindow(NamedTuple):
    """A window of a strip.

    Attributes
    ----------
    first, last : int
        Its first column and the one after its last.
    options : tuple of WindowFacts
        One for each layer that may be the top of what stands there.
    """

    first: int
    last: int
    options: tuple[WindowFacts, ...]


class VehicleWay:
    """The way of the vehicle, asked for its distance and direction.

    Parameters
    ----------
    places : (n, 2) float64
        Half a metre apart, m about the origin of the plan; none without a trajectory.
    """

    def __init__(self, places: Floats) -> None:
        from scipy.spatial import cKDTree

        self._places = places
        self._tree: Any = cKDTree(places) if len(places) > 1 else None  # scipy has no stub

    def nearest(self, nodes: Floats) -> tuple[Floats, Floats] | None:
        """The way's nearest place to each of (n, 2) nodes and its direction; None: no way."""
        if self._tree is None:
            return None
        number = np.asarray(self._tree.query(nodes)[1])
        before, after = np.maximum(number - 1, 0), np.minimum(number + 1, len(self._places) - 1)
        ways = self._places[after] - self._places[before]
        return self._places[number], ways / np.maximum(np.hypot(*ways.T), 1e-9)[:, None]


def windows_of(profile: StripProfile, way: VehicleWay) -> list[FactWindow]:
    """The windows of a strip, one for a short one; none where nothing stands."""
    windows = list(_windows_alone(profile, way))
    return [
        one._replace(
            options=tuple(
                facts._replace(long=_long_of(windows, number, facts.top)) for facts in one.options
            )
        )
        for number, one in enumerate(windows)
    ]


def _long_of(windows: Sequence[FactWindow], number: int, top: float) -> float:
    """How far something goes on about a window with the same top, as a fact."""
    ends = []
    for step in (-1, 1):
        at, high = number, top
        for _ in range(_MOST_WINDOWS):
            if not 0 <= at + step < len(windows):
                break
            if abs(windows[at + step].first - windows[at].first) > STRIDE:
                break
            others = [abs(one.top - high) for one in windows[at + step].options]
            if min(others) > _SAME_TOP_M:
                break
            at += step
            high = windows[at].options[int(np.argmin(others))].top
        ends.append(at)
    long_m = (windows[ends[1]].last - windows[ends[0]].first) * COLUMN_M
    return min(max(math.log2(long_m / _SHORTEST_M), 0.0) / _DOUBLINGS, 1.0)


def _windows_alone(profile: StripProfile, way: VehicleWay) -> Iterator[FactWindow]:
    columns = len(profile.counts)
    across, far = _to_way(profile, way)
    tops = np.zeros(MOST_TOPS, np.int64)
    for start in range(0, max(1, columns - WINDOW + STRIDE), STRIDE):
        last = min(start + WINDOW, columns)
        first = max(0, last - WINDOW)
        window = _ProfileWindow.of(profile, first, last)
        if float(window.share[RAIL_LAYER:].max()) < _LEAST_SHARE:
            continue
        node = min(int((first + last) / 2 * COLUMN_M / STEP_M), len(across) - 1)
        to_way = (float(across[node]), float(far[node]))
        count = tops_kernel(window.share, tops)
        options = tuple(window.facts(top, to_way) for top in tops[:count].tolist())
        yield FactWindow(first, last, options)


def _to_way(profile: StripProfile, way: VehicleWay) -> tuple[Floats, Floats]:
    near = way.nearest(profile.nodes)
    if near is None:
        return np.zeros(len(profile.nodes)), np.full(len(profile.nodes), 0.5)
    places, ways = near
    own = ways_of(profile.nodes)
    across = np.abs(own[:, 0] * ways[:, 1] - own[:, 1] * ways[:, 0])
    far = np.hypot(*(profile.nodes - places).T) / _FAR_M
    return across, np.minimum(far, 1.0)


def facts_below(profile: StripProfile, first: int, last: int, top_m: float) -> WindowFacts:
    """Facts of the columns of a strip whose top is known, wherever the vehicle drove."""
    top = max(round(top_m / LAYER_M) - 1, RAIL_LAYER)
    return _ProfileWindow.of(profile, first, last).facts(top, (0.0, 0.5))


class _ProfileWindow(NamedTuple):
    """Columns of a strip: its profile, which cells are filled, and the share of each layer."""

    profile: StripProfile
    first: int
    last: int
    filled: NDArray[np.bool_]
    share: Floats

    @staticmethod
    def of(profile: StripProfile, first: int, last: int) -> _ProfileWindow:
        filled = np.zeros((last - first, LAYERS), np.bool_)
        share = np.zeros(LAYERS)
        layers_kernel(profile.counts[first:last], filled, share)
        return _ProfileWindow(profile, first, last, filled, share)

    def facts(self, top: int, to_way: tuple[float, float]) -> WindowFacts:
        """Its facts if a layer is its top."""
        profile, columns = self.profile, slice(self.first, self.last)
        most = max(float(self.share[RAIL_LAYER : top + 1].max()), 1e-9)
        layers = np.minimum(self.share / most, 1.0)
        inside = layers[LOW_LAYER : top + 1]
        full, even, over = ends_kernel(self.filled, top)
        nodes = slice(
            int(self.first * COLUMN_M / STEP_M), int(np.ceil(self.last * COLUMN_M / STEP_M)) + 1
        )
        free, hidden, roofed = _beside(profile, nodes, top)
        rises = np.abs(profile.levels[nodes, 0] - profile.levels[nodes, 1])
        known = rises[np.isfinite(rises)]
        sums = LayerSums(profile.counts[columns], profile.aside[columns], profile.squares[columns])
        rough, lean, toe = leaning_kernel(sums, self.filled, top)
        return WindowFacts(
            top=(top + 1) * LAYER_M,
            full=full,
            even=even,
            over=over,
            fill=float(inside.mean()),
            low=float(layers[LOW_LAYER:RAIL_LAYER].mean()),
            rows=float(inside.std()),
            rough=min(rough / _ROUGH_M, _MOST_ROUGH),
            lean=min(abs(lean), 1.0),
            toe=min(toe / _TOE_M, 1.5),
            through=float(profile.lit[nodes].mean(axis=0).min()),
            free=free,
            hidden=hidden,
            roofed=roofed,
            rise=min(float(np.median(known)), _MOST_RISE_M) if known.size else 0.0,
            banked=self._banked(nodes, (top + 1) * LAYER_M),
            across=to_way[0],
            far=to_way[1],
        )

    def _banked(self, nodes: slice, top_m: float) -> float:
        levels = self.profile.levels[nodes] - self.profile.foot[nodes, None]
        known = levels[np.isfinite(levels).all(axis=1)]
        if len(known) == 0:
            return 0.0
        return min(max(float(np.median(known.max(axis=1))) / top_m, 0.0), _MOST_BANKED)


def _beside(profile: StripProfile, nodes: slice, top: int) -> tuple[float, float, float]:
    """Share of nodes with something beside them, on the freer side and on the other; or high."""
    high_m = max((top + 1) * LAYER_M, _LEAST_BESIDE_M)
    low, high = (round((one - LOWEST_M) / SLAB_M) for one in (RAIL_LAYER * LAYER_M, high_m))
    band = np.uint32((1 << min(high, SLABS - 1)) - 1) & ~np.uint32((1 << low) - 1)
    beside: NDArray[np.bool_] = (profile.filled[nodes] & band) > 0
    shares = beside.mean(axis=0)
    is_high: NDArray[np.bool_] = (profile.filled[nodes] & _HIGH_BITS) > 0
    return float(shares.min()), float(shares.max()), float(is_high.any(axis=1).mean())
