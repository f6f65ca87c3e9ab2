"""A grating or catch basin as it was found: a rectangle of true size, and what speaks for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

_SHARED = 0.25
"""Of the smaller one's area: two that share more are one, since two gratings lie beside each other
and drives differ by less than half a width. By trial: no measurement is recorded."""

_SAMPLES = 8
_POSITIONS = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
"""Where a rectangle is sampled along each side: shares are known to 1/64."""


@dataclass(frozen=True)
class GratingFacts:
    """What a confidence is made of.

    Attributes
    ----------
    rows : int
        Revolutions that crossed it.
    open_share : float
        Share of the rectangle that is open (bars let most through).
    depth_m : float
        Upper quartile of the depths of the points that fell through.
    least_part : float
        Share that is open of the least open of its nine parts but one.
    about : float
        Share of the surface around it that is open: all of a road is rough, or only this.
    raised_m : float
        How far it lies higher than roads and walks do, m.
    """

    rows: int
    open_share: float
    depth_m: float
    least_part: float
    about: float
    raised_m: float


@dataclass(frozen=True)
class GratingFound:
    """One grating.

    Attributes
    ----------
    corners : (4, 3) float64
        On the surface, m, project CRS, counterclockwise from above; the first two are a long side.
    length_m, width_m : float
        Longer and shorter side.
    facts : GratingFacts
    confidence : float
        0 … 1.
    points : tuple of int
        The measured point nearest to each corner, −1 where none is near.
    drive : int
        That they are of, among those of the survey.
    """

    corners: _Floats
    length_m: float
    width_m: float
    facts: GratingFacts
    confidence: float
    points: tuple[int, ...] = (-1,) * 4
    drive: int = 0

    def share_in(self, corners: _Floats) -> float:
        """Share of its area that lies in a rectangle, in plan."""
        first, second, last = (self.corners[k, :2] for k in (0, 1, 3))
        along, across = np.meshgrid(_POSITIONS, _POSITIONS)
        sides = np.stack([second - first, last - first])
        positions = first + np.column_stack([along.ravel(), across.ravel()]) @ sides
        return float(inside(positions, corners).mean())


def inside(positions: _Floats, corners: _Floats, beyond_m: float = 0.0) -> NDArray[np.bool_]:
    """Which places are in a rectangle in plan or no further outside than this."""
    own, long, wide = in_rectangle(positions, corners)
    low, high = -beyond_m, np.array([long, wide]) + beyond_m
    return np.asarray(((own >= low) & (own <= high)).all(axis=1))


def in_rectangle(positions: _Floats, corners: _Floats) -> tuple[_Floats, float, float]:
    """Places along and across a rectangle from its first corner, and its sides."""
    first, second, last = (corners[k, :2] for k in (0, 1, 3))
    long, wide = float(np.hypot(*(second - first))), float(np.hypot(*(last - first)))
    local = positions[:, :2] - first
    along, across = (second - first) / long, (last - first) / wide
    return np.column_stack([local @ along, local @ across]), long, wide


def one_of_each(found: Iterable[GratingFound]) -> tuple[GratingFound, ...]:
    """Gratings that several drives or passes saw, once each: as the surest of them."""
    kept: list[GratingFound] = []
    for one in sorted(found, key=lambda one: -one.confidence):
        middle = one.corners[:, :2].mean(axis=0)
        if not any(
            np.hypot(*(other.corners[:, :2].mean(axis=0) - middle)) < other.length_m + one.length_m
            and max(one.share_in(other.corners), other.share_in(one.corners)) > _SHARED
            for other in kept
        ):
            kept.append(one)
    return tuple(kept)
