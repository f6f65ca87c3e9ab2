"""Where guard rails, fences and delineators stand along a section.

Things (label 1): ``guardrail``, ``guard_pipe``, ``guard_cable``, ``fence``, ``parapet``,
``noise_barrier``; ``delineator`` and ``rubber_pole`` (label 66) are poles of the truth. Barriers
are open where the curb is dropped and where something stands already.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.random import Generator

from processing.simulate.border.along import posts
from processing.simulate.border.barrier_shapes import BARRIERS, Stretch
from processing.simulate.chance import chance
from processing.simulate.materials import Material
from processing.simulate.mesh import plate
from processing.simulate.roadside.places import Places, Spot, free_from_m
from processing.simulate.street.dropped_curbs import drops_of
from processing.simulate.street.plan import SIDES, SidePlan
from processing.simulate.street.section import Section
from processing.simulate.street.styles import HIGHWAY, URBAN
from processing.simulate.things import Built, Fact, TrueFeature

POLE = 66

_BEHIND_M = 0.24  # of posts behind the curb or the gutter
_ROOM_M = 0.12  # kept between a barrier and what stands in its way
_LEAST_M = 3.0

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


def add_barriers(places: Places, built: Built) -> None:
    """Add barriers and delineators along both sides, and in a median without junctions."""
    section = places.section
    for side in SIDES:
        if side in section.plan.junctions:
            continue
        plan = section.plan.side(side)
        alike = chance(section.seed, "barrier", side, round(plan.drain_m * 1e6))
        random = section.chance("barriers", side)
        kind = _one_of(alike, _shares(section, plan))
        if kind:
            offset = side * (free_from_m(plan) + _behind_m(alike, section, plan))
            for stretch in _stretches(random, places, side, offset):
                draws = chance(section.seed, "barrier shape", side, round(plan.drain_m * 1e6))
                BARRIERS[kind](draws, section, built, stretch)
        _add_noise_barrier(alike, places, built, side)
        _add_delineators(random, places, built, side)
    _add_in_median(section, built)


def _shares(section: Section, plan: SidePlan) -> Mapping[str, float]:
    if section.plan.style is HIGHWAY:
        return _HIGHWAY
    if plan.walk_m > 0:
        return _AT_WALKS if plan.curb != "flat" or plan.walk_m > 2.0 else {"": 1.0}
    return {"": 1.0} if section.plan.style is URBAN else _BESIDE[plan.outside]


def _behind_m(random: Generator, section: Section, plan: SidePlan) -> float:
    """How far behind the curb or gutter a barrier's posts stand."""
    if plan.walk_m > 0 or plan.verge_m < 0.6:
        return _BEHIND_M
    most = 0.9 if section.plan.style is HIGHWAY else 0.5
    return float(random.uniform(_BEHIND_M, min(most, plan.verge_m - 0.2)))


def _one_of(random: Generator, shares: Mapping[str, float]) -> str:
    names = list(shares)
    return names[int(random.choice(len(names), p=list(shares.values())))]


def _stretches(random: Generator, places: Places, side: int, offset_m: float) -> list[Stretch]:
    """Where a barrier can run along a side: not at dropped curbs, nor through what stands."""
    section = places.section
    plan = section.plan
    gaps = [
        (one.from_m - 0.2, one.to_m + 0.2) for one in drops_of(section.seed, plan, side)
    ] + list(places.standing_near(offset_m, _ROOM_M))
    at = plan.start_m + float(random.exponential(25.0))
    while plan.style is not HIGHWAY and at < plan.end_m:
        wide = float(random.uniform(2.0, 14.0))
        gaps.append((at, at + wide))
        at += wide + float(random.uniform(8.0, 60.0))
    free, stretches = plan.start_m, []
    for low, high in [*sorted(gaps), (plan.end_m, plan.end_m)]:
        if low - free > _LEAST_M:
            stretches.append(Stretch(free, min(low, plan.end_m), offset_m))
        free = max(free, high)
    return stretches


def _add_noise_barrier(random: Generator, places: Places, built: Built, side: int) -> None:
    """Add a noise barrier at the far edge of a highway's verge."""
    section = places.section
    outside = section.plan.side(side).band("outside")
    is_wanted = random.random() < 0.3
    if section.plan.style is not HIGHWAY or not is_wanted or outside is None:
        return
    if section.plan.side(side).outside == "wall" or section.plan.side(side).verge_m < 1.2:
        return
    stretch = Stretch(section.plan.start_m, section.plan.end_m, side * (outside.inner_m - 0.2))
    BARRIERS["noise"](random, section, built, stretch)


def _add_in_median(section: Section, built: Built) -> None:
    plan = section.plan
    alike = chance(section.seed, "median barrier")
    is_wanted = plan.style is HIGHWAY or alike.random() < 0.25
    if plan.median_m < 1.0 or plan.junctions or not is_wanted:
        return
    stretch = Stretch(plan.start_m, plan.end_m, 0.0, is_double=True)
    BARRIERS[_one_of(alike, _MEDIAN)](alike, section, built, stretch)


def _add_delineators(random: Generator, places: Places, built: Built, side: int) -> None:
    """Add posts with reflectors every 10–40 m, or groups of rubber poles in towns."""
    section = places.section
    plan = section.plan
    away = free_from_m(plan.side(side)) + _BEHIND_M
    if plan.style is URBAN:
        if random.random() < 0.15:
            start = float(random.uniform(plan.start_m + 1.0, plan.end_m - 1.0))
            spacing = float(random.uniform(0.8, 3.0))
            for number in range(int(random.integers(2, 12))):
                spot = Spot(start + number * spacing, side * away)
                if places.take(spot, 0.1):
                    _add_pole(random, built, places, spot, is_rubber=True)
        return
    if random.random() < 0.45:
        spacing = float(random.uniform(10.0, 40.0))
        for at in np.arange(plan.start_m + spacing / 2, plan.end_m, spacing):
            spot = Spot(float(at + random.normal(0, 0.3)), side * (away + 0.1))
            if places.take(spot, 0.1):
                _add_pole(random, built, places, spot, is_rubber=False)


def _add_pole(
    random: Generator, built: Built, places: Places, spot: Spot, *, is_rubber: bool
) -> None:
    foot = places.where(spot)
    kind = "rubber_pole" if is_rubber else "delineator"
    instance = built.thing(kind)
    high = float(random.uniform(0.6, 0.8) if is_rubber else random.uniform(0.85, 1.2))
    radius = float(random.uniform(0.035, 0.045) if is_rubber else random.uniform(0.03, 0.045))
    material = Material.PLASTIC if is_rubber else Material.PAINTED_METAL
    built.mesh.add(posts(foot[None], radius, high), material, POLE, instance)
    if is_rubber:
        built.mesh.add(posts(foot[None], 0.1, 0.03), Material.RUBBER, POLE, instance)
    else:
        heading = places.section.heading(spot.chainage_m)
        forward = np.array([np.cos(heading), np.sin(heading), 0.0])
        left = np.array([-np.sin(heading), np.cos(heading), 0.0])
        angles = np.arange(10) * np.pi / 5
        middle = foot + [0.0, 0.0, high - 0.02]  # noqa: RUF005 (added, not joined)
        for way in (-1.0, 1.0):
            disc = 0.05 * (np.cos(angles)[:, None] * left + np.sin(angles)[:, None] * [0, 0, 1])
            outline = middle + way * (radius + 0.01) * forward + disc
            built.mesh.add(plate(outline), Material.SIGN_FACE, POLE, instance)
    facts: dict[str, Fact] = {
        "kind": "pole",
        "type": kind,
        "height_m": high,
        "diameter_m": 2 * radius,
    }
    built.truth.append(TrueFeature("poles", "Point", foot[None], facts, instance, spot.chainage_m))
