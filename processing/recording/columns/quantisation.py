"""Quantisation: the grid of integers on which coordinates lie."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Quantisation:
    """Metres = integers × scale + offset."""

    scale: Triple
    offset: Triple

    def metres(self, integers: NDArray[Any]) -> Floats:
        """Metres, project CRS: (…, 3) float64, a copy."""
        metres: Floats = integers * self._scale
        metres += self._offset
        return metres

    def about(self, origin: Floats) -> tuple[Floats, Floats]:
        """Scale and shift for kernels, (3,) each: integers × scale + shift = m about an origin."""
        return self._scale, self._offset - origin

    def in_units(self, xyz: Floats) -> Floats:
        """Places in the integers' own units, not rounded: (…, 3) float64."""
        units: Floats = (xyz - self._offset) / self._scale
        return units

    def rounded(self, xyz: Floats) -> Floats:
        """The nearest integers of places: (…, 3) float64 with whole numbers."""
        return np.rint(self.in_units(xyz))

    def steps(self, shifts: Floats) -> Floats:
        """The nearest whole steps of the grid to shifts in metres: (…, 3) float64."""
        return np.rint(shifts / self._scale)

    def box(self, low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """The least and the greatest integers that a box with these corners, m, may hold."""
        return np.floor(self.in_units(low)), np.ceil(self.in_units(high))

    def of_integers(self, matrix: Floats, origin: Floats) -> Floats:
        """A matrix for integers in place of metres.

        Parameters
        ----------
        matrix : (k, 4) float64
            For metres about the origin, and 1.
        origin : (3,) float64
            m, project CRS.

        Returns
        -------
        (k, 4) float64
        """
        (scale, shift), axes = self.about(origin), matrix[:, :3]
        return np.column_stack([axes * scale, axes @ shift + matrix[:, 3]])

    @cached_property
    def _scale(self) -> Floats:
        return np.array(self.scale)

    @cached_property
    def _offset(self) -> Floats:
        return np.array(self.offset)
