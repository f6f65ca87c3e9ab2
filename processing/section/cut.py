"""Cut: a slab of points seen from its side, and the way there and back in coordinates."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.arrays import Floats
from processing.core.errors import OutOfRange
from processing.core.text import Text

_UNIT_TOLERANCE = 1e-6
"""By which a unit vector's length may be off: a micrometre on a metre, more than rounding."""


@dataclass(frozen=True)
class Cut:
    """An upright slab through the recording.

    Attributes
    ----------
    middle : tuple of float
        Easting, northing and height of a point that the slab goes through, m, project CRS.
    direction : tuple of float
        Unit vector in plan (east, north) of the section's horizontal axis, which points to the
        right of the picture. One looks at right angles to it, to its left in plan: at a section
        across a line, along the line, so that what is left of the line is left in the picture.
    width_m : float
        Thickness of the slab; half of it lies on either side of the plane.
    half_length_m : float
        How far the slab reaches from the middle to either side.

    Raises
    ------
    OutOfRange
        A size isn't positive, or the direction is no unit vector.
    """

    middle: tuple[float, float, float]
    direction: tuple[float, float]
    width_m: float = 1.0
    half_length_m: float = 15.0

    def __post_init__(self) -> None:
        sizes = self.width_m, self.half_length_m
        length = math.hypot(*self.direction)
        is_whole = all(map(math.isfinite, (*self.middle, *sizes))) and min(sizes) > 0
        if is_whole and abs(length - 1.0) <= _UNIT_TOLERANCE:
            return
        raise OutOfRange(
            Text("A section can't be like this.", "この断面は設定できません。"),
            Text(
                "width {width} m, half length {half} m, direction of length {length:.3f}",
                "幅 {width} m、片側の長さ {half} m、方向ベクトルの長さ {length:.3f}",
            ).filled(width=self.width_m, half=self.half_length_m, length=length),
            Text("Give positive sizes.", "幅と長さには正の値を指定してください。"),
        )

    @property
    def normal(self) -> tuple[float, float]:
        """Unit vector in plan away from the viewer; distances from the plane count along it."""
        east, north = self.direction
        return -north, east

    @property
    def outline(self) -> Floats:
        """The slab from above.

        Returns
        -------
        (4, 2) float64
            Easting and northing of its corners, m, anticlockwise from the near left one.
        """
        half, across = self.half_length_m, self.width_m / 2
        corners = np.array([[-half, -across], [half, -across], [half, across], [-half, across]])
        axes = np.array([self.direction, self.normal])
        outline: Floats = corners @ axes + np.array(self.middle[:2])
        return outline

    def to_section(self, xyz: ArrayLike) -> Floats:
        """Places as the section sees them.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.

        Returns
        -------
        (n, 3) float64
            Offset to the right of the middle, height (m, as in the project), distance from the
            plane (away from the viewer positive).
        """
        positions = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
        plan = positions[:, :2] - np.array(self.middle[:2])
        return np.column_stack([plan @ self.direction, positions[:, 2], plan @ self.normal])

    def to_space(self, section: ArrayLike) -> Floats:
        """Places of the section in space: what :meth:`to_section` undoes.

        Parameters
        ----------
        section : (n, 3) float64
            Offset, height, distance from the plane, m.

        Returns
        -------
        (n, 3) float64
            m, project CRS.
        """
        given = np.asarray(section, dtype=np.float64).reshape(-1, 3)
        axes = np.array([self.direction, self.normal])
        plan = given[:, [0, 2]] @ axes + np.array(self.middle[:2])
        return np.column_stack([plan, given[:, 1]])

    def holds(self, section: Floats) -> NDArray[np.bool_]:
        """Which places of the section lie in the slab: (n,) from (n, 3) of :meth:`to_section`."""
        inside: NDArray[np.bool_] = (np.abs(section[:, 0]) <= self.half_length_m) & (
            np.abs(section[:, 2]) <= self.width_m / 2
        )
        return inside
