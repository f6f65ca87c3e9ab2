"""Curves and gradients of a route, as the road's ledger asks for them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats

TIGHT_M = 30.0
"""Curves of a smaller radius stand in the ledger (道路法施行規則 第4条の2)."""

STEEP_PERCENT = 8.0
"""Gradients of it and more stand in the ledger (道路法施行規則 第4条の2)."""

_STEP_M = 1.0
_CHORD_M, _SLOPE_M = 10.0, 5.0
"""Half of what a radius and a gradient are measured over: a vertex set 5 cm beside a straight
centre line bends it to 1,000 m, not below; a height 5 cm wrong tilts it by 0.5 %."""

_STRAIGHT_M = 1000.0
"""From here on it is none: see above."""


@dataclass(frozen=True)
class RoadAlignment:
    """A stretch of a route.

    Attributes
    ----------
    least_radius_m : float
        Smallest radius in plan; NaN where it is straight.
    tight_m : float
        How long its radius is below `TIGHT_M`.
    steepest_percent : float
        Of heights along the centre line, whichever way; NaN where it has none.
    steep_m : float
        How long it is as steep as `STEEP_PERCENT` or steeper.
    """

    least_radius_m: float = math.nan
    tight_m: float = 0.0
    steepest_percent: float = math.nan
    steep_m: float = 0.0


class RouteShape:
    """Radius and gradient at every metre of a centre line.

    Parameters
    ----------
    xyz : (n, 3) float64
        Its vertices, m. Where all heights are 0 it has none.
    """

    def __init__(self, xyz: Floats) -> None:
        self._xy, self._z = xyz[:, :2], xyz[:, 2]
        steps = np.hypot(*np.diff(self._xy, axis=0).T)
        self._reached: Floats = np.concatenate([[0.0], np.cumsum(steps)])
        self._length = float(self._reached[-1])
        self._has_heights = bool(np.isfinite(self._z).all() and (self._z != 0.0).any())

    def between(self, start_m: float, end_m: float) -> RoadAlignment:
        """A stretch, from and to distances along the line."""
        count = max(1, math.ceil((end_m - start_m) / _STEP_M))
        along = start_m + (np.arange(count) + 0.5) * (end_m - start_m) / count
        step = (end_m - start_m) / count
        radii, slopes = self._radii(along), self._slopes(along)
        least = float(radii.min(initial=math.inf))
        steepest = float(slopes.max(initial=0.0)) if self._has_heights else math.nan
        return RoadAlignment(
            least if least < _STRAIGHT_M else math.nan,
            step * int((radii < TIGHT_M).sum()),
            steepest,
            step * int((slopes >= STEEP_PERCENT).sum()) if self._has_heights else 0.0,
        )

    def _radii(self, along: Floats) -> Floats:
        """Of the circle through three places; infinite near the ends, where there are none."""
        inside = (along >= _CHORD_M) & (along <= self._length - _CHORD_M)
        before, here, after = (self._places(along + by) for by in (-_CHORD_M, 0.0, _CHORD_M))
        a, b, c = (np.hypot(*(one - two).T) for one, two in
                   ((before, here), (here, after), (after, before)))  # fmt: skip
        first, second = here - before, after - before
        twice = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            radii = np.where(twice > 0, a * b * c / (2 * twice), math.inf)
        found: Floats = np.where(inside, radii, math.inf)
        return found

    def _slopes(self, along: Floats) -> Floats:
        low = np.clip(along - _SLOPE_M, 0.0, self._length)
        high = np.clip(along + _SLOPE_M, 0.0, self._length)
        rise = np.interp(high, self._reached, self._z) - np.interp(low, self._reached, self._z)
        slopes: Floats = 100.0 * np.abs(rise) / np.maximum(high - low, _STEP_M)
        return slopes

    def _places(self, along: Floats) -> Floats:
        return np.stack(
            [np.interp(along, self._reached, self._xy[:, axis]) for axis in (0, 1)], axis=1
        )
