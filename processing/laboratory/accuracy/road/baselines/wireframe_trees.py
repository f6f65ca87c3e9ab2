"""How the thesis finds street trees: components of the image's wireframe with a column and a crown.

References
----------
Takahashi 2022, 5.2: wires to the next pixels and to the nearest of the rows before and behind;
components; circles through cuts every 5 mm; the directions of smoothed edges. What it leaves open
is chosen as the specification chooses it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.laboratory.accuracy.road.baselines.tree_baselines import (
    SKIPPED,
    WINDOW,
    WIRE_M,
    cut_circles,
    diameter_at_breast,
)
from processing.methods.road.trees.circle_kernels import EAST, NORTH, RADIUS

KEPT_CLASSES = 5, 6, 66
"""Crown, building and pole-like: trunks are mixed with columns of buildings only."""

_FEWEST_VERTICES = 100
"""Of a component that is looked at: fewer are no tree."""

_SLICES, _SHARE = 440, 0.4
"""From 0.3 to 2.5 m, and which share of them must have a circle."""

_MEDIAN_M = 0.15
"""Circles of a column are so near to its middle."""

_BESIDE_M = 0.05
"""Beyond the circles: so near a vertex is of the column."""

_CROWN_VERTICES, _CROWN_SHARE = 300, 0.3
"""Vertices that are not of the column, or their share of the component."""

_TURNS, _SHRINK, _SWELL = 20, 0.5, -0.53
"""Of Taubin's filter."""

_BINS = 18
"""Of 5 degrees from the vertical."""

_MOST_BIAS = 0.8
"""Of the histogram of edges; leaves that point anywhere have 0.42."""


class WireframeTree(NamedTuple):
    """A tree as the thesis tells it.

    Attributes
    ----------
    place : (2,) float64
        The median of its circles' middles.
    diameter_m : float
        1.2 m above the ground; NaN where no line through diameters was found.
    """

    place: Floats
    diameter_m: float


def wireframe_trees(
    local: Floats, pulses: Integers, per_turn: int, ground_at: Callable[[float, float], float]
) -> list[WireframeTree]:
    """The trees of one head.

    Parameters
    ----------
    local : (n, 3) float64
        Points of the classes that are kept, m, in the order of their pulses.
    pulses : (n,) int64
        Rising.
    per_turn : int
        Pulses of a revolution.
    ground_at : callable
        Height of the ground at a place; NaN where nothing is known of it.
    """
    wires = image_wires_of(local, pulses, per_turn)
    links = sparse.coo_matrix((np.ones(len(wires)), wires.T), (len(local),) * 2)
    part_of = connected_components(links, directed=False)[1]
    order = np.argsort(part_of, kind="stable")
    wires = wires[np.argsort(part_of[wires[:, 0]], kind="stable")]
    counts = np.bincount(part_of)
    starts = np.cumsum([0, *counts])
    wire_starts = np.searchsorted(part_of[wires[:, 0]], np.arange(len(counts) + 1))
    number_of = np.empty(len(local), np.int64)
    found = []
    for part in np.flatnonzero(counts >= _FEWEST_VERTICES).tolist():
        members = order[starts[part] : starts[part + 1]]
        number_of[members] = np.arange(members.size)
        own = number_of[wires[wire_starts[part] : wire_starts[part + 1]]]
        ground = ground_at(*np.median(local[members, :2], axis=0).tolist())
        if math.isnan(ground):
            continue
        tree = _tree_of(local[members] - (0.0, 0.0, ground), own)
        if tree is not None:
            found.append(tree)
    return found


def _tree_of(above: Floats, wires: Integers) -> WireframeTree | None:
    """The tree that a component is; None: it has no column, or is none."""
    levels, circles = cut_circles(above[wires])
    middles = circles[:, [EAST, NORTH]]
    if not levels.size:
        return None
    middle = np.median(middles, axis=0)
    is_own = np.hypot(*(middles - middle).T) < _MEDIAN_M
    if np.count_nonzero(is_own) < _SHARE * _SLICES:
        return None
    wide = float(np.median(circles[is_own, RADIUS])) + _BESIDE_M
    is_column = (np.hypot(*(above[:, :2] - middle).T) < wide) & (above[:, 2] < levels[is_own][-1])
    others = int(np.count_nonzero(~is_column))
    if others < _CROWN_VERTICES and others < _CROWN_SHARE * len(above):
        return None
    rest = wires[~is_column[wires].any(axis=1)]
    if edge_bias(_smoothed(above, wires), rest) > _MOST_BIAS:
        return None
    place = np.median(middles[is_own], axis=0)
    return WireframeTree(place, diameter_at_breast(levels[is_own], 2 * circles[is_own, RADIUS]))


def edge_bias(places: Floats, wires: Integers) -> float:
    """How unevenly edges point, by their angle from the vertical (5-1); 2 where there are none."""
    if not len(wires):
        return 2.0
    edges = places[wires[:, 1]] - places[wires[:, 0]]
    lengths = np.maximum(np.linalg.norm(edges, axis=1), 1e-9)
    angles = np.degrees(np.arccos(np.clip(np.abs(edges[:, 2]) / lengths, 0, 1)))
    votes = np.histogram(angles, _BINS, (0.0, 90.0))[0]
    return float(np.abs(votes - len(wires) / _BINS).sum() / len(wires))


def _smoothed(places: Floats, wires: Integers) -> Floats:
    """By Taubin's filter: a step towards the neighbours' middle and one back, twenty times."""
    count = len(places)
    ends = np.concatenate([wires, wires[:, ::-1]])
    links = sparse.coo_matrix((np.ones(len(ends)), ends.T), (count, count)).tocsr()
    links.data[:] = 1.0
    degrees = np.maximum(np.asarray(links.sum(axis=1)).ravel(), 1.0)[:, None]
    moved = places.copy()
    for _ in range(_TURNS):
        for step in (_SHRINK, _SWELL):
            moved += step * (links @ moved / degrees - moved)
    return moved


def image_wires_of(local: Floats, pulses: Integers, per_turn: int) -> Integers:
    """(m, 2) wires to the next pixel of the row and to the nearest of the rows beside it."""
    wires = np.empty((3 * len(local), 2), np.int64)
    count = wires_kernel(local, pulses, per_turn, wires)
    return wires[:count]


@kernel
def wires_kernel(local: Floats, pulses: Integers, per_turn: int, wires: Integers) -> int:
    """Write the wires of points in the order of their pulses; how many there are."""
    count = 0
    first = np.zeros(2, np.int64)
    for point in range(len(local)):
        following = point + 1
        while following < len(local) and pulses[following] == pulses[point]:
            following += 1
        if following < len(local) and pulses[following] - pulses[point] <= SKIPPED:
            count = _wire(local, (point, following), wires, count)
        for side, turn in enumerate((-per_turn, per_turn)):
            low = pulses[point] + turn - WINDOW
            while first[side] < len(local) and pulses[first[side]] < low:
                first[side] += 1
            best, nearest = math.inf, -1
            other = first[side]
            while other < len(local) and pulses[other] <= low + 2 * WINDOW:
                away = 0.0
                for axis in range(3):
                    away += (local[other, axis] - local[point, axis]) ** 2
                if away < best:
                    best, nearest = away, other
                other += 1
            if nearest >= 0:
                count = _wire(local, (point, nearest), wires, count)
    return count


@kernel
def _wire(local: Floats, ends: tuple[int, int], wires: Integers, count: int) -> int:
    """Add a wire that is short enough."""
    a, b = ends
    away = 0.0
    for axis in range(3):
        away += (local[a, axis] - local[b, axis]) ** 2
    if away < WIRE_M * WIRE_M:
        wires[count, 0], wires[count, 1] = a, b
        return count + 1
    return count
