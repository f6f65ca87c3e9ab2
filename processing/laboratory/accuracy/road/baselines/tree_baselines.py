"""How others measure a trunk: the thesis' ways, on the points about a foot that is known.

References
----------
Takahashi 2022, 5.2 and 5.3: wires of the image cut every 5 mm, wires of a k-d tree, projection of
1.0 to 1.4 m into a plane.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.circle_kernels import (
    CIRCLE_WIDTH,
    MOST_CIRCLES,
    RADIUS,
    CircleLimits,
    circles_kernel,
)
from processing.methods.road.trees.stem_bodies import BREAST_M
from processing.methods.road.trees.stems import slab_circles, stems_of
from processing.methods.road.trees.trunks import trunk_of

MOST_DIAMETER_M = 1.2
"""As the tool's own parameter."""

_LOW_M, _HIGH_M, _STEP_M = 0.3, 2.5, 0.005
"""Planes that cut wires; the step is the thesis', the heights are this program's choice."""

_PROJECTED_M = (1.0, 1.4)
WIRE_M = 0.3
"""Longest wire: points farther apart are of two things (the thesis' own limit of grouping)."""

SKIPPED = 2
"""From a pixel to the next along a row: one empty pixel may lie between."""

WINDOW = 30
"""Columns to either side in the rows before and behind."""

_LINE_M = 0.01
"""Off the line through diameters."""

_FEWEST = 20
"""Circles on it."""

_CUT = CircleLimits(0.015, 0.2, 0.01, 5, 0.12, 10.0)
"""Circles of 3 to 40 cm as the thesis has them; what lies inside doesn't matter to it."""


class TrunkPoints(NamedTuple):
    """What was measured about a foot.

    Attributes
    ----------
    local : (n, 3) float64
        m about the foot.
    drives, pulses : (n,) int64
        Which drive each is of, and the pulse there; −1: not known.
    per_turn : tuple of int
        Pulses of a revolution, of each drive.
    """

    local: Floats
    drives: Integers
    pulses: Integers
    per_turn: tuple[int, ...]

    def of_drive(self, drive: int) -> TrunkPoints:
        """Those of one drive."""
        chosen = self.drives == drive
        return TrunkPoints(
            self.local[chosen], self.drives[chosen], self.pulses[chosen], self.per_turn
        )


def own_diameter(points: TrunkPoints) -> float:
    """As the tool measures."""
    trunk = trunk_of(stems_of(points.local, MOST_DIAMETER_M))
    return trunk.diameter_m if trunk is not None else math.nan


def diameter_by_one_circle(points: TrunkPoints) -> float:
    """As the tool measures, with one circle a slab."""
    trunk = trunk_of(stems_of(points.local, MOST_DIAMETER_M, most_circles=1))
    return trunk.diameter_m if trunk is not None else math.nan


def plain_diameter(points: TrunkPoints) -> float:
    """The best circle of the slab at 1.2 m."""
    slabs = slab_circles(points.local, MOST_DIAMETER_M)
    radius = slabs.circles[np.abs(slabs.heights - BREAST_M).argmin(), 0, RADIUS]
    return float(2 * radius) if radius > 0 else math.nan


def projected_diameter(points: TrunkPoints) -> float:
    """One circle through all that lies between 1.0 and 1.4 m, seen from above."""
    up = points.local[:, 2]
    plan = points.local[(up >= _PROJECTED_M[0]) & (up <= _PROJECTED_M[1]), :2]
    limits = CircleLimits(0.015, 10.0, 0.01, 5, 0.0, 10.0)
    circles = np.zeros((1, MOST_CIRCLES, CIRCLE_WIDTH))
    circles_kernel(np.ascontiguousarray(plan), np.array([0, len(plan)]), limits, circles)
    radius = circles[0, 0, RADIUS]
    return float(2 * radius) if radius > 0 else math.nan


def wire_diameter(points: TrunkPoints, wires: Integers) -> float:
    """Wires cut every 5 mm, a circle through each cut, and a line through the diameters."""
    levels, circles = cut_circles(points.local[wires])
    return diameter_at_breast(levels, 2 * circles[:, RADIUS])


def cut_circles(ends: Floats) -> tuple[Floats, Floats]:
    """Heights at which wires were cut, of those that gave a circle, and these circles.

    Parameters
    ----------
    ends : (m, 2, 3) float64
        Of each wire, m above the foot.

    Returns
    -------
    (k,) float64
    (k, CIRCLE_WIDTH) float64
    """
    levels = np.arange(_LOW_M, _HIGH_M, _STEP_M)
    low, high = ends[..., 2].min(axis=1), ends[..., 2].max(axis=1)
    order = np.argsort(low, kind="stable")
    ends, low, high = ends[order], low[order], high[order]
    longest = float((high - low).max(initial=0.0))
    parts: list[Floats] = []
    for level in levels.tolist():
        part = slice(*np.searchsorted(low, [level - longest, level], side="right").tolist())
        crosses = high[part] > level
        cut = ends[part][crosses]
        share = (level - cut[:, 0, 2]) / (cut[:, 1, 2] - cut[:, 0, 2])
        parts.append(cut[:, 0, :2] + share[:, None] * (cut[:, 1, :2] - cut[:, 0, :2]))
    starts = np.cumsum([0, *(len(part) for part in parts)])
    circles = np.zeros((levels.size, MOST_CIRCLES, CIRCLE_WIDTH))
    circles_kernel(np.concatenate(parts), starts, _CUT, circles)
    known = circles[:, 0, RADIUS] > 0
    return levels[known], circles[known, 0]


def diameter_at_breast(levels: Floats, diameters: Floats) -> float:
    """The robust line through diameters by height, at 1.2 m; NaN where too few are on one."""
    best: Integers = np.empty(0, np.int64)
    random = np.random.default_rng(1)
    for _ in range(200 if levels.size >= 2 else 0):
        a, b = random.choice(levels.size, 2, replace=False)
        slope = (diameters[b] - diameters[a]) / (levels[b] - levels[a])
        off = np.abs(diameters - diameters[a] - slope * (levels - levels[a]))
        near = np.flatnonzero(off < _LINE_M)
        best = near if near.size > best.size else best
    if best.size < _FEWEST:
        return math.nan
    slope, constant = np.polyfit(levels[best] - BREAST_M, diameters[best], 1)
    del slope
    return float(constant)


def kd_wires(points: TrunkPoints, neighbours: int) -> Integers:
    """(m, 2) wires to the nearest points in space."""
    count = len(points.local)
    if count <= neighbours:
        return np.empty((0, 2), np.int64)
    found = cKDTree(points.local).query(points.local, k=list(range(2, neighbours + 2)))
    away, near = np.asarray(found[0]), np.asarray(found[1])
    first = np.repeat(np.arange(count), neighbours)
    wires = np.column_stack([first, near.ravel()])
    short: Integers = wires[away.ravel() < WIRE_M]
    return short


def image_wires(points: TrunkPoints) -> Integers:
    """(m, 2) wires to the next pixels of the row and the nearest of the rows before and behind."""
    wires: list[tuple[int, int]] = []
    for drive, per_turn in enumerate(points.per_turn):
        own = np.flatnonzero((points.drives == drive) & (points.pulses >= 0))
        own = own[np.argsort(points.pulses[own], kind="stable")]
        pulses, local = points.pulses[own], points.local[own]
        beside = np.flatnonzero((np.diff(pulses) > 0) & (np.diff(pulses) <= SKIPPED))
        wires += [(int(own[one]), int(own[one + 1])) for one in beside]
        for step in (-per_turn, per_turn):
            first = np.searchsorted(pulses, pulses + step - WINDOW)
            end = np.searchsorted(pulses, pulses + step + WINDOW, side="right")
            for one in np.flatnonzero(end > first).tolist():
                others = np.arange(first[one], end[one])
                away = np.linalg.norm(local[others] - local[one], axis=1)
                wires.append((int(own[one]), int(own[others[away.argmin()]])))
    pairs = np.array(wires, np.int64).reshape(-1, 2)
    long = np.linalg.norm(np.diff(points.local[pairs], axis=1)[:, 0], axis=1)
    short: Integers = pairs[long < WIRE_M]
    return short


WAYS: Mapping[str, Callable[[TrunkPoints], float]] = {
    "this program, from these points": own_diameter,
    "this program, one circle a slab": diameter_by_one_circle,
    "thesis: wires of the image, cut every 5 mm": lambda one: wire_diameter(one, image_wires(one)),
    "wires to 8 neighbours in space": lambda one: wire_diameter(one, kd_wires(one, 8)),
    "wires to 32 neighbours in space": lambda one: wire_diameter(one, kd_wires(one, 32)),
    "projection of 1.0 to 1.4 m": projected_diameter,
    "the circle at 1.2 m alone": plain_diameter,
}
"""By their names in the table."""
