"""Where guard rails, fences and rubber poles stand along a section.

Things (label 1): ``guardrail``, ``guard_pipe``, ``guard_cable``, ``fence``, ``parapet``,
``noise_barrier``; ``rubber_pole`` (label 66), which is a delineator of the truth. Barriers
are open where the curb is dropped and where something stands already.
"""

from __future__ import annotations

from collections.abc import Mapping

from numpy.random import Generator

from processing.laboratory.simulate.border.along import posts
from processing.laboratory.simulate.border.barrier_shapes import BARRIERS, BarrierRun
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.things import Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.dropped_curbs import drops_of
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    FreePositions,
    free_from_m,
)
from processing.laboratory.simulate.street.plan import SIDES, SidePlan
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN

POLE = 66

_BEHIND_M = 0.24  # of posts behind the curb or the gutter
_ROOM_M = 0.12  # kept between a barrier and what stands in its way
_LEAST_M = 3.0
_BEHIND_REFLECTORS_M = 0.45
_BANDS_BELOW_M, _BAND_M = (0.16, 0.32), 0.1
"""Below the top of a rubber pole: where its bands of retroreflective sheet begin, and how high they
are (視線誘導標設置基準: delineators reflect)."""

_RUBBER_SHARE = 0.15

_HIGHWAY = {"beam": 0.5, "concrete": 0.15, "cables": 0.15, "pipes": 0.1, "": 0.1}
_MEDIAN = {"beam": 0.5, "concrete": 0.3, "cables": 0.2}
_BESIDE: Mapping[str, Mapping[str, float]] = {
    "fall": {"beam": 0.5, "pipes": 0.2, "cables": 0.1, "concrete": 0.05, "": 0.15},
    "wall": {"beam": 0.08, "": 0.92},
    "rise": {"beam": 0.12, "": 0.88},
    "fields": {"beam": 0.15, "pipes": 0.15, "": 0.7},
    "wood": {"beam": 0.2, "pipes": 0.1, "": 0.7},
    "lots": {"pipes": 0.1, "": 0.9},
}
_AT_WALKS = {"walkers": 0.3, "pipes": 0.15, "beam": 0.05, "": 0.5}


def add_barriers(positions: FreePositions, built: SectionBuilder) -> None:
    """Add barriers and rubber poles along both sides, and in a median without junctions."""
    section = positions.section
    for side in SIDES:
        if side in section.plan.junctions:
            continue
        plan = section.plan.side(side)
        alike = chance(section.seed, "barrier", side, round(plan.drain_m * 1e6))
        random = section.chance("barriers", side)
        kind = _one_of(alike, _shares(section, plan))
        if kind:
            offset = side * (free_from_m(plan) + _behind_m(alike, section, plan))
            for stretch in _stretches(random, positions, side, offset):
                draws = chance(section.seed, "barrier shape", side, round(plan.drain_m * 1e6))
                BARRIERS[kind](draws, section, built, stretch)
        _add_noise_barrier(alike, positions, built, side)
        if not kind:  # rubber poles stand on the line of a barrier's posts
            _add_rubber_poles(random, positions, built, side)
    _add_in_median(section, built)


def _shares(section: StreetSection, plan: SidePlan) -> Mapping[str, float]:
    if section.plan.style is HIGHWAY:
        return _HIGHWAY
    if plan.walk_m > 0:
        return _AT_WALKS if plan.curb != "flat" or plan.walk_m > 2.0 else {"": 1.0}
    return {"": 1.0} if section.plan.style is URBAN else _BESIDE[plan.outside]


def _behind_m(random: Generator, section: StreetSection, plan: SidePlan) -> float:
    """How far behind the curb or gutter a barrier's posts stand."""
    if plan.walk_m > 0 or plan.verge_m < _BEHIND_REFLECTORS_M + 0.2:
        return _BEHIND_M
    most = 0.9 if section.plan.style is HIGHWAY else 0.6
    return float(random.uniform(_BEHIND_REFLECTORS_M, min(most, plan.verge_m - 0.1)))


def _one_of(random: Generator, shares: Mapping[str, float]) -> str:
    names = list(shares)
    return names[int(random.choice(len(names), p=list(shares.values())))]


def _stretches(
    random: Generator, positions: FreePositions, side: int, offset_m: float
) -> list[BarrierRun]:
    """Where a barrier can run along a side: not at dropped curbs, nor through what stands."""
    section = positions.section
    plan = section.plan
    gaps = [
        (one.from_m - 0.2, one.to_m + 0.2) for one in drops_of(section.seed, plan, side)
    ] + list(positions.standing_near(offset_m, _ROOM_M))
    at = plan.start_m + float(random.exponential(25.0))
    while plan.style is not HIGHWAY and at < plan.end_m:
        wide = float(random.uniform(2.0, 14.0))
        gaps.append((at, at + wide))
        at += wide + float(random.uniform(8.0, 60.0))
    free, stretches = plan.start_m, []
    for low, high in [*sorted(gaps), (plan.end_m, plan.end_m)]:
        if low - free > _LEAST_M:
            stretches.append(BarrierRun(free, min(low, plan.end_m), offset_m))
        free = max(free, high)
    return stretches


def _add_noise_barrier(
    random: Generator, positions: FreePositions, built: SectionBuilder, side: int
) -> None:
    """Add a noise barrier at the far edge of a highway's verge."""
    section = positions.section
    outside = section.plan.side(side).band("outside")
    is_wanted = random.random() < 0.3
    if section.plan.style is not HIGHWAY or not is_wanted or outside is None:
        return
    if section.plan.side(side).outside == "wall" or section.plan.side(side).verge_m < 1.2:
        return
    stretch = BarrierRun(section.plan.start_m, section.plan.end_m, side * (outside.inner_m - 0.2))
    BARRIERS["noise"](random, section, built, stretch)


def _add_in_median(section: StreetSection, built: SectionBuilder) -> None:
    plan = section.plan
    alike = chance(section.seed, "median barrier")
    # Wider ones in towns are planted.
    is_wanted = plan.style is HIGHWAY or (plan.median_m < 1.5 and alike.random() < 0.5)
    if plan.median_m < 1.0 or plan.junctions or not is_wanted:
        return
    stretch = BarrierRun(plan.start_m, plan.end_m, 0.0, is_double=True)
    BARRIERS[_one_of(alike, _MEDIAN)](alike, section, built, stretch)


def _add_rubber_poles(
    random: Generator, positions: FreePositions, built: SectionBuilder, side: int
) -> None:
    """Add a group of rubber poles at the edge of a street in a town (ラバーポール)."""
    section = positions.section
    plan = section.plan
    if plan.style is not URBAN or random.random() > _RUBBER_SHARE:
        return
    away = free_from_m(plan.side(side)) + _BEHIND_M
    start = float(random.uniform(plan.start_m + 1.0, plan.end_m - 1.0))
    spacing = float(random.uniform(0.8, 3.0))
    high, radius = float(random.uniform(0.6, 0.8)), float(random.uniform(0.035, 0.045))
    for number in range(int(random.integers(2, 12))):
        spot = FreePosition(start + number * spacing, side * away)
        if not positions.take(spot, 0.1):
            continue
        foot, instance = positions.where(spot), built.thing("rubber_pole")
        built.mesh.add(posts(foot[None], radius, high), Material.PLASTIC, POLE, instance)
        built.mesh.add(posts(foot[None], 0.1, 0.03), Material.RUBBER, POLE, instance)
        for below in _BANDS_BELOW_M:
            band = posts(foot[None] + [0.0, 0.0, high - below], radius + 0.001, _BAND_M, below_m=0)
            built.mesh.add(band, Material.SIGN_FACE, POLE, instance)
        facts: dict[str, Fact] = {
            "kind": "pole",
            "type": "delineator",
            "height_m": high,
            "diameter_m": 2 * radius,
        }
        built.truth.append(
            TrueFeature("poles", "Point", foot[None], facts, instance, spot.chainage_m)
        )
