"""The raised strip between both directions, open at junctions, with round or tapered noses."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.ground import Strip
from processing.laboratory.simulate.street.plan import SIDES, SectionPlan
from processing.laboratory.simulate.street.profile import (
    CURB,
    GRASS,
    GROUND,
    STONE_TOP_M,
    Edge,
    RoadProfile,
)
from processing.laboratory.simulate.street.sweep import Straight, Sweep
from processing.laboratory.simulate.street.terrain import SectionTerrain

_TIP_M = 0.001


def opening_of(plan: SectionPlan, mouth_m: tuple[float, float] | None) -> tuple[float, float]:
    """From where to where the median is open; an empty stretch where it is not."""
    if mouth_m is None:
        return plan.end_m + 1.0, plan.end_m + 1.0
    return max(plan.start_m + 2.0, mouth_m[0]), min(plan.end_m - 2.0, mouth_m[1])


def median_nodes(plan: SectionPlan, opening: tuple[float, float]) -> Floats:
    """Chainages at which the median's lines bend: (n,) float64."""
    nodes = [np.linspace(plan.start_m, plan.end_m, int(plan.length_m / 0.5) + 2)]
    if opening[1] > opening[0]:
        fine = 3.0 * np.linspace(0, 1, 13) ** 2
        nodes += [opening[0] - fine, opening[1] + fine]
        nodes += [np.array([opening[0] + _TIP_M, opening[1] - _TIP_M])]
    every = np.unique(np.concatenate(nodes))
    every = every[(every >= plan.start_m) & (every <= plan.end_m)]
    kept: Floats = every[np.append(True, np.diff(every) > _TIP_M / 2)]
    return kept


def median_of(
    seed: int,
    plan: SectionPlan,
    terrain: SectionTerrain,
    nodes: Floats,
    opening: tuple[float, float],
) -> tuple[Sweep, ...]:
    """Both halves of the median on these nodes; none where the street has none."""
    if plan.median_m <= 0:
        return ()
    random = chance(seed, "median")
    high = float(random.uniform(0.12, 0.25))
    chamfer = float(random.uniform(0.005, 0.025))
    batter = float(random.uniform(0.05, 0.1))
    nose = float(random.choice([plan.median_m / 2, 3.0]))
    tops = ((Material.GRASS, GRASS), (Material.PAVING, GROUND), (Material.OLD_CONCRETE, GROUND))
    top, label = tops[int(random.integers(3))]
    if opening[1] > opening[0]:
        nose = min(nose, opening[0] - plan.start_m, plan.end_m - opening[1])
    before = (opening[0] - nodes) / nose
    behind = (nodes - opening[1]) / nose
    within = np.clip(np.where(nodes <= opening[0], before, behind), 0.0, 1.0)
    is_there = (nodes <= opening[0]) | (nodes >= opening[1])
    half = plan.median_m / 2 * np.sqrt(1 - (1 - within) ** 2)
    if opening[1] <= opening[0]:
        half, is_there = np.full(nodes.size, plan.median_m / 2), np.ones(nodes.size, np.bool_)
    rise = np.where(is_there, high, 0.0)
    profile = RoadProfile()
    surface = Strip("median", top, label)
    stone = Strip("curb", Material.CONCRETE, CURB)
    lean = batter * rise
    flat = np.minimum(chamfer, 0.4 * half)
    profile.line(0.0 * half, rise)
    inner = np.maximum(half - lean - STONE_TOP_M, 0.0)
    start = profile.line(inner, rise, surface)
    profile.line(np.maximum(half - lean - flat, 0.0), rise, stone)
    profile.line(half - batter * (rise - flat), rise - np.minimum(flat, rise), stone)
    foot = profile.line(half, 0.0 * half, stone)
    edge = np.maximum(half - lean, 0.0)
    profile.edges.append(Edge("median", foot, start, edge, rise, chamfer, 0.0 * half))
    return tuple(Sweep.along(Straight(nodes, side), profile, terrain, side) for side in SIDES)
