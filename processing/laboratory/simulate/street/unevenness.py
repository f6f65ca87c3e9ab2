"""How a street departs from its drawing: edges that swing, surfaces that settled, wheel ruts.

All are functions of the place alone, for the whole street, so that sections meet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.random import Generator
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.plan import SIDES, SectionPlan

_WAVES = 5
_TRACK_M = 0.8  # from the lane's middle to the wheels' paths
_TRACK_WIDE_M = 0.28


@dataclass(frozen=True)
class Waves:
    """A sum of waves over the plane of chainage and offset.

    Attributes
    ----------
    along, across : (w,) float64
        Radians per metre.
    phases, amplitudes : (w,) float64
    """

    along: Floats
    across: Floats
    phases: Floats
    amplitudes: Floats

    @staticmethod
    def drawn(random: Generator, shortest_m: float, longest_m: float, amplitude: float) -> Waves:
        """Waves of random lengths and ways whose sum has about this amplitude."""
        lengths = random.uniform(shortest_m, longest_m, _WAVES)
        directions = random.uniform(-0.9, 0.9, _WAVES)
        return Waves(
            2 * np.pi / lengths * np.cos(directions),
            2 * np.pi / lengths * np.sin(directions),
            random.uniform(0, 2 * np.pi, _WAVES),
            random.dirichlet(np.full(_WAVES, 2.0)) * amplitude * 1.5,
        )

    def at(self, chainage: ArrayLike, offset: ArrayLike = 0.0) -> Floats:
        """Their sum there: (...) float64, the arguments broadcast against each other."""
        s, o = np.broadcast_arrays(np.asarray(chainage, np.float64), np.asarray(offset, np.float64))
        total = np.zeros(s.shape)
        for one in range(_WAVES):
            turn = self.along[one] * s + self.across[one] * o + self.phases[one]
            total += self.amplitudes[one] * np.sin(turn)
        return total


@dataclass(frozen=True)
class Unevenness:
    """What time and work made of a street's drawing.

    Attributes
    ----------
    wander : mapping of side to Waves
        How far the asphalt's edge swings outwards.
    settled : Waves
        Of all surfaces.
    rut_m : float
        Depth of the wheels' paths where they are deepest.
    rutted : Waves
        Between −1 and 1: where.
    """

    wander: dict[int, Waves]
    settled: Waves
    rut_m: float
    rutted: Waves

    def rut(self, plan: SectionPlan, chainage: ArrayLike, offset: ArrayLike) -> Floats:
        """How deep the carriageway is worn there, m."""
        s, o = np.broadcast_arrays(np.asarray(chainage, np.float64), np.asarray(offset, np.float64))
        worn = np.zeros(s.shape)
        for lane in range(plan.lanes):
            middle = plan.lane_offset_m(lane)
            for track in (middle - _TRACK_M, middle + _TRACK_M):
                worn += np.exp(-(((np.abs(o) - track) / _TRACK_WIDE_M) ** 2))
        return worn * self.rut_m * (0.6 + 0.4 * self.rutted.at(s))


@lru_cache(maxsize=64)
def unevenness_of(seed: int) -> Unevenness:
    """That of a street."""
    random = chance(seed, "unevenness")
    return Unevenness(
        {
            side: Waves.drawn(chance(seed, "wander", side), 5, 30, random.uniform(0.004, 0.035))
            for side in SIDES
        },
        Waves.drawn(random, 5, 40, float(random.uniform(0.003, 0.015))),
        float(random.uniform(0, 0.012)),
        Waves.drawn(random, 15, 60, 1.0),
    )
