"""Two published ways to ground that the machine-removal study names: dense triangles and a roller.

They are here to be compared with, written from their papers; no tool offers them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.methods.ground.filters.triangles import Triangles, triangulate_points

_MOST_ROUNDS = 15
_FEWEST_NEW = 1e-3
"""Share of the points below which a round of new corners is the last."""

_PLUMB = 1e-9


def ground_by_dense_triangles(
    local_xyz: Floats, cell_m: float, angle_deg: float, distance_m: float, band_m: float
) -> Flags:
    """Progressive densification of a TIN: points join it that lie near its triangles.

    Parameters
    ----------
    cell_m : float
        Side of the cells whose lowest points are the first corners: the widest building.
    angle_deg, distance_m : float
        A point joins its triangle where it is no farther from its plane, and where no line to a
        corner is steeper against the plane.
    band_m : float
        At the end points so near the triangles, vertically, are ground.

    Notes
    -----
    Each triangle takes its lowest fitting point a round. Where a point doesn't fit, its mirror
    image about the nearest corner is tried, which climbs steps.

    References
    ----------
    Axelsson 2000, ISPRS Archives 33 (B4/1), p. 110-117.
    """
    corners = _lowest(local_xyz, np.arange(len(local_xyz)), cell_m)
    corners = np.concatenate([corners, _corners_of_hull(local_xyz, corners)])
    thin = _lowest(local_xyz, np.arange(len(local_xyz)), min(0.2, cell_m / 10))
    waiting = np.setdiff1d(thin, corners)
    triangles = triangulate_points(local_xyz[corners])
    for _ in range(_MOST_ROUNDS):
        fitting, owner = _fitting(triangles, local_xyz[waiting], angle_deg, distance_m)
        if fitting.sum() < max(1.0, _FEWEST_NEW * len(thin)):
            break
        found, of = waiting[fitting], owner[fitting]
        order = np.lexsort((local_xyz[found, 2], of))
        first = np.concatenate(([True], np.diff(of[order]) != 0))
        new = found[order][first]
        corners = np.concatenate([corners, new])
        waiting = np.setdiff1d(waiting, new)
        triangles = triangulate_points(local_xyz[corners])
    is_ground: Flags = np.abs(local_xyz[:, 2] - triangles.heights_at(local_xyz[:, :2])) <= band_m
    return is_ground


def ground_by_roller(local_xyz: Floats, radius_m: float, cell_m: float, band_m: float) -> Flags:
    """A cylinder rolled beneath the cloud along both axes of the grid; what it touches is ground.

    Parameters
    ----------
    radius_m : float
        Of the cylinder.
    cell_m : float
        Side of the cells whose lowest heights it rolls under; empty ones take the nearest height.
    band_m : float
        Points so near the surface that it touches are ground.

    Notes
    -----
    Where a cylinder can touch from below is an opening of the lowest heights by a circle's arc.
    It rolls along the rows and along the columns, and the higher of the two surfaces is taken: a
    ridge lets it pass one way.
    """
    from scipy.ndimage import distance_transform_edt

    cell = np.floor(local_xyz[:, :2] / cell_m).astype(np.int64)
    lowest = np.full(tuple(cell.max(axis=0) + 1), np.inf)
    np.minimum.at(lowest, (cell[:, 0], cell[:, 1]), local_xyz[:, 2])
    nearest = distance_transform_edt(
        ~np.isfinite(lowest), return_distances=False, return_indices=True
    )
    heights = lowest[tuple(nearest)]
    surface = np.maximum(
        _rolled_under(heights, radius_m, cell_m), _rolled_under(heights.T, radius_m, cell_m).T
    )
    is_ground: Flags = np.abs(local_xyz[:, 2] - surface[cell[:, 0], cell[:, 1]]) <= band_m
    return is_ground


def _rolled_under(heights: Floats, radius_m: float, cell_m: float) -> Floats:
    """Opening of every column by the arc of a circle below the surface."""
    reach = int(radius_m / cell_m)
    offsets = np.arange(-reach, reach + 1)
    arc = np.sqrt(np.maximum(radius_m**2 - (offsets * cell_m) ** 2, 0.0)) - radius_m
    count = len(heights)
    wide = np.pad(heights, ((reach, reach), (0, 0)), mode="edge")
    centre = np.full_like(heights, np.inf)
    for start, bend in enumerate(arc):
        np.minimum(centre, wide[start : start + count] - bend, out=centre)
    wide = np.pad(centre, ((reach, reach), (0, 0)), mode="edge")
    touched = np.full_like(heights, -np.inf)
    for start, bend in enumerate(arc):
        np.maximum(touched, wide[start : start + count] + bend, out=touched)
    return touched


def _lowest(xyz: Floats, numbers: NDArray[np.int64], cell_m: float) -> NDArray[np.int64]:
    """Of the points ``numbers`` the lowest of each cell."""
    cells = np.floor(xyz[numbers, :2] / cell_m).astype(np.int64)
    order = np.lexsort((xyz[numbers, 2], cells[:, 1], cells[:, 0]))
    is_first = np.concatenate(([True], np.any(np.diff(cells[order], axis=0) != 0, axis=1)))
    chosen: NDArray[np.int64] = numbers[order[is_first]]
    return chosen


def _corners_of_hull(xyz: Floats, seeds: NDArray[np.int64]) -> NDArray[np.int64]:
    """The points farthest out in eight directions, so that few lie outside all triangles."""
    turns = np.arange(8) * np.pi / 4
    far = np.argmax(xyz[:, :2] @ np.stack([np.cos(turns), np.sin(turns)]), axis=0)
    near_ground = xyz[far, 2] <= xyz[seeds, 2].max()
    return np.setdiff1d(far[near_ground], seeds)


def _fitting(
    triangles: Triangles, xyz: Floats, angle_deg: float, distance_m: float
) -> tuple[Flags, NDArray[np.int64]]:
    """Which points fit their triangle or, as a mirror image about its nearest corner, another."""
    owner = triangles.triangle_of(xyz[:, :2])
    fits = _fits_plane(triangles, xyz, owner, angle_deg, distance_m)
    others = np.flatnonzero((owner >= 0) & ~fits)
    if len(others):
        ends = triangles.xyz[triangles.corners[owner[others]]] + triangles.origin
        off = np.linalg.norm(ends[:, :, :2] - xyz[others, None, :2], axis=2)
        nearest = ends[np.arange(len(others)), np.argmin(off, axis=1)]
        image = np.column_stack([2 * nearest[:, :2] - xyz[others, :2], xyz[others, 2]])
        image[:, 2] = 2 * nearest[:, 2] - xyz[others, 2]
        of_image = triangles.triangle_of(image[:, :2])
        fits[others] = _fits_plane(triangles, image, of_image, angle_deg, distance_m)
    return fits, owner


def _fits_plane(
    triangles: Triangles,
    xyz: Floats,
    owner: NDArray[np.int64],
    angle_deg: float,
    distance_m: float,
) -> Flags:
    inside = np.flatnonzero(owner >= 0)
    ends = triangles.xyz[triangles.corners[owner[inside]]]
    local = xyz[inside] - triangles.origin
    normal = np.cross(ends[:, 1] - ends[:, 0], ends[:, 2] - ends[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), _PLUMB)
    off = np.abs(np.einsum("ij,ij->i", local - ends[:, 0], normal))
    to_ends = np.linalg.norm(ends - local[:, None], axis=2).min(axis=1)
    steepest = np.degrees(np.arcsin(np.clip(off / np.maximum(to_ends, _PLUMB), 0.0, 1.0)))
    fits = np.zeros(len(xyz), np.bool_)
    fits[inside] = (off <= distance_m) & (steepest <= angle_deg)
    return fits
