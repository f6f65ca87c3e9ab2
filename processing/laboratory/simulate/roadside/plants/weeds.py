"""Grass and weeds at the road's edges, and what hangs over curbs."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import grid
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions, free_from_m
from processing.laboratory.simulate.street.plan import SIDES, SidePlan
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN

GRASS = 3
_MOST_TUFTS = 110
_BLADES = 12


def add_weeds(positions: FreePositions, built: SectionBuilder) -> None:
    """Add tufts in joints and verges, and mats that hang over curbs, as neglected as the street."""
    section = positions.section
    street = chance(section.seed, "neglect")
    neglect = float(street.beta(1.2, 3.0) if section.plan.style is URBAN else street.beta(2, 2))
    for side in SIDES:
        if side in section.plan.junctions:
            continue
        random = section.chance("weeds", side)
        _add_tufts(section, built, random, side, neglect=neglect)
        plan = section.plan.side(side)
        has_soil = plan.strip_m > 0 or (plan.walk_m == 0 and plan.verge_m > 0.2)
        if has_soil and plan.drain in ("none", "apron"):
            for _ in range(int(random.poisson(neglect * section.plan.length_m / 7))):
                _add_mat(section, built, random, side)


def _lines(plan: SidePlan) -> list[float]:
    """Distances from the road's centre along which weeds find a joint."""
    behind = free_from_m(plan)
    lines = [behind + 0.04, behind + 0.12]
    if plan.drain in ("none", "apron"):
        lines.append(plan.edge_m + 0.02)
    walk, verge = plan.band("walk"), plan.band("verge")
    if walk is not None:
        lines.append(walk.outer_m)
    if verge is not None:
        lines += [verge.inner_m + 0.2 * plan.verge_m, verge.inner_m + 0.6 * plan.verge_m]
    return lines


def _add_tufts(
    section: StreetSection, built: SectionBuilder, random: Generator, side: int, *, neglect: float
) -> None:
    plan = section.plan
    count = int(min(_MOST_TUFTS, random.poisson(neglect * plan.length_m * 1.6)))
    if count == 0:
        return
    patches = random.uniform(plan.start_m, plan.end_m, max(2, count // 8))
    at = patches[random.integers(0, len(patches), count)] + random.normal(0, 1.2, count)
    at = np.clip(at, plan.start_m + 0.2, plan.end_m - 0.2)
    lines = np.array(_lines(plan.side(side)))
    away = lines[random.integers(0, len(lines), count)] + random.normal(0, 0.02, count)
    feet = section.position(at, side * away)
    size = np.clip(random.lognormal(-2.0, 0.6, count), 0.04, 0.6)
    base = feet[:, None] + random.normal(0, 0.22, (count, _BLADES, 3)) * size[:, None, None]
    base[..., 2] = feet[:, None, 2] - 0.005
    direction = random.normal(0, 0.5, (count, _BLADES, 3))
    direction[..., 2] = random.uniform(0.5, 1.2, (count, _BLADES))
    tips = base + direction * size[:, None, None]
    turn = random.uniform(0, np.pi, (count, _BLADES))
    wide = (0.04 + 0.05 * random.random((count, _BLADES))) * size[:, None] + 0.004
    flat = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=2) * wide[..., None]
    corners = np.stack([base - flat, base + flat, tips], axis=2).reshape(-1, 3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    built.mesh.add((corners, faces), Material.LEAVES, GRASS, NO_THING)


def _add_mat(section: StreetSection, built: SectionBuilder, random: Generator, side: int) -> None:
    """Grass that has grown from the soil over the curb: as irregular as it likes."""
    plan = section.plan
    long = float(random.uniform(0.4, 4.0))
    at = float(random.uniform(plan.start_m + 0.1, plan.end_m - 0.1))
    end = min(at + long, plan.end_m - 0.1)
    count = max(3, int((end - at) / 0.12))
    along = np.linspace(at, end, count)
    behind = free_from_m(plan.side(side)) + 0.2
    swing = np.sin(np.linspace(0, np.pi, count))
    deepest = min(0.5, behind - plan.side(side).edge_m + 0.1)
    reach = 0.05 + swing * float(random.uniform(0.1, deepest)) + random.normal(0, 0.025, count)
    share = np.array([0.0, 0.35, 0.6, 0.75, 0.9, 1.0])
    away = behind - np.clip(reach, 0.02, None)[:, None] * share
    level = 0.035 + random.normal(0, 0.012, away.shape)
    level[:, [0, -1]] = 0.006
    level[[0, -1]] = 0.006
    rows = section.position(along[:, None], side * away, np.maximum(level, 0.004))
    built.mesh.add(grid(rows), Material.GRASS, GRASS, NO_THING)
