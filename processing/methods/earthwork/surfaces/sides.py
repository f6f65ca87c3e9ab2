"""What is compared: the ground of an epoch, a design surface, or a level."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import date

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface


@dataclass(frozen=True)
class GroundBlock:
    """Some ground points of an epoch.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    station : int
        Which set-up of the scanner measured them: they share its errors.
    """

    xyz: NDArray[np.float64]
    station: int


@dataclass(frozen=True)
class EpochGround:
    """The ground points of an epoch, given in blocks, afresh at every call.

    Attributes
    ----------
    name : str
        What people call it.
    blocks : callable
    low, high : (3,) float64
        Corners of the box that holds all points, ground or not, m.
    stands : (k, 3) float64
        Where the scanner stood, m, project CRS; none where it moved, and where nothing tells.
    stations : tuple of int
        Whose positions these are, as blocks tell.
    measured : callable or None
        All points that are no noise, ground or not, in blocks.
    crs : str
        ``EPSG:n``, or empty when unknown.
    measured_on : date or None
        The day of its first point; None where the points have no times with a date.
    """

    name: str
    blocks: Callable[[], Iterable[GroundBlock]]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    stands: NDArray[np.float64]
    stations: tuple[int, ...] = ()
    measured: Callable[[], Iterable[GroundBlock]] | None = None
    crs: str = ""
    measured_on: date | None = None


@dataclass(frozen=True)
class Level:
    """A horizontal plane."""

    height_m: float


Side = EpochGround | TriangleSurface | Level
