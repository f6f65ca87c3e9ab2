"""Branches and leaves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.roadside.plants.growth import Growth
from processing.laboratory.simulate.roadside.plants.trunks import Stem
from processing.laboratory.simulate.roadside.rods import join_shapes, rods
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape

_POSITIONS = 5  # of a branch
_TIP_M = 0.004
LeafFilter = Callable[[Floats], NDArray[np.bool_]]
"""Which of some places, (n, 3) in the tree's frame, may hold twigs and leaves."""


@dataclass(frozen=True)
class CrownOptions:
    """What a crown is to be like.

    Attributes
    ----------
    base_m, high_m, wide_m : float
        Where it begins and ends above the foot, and its diameter.
    branches, leaves : int
    leaf_m : float
        Mean size of a leaf's triangle.
    """

    base_m: float
    high_m: float
    wide_m: float
    branches: int
    leaves: int
    leaf_m: float


def envelope(growth: Growth, share: Floats) -> Floats:
    """Radius of the crown by its greatest, at shares of its height from its base."""
    widest = np.clip(growth.form, 0.02, 0.95)
    away = np.where(share < widest, (widest - share) / widest, (share - widest) / (1 - widest))
    round_one: Floats = np.sqrt(np.maximum(0.04, 1 - np.minimum(away, 1.0) ** 2))
    straight: Floats = np.maximum(0.08, 1 - np.minimum(away, 1.0))
    return round_one if growth.form > 0.15 else straight


def branches_of(
    random: Generator, growth: Growth, stems: list[Stem], options: CrownOptions, keeps: LeafFilter
) -> tuple[TriangleShape, Floats]:
    """Tapering branches of two orders.

    Returns
    -------
    Shape
        In the tree's frame.
    (n, 3) float64
        Places where leaves grow.
    """
    count = options.branches
    share = np.sort(random.uniform(0.0, 0.92, count)) ** 1.1
    from_m = options.base_m + share * (options.high_m - options.base_m) * 0.8
    owner = random.integers(0, len(stems), count)
    starts = np.stack([stems[i].at(z) for i, z in zip(owner, from_m, strict=True)])
    thick = np.array([stems[i].radius_m(z) for i, z in zip(owner, from_m, strict=True)])
    turns = np.arange(count) * 2.4 + random.normal(0, 0.5, count)  # the golden angle
    rise = np.deg2rad(random.uniform(*growth.rise_deg, count))
    rise = np.minimum(rise + 0.5 * share * (growth.form > 0.2), 1.45)
    reach = options.wide_m / 2 * envelope(growth, np.minimum(share + 0.12, 1.0))
    long = np.minimum(reach / np.maximum(np.cos(rise), 0.35), options.high_m - from_m * 0.8)
    long = np.maximum(long * random.uniform(0.65, 1.05, count), 0.25)
    directions = _directions(turns, rise)
    first = _bent(random, starts, directions, long, growth.droop)
    first_wide = np.minimum(thick * random.uniform(0.35, 0.65, count), 0.03 + 0.025 * long)
    parent = np.repeat(np.arange(count), 3)
    step = random.integers(1, _POSITIONS - 1, parent.size)
    seconds = first[parent, step] + (random.random((parent.size, 1))) * (
        first[parent, step + 1] - first[parent, step]
    )
    spread = turns[parent] + random.uniform(0.4, 1.2, parent.size) * random.choice(
        [-1, 1], parent.size
    )
    tilt = rise[parent] + random.normal(0, 0.35, parent.size)
    short = long[parent] * random.uniform(0.3, 0.6, parent.size)
    second = _bent(random, seconds, _directions(spread, tilt), short, growth.droop)
    second_wide = first_wide[parent] * random.uniform(0.35, 0.6, parent.size)
    kept = keeps(first[:, -1]) & keeps(first[:, 2])
    kept_second = keeps(second[:, -1]) & kept[parent]
    paths = np.concatenate([first[kept], second[kept_second]])
    wide = np.concatenate([first_wide[kept], second_wide[kept_second]])
    if not len(paths):
        return (np.empty((0, 3)), np.empty((0, 3), np.int64)), np.empty((0, 3))
    radii = _TIP_M + (wide[:, None] - _TIP_M).clip(0) * np.linspace(1, 0, _POSITIONS)
    leafy = np.concatenate([paths[:, 2:].reshape(-1, 3), *(one.path[-2:] for one in stems)])
    boughs = int(kept.sum())
    limbs = rods(paths[:boughs], radii[:boughs], 5, is_closed=False)
    twigs = rods(paths[boughs:, ::2], radii[boughs:, ::2], 3, is_closed=False)
    return join_shapes([limbs, twigs]), leafy


def _directions(turns: Floats, rise: Floats) -> Floats:
    flat = np.cos(rise)
    return np.column_stack([flat * np.cos(turns), flat * np.sin(turns), np.sin(rise)])


def _bent(
    random: Generator, starts: Floats, directions: Floats, long: Floats, droop: float
) -> Floats:
    share = np.linspace(0, 1, _POSITIONS)
    paths = starts[:, None] + share[:, None] * (directions * long[:, None])[:, None]
    paths[..., 2] -= droop * long[:, None] * share**2
    crook = random.normal(0, 0.04, paths.shape) * long[:, None, None] * share[:, None]
    bent: Floats = paths + crook
    return bent


def leaves_of(
    random: Generator, growth: Growth, leafy: Floats, options: CrownOptions, keeps: LeafFilter
) -> TriangleShape:
    """Leaves in clumps about twigs: single triangles that look everywhere."""
    if options.leaves == 0 or not len(leafy):
        return np.empty((0, 3)), np.empty((0, 3), np.int64)
    clumps = leafy[random.integers(0, len(leafy), max(20, options.leaves // 9))]
    clumps = clumps + random.normal(0, 0.06 * options.wide_m, clumps.shape)
    tight = random.uniform(0.12, 0.34, len(clumps)) * np.clip(options.wide_m / 4, 0.5, 1.6)
    owner = random.integers(0, len(clumps), options.leaves)
    centres = clumps[owner] + random.normal(0, 1, (options.leaves, 3)) * tight[owner, None]
    if growth.droop > 0.5:
        centres[:, 2] -= (
            random.exponential(0.3, options.leaves) * (options.high_m - options.base_m) * 0.5
        )
    low = options.base_m * (0.55 if growth.droop > 0.5 else 0.85)
    centres = centres[(centres[:, 2] > low) & keeps(centres)]
    return scatter_leaves(random, centres, options.leaf_m)


def scatter_leaves(random: Generator, centres: Floats, leaf_m: float) -> TriangleShape:
    """One triangle about each place, (n, 3), of chance direction and about a size."""
    count = len(centres)
    first = random.normal(0, 1, (count, 3))
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(first, random.normal(0, 1, (count, 3)))
    second /= np.maximum(np.linalg.norm(second, axis=1), 1e-9)[:, None]
    size = (leaf_m * random.uniform(0.6, 1.5, count))[:, None]
    corners = np.stack(
        [
            centres + first * size * 0.6,
            centres - first * size * 0.4 + second * size * 0.45,
            centres - first * size * 0.4 - second * size * 0.45,
        ],
        axis=1,
    )
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)
