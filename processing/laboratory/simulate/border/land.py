"""What covers the land beside a street: ridges and levees of fields, frames and walls of slopes.

Things: ``ridges`` (label 2, or 3 where something grows), ``levee`` (3), ``slope_frame``, ``wall``
and ``fence`` (1); pieces are not told apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.along import stations, sweep_section
from processing.laboratory.simulate.border.wall_lines import add_ground_walls, add_swept_wall
from processing.laboratory.simulate.border.yards import add_mesh_fence
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.plan import SIDES, SidePlan
from processing.laboratory.simulate.street.section import StreetSection

OTHER, GROUND, GRASS = 1, 2, 3

_END_M = 0.3
_FARTHEST_M = 14.0  # how far from the slope's end fields are built in detail


@dataclass(frozen=True)
class _Slope:
    """Where the slope beside a street lies, m from the centre, and how far it rises.

    Attributes
    ----------
    foot_m, head_m : float
        Its beginning and its end.
    """

    side: int
    foot_m: float
    head_m: float
    rise_m: float


def add_land(positions: FreePositions, built: SectionBuilder) -> None:
    """Add what covers the land on both sides."""
    section = positions.section
    for side in SIDES:
        slope = _slope(section, side)
        if slope is None or side in section.plan.junctions:
            continue
        plan = section.plan.side(side)
        alike = chance(section.seed, "land", side, round(plan.drain_m * 1e6))
        random = section.chance("land", side)
        if plan.outside == "fields":
            _add_field(alike, random, section, built, slope)
        elif plan.outside == "rise":
            _add_slope_works(alike, section, built, slope)
        elif plan.outside == "wall" and alike.random() < 0.5:
            line = section.plan.start_m, section.plan.end_m, side * (slope.head_m + 0.2)
            add_mesh_fence(section, built, line, float(alike.uniform(0.8, 1.6)))
        _add_ground_walls(section, built, side)


def _add_ground_walls(section: StreetSection, built: SectionBuilder, side: int) -> None:
    sweep = section.layout.sides[side].sweep
    for number, strip in enumerate(sweep.profile.strips):
        if strip.kind == "wall":
            add_ground_walls(section, built, sweep, number)


def _slope(section: StreetSection, side: int) -> _Slope | None:
    """The strip between the verge and the land, None where the ground has none."""
    plan: SidePlan = section.plan.side(side)
    ground = section.ground
    for number, strip in enumerate(ground.strips):
        offsets = ground.offsets[:, number : number + 2]
        if strip.kind in ("slope", "wall") and np.sign(offsets.mean()) == side:
            away = np.abs(offsets)
            return _Slope(
                side, float(away.min(axis=1).max()), float(away.max()), plan.outside_high_m
            )
    return None


def _add_field(
    alike: Generator,
    random: Generator,
    section: StreetSection,
    built: SectionBuilder,
    slope: _Slope,
) -> None:
    plan = section.plan
    kind = alike.random()
    start = slope.head_m + float(alike.uniform(0.4, 2.0))
    low, far = plan.start_m + _END_M, plan.end_m - _END_M
    if kind < 0.45:
        pitch, high = float(alike.uniform(0.7, 1.3)), float(alike.uniform(0.12, 0.3))
        at = low
        while at < far - 4.0:
            end = min(at + float(random.uniform(12.0, 50.0)), far)
            count = int(random.uniform(5.0, _FARTHEST_M) / pitch)
            _add_ridges(random, section, built, (at, end, slope.side * start), (pitch, high, count))
            at = end + float(random.uniform(0.5, 3.0))
    elif kind < 0.85:
        high, wide = float(alike.uniform(0.2, 0.45)), float(alike.uniform(0.5, 1.0))
        outline = [(-wide, -0.1), (-wide / 3, high), (wide / 3, high), (wide, -0.1)]
        middle = start + wide
        levee = sweep_section(section, stations(low, far, 2.0), slope.side * middle, outline)
        instance = built.thing("levee")
        built.mesh.add(levee, Material.GRASS, GRASS, instance)
        across = low + float(random.uniform(2.0, 15.0))
        while across < far - 2.0:
            shape = _across(section, across, slope.side, (middle, middle + 20.0), (wide, high))
            built.mesh.add(shape, Material.GRASS, GRASS, instance)
            across += float(random.uniform(12.0, 35.0))


def _add_ridges(
    random: Generator,
    section: StreetSection,
    built: SectionBuilder,
    line: tuple[float, float, float],
    measures: tuple[float, float, int],
) -> None:
    """Add ridges along the road: their pitch, their height, how many (畝)."""
    low, far, offset = line
    pitch, high, count = measures
    if count < 1:
        return
    direction = float(np.sign(offset))
    shares = np.array([0.0, 0.25, 0.4, 0.6, 0.75])
    levels = np.array([-0.05, 0.0, 1.0, 1.0, 0.0])
    away = np.append((np.arange(count)[:, None] + shares).ravel(), count) * pitch
    above = np.append(np.tile(levels, count), -0.05)
    along = stations(low, far, 1.5)
    rough = random.normal(0, 0.02, (along.size, away.size))
    heights = high * above + np.where(above > 0, rough, 0.0)
    heights[[0, -1]] = -0.05
    rows = section.position(along[:, None], offset + direction * away[None, :], heights)
    vertices, triangles = grid(rows)
    grows = random.random() < 0.5
    is_top_column = np.arange(away.size - 1) % shares.size == 2
    is_top = np.tile(np.repeat(is_top_column, 2), along.size - 1)
    instance = built.thing("ridges")
    built.mesh.add((vertices, triangles[~is_top]), Material.SOIL, GROUND, instance)
    material, label = (Material.GRASS, GRASS) if grows else (Material.SOIL, GROUND)
    built.mesh.add((vertices, triangles[is_top]), material, label, instance)


def _across(
    section: StreetSection,
    chainage: float,
    side: int,
    aways: tuple[float, float],
    measures: tuple[float, float],
) -> TriangleShape:
    """A bank or beam square to the road, of a half width and a height, between two distances."""
    wide, high = measures
    outline = np.array(
        [[-wide, -0.3], [-wide / 2, high], [wide / 2, high], [wide, -0.3], [-wide, -0.3]]
    )
    away = side * np.linspace(*aways, 8)[:, None]
    return grid(section.position(chainage + outline[None, :, 0], away, outline[None, :, 1]))


def _add_slope_works(
    random: Generator, section: StreetSection, built: SectionBuilder, slope: _Slope
) -> None:
    """Add a frame of beams (法枠), a low wall at the foot or a fence against falling stones."""
    kind = random.random()
    run = slope.head_m - slope.foot_m
    low, far = section.plan.start_m, section.plan.end_m
    if kind < 0.3 and slope.rise_m > 2.0 and run > 2.0:
        _add_frame(random, section, built, slope)
    elif kind < 0.55 and run > 0.5:
        high = min(float(random.uniform(0.4, 1.6)), 0.7 * slope.rise_m)
        deep = max(run / slope.rise_m * high, 0.2)
        outline = [(0.0, -0.4), (0.08 * high, high), (deep, high), (deep, -0.4)]
        worn = Material.OLD_CONCRETE if random.random() < 0.7 else Material.CONCRETE
        shape = sweep_section(
            section, stations(low, far), slope.side * (slope.foot_m + 0.02), outline
        )
        instance = built.thing("wall")
        built.mesh.add(shape, worn, OTHER, instance)
        line = low, far, slope.side * (slope.foot_m + 0.02)
        add_swept_wall(section, built, instance, line, ("retaining", high, 0.08))
    elif kind < 0.7:
        line = low, far, slope.side * (slope.foot_m + 0.1)
        add_mesh_fence(section, built, line, float(random.uniform(1.2, 2.5)))


def _add_frame(
    random: Generator, section: StreetSection, built: SectionBuilder, slope: _Slope
) -> None:
    pitch, wide = float(random.uniform(1.5, 3.0)), float(random.uniform(0.2, 0.35))
    proud = float(random.uniform(0.12, 0.3))
    worn = Material.OLD_CONCRETE if random.random() < 0.7 else Material.CONCRETE
    instance = built.thing("slope_frame")
    plan, half = section.plan, wide / 2
    outline = [(-half, -0.3), (-half, proud), (half, proud), (half, -0.3)]
    along = stations(plan.start_m, plan.end_m, 2.0)
    low, high = slope.foot_m + 0.3, slope.head_m - 0.2
    levels: Floats = np.linspace(low, high, max(2, round((high - low) / (0.83 * pitch)) + 1))
    for away in levels:
        beam = sweep_section(section, along, slope.side * float(away), outline)
        built.mesh.add(beam, worn, OTHER, instance)
    # The same chainages in every section, so that the frame goes on evenly.
    first, last = np.ceil((plan.start_m + half) / pitch), np.floor((plan.end_m - half) / pitch)
    for at in np.arange(first, last + 1) * pitch:
        beam = _across(section, float(at), slope.side, (low, high), (half, proud))
        built.mesh.add(beam, worn, OTHER, instance)
