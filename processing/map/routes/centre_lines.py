"""Centre lines of roads that have none drawn: midway between the edges on both sides of a way.

The way is where a vehicle went; the edges are the accepted curbs, footways and edges of the road.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.change import Change
from processing.map.drafting.polyline import Polyline
from processing.map.feature import Feature, Provenance, Vertex, new_feature_id
from processing.map.routes.road_widths import (
    CARRIAGEWAY_CODES,
    CURB_KINDS,
    ROAD_EDGE_CODES,
    StationedRoute,
    WidthLines,
    accepted_with_kinds,
)
from processing.map.routes.route import CENTRE_LINE_CODE, Route

_STEP_M = 1.0
_WIDEST_M = 20.0
"""Of one side: what lies farther is an edge of something else."""

_MEDIAN_STEPS, _MEAN_STEPS = 5, 5
"""To either side: what is narrower than 5 m along it doesn't bend it, and it has no corners."""

_LEAVES_M = 0.02
"""A vertex that leaves the straight line between its neighbours by less isn't needed."""

_FEWEST = 3

_SAME_WAY_M, _SAME_SHARE = 25.0, 0.7
"""A second pass so near to the first along so much of its way is on the same road."""

_NEAR_M = 3.0
"""From a place on an edge to the vertex that tells its height."""

_MADE = "made_between"
"""Parameter of what was drawn here, so that it can be drawn anew."""


@dataclass(frozen=True)
class MadeCentreLine:
    """A centre line that nobody drew.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS, in the direction of the way; as high as the edges, 0 on a flat map.
    unknown_m : float
        Of its length that without an edge on one side, along which it goes on as before.
    """

    xyz: Floats
    unknown_m: float


def centre_lines(
    features: Sequence[Feature], catalogue: Catalogue, ways: Sequence[Floats]
) -> Change:
    """Draw the centre lines of the ways that were driven; those drawn so before are replaced.

    Parameters
    ----------
    features : sequence of Feature
        The whole map; accepted ones count.
    ways : sequence of (n, 2) float64
        m, project CRS.

    Returns
    -------
    Change
        Empty where no way has edges on both sides, or the catalogue has no centre line.
    """
    kinds = [kind for kind in catalogue if kind.dm_code == CENTRE_LINE_CODE]
    if not kinds:
        return Change()
    made = Provenance(parameters={_MADE: "edges"})
    drawn = [
        Feature(
            new_feature_id(),
            kinds[0].id,
            Geometry.LINE,
            tuple(Vertex((x, y, z)) for x, y, z in line.xyz.tolist()),
            {},
            provenance=made,
        )
        for line in made_centre_lines(accepted_with_kinds(features, catalogue), ways)
    ]
    before = tuple(one for one in features if _MADE in one.provenance.parameters)
    return Change(added=tuple(drawn), removed=before if drawn else ())


def made_centre_lines(
    accepted: Sequence[tuple[FeatureKind, Feature]], ways: Iterable[Floats]
) -> Iterator[MadeCentreLine]:
    """Lines between the edges of each way; later passes on the same road are left out."""
    from scipy.spatial import cKDTree

    across, heights = WidthLines(accepted), _EdgeHeights(accepted)
    before: list[Floats] = []
    for way in ways:
        if before:
            away, _ = cKDTree(np.concatenate(before)).query(way)
            if np.mean(away <= _SAME_WAY_M) >= _SAME_SHARE:
                continue
        before.append(way)
        made = _between(across, heights, way)
        if made is not None:
            yield made


def _between(across: WidthLines, heights: _EdgeHeights, way: Floats) -> MadeCentreLine | None:
    """From the first to the last place with edges on both sides; None where there is none.

    The way isn't parallel to the road: what is found square to it is found anew square to the
    line that comes of it.
    """
    first = _middles(across, way)
    second = None if first is None else _middles(across, _mean_places(first.places()))
    if second is None:
        return None
    rows = np.column_stack([second.places(), _filled(second.heights(heights))])
    simple = shapely.simplify(shapely.LineString(rows), _LEAVES_M)
    unknown = 1.0 - float(np.isfinite(second.sides[:, 0]).mean())
    return MadeCentreLine(
        shapely.get_coordinates(simple, include_z=True), unknown * float(simple.length)
    )


@dataclass(frozen=True)
class _Middles:
    """Places of a way with the edges on both sides of it.

    Attributes
    ----------
    feet, left : (n, 2) float64
        On the way, and a metre square to it from there.
    sides : (n, 2) float64
        How far the edges lie to the left and to the right; both NaN where either is missing.
    """

    feet: Floats
    left: Floats
    sides: Floats

    def places(self) -> Floats:
        offsets = _settled((self.sides[:, 0] - self.sides[:, 1]) / 2)
        places: Floats = self.feet + self.left * offsets[:, None]
        return places

    def heights(self, edges: _EdgeHeights) -> Floats:
        both = zip(self.feet, self.left, self.sides, strict=True)
        return np.array(
            [edges.middle([foot + way * at[0], foot - way * at[1]]) for foot, way, at in both]
        )


def _middles(across: WidthLines, way: Floats) -> _Middles | None:
    if len(way) < _FEWEST:
        return None
    line = Polyline.of([(x, y, 0.0) for x, y in way.tolist()])
    route = StationedRoute.of(Route("", 0.0, line), _STEP_M)
    if not route.stations:
        return None
    sides = np.array([across.widths(route, at).carriageway for at in route.stations])
    with np.errstate(invalid="ignore"):
        sides[~(sides.max(axis=1) <= _WIDEST_M)] = np.nan
    known = np.flatnonzero(np.isfinite(sides[:, 0]))
    if known.size < _FEWEST:
        return None
    part = slice(int(known[0]), int(known[-1]) + 1)
    rays = np.array([route.ray(at, is_left=True) for at in route.stations[part]])
    ways = rays[:, 1] - rays[:, 0]
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    return _Middles(rays[:, 0], ways / lengths, sides[part])


def _mean_places(places: Floats) -> Floats:
    return np.column_stack(
        [[_around(axis, at, _MEAN_STEPS).mean() for at in range(len(places))] for axis in places.T]
    )


class _EdgeHeights:
    """How high edges lie, told by their vertices."""

    def __init__(self, accepted: Iterable[tuple[FeatureKind, Feature]]) -> None:
        from scipy.spatial import cKDTree

        xyz = np.array(
            [
                vertex.xyz
                for kind, feature in accepted
                if kind.id in CURB_KINDS or kind.dm_code in CARRIAGEWAY_CODES | ROAD_EDGE_CODES
                for vertex in feature.vertices
            ],
            np.float64,
        ).reshape(-1, 3)
        xyz = xyz[np.isfinite(xyz).all(axis=1)]
        self._heights = xyz[:, 2]
        # Any: scipy's tree has no stub that mypy takes
        self._tree: Any = cKDTree(xyz[:, :2]) if len(xyz) else None

    def middle(self, places: Sequence[Floats]) -> float:
        """Between places on edges; NaN where the height of one isn't known."""
        asked = np.array(places)
        if self._tree is None or not np.isfinite(asked).all():
            return float("nan")
        away, nearest = self._tree.query(asked)
        return float(self._heights[nearest].mean()) if max(away) <= _NEAR_M else float("nan")


def _settled(offsets: Floats) -> Floats:
    """Medians, then means, of the places before and behind; straight over what isn't known."""
    medians = np.full(offsets.size, np.nan)
    for at in range(offsets.size):
        near = _around(offsets, at, _MEDIAN_STEPS)
        near = near[np.isfinite(near)]
        if near.size:
            medians[at] = np.median(near)
    filled = _filled(medians)
    means: Floats = np.array(
        [_around(filled, at, _MEAN_STEPS).mean() for at in range(offsets.size)]
    )
    return means


def _around(values: Floats, at: int, steps: int) -> Floats:
    """As many before as behind, so that nothing is drawn aside at the ends."""
    reach = min(steps, at, values.size - 1 - at)
    return values[at - reach : at + reach + 1]


def _filled(values: Floats) -> Floats:
    """Straight over what isn't known; 0 where nothing is."""
    numbers, known = np.arange(values.size), np.isfinite(values)
    if not known.any():
        return np.zeros(values.size)
    return np.interp(numbers, numbers[known], values[known])
