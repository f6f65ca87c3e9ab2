"""Simulated streets, each of its own shape: what the beams of a training scene meet."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.noise_training.rays import BOX, CAPSULE, CROWN, PANE, STRIP, thing

KINDS = (
    "road",
    "wire",
    "post",
    "rail",
    "facade",
    "grass",
    "curb",
    "car",
    "tree",
    "glass",
    "far facade",
)
ROAD, WIRE, POST, RAIL, FACADE, GRASS, CURB, CAR, TREE, GLASS, FAR = range(len(KINDS))
GROUND_STRIPS = 10
BRIGHT = 0.95  # albedo of a sign's plate
_CURB_STRIPS = (3, 6)
_SIDES = (-1, 1)


@dataclass
class TrainingStreet:
    """A street along x.

    Attributes
    ----------
    across, heights : (11,) float64
        The ground's profile, m.
    half_width, walk : float
        Of the road, and of the pavement beside it, m.
    has_grass : bool
    things : list
        Rows of :mod:`processing.laboratory.noise_training.rays`; the ground comes first.
    panes : list
        Glass, which lets most beams through.
    """

    across: NDArray[np.float64]
    heights: NDArray[np.float64]
    half_width: float
    walk: float
    has_grass: bool
    things: list[list[float]] = field(default_factory=list)
    panes: list[list[float]] = field(default_factory=list)

    def ground_at(self, y: float) -> float:
        """Height of the ground, m."""
        return float(np.interp(y, self.across, self.heights))


def street_of(random: Generator, length_m: float, *, has_far: bool) -> TrainingStreet:
    """A street with what stands beside it, drawn by chance."""
    street = _bare_street(random)
    for side in _SIDES:
        _add_one_side(street, random, side, length_m)
    _add_traffic(street, random, length_m)
    if has_far and random.random() < 0.4:
        _add_wood(street, random, length_m)
    if has_far or random.random() < 0.6:
        _add_far(street, random, length_m, (25, 75, 5, 30, 5, 16, 8))
    if random.random() < 0.7:  # seldom in reach: what a scanner folds back
        _add_far(street, random, length_m, (55, 140, 15, 80, 10, 40, 15))
    return street


def _add_one_side(street: TrainingStreet, random: Generator, side: int, length_m: float) -> None:
    if random.random() < 0.6:
        _add_facades(street, random, side, length_m)
    if random.random() < 0.7:
        _add_fence(street, random, side, length_m)
    if random.random() < 0.7:
        _add_poles_and_wires(street, random, side, length_m)
    _add_signs(street, random, side, length_m)
    _add_plants(street, random, side, length_m)
    if random.random() < 0.45:
        _add_street_trees(street, random, side, length_m)
    if random.random() < 0.45:
        _add_hedge(street, random, side, length_m)
    for _ in range(random.integers(0, 3)):
        y = side * (street.half_width - 1.2)
        x, z = random.uniform(0, length_m), street.ground_at(y) + 0.75
        street.things.append(thing(BOX, CAR, 0.5, x, y, z, 2.1, 0.85, 0.75, random.normal() * 0.05))


def _bare_street(random: Generator) -> TrainingStreet:
    half, fall, rise = (
        random.uniform(3, 6.5),
        random.uniform(0.01, 0.03),
        random.uniform(0.05, 0.25),
    )
    walk, slope = random.uniform(1.5, 4), random.uniform(-0.1, 0.25)
    edge = -half * fall
    outer = edge + rise + walk * 0.02
    left, right = outer + 8 * slope * random.uniform(-0.3, 1), outer + 8 * slope
    rising = [0.0, half, half + 0.01, half + walk, half + walk + 8, 200.0]
    across = np.array([-y for y in rising[:0:-1]] + rising)
    heights = np.array(
        [left, left, outer, edge + rise, edge, 0.0, edge, edge + rise, outer, right, right]
    )
    street = TrainingStreet(across, heights, half, walk, bool(random.random() < 0.7))
    for strip in range(GROUND_STRIPS):
        kind = CURB if strip in _CURB_STRIPS else ROAD
        ends = across[strip], heights[strip], across[strip + 1], heights[strip + 1]
        street.things.append(thing(STRIP, kind, 0.6 if kind == CURB else 0.5, *ends))
    return street


def _add_facades(street: TrainingStreet, random: Generator, side: int, length_m: float) -> None:
    y = side * (street.half_width + street.walk + random.uniform(0.5, 6))
    x = -length_m * 0.2
    while x < length_m * 1.2:
        long, high = random.uniform(8, 25), random.uniform(4, 14)
        if random.random() < 0.7:
            back = random.uniform(0, 4)
            z = street.ground_at(y)
            middle = x + long / 2, y + side * (5 + back), z + high / 2 - 0.5
            street.things.append(thing(BOX, FACADE, 0.6, *middle, long / 2, 5, high / 2 + 0.5, 0))
            if random.random() < 0.5:
                front = x + long / 2, y + side * (back - 0.02), z + 1.6
                street.panes.append(thing(PANE, GLASS, 0.1, *front, np.pi / 2, long / 3, 1.3))
        x += long + random.uniform(0, 12)


def _add_fence(street: TrainingStreet, random: Generator, side: int, length_m: float) -> None:
    y = side * (street.half_width + random.uniform(0.3, street.walk))
    start, end = random.uniform(0, length_m * 0.4), random.uniform(length_m * 0.5, length_m)
    z, radius = street.ground_at(y), random.uniform(0.012, 0.035)
    for height in np.arange(1, random.integers(2, 4)) * random.uniform(0.3, 0.45):
        ends = start, y, z + height, end, y, z + height
        street.things.append(thing(CAPSULE, RAIL, 0.6, *ends, radius))
    for x in np.arange(start, end, random.uniform(1.5, 3)):
        street.things.append(thing(CAPSULE, POST, 0.6, x, y, z, x, y, z + 1.0, 0.03))


def _add_poles_and_wires(
    street: TrainingStreet, random: Generator, side: int, length_m: float
) -> None:
    y = side * (street.half_width + random.uniform(0.2, street.walk))
    step, high = random.uniform(20, 35), random.uniform(6, 11)
    ground = street.ground_at(y)
    positions = np.arange(random.uniform(-step, 0), length_m + step, step)
    for x in positions:
        ends = x, y, ground, x, y, ground + high
        street.things.append(thing(CAPSULE, POST, 0.5, *ends, random.uniform(0.08, 0.18)))
    along = np.linspace(0, 1, 7)
    for number in range(random.integers(1, 5)):
        radius, beside = random.uniform(0.004, 0.015), y + random.uniform(-0.4, 0.4)
        top = ground + high - 0.3 - number * random.uniform(0.4, 1.2)
        heights = top - random.uniform(0.2, 0.9) * 4 * along * (1 - along)
        for start, end in pairwise(positions):
            xs = start + along * (end - start)
            for one in range(along.size - 1):
                ends = xs[one], beside, heights[one], xs[one + 1], beside, heights[one + 1]
                street.things.append(thing(CAPSULE, WIRE, 0.4, *ends, radius))


def _add_signs(street: TrainingStreet, random: Generator, side: int, length_m: float) -> None:
    for _ in range(random.integers(0, 3)):
        x = random.uniform(0, length_m)
        y = side * (street.half_width + random.uniform(0.2, street.walk))
        z, high = street.ground_at(y), random.uniform(1.8, 3.5)
        ends = x, y, z, x, y, z + high
        street.things.append(thing(CAPSULE, POST, 0.6, *ends, random.uniform(0.02, 0.05)))
        plate = x, y, z + high - 0.3, random.uniform(-0.4, 0.4), 0.3, 0.3
        street.things.append(thing(PANE, POST, BRIGHT, *plate))


def _add_plants(street: TrainingStreet, random: Generator, side: int, length_m: float) -> None:
    for _ in range(random.integers(0, 3)):
        x = random.uniform(0, length_m)
        y = side * (street.half_width + random.uniform(0.5, street.walk + 6))
        z, high, radius = street.ground_at(y), random.uniform(2, 5), random.uniform(0.8, 2.5)
        trunk = x, y, z, x, y, z + high
        street.things.append(thing(CAPSULE, TREE, 0.4, *trunk, random.uniform(0.05, 0.2)))
        crown = x, y, z + high, radius, radius, radius * random.uniform(0.6, 1.4)
        street.things.append(thing(CROWN, TREE, 0.35, *crown, random.uniform(0.3, 1.2)))
    for _ in range(random.integers(0, 3)):
        x, radius = random.uniform(0, length_m), random.uniform(0.4, 1)
        y = side * (street.half_width + random.uniform(0.5, street.walk + 6))
        shrub = x, y, street.ground_at(y) + 0.5, radius, radius, radius
        street.things.append(thing(CROWN, TREE, 0.35, *shrub, random.uniform(0.15, 0.5)))


def _add_traffic(street: TrainingStreet, random: Generator, length_m: float) -> None:
    """What moves, as long or as short as the scanner's own way makes it, and people."""
    for _ in range(random.integers(0, 6)):
        x, y = random.uniform(0, length_m), random.uniform(-1, 1) * street.half_width * 0.8
        z, long = street.ground_at(y), 2 ** random.uniform(-3.5, 2.5)
        high = random.uniform(0.5, 1.3)
        box = x, y, z + high + 0.15, long, random.uniform(0.3, 1.1), high, random.normal() * 0.05
        street.things.append(thing(BOX, CAR, 0.5, *box))
    for _ in range(random.integers(0, 6)):
        x, y = (
            random.uniform(0, length_m),
            random.uniform(-1, 1) * (street.half_width + street.walk),
        )
        z, radius, high = street.ground_at(y), random.uniform(0.05, 0.3), random.uniform(0.8, 1.8)
        ends = x, y, z + radius, x + random.normal() * 0.2, y, z + high - radius
        street.things.append(thing(CAPSULE, CAR, 0.5, *ends, radius))


def _add_street_trees(
    street: TrainingStreet, random: Generator, side: int, length_m: float
) -> None:
    """A row of trees whose crowns reach over the road."""
    y = side * (street.half_width + random.uniform(0.3, street.walk))
    high, radius = random.uniform(2, 6), random.uniform(0.7, 2.8)
    clumps, depth = int(random.integers(0, 13)), 2 ** random.uniform(-3, 1.5)
    for x in np.arange(random.uniform(0, 8), length_m, random.uniform(5, 14)):
        z, wide = (
            street.ground_at(y) + high * random.uniform(0.8, 1.2),
            radius * random.uniform(0.7, 1.2),
        )
        trunk = x, y, street.ground_at(y), x, y, z
        street.things.append(thing(CAPSULE, TREE, 0.4, *trunk, random.uniform(0.04, 0.15)))
        if clumps < 4:
            crown = x, y, z, wide, wide, wide * random.uniform(0.5, 1.3)
            street.things.append(thing(CROWN, TREE, 0.35, *crown, depth))
            continue
        for _ in range(clumps):
            at = np.array([x, y, z]) + wide * 0.75 * random.uniform(-1, 1, 3)
            size = wide * random.uniform(0.15, 0.5)
            clump = *at, size, size, size * random.uniform(0.5, 1)
            street.things.append(thing(CROWN, TREE, 0.35, *clump, depth * 0.3))


def _add_hedge(street: TrainingStreet, random: Generator, side: int, length_m: float) -> None:
    """Leaves along the street, as high as a knee or a man."""
    y = side * (street.half_width + random.uniform(0.3, street.walk + 2))
    start, long = random.uniform(0, length_m * 0.5), random.uniform(3, 50)
    high, wide, depth = (
        random.uniform(0.3, 1.1),
        random.uniform(0.25, 0.7),
        random.uniform(0.05, 0.4),
    )
    for x in np.arange(start, min(start + long, length_m), wide * 1.2):
        z = street.ground_at(y) + high * random.uniform(0.8, 1.1)
        street.things.append(thing(CROWN, TREE, 0.35, x, y, z, wide, wide, high, depth))


def _add_wood(street: TrainingStreet, random: Generator, length_m: float) -> None:
    """Crowns that touch, of any height, as seen from the air more than from the street."""
    side = random.choice(_SIDES)
    near = street.half_width + street.walk + random.uniform(3, 15)
    for _ in range(random.integers(15, 50)):
        x, y = random.uniform(0, length_m), side * (near + random.uniform(0, 25))
        z, high, radius = street.ground_at(y), random.uniform(1, 16), random.uniform(0.6, 4)
        trunk = x, y, z, x, y, z + high
        street.things.append(thing(CAPSULE, TREE, 0.4, *trunk, random.uniform(0.05, 0.25)))
        crown = x, y, z + high, radius, radius, radius * random.uniform(0.6, 2)
        street.things.append(thing(CROWN, TREE, 0.35, *crown, random.uniform(0.3, 3)))


def _add_far(
    street: TrainingStreet, random: Generator, length_m: float, sizes: tuple[float, ...]
) -> None:
    near, far, short, long, low, high, middle = sizes
    for _ in range(random.integers(1, 6)):
        y = random.choice(_SIDES) * (random.uniform(near, far) + 5)
        x, yaw = random.uniform(-length_m, 2 * length_m), random.normal() * 0.2
        halves = random.uniform(short, long), 5, random.uniform(low, high)
        street.things.append(thing(BOX, FAR, 0.6, x, y, middle, *halves, yaw))
