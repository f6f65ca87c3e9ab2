"""Streams of movers: each lane has one speed, and each mover a slot that goes along with it.

A slot is a stretch of the lane that moves at the lane's speed; a mover swings within its own slot
only. So none ever meets another of its lane, however long the recording, and what is drawn
depends on lane and slot alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats

REACH_M = 150.0
"""Movers farther away from the recording vehicle are not there."""

_GAP_M = 1.2  # between slot's end and body, so two bodies are at least twice as far apart
_SURGE_S = (12.0, 45.0)
_SURGE_SHARE = 0.2  # of the lane's speed


@dataclass(frozen=True)
class TrafficLane:
    """A stream of movers along the road.

    Attributes
    ----------
    name : str
        Tells its chance from that of others.
    number : int
        Of several of that name.
    offset_m : float
        To the left of the road's centre.
    speed_m_s : float
        Along the chainage; negative towards its beginning.
    turn_rad : float
        Where they face, anticlockwise from the road's direction.
    slot_m : float
    fill : float
        Share of slots that hold a mover.
    kinds : mapping of str to float
        How often which kind comes.
    wide_m : float
    """

    name: str
    number: int
    offset_m: float
    speed_m_s: float
    turn_rad: float
    slot_m: float
    fill: float
    kinds: dict[str, float]
    wide_m: float


@dataclass(frozen=True)
class Slot:
    """A slot that comes near the recording vehicle.

    Attributes
    ----------
    number : int
    middle_m : float
        Chainage of its middle at time 0.
    first, last : int
        Rows of the course's times between which it may be near.
    """

    number: int
    middle_m: float
    first: int
    last: int


@dataclass(frozen=True)
class Swing:
    """How a mover swings within its slot: chainage from the slot's middle, and surge."""

    from_middle_m: float
    surge_m: float
    surge_s: float
    phase_rad: float


def slots_near(lane: TrafficLane, course: Floats) -> Iterator[Slot]:
    """All slots of a lane that come near the recording vehicle.

    Parameters
    ----------
    course : (n, 2) float64
        Times from 0, rising, and the recording vehicle's chainages.
    """
    times, own = course[:, 0], course[:, 1]
    direction = 1.0 if own[-1] >= own[0] else -1.0
    relative = own - lane.speed_m_s * times
    if relative[-1] < relative[0]:
        direction = -1.0
    ahead = np.maximum.accumulate(direction * relative)
    behind = np.minimum.accumulate((direction * relative)[::-1])[::-1]
    first = int(np.floor((relative.min() - REACH_M) / lane.slot_m))
    last = int(np.ceil((relative.max() + REACH_M) / lane.slot_m))
    middles = (np.arange(first, last + 1) + 0.5) * lane.slot_m
    starts = np.searchsorted(ahead, direction * middles - REACH_M)
    ends = np.searchsorted(behind, direction * middles + REACH_M, "right") - 1
    for row in np.flatnonzero((starts <= ends) & (starts < times.size)).tolist():
        yield Slot(first + row, float(middles[row]), int(starts[row]), int(ends[row]))


def slot_chance(seed: int, number: int, lane: TrafficLane, slot: Slot) -> Generator | None:
    """The chance of what a slot holds, or None for an empty slot; ``number`` is the pass."""
    random = chance(seed, lane.name, number, lane.number, slot.number)
    return random if random.random() < lane.fill else None


def kind_drawn(random: Generator, kinds: dict[str, float]) -> str:
    """One of some kinds by their shares."""
    shares = np.array(list(kinds.values()))
    return list(kinds)[int(random.choice(len(kinds), p=shares / shares.sum()))]


def swing_of(random: Generator, lane: TrafficLane, length_m: float) -> Swing:
    """How a mover of a length stands and swings in its slot."""
    room = max(0.0, (lane.slot_m - length_m) / 2 - _GAP_M)
    period = float(random.uniform(*_SURGE_S))
    most = _SURGE_SHARE * abs(lane.speed_m_s) * period / (2 * np.pi)
    surge = float(random.uniform(0, 1)) * min(0.6 * room, most)
    aside = float(random.uniform(-1, 1)) * (room - surge)
    return Swing(aside, surge, period, float(random.uniform(0, 2 * np.pi)))


def stretches_of(inside: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """First and last row of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(np.int8)))
    for first, behind in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        yield first, behind - 1
