"""A tree with its truth: trunks, branches, leaves, stakes, what grows about its foot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.plants.crowns import (
    CrownOptions,
    LeafFilter,
    branches_of,
    leaves_of,
    scatter_leaves,
)
from processing.laboratory.simulate.roadside.plants.growth import Growth
from processing.laboratory.simulate.roadside.plants.stakes import guard_of, stakes_of
from processing.laboratory.simulate.roadside.plants.trunks import (
    HIGH_PIECE,
    TAPE_M,
    Stem,
    StemOptions,
    girth_of_stem_m,
    stem_of,
    stem_shape,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.section import StreetSection

TRUNK, CROWN, SHRUB = 66, 5, 4
TRUTH_WITHIN_M = 8.0
"""Of the carriageway's edge: trees farther off are in the truth, but not asked for."""

_MANY_LEAVES, _FEW_LEAVES = 1_500, 600
_COVER = 1.1  # area of all leaves by that of the crown as seen from beside
_WIDEST_LEAF_M = 0.17
_CLEAR_OVER_ROAD_M = 4.2  # 建築限界: 4.5 m over carriageways, trees a little in arrears
_STAKED = {"young": 0.9, "grown": 0.36, "wild": 0.0}
_GUARDED = 0.25  # of the trees of avenues that stand without stakes
_STAKED_TO_M = 0.22  # thicker trunks stand by themselves
_SEVERAL_STEMS = 0.7  # of the sum of their girths: how street trees of several stems are measured


Age = Literal["young", "grown", "wild"]


@dataclass(frozen=True)
class TreeOptions:
    """What one tree is to be like.

    Attributes
    ----------
    high_m : float
    age : str
        ``young``: newly planted, thin and staked; ``wild``: of a wood, never staked.
    leaves : int
        At most; fewer as the season has it.
    above_m : float
        How high the soil of its pit lies over the walk.
    """

    growth: Growth
    spot: FreePosition
    high_m: float
    age: Age
    leaves: int
    above_m: float = 0.0


def leaf_share(section: StreetSection, growth: Growth) -> float:
    """How many of its leaves a tree carries in this street's season; 0 is a bare winter."""
    if growth.is_evergreen:
        return 1.0
    season = chance(section.seed, "season").random()
    return 0.0 if season < 0.2 else 0.35 if season < 0.35 else 1.0


def is_asked_for(positions: FreePositions, spot: FreePosition) -> bool:
    """Whether a tree at a place is near enough to the road that a survey maps it."""
    edge = positions.section.plan.side(spot.side).edge_m
    return abs(spot.offset_m) - edge <= TRUTH_WITHIN_M


def add_tree(
    positions: FreePositions, built: SectionBuilder, options: TreeOptions, random: Generator
) -> None:
    """Add a tree at a place that was taken for it."""
    section, growth, spot = positions.section, options.growth, options.spot
    foot = positions.where(spot) + np.array([0.0, 0.0, options.above_m])
    instance = built.thing("tree")
    stems = _stems(random, options)
    girths = []
    for stem in stems:
        shape, pieces = stem_shape(stem)
        girths.append(girth_of_stem_m(stem, shape))
        built.mesh.add((shape[0] + foot, shape[1]), Material.BARK, TRUNK, instance, piece=pieces)
    crown = _crown_options(random, options, leaf_share(section, growth))
    keeps = _clear_of_road(section, spot)
    branches, leafy = branches_of(random, growth, stems, crown, keeps)
    leaves = leaves_of(random, growth, leafy, crown, keeps)
    built.mesh.add(
        (branches[0] + foot, branches[1]), Material.BARK, TRUNK, instance, piece=HIGH_PIECE
    )
    built.mesh.add((leaves[0] + foot, leaves[1]), Material.LEAVES, CROWN, instance)
    stakes = 0
    is_thin = len(stems) == 1 and stems[0].radius_m(TAPE_M) < _STAKED_TO_M / 2
    if is_thin and random.random() < _STAKED[options.age]:
        stakes = _add_stakes(positions, built, options, stems[0])
    elif positions.section.plan.side(spot.side).is_avenue and random.random() < _GUARDED:
        guard = guard_of(random, stems[0])
        wrapped = (guard[0] + foot, guard[1])
        built.mesh.add(wrapped, Material.PAINTED_METAL, TRUNK, built.thing("guard"))
    _add_undergrowth(built, random, stems[0], foot)
    extent = np.concatenate([branches[0], leaves[0], stems[0].path[-1:]])
    girth = girths[0] if len(girths) == 1 else _SEVERAL_STEMS * sum(girths)
    built.truth.append(
        TrueFeature(
            "trees",
            "Point",
            foot[None],
            {
                "kind": "tree",
                "girth_m": girth,
                "dbh_m": girth / np.pi,
                "stem_dbh_m": [one / np.pi for one in girths],
                "stems": len(girths),
                "stakes": stakes,
                "height_m": float(extent[:, 2].max()),
                "crown_m": float(np.ptp(extent[:, :2], axis=0).mean()),
                "growth": growth.name,
                "leaf_share": leaf_share(section, growth),
                "in_span": is_asked_for(positions, spot),
            },
            instance,
            spot.chainage_m,
        )
    )


def _stems(random: Generator, options: TreeOptions) -> list[Stem]:
    growth = options.growth
    count = int(random.integers(growth.stems[0], growth.stems[1] + 1))
    diameter = options.high_m / float(random.uniform(*growth.slenderness))
    diameter = float(np.clip(diameter * random.lognormal(0, 0.15), 0.035, 0.6))
    if options.age == "young":
        diameter = float(np.clip(diameter * 0.6, 0.035, 0.12))
    lean = float(min(random.exponential(0.025), 0.14))
    turn = float(random.uniform(0, 2 * np.pi))
    common = np.array([np.cos(turn), np.sin(turn)]) * lean
    if count == 1:
        end = 0.25 if growth.form < 0.7 else 0.35
        top = options.high_m * (0.92 if growth.form < 0.35 else 0.72)
        return [stem_of(random, StemOptions(diameter / 2, top, end, (common[0], common[1])))]
    stems = []
    apart = diameter * float(random.uniform(0.5, 1.0)) + 0.03
    for each in range(count):
        angle = turn + each * 2 * np.pi / count + float(random.normal(0, 0.3))
        direction = np.array([np.cos(angle), np.sin(angle)])
        out = common + direction * float(random.uniform(0.06, 0.2))
        radius = diameter / 2 * float(random.uniform(0.45, 0.85))
        foot = direction * apart
        top = options.high_m * float(random.uniform(0.6, 0.8))
        stems.append(
            stem_of(random, StemOptions(radius, top, 0.3, (out[0], out[1]), (foot[0], foot[1])))
        )
    return stems


def _crown_options(random: Generator, options: TreeOptions, share: float) -> CrownOptions:
    growth = options.growth
    base = max(
        options.high_m * float(random.uniform(*growth.base)), min(1.6, options.high_m * 0.45)
    )
    wide = (
        options.high_m
        * float(random.uniform(*growth.crown))
        * (0.5 if options.age == "young" else 1.0)
    )
    most = 24 if options.leaves > _MANY_LEAVES else 13 if options.leaves > _FEW_LEAVES else 9
    branches = int(np.clip(options.high_m * random.uniform(1.5, 3.0), 5, most))
    leaves = int(options.leaves * share * np.clip(wide * options.high_m / 24, 0.25, 1.0))
    cover = _COVER * wide * (options.high_m - base) * float(random.uniform(0.6, 1.3))
    leaf = float(np.clip(np.sqrt(cover / max(options.leaves, 1) / 0.45), 0.05, _WIDEST_LEAF_M))
    return CrownOptions(base, options.high_m, wide, branches, leaves, leaf)


def _clear_of_road(section: StreetSection, spot: FreePosition) -> LeafFilter:
    """Nothing low hangs over the carriageway: lorries see to that."""
    heading = section.heading(spot.chainage_m)
    outwards = spot.side * np.array([-np.sin(heading), np.cos(heading)])
    reach = abs(spot.offset_m) - section.plan.side(spot.side).edge_m

    def keeps(positions: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        is_over = positions[:, :2] @ outwards < -reach + 0.3
        kept: np.ndarray[tuple[int], np.dtype[np.bool_]] = ~is_over | (
            positions[:, 2] > _CLEAR_OVER_ROAD_M
        )
        return kept

    return keeps


def _add_stakes(
    positions: FreePositions, built: SectionBuilder, options: TreeOptions, stem: Stem
) -> int:
    section, spot = positions.section, options.spot
    random = section.chance("stakes", int(spot.chainage_m * 100) * spot.side)
    foot = positions.where(spot) + np.array([0.0, 0.0, options.above_m])
    room = abs(spot.offset_m) - positions.near_m(spot.side)
    wood, straps, count = stakes_of(random, stem, section.heading(spot.chainage_m), room)
    instance = built.thing("stake")
    built.mesh.add((wood[0] + foot, wood[1]), Material.WOOD, TRUNK, instance)
    built.mesh.add((straps[0] + foot, straps[1]), Material.CLOTH, TRUNK, instance)
    return count


def _add_undergrowth(built: SectionBuilder, random: Generator, stem: Stem, foot: Floats) -> None:
    """Shoots and shrubs about the foot, ivy on the trunk: now and then."""
    kind = random.random()
    if kind < 0.14:
        high, wide = float(random.uniform(0.2, 1.0)), float(random.uniform(0.2, 0.5))
        count = int(120 + 500 * high)
        turns = random.uniform(0, 2 * np.pi, count)
        away = stem.radius_m(0.3) + wide * np.abs(random.normal(0.3, 0.5, count))
        level = np.abs(random.normal(0, high / 2, count)).clip(0.03, high)
        centres = np.column_stack([away * np.cos(turns), away * np.sin(turns), level])
    elif kind < 0.19:
        count, high = 300, float(random.uniform(0.8, 2.6))
        turns, level = random.uniform(0, 2 * np.pi, count), random.uniform(0.03, high, count)
        away = np.interp(level, stem.path[:, 2], stem.radii) + random.uniform(0, 0.05, count)
        axis = np.column_stack([np.interp(level, stem.path[:, 2], stem.path[:, i]) for i in (0, 1)])
        turned = np.column_stack([np.cos(turns), np.sin(turns)]) * away[:, None]
        centres = np.column_stack([axis + turned, level])
    else:
        return
    leaves = scatter_leaves(random, centres, 0.06)
    built.mesh.add((leaves[0] + foot, leaves[1]), Material.LEAVES, SHRUB, built.thing("shrub"))
