"""How curb stones were laid: their joints, and how far each lies from its line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.mesh import Floats

_JOINT_M = 0.005
_LONGEST_STEP_M = 0.5
_LEAST_STEP_M = 0.002

_SETTLED_M, _TILTED, _ROUNDED_M = 0.004, 0.05, (0.01, 0.035)
"""Of an old street: how far stones have moved, m, and leant, m per m (3°), one standard deviation;
how far their edges are worn off, m, fewest and most. Chosen, not measured: what scanners of this
class still show, and more than new stones may be off."""


@dataclass(frozen=True)
class StoneNodes:
    """Nodes of a row of stones.

    Attributes
    ----------
    along : (n,) float64
        Rising, no more than half a metre apart; both ends of every stone are nodes.
    outwards, upwards : (n,) float64
        How far the stones lie from their lines, m; 0 at both ends of the row.
    chipped : (n,) float64
        How much more of the edge is broken off, m.
    tilted : (n,) float64
        How far the stones lean outwards beyond their batter, m per m of height.
    rounded : (n,) float64
        Radius to which the upper edge is worn, m.
    """

    along: Floats
    outwards: Floats
    upwards: Floats
    chipped: Floats
    tilted: Floats
    rounded: Floats


@dataclass(frozen=True)
class StoneRow:
    """Stones of one kind, as they were laid and as time left them.

    Attributes
    ----------
    stone_m : float
        Length of a stone; they vary by some per cent, and one is cut.
    sloppiness_m : float
        Standard deviation of the places of single stones.
    wear : float
        0: as laid; 1: as in an old street, settled, tilted by wheels and rounded.
    """

    stone_m: float
    sloppiness_m: float
    wear: float = 0.0


def lay_stones(random: Generator, ends: Floats, row: StoneRow, breaks: Floats) -> StoneNodes:
    """Lay stones between two ends.

    Parameters
    ----------
    ends : (2,) float64
    row : StoneRow
    breaks : (b,) float64
        Further places that have to be nodes.
    """
    low, high = float(ends[0]), float(ends[1])
    stone_m, sloppiness_m = row.stone_m, row.sloppiness_m + _SETTLED_M * row.wear
    count = int((high - low) / stone_m) + 2
    lengths = stone_m * (1 + random.normal(0, 0.004, count))
    if random.random() < 0.5:
        lengths[int(random.integers(count))] *= float(random.uniform(0.4, 0.9))
    joints = low + float(random.uniform(0.1, 1.0)) * stone_m + np.cumsum(lengths) - lengths[0]
    joints = joints[(joints > low + 0.1) & (joints < high - 0.1)]
    if breaks.size:
        clear = np.abs(joints[:, None] - breaks[None]).min(axis=1) > 3 * _JOINT_M
        joints = joints[clear]
    nodes = [np.array([low, high]), breaks, joints - _JOINT_M / 2, joints + _JOINT_M / 2]
    along = _refined(np.unique(np.concatenate(nodes)))
    stone = np.searchsorted(joints, along)
    many = joints.size + 1
    middles = (np.append(low, joints) + np.append(joints, high)) / 2
    yaw = random.normal(0, 1.5 * sloppiness_m, many)
    outwards = random.normal(0, sloppiness_m, many)[stone] + yaw[stone] * (along - middles[stone])
    upwards = random.normal(0, sloppiness_m, many)[stone]
    chipped = np.where(random.random(along.size) < 0.02, random.uniform(0, 0.02, along.size), 0.0)
    # Of streams of their own, so that a street without wear stays what it was.
    worn = random.spawn(1)[0]
    tilted = row.wear * worn.normal(0, _TILTED, many)[stone]
    rounded = row.wear * worn.uniform(*_ROUNDED_M, many)[stone]
    for one in (outwards, upwards, chipped, tilted):
        one[[0, -1]] = 0.0
    return StoneNodes(along, outwards, upwards, chipped, tilted, rounded)


def place_nodes_evenly(ends: Floats, step_m: float, breaks: Floats) -> StoneNodes:
    """Nodes of a row without joints."""
    low, high = float(ends[0]), float(ends[1])
    count = max(2, int(np.ceil((high - low) / step_m)) + 1)
    along = np.unique(np.concatenate([np.linspace(low, high, count), breaks]))
    none = np.zeros(along.size)
    return StoneNodes(along, none, none, none, none, none)


def _refined(nodes: Floats) -> Floats:
    keep = np.append(True, np.diff(nodes) > _LEAST_STEP_M)
    nodes = nodes[keep]
    steps = np.diff(nodes)
    parts = np.ceil(steps / _LONGEST_STEP_M).astype(np.int64)
    starts = np.repeat(nodes[:-1], parts)
    first = np.repeat(np.cumsum(parts) - parts, parts)
    within = np.arange(parts.sum()) - first
    return np.append(starts + within * np.repeat(steps / parts, parts), nodes[-1])
