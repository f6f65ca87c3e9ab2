"""A section of a street as its makers see it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.alignment import Alignment
from processing.laboratory.simulate.street.ground import StreetGround
from processing.laboratory.simulate.street.layout import SectionSurfaces
from processing.laboratory.simulate.street.plan import SectionPlan


@dataclass(frozen=True)
class StreetSection:
    """Plan, alignment and ground of one section.

    Attributes
    ----------
    seed : int
        Of the street.
    layout : SectionSurfaces
        The lines of its surfaces: where curbs are lowered, where side streets meet the road.
    """

    seed: int
    plan: SectionPlan
    alignment: Alignment
    layout: SectionSurfaces

    @property
    def ground(self) -> StreetGround:
        """Its surfaces, by lines along the road."""
        return self.layout.ground

    def chance(self, what: str, number: int = 0) -> Generator:
        """A stream of its own for what a maker draws here."""
        return chance(self.seed, what, self.plan.index, number)

    def position(self, chainage: ArrayLike, offset: ArrayLike, above_m: ArrayLike = 0.0) -> Floats:
        """Places on the ground, or above it: (..., 3) float64, m, the street's frame."""
        height = self.ground.height(chainage, offset) + np.asarray(above_m, np.float64)
        return self.alignment.at(chainage, offset, height)

    def heading(self, chainage: float) -> float:
        """Where the road leads there: radians anticlockwise from east."""
        return float(self.alignment.heading(chainage))
