"""Utility poles with what hangs on them, guy wires and service poles in yards.

Pieces of a pole: 1 the shaft, 0 arms, steps and boxes.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.pole_line import TAPER, LinePole, axis, pole_line
from processing.laboratory.simulate.roadside.rods import join_shapes, rod, rods
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, box, place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions

POLE, OTHER, WIRE = 66, 1, 14
SHAFT_PIECE, FITTING_PIECE = 1, 0
SUNK_M = 0.3
"""How far posts go into the ground."""

_BREAST_M = 1.2


def pole_truth(
    built: SectionBuilder, spot: FreePosition, instance: int, foot: Floats, **facts: str | float
) -> None:
    """Say where a pole stands: ``type``, ``height_m`` and ``diameter_m`` (1.2 m up)."""
    built.truth.append(
        TrueFeature(
            "poles",
            "Point",
            np.asarray(foot, np.float64).reshape(1, 3),
            {"kind": "pole", **facts},
            instance,
            spot.chainage_m,
        )
    )


def add_utility_poles(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the poles of the street's line that stand in this section."""
    section = positions.section
    for pole in pole_line(section).poles:
        if pole.section == section.plan.index:
            positions.take(pole.spot, pole.top_diameter_m / 2 + pole.high_m * TAPER / 2 + 0.05)
            _add_pole(positions, built, pole)


def _add_pole(positions: FreePositions, built: SectionBuilder, pole: LinePole) -> None:
    section, spot = positions.section, pole.spot
    random = section.chance("pole", pole.number)
    alignment = section.alignment
    edge = float(alignment.carriageway_height(spot.chainage_m, spot.offset_m))
    ground = float(section.ground.height(spot.chainage_m, spot.offset_m)) - edge
    levels = np.linspace(ground - SUNK_M, pole.high_m, 6)
    radii = (pole.top_diameter_m + (pole.high_m - levels) * TAPER) / 2
    instance = built.thing("pole")
    material = Material.CONCRETE if random.random() < 0.5 else Material.OLD_CONCRETE
    built.mesh.add(
        rods(axis(alignment, pole, levels)[None], radii, 20),
        material,
        POLE,
        instance,
        piece=SHAFT_PIECE,
    )
    foot = axis(alignment, pole, np.array([ground]))[0]
    pole_truth(
        built,
        spot,
        instance,
        foot,
        type="utility_pole",
        height_m=pole.high_m - ground,
        diameter_m=pole.top_diameter_m + (pole.high_m - ground - _BREAST_M) * TAPER,
    )
    _add_fittings(positions, built, pole, instance)
    if random.random() < 0.15:
        _add_guy_wire(positions, built, pole, random)


def _add_fittings(
    positions: FreePositions, built: SectionBuilder, pole: LinePole, instance: int
) -> None:
    section = positions.section
    random = section.chance("fittings", pole.number)
    heading = section.heading(pole.spot.chainage_m)
    towards = -pole.spot.side
    turn = heading if towards > 0 else heading + np.pi
    cables = pole_line(section).cables
    parts = []
    for below in sorted({round(float(one), 2) for one in cables[:, 0]})[:2]:
        level = pole.high_m - below - 0.06
        wide = max(0.35, float(np.abs(cables[cables[:, 0] == below, 1]).max(initial=0.3)) + 0.1)
        at = axis(section.alignment, pole, np.array([level]))[0]
        parts.append(place_shape(box((-0.04, -wide, -0.04), (0.04, wide, 0.04)), at, turn))
    steps = np.arange(float(random.uniform(1.8, 2.8)), pole.high_m - 2.5, 0.45)
    if random.random() < 0.8:
        centre = axis(section.alignment, pole, steps)
        direction = np.array([np.cos(heading), np.sin(heading), 0.0])
        direction = np.where((np.arange(len(steps)) % 2 == 0)[:, None], direction, -direction)
        reach = ((pole.top_diameter_m + (pole.high_m - steps) * TAPER) / 2 + 0.13)[:, None]
        parts.append(rods(np.stack([centre, centre + direction * reach], axis=1), 0.008, 4))
    built.mesh.add(join_shapes(parts), Material.STEEL, POLE, instance, piece=FITTING_PIECE)
    if random.random() < 0.35:
        _add_transformer(positions, built, pole, instance)
    if random.random() < 0.3:
        low = float(random.uniform(2.5, 4.5))
        at = axis(section.alignment, pole, np.array([low]))[0]
        radius = (pole.top_diameter_m + (pole.high_m - low) * TAPER) / 2
        body = box((-0.2, -radius - 0.22, 0.0), (0.2, -radius, float(random.uniform(0.4, 0.7))))
        built.mesh.add(place_shape(body, at, turn), Material.PAINTED_METAL, POLE, instance)


def _add_transformer(
    positions: FreePositions, built: SectionBuilder, pole: LinePole, instance: int
) -> None:
    section = positions.section
    random = section.chance("transformer", pole.number)
    level = pole.high_m - float(random.uniform(2.2, 3.0))
    ends = axis(section.alignment, pole, np.array([level, level + 0.75]))
    heading = section.heading(pole.spot.chainage_m) + (0.0 if random.random() < 0.5 else np.pi)
    direction = np.array([np.cos(heading), np.sin(heading), 0.0])
    cans = []
    for each in range(1 if random.random() < 0.6 else 2):
        radius = float(random.uniform(0.2, 0.28))
        aside = direction * (1 - 2 * each) * (radius + pole.top_diameter_m / 2 + 0.06)
        cans.append(rod(ends[0] + aside, ends[1] + aside, radius, 12))
    built.mesh.add(join_shapes(cans), Material.PAINTED_METAL, POLE, instance, piece=FITTING_PIECE)


def _add_guy_wire(
    positions: FreePositions, built: SectionBuilder, pole: LinePole, random: Generator
) -> None:
    """A stay along the road with its yellow cover, where its anchor finds a place."""
    section, spot = positions.section, pole.spot
    reach = float(random.uniform(2.5, 4.5)) * (1 if random.random() < 0.5 else -1)
    anchor = FreePosition(spot.chainage_m + reach, spot.offset_m)
    if not positions.take(anchor, 0.1):
        return
    foot = positions.where(anchor)
    top = axis(section.alignment, pole, np.array([pole.high_m - 2.0]))[0]
    instance = built.thing("guy_wire")
    built.mesh.add(rod(foot - [0.0, 0.0, 0.1], top, 0.006, 5), Material.CABLE, WIRE, instance)
    direction = (top - foot) / np.linalg.norm(top - foot)
    cover = rod(foot, foot + direction * 2.0, 0.03, 8)
    built.mesh.add(cover, Material.PLASTIC, POLE, instance, piece=1)
