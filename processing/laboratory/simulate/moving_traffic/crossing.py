"""People who cross the road at junctions, when nothing comes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.moving_traffic.recorded_pass import (
    BODIES,
    PlannedMover,
    RecordedPass,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.things import Mover
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SectionPlan
from processing.laboratory.simulate.street.styles import URBAN
from processing.laboratory.simulate.traffic.lanes import REACH_M
from processing.laboratory.simulate.traffic.parking import parking_positions

_SLOT_S = 16.0
_FILL = 0.8
_BEFORE_M = 1.5  # from the junction's beginning into it
_INSIDE_M = 1.0  # from the carriageway's edge, where they appear and vanish
_APART_M = 1.4
_CLEAR_M = 5.0  # from a vehicle's middle, besides half its length
_OWN_CLEAR_M = 9.0
_HURRY = 1.4  # of the recording vehicle above its usual speed, at most


def crossers_of(recorded: RecordedPass, vehicles: Sequence[Mover]) -> list[PlannedMover]:
    """Those who cross, one slot of time after the other at each junction.

    Parameters
    ----------
    vehicles : sequence of Mover
        That nobody may walk into.
    """
    if recorded.style is not URBAN or recorded.plan.median_m > 0:
        return []
    orders = []
    times, own = recorded.course.T
    for plan in recorded.plans:
        at = plan.start_m + _BEFORE_M
        near = times[np.abs(own - at) < REACH_M]
        if not plan.junctions or not near.size or _is_parked_on(recorded.seed, plan, at):
            continue
        for slot in range(int(near[0] / _SLOT_S), int(near[-1] / _SLOT_S) + 1):
            random = chance(recorded.seed, "crossing", recorded.number, plan.index, slot)
            if random.random() < _FILL:
                start = (slot + 0.25 * float(random.random())) * _SLOT_S
                group = _group(recorded, plan, random, start)
                if group and _is_clear(recorded, vehicles, group):
                    numbers = range(len(group))
                    name = f"crossing {plan.index}"
                    orders += [
                        PlannedMover(max(0.0, start), name, 10 * slot + number, group[number])
                        for number in numbers
                    ]
    return orders


def _group(
    recorded: RecordedPass, plan: SectionPlan, random: Generator, start_s: float
) -> list[Mover]:
    """One to three who cross side by side."""
    direction = 1.0 if random.random() < 0.5 else -1.0
    reach = {LEFT: plan.left.edge_m - _INSIDE_M, RIGHT: plan.right.edge_m - _INSIDE_M}
    first = -reach[RIGHT] if direction > 0 else reach[LEFT]
    speed = direction * float(random.uniform(0.9, 1.7))
    lasts = (reach[LEFT] + reach[RIGHT]) / abs(speed)
    group = []
    for number in range(1 + int(random.integers(3))):
        body, mesh = recorded.bodies.one("person", int(random.integers(BODIES)))
        group.append(
            Mover(
                mesh,
                plan.start_m + _BEFORE_M + number * _APART_M,
                first - speed * start_s,
                0.0,
                start_s,
                start_s + lasts,
                turn_rad=direction * np.pi / 2,
                aside_m_s=speed,
                kind=body.kind,
            )
        )
    return group


def _is_clear(recorded: RecordedPass, vehicles: Sequence[Mover], group: list[Mover]) -> bool:
    """Whether no vehicle comes while they cross, the recording vehicle neither."""
    start, end = group[0].from_s, group[0].to_s
    at = group[0].chainage_m, group[-1].chainage_m
    own = float(np.interp(start, recorded.course[:, 0], recorded.course[:, 1]))
    ahead = recorded.direction * (np.array(at) - own)
    driven = _HURRY * recorded.style.speed_m_s[1] * (end - start)
    if not ((ahead < -_OWN_CLEAR_M).all() or (ahead > driven + _OWN_CLEAR_M).all()):
        return False
    times = np.arange(start, end + 0.5, 0.5)
    for one in vehicles:
        if one.from_s > end or one.to_s < start:
            continue
        positions, _ = one.direction_at(times)
        room = _CLEAR_M + float(one.mesh.vertices[:, 0].max()) + abs(one.speed_m_s) * 0.25
        if ((positions > at[0] - room) & (positions < at[1] + room)).any():
            return False
    return True


def _is_parked_on(seed: int, plan: SectionPlan, at: float) -> bool:
    """Whether something may be parked where they would cross."""
    last = at + 2 * _APART_M
    return any(
        one.chainage_m - one.along_m < last and one.chainage_m + one.along_m > at
        for one in parking_positions(seed, plan)
    )
