"""SectionProjection: how project space lies on the plane of a cut."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.map.feature import Position
from processing.section.cut import Cut
from widgets.mouse_tools.mouse_tool import Ray


class SectionProjection:
    """Offsets to the right, heights upwards about the cut's middle; nothing outside the slab.

    Parameters
    ----------
    cut : Cut
    """

    def __init__(self, cut: Cut) -> None:
        self.cut = cut

    def to_plane(self, xyz: Floats) -> Floats:
        """(n, 2) metres, x right, y down, from (n, 3) places; NaN outside the slab."""
        section = self.cut.to_section(xyz)
        positions = self.on_plane(section)
        positions[~self._is_inside(section)] = np.nan
        return positions

    def on_plane(self, section: Floats) -> Floats:
        """(n, 2) of the plane from (n, 3) offsets, heights and distances."""
        return np.column_stack([section[:, 0], self.cut.middle[2] - section[:, 1]])

    def height_of(self, y: float) -> float:
        """The height in the project that a row of the plane stands for."""
        return self.cut.middle[2] - y

    def lines_on_plane(self, xyz: Floats, ends: NDArray[np.int64]) -> list[Floats]:
        """The part of each segment within the slab: (2, 2), or (0, 2) where none is.

        Parameters
        ----------
        xyz : (n, 3) float64
        ends : (m, 2) int64
            Numbers of the places that each segment joins.
        """
        section = self.cut.to_section(xyz)
        half = self.cut.width_m / 2
        starts, stops = section[ends[:, 0]], section[ends[:, 1]]
        way = stops - starts
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = (-half - starts[:, 2]) / way[:, 2], (half - starts[:, 2]) / way[:, 2]
        is_level = way[:, 2] == 0
        begin = np.where(is_level, 0.0, np.maximum(np.fmin(one, other), 0.0))
        end = np.where(is_level, 1.0, np.minimum(np.fmax(one, other), 1.0))
        is_shown = (begin <= end) & ~(is_level & (np.abs(starts[:, 2]) > half))
        nothing = np.empty((0, 2))
        lines = [nothing] * len(ends)
        for number in np.flatnonzero(is_shown).tolist():
            shares = np.array([[begin[number]], [end[number]]])
            lines[number] = self.on_plane(starts[number] + shares * way[number])
        return lines

    def ray(self, position: tuple[float, float]) -> Ray | None:
        """At right angles through the slab, from its near face."""
        x, y = position
        start = self.cut.to_space([[x, self.height_of(y), -self.cut.width_m / 2]])[0]
        east, north = self.cut.normal
        return Ray(_position(start), (east, north, 0.0), self.cut)

    def reach_m(
        self,
        position: tuple[float, float],  # noqa: ARG002 - the same everywhere
        reach: float,
        at: Position | None,  # noqa: ARG002 - at any depth
    ) -> float:
        """The plane's units are metres."""
        return reach

    def is_near(self, xyz: Floats) -> NDArray[np.bool_]:
        """(n,) whether (n, 3) places lie in the slab."""
        return self._is_inside(self.cut.to_section(xyz))

    def _is_inside(self, section: Floats) -> NDArray[np.bool_]:
        # Beyond its ends the plane goes on: what is drawn there may still be seen.
        inside: NDArray[np.bool_] = np.abs(section[:, 2]) <= self.cut.width_m / 2
        return inside


def _position(position: Floats) -> Position:
    easting, northing, height = position.tolist()
    return easting, northing, height
