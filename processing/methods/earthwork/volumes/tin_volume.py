"""Volume between two triangulated surfaces, exact: the prismoidal method of both networks.

Wherever a triangle of one surface lies over one of the other, the difference of both is linear on
the polygon that they share. It is cut into triangles, and these where the difference changes its
sign; what is left are prisms under a plane, whose volumes are known without sampling anything.

References
----------
MLIT, quantities of earthwork from 3D surveying data: プリズモイダル法.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.core.worked_ahead import in_order
from processing.methods.earthwork.geometry.overlay_kernels import level_kernel, overlay_kernel
from processing.methods.earthwork.geometry.plan_buckets import PlanBuckets, sort_into_buckets
from processing.methods.earthwork.geometry.plan_clip import clip_triangles
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface, twice_areas

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

_PAIRS_IN_BLOCK = 200_000
_TRIANGLES_IN_BLOCK = 100_000
"""Worked on between two questions whether to go on, and shared among cores; they change the
time only."""

_ROUNDING = 1e-9
"""Share of an area that is left over by rounding and no area."""


@dataclass(frozen=True)
class TinVolume:
    """Earth between two triangulated surfaces within a boundary.

    Attributes
    ----------
    cut_m3, fill_m3 : float
        Where the later surface is lower, and where it is higher; neither is negative.
    area_m2 : float
        Seen from above, where both surfaces are.
    before_only_m2, after_only_m2 : float
        Where only one of them is.
    neither_m2 : float
        Where the boundary encloses neither; 0 without a boundary.
    """

    cut_m3: float
    fill_m3: float
    area_m2: float
    before_only_m2: float = 0.0
    after_only_m2: float = 0.0
    neither_m2: float = 0.0

    @property
    def net_m3(self) -> float:
        """Fill less cut."""
        return self.fill_m3 - self.cut_m3

    @property
    def missing_m2(self) -> float:
        """Area of the comparison that lacks a surface or both."""
        return self.before_only_m2 + self.after_only_m2 + self.neither_m2

    def reversed(self) -> TinVolume:
        """The same with the later surface taken for the earlier one."""
        return replace(
            self,
            cut_m3=self.fill_m3,
            fill_m3=self.cut_m3,
            before_only_m2=self.after_only_m2,
            after_only_m2=self.before_only_m2,
        )


def volume_between(
    before: TriangleSurface,
    after: TriangleSurface,
    monitor: Monitor,
    boundary: shapely.Geometry | None = None,
) -> TinVolume:
    """Cut and fill from one surface to a later one.

    Parameters
    ----------
    before, after : TriangleSurface
        Checked (:func:`processing.methods.earthwork.geometry.surface_check.check_surface`); where
        triangles of one lie over each other the ground counts twice.
    boundary : shapely.Polygon or shapely.MultiPolygon or None
        m, project CRS.

    Raises
    ------
    Unsuitable
        The surfaces have no ground in common there.
    """
    origin = np.minimum(before.origin, after.origin)
    area = None if boundary is None else _moved(boundary, origin)
    one = _within(before, area, origin, monitor)
    monitor.check()
    other = _within(after, area, origin, monitor)
    monitor.check()
    if not len(one) or not len(other):
        raise _apart()
    buckets = sort_into_buckets(other)
    monitor.check()
    frame = (buckets.west, buckets.south, buckets.size_m, buckets.rows, buckets.columns)
    ends = _block_ends(one, buckets)

    def overlay(block: tuple[int, int]) -> Floats:
        sums = np.zeros(3)
        held = (buckets.starts, buckets.triangles)
        overlay_kernel(one[block[0] : block[1]], other, frame, held, sums)
        return sums

    cut, fill, both = _summed(overlay, ends, monitor)
    if both <= 0.0:
        raise _apart()
    of_one, of_other = (float(twice_areas(triangles).sum()) / 2 for triangles in (one, other))
    whole = of_one + of_other - both if area is None else float(area.area)
    return TinVolume(
        cut,
        fill,
        both,
        before_only_m2=_left(of_one, both),
        after_only_m2=_left(of_other, both),
        neither_m2=_left(whole, of_one + of_other - both),
    )


def volume_to_level(
    before: TriangleSurface,
    level_m: float,
    monitor: Monitor,
    boundary: shapely.Geometry | None = None,
) -> TinVolume:
    """Cut and fill from a surface to a level; :meth:`TinVolume.reversed` from a level to it.

    Parameters
    ----------
    level_m : float
        Height, m.
    boundary : shapely.Polygon or shapely.MultiPolygon or None
        m, project CRS.

    Raises
    ------
    Unsuitable
        The surface is not within the boundary.
    """
    area = None if boundary is None else _moved(boundary, before.origin)
    triangles = _within(before, area, before.origin, monitor)
    if not len(triangles):
        raise _apart()
    ends = [*range(0, len(triangles), _TRIANGLES_IN_BLOCK), len(triangles)]

    def under(block: tuple[int, int]) -> Floats:
        sums = np.zeros(3)
        level_kernel(triangles[block[0] : block[1]], level_m - float(before.origin[2]), sums)
        return sums

    cut, fill, covered = _summed(under, ends, monitor)
    whole = covered if area is None else float(area.area)
    return TinVolume(cut, fill, covered, neither_m2=_left(whole, covered))


def _moved(boundary: shapely.Geometry, origin: Floats) -> shapely.Geometry:
    return shapely.transform(boundary, lambda positions: positions - origin[:2])


def _within(
    surface: TriangleSurface, boundary: shapely.Geometry | None, origin: Floats, monitor: Monitor
) -> Floats:
    triangles = surface.plan_triangles(origin)
    monitor.check()
    return triangles if boundary is None else clip_triangles(triangles, boundary, monitor)


def _left(whole: float, part: float) -> float:
    """What a part leaves of an area; 0 where it is all but for rounding."""
    return whole - part if whole - part > _ROUNDING * whole else 0.0


def _apart() -> Unsuitable:
    return Unsuitable(
        Text("The surfaces have no ground in common.", "2つの面に共通する範囲がありません。"),
        Text("Before and after, within the boundary", "境界内の前後の面"),
        Text(
            "Choose surfaces of the same site and a boundary on both.",
            "同じ現場の面と、両方の面に重なる境界を指定してください。",
        ),
    )


def _summed(
    work: Callable[[tuple[int, int]], Floats], ends: list[int], monitor: Monitor
) -> tuple[float, float, float]:
    """Sums over blocks; they don't depend on which thread had which block."""
    parts = []
    for sums in in_order(work, pairwise(ends)):
        monitor.check()
        parts.append(sums.tolist())
        monitor.report(len(parts) / (len(ends) - 1))
    cut, fill, area = (math.fsum(column) for column in zip(*parts, strict=True))
    return cut, fill, area


def _block_ends(triangles: Floats, buckets: PlanBuckets) -> list[int]:
    """Where blocks of triangles end that meet about the same number of others."""
    counts = np.diff(buckets.starts).reshape(buckets.rows, buckets.columns)
    sums = np.zeros((buckets.rows + 1, buckets.columns + 1), np.int64)
    np.cumsum(np.cumsum(counts, axis=0), axis=1, out=sums[1:, 1:])
    plan = (triangles[:, :, :2] - [buckets.west, buckets.south]) / buckets.size_m
    most = [buckets.columns, buckets.rows]
    first = np.clip(np.floor(plan.min(axis=1)), 0, most).astype(np.int64)
    last = np.clip(np.floor(plan.max(axis=1)) + 1, 0, most).astype(np.int64)
    (west, south), (east, north) = first.T, last.T
    met = sums[north, east] - sums[south, east] - sums[north, west] + sums[south, west]
    block = np.cumsum(met + 1) // _PAIRS_IN_BLOCK
    return [0, *(np.flatnonzero(np.diff(block)) + 1).tolist(), len(triangles)]


def warm_up() -> None:
    """Compile the kernels."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    surface = TriangleSurface(corners, np.array([[0, 1, 2]]))
    volume_between(surface, surface, SilentMonitor())
    volume_to_level(surface, 1.0, SilentMonitor())
