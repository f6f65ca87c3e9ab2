"""The line of a gutter in plan, with coordinates along and across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

_Floats = NDArray[np.float64]

STEP_M = 0.25
"""Between places of an axis: under half a lid, and a bend of 10 m radius leaves a chord by less
than a millimetre there."""

_SAME_M, _LEAST_M = 1e-6, 1e-9
"""Places nearer to the one before are the same; guard of a division."""

_BEYOND_M = 0.5
"""Places before and behind an axis are still told along it so far: a lid's length nearly."""


@dataclass(frozen=True)
class GutterAxis:
    """A smooth line about along the middle of a gutter's lids.

    Attributes
    ----------
    xyz : (m, 3) float64
        Every ``STEP_M`` along it, m, project CRS.
    outwards : (m, 2) float64
        Level unit vectors to its right.
    """

    xyz: _Floats
    outwards: _Floats

    @staticmethod
    def through(positions: _Floats) -> GutterAxis:
        """The axis through places in order: (n, 3) float64, n ≥ 2, m."""
        driven = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(positions[:, :2], axis=0).T))])
        is_new = np.concatenate([[True], np.diff(driven) > _SAME_M])
        count = max(2, int(np.ceil(driven[-1] / STEP_M)) + 1)
        at = np.arange(count) * STEP_M
        inside = np.minimum(at, driven[-1])
        xyz = np.column_stack([np.interp(inside, driven[is_new], k[is_new]) for k in positions.T])
        end = xyz[-1] - xyz[-2]
        if at[-1] > driven[-1]:
            left = max(float(np.hypot(end[0], end[1])), _LEAST_M)
            xyz[-1] = xyz[-2] + end * (STEP_M / left)
        ahead = np.gradient(xyz[:, :2], axis=0)
        ahead /= np.maximum(np.hypot(ahead[:, 0], ahead[:, 1]), _LEAST_M)[:, None]
        return GutterAxis(xyz, np.column_stack([ahead[:, 1], -ahead[:, 0]]))

    @property
    def length_m(self) -> float:
        """In plan."""
        return (len(self.xyz) - 1) * STEP_M

    def positions(self, along_m: _Floats, across_m: _Floats) -> _Floats:
        """Places at its height: (n, 3) float64, m, project CRS."""
        at = np.clip(along_m / STEP_M, 0.0, len(self.xyz) - 1.0)
        known = np.arange(len(self.xyz))
        xyz = np.column_stack([np.interp(at, known, axis) for axis in self.xyz.T])
        right = np.column_stack([np.interp(at, known, axis) for axis in self.outwards.T])
        beyond = along_m - at * STEP_M
        xyz[:, :2] += across_m[:, None] * right
        xyz[:, :2] += beyond[:, None] * np.column_stack([-right[:, 1], right[:, 0]])
        return xyz

    def coordinates_of(self, xyz: _Floats, within_m: float) -> tuple[_Floats, _Floats, _Floats]:
        """Along, across (to the right) and above of places: (n,) each, NaN for those farther off.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.
        """
        found = np.full((3, len(xyz)), np.nan)
        bound = within_m + STEP_M
        low, high = self.xyz[:, :2].min(axis=0) - bound, self.xyz[:, :2].max(axis=0) + bound
        boxed = np.flatnonzero(((xyz[:, :2] >= low) & (xyz[:, :2] <= high)).all(axis=1))
        away, nearest = cKDTree(self.xyz[:, :2]).query(xyz[boxed, :2], distance_upper_bound=bound)
        is_near = np.isfinite(away)
        near = boxed[is_near]
        if near.size == 0:
            return found[0], found[1], found[2]
        at: NDArray[np.int64] = np.asarray(nearest, np.int64)[is_near]
        right = self.outwards[at]
        off = xyz[near] - self.xyz[at]
        ahead = -right[:, 1] * off[:, 0] + right[:, 0] * off[:, 1]
        along = np.asarray(at * STEP_M + ahead, np.float64)
        back = self.positions(along, np.zeros(near.size))
        known = np.arange(len(self.xyz))
        here = np.column_stack([np.interp(along / STEP_M, known, axis) for axis in self.outwards.T])
        off = xyz[near] - back
        across = (off[:, :2] * here).sum(axis=1)
        is_in = (
            (np.abs(across) <= within_m)
            & (along >= -_BEYOND_M)
            & (along <= self.length_m + _BEYOND_M)
        )
        chosen = near[is_in]
        found[:, chosen] = np.array([along, across, off[:, 2]])[:, is_in]
        return found[0], found[1], found[2]
