"""The cross sections of a section: its lines and strips from the far right to the far left."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.alignment import Alignment
from processing.laboratory.simulate.street.corner_track import (
    CornerTrack,
    corner_course,
    corner_drops,
    corner_nodes,
)
from processing.laboratory.simulate.street.dropped_curbs import drops_of, lowering
from processing.laboratory.simulate.street.ground import StreetGround, Strip
from processing.laboratory.simulate.street.junction_shape import DEEP_M, Mouth, mouth_of
from processing.laboratory.simulate.street.layout import (
    CornerLayout,
    Outline,
    SectionSurfaces,
    SideLayout,
)
from processing.laboratory.simulate.street.measures import (
    BandSurfaces,
    band_surfaces_of,
    measures_along,
)
from processing.laboratory.simulate.street.median import median_nodes, median_of, opening_of
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES, SectionPlan, SidePlan
from processing.laboratory.simulate.street.profile import (
    GROUND,
    ROAD,
    Course,
    RoadProfile,
    profile_of,
)
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.stones import StoneNodes, lay_stones, place_nodes_evenly
from processing.laboratory.simulate.street.sweep import Straight, Sweep
from processing.laboratory.simulate.street.terrain import SectionTerrain
from processing.laboratory.simulate.street.unevenness import unevenness_of

_ROAD_STEP_M = 0.75
_ROAD_LINE_M = 0.4
_PLAIN_STEP_M = 0.5
_SAME_M = 1e-4
_MOUTH_NEAR_M = 12.0
_MOUTH_LINE_M = 0.3
_FOLD_SHARE = 0.8
"""On the inside of a bend the land ends before its lines cross: this share of the radius."""


def section_of(
    seed: int, plans: Sequence[SectionPlan], row: int, alignment: Alignment
) -> StreetSection:
    """A section with its lines; depends on its own plan and those of its neighbours alone."""
    plan = plans[row]
    before = plans[row - 1] if row > 0 else None
    after = plans[row + 1] if row + 1 < len(plans) else None
    mouths = {side: mouth_of(seed, plan, side) for side in plan.junctions}
    terrain = SectionTerrain(
        plan, alignment, unevenness_of(seed), tuple(one.grade for one in mouths.values())
    )
    sides = {}
    for side in SIDES:
        beside = tuple(one.side(side) if one else None for one in (before, plan, after))
        own = (beside[0], plan.side(side), beside[2])
        sides[side] = _side_layout(seed, terrain, side, own, mouths.get(side))
        if after is not None:
            outlines = (
                outline(seed, plans, row, side, is_end=True),
                outline(seed, plans, row + 1, side, is_end=False),
            )
            sides[side] = replace(sides[side], end=outlines)
    opening = opening_of(plan, _widest(mouths))
    step = int(np.ceil(plan.length_m / _ROAD_STEP_M)) + 1
    nodes = np.linspace(plan.start_m, plan.end_m, step)
    if plan.median_m > 0:
        nodes = median_nodes(plan, opening)
    median = median_of(seed, plan, terrain, nodes, opening)
    layout = _layout(terrain, nodes, sides, median)
    return StreetSection(seed, plan, alignment, layout)


def outline(
    seed: int, plans: Sequence[SectionPlan], row: int, side: int, *, is_end: bool
) -> Outline:
    """The lines of a side where a section ends or begins."""
    plan = plans[row]
    before = plans[row - 1].side(side) if row > 0 else None
    after = plans[row + 1].side(side) if row + 1 < len(plans) else None
    own = plan.side(side)
    along = np.array([plan.end_m if is_end else plan.start_m])
    none = np.zeros(1)
    course = Course(
        cover_gutter(own) if side in plan.junctions else own,
        measures_along(seed, (before, own, after), along, np.array([plan.start_m, plan.end_m])),
        band_surfaces_of(seed, own),
        own.edge_m + unevenness_of(seed).wander[side].at(along),
        StoneNodes(along, none, none, none, none, none),
        lowering((), along),
    )
    profile = profile_of(course)
    profile.line(profile.away[-1] + 1.0, profile.above[-1], land_of(seed, own))
    away, above = profile.stacked()
    return Outline(away[0], above[0], tuple(profile.strips))


def far_m(terrain: SectionTerrain, side: int, chainage: Floats, least_m: Floats) -> Floats:
    """How far from the centre the land reaches there: (n,) float64, m."""
    outer = next(one.outer_m for one in terrain.plan.side(side).bands() if one.name == "outside")
    alignment = terrain.alignment
    bend = side * np.interp(chainage, alignment.chainages, alignment.curvatures)
    limit = _FOLD_SHARE / np.maximum(bend, 1e-6)
    reach: Floats = np.maximum(np.minimum(outer, limit), least_m + 1.0)
    return reach


def land_of(seed: int, side: SidePlan) -> Strip:
    """What the ground is made of behind a street's side."""
    random = chance(seed, "land", int(side.verge_m * 1e7))
    yards = (Material.GRAVEL, Material.SOIL, Material.OLD_CONCRETE, Material.GRASS)
    materials = {"lots": yards[int(random.integers(4))], "rise": Material.GRASS}
    return Strip("land", materials.get(side.outside, Material.SOIL), GROUND)


def cover_gutter(side: SidePlan) -> SidePlan:
    """A side whose gutter runs below the side street's asphalt."""
    return side if side.drain in ("none", "apron") else replace(side, drain="apron")


def _widest(mouths: dict[int, Mouth]) -> tuple[float, float] | None:
    if not mouths:
        return None
    return min(one.from_m for one in mouths.values()), max(one.to_m for one in mouths.values())


def _side_layout(
    seed: int,
    terrain: SectionTerrain,
    side: int,
    plans: tuple[SidePlan | None, SidePlan, SidePlan | None],
    mouth: Mouth | None,
) -> SideLayout:
    plan, own = terrain.plan, plans[1]
    looks = band_surfaces_of(seed, own)
    ends = np.array([plan.start_m, plan.end_m])
    drops = drops_of(seed, plan, side)
    breaks = np.array([position for drop in drops for position in drop.breaks()])
    random = chance(seed, "stones", plan.index, side)
    if own.curb in ("none", "asphalt") or mouth is not None:
        nodes = place_nodes_evenly(ends, _PLAIN_STEP_M, breaks)
    else:
        nodes = lay_stones(random, ends, looks.row, breaks)
    wander = terrain.unevenness.wander[side].at(nodes.along)
    if mouth is not None:
        wander = wander * mouth.calm(nodes.along)
    course = Course(
        own,
        measures_along(seed, plans, nodes.along, ends),
        looks,
        own.edge_m + wander,
        nodes,
        lowering(drops, nodes.along),
    )
    if mouth is not None:
        profile = _mouth_profile(mouth, replace(course, side=cover_gutter(own)))
        corners = tuple(_corners(seed, terrain, plans, mouth, looks))
    else:
        profile, corners = profile_of(course), ()
        reach = far_m(terrain, side, nodes.along, profile.away[-1])
        profile.line(reach, profile.above[-1], land_of(seed, own))
    sweep = Sweep.along(Straight(nodes.along, side), profile, terrain, side)
    return SideLayout(sweep, drops, looks, mouth, corners, None)


def _mouth_profile(mouth: Mouth, course: Course) -> RoadProfile:
    """Lines beside a mouth that know its heights alone: the corners have the surfaces."""
    nodes = course.laid.along
    away, above = profile_of(course).stacked()
    inwards, levels = away.mean(axis=0) - course.side.edge_m, above.mean(axis=0)
    inwards = inwards + 1e-6 * np.arange(inwards.size)
    profile = RoadProfile()
    profile.line(course.edge, 0.0)
    bare = Strip("mouth", Material.ASPHALT, ROAD, has_surface=False)
    near = np.arange(1, int(_MOUTH_NEAR_M / _MOUTH_LINE_M)) * _MOUTH_LINE_M
    for beside in (*near, *np.arange(_MOUTH_NEAR_M, DEEP_M, 2.0)):
        depths = mouth.inside_m(nodes, np.full(nodes.size, beside))
        inside = np.maximum(depths[0], depths[1])
        crown = mouth.crown(nodes, np.full(nodes.size, beside))
        level = np.where(inside <= 0, crown, np.interp(inside, inwards, levels))
        profile.line(course.side.edge_m + beside, level, bare)
    return profile


def _corners(
    seed: int,
    terrain: SectionTerrain,
    plans: tuple[SidePlan | None, SidePlan, SidePlan | None],
    mouth: Mouth,
    looks: BandSurfaces,
) -> Iterator[CornerLayout]:
    own = plans[1]
    for number, corner in enumerate(mouth.corners):
        random = chance(seed, "corner", terrain.plan.index, mouth.side, number)
        drops = corner_drops(random, own, corner)
        nodes, first, last = corner_nodes(random, corner, looks, DEEP_M, drops)
        track = CornerTrack(mouth, corner, own.edge_m, nodes.along, first, last)
        wander = terrain.unevenness.wander[mouth.side]
        course = corner_course(seed, plans, track, nodes, looks=looks, drops=drops, wander=wander)
        profile = profile_of(replace(course, side=cover_gutter(own)))
        sweep = Sweep.along(track, profile, terrain, mouth.side)
        yield CornerLayout(track, sweep, drops, land_of(seed, own))


def _layout(
    terrain: SectionTerrain, nodes: Floats, sides: dict[int, SideLayout], median: tuple[Sweep, ...]
) -> SectionSurfaces:
    plan = terrain.plan
    halves = {side: _road_lines(plan, side) for side in SIDES}
    middle = np.array([] if median else [0.0])
    lines = np.concatenate([-halves[RIGHT][::-1], middle, halves[LEFT]])
    every = [nodes, *(one.sweep.chainages[:, 0] for one in sides.values())]
    common = _apart(np.unique(np.concatenate(every)))
    road = Strip("road", Material.ASPHALT, ROAD)
    left, right = sides[LEFT].sweep, sides[RIGHT].sweep
    parts = [_resampled(right, common, is_mirrored=True)]
    strips: list[Strip] = [*right.profile.strips[::-1], road]
    for side in (RIGHT, LEFT):
        offsets = np.broadcast_to(side * halves[side], (nodes.size, halves[side].size))
        if side == RIGHT:
            offsets = offsets[:, ::-1]
        flat = np.broadcast_to(nodes[:, None], offsets.shape)
        bare = _on(common, nodes, (offsets, terrain.height(flat, offsets)))
        if side == RIGHT:
            parts.append(bare)
            strips += [road] * (halves[side].size - 1)
            _add_middle(parts, strips, median, (common, nodes, terrain))
        else:
            parts.append(bare)
            strips += [road] * (halves[side].size - 1)
    parts.append(_resampled(left, common, is_mirrored=False))
    strips += [road, *left.profile.strips]
    ground = StreetGround(
        common,
        np.hstack([one[0] for one in parts]),
        np.hstack([one[1] for one in parts]),
        tuple(strips),
    )
    return SectionSurfaces(terrain, ground, nodes, lines, sides, median)


def _apart(nodes: Floats) -> Floats:
    """Nodes without those that lie on another's place but for rounding."""
    inner = nodes[1:-1]
    is_apart = (np.diff(nodes)[:-1] > _SAME_M) & (nodes[-1] - inner > _SAME_M)
    return np.concatenate([nodes[:1], inner[is_apart], nodes[-1:]])


def _add_middle(
    parts: list[tuple[Floats, Floats]],
    strips: list[Strip],
    median: tuple[Sweep, ...],
    where: tuple[Floats, Floats, SectionTerrain],
) -> None:
    common, nodes, terrain = where
    road = Strip("road", Material.ASPHALT, ROAD)
    if not median:
        middle = np.zeros((nodes.size, 1))
        parts.append(_on(common, nodes, (middle, terrain.height(nodes[:, None], middle))))
        strips += [road, road]
        return
    left, right = median
    parts.append(_resampled(right, common, is_mirrored=True))
    parts.append(_resampled(left, common, is_mirrored=False))
    inner = right.profile.strips
    strips += [road, *inner[::-1], inner[0], *inner, road]


def _road_lines(plan: SectionPlan, side: int) -> Floats:
    """Distances of the carriageway's lines between the middle and one edge, both left out."""
    wide = plan.side(side).edge_m - plan.median_m / 2
    count = max(2, int(np.ceil(wide / _ROAD_LINE_M)))
    return plan.median_m / 2 + wide * np.arange(1, count) / count


def _resampled(sweep: Sweep, common: Floats, *, is_mirrored: bool) -> tuple[Floats, Floats]:
    lines = (sweep.offsets, sweep.heights)
    if is_mirrored:
        lines = (sweep.offsets[:, ::-1], sweep.heights[:, ::-1])
    return _on(common, sweep.chainages[:, 0], lines)


def _on(common: Floats, nodes: Floats, lines: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """Lines at other nodes, straight between their own."""
    row = np.clip(np.searchsorted(nodes, common, "right") - 1, 0, nodes.size - 2)
    share = ((common - nodes[row]) / (nodes[row + 1] - nodes[row]))[:, None]
    offsets, heights = (one[row] + share * (one[row + 1] - one[row]) for one in lines)
    return offsets, heights
