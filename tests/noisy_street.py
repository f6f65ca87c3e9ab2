"""A simulated street with a wire and known noise: beams that met something nearer or farther."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tests.builders import START, SimulatedDrive, simulated_drive
from tests.street_scene import StreetScene

POLE = 4
_WIRE_AT = (5.0, 3.4)  # across the street, above it, m
_WIRE_RADIUS_M = 0.02


@dataclass(frozen=True)
class NoisyStreet:
    """A recording with its truth.

    Attributes
    ----------
    drive : SimulatedDrive
    noise : (n,) uint8
        0 where a surface was met, 7 noise below the street, 18 noise elsewhere.
    is_wire : (n,) bool
    """

    drive: SimulatedDrive
    noise: NDArray[np.uint8]
    is_wire: NDArray[np.bool_]


def noisy_street(seed: int = 0, **changes: float) -> NoisyStreet:
    """Arcs of one range, single points along beams, and a patch below the street."""
    simulated = simulated_drive(seed, mount="90", **{"lost_share": 0.0, **changes})  # type: ignore[arg-type] - numbers only
    random = np.random.default_rng(seed)
    away = simulated.xyz - simulated.origin
    ranges = np.linalg.norm(away, axis=1)
    ways = away / ranges[:, None]
    is_wire, wire_ranges = _wire_hits(simulated, ways, ranges)
    met = np.where(is_wire, wire_ranges, ranges)
    along = StreetScene(0.0, 0.0).along_across(simulated.xyz - START)[0]
    is_free, is_down = ~is_wire, ways[:, 2] < -0.3
    seldom = random.uniform(size=ranges.size)
    arc = is_free & (seldom < 0.4) & (ranges > 5.0) & (np.abs(ways[:, 2]) < 0.3)
    arc &= (along > along.max() * 0.3) & (along < along.max() * 0.5)
    single = is_free & ~arc & (seldom > 0.997)
    under = is_free & is_down & ~single & (seldom < 0.5) & (np.abs(along - along.max() * 0.7) < 0.5)
    met[arc] = 4.0 + random.normal(0, 0.01, int(arc.sum()))
    met[single] *= random.uniform(0.2, 0.8, int(single.sum()))
    met[under] += random.uniform(0.4, 0.8, int(under.sum())) / -ways[under, 2]
    positions = simulated.origin + ways * met[:, None]
    columns = dict(simulated.columns)
    columns["xyz"] = np.rint(
        (positions - np.array(simulated.offset)) / np.array(simulated.scale)
    ).astype(np.int32)
    noise = np.zeros(ranges.size, np.uint8)
    noise[arc | single] = 18
    noise[under] = 7
    return NoisyStreet(replace(simulated, columns=columns), noise, is_wire)


def _wire_hits(
    simulated: SimulatedDrive, ways: NDArray[np.float64], ranges: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Beams that a straight wire along the street stops, and how far it is."""
    across, above = -_WIRE_AT[0], _WIRE_AT[1]
    origin = simulated.origin - START
    square = ways[:, 0] ** 2 + ways[:, 2] ** 2
    reach = ((across - origin[:, 0]) * ways[:, 0] + (above - origin[:, 2]) * ways[:, 2]) / square
    miss = np.hypot(
        origin[:, 0] + reach * ways[:, 0] - across, origin[:, 2] + reach * ways[:, 2] - above
    )
    return (miss < _WIRE_RADIUS_M) & (reach > 0) & (reach < ranges), reach
