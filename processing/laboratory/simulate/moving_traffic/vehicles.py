"""Vehicles that drive: in the other lanes, and ahead of the recording vehicle and behind it.

No vehicle leaves its lane, and the recording vehicle's holds only those that keep their distance.
"""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.moving_traffic.recorded_pass import (
    BODIES,
    PlannedMover,
    RecordedPass,
    fill_slots,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.things import Mover
from processing.laboratory.simulate.street.plan import LEFT
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL
from processing.laboratory.simulate.traffic.bodies import TrafficBody
from processing.laboratory.simulate.traffic.kinds import KINDS
from processing.laboratory.simulate.traffic.lanes import TrafficLane, kind_drawn, swing_of
from processing.laboratory.simulate.traffic.parking import has_parking

_VEHICLES = {
    "kei_car": 0.3, "saloon": 0.33, "van": 0.12, "small_truck": 0.1, "truck": 0.07, "bus": 0.03,
    "motorcycle": 0.05,
}  # fmt: skip
_SIDE_ROOM_M = 0.15  # between a body and the lane's edge
_OVERTAKING = 1.2  # how much faster the inner lanes are
_PARKED_ROOM_M = 0.95  # half the width of what passes where vehicles are parked


def companions_of(recorded: RecordedPass) -> list[PlannedMover]:
    """Those that drive ahead of the recording vehicle and behind it, whatever it does."""
    direction, plan, orders = recorded.direction, recorded.plan, []
    kinds = _fitting(plan.lane_m, is_narrow=has_parking(recorded.seed, plan.style, direction))
    for row, side in enumerate((1, -1)):
        random = chance(recorded.seed, "companions", recorded.number, side)
        if random.random() > 0.6:
            continue
        edge = float(random.uniform(15, 40))
        for number in range(int(random.integers(1, 4))):
            kind = kind_drawn(random, kinds)
            body, mesh = recorded.bodies.one(kind, int(random.integers(BODIES)))
            surge = float(random.uniform(0, 1.5))
            reach = body.length_m / 2 + surge
            mover = Mover(
                mesh,
                direction * side * (edge + reach),
                direction * plan.lane_offset_m(0) + _beside(random, plan.lane_m, body),
                0.0,
                -np.inf,
                np.inf,
                turn_rad=0.0 if direction > 0 else np.pi,
                surge_m=surge,
                surge_s=float(random.uniform(15, 50)),
                phase_rad=float(random.uniform(0, 2 * np.pi)),
                course=recorded.course,
                kind=body.kind,
            )
            orders.append(PlannedMover(0.0, "companions", 10 * row + number, mover))
            edge += 2 * reach + float(random.uniform(2.5, 18))
    return orders


def vehicle_lanes(recorded: RecordedPass) -> list[TrafficLane]:
    """All lanes but the recording vehicle's."""
    seed, style, plan = recorded.seed, recorded.style, recorded.plan
    direction, lanes = recorded.direction, []
    for side in (direction, -direction):
        is_narrow = has_parking(seed, style, side)
        for number in range(plan.lanes):
            if side == direction and number == 0:
                continue
            random = chance(seed, "lane", recorded.number, side, number)
            usual = float(random.uniform(*style.speed_m_s)) * float(random.uniform(0.9, 1.3))
            kinds = _fitting(plan.lane_m, is_narrow=is_narrow and number == 0)
            state, dense = float(random.random()), float(random.uniform(1.8, 7.0))
            speed, fill = usual, float(random.uniform(0.25, 0.85))
            if side == direction:
                speed *= _OVERTAKING
            if style is RURAL:
                fill *= 0.4
            elif style is not HIGHWAY and state < 0.18:
                speed = 0.0 if state < 0.09 else float(random.uniform(0.4, 3.0))
                fill = 0.93
            longest = max(KINDS[kind].length_m for kind in kinds)
            slot = max(longest + 3.5, speed * dense)
            lanes.append(
                TrafficLane(
                    "vehicles", 10 * (side == LEFT) + number, side * plan.lane_offset_m(number),
                    side * speed, 0.0 if side == LEFT else np.pi, slot, fill, kinds, plan.lane_m,
                )
            )  # fmt: skip
    return lanes


def vehicles_of(recorded: RecordedPass, lane: TrafficLane) -> list[PlannedMover]:
    """The vehicles of a lane."""
    orders = []
    for slot, random, body, mesh in fill_slots(recorded, lane):
        swing = swing_of(random, lane, body.length_m)
        mover = Mover(
            mesh,
            slot.middle_m + swing.from_middle_m,
            lane.offset_m + _beside(random, lane.wide_m, body),
            lane.speed_m_s,
            *recorded.span(slot.first, slot.last),
            turn_rad=lane.turn_rad,
            surge_m=swing.surge_m,
            surge_s=swing.surge_s,
            phase_rad=swing.phase_rad,
            kind=body.kind,
        )
        orders.append(
            PlannedMover(max(0.0, mover.from_s), f"vehicles {lane.number}", slot.number, mover)
        )
    return orders


def _fitting(lane_m: float, *, is_narrow: bool) -> dict[str, float]:
    """Kinds of vehicles that fit in a lane, beside parked ones if it is narrow."""
    most = 2 * _PARKED_ROOM_M if is_narrow else lane_m - 2 * _SIDE_ROOM_M
    most = min(most, lane_m - 2 * _SIDE_ROOM_M)
    return {kind: share for kind, share in _VEHICLES.items() if KINDS[kind].width_m <= most}


def _beside(random: np.random.Generator, lane_m: float, body: TrafficBody) -> float:
    """How far a vehicle drives beside the lane's middle, within the lane."""
    room = min(0.25, max(0.0, (lane_m - body.width_m) / 2 - _SIDE_ROOM_M))
    return float(random.uniform(-room, room))
