"""Rows of street trees, trees in yards, and woods beside the road."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.plants.crowns import scatter_leaves
from processing.laboratory.simulate.roadside.plants.growth import (
    AVENUE_GROWTHS,
    CEDAR,
    GROWTHS,
    YARD_GROWTHS,
    Growth,
)
from processing.laboratory.simulate.roadside.plants.tree_pits import (
    PitStyle,
    add_pit,
    pit_habit,
    take_pit,
)
from processing.laboratory.simulate.roadside.plants.trees import (
    CROWN,
    TRUNK,
    Age,
    TreeOptions,
    add_tree,
    is_asked_for,
    leaf_share,
)
from processing.laboratory.simulate.roadside.plants.trunks import TAPE_M
from processing.laboratory.simulate.roadside.rods import rods
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.things import Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    FreePositions,
    free_from_m,
    free_to_m,
)
from processing.laboratory.simulate.street.plan import SIDES, SectionPlan, SidePlan
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN

_COARSE_SIDES = 7  # of the trunks of trees deep in a wood
_TRIANGLES, _BARK_TRIANGLES = 44_000, 2_000  # of all trees of a section, of one tree's wood
_LEAST_LEAVES, _MOST_LEAVES = 250, 4_500
_ROOM_M = 0.35  # about a trunk
_AVENUE_PITCH_M = (4.5, 8.0)  # less than crowns of grown trees are wide
_AVENUE_AWAY_M = 0.7  # behind the curb
_MOST_WOOD_TREES = 26
_WOOD_DEEP_M = 24.0
_GONE_SHARE = 0.08  # of the trees of a row
_EMPTY_PIT_SHARE = 0.6  # of the pits whose trees are gone, the others were paved


@dataclass(frozen=True)
class _Row:
    """Where trees of one row stand: distance from the road's centre, their kind, their pits."""

    side: int
    away_m: float
    growth: Growth
    pitch_m: float
    high_m: float
    pits: PitStyle | None


def add_street_trees(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the rows of this section, its yards' trees and its woods."""
    all_options: list[TreeOptions] = []
    for side in SIDES:
        random = positions.section.chance("trees", side)
        row = _row(positions, random, side)
        if row is not None:
            all_options += _in_row(positions, built, random, row)
        all_options += _in_yards(positions, random, side)
    count = max(1, len(all_options))
    leaves = int(np.clip(_TRIANGLES // count - _BARK_TRIANGLES, _LEAST_LEAVES, _MOST_LEAVES))
    for number, tree_options in enumerate(all_options):
        own = positions.section.chance("tree", number)
        add_tree(positions, built, replace(tree_options, leaves=leaves), own)
    for side in SIDES:
        if positions.section.plan.side(side).outside == "wood":
            _add_wood(positions, built, side)


def _row(positions: FreePositions, random: Generator, side: int) -> _Row | None:
    section = positions.section
    plan = section.plan.side(side)
    street = chance(section.seed, "rows", side)
    growth = GROWTHS[int(street.integers(len(GROWTHS)))]
    pitch, high = float(street.uniform(5.0, 12.0)), float(street.random())
    if random.random() < 0.15:
        growth = GROWTHS[int(random.integers(len(GROWTHS)))]
    away = _row_away_m(section.plan, plan, random)
    if plan.is_avenue:
        growth = AVENUE_GROWTHS[int(street.integers(len(AVENUE_GROWTHS)))]
        pitch, high = float(street.uniform(*_AVENUE_PITCH_M)), 0.5 + high / 2
        near = positions.near_m(side) + _AVENUE_AWAY_M
        away = min(near, free_to_m(plan) - _ROOM_M) if away is None else away
    if away is None:
        return None
    walk = plan.band("walk")
    is_in_walk = walk is not None and walk.inner_m < away < walk.outer_m
    pits = pit_habit(section, side) if is_in_walk else None
    if pits is not None:
        away = pits.middle_m(positions.near_m(side))
    low, top = growth.high_m
    return _Row(side, away, growth, pitch, low + high * (top - low), pits)


def _row_away_m(section: SectionPlan, plan: SidePlan, random: Generator) -> float | None:
    strip, walk, verge = plan.band("strip"), plan.band("walk"), plan.band("verge")
    if strip is not None and strip.outer_m - strip.inner_m >= 0.6:
        return (strip.inner_m + strip.outer_m) / 2 if random.random() < 0.88 else None
    if walk is not None and plan.walk_m >= 2.2 and section.style is URBAN:
        return walk.inner_m + float(random.uniform(0.55, 0.75)) if random.random() < 0.5 else None
    share = 0.25 if section.style is HIGHWAY else 0.12
    if verge is not None and plan.verge_m >= 1.0 and random.random() < share:
        return verge.inner_m + plan.verge_m * float(random.uniform(0.45, 0.7))
    return None


def _in_row(
    positions: FreePositions, built: SectionBuilder, random: Generator, row: _Row
) -> list[TreeOptions]:
    plan, pits = positions.section.plan, row.pits
    options: list[TreeOptions] = []
    at, number = plan.start_m + float(random.uniform(0.5, row.pitch_m)), 0
    while at < plan.end_m - 0.5:
        off = float(random.normal(0, 0.06))
        fate, number = random.random(), number + 1
        own = positions.section.chance("pit", row.side * number)
        has_tree = fate > _GONE_SHARE
        is_free, above = False, 0.0
        if pits is None:
            spot = FreePosition(at, row.side * (row.away_m + off))
            is_free = has_tree and positions.take(spot, _ROOM_M)
        else:
            middle = FreePosition(at, row.side * row.away_m)
            spot = FreePosition(at + 0.5 * off, row.side * (row.away_m + 0.5 * off))
            is_left = has_tree or own.random() < _EMPTY_PIT_SHARE
            if is_left and take_pit(positions, middle, pits):
                add_pit(positions.section, built, middle, pits, own)
                is_free, above = has_tree, pits.soil_m
        if is_free:
            is_young = fate < _GONE_SHARE + 0.1
            low, top = row.growth.high_m
            high = float(np.clip(row.high_m * random.normal(1.0, 0.14), low * 0.85, top * 1.1))
            if is_young:
                high = float(random.uniform(2.6, 4.2))
            age: Age = "young" if is_young else "grown"
            options.append(TreeOptions(row.growth, spot, high, age, 0, above))
        at += row.pitch_m * float(random.uniform(0.75, 1.3))
    return options


def _in_yards(positions: FreePositions, random: Generator, side: int) -> list[TreeOptions]:
    """A few trees of gardens, close behind the boundary."""
    section = positions.section
    plan = section.plan.side(side)
    verge = plan.band("verge")
    if plan.outside != "lots" or verge is None or plan.verge_m < 1.1:
        return []
    options = []
    for _ in range(int(random.poisson(section.plan.length_m / 22))):
        away = verge.outer_m - float(random.uniform(0.45, 0.7))
        spot = FreePosition(
            float(random.uniform(section.plan.start_m, section.plan.end_m)), side * away
        )
        growth = YARD_GROWTHS[int(random.integers(len(YARD_GROWTHS)))]
        if positions.take(spot, _ROOM_M + 0.05):
            high = float(random.uniform(2.4, min(5.5, growth.high_m[1])))
            options.append(TreeOptions(growth, spot, high, "grown", 0))
    return options


def _add_wood(positions: FreePositions, built: SectionBuilder, side: int) -> None:
    """Trees of a wood: whole ones near the road, coarse ones behind."""
    section = positions.section
    plan = section.plan.side(side)
    random = section.chance("wood", side)
    conifers = chance(section.seed, "wood").random() < 0.6
    first = free_from_m(plan) + 0.6
    outside = plan.band("outside")
    start = outside.inner_m + 0.5 if outside is not None else first
    count = min(_MOST_WOOD_TREES, int(section.plan.length_m * random.uniform(0.25, 0.5)))
    for number in range(count):
        deep = float(random.random()) ** 1.4 * _WOOD_DEEP_M
        at = float(random.uniform(section.plan.start_m, section.plan.end_m))
        spot = FreePosition(at, side * (start + deep))
        growth = CEDAR if conifers else GROWTHS[int(random.integers(len(GROWTHS)))]
        if not positions.take(spot, 0.5):
            continue
        own = section.chance("tree of a wood", number * side)
        high = float(own.uniform(*growth.high_m))
        if is_asked_for(positions, spot):
            add_tree(positions, built, TreeOptions(growth, spot, high, "wild", 350), own)
        else:
            _add_coarse_tree(positions, built, TreeOptions(growth, spot, high, "wild", 200), own)


def _add_coarse_tree(
    positions: FreePositions, built: SectionBuilder, options: TreeOptions, random: Generator
) -> None:
    foot = positions.where(options.spot)
    instance = built.thing("tree")
    high = options.high_m
    top = foot + np.array([*random.normal(0, 0.02, 2) * high, high])
    path = np.stack([foot - [0.0, 0.0, 0.3], foot, foot + (top - foot) * 0.5, top])
    radius = high / float(random.uniform(*options.growth.slenderness)) / 2
    bark = rods(path[None], radius * np.array([1.1, 1.0, 0.7, 0.1]), _COARSE_SIDES)
    built.mesh.add(bark, Material.BARK, TRUNK, instance, piece=1)
    at_tape = radius * (1.0 - 0.3 * TAPE_M / (high / 2))
    girth = 2 * _COARSE_SIDES * at_tape * np.sin(np.pi / _COARSE_SIDES)
    facts: dict[str, Fact] = {"kind": "tree", "girth_m": girth, "dbh_m": girth / np.pi}
    facts |= {"stems": 1, "stakes": 0, "height_m": high, "in_span": False}
    at_m = options.spot.chainage_m
    built.truth.append(TrueFeature("trees", "Point", foot[None], facts, instance, at_m))
    count = int(options.leaves * leaf_share(positions.section, options.growth))
    if count == 0:
        return
    low = float(random.uniform(*options.growth.base))
    share = random.uniform(0, 1, count)
    wide = high * float(random.uniform(*options.growth.crown)) / 2 * (1.1 - share)
    turns, away = random.uniform(0, 2 * np.pi, count), wide * np.sqrt(random.random(count))
    level = high * (low + (1 - low) * share)
    centres = foot + np.column_stack([away * np.cos(turns), away * np.sin(turns), level])
    built.mesh.add(scatter_leaves(random, centres, 0.35), Material.LEAVES, CROWN, instance)
