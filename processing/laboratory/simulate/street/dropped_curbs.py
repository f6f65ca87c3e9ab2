"""Where the curb is lowered: crossings, entrances to yards, ramps for wheelchairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.plan import SectionPlan
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN

_APART_M = 1.5
_NO_DROPS = ("none", "asphalt")


@dataclass(frozen=True)
class Drop:
    """A lowered piece of a curb, by distances along it, m.

    Attributes
    ----------
    from_m, to_m : float
        The whole of it, with both ramps.
    ramp_m : float
        Length of each ramp.
    high_m : float
        What is left of the step between the ramps.
    """

    from_m: float
    to_m: float
    ramp_m: float
    high_m: float

    def breaks(self) -> tuple[float, ...]:
        """Where its lines bend, and the middles of its ramps."""
        half = self.ramp_m / 2
        low, high = self.from_m, self.to_m
        return (low, low + half, low + self.ramp_m, high - self.ramp_m, high - half, high)

    def share(self, along: Floats) -> Floats:
        """How far the curb is lowered: 0 outside, 1 between the ramps; (n,) float64."""
        inside = np.minimum(along - self.from_m, self.to_m - along) / self.ramp_m
        return np.clip(inside, 0.0, 1.0)


@dataclass(frozen=True)
class Lowering:
    """What drops make of a curb, along its nodes: (n,) float64 each.

    Attributes
    ----------
    share : (n,) float64
        0 where the curb is whole, 1 where it is lowered, between them on ramps.
    high : (n,) float64
        The step where it is lowered, m.
    """

    share: Floats
    high: Floats


def lowering(drops: tuple[Drop, ...], along: Floats) -> Lowering:
    """What drops make of a curb whose nodes lie there."""
    share, high = np.zeros(along.size), np.zeros(along.size)
    for drop in drops:
        part = drop.share(along)
        share += part
        high[part > 0] = drop.high_m
    return Lowering(share, high)


def drops_of(seed: int, plan: SectionPlan, side: int) -> tuple[Drop, ...]:
    """The drops of one side of a section, from its beginning to its end; none at junctions."""
    bands = plan.side(side)
    if bands.curb in _NO_DROPS or bands.walk_m <= 0 or side in plan.junctions:
        return ()
    if plan.style is HIGHWAY:
        return ()
    random = chance(seed, "drops", plan.index, side)
    between = (7.0, 22.0) if plan.style is URBAN else (12.0, 50.0)
    at = plan.start_m + float(random.uniform(_APART_M, between[1]))
    drops: list[Drop] = []
    while True:
        ramp = float(random.uniform(0.6, 1.5))
        wide = float(random.uniform(1.0, 8.0)) * float(random.uniform(0.5, 1.0))
        kinds = (float(random.uniform(0.045, 0.055)), 0.02, float(random.uniform(0.0, 0.01)))
        # Entrances 5 cm, crossings 2 cm (移動等円滑化のための道路構造基準, 2006, article 9).
        high = min(kinds[int(random.choice(3, p=[0.6, 0.25, 0.15]))], bands.curb_high_m * 0.7)
        end = at + wide + 2 * ramp
        if end > plan.end_m - _APART_M:
            return tuple(drops)
        drops.append(Drop(at, end, ramp, high))
        at = end + _APART_M + float(random.exponential(1.0)) * (between[0] + between[1]) / 2
