"""What traffic is drawn for: the way of the recording vehicle, and bodies to choose from."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats, Mesh
from processing.laboratory.simulate.scene.things import Mover
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SectionPlan
from processing.laboratory.simulate.street.styles import Style
from processing.laboratory.simulate.traffic.bodies import TrafficBody
from processing.laboratory.simulate.traffic.kinds import KINDS
from processing.laboratory.simulate.traffic.lanes import (
    Slot,
    TrafficLane,
    kind_drawn,
    slot_chance,
    slots_near,
)

BODIES = 48
"""Bodies of each kind in one street."""

STEP_S = 0.25


@dataclass(frozen=True)
class PlannedMover:
    """A mover before it has its number.

    Attributes
    ----------
    first_s : float
        When it comes.
    lane, number : str, int
        Tell it from others that come at the same time.
    """

    first_s: float
    lane: str
    number: int
    mover: Mover


class Bodies:
    """Bodies of a street's traffic, each made once.

    Parameters
    ----------
    seed : int
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._made: OrderedDict[tuple[str, int], tuple[TrafficBody, Mesh]] = OrderedDict()

    def one(self, kind: str, number: int) -> tuple[TrafficBody, Mesh]:
        """A body and its triangles."""
        key = kind, number % BODIES
        if key not in self._made:
            body = KINDS[kind].drawn(chance(self._seed, "body", *key))
            self._made[key] = body, body.mesh(1)
        return self._made[key]


@dataclass(frozen=True)
class RecordedPass:
    """A pass as its traffic sees it.

    Attributes
    ----------
    seed : int
        Of the street.
    number : int
        Of the pass.
    direction : int
        `LEFT` along the chainage, on the left half; `RIGHT` for one that comes back.
    style : Style
    plans : tuple of SectionPlan
    course : (n, 2) float64
        Times and chainages of the recording vehicle, four a second.
    bodies : Bodies
    """

    seed: int
    number: int
    direction: int
    style: Style
    plans: tuple[SectionPlan, ...]
    course: Floats
    bodies: Bodies

    @property
    def plan(self) -> SectionPlan:
        """Of any section: lanes are the same all along."""
        return self.plans[0]

    def span(self, first: int, last: int) -> tuple[float, float]:
        """From when to when, of two rows of the course; without limit at its ends."""
        start = -np.inf if first == 0 else float(self.course[first, 0])
        end = np.inf if last == self.course.shape[0] - 1 else float(self.course[last, 0])
        return start, end


def record_pass(street: Street, driven: SimulatedPass) -> RecordedPass:
    """A pass as its traffic sees it."""
    times = np.arange(0.0, driven.duration_s, STEP_S)
    return RecordedPass(
        street.seed,
        driven.number,
        RIGHT if driven.number % 2 else LEFT,
        street.style,
        street.plans,
        np.column_stack([times, driven.chainage_at(times)]),
        Bodies(street.seed),
    )


def fill_slots(
    recorded: RecordedPass, lane: TrafficLane
) -> Iterator[tuple[Slot, Generator, TrafficBody, Mesh]]:
    """The slots of a lane that hold something: their chance, the body in it and its triangles."""
    for slot in slots_near(lane, recorded.course):
        random = slot_chance(recorded.seed, recorded.number, lane, slot)
        if random is not None:
            kind = kind_drawn(random, lane.kinds)
            yield slot, random, *recorded.bodies.one(kind, int(random.integers(BODIES)))
