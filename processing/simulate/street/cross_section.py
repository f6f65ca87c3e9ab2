"""The cross section of a stretch: its lines and strips from the far right to the far left."""

from __future__ import annotations

import numpy as np

from processing.simulate.materials import Material
from processing.simulate.mesh import Floats
from processing.simulate.street.alignment import Alignment
from processing.simulate.street.ground import Ground, Strip
from processing.simulate.street.plan import LEFT, RIGHT, Band, SectionPlan, SidePlan

GROUND, ROAD, CURB, GRASS = 2, 11, 67, 3
_STEP_M = 0.5
_FACE_M = 0.02  # how far a face leans back

_Line = tuple[float, float]  # distance from the centre, height above the asphalt's edge


def ground_of(plan: SectionPlan, alignment: Alignment) -> Ground:
    """The ground of a section."""
    nodes = np.linspace(plan.start_m, plan.end_m, max(2, int(plan.length_m / _STEP_M) + 1))
    right_lines, right_strips = _side(plan.right)
    left_lines, left_strips = _side(plan.left)
    right = _placed(alignment, nodes, plan.right.edge_m, right_lines, RIGHT)
    left = _placed(alignment, nodes, plan.left.edge_m, left_lines, LEFT)
    middle = np.zeros((nodes.size, 1))
    centre = alignment.carriageway_height(nodes, 0.0)[:, None]
    road = Strip("road", Material.ASPHALT, ROAD)
    return Ground(
        nodes,
        np.hstack([right[0][:, ::-1], middle, left[0]]),
        np.hstack([right[1][:, ::-1], centre, left[1]]),
        (*right_strips[::-1], road, road, *left_strips),
    )


def _side(side: SidePlan) -> tuple[list[_Line], list[Strip]]:
    """Lines outwards from the asphalt's edge, which is the first, and the strips after each."""
    lines: list[_Line] = [(side.edge_m, 0.0)]
    strips: list[Strip] = []
    for band in side.bands():
        _add_band(side, band, lines, strips)
    return lines, strips


def _add_band(side: SidePlan, band: Band, lines: list[_Line], strips: list[Strip]) -> None:
    high = lines[-1][1]
    if band.name == "curb":
        top = high + side.curb_high_m
        behind = {"raised": top, "semi": high + 0.05, "flat": high, "asphalt": high}[side.curb]
        lines += [
            (band.inner_m + _FACE_M, top),
            (band.outer_m, top),
            (band.outer_m + 0.001, behind),
        ]
        strips += [Strip("curb", Material.CONCRETE, CURB)] * 3
        return
    wide = band.outer_m - lines[-1][0]
    fall = {"drain": -0.06, "walk": 0.02, "strip": 0.02, "verge": 0.0}
    has_lids = band.name == "drain" and side.drain == "lids"
    rise = 0.0 if has_lids else fall.get(band.name, 0.0) * wide
    if band.name == "outside":
        steep = abs(side.outside_high_m) * 1.5
        lines += [(lines[-1][0] + max(steep, 0.01), high + side.outside_high_m)]
        strips += [Strip("slope", Material.GRASS, GRASS)]
        lines += [(max(band.outer_m, lines[-1][0] + 1), high + side.outside_high_m)]
        strips += [Strip("land", Material.SOIL, GROUND)]
        return
    lines += [(band.outer_m, high + rise)]
    materials = {"drain": Material.CONCRETE, "walk": Material.PAVING, "strip": Material.SOIL}
    labels = {"drain": ROAD, "walk": GROUND, "strip": GROUND, "verge": GRASS}
    material = materials.get(band.name, Material.GRASS)
    strips += [Strip(band.name, material, labels[band.name], has_surface=not has_lids)]


def _placed(
    alignment: Alignment, nodes: Floats, edge_m: float, lines: list[_Line], side: int
) -> tuple[Floats, Floats]:
    away = np.array([one[0] for one in lines])
    high = np.array([one[1] for one in lines])
    edge = alignment.carriageway_height(nodes, side * edge_m)
    offsets = np.broadcast_to(side * away, (nodes.size, away.size))
    return offsets, edge[:, None] + high
