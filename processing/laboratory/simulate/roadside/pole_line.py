"""Utility poles in a row along the street, known to all sections before any is built.

Cables span from section to section, so that both must agree on the poles: these are drawn by
number from streams of the street and set by the sections' plans alone.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.alignment import Alignment
from processing.laboratory.simulate.street.dropped_curbs import drops_of
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    free_from_m,
    free_to_m,
)
from processing.laboratory.simulate.street.neighbours import driven_m, plans
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SectionPlan
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN, Style

# Prestressed concrete poles (JIS A 5373): 1/75 taper, ends of 14 to 22 cm.
TAPER = 1 / 75
_END_GAP_M = 0.7  # from the ends of a section
_MOST_CABLES = 12
# Cables over roads hang 5 m high (電気設備技術基準の解釈, article 68), their sag included.
_LOWEST_CABLE_M = 6.0
_KERB_GAP_M = 0.12


@dataclass(frozen=True)
class LinePole:
    """A pole that carries cables.

    Attributes
    ----------
    number : int
        Along the chainage; negative before the drive's beginning.
    section : int
        Number of the section it stands in.
    spot : FreePosition
    high_m : float
        Of its top above the carriageway's edge there (cables hang where the road is, whatever
        ground the pole stands on).
    top_diameter_m : float
    lean : (float, float)
        m per m of height along the road and to its left.
    is_telephone : bool
        Shorter, for communication cables alone.
    """

    number: int
    section: int
    spot: FreePosition
    high_m: float
    top_diameter_m: float
    lean: tuple[float, float]
    shifts_m: tuple[float, ...]


@dataclass(frozen=True)
class PoleLine:
    """The poles of a street in their order, and what its cables are like.

    Attributes
    ----------
    cables : (c, 4) float64
        How far below the pole's top, how far to the road's side, radius, sag in a span of 30 m: m.
    """

    poles: tuple[LinePole, ...]
    cables: Floats


def pole_line(section: StreetSection) -> PoleLine:
    """The poles of the street that a section belongs to."""
    return _pole_line(section.seed, section.plan.style, driven_m(section.alignment))


def axis(alignment: Alignment, pole: LinePole, above_m: Floats) -> Floats:
    """Places on the pole's axis: (n,) heights above the carriageway's edge to (n, 3), m."""
    spot = pole.spot
    up = np.asarray(above_m, np.float64)
    edge = alignment.carriageway_height(spot.chainage_m, spot.offset_m)
    heading = float(alignment.heading(spot.chainage_m))
    along, aside = pole.lean
    foot = alignment.at(spot.chainage_m, spot.offset_m, edge)
    direction = np.array(
        [
            along * np.cos(heading) - aside * np.sin(heading),
            along * np.sin(heading) + aside * np.cos(heading),
            1.0,
        ]
    )
    positions: Floats = foot + up[:, None] * direction
    return positions


def cable_ends(alignment: Alignment, pole: LinePole, line: PoleLine) -> Floats:
    """Where the cables are tied to a pole: (c, 3) float64, m, the street's frame."""
    below = line.cables[:, 0] - np.array(pole.shifts_m)[: len(line.cables)]
    aside = -pole.spot.side * line.cables[:, 1]
    heading = float(alignment.heading(pole.spot.chainage_m))
    left = np.array([-np.sin(heading), np.cos(heading), 0.0])
    ends: Floats = axis(alignment, pole, pole.high_m - below) + aside[:, None] * left
    return ends


@lru_cache(maxsize=4)
def _pole_line(seed: int, style: Style, length_m: float) -> PoleLine:
    random = chance(seed, "pole line")
    cables = _cables(seed)
    share = 0.88 if style is URBAN else 0.75
    if style is HIGHWAY or random.random() > share:
        return PoleLine((), cables)
    side = LEFT if random.random() < 0.5 else RIGHT
    pitch = float(random.uniform(25.0, 35.0))
    high = float(random.uniform(8.5, 13.0))
    of_walk = float(random.random())
    cables[:, 0] *= min(1.0, (high - _LOWEST_CABLE_M) / float(cables[:, 0].max()))
    by_number = plans(seed, style, length_m)
    order = [by_number[index] for index in sorted(by_number)]
    starts = [one.start_m for one in order]
    poles = []
    first, last = int(np.ceil(starts[0] / pitch)) + 1, int(order[-1].end_m / pitch) - 1
    for number in range(first, last + 1):
        at = (number + float(chance(seed, "pole at", number).uniform(-0.16, 0.16))) * pitch
        plan = order[bisect_right(starts, at) - 1]
        if side in plan.junctions:
            step = -1 if at - plan.start_m < plan.end_m - at else 1
            plan = by_number.get(plan.index + step, plan)
        beside = [by_number.get(plan.index + one) for one in (-1, 1)]
        sides = [None if one is None else one.side(side) for one in beside]
        near = free_from_m(plan.side(side), *sides)
        pole = _pole(seed, number, plan, _PoleOptions(side, at, high, of_walk, near))
        if pole is not None:
            poles.append(pole)
    return PoleLine(tuple(poles), cables)


@dataclass(frozen=True)
class _PoleOptions:
    side: int
    chainage_m: float
    high_m: float
    walk_share: float
    near_m: float


def _pole(seed: int, number: int, plan: SectionPlan, options: _PoleOptions) -> LinePole | None:
    random = chance(seed, "utility pole", number)
    side = plan.side(options.side)
    at = float(np.clip(options.chainage_m, plan.start_m + _END_GAP_M, plan.end_m - _END_GAP_M))
    high = options.high_m + float(random.normal(0, 0.35))
    top = float(random.choice([0.14, 0.17, 0.19, 0.19, 0.22]))
    radius = (top + high * TAPER) / 2 + 0.05
    near, far = options.near_m + _KERB_GAP_M + radius, free_to_m(side) - radius
    verge = side.band("verge")
    if verge is not None:
        far = max(near, min(far, verge.outer_m - radius))
    for drop in drops_of(seed, plan, options.side):
        if drop.from_m - radius < at < drop.to_m + radius:
            is_early = at - drop.from_m < drop.to_m - at
            at = drop.from_m - radius - 0.1 if is_early else drop.to_m + radius + 0.1
    walk = side.band("walk")
    away = near + float(random.uniform(0.0, 0.25))
    if walk is not None and random.random() < options.walk_share * 0.8:
        away = walk.outer_m + float(random.uniform(-radius, 0.3))
    if options.side in plan.junctions or near > far:
        return None
    away = float(np.clip(away, near, far))
    wide = 0.004 if random.random() < 0.85 else 0.025
    along, aside = random.normal(0, wide, 2)
    return LinePole(
        number,
        plan.index,
        FreePosition(at, options.side * away),
        high,
        top,
        (float(along), float(aside)),
        tuple(float(one) for one in random.normal(0, 0.05, _MOST_CABLES)),
    )


def _cables(seed: int) -> Floats:
    """High voltage on the arm, low voltage below, communication cables lowest."""
    random = chance(seed, "cables")
    rows: list[tuple[float, float, float, float]] = []
    sag = float(random.uniform(0.3, 0.75))
    if random.random() < 0.8:
        wide = float(random.uniform(0.5, 0.8))
        rows += [(0.15, aside, 0.007, sag) for aside in (-wide, wide * 0.35, wide)]
    low = float(random.uniform(1.6, 2.4))
    rows += [
        (low + 0.28 * each, 0.18, float(random.uniform(0.005, 0.009)), sag * 1.1)
        for each in range(int(random.integers(1, 4)))
    ]
    deep = low + float(random.uniform(1.2, 1.9))
    for each in range(int(random.integers(1, 7))):
        radius = float(random.uniform(0.006, 0.015))
        rows.append((deep + 0.22 * each, float(random.uniform(0.15, 0.3)), radius, sag * 1.25))
    return np.array(rows)
