"""Where the tripods are set up: places that together see most of the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.layout import SiteLayout
from processing.laboratory.simulate.sites.terrain import StopCheck

_CANDIDATES, _TARGETS = 48, 700
_CLEAR_M = 2.2
_STEEPEST = 0.6
_GOOD_M = 30.0  # beyond it the ground is seen at too flat an angle to count fully


@dataclass(frozen=True)
class Station:
    """One set-up of the scanner.

    Attributes
    ----------
    position : (3,) float64
        Of its centre, m, the site's frame.
    start_rad : float
        Where its first column points, anticlockwise from east.
    turn : (3,) float64
        Error of the registration: small rotations about x, y and z, radians.
    shift : (3,) float64
        Error of the registration, m.
    """

    position: Floats
    start_rad: float
    turn: Floats
    shift: Floats


def count_for(length_m: float, wanted: int) -> int:
    """How many stations: as wished, or three to eight by the site's size."""
    return wanted or int(np.clip(round(2.6 + length_m / 30), 3, 8))


def stations_of(
    random: Generator, layout: SiteLayout, scene: RaycastScene, count: int, check: StopCheck
) -> list[Station]:
    """Stations one after the other, each where it adds most to what is seen.

    Parameters
    ----------
    scene : RaycastScene
        All triangles of the date.
    check : callable
        Called for every candidate; raises to stop.
    """
    heights = layout.ground.heights
    east, north = heights.size_m
    positions = _candidates(random, layout)
    x, y = random.uniform((0, 0), (east, north), (_TARGETS, 2)).T
    targets = np.column_stack([x, y, heights.height(x, y) + 0.05])
    seen = np.zeros((len(positions), _TARGETS))
    for row, position in enumerate(positions):
        check()
        seen[row] = _seen_from(scene, position, targets)
    chosen: list[int] = []
    best = np.zeros(_TARGETS)
    for _ in range(min(count, len(positions))):
        gains = np.maximum(seen - best, 0).sum(axis=1)
        gains[chosen] = -1
        chosen.append(int(np.argmax(gains)))
        best = np.maximum(best, seen[chosen[-1]])
    return [
        Station(
            positions[one],
            random.uniform(-np.pi, np.pi),
            random.normal(0, 2e-5, 3),
            random.normal(0, 0.0012, 3),
        )
        for one in chosen
    ]


def _candidates(random: Generator, layout: SiteLayout) -> Floats:
    """Places where a tripod can stand: dry, not steep, away from things."""
    heights = layout.ground.heights
    east, north = heights.size_m
    found: list[list[float]] = []
    for number in range(_CANDIDATES * 20):
        x, y = random.uniform(0.04, 0.96) * east, random.uniform(0.04, 0.96) * north
        over = random.uniform(1.45, 1.85)
        node = int(y / heights.res), int(x / heights.res)
        is_dry = layout.ground.material[node] != int(Material.WATER)
        # Where nothing is level, the last tries take what there is.
        steepest = _STEEPEST if number < _CANDIDATES * 15 else 10.0
        is_level = np.hypot(*heights.slope(x, y, 1.0)) < steepest
        if (
            is_dry
            and is_level
            and layout.ground.is_reached[node]
            and layout.is_free(x, y, _CLEAR_M)
        ):
            found.append([x, y, float(heights.height(x, y)) + over])
        if len(found) == _CANDIDATES:
            break
    if not found:
        found.append([east / 2, north / 2, float(heights.z.max()) + 2.0])
    return np.array(found)


def _seen_from(scene: RaycastScene, position: Floats, targets: Floats) -> Floats:
    """How well each target is seen: 1 near by, less far away, 0 where something is between."""
    directions = targets - position
    away = np.linalg.norm(directions, axis=1)
    hits = scene.cast(np.broadcast_to(position, directions.shape), directions / away[:, None])
    return np.where(hits.ranges > away - 0.1, 1 / (1 + (away / _GOOD_M) ** 2), 0.0)
