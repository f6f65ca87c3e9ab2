"""TriangleSurface: given triangles (a design, a TIN), one height at each position."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.text import Text
from processing.core.worked_ahead import in_order
from processing.methods.earthwork.geometry.plan_buckets import PlanBuckets, sort_into_buckets

Floats = NDArray[np.float64]

_POSITIONS_AT_ONCE = 65_536
"""Positions of a share of a core's work."""

_NO_WIDTH_M = 1e-6
"""A triangle that is nowhere wider seen from above is vertical, or no triangle at all."""

_ON_EDGE_M = 1e-9
"""A position so far outside still counts as on the outline: what rounding makes of a corner."""


@dataclass(frozen=True)
class TriangleSurface:
    """Triangles over a plan; they don't overlap seen from above.

    Attributes
    ----------
    xyz : (n, 3) float64
        Corners, m, project CRS (x easting, y northing).
    corners : (t, 3) int64
        Rows of ``xyz``, in either sense.
    name : str
        As its file names it; empty for one made here.
    notes : tuple of Text
        What a reader of numbers against it has to know, a sentence each.
    """

    xyz: Floats
    corners: NDArray[np.int64]
    name: str = ""
    notes: tuple[Text, ...] = ()

    def heights_at(self, xy: Floats) -> Floats:
        """Height on the triangle above or below each position: (n,) float64, m; NaN outside.

        A position on an edge or a corner belongs to the first of the triangles there, so that none
        between triangles is left out.

        Parameters
        ----------
        xy : (n, 2) float64
            m, project CRS.
        """
        positions = np.ascontiguousarray(np.asarray(xy, np.float64)[:, :2])
        heights = np.full(len(positions), np.nan)
        if not len(self._triangles):
            return heights
        buckets, origin = self._buckets, self.origin
        frame = (buckets.west, buckets.south, buckets.size_m, buckets.rows, buckets.columns)

        def fill(start: int) -> None:
            part = slice(start, start + _POSITIONS_AT_ONCE)
            local = positions[part] - origin[:2]
            held = (buckets.starts, buckets.triangles)
            _heights_kernel(local, self._triangles, frame, held, heights[part])

        starts = range(0, len(positions), _POSITIONS_AT_ONCE)
        if len(starts) == 1:  # a position under the mouse is worth no threads
            fill(0)
        else:
            for _ in in_order(fill, starts):
                pass
        heights += origin[2]
        return heights

    def slopes_deg(self) -> Floats:
        """Angle of each triangle's plane from the horizontal: (t,) float64, degrees, 0 to 90."""
        first, second, third = np.moveaxis(self.xyz[self.corners], 1, 0)
        normals = np.cross(second - first, third - first)
        flat = np.hypot(normals[:, 0], normals[:, 1])
        slopes: Floats = np.degrees(np.arctan2(flat, np.abs(normals[:, 2])))
        return slopes

    def plan_area_m2(self) -> float:
        """Area of the triangles seen from above."""
        return float(twice_areas(self._triangles).sum()) / 2

    def extent(self) -> tuple[float, float, float, float]:
        """Least easting and northing, greatest easting and northing of its triangles, m.

        There has to be a triangle.
        """
        plan = self.xyz[self.corners.ravel(), :2]
        west, south = plan.min(axis=0).tolist()
        east, north = plan.max(axis=0).tolist()
        return west, south, east, north

    @cached_property
    def origin(self) -> Floats:
        """A place near the triangles that is subtracted before any arithmetic: (3,) float64, m."""
        if not len(self.corners):
            return np.zeros(3)
        positions = self.xyz[self.corners.ravel()]
        known = positions[np.isfinite(positions).all(axis=1)]
        origin: Floats = np.floor(known.min(axis=0)) if len(known) else np.zeros(3)
        return origin

    @cached_property
    def is_vertical(self) -> NDArray[np.bool_]:
        """Triangles without width in plan, on which no position lies: (t,) bool.

        Those with a corner that is no number are among them.
        """
        figures = self.xyz[self.corners] - self.origin
        sides = np.roll(figures, -1, axis=1) - figures
        longest = np.hypot(sides[:, :, 0], sides[:, :, 1]).max(axis=1, initial=_NO_WIDTH_M)
        is_seen: NDArray[np.bool_] = np.abs(twice_areas(figures)) > _NO_WIDTH_M * longest
        return ~(is_seen & np.isfinite(figures).all(axis=(1, 2)))

    def plan_triangles(self, origin: Floats) -> Floats:
        """The triangles that are seen from above, counterclockwise: (k, 3, 3) float64, a copy.

        Parameters
        ----------
        origin : (3,) float64
            What is subtracted from all coordinates, m.
        """
        figures = self.xyz[self.corners[~self.is_vertical]] - origin
        is_clockwise = twice_areas(figures) < 0.0
        figures[is_clockwise] = figures[is_clockwise, ::-1]
        return np.ascontiguousarray(figures)

    @cached_property
    def _triangles(self) -> Floats:
        return self.plan_triangles(self.origin)

    @cached_property
    def _buckets(self) -> PlanBuckets:
        return sort_into_buckets(self._triangles)


def twice_areas(triangles: Floats) -> Floats:
    """Twice the area of triangles in plan, negative where they go clockwise: (t,) float64.

    Parameters
    ----------
    triangles : (t, 3, 2 or 3) float64
        Near the origin, m.
    """
    first, second, third = (triangles[:, corner, :2] for corner in range(3))
    u, v = second - first, third - first
    doubled: Floats = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return doubled


@kernel
def _beside(start: Floats, end: Floats, x: float, y: float) -> float:
    """Twice the area between an edge and a position, positive to the left of the edge.

    Worked out from the same end whichever triangle asks, so that a position is never outside both
    triangles of an edge.
    """
    if start[0] < end[0] or (start[0] == end[0] and start[1] < end[1]):
        return float((end[0] - start[0]) * (y - start[1]) - (end[1] - start[1]) * (x - start[0]))
    return float((end[0] - start[0]) * (y - end[1]) - (end[1] - start[1]) * (x - end[0]))


@kernel
def _height_in(triangle: Floats, x: float, y: float) -> tuple[float, float]:
    """How far outside of a triangle a position is, 0 inside, and the height on its plane there."""
    out = 0.0
    whole = 0.0
    height = 0.0
    for one in range(3):
        start, end = triangle[one], triangle[(one + 1) % 3]
        area = _beside(start, end, x, y)
        if area < 0.0:
            out = max(out, -area / np.hypot(end[0] - start[0], end[1] - start[1]))
        whole += area
        height += area * triangle[(one + 2) % 3, 2]
    return out, height / whole


@kernel
def _heights_kernel(
    positions: Floats,
    triangles: Floats,
    frame: tuple[float, float, float, int, int],
    held: tuple[NDArray[np.int64], NDArray[np.int64]],
    heights: Floats,
) -> None:
    """Heights at positions; those outside of all triangles stay as they are."""
    west, south, size, rows, columns = frame
    starts, numbers = held
    for position in range(positions.shape[0]):
        x, y = positions[position, 0], positions[position, 1]
        along, up = (x - west) / size, (y - south) / size
        # Written so that a position that is no number is passed over, too.
        if not (-1.0 < along < columns + 1.0 and -1.0 < up < rows + 1.0):
            continue
        column = min(max(int(np.floor(along)), 0), columns - 1)
        row = min(max(int(np.floor(up)), 0), rows - 1)
        bucket = row * columns + column
        nearest = _ON_EDGE_M
        for entry in range(starts[bucket], starts[bucket + 1]):
            out, height = _height_in(triangles[numbers[entry]], x, y)
            if out < nearest:
                nearest = out
                heights[position] = height
                if out == 0.0:
                    break


def warm_up() -> None:
    """Compile the kernels of this file."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    TriangleSurface(corners, np.array([[0, 1, 2]])).heights_at(np.array([[0.2, 0.2]]))
