"""Faces of a design: where it is flat (天端, 平場) and where it slopes (法面), and what is judged.

Berms (小段) belong to the slope that they interrupt. A strip along shoulders and toes is left out
of both: there a small shift in plan is a large one in height.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.methods.earthwork.as_built.limits import FaceKind
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface, twice_areas

_LEAST_AREA_M2 = 1e-6
"""Smaller parts of a plan are what rounding leaves."""

_SAME_POSITION_M = 1e-4
"""Corners nearer than this are one: designs are written in millimetres."""

_LEAST_SIDE_SHARE = 0.25
"""Of a berm's sides that have a slope above, and below; by trial, a berm is long, and its ends may
be open."""

_SAME_AREA = 1e-9
"""Share of an area by which a union of triangles may differ from their sum by rounding."""


@dataclass(frozen=True)
class FaceRules:
    """How the faces of a design are told apart.

    Attributes
    ----------
    slope_from : float
        Height ÷ plan length from which on a triangle is a slope. Roads lean up to 0.1, the
        gentlest slopes of banks are 0.25 (4割): between both.
    berm_m : float
        Widest berm: a flat between a slope above and one below it that is no wider is part of
        the slope. By judgement: berms are built 1 to 2 m wide, 3 m for a river's.
    margin_m : float
        Width of the strip on both sides of a shoulder or a toe that is left out: 5 cm
        (3次元計測技術を用いた出来形管理要領).
    """

    slope_from: float = 0.2
    berm_m: float = 3.0
    margin_m: float = 0.05


def design_faces(
    design: TriangleSurface, rules: FaceRules, boundary: shapely.Geometry | None = None
) -> Mapping[FaceKind, shapely.Geometry]:
    """The plan of each face, less the strips; a kind that the design lacks is not in it.

    Parameters
    ----------
    boundary : shapely.Polygon or shapely.MultiPolygon, optional
        What is judged lies within it; m, project CRS.

    Raises
    ------
    Unsuitable
        Nothing of the design is left to judge.
    """
    triangles = _Triangles.of(design)
    is_steep = triangles.gradient >= rules.slope_from
    is_slope = is_steep | _are_berms(triangles, is_steep, rules.berm_m)
    steep = _merged(triangles.outlines[is_steep])
    strips = shapely.buffer(shapely.boundary(steep), rules.margin_m)
    faces = {}
    for face, chosen in ((FaceKind.FLAT, ~is_slope), (FaceKind.SLOPE, is_slope)):
        plan = _merged(triangles.outlines[chosen])
        if rules.margin_m > 0.0:
            plan = shapely.difference(plan, strips)
        if boundary is not None:
            plan = shapely.intersection(plan, boundary)
        parts = shapely.get_parts(plan)
        is_area = (shapely.get_dimensions(parts) == 2) & (shapely.area(parts) > _LEAST_AREA_M2)
        if is_area.any():
            faces[face] = shapely.multipolygons(parts[is_area])
    if not faces:
        raise Unsuitable(
            Text("The design has no area to judge.", "設計面に評価できる範囲がありません。"),
            Text.same(design.name or "TIN"),
            Text(
                "Choose a surface with triangles, and a boundary on it.",
                "三角形網のある設計面と、その上の境界を指定してください。",
            ),
        )
    return faces


def _merged(outlines: NDArray[np.object_]) -> shapely.Geometry:
    """One area of many triangles; of none, an empty one, which has an outline."""
    if not len(outlines):
        return shapely.Polygon()
    # Many times faster, but only right where triangles meet at their corners.
    with suppress(shapely.GEOSException):
        merged = shapely.coverage_union_all(outlines)
        is_whole = np.isclose(shapely.area(merged), shapely.area(outlines).sum(), rtol=_SAME_AREA)
        if is_whole and shapely.is_valid(merged):
            return merged
    return shapely.union_all(outlines)


@dataclass(frozen=True)
class _Triangles:
    """Those that have an area seen from above.

    Attributes
    ----------
    gradient : (t,) float64
        Height ÷ plan length.
    area : (t,) float64
        Seen from above, m².
    outlines : (t,) shapely.Polygon
    pairs : (p, 2) int64
        Triangles that share a side.
    side_m : (p,) float64
        How long it is, seen from above.
    above_m : (p, 2) float64
        By how much the far corner of each of the two lies above the middle of that side.
    """

    gradient: NDArray[np.float64]
    area: NDArray[np.float64]
    outlines: NDArray[np.object_]
    pairs: NDArray[np.int64]
    side_m: NDArray[np.float64]
    above_m: NDArray[np.float64]

    @staticmethod
    def of(design: TriangleSurface) -> _Triangles:
        is_seen = ~design.is_vertical
        corners, xyz = design.corners[is_seen], design.xyz - design.origin
        gradient = np.tan(np.radians(design.slopes_deg()[is_seen]))
        area = 0.5 * np.abs(twice_areas(xyz[corners]))
        rings = design.xyz[corners][:, [0, 1, 2, 0], :2]
        outlines = np.atleast_1d(shapely.polygons(rings)) if len(rings) else np.empty(0, object)
        pairs, sides, far = _neighbours(xyz, corners)
        side_m = np.hypot(*(xyz[sides[:, 1], :2] - xyz[sides[:, 0], :2]).T)
        middle = 0.5 * (xyz[sides[:, 0], 2] + xyz[sides[:, 1], 2])
        above_m = xyz[far, 2] - middle[:, None]
        return _Triangles(gradient, area, outlines, pairs, side_m, above_m)


def _neighbours(
    xyz: NDArray[np.float64], corners: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Triangles that share a side, the side's two corners, and the far corner of each triangle."""
    # Programs that write each face with corners of its own give the same position many numbers.
    _, position = np.unique(np.round(xyz / _SAME_POSITION_M), axis=0, return_inverse=True)
    position = position.reshape(-1)
    sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    far = np.concatenate([corners[:, 2], corners[:, 0], corners[:, 1]])
    triangle = np.tile(np.arange(len(corners)), 3)
    ends = np.sort(position[sides], axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    is_same = (ends[order[1:]] == ends[order[:-1]]).all(axis=1)
    one, other = order[:-1][is_same], order[1:][is_same]
    return (
        np.column_stack([triangle[one], triangle[other]]),
        sides[one],
        np.column_stack([far[one], far[other]]),
    )


def _are_berms(
    triangles: _Triangles, is_steep: NDArray[np.bool_], berm_m: float
) -> NDArray[np.bool_]:
    """Which flat triangles belong to a berm: narrow, with a slope above and one below."""
    count, pairs = len(is_steep), triangles.pairs
    are_flat = ~is_steep[pairs].any(axis=1)
    links = coo_array(
        (np.ones(are_flat.sum(), np.int8), (pairs[are_flat, 0], pairs[are_flat, 1])),
        shape=(count, count),
    )
    parts, part = connected_components(links, directed=False)
    area = np.bincount(part, triangles.area, parts)
    is_edge = is_steep[pairs[:, 0]] != is_steep[pairs[:, 1]]
    edges = pairs[is_edge]
    flat_side = np.where(is_steep[edges[:, 0]], 1, 0)
    numbers = np.arange(len(edges))
    of_part = part[edges[numbers, flat_side]]
    rises = triangles.above_m[is_edge][numbers, 1 - flat_side] > 0.0
    length = triangles.side_m[is_edge]
    up = np.bincount(of_part, length * rises, parts)
    down = np.bincount(of_part, length * ~rises, parts)
    along = up + down
    # A berm as long as wide is no berm: its ends count for nothing in twice the area ÷ edges.
    is_narrow = (along > 0.0) & (2.0 * area <= berm_m * along)
    is_between = np.minimum(up, down) >= _LEAST_SIDE_SHARE * along
    return ~is_steep & (is_narrow & is_between)[part]
