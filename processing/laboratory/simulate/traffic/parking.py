"""Where vehicles and bicycles may be parked, before anyone looks whether there is room.

Places follow from seed and plan alone, so that those who walk can keep clear of them without the
section being built.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.street.plan import LEFT, SIDES, SectionPlan
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN, Style
from processing.laboratory.simulate.traffic.kinds import KINDS

_PASSING_M = 1.3  # from a lane's middle to what is parked: half a vehicle and some room
_END_M = 1.5
_GAP_M = 0.7
_STREETS_WITH = {"urban": 0.6, "rural": 0.2, "highway": 0.04}
_YARDS = {"urban": 1.6, "rural": 0.5}  # vehicles per side and section


@dataclass(frozen=True)
class ParkingPosition:
    """Where something may stand.

    Attributes
    ----------
    number : int
        In its section; its body is drawn by it.
    kind : str
        Of `KINDS`.
    side : int
    chainage_m, offset_m : float
        Of its middle; the offset to the left of the road's centre.
    turn_rad : float
        Where it faces, anticlockwise from the road's direction.
    along_m, across_m : float
        Of the road it takes at most.
    """

    number: int
    kind: str
    side: int
    chainage_m: float
    offset_m: float
    turn_rad: float
    along_m: float
    across_m: float


def has_parking(seed: int, style: Style, side: int) -> bool:
    """Whether vehicles stand at this edge of a street at all."""
    return bool(chance(seed, "parking", side).random() < _STREETS_WITH[style.id])


def parking_positions(seed: int, plan: SectionPlan) -> list[ParkingPosition]:
    """All places of a section, whether something hinders them or not."""
    positions: list[ParkingPosition] = []
    for side in SIDES:
        if side in plan.junctions:
            continue
        random = chance(seed, "parking places", plan.index, side)
        if has_parking(seed, plan.style, side):
            _add_at_the_edge(positions, random, plan, side)
        if plan.style is not HIGHWAY and plan.side(side).outside == "lots":
            _add_in_yards(positions, random, plan, side)
        if plan.style is URBAN:
            _add_bicycles(positions, random, plan, side)
    return positions


def _add_at_the_edge(
    positions: list[ParkingPosition], random: Generator, plan: SectionPlan, side: int
) -> None:
    """A row along the road, partly on the walk where the road is narrow."""
    plan_of_side = plan.side(side)
    if plan_of_side.strip_m > 0 or plan_of_side.drain == "open":
        return
    inner = plan.lane_offset_m(0) + _PASSING_M
    outer = max(band.inner_m for band in plan_of_side.bands()) - 0.1
    share = float(random.beta(0.7, 2.0))
    at = plan.start_m + _END_M
    while True:
        names = ("kei_car", "saloon", "van", "small_truck", "truck")
        kind = KINDS[names[int(random.choice(5, p=[0.35, 0.3, 0.2, 0.13, 0.02]))]]
        long = kind.length_m + _GAP_M + float(random.exponential(1.0))
        if at + long > plan.end_m - _END_M:
            return
        middle, spare = at + long / 2, outer - inner - kind.width_m
        at += long
        is_taken, aside = random.random() < share, float(random.uniform(0, 1))
        turn, is_contrary = float(random.normal(0, 0.02)), random.random() < 0.1
        if not is_taken or spare < 0:
            continue
        away = inner + aside * min(spare, 0.6) + kind.width_m / 2
        faces_back = (side != LEFT) != is_contrary
        positions.append(
            ParkingPosition(
                len(positions), kind.name, side, middle, side * away,
                turn + (np.pi if faces_back else 0.0), long, kind.width_m,
            )
        )  # fmt: skip


def _add_in_yards(
    positions: list[ParkingPosition], random: Generator, plan: SectionPlan, side: int
) -> None:
    """Square to the road or along it, on the land beside it."""
    inner = max(band.inner_m for band in plan.side(side).bands())
    if plan.length_m < 12:
        return
    for _ in range(int(random.poisson(_YARDS[plan.style.id]))):
        names = ("kei_car", "saloon", "van", "small_truck")
        kind = KINDS[names[int(random.choice(4, p=[0.4, 0.35, 0.15, 0.1]))]]
        is_square = random.random() < 0.75
        deep, wide = kind.length_m, kind.width_m
        if not is_square:
            deep, wide = wide, deep
        turn = (np.pi / 2 if is_square else 0.0) + (np.pi if random.random() < 0.5 else 0.0)
        turn += float(random.normal(0, 0.06))
        away = inner + 0.5 + deep / 2 + float(random.exponential(1.5))
        middle = float(random.uniform(plan.start_m + 4, plan.end_m - 4))
        positions.append(
            ParkingPosition(
                len(positions), kind.name, side, middle, side * away, turn, wide + 0.4, deep + 0.4
            )
        )


def _add_bicycles(
    positions: list[ParkingPosition], random: Generator, plan: SectionPlan, side: int
) -> None:
    """A row of bicycles, or a motorcycle, at the far edge of the walk."""
    walk = plan.side(side).band("walk")
    if walk is None or walk.outer_m - walk.inner_m < 2.0 or random.random() > 0.35:
        return
    at = float(random.uniform(plan.start_m + 2, max(plan.start_m + 2.1, plan.end_m - 8)))
    lean = float(random.uniform(-0.5, 0.5))
    for _ in range(int(random.integers(1, 8))):
        kind = KINDS["bicycle" if random.random() < 0.85 else "motorcycle"]
        at += float(random.uniform(0.75, 1.0))
        if at > plan.end_m - 1.0:
            return
        turn = side * np.pi / 2 + lean + float(random.normal(0, 0.06))
        away = walk.outer_m - 0.15 - kind.length_m / 2 * float(np.cos(lean))
        positions.append(
            ParkingPosition(
                len(positions), kind.name, side, at, side * away, turn, 1.0, kind.length_m
            )
        )
