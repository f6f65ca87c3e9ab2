"""A surface of triangles over scattered points: heights, slopes, the triangle at a position."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

_POSITIONS_AT_ONCE = 1_000_000
"""Positions looked up at a time: their shares take 24 MB."""

_ON_EDGE = 1e-9
"""Share of a triangle's height within which a position is on its edge: more than rounding leaves,
and far below a scanner's resolution."""

_OUTSIDE = -1e-12
"""Share of a triangle's area by which a position must lie beyond the hull to be outside it: more
than rounding, so that corners of the hull are inside."""

_STRIP_TRIANGLES = 3.0
"""Width of the strips in which positions are walked through, in mean triangles; it changes only the
time. By trial."""

_NARROWEST_STRIP_M = 1e-6
"""Keeps strips over corners on one line from having no width."""

_FEWEST_CORNERS = 3


class _AskedPositions(NamedTuple):
    """Positions in plan, m from the mesh's origin, and the order in which to look them up."""

    positions: NDArray[np.float64]
    order: NDArray[np.int64]


class _LocatedPositions(NamedTuple):
    """The triangle of each position or −1, and its barycentric shares there: (n,) and (n, 3)."""

    triangles: NDArray[np.int64]
    shares: NDArray[np.float64]


@dataclass(frozen=True)
class Triangles:
    """Delaunay triangles in plan.

    Attributes
    ----------
    xyz : (n, 3) float64
        Corners, m from ``origin``.
    origin : (3,) float64
        Shift of all coordinates, m: triangulating large coordinates loses digits.
    corners : (t, 3) int64
        Empty where all points lie on one line.
    mesh : scipy.spatial.Delaunay or None
    """

    xyz: NDArray[np.float64]
    origin: NDArray[np.float64]
    corners: NDArray[np.int64]
    mesh: object | None

    def slopes_deg(self) -> NDArray[np.float64]:
        """Angle of each triangle's plane from the horizontal: (t,) degrees."""
        first, second, third = (self.xyz[self.corners[:, k]] for k in range(3))
        normals = np.cross(second - first, third - first)
        flat = np.hypot(normals[:, 0], normals[:, 1])
        slopes: NDArray[np.float64] = np.degrees(np.arctan2(flat, np.abs(normals[:, 2])))
        return slopes

    def triangle_of(self, xy: NDArray[np.float64]) -> NDArray[np.int64]:
        """Triangle that holds each position, one only; −1 outside the hull: (m,) int64."""
        if self.mesh is None:
            return np.full(len(xy), -1, np.int64)
        positions = xy - self.origin[:2]
        found = [
            self._one_triangle(positions[start : start + _POSITIONS_AT_ONCE])
            for start in range(0, len(positions), _POSITIONS_AT_ONCE)
        ]
        return np.concatenate(found) if found else np.empty(0, np.int64)

    # scipy's mesh has no types.
    def _one_triangle(self, positions: NDArray[np.float64]) -> NDArray[np.int64]:
        """The triangle that was found, or on an edge or a corner always the same of those there."""
        mesh: Any = self.mesh
        triangle = np.empty(len(positions), np.int64)
        shares = np.zeros((len(positions), 3))
        asked = _AskedPositions(positions, self._along_the_plan(positions))
        _walk_kernel(
            self.xyz, mesh.simplices, mesh.neighbors, asked, _LocatedPositions(triangle, shares)
        )
        inside = np.flatnonzero(triangle >= 0)
        of, shares = triangle[inside], shares[inside]
        for corner in range(3):
            beyond = mesh.neighbors[of, corner]
            on_edge = (np.abs(shares[:, corner]) <= _ON_EDGE) & (beyond >= 0)
            triangle[inside[on_edge]] = np.minimum(of, beyond)[on_edge]
        for corner in range(3):
            at_corner = np.abs(shares[:, corner] - 1.0) <= _ON_EDGE
            vertex = mesh.simplices[of[at_corner], corner]
            triangle[inside[at_corner]] = mesh.vertex_to_simplex[vertex]
        return triangle

    def _along_the_plan(self, positions: NDArray[np.float64]) -> NDArray[np.int64]:
        """An order in which each position is near the one before it: short walks over the mesh.

        Strips of a few triangles' width, every second one backwards.
        """
        size = self.xyz[:, :2].max(axis=0)
        wide = _STRIP_TRIANGLES * float(np.sqrt(size.prod() / len(self.corners)))
        strip = np.floor(positions[:, 1] / max(wide, _NARROWEST_STRIP_M))
        along = np.where(strip % 2 == 0, positions[:, 0], -positions[:, 0])
        return np.lexsort((along, strip))

    @cached_property
    def _corner_tree(self) -> cKDTree:
        from scipy.spatial import cKDTree

        return cKDTree(self.xyz[:, :2])

    def heights_at(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height on the triangles, m; outside the hull that of the nearest corner: (m,)."""
        return self.located(xy)[0]

    def located(self, xy: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Heights as :meth:`heights_at`, and which positions are outside the hull: (m,) bool."""
        positions = xy - self.origin[:2]
        triangle = self.triangle_of(xy)
        heights = np.empty(len(xy))
        inside = triangle >= 0
        a, b, c = (self.xyz[self.corners[triangle[inside], k]] for k in range(3))
        u, v, w = b[:, :2] - a[:, :2], c[:, :2] - a[:, :2], positions[inside] - a[:, :2]
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        area = np.where(area == 0.0, np.inf, area)
        share_b = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
        share_c = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
        heights[inside] = a[:, 2] + share_b * (b[:, 2] - a[:, 2]) + share_c * (c[:, 2] - a[:, 2])
        if not inside.all():
            nearest = self._corner_tree.query(positions[~inside])[1]
            heights[~inside] = self.xyz[nearest, 2]
        heights += float(self.origin[2])
        return heights, ~inside


def triangulate_points(xyz: NDArray[np.float64]) -> Triangles:
    """Triangles over points; of points at one position in plan the lowest is taken.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, n at least 1, finite.
    """
    from scipy.spatial import Delaunay, QhullError

    order = np.lexsort((xyz[:, 2], xyz[:, 1], xyz[:, 0]))
    ordered = xyz[order]
    is_first = np.concatenate(([True], np.any(np.diff(ordered[:, :2], axis=0) != 0.0, axis=1)))
    corners = ordered[is_first]
    origin = corners.min(axis=0)
    local = corners - origin
    if len(local) < _FEWEST_CORNERS:
        return Triangles(local, origin, np.empty((0, 3), np.int64), None)
    try:
        mesh = Delaunay(local[:, :2])
    except QhullError:  # all on one line: there is no triangle, the nearest corner serves
        return Triangles(local, origin, np.empty((0, 3), np.int64), None)
    return Triangles(local, origin, mesh.simplices.astype(np.int64), mesh)


@kernel
def _walk_kernel(
    corners: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbours: NDArray[np.int32],
    asked: _AskedPositions,
    found: _LocatedPositions,
) -> None:
    """The triangle of each position, from that of the last one over edges that it lies beyond.

    Such a walk ends in a Delaunay mesh; it never goes back, which rounding could make it do.

    References
    ----------
    Devillers, Pion & Teillaud 2002, the remembering walk.
    """
    positions = asked.positions
    held, shares = found.triangles, found.shares
    now = 0
    most = triangles.shape[0] + 3
    for number in asked.order:
        x, y = positions[number, 0], positions[number, 1]
        before = -2
        is_outside = False
        for _ in range(most):
            ends = triangles[now]
            area = _double_area(
                corners[ends[0]], corners[ends[1]], corners[ends[2], 0], corners[ends[2], 1]
            )
            following = -1
            for side in range(3):
                first, second = ends[(side + 1) % 3], ends[(side + 2) % 3]
                part = _double_area(corners[first], corners[second], x, y)
                shares[number, side] = part / area if area != 0.0 else 0.0
                beyond = neighbours[now, side]
                if part < 0.0 and beyond != before and following < 0:
                    if beyond >= 0:
                        following = beyond
                    elif part < _OUTSIDE * area:
                        is_outside = True
            if following < 0 or is_outside:
                break
            before, now = now, following
        held[number] = -1 if is_outside else now


@kernel
def _double_area(start: NDArray[np.float64], end: NDArray[np.float64], x: float, y: float) -> float:
    """Twice the area of a triangle; positive where its third corner lies left of the edge."""
    return float((end[0] - start[0]) * (y - start[1]) - (end[1] - start[1]) * (x - start[0]))


def warm_up() -> None:
    """Compile the kernels of this file."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    triangulate_points(corners).triangle_of(np.array([[0.2, 0.2]]))
