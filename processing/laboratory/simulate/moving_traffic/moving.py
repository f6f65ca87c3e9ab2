"""Movers of a pass: oncoming, overtaking, ahead and behind; walking, cycling, crossing.

What comes depends on lanes, slots and times that are drawn one by one, so a longer recording
begins like a shorter one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.moving_traffic.crossing import crossers_of
from processing.laboratory.simulate.moving_traffic.recorded_pass import record_pass
from processing.laboratory.simulate.moving_traffic.vehicles import (
    companions_of,
    vehicle_lanes,
    vehicles_of,
)
from processing.laboratory.simulate.moving_traffic.walking import Walks, walkers_of, walking_lanes
from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scene.things import Mover

MOST_INSTANCES = 4500
"""Numbers that each pass has for its movers; beyond them its first ones come again."""


def movers_of(street: Street, driven: SimulatedPass) -> list[Mover]:
    """All that moves, or waits, around the recording vehicle during a pass.

    Each has an instance of its own in the order in which they come near; those of pass ``n``
    begin behind ``n * MOST_INSTANCES``.
    """
    recorded = record_pass(street, driven)
    orders = companions_of(recorded)
    for lane in vehicle_lanes(recorded):
        orders += vehicles_of(recorded, lane)
    orders += crossers_of(recorded, [one.mover for one in orders])
    walks = Walks(street.seed, street.plans)
    for lane in walking_lanes(recorded):
        orders += walkers_of(recorded, lane, walks)
    orders.sort(key=lambda one: (one.first_s, one.lane, one.number))
    first = driven.number * MOST_INSTANCES + 1
    return [_numbered(one.mover, first + row % MOST_INSTANCES) for row, one in enumerate(orders)]


def _numbered(mover: Mover, instance: int) -> Mover:
    mesh = mover.mesh
    return replace(mover, mesh=replace(mesh, instance=np.full_like(mesh.instance, instance)))
