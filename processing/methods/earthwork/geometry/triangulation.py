"""Triangles over measured ground whose edges keep to the break lines that somebody drew.

1. Break lines become one net (:mod:`processing.methods.earthwork.geometry.break_lines`).
2. Points nearer to a line than half of what lies between them are left out: the line tells better
   where the ground breaks than they do.
3. Segments are cut, at heights on the line, until the circle over each holds no other point.
   Then each is an edge of the Delaunay triangles, and no triangle reaches across a break.
4. Triangles with an edge longer than what is asked for span ground that nobody measured; they are
   left out, and so is what lies outside the boundary.

References
----------
Ruppert 1995, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation": cutting
by circles, and on shells around corners, so that segments which meet there cut each other once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import Delaunay, QhullError, cKDTree

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.geometry.break_lines import BreakNet, break_net
from processing.methods.earthwork.geometry.plan_clip import clip_triangles
from processing.methods.earthwork.geometry.same_positions import number_positions
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

AGREE_WITHIN_M = 0.05
"""Break lines that meet at heights no farther apart are joined at the mean of both; by judgement,
about what two lines drawn on points differ by. Farther ones cross over each other."""

_SAME_POSITION_M = 1e-4
"""Points nearer than this in plan are one: below a millimetre, above rounding."""

_ROUNDING_M = 1e-6
"""Corners of pieces that differ by less do so by rounding."""

_SPACING_NEIGHBOURS = 4
"""On a square grid so many neighbours are one spacing away."""

_NEAR_LINE_SPACINGS = 0.5
"""Points nearer to a line than this share of their spacing say what the line says, and give way to
it."""

_MOST_REACH_M = 0.5
"""Single points that somebody measured farther from a line are meant, however few there are."""

_ON_CIRCLE = 1e-9
"""Share of a radius within which a point is on a circle: what rounding makes of it."""

_SHORTEST_M = 1e-3
"""Radius of the circle over a segment that is cut no further: pieces of a millimetre or two."""

_MOST_ROUNDS = 60
"""Of cutting; each halves, so that any segment would be shorter than an atom by then."""


def triangulate_ground(
    xyz: Floats,
    break_lines: Sequence[Floats],
    monitor: Monitor,
    *,
    longest_m: float | None = None,
    boundary: shapely.Geometry | None = None,
    agree_within_m: float = AGREE_WITHIN_M,
) -> TriangleSurface:
    """The ground between points, and along break lines.

    Parameters
    ----------
    xyz : (n, 3) float64
        Ground, m, project CRS; rows that are not finite are passed over, points at one position in
        plan become one at their mean height.
    break_lines : sequence of (k, 3) float64
        Lines on the ground that no triangle reaches across.
    longest_m : float or None
        No triangle has a longer edge in plan; None fills all gaps.
    boundary : shapely.Polygon or shapely.MultiPolygon or None
        The surface ends there, m, project CRS.
    agree_within_m : float
        As of :func:`processing.methods.earthwork.geometry.break_lines.break_net`.

    Raises
    ------
    Unsuitable
        Fewer than three places that aren't on one line; break lines that can't be joined; nothing
        left by the longest edge or the boundary.
    """
    measured = xyz[np.isfinite(xyz).all(axis=1)]
    every = np.concatenate([measured, *(np.asarray(line)[:, :3] for line in break_lines)])
    if len(every) < 3:
        raise _too_few(len(every))
    origin = np.array([*np.floor(np.nanmin(every[:, :2], axis=0)), 0.0])
    points = _merged(measured - origin)
    net = BreakNet(np.empty((0, 3)), np.empty((0, 2), np.int64))
    if break_lines:
        joined = break_net(break_lines, agree_within_m)
        net = BreakNet(joined.xyz - origin, joined.segments)
        points = _away_from_lines(points, net)
        monitor.check()
        net = _cut_to_edges(net, points)
    monitor.check()
    corners, triangles = _delaunay(points, net, origin)
    monitor.check()
    if longest_m is not None:
        sides = corners[triangles] - corners[np.roll(triangles, 1, axis=1)]
        triangles = triangles[np.hypot(sides[:, :, 0], sides[:, :, 1]).max(axis=1) <= longest_m]
    surface = TriangleSurface(corners + origin, triangles)
    surface = TriangleSurface(surface.xyz, triangles[~surface.is_vertical])
    if boundary is not None and len(surface.corners):
        surface = clip_surface(surface, boundary, monitor)
    if not len(surface.corners):
        raise _none_left()
    return surface


def clip_surface(
    surface: TriangleSurface, boundary: shapely.Geometry, monitor: Monitor
) -> TriangleSurface:
    """A surface that ends at a boundary; triangles that it cuts are cut into smaller ones.

    Parameters
    ----------
    boundary : shapely.Polygon or shapely.MultiPolygon
        m, project CRS.
    """
    origin = np.array([*surface.origin[:2], 0.0])
    local = shapely.transform(boundary, lambda positions: positions - origin[:2])
    pieces = clip_triangles(surface.plan_triangles(origin), local, monitor).reshape(-1, 3)
    corners, firsts = number_positions(pieces, _ROUNDING_M)
    return TriangleSurface(pieces[firsts] + origin, corners.reshape(-1, 3), surface.name)


def _none_left() -> Unsuitable:
    return Unsuitable(
        Text("No triangle of the ground is left.", "地盤の三角形が1つも残りません。"),
        Text("Longest edge and boundary", "最大辺長と境界"),
        Text(
            "Allow longer edges, or choose a boundary on the measured ground.",
            "最大辺長を長くするか、計測した地盤の上に境界を指定してください。",
        ),
    )


def _too_few(count: int) -> Unsuitable:
    return Unsuitable(
        Text(
            "The ground has no three places that make a triangle.",
            "三角形を作れる3点が地盤にありません。",
        ),
        Text(f"{count} points", f"{count}点"),
        Text("Give more ground points.", "地盤の点を増やしてください。"),
    )


def _merged(xyz: Floats) -> Floats:
    """Points at one position in plan as one at their mean height."""
    numbers, firsts = number_positions(xyz[:, :2], _SAME_POSITION_M)
    heights = np.bincount(numbers, xyz[:, 2]) / np.bincount(numbers)
    return np.column_stack([xyz[firsts, :2], heights])


def _away_from_lines(points: Floats, net: BreakNet) -> Floats:
    """Points that don't lie beside a break line, nearer than half their spacing."""
    if len(points) <= _SPACING_NEIGHBOURS:
        return points
    tree = cKDTree(points[:, :2])
    spacing, _ = tree.query(points[:, :2], [_SPACING_NEIGHBOURS + 1], workers=-1)  # 1: itself
    reach = np.minimum(_NEAR_LINE_SPACINGS * np.ravel(spacing), _MOST_REACH_M)
    lines = shapely.linestrings(net.xyz[net.segments, :2])
    (asked, _), apart = shapely.STRtree(lines).query_nearest(
        shapely.points(points[:, :2]),
        max_distance=float(reach.max()),
        return_distance=True,
        all_matches=False,
    )
    is_kept = np.ones(len(points), bool)
    is_kept[asked[apart < reach[asked]]] = False
    return points[is_kept]


def _cut_to_edges(net: BreakNet, points: Floats) -> BreakNet:
    """Cut segments at heights on them until the circle over each holds no other point."""
    xyz, segments = net.xyz, net.segments
    given = len(xyz)
    cloud = cKDTree(points[:, :2]) if len(points) else None
    for _ in range(_MOST_ROUNDS):
        cut = _encroached(xyz, segments, cloud)
        if not cut.any():
            break
        xyz, segments = _halved(xyz, segments, cut, given)
    return BreakNet(xyz, segments)


def _encroached(xyz: Floats, segments: Numbers, cloud: cKDTree | None) -> NDArray[np.bool_]:
    """Segments over which the circle holds a point or another vertex: (s,) bool."""
    start, end = xyz[segments[:, 0], :2], xyz[segments[:, 1], :2]
    middle, radius = (start + end) / 2, np.hypot(*(end - start).T) / 2
    reach = radius * (1.0 + _ON_CIRCLE)
    # The ends of the segment are two of the three nearest, unless others are nearer still.
    count = min(3, len(xyz))
    apart, vertex = cKDTree(xyz[:, :2]).query(middle, count)
    is_other = (vertex != segments[:, :1]) & (vertex != segments[:, 1:])
    is_cut = (is_other & (apart <= reach[:, None])).any(axis=1)
    if cloud is not None:
        is_cut |= cloud.query(middle)[0] <= reach
    result: NDArray[np.bool_] = is_cut & (radius > _SHORTEST_M)
    return result


def _halved(
    xyz: Floats, segments: Numbers, cut: NDArray[np.bool_], given: int
) -> tuple[Floats, Numbers]:
    """Segments cut near their middle; those that end at one given vertex on a shell around it."""
    ends = segments[cut]
    is_given = ends < given
    # The given end comes first: shells are counted from there.
    ends = np.where((is_given[:, 1] & ~is_given[:, 0])[:, None], ends[:, ::-1], ends)
    start, end = xyz[ends[:, 0]], xyz[ends[:, 1]]
    length = np.hypot(*(end - start)[:, :2].T)
    shell = 2.0 ** np.round(np.log2(length / 2)) / length
    share = np.where(is_given[:, 0] != is_given[:, 1], shell, 0.5)[:, None]
    added = len(xyz) + np.arange(len(ends))
    halves = [np.column_stack([ends[:, 0], added]), np.column_stack([added, ends[:, 1]])]
    positions = start + share * (end - start)
    return np.concatenate([xyz, positions]), np.concatenate([segments[~cut], *halves])


def _delaunay(points: Floats, net: BreakNet, origin: Floats) -> tuple[Floats, Numbers]:
    """Corners and triangles; each segment of the net is an edge of them."""
    corners = np.concatenate([net.xyz, points])
    if len(corners) < 3:
        raise _too_few(len(corners))
    try:
        triangles = Delaunay(corners[:, :2]).simplices.astype(np.int64)
    except QhullError as error:  # all on one line
        raise _too_few(len(corners)) from error
    missing = _not_edges(triangles, net.segments, len(corners))
    if len(missing):
        position = corners[missing[0, 0]] + origin
        raise Unsuitable(
            Text(
                "Break lines meet at so small an angle that no triangle fits between them.",
                "ブレークラインどうしの角度が小さすぎて、間に三角形を作れません。",
            ),
            Text(
                f"Easting {position[0]:.3f}, northing {position[1]:.3f}",
                f"東{position[0]:.3f} 北{position[1]:.3f}",
            ),
            Text("Draw one of the lines again.", "一方の線を描き直してください。"),
        )
    return corners, triangles


def _not_edges(triangles: Numbers, segments: Numbers, count: int) -> Numbers:
    """Segments that are no edge of any triangle."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    lines = np.sort(segments, axis=1)
    sides = np.sort(sides[(sides < segments.max(initial=-1) + 1).all(axis=1)], axis=1)
    keys = lines[:, 0] * count + lines[:, 1]
    return segments[~np.isin(keys, sides[:, 0] * count + sides[:, 1])]
