"""What panes, mirrors and water show: echoes of things by way of them, where they seem to be.

An image is no copy of its thing: its range is longer, its light weaker, so that it is measured less
exactly, and no pane is quite flat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.return_kernels import (
    first_returns,
    mirrored_ways,
)
from processing.laboratory.simulate.scanning.returns import OPTICS
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers

MIRRORS = (Material.GLASS, Material.MIRROR, Material.WATER)
"""Materials in which other things are seen."""

_LEVEL = 0.7  # of a normal's z: water and wet ground rather than windows
_SAME_M = 1e-3
_OFF_M = 0.01  # before the next thing is asked for, so that it isn't the pane itself
_SALT = 401


@dataclass(frozen=True)
class MirroredEchoes:
    """Echoes of what mirrors show.

    Attributes
    ----------
    rays : (n,) int64
        Their beams, rising.
    ranges : (n,) float64
        Of the whole way as it was measured, m.
    strengths : (n,) float64
        As `Returns` has them.
    is_level : (n,) bool
        Whether their mirror lies: water rather than a window.
    """

    rays: Integers
    ranges: Floats
    strengths: Floats
    is_level: NDArray[np.bool_]


def mirrored_echoes(
    beams: Beams,
    reaches: Floats,
    scene: RaycastScene,
    scanner: Floats,
    rays: Integers,
    *,
    key: int,
) -> MirroredEchoes:
    """What comes back of beams by way of the mirrors they met.

    Parameters
    ----------
    reaches : (beams,) float64
        How far off each beam met something, m.
    scanner : (13,) float64
        `scanner_numbers`, with the share of light that the mirror lets by there and back.
    rays : (n,) int64
        Beams that met mirrors, rising.
    key : int
        Of the recording's chance.

    Notes
    -----
    1. The mirror's normal is tilted as its surface lies off its triangle: panes bend by roller
       waves of up to 0.3 mm over 0.3 m (EN 12150-1), a convex mirror likewise.
    2. The way on is cast. What it meets returns as if it were measured from behind the mirror, over
       the whole way, by its own surface and angle, and the light passes the mirror twice.
    """
    hits = scene.cast(beams.origins[rays], beams.directions[rays])
    is_same = (np.abs(hits.ranges - reaches[rays]) < _SAME_M) & (hits.triangles >= 0)
    rays, found = rays[is_same], hits.triangles[is_same]
    positions = beams.origins[rays] + beams.directions[rays] * reaches[rays, None]
    corners = scene.mesh.vertices[scene.mesh.triangles[found]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    ways = np.empty((rays.size, 3))
    shines = normals, scene.mesh.material[found]
    mirrored_ways((positions, beams.directions[rays]), shines, OPTICS, ways)
    beyond = scene.cast(positions + _OFF_M * ways, ways)
    count = reaches.size
    whole, cosines = np.full(count, np.inf), np.ones(count)
    whole[rays], cosines[rays] = reaches[rays] + _OFF_M + beyond.ranges, beyond.cosines
    materials = np.zeros(count, np.uint8)
    materials[rays] = np.where(
        beyond.triangles >= 0, scene.mesh.material[np.maximum(beyond.triangles, 0)], 0
    )
    starts, directions = np.zeros((count, 3)), np.zeros((count, 3))
    starts[rays], directions[rays] = positions - ways * reaches[rays, None], ways
    ranges, _, strengths = out = (np.empty(count), np.empty(count), np.empty(count))
    seen = whole, cosines, materials
    first_returns((beams.first, starts, directions), seen, OPTICS, scanner, key + _SALT, out)
    is_back = ~np.isnan(ranges[rays])
    rays, normals = rays[is_back], normals[is_back]
    return MirroredEchoes(rays, ranges[rays], strengths[rays], np.abs(normals[:, 2]) > _LEVEL)
