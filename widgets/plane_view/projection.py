"""PlaneProjection: how space lies on the plane of a picture, the one thing such views differ in."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.map.feature import Position
from widgets.mouse_tools.mouse_tool import Ray

PlanePoint = tuple[float, float]


class PlaneProjection(Protocol):
    """From space to a plane: x to the right, y downwards, in units of the plane.

    The units are metres for a section and for the map from above, pixels of the image for a
    camera. A lay is a value: when anything about it changes, the view has another one.
    """

    def to_plane(self, xyz: Floats) -> Floats:
        """Where places lie.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.

        Returns
        -------
        (n, 2) float64
            NaN where a place isn't shown, as behind a camera.
        """

    def lines_on_plane(self, xyz: Floats, ends: NDArray[np.int64]) -> list[Floats]:
        """Straight segments in space as lines of the plane.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.
        ends : (m, 2) int64
            Indices of the places at both ends.

        Returns
        -------
        list of (k, 2) float64
            One for each segment: of more than two places where the picture bends it, cut off
            where it leaves what is shown, empty where nothing of it is.
        """

    def ray(self, position: PlanePoint) -> Ray | None:
        """The line of sight through a place of the plane, project CRS."""

    def reach_m(self, position: PlanePoint, reach: float, at: Position | None) -> float:
        """How many metres in space a distance on the plane means.

        Parameters
        ----------
        position : tuple of float
            On the plane.
        reach : float
            Units of the plane.
        at : Position or None
            The measured point there, if one is.
        """

    def is_near(self, xyz: Floats) -> NDArray[np.bool_]:
        """(n,) which of (n, 3) places are drawn at full strength: within the slab, in reach."""
