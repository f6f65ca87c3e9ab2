"""Where people walk and cycle: lanes on the walks, broken where something is parked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.moving_traffic.recorded_pass import (
    PlannedMover,
    RecordedPass,
    fill_slots,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import Mover
from processing.laboratory.simulate.street.free_positions import free_from_m
from processing.laboratory.simulate.street.plan import LEFT, SIDES, SectionPlan, SidePlan
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN
from processing.laboratory.simulate.traffic.kinds import KINDS
from processing.laboratory.simulate.traffic.lanes import TrafficLane, stretches_of, swing_of
from processing.laboratory.simulate.traffic.parking import ParkingPosition, parking_positions

_FILLS = {"person": 1.0, "bicycle": 0.3}
_SWAY_M = {"person": 0.04, "bicycle": 0.08}
_LANES = 5
_APART_M = 1.3
_HALF_M = 0.4  # of a person, for whom the walk must have room
_BUSY = {"urban": (0.03, 0.5), "rural": (0.0, 0.08)}
_POSTS_M, _BACK_M = 1.35, 0.85  # kept clear of a wide walk: posts, trees and boxes stand there
_FREE_M = 0.3  # what has to be left of a walk between them
_ROOM_M = 0.9  # between a walker's middle and what is parked, along the road


class Walks:
    """The walks of a street, as those see them who walk.

    Parameters
    ----------
    plans : sequence of SectionPlan
        In their order.
    """

    def __init__(self, seed: int, plans: Sequence[SectionPlan]) -> None:
        self._seed, self._plans = seed, plans
        self._starts = np.array([one.start_m for one in plans])
        self._positions: dict[int, list[ParkingPosition]] = {}

    def has_room(self, lane: TrafficLane, chainages: Floats) -> NDArray[np.bool_]:
        """Whether the walk carries a lane at chainages, and nothing may be parked on it."""
        rows = np.searchsorted(self._starts, chainages, "right") - 1
        free = np.zeros(chainages.size, np.bool_)
        for row in np.unique(rows[rows >= 0]).tolist():
            here = rows == row
            free[here] = self._is_free(row, lane, chainages[here])
        return free

    def _is_free(self, row: int, lane: TrafficLane, chainages: Floats) -> NDArray[np.bool_]:
        plan = self._plans[row]
        side = LEFT if lane.offset_m > 0 else -LEFT
        away = abs(lane.offset_m)
        low, far = _walked(plan.side(side))
        if not low <= away <= far:
            return np.zeros(chainages.size, np.bool_)
        free = (chainages > plan.start_m) & (chainages < plan.end_m)
        for start, end in self._taken(row, side, away):
            free &= (chainages < start) | (chainages > end)
        return np.asarray(free)

    def _taken(self, row: int, side: int, away: float) -> Iterator[tuple[float, float]]:
        """Chainages between which something may be parked in the way."""
        if row not in self._positions:
            self._positions[row] = parking_positions(self._seed, self._plans[row])
        for one in self._positions[row]:
            reach = one.across_m / 2 + 2 * _HALF_M
            if one.side == side and abs(abs(one.offset_m) - away) <= reach:
                half = one.along_m / 2 + _ROOM_M
                yield one.chainage_m - half, one.chainage_m + half


def _walked(side: SidePlan) -> tuple[float, float]:
    """From and to which distance of the road's centre people walk; from > to where they don't.

    Wide walks leave room between what stands behind the curb and what stands at their far edge.
    """
    walk = side.band("walk")
    if walk is None:
        return np.inf, -np.inf
    low, far = walk.inner_m + _HALF_M, walk.outer_m - _HALF_M
    behind_posts = max(low, free_from_m(side) + _POSTS_M)
    if far - behind_posts < _FREE_M:
        return low, far
    before_back = walk.outer_m - _BACK_M
    return behind_posts, before_back if before_back - behind_posts >= _FREE_M else far


def walking_lanes(recorded: RecordedPass) -> list[TrafficLane]:
    """Lanes beside the road on which people walk, stand and cycle in a pass."""
    seed, style, number = recorded.seed, recorded.style, recorded.number
    if style is HIGHWAY:
        return []
    lanes = []
    busy = float(chance(seed, "busy", number).uniform(*_BUSY[style.id]))
    for side in SIDES:
        inner = recorded.plan.side(side).edge_m + float(
            chance(seed, "walks", side).uniform(0.6, 1.6)
        )
        for position in range(_LANES):
            random = chance(seed, "walkers' lane", number, side, position)
            direction = 1.0 if random.random() < 0.5 else -1.0
            kind = "bicycle" if style is URBAN and random.random() < 0.25 else "person"
            speed = direction * float(
                random.uniform(2.5, 4.5) if kind == "bicycle" else random.uniform(0.7, 1.7)
            )
            if kind == "person" and random.random() < 0.12:
                speed = 0.0
            slot = KINDS[kind].length_m + 2.6 + float(random.exponential(6.0))
            lanes.append(
                TrafficLane(
                    "walkers", 10 * (side == LEFT) + position, side * (inner + position * _APART_M),
                    speed, 0.0 if direction > 0 else np.pi, slot, busy * _FILLS[kind], {kind: 1.0},
                    _APART_M,
                )
            )  # fmt: skip
    return lanes


def walkers_of(recorded: RecordedPass, lane: TrafficLane, walks: Walks) -> list[PlannedMover]:
    """Those who walk or cycle along, wherever the walk has their lane."""
    orders = []
    for slot, random, body, mesh in fill_slots(recorded, lane):
        swing = swing_of(random, lane, body.length_m)
        mover = Mover(
            mesh,
            slot.middle_m + swing.from_middle_m,
            lane.offset_m,
            lane.speed_m_s,
            -np.inf,
            np.inf,
            turn_rad=lane.turn_rad + (0.0 if lane.speed_m_s else float(random.normal(0, 0.1))),
            sway_m=_SWAY_M.get(body.kind, 0.0) if lane.speed_m_s else 0.0,
            sway_s=float(
                random.uniform(0.9, 1.3) if body.kind == "person" else random.uniform(2, 4)
            ),
            surge_m=swing.surge_m,
            surge_s=swing.surge_s,
            phase_rad=swing.phase_rad,
            kind=body.kind,
        )
        times = recorded.course[slot.first : slot.last + 1, 0]
        at, _ = mover.direction_at(times)
        inside = walks.has_room(lane, at)
        for first, last in stretches_of(inside):
            start, end = recorded.span(slot.first + first, slot.first + last)
            one = replace(mover, from_s=start, to_s=end)
            orders.append(
                PlannedMover(max(0.0, one.from_s), f"walkers {lane.number}", slot.number, one)
            )
    return orders
