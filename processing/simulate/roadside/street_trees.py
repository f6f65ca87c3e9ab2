"""Rows of street trees, trees in yards, and woods beside the road."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from processing.simulate.chance import chance
from processing.simulate.materials import Material
from processing.simulate.roadside.crowns import scattered_leaves
from processing.simulate.roadside.growth import CEDAR, GROWTHS, YARD_GROWTHS, Growth
from processing.simulate.roadside.places import Places, Spot, free_from_m
from processing.simulate.roadside.rods import rods
from processing.simulate.roadside.tree_pits import PitHabit, add_pit, pit_habit, take_pit
from processing.simulate.roadside.trees import (
    CROWN,
    TRUNK,
    TRUTH_WITHIN_M,
    Age,
    TreeWish,
    add_tree,
    leaf_share,
)
from processing.simulate.street.plan import SIDES, SectionPlan, SidePlan
from processing.simulate.street.styles import HIGHWAY, URBAN
from processing.simulate.things import Built

_TRIANGLES, _BARK_TRIANGLES = 44_000, 2_000  # of all trees of a section, of one tree's wood
_LEAST_LEAVES, _MOST_LEAVES = 250, 4_500
_ROOM_M = 0.35  # about a trunk
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
    pits: PitHabit | None


def add_street_trees(places: Places, built: Built) -> None:
    """Add the rows of this section, its yards' trees and its woods."""
    wishes: list[TreeWish] = []
    for side in SIDES:
        random = places.section.chance("trees", side)
        row = _row(places, random, side)
        if row is not None:
            wishes += _in_row(places, built, random, row)
        wishes += _in_yards(places, random, side)
    count = max(1, len(wishes))
    leaves = int(np.clip(_TRIANGLES // count - _BARK_TRIANGLES, _LEAST_LEAVES, _MOST_LEAVES))
    for number, wish in enumerate(wishes):
        own = places.section.chance("tree", number)
        add_tree(places, built, replace(wish, leaves=leaves), own)
    for side in SIDES:
        if places.section.plan.side(side).outside == "wood":
            _add_wood(places, built, side)


def _row(places: Places, random: Generator, side: int) -> _Row | None:
    section = places.section
    plan = section.plan.side(side)
    street = chance(section.seed, "rows", side)
    growth = GROWTHS[int(street.integers(len(GROWTHS)))]
    pitch, high = float(street.uniform(5.0, 12.0)), float(street.random())
    if random.random() < 0.15:
        growth = GROWTHS[int(random.integers(len(GROWTHS)))]
    away = _row_away_m(section.plan, plan, random)
    if away is None:
        return None
    walk = plan.band("walk")
    is_in_walk = walk is not None and walk.inner_m < away < walk.outer_m
    pits = pit_habit(section, side) if is_in_walk else None
    if pits is not None:
        away = pits.middle_m(places.near_m(side))
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


def _in_row(places: Places, built: Built, random: Generator, row: _Row) -> list[TreeWish]:
    plan, pits = places.section.plan, row.pits
    wishes: list[TreeWish] = []
    at, number = plan.start_m + float(random.uniform(0.5, row.pitch_m)), 0
    while at < plan.end_m - 0.5:
        off = float(random.normal(0, 0.06))
        fate, number = random.random(), number + 1
        own = places.section.chance("pit", row.side * number)
        has_tree = fate > _GONE_SHARE
        is_free, above = False, 0.0
        if pits is None:
            spot = Spot(at, row.side * (row.away_m + off))
            is_free = has_tree and places.take(spot, _ROOM_M)
        else:
            middle = Spot(at, row.side * row.away_m)
            spot = Spot(at + 0.5 * off, row.side * (row.away_m + 0.5 * off))
            is_left = has_tree or own.random() < _EMPTY_PIT_SHARE
            if is_left and take_pit(places, middle, pits):
                add_pit(places.section, built, middle, pits, own)
                is_free, above = has_tree, pits.soil_m
        if is_free:
            is_young = fate < _GONE_SHARE + 0.1
            low, top = row.growth.high_m
            high = float(np.clip(row.high_m * random.normal(1.0, 0.14), low * 0.85, top * 1.1))
            if is_young:
                high = float(random.uniform(2.6, 4.2))
            age: Age = "young" if is_young else "grown"
            wishes.append(TreeWish(row.growth, spot, high, age, 0, above))
        at += row.pitch_m * float(random.uniform(0.75, 1.3))
    return wishes


def _in_yards(places: Places, random: Generator, side: int) -> list[TreeWish]:
    """A few trees of gardens, close behind the boundary."""
    section = places.section
    plan = section.plan.side(side)
    verge = plan.band("verge")
    if plan.outside != "lots" or verge is None or plan.verge_m < 1.1:
        return []
    wishes = []
    for _ in range(int(random.poisson(section.plan.length_m / 22))):
        away = verge.outer_m - float(random.uniform(0.45, 0.7))
        spot = Spot(float(random.uniform(section.plan.start_m, section.plan.end_m)), side * away)
        growth = YARD_GROWTHS[int(random.integers(len(YARD_GROWTHS)))]
        if places.take(spot, _ROOM_M + 0.05):
            high = float(random.uniform(2.4, min(5.5, growth.high_m[1])))
            wishes.append(TreeWish(growth, spot, high, "grown", 0))
    return wishes


def _add_wood(places: Places, built: Built, side: int) -> None:
    """Trees of a wood: whole ones near the road, coarse ones behind."""
    section = places.section
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
        spot = Spot(at, side * (start + deep))
        growth = CEDAR if conifers else GROWTHS[int(random.integers(len(GROWTHS)))]
        if not places.take(spot, 0.5):
            continue
        own = section.chance("tree of a wood", number * side)
        high = float(own.uniform(*growth.high_m))
        if abs(spot.offset_m) - plan.edge_m <= TRUTH_WITHIN_M:
            add_tree(places, built, TreeWish(growth, spot, high, "wild", 350), own)
        else:
            _add_coarse_tree(places, built, TreeWish(growth, spot, high, "wild", 200), own)


def _add_coarse_tree(places: Places, built: Built, wish: TreeWish, random: Generator) -> None:
    foot = places.where(wish.spot)
    instance = built.thing("tree")
    high = wish.high_m
    top = foot + np.array([*random.normal(0, 0.02, 2) * high, high])
    path = np.stack([foot - [0.0, 0.0, 0.3], foot, foot + (top - foot) * 0.5, top])
    radius = high / float(random.uniform(*wish.growth.slenderness)) / 2
    bark = rods(path[None], radius * np.array([1.1, 1.0, 0.7, 0.1]), 7)
    built.mesh.add(bark, Material.BARK, TRUNK, instance, piece=1)
    count = int(wish.leaves * leaf_share(places.section, wish.growth))
    if count == 0:
        return
    low = float(random.uniform(*wish.growth.base))
    share = random.uniform(0, 1, count)
    wide = high * float(random.uniform(*wish.growth.crown)) / 2 * (1.1 - share)
    turns, away = random.uniform(0, 2 * np.pi, count), wide * np.sqrt(random.random(count))
    level = high * (low + (1 - low) * share)
    centres = foot + np.column_stack([away * np.cos(turns), away * np.sin(turns), level])
    built.mesh.add(scattered_leaves(random, centres, 0.35), Material.LEAVES, CROWN, instance)
