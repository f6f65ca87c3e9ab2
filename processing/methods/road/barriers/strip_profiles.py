"""What stands along strips: points of each by length, height above the foot, and how far aside.

A profile is a picture of a strip seen square to it: columns of 0.25 m along it, slabs of 5 cm above
its foot. Rails are rows of it, posts columns, walls and nets fill it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, uniform_filter1d

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.barriers.raised_cells import (
    FINE,
    FINE_M,
    GROUND_BIT,
    LOWEST_M,
    SLAB_M,
    SLABS,
    RaisedCells,
)
from processing.methods.road.barriers.strip_kernels import STEP_M
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.sparse_plan import TILE, cell_of
from processing.recording.drive import Drive

COLUMN_M, LAYER_M, LAYERS = 0.25, 0.05, 96
"""Length of a column, height of a layer, and how many: up to 4.8 m."""

_ABOUT_M = 0.6
"""From a node to points that are looked at: 0.5 m aside between two nodes."""

_THICK_M = 0.25
"""To either side of the strip's middle: the depth of a beam on its post, of a parapet's foot."""

_FOOT_ASIDE_M = (0.2, 0.5)
_FOOT_LOW_M, _FOOT_HIGH_M = -0.6, 0.35
_FOOT_SHARE = 0.2
_FOOT_LEAST = 4
"""The foot is a fifth of the way up the lowest points, about the strip if it shows there, else
beside it: a curb or a gutter may lie there."""

_FOOT_MEDIAN, _FOOT_MEAN = 8, 4
"""Nodes to both sides that tell the foot of one with it: 4 m, as far as walks are lowered."""

_BINS, _BIN_M = 16, 0.05
_BAND = slice(6, 26)
_CENTRE_NODES, _MIDDLE, _APART_BINS = 4, 0.3, 3
"""Across a strip, 0.8 m in parts of 5 cm: how many of the layers from 0.3 to 1.3 m each fills tells
where what is thinnest stands, with the nodes up to 2 m away."""

_SMOOTH = 2
"""Nodes to both sides that tell a node's place with it: cells are 0.1 m wide."""

_LEVEL_M = 1.0
"""Beside a strip, where the ground on either side is asked for."""

SIDE_CELLS = (3, 15)
"""Beside a strip, fine cells that tell whether it stands free: 0.3 to 1.5 m."""


@dataclass(frozen=True)
class StripProfile:
    """One strip.

    Attributes
    ----------
    nodes : (n, 2) float64
        Half a metre apart, m about the origin of the plan.
    foot : (n,) float64
        Height of the ground at each, m about the origin; NaN where none is known.
    local : (k, 3) float64
        Points about it: along it, to the left of it, above its foot, m.
    counts, aside, squares : (c, 96) float32
        Of each column and layer: points, and the sums of how far to the left they lie, m, m².
    filled : (n, 2) uint32
        Beside each node, left and right: slabs in which something stands, as of `RaisedCells`.
    lit : (n, 2) float64
        The share of the cells beside each node in which the ground was seen: nothing hides it.
    levels : (n, 2) float64
        The ground 1 m to the left and right of each node, m about the origin.
    """

    nodes: Floats
    foot: Floats
    local: Floats
    counts: NDArray[np.float32]
    aside: NDArray[np.float32]
    squares: NDArray[np.float32]
    filled: NDArray[np.uint32]
    lit: Floats
    levels: Floats

    @property
    def long_m(self) -> float:
        """From the first node to the last."""
        return (len(self.nodes) - 1) * STEP_M


class SideCells(NamedTuple):
    """The cells of `RaisedCells`, flat, as the kernel takes them."""

    table: NDArray[np.int32]
    ground: NDArray[np.float32]
    slabs: NDArray[np.uint32]


class StripSides(NamedTuple):
    """What is told of each node: its ground, and what is beside it."""

    coarse: Floats
    filled: NDArray[np.uint32]
    lit: Floats
    levels: Floats


def profiles_of(
    strips: Sequence[Floats], cells: RaisedCells, drives: Sequence[Drive], monitor: Monitor
) -> list[StripProfile]:
    """Profiles of strips: (n, 2) nodes of each, half a metre apart."""
    smooth = [_smoothed(one) for one in strips]
    if not smooth:
        return []
    about = points_about(
        drives, cells.plan, np.concatenate(smooth), _ABOUT_M, PartMonitor(monitor, 0.0, 0.8)
    )
    ends = np.cumsum([0, *(len(one) for one in smooth)]).tolist()
    profiles = []
    for nodes, first, last in zip(smooth, ends[:-1], ends[1:], strict=True):
        monitor.check()
        rows = slice(int(about.starts[first]), int(about.starts[last]))
        owners = np.repeat(np.arange(len(nodes)), np.diff(about.starts[first : last + 1]))
        profiles.append(_profile(nodes, about.local[rows], owners, cells))
    return profiles


def _smoothed(nodes: Floats) -> Floats:
    """Nodes moved onto lines through their neighbours."""
    result = nodes.copy()
    at = np.arange(len(nodes), dtype=np.float64)
    for k in range(len(nodes)):
        part = slice(max(0, k - _SMOOTH), k + _SMOOTH + 1)
        if part.stop - part.start < 3 or len(nodes) < 3:
            continue
        t = at[part] - at[part].mean()
        for axis in range(2):
            values = nodes[part, axis]
            slope = float((t * (values - values.mean())).sum() / (t * t).sum())
            result[k, axis] = values.mean() + slope * (k - at[part].mean())
    return result


def ways_of(nodes: Floats) -> Floats:
    """(n, 2) the direction of a line at its nodes."""
    ways = np.gradient(nodes, axis=0)
    return np.asarray(ways / np.maximum(np.hypot(*ways.T), 1e-9)[:, None])


def profile_about(points: Floats, nodes: Floats, ground: float) -> StripProfile:
    """The profile of a strip by the points about it alone, on level ground.

    Parameters
    ----------
    points : (k, 3) float64
        With those up to 1.5 m beside it.
    nodes : (n, 2) float64
        Half a metre apart.
    ground : float
        Its height.
    """
    ways = ways_of(nodes)
    along = (points[:, :2] - nodes[0]) @ ways[0]
    owners = np.clip(np.rint(along / STEP_M), 0, len(nodes) - 1).astype(np.int64)
    local = np.empty_like(points)
    along_kernel(points, owners, nodes, ways, local)
    sides = StripSides(
        np.full(len(nodes), ground),
        np.zeros((len(nodes), 2), np.uint32),
        np.zeros((len(nodes), 2)),
        np.full((len(nodes), 2), np.nan),
    )
    high = local[:, 2] - ground - LOWEST_M
    for side, sign in enumerate((1.0, -1.0)):
        cells = np.floor(sign * local[:, 1] / FINE_M)
        is_beside = (cells >= SIDE_CELLS[0]) & (cells <= SIDE_CELLS[1])
        stands = is_beside & (high >= 0.0) & (high < SLABS * SLAB_M)
        slabs = np.uint32(1) << (high[stands] / SLAB_M).astype(np.uint32)
        np.bitwise_or.at(sides.filled[:, side], owners[stands], slabs)
        lies = is_beside & (high < 0.0) & (high >= -2 * LOWEST_M)
        seen = np.unique(np.column_stack([owners[lies], cells[lies]]), axis=0)[:, 0]
        count = np.bincount(seen.astype(np.int64), minlength=len(nodes))
        sides.lit[:, side] = count / (SIDE_CELLS[1] - SIDE_CELLS[0] + 1)
    is_near = np.abs(local[:, 1]) <= _ABOUT_M
    return _profile_of(nodes, local[is_near], owners[is_near], sides)


def _profile(nodes: Floats, points: Floats, owners: Integers, cells: RaisedCells) -> StripProfile:
    ways = ways_of(nodes)
    local = np.empty_like(points)
    along_kernel(points, owners, nodes, ways, local)
    sides = StripSides(
        np.empty(len(nodes)),
        np.zeros((len(nodes), 2), np.uint32),
        np.zeros((len(nodes), 2)),
        np.empty((len(nodes), 2)),
    )
    flat = SideCells(cells.plan.table, cells.ground.reshape(-1), cells.slabs.reshape(-1))
    sides_kernel(nodes, ways, flat, sides)
    return _profile_of(nodes, local, owners, sides)


def _profile_of(nodes: Floats, local: Floats, owners: Integers, sides: StripSides) -> StripProfile:
    """A profile of points along a line; they become heights above its foot, about its middle."""
    foot = _foot_of(local, owners, sides.coarse)
    local[:, 2] -= foot[owners]
    aside_m = _centred(local, owners, len(nodes))
    local[:, 1] -= aside_m[owners]
    ways = ways_of(nodes)
    nodes = nodes + aside_m[:, None] * np.column_stack([-ways[:, 1], ways[:, 0]])
    columns = max(1, int(np.ceil(len(nodes) * STEP_M / COLUMN_M)))
    sums = np.zeros((3, columns, LAYERS), np.float32)
    layers_kernel(local, sums)
    return StripProfile(
        nodes, foot, local, sums[0], sums[1], sums[2], sides.filled, sides.lit, sides.levels
    )


def _centred(local: Floats, owners: Integers, count: int) -> Floats:
    """How far to the left of each node what is thinnest about it stands, m.

    Strips are followed on cells 0.1 m wide, and halfway between a fence and the hedge behind it.
    """
    filled = np.zeros((count, _BINS, LAYERS), np.bool_)
    bins_kernel(local, owners, filled)
    share = filled[:, :, _BAND].sum(axis=2, dtype=np.float64)
    # What stands there goes on: 2 m to both sides tell with a node.
    about = uniform_filter1d(share, 2 * _CENTRE_NODES + 1, axis=0, mode="nearest")
    pairs = about[:, 1:] + about[:, :-1]
    # What fills both sides too, as plants do, is not thin.
    padded = np.pad(pairs, ((0, 0), (_APART_BINS, _APART_BINS)))
    pairs = pairs - 0.5 * (padded[:, : -2 * _APART_BINS] + padded[:, 2 * _APART_BINS :])
    # Of places that are filled alike the one in the middle of the strip.
    pairs = pairs * (1.0 - _MIDDLE * np.abs(np.arange(_BINS - 1) - (_BINS / 2 - 1)) / _BINS)
    best = (np.argmax(pairs, axis=1) + 1 - _BINS / 2) * _BIN_M
    best[pairs.max(axis=1) <= 0] = 0.0
    calm = median_filter(best, 2 * _CENTRE_NODES + 1, mode="nearest")
    return np.asarray(uniform_filter1d(calm, _CENTRE_NODES, mode="nearest"))


@kernel
def bins_kernel(local: Floats, owners: Integers, filled: NDArray[np.bool_]) -> None:
    """Mark which parts across each node hold points, layer by layer."""
    for point in range(len(local)):
        part = math.floor(local[point, 1] / _BIN_M) + _BINS // 2
        height = local[point, 2]
        # Comparisons with NaN are false.
        if 0 <= part < filled.shape[1] and 0.0 <= height < filled.shape[2] * LAYER_M:
            filled[owners[point], part, int(height / LAYER_M)] = True


def _foot_of(local: Floats, owners: Integers, coarse: Floats) -> Floats:
    """The ground at each node, from the lowest points about it and its neighbours'."""
    low = local[:, 2] - coarse[owners]
    is_low = (low > _FOOT_LOW_M) & (low < _FOOT_HIGH_M)
    foot = np.full(len(coarse), np.nan)
    for within in _FOOT_ASIDE_M:
        chosen = np.flatnonzero(is_low & (np.abs(local[:, 1]) <= within))
        starts = np.searchsorted(owners[chosen], np.arange(len(coarse) + 1))
        for node in np.flatnonzero(np.isnan(foot)).tolist():
            values = local[chosen[starts[node] : starts[node + 1]], 2]
            if values.size >= _FOOT_LEAST:
                foot[node] = np.quantile(values, _FOOT_SHARE)
    off = _middles_of(foot - coarse, _FOOT_MEDIAN, np.median)
    return coarse + _middles_of(off, _FOOT_MEAN, np.mean)


def _middles_of(values: Floats, reach: int, middle: Callable[[Floats], float]) -> Floats:
    """The middle of the known values about each; 0 where there are none."""
    result = np.zeros_like(values)
    for node in range(len(values)):
        near = values[max(0, node - reach) : node + reach + 1]
        known = near[np.isfinite(near)]
        if known.size:
            result[node] = middle(known)
    return result


@kernel
def along_kernel(
    points: Floats, owners: Integers, nodes: Floats, ways: Floats, local: Floats
) -> None:
    """Points along a line, to the left of it, and their heights."""
    for point in range(len(points)):
        node = owners[point]
        east, north = points[point, 0] - nodes[node, 0], points[point, 1] - nodes[node, 1]
        x, y = ways[node, 0], ways[node, 1]
        local[point, 0] = node * STEP_M + east * x + north * y
        local[point, 1] = north * x - east * y
        local[point, 2] = points[point, 2]


@kernel
def layers_kernel(local: Floats, sums: NDArray[np.float32]) -> None:
    """Count the points of columns and layers, with how far aside they are."""
    for point in range(len(local)):
        aside, height = local[point, 1], local[point, 2]
        # Comparisons with NaN are false.
        if not (abs(aside) <= _THICK_M and height >= 0.0):
            continue
        column, layer = int(local[point, 0] / COLUMN_M + 0.5), int(height / LAYER_M)
        if 0 <= column < sums.shape[1] and layer < LAYERS:
            sums[0, column, layer] += 1
            sums[1, column, layer] += aside
            sums[2, column, layer] += aside * aside


@kernel
def sides_kernel(nodes: Floats, ways: Floats, cells: SideCells, sides: StripSides) -> None:
    """Look at the cells beside each node."""
    for node in range(len(nodes)):
        east, north = nodes[node, 0], nodes[node, 1]
        x, y = ways[node, 0], ways[node, 1]
        sides.coarse[node] = _ground_at(east, north, cells)
        for side in range(2):
            sign = 1.0 - 2.0 * side
            sides.levels[node, side] = _ground_at(
                east - sign * _LEVEL_M * y, north + sign * _LEVEL_M * x, cells
            )
            lit = 0
            for k in range(SIDE_CELLS[0], SIDE_CELLS[1] + 1):
                away = sign * k * FINE_M
                cell = cell_of(east - away * y, north + away * x, cells.table, FINE)
                if cell >= 0:
                    sides.filled[node, side] |= cells.slabs[cell]
                    lit += (cells.slabs[cell] & GROUND_BIT) > 0
            sides.lit[node, side] = lit / (SIDE_CELLS[1] - SIDE_CELLS[0] + 1)


@kernel
def _ground_at(east: float, north: float, cells: SideCells) -> float:
    cell = cell_of(east, north, cells.table, TILE)
    return float(cells.ground[cell]) if cell >= 0 else np.nan
