"""Clipped hedges in planting strips, medians and along yards, with gaps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.plants.crowns import scatter_leaves
from processing.laboratory.simulate.roadside.plants.plant_truth import HEDGE, tell_area
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.dropped_curbs import drops_of
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN

SHRUB = 4
_STEP_M = 0.22
_END_GAP_M = 0.4
_MEDIAN_END_GAP_M = 4.0  # noses of islands
_MOST_LEAVES = 800
_LEAST_M = 1.0
# Across a hedge, as shares of half its width and of its height: up one face, over, down the other.
_PROFILE = np.array(
    [[-0.8, 0.0], [-1, 0.25], [-1.0, 0.8], [-0.75, 1], [0, 1.04], [0.75, 1], [1, 0.8], [1, 0.25],
     [0.8, 0.0]]
)  # fmt: skip


@dataclass(frozen=True)
class _Hedge:
    start_m: float
    end_m: float
    offset_m: float
    wide_m: float
    high_m: float


def add_hedges(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the hedges of this section."""
    section = positions.section
    for side in SIDES:
        if side in section.plan.junctions:
            continue
        random = section.chance("hedges", side)
        for hedge in _beside(section, random, side):
            _add_hedge(section, built, hedge, random)
    plan = section.plan
    if plan.style is URBAN and plan.median_m >= 1.5 and not plan.junctions:
        random = section.chance("hedge of the median")
        wide = plan.median_m - float(random.uniform(0.7, 0.9))
        start, end = plan.start_m + _MEDIAN_END_GAP_M, plan.end_m - _MEDIAN_END_GAP_M
        if random.random() < 0.6 and end - start > 3.0:
            high = float(random.uniform(0.4, 1.1))
            _add_hedge(section, built, _Hedge(start, end, 0.0, wide, high), random)


def _beside(section: StreetSection, random: Generator, side: int) -> Iterator[_Hedge]:
    plan = section.plan.side(side)
    strip, verge = plan.band("strip"), plan.band("verge")
    planted = chance(section.seed, "planted", side).random()
    if strip is not None and random.random() < 0.25 + 0.6 * planted:
        wide = strip.outer_m - strip.inner_m - float(random.uniform(0.2, 0.35))
        middle = (strip.inner_m + strip.outer_m) / 2
        high = float(random.uniform(0.3, 0.9))
        yield from _pieces(section, random, _Hedge(0, 0, side * middle, wide, high))
    if verge is None or plan.outside != "lots" or plan.verge_m < 0.9 or random.random() > 0.35:
        return
    wide = min(float(random.uniform(0.4, 0.8)), plan.verge_m - 0.3)
    middle = verge.outer_m - wide / 2 - float(random.uniform(0.08, 0.15))
    high = float(random.uniform(0.7, 1.9))
    yield from _pieces(section, random, _Hedge(0, 0, side * middle, wide, high))


def _pieces(section: StreetSection, random: Generator, like: _Hedge) -> Iterator[_Hedge]:
    """Hedges of 1.5 to 14 m with gaps, over a part of the section."""
    at = section.plan.start_m + _END_GAP_M + float(random.exponential(3.0))
    end = section.plan.end_m - _END_GAP_M
    drops = drops_of(section.seed, section.plan, 1 if like.offset_m > 0 else -1)
    while at + 1.0 < end:
        drop = next((one for one in drops if one.to_m + 0.2 > at), None)
        if drop is not None and drop.from_m - 0.2 < at + _LEAST_M:
            at = drop.to_m + 0.3
            continue
        last = end if drop is None else min(end, drop.from_m - 0.2)
        long = min(float(random.uniform(1.5, 14.0)), last - at)
        high = like.high_m * float(random.uniform(0.9, 1.1))
        yield _Hedge(at, at + long, like.offset_m, like.wide_m, high)
        at += long + float(random.exponential(1.5)) + 0.3


def _add_hedge(
    section: StreetSection, built: SectionBuilder, hedge: _Hedge, random: Generator
) -> None:
    if hedge.wide_m < 0.2 or hedge.end_m - hedge.start_m < 0.8:
        return
    count = max(4, int((hedge.end_m - hedge.start_m) / _STEP_M) + 1)
    along = np.linspace(hedge.start_m, hedge.end_m, count)
    rough = float(random.uniform(0.015, 0.05))
    swell = 1 + 0.06 * np.sin(along * random.uniform(0.8, 2.5) + random.uniform(0, 6))
    swell[[0, -1]] *= 0.6
    chainage = along[:, None] + random.normal(0, rough, (count, len(_PROFILE)))
    across = hedge.wide_m / 2 * np.clip(swell, 0.5, 1.04)[:, None] * _PROFILE[:, 0]
    offset = hedge.offset_m + across + random.normal(0, rough, across.shape)
    level = np.maximum(
        hedge.high_m * swell[:, None] * _PROFILE[:, 1] + random.normal(0, rough, across.shape), 0.0
    )
    level[:, [0, -1]] = -0.03
    rows = section.position(chainage, offset, level)
    rows[[0, -1], :, :2] = rows[[0, -1], :, :2].mean(axis=1, keepdims=True)
    instance = built.thing("hedge")
    built.mesh.add(grid(rows), Material.LEAVES, SHRUB, instance)
    ring = np.concatenate([rows[:, 1], rows[::-1, -2]])
    middle_m = (hedge.start_m + hedge.end_m) / 2
    tell_area(built, ring, (HEDGE, instance, middle_m), hedge.high_m)
    centres = _on(random, rows, int(min(_MOST_LEAVES, 60 * (hedge.end_m - hedge.start_m))))
    leaves = scatter_leaves(random, centres, float(random.uniform(0.05, 0.1)))
    built.mesh.add(leaves, Material.LEAVES, SHRUB, instance)


def _on(random: Generator, rows: Floats, count: int) -> Floats:
    """Chance places on a hedge's surface."""
    row = random.integers(0, rows.shape[0] - 1, count)
    position = random.integers(0, rows.shape[1] - 1, count)
    one, other = random.random((count, 1)), random.random((count, 1))
    low = rows[row, position] * (1 - one) + rows[row + 1, position] * one
    high = rows[row, position + 1] * (1 - one) + rows[row + 1, position + 1] * one
    positions: Floats = low * (1 - other) + high * other + random.normal(0, 0.035, (count, 3))
    return positions
