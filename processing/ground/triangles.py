"""A surface of triangles over scattered points: heights, slopes, and the triangle at a place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_BLOCK = 1_000_000
_ON_EDGE = 1e-9


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
        """Triangle that holds each place, one only; −1 outside the hull: (m,) int64."""
        if self.mesh is None:
            return np.full(len(xy), -1, np.int64)
        places = xy - self.origin[:2]
        found = [
            self._one_triangle(places[start : start + _BLOCK])
            for start in range(0, len(places), _BLOCK)
        ]
        return np.concatenate(found) if found else np.empty(0, np.int64)

    # scipy's mesh has no types.
    def _one_triangle(self, places: NDArray[np.float64]) -> NDArray[np.int64]:
        """The triangle that was found, or on an edge or a corner always the same of those there."""
        mesh: Any = self.mesh
        triangle: NDArray[np.int64] = mesh.find_simplex(places).astype(np.int64)
        inside = np.flatnonzero(triangle >= 0)
        of = triangle[inside]
        shares = np.einsum(
            "nij,nj->ni", mesh.transform[of, :2], places[inside] - mesh.transform[of, 2]
        )
        shares = np.column_stack((shares, 1.0 - shares.sum(axis=1)))
        for corner in range(3):
            beyond = mesh.neighbors[of, corner]
            on_edge = (np.abs(shares[:, corner]) <= _ON_EDGE) & (beyond >= 0)
            triangle[inside[on_edge]] = np.minimum(of, beyond)[on_edge]
        for corner in range(3):
            at_corner = np.abs(shares[:, corner] - 1.0) <= _ON_EDGE
            vertex = mesh.simplices[of[at_corner], corner]
            triangle[inside[at_corner]] = mesh.vertex_to_simplex[vertex]
        return triangle

    def heights_at(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height on the triangles, m; outside the hull that of the nearest corner: (m,)."""
        return self.located(xy)[0]

    def located(self, xy: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Heights as :meth:`heights_at`, and which places are outside the hull: (m,) bool."""
        from scipy.spatial import cKDTree

        places = xy - self.origin[:2]
        triangle = self.triangle_of(xy)
        heights = np.empty(len(xy))
        inside = triangle >= 0
        a, b, c = (self.xyz[self.corners[triangle[inside], k]] for k in range(3))
        u, v, w = b[:, :2] - a[:, :2], c[:, :2] - a[:, :2], places[inside] - a[:, :2]
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        area = np.where(area == 0.0, np.inf, area)
        share_b = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
        share_c = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
        heights[inside] = a[:, 2] + share_b * (b[:, 2] - a[:, 2]) + share_c * (c[:, 2] - a[:, 2])
        if not inside.all():
            nearest = cKDTree(self.xyz[:, :2]).query(places[~inside])[1]
            heights[~inside] = self.xyz[nearest, 2]
        heights += float(self.origin[2])
        return heights, ~inside


def triangulated(xyz: NDArray[np.float64]) -> Triangles:
    """Triangles over points; of points at one place in plan the lowest is taken.

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
    if len(local) < 3:
        return Triangles(local, origin, np.empty((0, 3), np.int64), None)
    try:
        mesh = Delaunay(local[:, :2])
    except QhullError:  # all on one line: there is no triangle, the nearest corner serves
        return Triangles(local, origin, np.empty((0, 3), np.int64), None)
    return Triangles(local, origin, mesh.simplices.astype(np.int64), mesh)
