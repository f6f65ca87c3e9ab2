"""What panes, mirrors and water show: echoes of things by way of them, where they seem to be.

An image is no copy of its thing: its range is longer, its light weaker, so that it is measured less
exactly, and no pane is quite flat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import CastHits, RaycastScene
from processing.laboratory.simulate.scanning.return_kernels import (
    first_returns,
    mirrored_ways,
)
from processing.laboratory.simulate.scanning.returns import OPTICS, BeamHits, shares_of
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh

MIRRORS = (Material.GLASS, Material.MIRROR, Material.WATER)
"""Materials in which other things are seen."""

_WALLS = (
    Material.PLASTER,
    Material.BRICK,
    Material.CONCRETE,
    Material.OLD_CONCRETE,
    Material.WOOD,
    Material.PAINTED_METAL,
)
_OF_WALLS, _UPRIGHT = (1, 6), 0.1
_BLIND_SHARE = 0.6  # at most, of what lies behind a pane or on it: blinds, goods, dirt
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
    met: BeamHits,
    scene: RaycastScene,
    scanner: Floats,
    rays: Integers,
    *,
    key: int,
) -> MirroredEchoes:
    """What comes back of beams by way of the mirrors they met.

    Parameters
    ----------
    met : BeamHits
        Of each beam.
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
    reaches, hits = met.ranges, scene.cast(beams.origins[rays], beams.directions[rays])
    is_same = (np.abs(hits.ranges - reaches[rays]) < _SAME_M) & (hits.triangles >= 0)
    rays, found = rays[is_same], hits.triangles[is_same]
    positions = beams.origins[rays] + beams.directions[rays] * reaches[rays, None]
    normals = _normals(scene.mesh, found)
    ways = np.empty((rays.size, 3))
    shines = normals, met.material[rays]
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


def panes_in_walls(
    beams: Beams, hits: CastHits, mesh: Mesh, drawn: tuple[float, float, float], seed: int
) -> NDArray[np.bool_]:
    """Which beams meet a pane where the scene has a wall: the same places for all beams.

    Parameters
    ----------
    drawn : (float, float, float)
        Share of walls that are panes; their widths and heights, m.

    Notes
    -----
    Walls are upright and of anything that windows are set into. Of the beams at a pane some meet
    what hangs behind it or sticks to it, as many as is drawn for the pane: those are left out.
    """
    share, wide_m, high_m = drawn
    is_pane = np.zeros(hits.ranges.size, np.bool_)
    triangles = np.maximum(hits.triangles, 0)
    is_wall = np.isin(mesh.material[triangles], _WALLS) & np.isin(mesh.label[triangles], _OF_WALLS)
    rays = np.flatnonzero(is_wall & (hits.triangles >= 0))
    normals = _normals(mesh, hits.triangles[rays])
    is_upright = np.abs(normals[:, 2]) < _UPRIGHT
    rays, normals = rays[is_upright], normals[is_upright]
    there = beams.origins[rays] + beams.directions[rays] * hits.ranges[rays, None]
    along = there[:, 1] * normals[:, 0] - there[:, 0] * normals[:, 1]
    cells = np.floor(np.column_stack([along / wide_m, there[:, 2] / high_m])).astype(np.int64)
    number = cells[:, 0] * 73_856_093 + cells[:, 1] * 19_349_663
    blind = _BLIND_SHARE * shares_of(number, seed + _SALT + 1)
    is_clear = shares_of(beams.first + rays, seed + _SALT + 2) > blind
    is_pane[rays[is_clear & (shares_of(number, seed + _SALT) < share)]] = True
    return is_pane


def _normals(mesh: Mesh, triangles: Integers) -> Floats:
    corners = mesh.vertices[mesh.triangles[triangles]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    return np.asarray(normals / lengths[:, None])
