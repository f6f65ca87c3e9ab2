"""The published ground method, step by step, with every number open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.ground.filters.cell_positions import Blocks, require_three_positions
from processing.methods.ground.filters.lowest_points import LowestPoints, lowest_ground
from processing.methods.ground.filters.triangles import Triangles, triangulate_points

MOST_CORNERS = 1_000_000
"""What is joined in memory: triangulating so many corners once takes some 10 s."""

_FEWEST_CORNERS = 3
"""Of one triangle: removing goes no further."""

_FINE_PARTS = 5.0
"""Columns on slopes along the grid's side, whose number the paper leaves open; by judgement."""


@dataclass(frozen=True)
class PublishedSteps:
    """The paper's numbers (Sakurai et al., sections 3(2) and 4(2)); defaults are its own.

    Attributes
    ----------
    grid_m : float
        Side of the cells whose lowest points make the first triangles: about 1.5 times the width
        of what is to be removed, 3 m for a machine of 2 m (section 3(2)a), which is also the best
        of 1, 3 and 10 m in its table 2.
    steep_deg : float
        A triangle this steep or steeper loses its highest corner (section 3(2)a).
    slope_from_deg : float
        Triangles from here up to ``steep_deg`` are slopes and are divided (section 4(2)a).
    fine_grid_m : float
        Side of the columns that divide slopes; 0 takes a fifth of ``grid_m``, which the paper
        does not say.
    distance_m : float
        A point no farther from the triangles, vertically, is ground (section 4(2)a).
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
class PublishedSurface:
    """The triangles that the method ends with.

    Attributes
    ----------
    triangles : Triangles
    distance_m : float
        A point no farther from them, vertically, is ground.
    removals : int
        How often corners were removed.
    """

    triangles: Triangles
    distance_m: float
    removals: int

    def judged(
        self, xyz: NDArray[np.float64]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64], int]:
        """Which points of a block are ground, and how high they are above the triangles.

        Returns
        -------
        is_ground : (n,) bool
        above : (n,) float64
            m; NaN for points without coordinates.
        outside_hull : int
            Points beyond the triangles, judged by the nearest corner.
        """
        finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
        heights, is_outside = self.triangles.located(xyz[finite, :2])
        above = np.full(len(xyz), np.nan)
        above[finite] = xyz[finite, 2] - heights
        with np.errstate(invalid="ignore"):
            is_ground = np.abs(above) <= self.distance_m
        return is_ground, above, int(is_outside.sum())


def published_surface(blocks: Blocks, steps: PublishedSteps, monitor: Monitor) -> PublishedSurface:
    """The triangles of a cloud that comes in blocks; how it is cut changes nothing.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m, afresh at every call, in the same order.

    Raises
    ------
    OutOfRange
        Finite points at fewer than three positions; more corners than can be joined in memory.

    References
    ----------
    Sakurai et al., 地上設置型レーザスキャナを用いた出来高管理のための地表面抽出手法の検討,
    section 3(2).
    """
    require_three_positions(blocks)
    monitor.report(0.0, Text("Looking for the ground", "地面を探しています"))
    corners = lowest_ground(blocks, steps.grid_m).lowest.xyz
    _refuse_too_many(len(corners))
    triangles, removals = _without_steep(corners, steps, monitor)
    monitor.report(0.5)
    fine = _lowest_on_slopes(blocks, triangles, steps, monitor)
    if len(fine):
        triangles = triangulate_points(np.concatenate((triangles.xyz + triangles.origin, fine)))
    monitor.report(1.0)
    return PublishedSurface(triangles, steps.distance_m, removals)


def _refuse_too_many(corners: int) -> None:
    if corners > MOST_CORNERS:
        raise OutOfRange(
            Text(
                f"The triangles would have more than {MOST_CORNERS:,} corners.",
                f"三角網の頂点が{MOST_CORNERS:,}点を超えます。",
            ),
            Text("Published method", "論文の方法"),
            Text(
                "Take a larger grid, a smaller part, or the adaptive method, which has no limit.",
                "格子を大きくするか、範囲を小さくするか、上限のない「自動調整」を使ってください。",
            ),
        )


def _without_steep(
    xyz: NDArray[np.float64], steps: PublishedSteps, monitor: Monitor
) -> tuple[Triangles, int]:
    """Take the highest corner from steep triangles, from all of them at once."""
    triangles = triangulate_points(xyz)
    for removals in range(steps.most_removals):
        monitor.check()
        steep = triangles.corners[triangles.slopes_deg() >= steps.steep_deg]
        highest = steep[np.arange(len(steep)), np.argmax(triangles.xyz[steep, 2], axis=1)]
        is_kept = np.ones(len(triangles.xyz), np.bool_)
        is_kept[highest] = False
        if len(steep) == 0 or is_kept.sum() < _FEWEST_CORNERS:
            return triangles, removals
        triangles = triangulate_points((triangles.xyz + triangles.origin)[is_kept])
    return triangles, steps.most_removals


def _lowest_on_slopes(
    blocks: Blocks, triangles: Triangles, steps: PublishedSteps, monitor: Monitor
) -> NDArray[np.float64]:
    """Lowest point of each fine column of each sloping triangle, (m, 3) float64."""
    slopes = triangles.slopes_deg()
    is_slope = (slopes >= steps.slope_from_deg) & (slopes < steps.steep_deg)
    fine_m = steps.fine_grid_m if steps.fine_grid_m > 0.0 else steps.grid_m / _FINE_PARTS
    lowest = LowestPoints(3)
    for xyz in blocks():
        monitor.check()
        kept = xyz[np.isfinite(xyz).all(axis=1)]
        triangle = triangles.triangle_of(kept[:, :2])
        on_slope = triangle >= 0
        on_slope[on_slope] = is_slope[triangle[on_slope]]
        chosen = kept[on_slope]
        columns = np.floor((chosen[:, :2] - triangles.origin[:2]) / fine_m).astype(np.int64)
        keys = np.column_stack((columns, triangle[on_slope]))
        lowest.add(keys, chosen, np.zeros(len(chosen), np.int64))
        _refuse_too_many(lowest.count_so_far)
    _refuse_too_many(len(lowest.numbers))
    return lowest.xyz
