"""The published ground method, step by step, with every number open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.ground.lowest_points import lowest_points, require_points
from processing.ground.triangles import Triangles, triangulated
from processing.monitor import Monitor
from processing.text import Text

_BLOCK = 1_000_000


@dataclass(frozen=True)
class PublishedSteps:
    """The paper's numbers.

    Attributes
    ----------
    grid_m : float
        Side of the cells whose lowest points make the first triangles: about 1.5 times the width
        of what is to be removed.
    steep_deg : float
        A triangle this steep or steeper loses its highest corner.
    slope_from_deg : float
        Triangles from here up to ``steep_deg`` are slopes and are divided.
    fine_grid_m : float
        Side of the columns that divide slopes; 0 takes a fifth of ``grid_m``, which the paper
        does not say.
    distance_m : float
        A point no farther from the triangles, vertically, is ground.
    most_removals : int
        How often steep triangles are sought: 1 as published, more until none is left.
    """

    grid_m: float = 3.0
    steep_deg: float = 80.0
    slope_from_deg: float = 4.0
    fine_grid_m: float = 0.0
    distance_m: float = 0.3
    most_removals: int = 1


@dataclass(frozen=True)
class PublishedGround:
    """What the method found.

    Attributes
    ----------
    is_ground : (n,) bool
    triangles : Triangles
    outside_hull : int
        Points beyond the triangles, judged by the nearest corner.
    removals : int
        How often corners were removed.
    """

    is_ground: NDArray[np.bool_]
    triangles: Triangles
    outside_hull: int
    removals: int


def published_ground(
    xyz: NDArray[np.float64], steps: PublishedSteps, monitor: Monitor
) -> PublishedGround:
    """Ground by lowest points, triangles, slopes divided and a vertical band.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; rows that are not finite are not ground.

    Raises
    ------
    OutOfRange
        Fewer than three finite points.

    References
    ----------
    Specification noise_ground.md, B3.1 to B3.3.
    """
    require_points(xyz, 3)
    monitor.report(0.0, Text("Looking for the ground", "地面を探しています"))
    corners = lowest_points(xyz, steps.grid_m)
    kept, removals = _without_steep(xyz[corners], steps, monitor)
    monitor.report(0.3)
    first = triangulated(kept)
    fine = _lowest_on_slopes(xyz, first, steps, monitor)
    monitor.report(0.6)
    triangles = triangulated(np.concatenate((kept, xyz[fine])))
    is_ground = np.zeros(len(xyz), np.bool_)
    outside = 0
    for start in range(0, len(xyz), _BLOCK):
        monitor.check()
        block = xyz[start : start + _BLOCK]
        finite = np.flatnonzero(np.isfinite(block).all(axis=1))
        off = np.abs(block[finite, 2] - triangles.heights_at(block[finite, :2]))
        is_ground[start + finite] = off <= steps.distance_m
        outside += int((triangles.triangle_of(block[finite, :2]) < 0).sum())
        monitor.report(0.6 + 0.4 * (start + len(block)) / len(xyz))
    return PublishedGround(is_ground, triangles, outside, removals)


def _without_steep(
    xyz: NDArray[np.float64], steps: PublishedSteps, monitor: Monitor
) -> tuple[NDArray[np.float64], int]:
    """Take the highest corner from steep triangles, from all of them at once."""
    for removals in range(steps.most_removals):
        monitor.check()
        triangles = triangulated(xyz)
        steep = triangles.corners[triangles.slopes_deg() >= steps.steep_deg]
        corners = triangles.xyz + triangles.origin
        if len(steep) == 0:
            return corners, removals
        highest = steep[np.arange(len(steep)), np.argmax(triangles.xyz[steep, 2], axis=1)]
        is_kept = np.ones(len(corners), np.bool_)
        is_kept[highest] = False
        if is_kept.sum() < 3:
            return corners, removals
        xyz = corners[is_kept]
    return xyz, steps.most_removals


def _lowest_on_slopes(
    xyz: NDArray[np.float64], triangles: Triangles, steps: PublishedSteps, monitor: Monitor
) -> NDArray[np.int64]:
    """Lowest point of each fine column of each sloping triangle, as indices into ``xyz``."""
    slopes = triangles.slopes_deg()
    is_slope = (slopes >= steps.slope_from_deg) & (slopes < steps.steep_deg)
    fine_m = steps.fine_grid_m if steps.fine_grid_m > 0.0 else steps.grid_m / 5.0
    finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
    monitor.check()
    triangle = triangles.triangle_of(xyz[finite, :2])
    on_slope = triangle >= 0
    on_slope[on_slope] = is_slope[triangle[on_slope]]
    chosen, owner = finite[on_slope], triangle[on_slope]
    if len(chosen) == 0:
        return chosen
    columns = np.floor((xyz[chosen, :2] - triangles.origin[:2]) / fine_m).astype(np.int64)
    order = np.lexsort((xyz[chosen, 2], columns[:, 0], columns[:, 1], owner))
    keys = np.column_stack((owner, columns))[order]
    is_first = np.concatenate(([True], np.any(np.diff(keys, axis=0) != 0, axis=1)))
    return chosen[order[is_first]]
