"""Heights on which everything beside and on a road is built."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.alignment import Alignment
from processing.laboratory.simulate.street.plan import LEFT, SectionPlan
from processing.laboratory.simulate.street.unevenness import Unevenness

_FLAT_M = 0.1
"""The road's cross fall ends this much before its drawn edge, which the laid edge swings about."""


@dataclass(frozen=True)
class Grade:
    """A side street that climbs or falls from the road.

    Attributes
    ----------
    side : int
    from_m, flat_m, to_m : float
        Chainages: the middle of the side street, how far its grade is whole on both sides, and
        how far from the middle it has vanished.
    slope : float
        Rise per metre.
    """

    side: int
    middle_m: float
    flat_m: float
    gone_m: float
    slope: float

    def rise(self, chainage: Floats, beside_m: Floats) -> Floats:
        """How much higher the side street is; ``beside_m`` counts from the asphalt's edge."""
        from_middle = np.abs(chainage - self.middle_m)
        wide = max(self.gone_m - self.flat_m, 1e-6)
        part = np.clip((self.gone_m - from_middle) / wide, 0.0, 1.0)
        beside = np.maximum(beside_m, 0.0)
        rise: Floats = self.slope * part * beside**2 / (beside + 6.0)
        return rise


@dataclass(frozen=True)
class SectionTerrain:
    """The height over which the lines of a section's profiles stand.

    On the carriageway that of the road, settled and worn; beside it that of the asphalt's edge.
    """

    plan: SectionPlan
    alignment: Alignment
    unevenness: Unevenness
    grades: tuple[Grade, ...] = ()

    def height(self, chainage: ArrayLike, offset: ArrayLike) -> Floats:
        """z, m: (...) float64, the arguments broadcast against each other."""
        s, o = np.broadcast_arrays(np.asarray(chainage, np.float64), np.asarray(offset, np.float64))
        edges = np.clip(o, _FLAT_M - self.plan.right.edge_m, self.plan.left.edge_m - _FLAT_M)
        high: Floats = self.alignment.carriageway_height(s, edges)
        high = high + self.unevenness.settled.at(s, o) - self.unevenness.rut(self.plan, s, o)
        for grade in self.grades:
            beside = o - edges if grade.side == LEFT else edges - o
            high = high + grade.rise(s, beside)
        return high
