"""Check points: how near a map comes to places that were surveyed independently of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from processing.map.feature import Feature, Position, Status, Vertex


@dataclass(frozen=True)
class LevelLimits:
    """Largest standard deviations of a map level, m: in plan, and of spot heights."""

    plan_m: float
    height_m: float


LEVEL_LIMITS: Mapping[int, LevelLimits] = {
    250: LevelLimits(0.12, 0.25),
    500: LevelLimits(0.25, 0.25),
    1000: LevelLimits(0.70, 0.33),
}
"""By map level (地図情報レベル). Source: 作業規程の準則 第80条."""

_REACH_IN_LIMITS = 4.0
"""A vertex farther from a check point than four standard deviations of its level is another one."""


@dataclass(frozen=True)
class CheckPoint:
    """A surveyed place.

    Attributes
    ----------
    height_m : float
        NaN where it wasn't measured.
    kind : str
        Of the feature that it lies on; empty: any.
    """

    id: str
    easting_m: float
    northing_m: float
    height_m: float = math.nan
    kind: str = ""


@dataclass(frozen=True)
class CheckedPoint:
    """A check point and the vertex of the map that stands for it.

    Attributes
    ----------
    feature : str
        Its id; empty where no vertex is within reach.
    plan_m, height_m : float
        How far the vertex lies from the point; the map's height minus the point's. NaN where
        there is no such thing.
    """

    point: CheckPoint
    feature: str = ""
    plan_m: float = math.nan
    height_m: float = math.nan


@dataclass(frozen=True)
class Deviation:
    """Of several differences: how many there are, root mean square and largest, m."""

    count: int
    rmse_m: float
    most_m: float
    limit_m: float

    @property
    def passes(self) -> bool:
        """Whether there are any, and they keep to the limit."""
        return self.count > 0 and self.rmse_m <= self.limit_m


@dataclass(frozen=True)
class PointCheck:
    """A map against its check points.

    Attributes
    ----------
    level : int
        Map level whose limits count.
    """

    level: int
    points: tuple[CheckedPoint, ...]

    @property
    def plan(self) -> Deviation:
        """In plan."""
        return _deviation([one.plan_m for one in self.points], LEVEL_LIMITS[self.level].plan_m)

    @property
    def height(self) -> Deviation:
        """Of heights."""
        return _deviation([one.height_m for one in self.points], LEVEL_LIMITS[self.level].height_m)

    @property
    def missing(self) -> tuple[CheckedPoint, ...]:
        """Points without a vertex within reach."""
        return tuple(one for one in self.points if not one.feature)


def check_points(
    points: Iterable[CheckPoint], features: Iterable[Feature], level: int
) -> PointCheck:
    """Compare each check point with the vertex nearest to it in plan, of its kind if it says one.

    Only accepted features count. A point with no vertex within four standard deviations of the
    level has none: it is listed as missing, and counts in no mean.

    Parameters
    ----------
    level : int
        One of :data:`LEVEL_LIMITS`.
    """
    by_kind: dict[str, list[tuple[str, Vertex]]] = {}
    for one in features:
        if one.status is Status.ACCEPTED:
            pairs = [(one.id, vertex) for vertex in one.vertices]
            by_kind.setdefault(one.kind, []).extend(pairs)
    by_kind[""] = [pair for pairs in by_kind.values() for pair in pairs]
    trees = {kind: _tree([vertex.xyz for _, vertex in pairs]) for kind, pairs in by_kind.items()}
    reach = LEVEL_LIMITS[level].plan_m * _REACH_IN_LIMITS
    checked = []
    for point in points:
        pairs = by_kind.get(point.kind, [])
        place = shapely.Point(point.easting_m, point.northing_m)
        near = _nearest(trees[point.kind], place, reach) if pairs else None
        if near is None:
            checked.append(CheckedPoint(point))
            continue
        id_, vertex = pairs[near]
        east, north, height = vertex.xyz
        plan = math.hypot(east - point.easting_m, north - point.northing_m)
        rise = math.nan if vertex.is_occluded else height - point.height_m
        checked.append(CheckedPoint(point, id_, plan, rise))
    return PointCheck(level, tuple(checked))


def _nearest(tree: shapely.STRtree, place: shapely.Point, reach_m: float) -> int | None:
    found = tree.query_nearest(place, max_distance=reach_m)
    return int(found[0]) if len(found) else None


def _tree(positions: Sequence[Position]) -> shapely.STRtree:
    return shapely.STRtree([shapely.Point(one[:2]) for one in positions])


def _deviation(differences: Sequence[float], limit_m: float) -> Deviation:
    known = np.array([one for one in differences if not math.isnan(one)], dtype=np.float64)
    if not known.size:
        return Deviation(0, math.nan, math.nan, limit_m)
    rmse = float(np.sqrt(np.mean(known**2)))
    return Deviation(len(known), rmse, float(np.abs(known).max()), limit_m)
