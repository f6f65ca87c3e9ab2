"""How lines and areas of one kind lie to one another."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.map.catalogue import Geometry
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.polyline import SAME_POSITION_M
from processing.map.feature import Feature, Position
from processing.map.quality.findings import Finding, RuleId
from processing.map.quality.plan_shapes import SAME_LEVEL_M, PlanShapes, height_on

GAP_M = 0.25
"""Half a millimetre at 1:500: nearer ends look joined on paper, and nobody means such a gap."""

SAME_SHAPE_M = 0.01
"""Two drawings of one line differ by more, unless one is a copy of the other."""

SAME_POINT_M = 0.05
"""Things on posts and in the ground are thicker: two of a kind don't stand nearer."""

LEAST_LENGTH_M = 0.01
LEAST_AREA_M2 = 1e-3
"""Less is a slip of the hand: a manhole of 4 cm across."""

OVERLAP_SHARE = 0.1
"""Of the smaller area; lids that were measured side by side overlap by their joints."""

_SAME_WAY = math.cos(math.radians(30.0))
"""Edges side by side, as of a gutter, end together and look the same way: that is no gap."""

_MAY_CROSS = frozenset(
    {"wire", "width_line", "measurement", "marking_line", "crosswalk_bar", "road_marking"}
)
"""Wires hang above each other, widths are taken across, markings are painted so."""


def topology_findings(features: Sequence[Feature]) -> Iterator[Finding]:
    """What is wrong among features of one kind and one geometry."""
    if not features:
        return
    geometry, kind = features[0].geometry, features[0].kind
    if geometry is Geometry.POINT:
        yield from _double_points(features)
        return
    alone = list(_alone(features))
    yield from alone
    slips = {one.features[0] for one in alone if one.rule == "too_small"}
    shapes = PlanShapes.of([one for one in features if one.id not in slips])
    if geometry is Geometry.AREA:
        yield from _overlaps(shapes)
        return
    yield from _line_pairs(shapes, may_cross=kind in _MAY_CROSS)
    if kind not in _MAY_CROSS:
        yield from _gaps(shapes)


def _finding(
    rule: RuleId, features: Sequence[Feature], position: Position, extent_m: float | None = None
) -> Finding:
    return Finding(rule, tuple(one.id for one in features), features[0].kind, position, extent_m)


def _double_points(features: Sequence[Feature]) -> Iterator[Finding]:
    places = np.array([one.vertices[0].xyz for one in features])
    pairs = cKDTree(places - places[0]).query_pairs(SAME_POINT_M, output_type="ndarray")
    for one, other in sorted(map(tuple, pairs.tolist())):
        both = features[one], features[other]
        yield _finding("duplicate", both, both[0].vertices[0].xyz)


def _alone(features: Sequence[Feature]) -> Iterator[Finding]:
    """What is wrong with a feature whatever lies beside it."""
    for one in features:
        positions = [vertex.xyz for vertex in one.vertices]
        is_closed = one.geometry is Geometry.AREA
        if _is_too_small(np.array(positions), is_closed=is_closed):
            yield _finding("too_small", [one], positions[0])
            continue
        meets = crosses_itself(positions, is_closed=is_closed)
        if meets is not None:
            yield _finding("self_crossing", [one], (*meets, positions[0][2]))


def _is_too_small(positions: Floats, *, is_closed: bool) -> bool:
    near = positions - positions[0]
    if not is_closed:
        return bool(np.linalg.norm(np.diff(near, axis=0), axis=1).sum() < LEAST_LENGTH_M)
    # The area in space: a wall's outline seen from above has none.
    turned = np.cross(near, np.roll(near, -1, axis=0)).sum(axis=0)
    return bool(0.5 * np.linalg.norm(turned) < LEAST_AREA_M2)


def _overlaps(shapes: PlanShapes) -> Iterator[Finding]:
    for one, other in zip(*shapes.meeting(), strict=True):
        a, b = shapes.shapes[one], shapes.shapes[other]
        both = shapes.features[one], shapes.features[other]
        if not (a.is_valid and b.is_valid):
            continue  # told as crossing itself
        shared = shapely.intersection(shapely.force_2d(a), shapely.force_2d(b))
        smaller = min(a.area, b.area)
        heights = [np.mean([vertex.xyz[2] for vertex in each.vertices]) for each in both]
        if shared.area <= OVERLAP_SHARE * smaller or abs(np.diff(heights)[0]) > SAME_LEVEL_M:
            continue
        middle = shared.representative_point()
        place = shapes.position(middle.x, middle.y, float(heights[0]))
        is_twin = shared.area >= (1 - OVERLAP_SHARE) * max(a.area, b.area)
        yield _finding("duplicate" if is_twin else "overlap", both, place, shared.area)


def _line_pairs(shapes: PlanShapes, *, may_cross: bool) -> Iterator[Finding]:
    """Lines that lie on one another or cross, where their heights are the same."""
    for one, other in zip(*shapes.meeting(), strict=True):
        a, b = (shapely.force_2d(shapes.shapes[each]) for each in (one, other))
        both = shapes.features[one], shapes.features[other]
        shared = shapely.intersection(a, b)
        if shared.length > LEAST_LENGTH_M:
            is_twin = shapely.equals_exact(a.normalize(), b.normalize(), SAME_SHAPE_M)
            places = [shapely.line_interpolate_point(_longest(shared), 0.5, normalized=True)]
            rule: RuleId = "duplicate" if is_twin else "partly_double"
        elif may_cross or not shapely.crosses(a, b):
            continue
        else:
            places, rule = list(shapely.get_parts(shared)), "crossing"
        for place in places:
            heights = [height_on(shapes.shapes[each], place) for each in (one, other)]
            is_end = min(_to_end(line, place) for line in (a, b)) <= SAME_POSITION_M
            if abs(heights[0] - heights[1]) > SAME_LEVEL_M or (rule == "crossing" and is_end):
                continue
            yield _finding(rule, both, shapes.position(place.x, place.y, heights[0]))


def _longest(shared: shapely.Geometry) -> shapely.Geometry:
    parts = shapely.get_parts(shared)
    return parts[np.argmax(shapely.length(parts))]


def _to_end(line: shapely.LineString, place: shapely.Point) -> float:
    ends = (line.coords[0], line.coords[-1])
    return min(math.dist(end[:2], (place.x, place.y)) for end in ends)


def _gaps(shapes: PlanShapes) -> Iterator[Finding]:
    """Ends that stop short of the end, or of the middle, of another line of the kind."""
    ends, outward, owners = line_ends(shapes)
    if not len(ends):
        return
    yield from _gaps_to_ends(shapes, ends, outward, owners)
    yield from _gaps_to_lines(shapes, ends, outward, owners)


def line_ends(shapes: PlanShapes) -> tuple[Floats, Floats, list[int]]:
    """Both ends of each open line: place, direction outwards in plan, whose it is."""
    places, outward, owners = [], [], []
    for number, shape in enumerate(shapes.shapes):
        corners = shapely.get_coordinates(shape, include_z=True)
        if math.dist(corners[0, :2], corners[-1, :2]) <= SAME_POSITION_M:
            continue
        for end, before in ((corners[0], corners[1]), (corners[-1], corners[-2])):
            step = end[:2] - before[:2]
            length = float(np.hypot(*step))
            places.append(end)
            outward.append(step / length if length else step)
            owners.append(number)
    return np.array(places), np.array(outward), owners


def _gaps_to_ends(
    shapes: PlanShapes, ends: Floats, outward: Floats, owners: list[int]
) -> Iterator[Finding]:
    pairs = cKDTree(ends[:, :2]).query_pairs(GAP_M, output_type="ndarray")
    for one, other in sorted(map(tuple, pairs.tolist())):
        apart = math.dist(ends[one, :2], ends[other, :2])
        if apart <= SAME_POSITION_M or abs(ends[one, 2] - ends[other, 2]) > SAME_LEVEL_M:
            continue
        is_alongside = float(outward[one] @ outward[other]) > _SAME_WAY
        if is_alongside and owners[one] != owners[other]:
            continue
        both = [shapes.features[number] for number in dict.fromkeys((owners[one], owners[other]))]
        middle = (ends[one] + ends[other]) / 2
        yield _finding("gap", both, shapes.position(*middle.tolist()), apart)


def _gaps_to_lines(
    shapes: PlanShapes, ends: Floats, outward: Floats, owners: list[int]
) -> Iterator[Finding]:
    """Ends that would meet another line if they went on a little."""
    starts = ends[:, :2] + SAME_POSITION_M * outward
    ahead = shapely.linestrings(np.stack([starts, ends[:, :2] + GAP_M * outward], axis=1))
    flat = shapely.force_2d(shapes.shapes)
    numbers, lines = shapely.STRtree(flat).query(ahead, predicate="intersects")
    for number, line in zip(numbers.tolist(), lines.tolist(), strict=True):
        if line == owners[number]:
            continue
        meets = shapely.intersection(ahead[number], flat[line])
        if meets.is_empty:  # an end without a direction has nothing ahead
            continue
        place = shapely.get_parts(meets)[0].centroid
        # Ends near ends are told as such; an end that touches the line is joined.
        if _to_end(flat[line], place) <= GAP_M:
            continue
        is_joined = shapely.distance(shapely.Point(ends[number, :2]), flat[line]) <= SAME_POSITION_M
        height_m = height_on(shapes.shapes[line], place)
        if is_joined or abs(height_m - ends[number, 2]) > SAME_LEVEL_M:
            continue
        both = shapes.features[owners[number]], shapes.features[line]
        apart = math.dist(ends[number, :2], (place.x, place.y))
        yield _finding("gap", both, shapes.position(place.x, place.y, height_m), apart)
