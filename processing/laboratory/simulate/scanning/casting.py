"""Beams against triangles: what each meets first, by Open3D's ray casting (Embree)."""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from processing.core.library_loading import LIBRARY_LOADING
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh

NOWHERE = np.inf


class CastHits(NamedTuple):
    """What beams meet first.

    Attributes
    ----------
    ranges : (n,) float64
        m; infinite where nothing is met.
    triangles : (n,) int64
        Rows of the scene's mesh; −1 where nothing is met.
    cosines : (n,) float64
        Of the angle between beam and surface normal, 0 to 1.
    """

    ranges: Floats
    triangles: Integers
    cosines: Floats


class RaycastScene:
    """Triangles to cast at; single precision about an origin inside, double outside.

    Parameters
    ----------
    mesh : Mesh
    origin : (3,) float64
        Near the middle of the triangles: within 200 m of it places err by less than 0.02 mm.
    """

    def __init__(self, mesh: Mesh, origin: Floats) -> None:
        with LIBRARY_LOADING:
            import open3d as o3d

        self.mesh, self._origin = mesh, np.asarray(origin, np.float64)
        # Open3D's stubs don't know that a tensor is made of an array.
        self._tensor = cast("Any", o3d.core.Tensor)
        self._scene = o3d.t.geometry.RaycastingScene()
        if mesh.triangles.shape[0]:
            local = np.ascontiguousarray(mesh.vertices - self._origin, np.float32)
            triangles = np.ascontiguousarray(mesh.triangles, np.uint32)
            self._scene.add_triangles(self._tensor(local), self._tensor(triangles))
            self._scene.cast_rays(self._tensor(np.ones((1, 6), np.float32)))  # builds its tree

    def cast(self, origins: Floats, directions: Floats) -> CastHits:
        """What beams meet first.

        Parameters
        ----------
        origins, directions : (n, 3) float64
            m, the frame of the mesh; unit vectors.
        """
        count = origins.shape[0]
        if count == 0 or self.mesh.triangles.shape[0] == 0:
            return CastHits(np.full(count, NOWHERE), np.full(count, -1, np.int64), np.ones(count))
        rays = np.empty((count, 6), np.float32)
        rays[:, :3] = origins - self._origin
        rays[:, 3:] = directions
        answer = self._scene.cast_rays(self._tensor(rays))
        ranges = answer["t_hit"].numpy().astype(np.float64)
        found: NDArray[np.uint32] = answer["primitive_ids"].numpy()
        is_hit = np.isfinite(ranges)
        normals = answer["primitive_normals"].numpy()
        cosines = np.abs(np.einsum("ij,ij->i", normals, rays[:, 3:])).astype(np.float64)
        return CastHits(ranges, np.where(is_hit, found.astype(np.int64), -1), cosines)
