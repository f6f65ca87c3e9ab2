"""Two maps of one place against each other, kind by kind, in plan.

Points and areas are paired one to one, the nearest first. Lines are compared piece by piece, since
two surveyors hardly cut a road's edge at the same places.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from scipy.spatial import cKDTree

from processing.core.arrays import Flags, Floats
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex
from processing.map.quality.check_points import LEVEL_LIMITS

ChangeName = Literal["new", "moved", "gone"]

COMPARISON = "map-comparison"
"""What stands in the place of a tool's id where features and runs come from a comparison."""

COMPARISON_NAME = Text("Comparison with the last map", "既存図との比較")

TOLERANCE_M = round(2 * math.sqrt(2) * LEVEL_LIMITS[500].plan_m, 1)
"""Twice the standard deviation of the difference of two maps of level 500, each as exact as
作業規程の準則 第80条 asks: what differs less may not have changed."""

SEARCH_M = 3.0
"""Farther away it is another thing: some three quarters of a traffic lane."""

MOST_SEARCH_M = 50.0
"""Farther apart, nothing on a road is the same thing."""

_LEAST_PIECE_M = 1.0
"""Shorter pieces of lines, 2 mm on paper, are ends that were drawn a little farther."""

_REACHED = 0.5
"""A thing was looked for where at least this share of its places was measured or mapped."""

_STEP_M = 0.5
_SAME_AREA = 0.3
"""Outlines that share this much of what both cover are of one thing, wherever its middle is."""

_COMPARING = Text("Comparing {kind}", "{kind}を比較中")


@dataclass(frozen=True)
class ComparisonLimits:
    """What counts as a change.

    Attributes
    ----------
    tolerance_m : float
        Within it, nothing moved.
    search_m : float
        Farther than this, a thing is another one; at least the tolerance.
    """

    tolerance_m: float = TOLERANCE_M
    search_m: float = SEARCH_M


@dataclass(frozen=True)
class MapDifference:
    """One change.

    Attributes
    ----------
    change : str
        ``new``: only on the map of today; ``gone``: only on the last one; ``moved``: on both, in
        different places.
    kind : str
        Of the thing.
    geometry : Geometry
    vertices : tuple of Vertex
        The thing as it is today; as it was where it is gone. A piece, of a line.
    features : tuple of str
        Ids of the thing on the map of today; none where it is gone.
    distance_m : float
        How far it moved in plan at most; NaN where it didn't.
    confidence : float
        Near 0 where the difference is that of two drawings, near 1 where it is far larger.
    """

    change: ChangeName
    kind: str
    geometry: Geometry
    vertices: tuple[Vertex, ...]
    features: tuple[str, ...] = ()
    distance_m: float = math.nan
    confidence: float = 1.0


@dataclass(frozen=True)
class MapComparison:
    """What became of a map.

    Attributes
    ----------
    differences : tuple of MapDifference
    same : int
        Things on the last map that are where they were; lines count as one where any piece is.
    only_before, only_now : tuple of str
        Kinds that only one of the maps has: they were not compared.
    unreached : int
        Things on the last map where nothing was measured.
    """

    differences: tuple[MapDifference, ...]
    same: int
    only_before: tuple[str, ...]
    only_now: tuple[str, ...]
    unreached: int


def compare_maps(
    before: Sequence[Feature],
    now: Sequence[Feature],
    limits: ComparisonLimits,
    is_measured: Callable[[Floats], Flags],
    monitor: Monitor,
) -> MapComparison:
    """Find what is new, moved and gone.

    What lies outside of the last map's outline is not new, and what lies where nothing was measured
    is not gone.

    Parameters
    ----------
    before, now : sequence of Feature
        In one reference system; of ``now`` those that count.
    is_measured : callable
        Of (n, 2) places, m, whether the survey of today saw them.

    Raises
    ------
    Cancelled
    """
    groups = _grouped(before), _grouped(now)
    shared = [key for key in groups[0] if key in groups[1]]
    mapped = mapped_ground(before, limits.tolerance_m)
    found: list[MapDifference] = []
    same = unreached = 0
    for number, key in enumerate(shared):
        monitor.check()
        monitor.report(number / len(shared), _COMPARING.filled(kind=key[0]))
        compare = _BY_GEOMETRY[key[1]]
        part = compare(groups[0][key], groups[1][key], limits)
        gone = [one for one in part.differences if one.change == "gone"]
        kept = [one for one in gone if _share(is_measured, one) >= _REACHED]
        unreached += len(gone) - len(kept)
        same += part.same
        found += kept
        found += [one for one in part.differences if one.change == "moved"]
        found += [
            one
            for one in part.differences
            if one.change == "new" and _share(mapped, one) >= _REACHED
        ]
    kinds = [dict.fromkeys(kind for kind, _ in group) for group in groups]
    return MapComparison(
        tuple(found),
        same,
        tuple(kind for kind in kinds[0] if kind not in kinds[1]),
        tuple(kind for kind in kinds[1] if kind not in kinds[0]),
        unreached,
    )


@dataclass(frozen=True)
class _Part:
    differences: Sequence[MapDifference]
    same: int


_Groups = Mapping[tuple[str, Geometry], list[Feature]]


def _grouped(features: Sequence[Feature]) -> _Groups:
    groups: dict[tuple[str, Geometry], list[Feature]] = {}
    for one in features:
        groups.setdefault((one.kind, one.geometry), []).append(one)
    return groups


def mapped_ground(features: Sequence[Feature], reach_m: float) -> Callable[[Floats], Flags]:
    """Whether places lie within the outline around all features, with a margin."""
    corners = np.array([vertex.xyz[:2] for one in features for vertex in one.vertices])
    outline = shapely.MultiPoint(corners).convex_hull.buffer(reach_m)
    shapely.prepare(outline)

    def holds(xy: Floats) -> Flags:
        inside: Flags = shapely.contains_xy(outline, xy[:, 0], xy[:, 1])
        return inside

    return holds


def _share(is_there: Callable[[Floats], Flags], one: MapDifference) -> float:
    return share_within(is_there, one.geometry, one.vertices)


def share_within(
    is_there: Callable[[Floats], Flags], geometry: Geometry, vertices: Sequence[Vertex]
) -> float:
    """The share of a thing's places of which something is so; along lines every half metre."""
    xy = np.array([vertex.xyz[:2] for vertex in vertices])
    return float(np.mean(is_there(_dense(xy) if geometry is Geometry.LINE else xy)))


def _dense(xy: Floats) -> Floats:
    places: Floats = shapely.get_coordinates(shapely.segmentize(shapely.LineString(xy), _STEP_M))
    return places


def _confidence(distance_m: float, limits: ComparisonLimits) -> float:
    """How much of a distance the maps' inaccuracy doesn't explain."""
    return max(0.0, 1.0 - limits.tolerance_m / max(distance_m, limits.tolerance_m))


def _whole(
    change: ChangeName, one: Feature, reach_m: float, limits: ComparisonLimits
) -> MapDifference:
    ids = () if change == "gone" else (one.id,)
    confidence = _confidence(reach_m, limits)
    return MapDifference(change, one.kind, one.geometry, one.vertices, ids, confidence=confidence)


def _moved(one: Feature, distance_m: float, limits: ComparisonLimits) -> MapDifference:
    confidence = _confidence(distance_m, limits)
    return MapDifference(
        "moved", one.kind, one.geometry, one.vertices, (one.id,), distance_m, confidence
    )


# Points and areas


def _compare_points(
    before: Sequence[Feature], now: Sequence[Feature], limits: ComparisonLimits
) -> _Part:
    places = [np.array([one.vertices[0].xyz[:2] for one in each]) for each in (before, now)]
    near = cKDTree(places[0]).sparse_distance_matrix(
        cKDTree(places[1]), limits.search_m, output_type="coo_matrix"
    )
    ranked = sorted(zip(near.data.tolist(), near.row.tolist(), near.col.tolist(), strict=True))
    pairs = _one_to_one((distance, one, other) for distance, one, other in ranked)
    return _paired(before, now, pairs, limits)


def _compare_areas(
    before: Sequence[Feature], now: Sequence[Feature], limits: ComparisonLimits
) -> _Part:
    origin = np.array(before[0].vertices[0].xyz[:2])
    outlines = [[_outline(one, origin) for one in each] for each in (before, now)]
    tree = shapely.STRtree(outlines[1])
    ranked = []
    for number, outline in enumerate(outlines[0]):
        for other in tree.query(outline, predicate="dwithin", distance=limits.search_m).tolist():
            rival = outlines[1][other]
            union = outline.union(rival).area
            overlap = outline.intersection(rival).area / union if union else 0.0
            apart = outline.centroid.distance(rival.centroid)
            if overlap >= _SAME_AREA or apart <= limits.search_m:
                ranked.append((-overlap, apart, number, other))
    pairs = _one_to_one(
        (shapely.hausdorff_distance(outlines[0][one], outlines[1][other]), one, other)
        for _, _, one, other in sorted(ranked)
    )
    return _paired(before, now, pairs, limits)


def _outline(feature: Feature, origin: Floats) -> shapely.Geometry:
    ring = np.array([vertex.xyz[:2] for vertex in feature.vertices]) - origin
    polygon = shapely.Polygon(ring)
    return polygon if polygon.is_valid else polygon.buffer(0.0) or polygon.convex_hull


def _one_to_one(ranked: Iterator[tuple[float, int, int]]) -> list[tuple[float, int, int]]:
    """Pairs in their order, each thing once."""
    pairs: list[tuple[float, int, int]] = []
    taken: tuple[set[int], set[int]] = (set(), set())
    for distance, one, other in ranked:
        if one not in taken[0] and other not in taken[1]:
            pairs.append((distance, one, other))
            taken[0].add(one)
            taken[1].add(other)
    return pairs


def _paired(
    before: Sequence[Feature],
    now: Sequence[Feature],
    pairs: Sequence[tuple[float, int, int]],
    limits: ComparisonLimits,
) -> _Part:
    moved = [
        _moved(now[other], distance, limits)
        for distance, _, other in pairs
        if distance > limits.tolerance_m
    ]
    known = {one for _, one, _ in pairs}, {other for _, _, other in pairs}
    reach = limits.search_m
    gone = [_whole("gone", one, reach, limits) for n, one in enumerate(before) if n not in known[0]]
    new = [_whole("new", one, reach, limits) for n, one in enumerate(now) if n not in known[1]]
    return _Part([*moved, *gone, *new], len(pairs) - len(moved))


# Lines


@dataclass(frozen=True)
class _Lines:
    """Lines of one kind about an origin, and what finds those near a line."""

    features: Sequence[Feature]
    shapes: Sequence[shapely.LineString]
    tree: shapely.STRtree

    @staticmethod
    def of(features: Sequence[Feature], origin: Floats) -> _Lines:
        shapes = [
            shapely.LineString(np.array([vertex.xyz for vertex in one.vertices]) - (*origin, 0.0))
            for one in features
        ]
        return _Lines(features, shapes, shapely.STRtree(shapes))

    def near(self, line: shapely.Geometry, reach_m: float) -> list[int]:
        found: list[int] = self.tree.query(line, predicate="dwithin", distance=reach_m).tolist()
        return found


def _compare_lines(
    before: Sequence[Feature], now: Sequence[Feature], limits: ComparisonLimits
) -> _Part:
    origin = np.array(before[0].vertices[0].xyz[:2])
    old, new = _Lines.of(before, origin), _Lines.of(now, origin)
    found: list[MapDifference] = []
    same = 0
    for feature, line in zip(old.features, old.shapes, strict=True):
        rest, far = _apart(line, new, limits)
        same += rest.length < line.length - _LEAST_PIECE_M
        found += [_gone_piece(feature, line, one, origin, limits) for one in far]
    for feature, line in zip(new.features, new.shapes, strict=True):
        rest, far = _apart(line, old, limits)
        for one in far:
            vertices = _vertices(feature, line, one, origin)
            found.append(
                MapDifference(
                    "new", feature.kind, Geometry.LINE, vertices, (feature.id,),
                    confidence=_confidence(limits.search_m, limits),
                )
            )  # fmt: skip
        moved = rest.difference(shapely.union_all([one.buffer(1e-6) for one in far]))
        rivals = [old.shapes[each] for each in old.near(line, limits.search_m)]
        for one in _pieces(moved):
            distance = shapely.distance(
                shapely.points(_dense(_flat(one))), shapely.union_all(rivals)
            )
            piece = feature.with_vertices(_vertices(feature, line, one, origin))
            found.append(_moved(piece, float(distance.max()), limits))
    return _Part(found, same)


def _flat(line: shapely.Geometry) -> Floats:
    xy: Floats = shapely.get_coordinates(line)
    return xy


def _apart(
    line: shapely.LineString, others: _Lines, limits: ComparisonLimits
) -> tuple[shapely.Geometry, list[shapely.LineString]]:
    """What of a line isn't on other lines, and the pieces of it that are near none of them."""
    near = [others.shapes[each] for each in others.near(line, limits.search_m)]
    flat = shapely.force_2d(line)
    if not near:
        return flat, _pieces(flat)
    lines = shapely.union_all(shapely.force_2d(near))
    rest = flat.difference(lines.buffer(limits.tolerance_m))
    # What goes on where another line ends has not moved: the search ends square with it.
    beside = shapely.line_merge(lines).buffer(limits.search_m, cap_style="flat")
    return rest, _pieces(rest.difference(beside))


def _pieces(shape: shapely.Geometry) -> list[shapely.LineString]:
    merged = shapely.line_merge(shape) if shape.geom_type == "MultiLineString" else shape
    parts = shapely.get_parts(merged)
    return [one for one in parts if one.geom_type == "LineString" and one.length >= _LEAST_PIECE_M]


def _gone_piece(
    feature: Feature,
    line: shapely.LineString,
    piece: shapely.LineString,
    origin: Floats,
    limits: ComparisonLimits,
) -> MapDifference:
    vertices = _vertices(feature, line, piece, origin)
    confidence = _confidence(limits.search_m, limits)
    return MapDifference("gone", feature.kind, Geometry.LINE, vertices, confidence=confidence)


def _vertices(
    feature: Feature, line: shapely.LineString, piece: shapely.LineString, origin: Floats
) -> tuple[Vertex, ...]:
    """A piece with the heights of its line, and the measured points of the vertices it shares."""
    own = {
        (round(vertex.xyz[0] - origin[0], 6), round(vertex.xyz[1] - origin[1], 6)): vertex
        for vertex in feature.vertices
    }
    lacks_heights = all(vertex.is_occluded for vertex in feature.vertices)
    flat = shapely.force_2d(line)
    vertices = []
    for x, y in _flat(piece).tolist():
        known = own.get((round(x, 6), round(y, 6)))
        along = flat.project(shapely.Point(x, y))
        height = float(shapely.get_z(_at(line, flat, along)))
        place = (x + float(origin[0]), y + float(origin[1]), height)
        vertices.append(known or Vertex(place, is_occluded=lacks_heights))
    return tuple(vertices)


def _at(line: shapely.LineString, flat: shapely.LineString, along_m: float) -> shapely.Point:
    """The place of a line, with its height, so far along its plan."""
    share = along_m / flat.length if flat.length else 0.0
    return shapely.line_interpolate_point(line, share, normalized=True)


_BY_GEOMETRY: Mapping[
    Geometry, Callable[[Sequence[Feature], Sequence[Feature], ComparisonLimits], _Part]
] = {
    Geometry.POINT: _compare_points,
    Geometry.LINE: _compare_lines,
    Geometry.AREA: _compare_areas,
}
