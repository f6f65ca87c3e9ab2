"""The outliers of clouds larger than memory, the same as if the cloud were taken whole.

Radius: a part of space needs what lies within the radius. Statistics: mean and deviation are of
the whole cloud, so distances are measured part by part, kept in a file, and judged in the end; a
point whose k-th neighbour may lie outside its part is measured again with more around it.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.scratch_arrays import scratch_array
from processing.methods.noise.neighbours.radius import NEIGHBOURS, RADIUS_M, radius_outliers
from processing.methods.noise.neighbours.statistical import DEVIATIONS, DistanceSums, distances_of
from processing.methods.noise.tiles_of_space import POINTS_PER_PART, SpacePart, TiledCloud

_POINTS_AT_ONCE = 4_000_000
"""Points whose means are added up at a time: 32 MB."""

_MARGIN = 2.0
"""Of the radius of a circle that holds the neighbours at the usual spacing: what a part sees around
it at first. It changes the time only; points that need more are measured again."""

_WIDENING = 4.0
"""By which a part sees more each time that points are left over."""


class _Search(NamedTuple):
    """How many neighbours are asked for, and how far around a part they are looked for, m."""

    neighbours: int
    reach_m: float


class _Progress(NamedTuple):
    """The mean distance of every point, m, and which points are still to be measured."""

    means: NDArray[np.float64]
    is_open: NDArray[np.bool_]


def radius_outliers_by_parts(
    cloud: TiledCloud,
    found: NDArray[np.uint8],
    radius_m: float = RADIUS_M,
    neighbours: int = NEIGHBOURS,
    *,
    monitor: Monitor,
    points_per_part: int = POINTS_PER_PART,
) -> None:
    """As :func:`processing.methods.noise.neighbours.radius.radius_outliers`, part by part.

    Parameters
    ----------
    found : (n,) uint8
        Zero; gets 1 where a point is an outlier.
    """
    done = 0
    for part in cloud.parts(radius_m, points_per_part):
        monitor.report(done / cloud.count)
        xyz = np.concatenate([cloud.read(part.own), cloud.read(part.around)])
        outliers = radius_outliers(xyz, radius_m, neighbours, monitor=monitor)
        found[part.own] = outliers[: part.own.size]
        done += part.own.size


def statistical_outliers_by_parts(
    cloud: TiledCloud,
    found: NDArray[np.uint8],
    neighbours: int = NEIGHBOURS,
    deviations: float = DEVIATIONS,
    *,
    scratch: Path,
    monitor: Monitor,
    points_per_part: int = POINTS_PER_PART,
) -> None:
    """As `statistical_outliers`, part by part.

    Parameters
    ----------
    found : (n,) uint8
        Zero; gets 1 where a point is an outlier.
    scratch : Path
        A folder for 9 bytes a point meanwhile; the caller deletes it.

    Raises
    ------
    NoSpace
    """
    if not cloud.count:
        return
    means = scratch_array(scratch / "means", np.float64, cloud.count)
    is_open = scratch_array(scratch / "open", np.bool_, cloud.count)
    for start in range(0, cloud.count, _POINTS_AT_ONCE):
        means[start : start + _POINTS_AT_ONCE] = np.nan
        is_open[start : start + _POINTS_AT_ONCE] = True
    reach = _MARGIN * math.sqrt(neighbours / math.pi) * cloud.spacing_m
    left = cloud.count
    state = _Progress(means, is_open)
    while left:
        search = _Search(neighbours, reach)
        for part in cloud.parts(reach, points_per_part, is_open):
            monitor.report(1.0 - left / cloud.count)
            left -= _measure(cloud, part, search, state, monitor)
        reach *= _WIDENING
    total = DistanceSums()
    for start in range(0, cloud.count, _POINTS_AT_ONCE):
        total += DistanceSums.of(np.asarray(means[start : start + _POINTS_AT_ONCE]))
    limit = total.limit(deviations)
    for start in range(0, cloud.count, _POINTS_AT_ONCE):
        found[start : start + _POINTS_AT_ONCE] = ~(means[start : start + _POINTS_AT_ONCE] <= limit)


def _measure(
    cloud: TiledCloud,
    part: SpacePart,
    search: _Search,
    state: _Progress,
    monitor: Monitor,
) -> int:
    """Settle the open points of a part whose neighbours are all known to be near enough."""
    means, is_open = state
    own = cloud.read(part.own)
    wanted = np.flatnonzero(is_open[part.own])
    is_finite = np.isfinite(own[wanted]).all(axis=1)
    is_open[part.own[wanted[~is_finite]]] = False
    settled_before = int((~is_finite).sum())
    wanted = wanted[is_finite]
    if not wanted.size:
        return settled_before
    xyz = np.concatenate([own, cloud.read(part.around)])
    found, farthest = distances_of(xyz, wanted, search.neighbours, monitor=monitor)
    xy = own[wanted, :2]
    to_edge = np.minimum(xy - part.low, part.high - xy).min(axis=1)
    is_settled = farthest <= np.maximum(to_edge, 0.0) + search.reach_m
    if xyz.shape[0] == cloud.count:
        is_settled[:] = True
    settled = part.own[wanted[is_settled]]
    means[settled] = found[is_settled]
    is_open[settled] = False
    return settled_before + int(settled.size)
