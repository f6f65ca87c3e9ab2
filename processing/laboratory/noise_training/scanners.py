"""Where the beams of simulated scanners begin and go: on a vehicle, on stands, in the air."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.core.arrays import Floats, Integers

MOBILE, STANDING, AIRBORNE = "mobile", "standing", "airborne"
_PULSES = (900, 1500, 2000, 2900, 3400, 5000)
_TURNS_PER_S = (50, 80, 100, 150, 200)
_MOUNTS_DEG = (45, -45, 0, 23, 67)
_FLIGHTS_M = (40, 80, 120, 600, 1000)
_SECTORS = (1.0, 1.0, 0.4, 0.15)  # of the horizon: the fewer, the finer for as many beams
_LOWEST_DEG, _SWEEP_DEG = -60.0, 150.0


@dataclass(frozen=True)
class Shots:
    """Beams in the order in which they were sent.

    Attributes
    ----------
    origins, directions : (n, 3) float64
        m; unit vectors.
    rows, columns, scans : (n,) int64
        Of a scan of ``width`` columns; columns go round where ``is_round``.
    width : int
    turn : float
        Radians from beam to beam.
    """

    origins: Floats
    directions: Floats
    rows: Integers
    columns: Integers
    scans: Integers
    width: int
    turn: float


def mobile_shots(random: Generator, length_m: float, budget: int) -> Shots:
    """A spinning scanner on a vehicle."""
    width, revolutions = int(random.choice(_PULSES)), float(random.choice(_TURNS_PER_S))
    speed = random.uniform(4, 16)
    seen_m = min(length_m, speed * budget / (width * revolutions))
    rows = max(8, int(seen_m / speed * revolutions))
    start = random.uniform(0.2, 0.8) * max(0.0, length_m - seen_m)
    high, beside = random.uniform(1.9, 3), random.uniform(-2, 2)
    tilt = np.radians(random.uniform(-10, 10))
    mount = np.radians(random.choice(_MOUNTS_DEG))
    pulses = np.arange(rows * width)
    times, angles = pulses / (width * revolutions), 2 * np.pi * pulses / width
    aside = np.array([np.sin(mount), np.cos(mount), 0])
    up = np.array([np.cos(mount) * np.sin(tilt), -np.sin(mount) * np.sin(tilt), np.cos(tilt)])
    directions = np.sin(angles)[:, None] * aside - np.cos(angles)[:, None] * up
    roll = 0.01 * np.sin(2 * np.pi * times * 1.3)
    directions[:, 1], directions[:, 2] = (
        directions[:, 1] + roll * directions[:, 2],
        directions[:, 2] - roll * directions[:, 1],
    )
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    origins = np.column_stack(
        [
            start + speed * times,
            beside + 0.3 * np.sin(times * 0.3),
            high + 0.02 * np.sin(2 * np.pi * times),
        ]
    )
    half = pulses + width // 2
    scans = np.zeros(pulses.size, np.int64)
    return Shots(origins, directions, half // width, half % width, scans, width, 2 * np.pi / width)


def standing_shots(random: Generator, length_m: float, budget: int, stations: int) -> Shots:
    """Scanners on stands, one after the other; a row is a sweep from below to above."""
    share = float(random.choice(_SECTORS))
    turn = 2 * np.pi / int(np.sqrt(budget * 2.4 / stations / share))
    around = random.uniform(0, 2 * np.pi) + np.arange(0, 2 * np.pi * share - turn / 2, turn)
    above = np.radians(_LOWEST_DEG) + np.arange(0, np.radians(_SWEEP_DEG), turn)
    azimuths, heights = (one.ravel() for one in np.meshgrid(around, above, indexing="ij"))
    directions = np.column_stack(
        [np.cos(heights) * np.cos(azimuths), np.cos(heights) * np.sin(azimuths), np.sin(heights)]
    )
    positions = np.column_stack(
        [
            random.uniform(0.1, 0.9, stations) * length_m,
            random.uniform(-3, 3, stations),
            random.uniform(1.4, 1.9, stations),
        ]
    )
    pulses = np.arange(directions.shape[0] * stations)
    scans = pulses // directions.shape[0]
    return Shots(
        positions[scans],
        np.tile(directions, (stations, 1)),
        pulses // above.size,
        pulses % above.size,
        scans,
        above.size,
        turn,
    )


def airborne_shots(random: Generator, length_m: float, budget: int) -> Shots:
    """A scanner in the air whose lines cross the street."""
    high, wide = float(random.choice(_FLIGHTS_M)), length_m * 1.2
    width = int(np.sqrt(budget))
    rows = budget // width
    shape = (rows, width)
    y = np.linspace(-wide / 2, wide / 2, width) + random.normal(0, wide / width * 0.2, shape)
    along = np.linspace(0, length_m, rows)[:, None]
    x = along + random.normal(0, length_m / rows * 0.2, shape)
    origins = np.stack(
        [np.broadcast_to(along, shape), np.zeros(shape), np.full(shape, high)], -1
    ).reshape(-1, 3)
    directions = np.stack([x, y, np.zeros(shape)], -1).reshape(-1, 3) - origins
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    pulses = np.arange(rows * width)
    scans = np.zeros(pulses.size, np.int64)
    return Shots(
        origins, directions, pulses // width, pulses % width, scans, width, wide / width / high
    )
