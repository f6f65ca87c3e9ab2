"""What is compared: the ground of an epoch, a design surface, or a level."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import date

import numpy as np
from numpy.typing import NDArray

from processing.earthwork.triangle_surface import TriangleSurface


@dataclass(frozen=True)
class GroundBlock:
    """Some ground points of an epoch.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    station : (n,) uint16
        Which set-up of the scanner measured each: points of one share its errors.
    """

    xyz: NDArray[np.float64]
    station: NDArray[np.uint16]


@dataclass(frozen=True)
class EpochGround:
    """The ground points of an epoch, given in blocks, afresh at every call.

    Attributes
    ----------
    name : str
        What people call it.
    blocks : callable
    crs : str
        ``EPSG:n``, or empty when unknown.
    measured_on : date or None
        The day of its first point; None where the points have no times with a date.
    """

    name: str
    blocks: Callable[[], Iterable[GroundBlock]]
    crs: str = ""
    measured_on: date | None = None


@dataclass(frozen=True)
class Level:
    """A horizontal plane."""

    height_m: float


Side = EpochGround | TriangleSurface | Level
