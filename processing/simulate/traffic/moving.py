"""Movers of a pass: oncoming, overtaking, ahead and behind; walking, cycling, crossing.

What comes depends on lanes, slots and times that are drawn one by one, so a longer recording
begins like a shorter one. Lanes lie side by side and no mover leaves its own; the recording
vehicle's lane holds only those that keep their distance from it.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, replace

import numpy as np

from processing.simulate.chance import chance
from processing.simulate.mesh import Floats, Mesh
from processing.simulate.scanning.passes import Pass
from processing.simulate.street.plan import LEFT, RIGHT, SectionPlan
from processing.simulate.street.street import Street
from processing.simulate.street.styles import HIGHWAY, RURAL, Style
from processing.simulate.things import Mover
from processing.simulate.traffic.bodies import Body
from processing.simulate.traffic.kinds import KINDS
from processing.simulate.traffic.lanes import (
    Lane,
    kind_drawn,
    slot_chance,
    slots_near,
    stretches_of,
    swing_of,
)
from processing.simulate.traffic.parking import has_parking
from processing.simulate.traffic.walking import Walks, walking_lanes

MOST_INSTANCES = 18_000
"""Movers have the numbers 1 to this; beyond it the first numbers come again."""

_STEP_S = 0.25
_BODIES = 48  # of each kind, in one street
_VEHICLES = {
    "kei_car": 0.3, "saloon": 0.33, "van": 0.12, "small_truck": 0.1, "truck": 0.07, "bus": 0.03,
    "motorcycle": 0.05,
}  # fmt: skip
_SWAY_M = {"person": 0.04, "bicycle": 0.08}
_SIDE_ROOM_M = 0.15  # between a body and the lane's edge
_OVERTAKING = 1.2  # how much faster the inner lanes are
_PARKED_ROOM_M = 0.95  # half the width of what passes where vehicles are parked


@dataclass(frozen=True)
class _Order:
    """A mover before it has its number."""

    first_s: float
    lane: str
    number: int
    mover: Mover


class _Bodies:
    """Bodies of a street's traffic, each made once."""

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._made: OrderedDict[tuple[str, int], tuple[Body, Mesh]] = OrderedDict()

    def one(self, kind: str, number: int) -> tuple[Body, Mesh]:
        """A body and its triangles."""
        key = kind, number % _BODIES
        if key not in self._made:
            body = KINDS[kind].drawn(chance(self._seed, "body", *key))
            self._made[key] = body, body.mesh(1)
        return self._made[key]


def movers_of(street: Street, driven: Pass) -> list[Mover]:
    """All that moves, or waits, around the recording vehicle during a pass.

    Each has an instance of its own, from 1, in the order in which they come near.
    """
    course = _course(driven)
    bodies = _Bodies(street.seed)
    plan = street.plans[0]
    orders = _companions(street.seed, driven, course, plan, bodies)
    for lane in _vehicle_lanes(street.seed, street.style, plan, driven):
        orders += _stream(street.seed, driven.number, lane, course, bodies)
    walks = Walks(street.seed, street.plans)
    for lane in walking_lanes(street.seed, street.style, plan, driven.number):
        orders += _walkers(street.seed, driven.number, lane, course, bodies, walks)
    orders.sort(key=lambda one: (one.first_s, one.lane, one.number))
    return [_numbered(one.mover, row % MOST_INSTANCES + 1) for row, one in enumerate(orders)]


def _course(driven: Pass) -> Floats:
    """Times and chainages of the recording vehicle, four a second."""
    times = np.arange(0.0, driven.duration_s, _STEP_S)
    return np.column_stack([times, driven.chainage_at(times)])


def _numbered(mover: Mover, instance: int) -> Mover:
    mesh = mover.mesh
    return replace(mover, mesh=replace(mesh, instance=np.full_like(mesh.instance, instance)))


def _companions(
    seed: int, driven: Pass, course: Floats, plan: SectionPlan, bodies: _Bodies
) -> list[_Order]:
    """Those that drive ahead of the recording vehicle and behind it, whatever it does."""
    way, orders = _way(driven), []
    kinds = _fitting(plan.lane_m, is_narrow=has_parking(seed, plan.style, way))
    for row, side in enumerate((1, -1)):
        random = chance(seed, "companions", driven.number, side)
        if random.random() > 0.6:
            continue
        edge = float(random.uniform(15, 40))
        for number in range(int(random.integers(1, 4))):
            kind = kind_drawn(random, kinds)
            body, mesh = bodies.one(kind, int(random.integers(_BODIES)))
            surge = float(random.uniform(0, 1.5))
            reach = body.length_m / 2 + surge
            mover = Mover(
                mesh,
                way * side * (edge + reach),
                way * plan.lane_offset_m(0) + _beside(random, plan.lane_m, body),
                0.0,
                -np.inf,
                np.inf,
                turn_rad=0.0 if way > 0 else np.pi,
                surge_m=surge,
                surge_s=float(random.uniform(15, 50)),
                phase_rad=float(random.uniform(0, 2 * np.pi)),
                course=course,
                kind=body.kind,
            )
            orders.append(_Order(0.0, "companions", 10 * row + number, mover))
            edge += 2 * reach + float(random.uniform(2.5, 18))
    return orders


def _vehicle_lanes(seed: int, style: Style, plan: SectionPlan, driven: Pass) -> list[Lane]:
    """All lanes but the recording vehicle's."""
    way, lanes = _way(driven), []
    for side in (way, -way):
        is_narrow = has_parking(seed, style, side)
        for number in range(plan.lanes):
            if side == way and number == 0:
                continue
            random = chance(seed, "lane", driven.number, side, number)
            usual = float(random.uniform(*style.speed_m_s)) * float(random.uniform(0.9, 1.3))
            kinds = _fitting(plan.lane_m, is_narrow=is_narrow and number == 0)
            state, dense = float(random.random()), float(random.uniform(1.8, 7.0))
            speed, fill = usual, float(random.uniform(0.25, 0.85))
            if side == way:
                speed *= _OVERTAKING
            if style is RURAL:
                fill *= 0.4
            elif style is not HIGHWAY and state < 0.18:
                speed = 0.0 if state < 0.09 else float(random.uniform(0.4, 3.0))
                fill = 0.93
            longest = max(KINDS[kind].length_m for kind in kinds)
            slot = max(longest + 3.5, speed * dense)
            lanes.append(
                Lane(
                    "vehicles", 10 * (side == LEFT) + number, side * plan.lane_offset_m(number),
                    side * speed, 0.0 if side == LEFT else np.pi, slot, fill, kinds, plan.lane_m,
                )
            )  # fmt: skip
    return lanes


def _fitting(lane_m: float, *, is_narrow: bool) -> dict[str, float]:
    """Kinds of vehicles that fit in a lane, beside parked ones if it is narrow."""
    most = 2 * _PARKED_ROOM_M if is_narrow else lane_m - 2 * _SIDE_ROOM_M
    most = min(most, lane_m - 2 * _SIDE_ROOM_M)
    return {kind: share for kind, share in _VEHICLES.items() if KINDS[kind].width_m <= most}


def _beside(random: np.random.Generator, lane_m: float, body: Body) -> float:
    """How far a vehicle drives beside the lane's middle, within the lane."""
    room = min(0.25, max(0.0, (lane_m - body.width_m) / 2 - _SIDE_ROOM_M))
    return float(random.uniform(-room, room))


def _stream(seed: int, number: int, lane: Lane, course: Floats, bodies: _Bodies) -> list[_Order]:
    """The vehicles of a lane."""
    orders = []
    for slot in slots_near(lane, course):
        random = slot_chance(seed, number, lane, slot)
        if random is None:
            continue
        kind = kind_drawn(random, lane.kinds)
        body, mesh = bodies.one(kind, int(random.integers(_BODIES)))
        swing = swing_of(random, lane, body.length_m)
        mover = Mover(
            mesh,
            slot.middle_m + swing.from_middle_m,
            lane.offset_m + _beside(random, lane.wide_m, body),
            lane.speed_m_s,
            *_span(course, slot.first, slot.last),
            turn_rad=lane.turn_rad,
            surge_m=swing.surge_m,
            surge_s=swing.surge_s,
            phase_rad=swing.phase_rad,
            kind=body.kind,
        )
        orders.append(_Order(max(0.0, mover.from_s), f"vehicles {lane.number}", slot.number, mover))
    return orders


def _walkers(
    seed: int, number: int, lane: Lane, course: Floats, bodies: _Bodies, walks: Walks
) -> list[_Order]:
    """Those who walk or cycle along, wherever the walk has their lane."""
    orders = []
    for slot in slots_near(lane, course):
        random = slot_chance(seed, number, lane, slot)
        if random is None:
            continue
        kind = kind_drawn(random, lane.kinds)
        body, mesh = bodies.one(kind, int(random.integers(_BODIES)))
        swing = swing_of(random, lane, body.length_m)
        mover = Mover(
            mesh,
            slot.middle_m + swing.from_middle_m,
            lane.offset_m,
            lane.speed_m_s,
            -np.inf,
            np.inf,
            turn_rad=lane.turn_rad + (0.0 if lane.speed_m_s else float(random.normal(0, 0.1))),
            sway_m=_SWAY_M.get(kind, 0.0) if lane.speed_m_s else 0.0,
            sway_s=float(random.uniform(0.9, 1.3) if kind == "person" else random.uniform(2, 4)),
            surge_m=swing.surge_m,
            surge_s=swing.surge_s,
            phase_rad=swing.phase_rad,
            kind=body.kind,
        )
        times = course[slot.first : slot.last + 1, 0]
        at, _ = mover.way_at(times)
        inside = walks.has_room(lane, at)
        for first, last in stretches_of(inside):
            start, end = _span(course, slot.first + first, slot.first + last)
            one = replace(mover, from_s=start, to_s=end)
            orders.append(_Order(max(0.0, one.from_s), f"walkers {lane.number}", slot.number, one))
    return orders


def _span(course: Floats, first: int, last: int) -> tuple[float, float]:
    """When a mover comes and goes; without limit at the recording's ends."""
    start = -np.inf if first == 0 else float(course[first, 0])
    end = np.inf if last == course.shape[0] - 1 else float(course[last, 0])
    return start, end


def _way(driven: Pass) -> int:
    return RIGHT if driven.number % 2 else LEFT
