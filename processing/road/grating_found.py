"""A grating or catch basin as it was found: a rectangle of true size, and what speaks for it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class GratingFacts:
    """What a confidence is made of.

    Attributes
    ----------
    hits : int
        Notches inside.
    rows : int
        Revolutions that crossed it.
    density : float
        Share of the rectangle's crossings by rows that are open (bars let most through).
    depth_m : float
        Median depth of the points that fell through.
    rim_m : float
        How far its top is from a plane, RMS.
    filled : float
        Share of its nine parts with notches.
    contrast : float
        Notches inside against those beside it, by area: 1 where nothing beside is open.
    """

    hits: int
    rows: int
    density: float
    depth_m: float
    rim_m: float
    filled: float
    contrast: float


@dataclass(frozen=True)
class GratingFound:
    """One grating.

    Attributes
    ----------
    corners : (4, 3) float64
        On the surface, m, project CRS, counterclockwise from above; the first two are a long side.
    length_m, width_m : float
        Longer and shorter side.
    time_s : float
        When the vehicle was beside it.
    points : (k,) int64
        Points of the drive by which it was found.
    facts : GratingFacts
    confidence : float
        0 … 1.
    """

    corners: NDArray[np.float64]
    length_m: float
    width_m: float
    time_s: float
    points: NDArray[np.int64]
    facts: GratingFacts
    confidence: float
