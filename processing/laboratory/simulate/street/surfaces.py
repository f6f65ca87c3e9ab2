"""The triangles of a section's ground: carriageway, sides and median, with their curbs."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES
from processing.laboratory.simulate.street.profile import ROAD
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep, add_runs, add_surfaces

_UNDER_M = 0.04
"""How far a side's bed reaches under the asphalt, so that no beam passes between them."""

_BELOW_M = 0.006


def add_ground(section: StreetSection, built: SectionBuilder) -> None:
    """Add the surfaces of the ground; each run of a curb is a thing of its own."""
    _add_road(section, built)
    layout = section.layout
    for half in layout.median:
        add_surfaces(half, section.alignment, built, Material.PAVING)
        add_runs(half, section.alignment, built)
    for side in SIDES:
        part = layout.sides[side]
        add_surfaces(part.sweep, section.alignment, built, part.looks.walk)
        add_runs(part.sweep, section.alignment, built)
        _add_bed(section, part.sweep, built)


def asphalt_of(seed: int) -> Material:
    """What a street's carriageway is made of."""
    kinds = (Material.ASPHALT, Material.WORN_ASPHALT)
    return kinds[int(chance(seed, "asphalt").random() < 0.45)]


def _add_road(section: StreetSection, built: SectionBuilder) -> None:
    layout, plan = section.layout, section.plan
    nodes = layout.road_nodes
    material = asphalt_of(section.seed)
    wander = layout.terrain.unevenness.wander
    outer = {}
    for side in SIDES:
        swing = wander[side].at(nodes)
        mouth = layout.sides[side].mouth
        if mouth is not None:
            swing = swing * mouth.calm(nodes)
        outer[side] = side * (plan.side(side).edge_m + swing)
    lines = np.broadcast_to(layout.road_lines, (nodes.size, layout.road_lines.size))
    if not layout.median:
        halves = [np.column_stack([outer[RIGHT], lines, outer[LEFT]])]
    else:
        inner = {one.side: one.offsets[:, -1] for one in layout.median}
        count = int((layout.road_lines < 0).sum())
        halves = [
            np.column_stack([outer[RIGHT], lines[:, :count], inner[RIGHT]]),
            np.column_stack([inner[LEFT], lines[:, count:], outer[LEFT]]),
        ]
    for offsets in halves:
        rows = _rows(section, np.broadcast_to(nodes[:, None], offsets.shape), offsets)
        built.mesh.add(grid(rows), material, ROAD, NO_THING)


def _rows(section: StreetSection, chainages: Floats, offsets: Floats) -> Floats:
    heights = section.layout.terrain.height(chainages, offsets)
    return section.alignment.at(chainages, offsets, heights)


def _add_bed(section: StreetSection, sweep: Sweep, built: SectionBuilder) -> None:
    chainages = sweep.chainages[:, :1]
    edge, height = sweep.offsets[:, :1], sweep.heights[:, :1]
    under = edge - sweep.side * _UNDER_M
    rows = section.alignment.at(
        np.hstack([chainages, chainages]),
        np.hstack([under, edge]),
        np.hstack([section.layout.terrain.height(chainages, under) - _BELOW_M, height]),
    )
    built.mesh.add(grid(rows), asphalt_of(section.seed), ROAD, NO_THING)
