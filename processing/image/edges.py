"""Edges of the cloud near a measured point: what snapping asks of the image.

Neighbours come from the pulses: a few pulses before and after, in this turn and in the turns
around it (cells and rows of cells in a top view). All else is measured in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.image.edge_kernels import (
    ACROSS,
    BEND,
    CORNER_COLUMNS,
    HEIGHT,
    LONGEST_ARM_M,
    MOST_CORNERS,
    ORDER,
    STRENGTH,
    corners_kernel,
    roughness_kernel,
)

if TYPE_CHECKING:  # processing.points.drive makes images, so importing it here would be a circle
    from processing.points.drive import Drive

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

LEAST_STRENGTH_M = 0.010
"""An edge bends the surface at least so far from the straight: sine of the bend times the shorter
of the two surfaces (10 cm at most). Steps of 2 cm and more are well above it, joints below."""

_NONE = -1
_FEWEST = 30  # points from which a direction and a profile can be told
_ENOUGH, _MOST = 160, 500
PATCH_M = 0.5  # radius of what is looked at as one straight piece of edge
_LEAST_ALONG_M = 0.2
_ACROSS_AGAIN_M = (0.25, 0.15)  # half widths of the second look
_SAME_M = 0.05
_TRUSTED_M = 0.25  # edges farther from the middle of a patch are left to the next patch
_MOST_REACH_M = 2.0
_NEIGHBOURS = 20  # points in the circle from which a normal is found
NOISE_M = 0.004
"""How far points of a mobile mapping system lie off a smooth surface, one after the other."""
_NOISE_MARGIN, _MOST_NOISE_M = 1.1, 0.008
_MOST_SPREAD_M = 0.020  # beyond: plants, parts of several things
_TRIED_HEADINGS = np.radians(np.arange(-15.0, 15.1, 2.5))
_COMPARABLE = 0.5
_ON_EDGE_M = 0.5  # the chosen point lies within so much along the edge
_ROWS_ASIDE = 10
_DENSE_M, _EVENLY_FILLED = 0.015, 0.6
_COMPANY, _COMPANY_M = 3, 0.05  # others that lie so near a point bear it out
_FOLDED = math.radians(110.0)  # sharper bends come from rows that don't fit on one profile


@dataclass(frozen=True)
class Section:
    """The profile across an edge.

    Attributes
    ----------
    center : (3,) float64
        m; what the frame is about.
    heading_rad, grade, curvature : float
        Direction of the edge: counter-clockwise from the easting; rise per metre; 1/m.
    corners : (k, CORNER_COLUMNS) float64
        See `edge_kernels`.
    spread_m : float
        How far points lie off the profile, its pieces being paid for.
    """

    center: _Floats
    heading_rad: float
    grade: float
    curvature: float
    corners: _Floats
    spread_m: float

    @property
    def direction(self) -> _Floats:
        """(3,) unit vector along the edge."""
        along = np.array([math.cos(self.heading_rad), math.sin(self.heading_rad), self.grade])
        return np.asarray(along / np.linalg.norm(along))

    @property
    def places(self) -> _Floats:
        """(k, 3) the corners, m, project CRS."""
        left = np.array([-math.sin(self.heading_rad), math.cos(self.heading_rad), 0.0])
        up = np.array([0.0, 0.0, 1.0])
        corners = self.corners
        return np.asarray(
            self.center + corners[:, ACROSS, None] * left + corners[:, HEIGHT, None] * up
        )


def strongest_bend(drive: Drive, point: int, within_px: int = 8) -> int:
    """The measured point on the edge of the cloud beside a point: curb edge, wall foot, wall top.

    Parameters
    ----------
    point : int
        A point of the drive.
    within_px : int
        The edge passes the point's row within so many pixels on either side.

    Returns
    -------
    int
        −1 where the surface doesn't bend: on a flat road, in leaves, on a wire.

    Notes
    -----
    1. Points of the rows around are looked at along the direction in which the surface stays the
       same (that of the least eigenvalue of the sum of n·nᵀ over the surface normals n), so they
       fall on one profile, much denser than one row.
    2. The profile is cut into straight pieces; neighbouring pieces cross on the edge.
    3. Of the edges at least half as strong as the strongest, the nearest is taken; and of the
       points around it the one that lies best on it. Points of the same row may be 10 cm apart,
       so it may be one of a row beside.
    """
    row = _row_around(drive, point, within_px)
    around = neighbours(drive, point, row.reach_m + PATCH_M)
    xyz = drive.xyz(around)
    edges: list[_Edge] = []
    for offset in _outward(row.xyz, row.middle):
        edges += _edges_beside(xyz, row, row.xyz[offset], within_px)
        # No edge is twice as strong as these.
        if any(edge.strength_m >= _COMPARABLE * LONGEST_ARM_M for edge in edges):
            break
    if not edges:
        return _NONE
    strongest = max(edge.strength_m for edge in edges)
    edge = min(
        (edge for edge in edges if edge.strength_m >= _COMPARABLE * strongest),
        key=lambda edge: edge.distance_m,
    )
    return int(around[_best_on_edge(xyz, row.xyz, edge.place, edge.direction)])


def lowest_point(drive: Drive, point: int, radius_m: float) -> int:
    """The lowest measured point in the upright cylinder around a point: the bottom of a gutter.

    Parameters
    ----------
    radius_m : float
        Of the cylinder; points more than so much above or below don't count either, lest a
        bridge's deck should snap to the road beneath it.

    Returns
    -------
    int
        The point itself where it is the lowest.

    Notes
    -----
    A point counts only if three others lie within 5 cm of it, or within twice the distance that
    points have there: returns from below the surface (multipath, mirrors in puddles) come alone,
    and one of them would carry the gutter away by decimetres. The bottom itself is always
    measured many times. Nothing is averaged: what is returned was measured.
    """
    return _extreme_point(drive, point, radius_m, -1.0)


def highest_point(drive: Drive, point: int, radius_m: float) -> int:
    """The highest measured point in the upright cylinder around a point: the top of a wall.

    Parameters and the treatment of single points as for `lowest_point`.
    """
    return _extreme_point(drive, point, radius_m, 1.0)


def _extreme_point(drive: Drive, point: int, radius_m: float, sign: float) -> int:
    around = neighbours(drive, point, radius_m * math.sqrt(2.0))
    xyz = drive.xyz(around)
    away = xyz - xyz[np.searchsorted(around, point)]
    inside = np.flatnonzero(np.hypot(away[:, 0], away[:, 1]) <= radius_m)
    inside = inside[np.abs(away[inside, 2]) <= radius_m]
    spacing = math.sqrt(math.pi / max(1, inside.size)) * radius_m
    company = max(_COMPANY_M, 2.0 * spacing)
    for candidate in inside[np.argsort(-sign * away[inside, 2], kind="stable")]:
        distances = np.linalg.norm(away - away[candidate], axis=1)
        if int((distances <= company).sum()) > _COMPANY:
            return int(around[candidate])
    return point


@dataclass(frozen=True)
class _Edge:
    """An edge that passes a row: place and direction, strength, distance from the row's middle."""

    place: _Floats
    direction: _Floats
    strength_m: float
    distance_m: float


def _edges_beside(xyz: _Floats, row: _Row, center: _Floats, within_px: int) -> list[_Edge]:
    """Strong edges near a place that pass the row within the pixels, each looked at again."""
    section = section_at(xyz, center)
    if section is None:
        return []
    edges = []
    for k in np.flatnonzero(section.corners[:, STRENGTH] >= LEAST_STRENGTH_M):
        seen = _seen_again(xyz, section, int(k))
        if seen is None:
            continue
        place, direction, strength = seen
        off = _off_line(row.xyz, place, direction)
        if abs(row.offsets[off.argmin()]) <= within_px + 1:
            edges.append(_Edge(place, direction, strength, float(off[row.middle])))
    return edges


def _seen_again(
    xyz: _Floats, section: Section, corner: int
) -> tuple[_Floats, _Floats, float] | None:
    """The same corner in a narrow profile around it; None where it isn't there."""
    if np.hypot(*section.corners[corner, [ACROSS, HEIGHT]]) > _TRUSTED_M:
        return None
    place = section.places[corner]
    local = xyz - place
    local = np.ascontiguousarray(local[(local**2).sum(axis=1) <= PATCH_M**2])
    frame = np.array([section.heading_rad, section.grade, section.curvature])
    for across in _ACROSS_AGAIN_M:
        reach = (length_needed(local, frame), across)
        again = section_along(local, frame, reach, int(section.corners[corner, ORDER]))
        if again is None:
            continue
        is_same = (again.corners[:, BEND] * section.corners[corner, BEND] > 0) & (
            again.corners[:, STRENGTH] >= LEAST_STRENGTH_M
        )
        away = np.hypot(again.corners[:, ACROSS], again.corners[:, HEIGHT])
        strengths = np.where(is_same & (away <= _SAME_M), again.corners[:, STRENGTH], 0.0)
        if strengths.max(initial=0.0) > 0:
            k = int(strengths.argmax())
            strength = max(float(strengths[k]), float(section.corners[corner, STRENGTH]))
            return place + again.places[k], again.direction, strength
    return None


def section_at(xyz: _Floats, center: _Floats) -> Section | None:
    """The profile of points about a place, seen along the edge that runs there.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.

    Returns
    -------
    Section or None
        None where there are too few points or they are no surfaces.
    """
    local = xyz - center
    near = (local**2).sum(axis=1) <= PATCH_M**2
    local = local[near]
    if local.shape[0] < _FEWEST:
        return None
    local = np.ascontiguousarray(local[:: max(1, local.shape[0] // _MOST)])
    frame = _first_frame(local)
    tried = np.tile(frame, (_TRIED_HEADINGS.size, 1))
    tried[:, 0] += _TRIED_HEADINGS
    costs = np.empty(tried.shape[0])
    roughness_kernel(local, NOISE_M, tried, costs)
    best: Section | None = None
    for start in (frame, tried[costs.argmin()]):
        if _runs_with_rows(local, start):
            continue
        found = section_along(local, start, (length_needed(local, start), PATCH_M), 0)
        if found is not None and (best is None or found.spread_m < best.spread_m):
            best = found
    if best is None or best.spread_m > _MOST_SPREAD_M:
        return None
    return replace(best, center=center)


def section_along(
    local: _Floats, frame: _Floats, reach: tuple[float, float], order: int
) -> Section | None:
    """The profile of points about the origin when the direction of the edge is nearly known."""
    corners = np.empty((MOST_CORNERS, CORNER_COLUMNS))
    noise = NOISE_M
    for _ in range(2):
        turned = frame.copy()
        limits = np.array([reach[0], reach[1], min(0.5, reach[1]), noise, order])
        count, price, spread = corners_kernel(local, limits, turned, corners)
        if not math.isfinite(price):
            return None
        if spread <= noise:
            break
        # Rougher ground or another scanner: again, by what was found.
        noise = min(_MOST_NOISE_M, _NOISE_MARGIN * spread)
    is_edge = np.abs(corners[:count, BEND]) <= _FOLDED
    return Section(
        center=np.zeros(3),
        heading_rad=float(turned[0]),
        grade=float(turned[1]),
        curvature=float(turned[2]),
        corners=corners[:count][is_edge],
        spread_m=noise * math.sqrt(price),
    )


def _runs_with_rows(local: _Floats, frame: _Floats) -> bool:
    """Whether points fall on few places of the profile, since rows run along that direction."""
    across = local[:, 1] * math.cos(frame[0]) - local[:, 0] * math.sin(frame[0])
    bins = round(2 * PATCH_M / _DENSE_M)
    filled = np.unique((across / _DENSE_M).astype(np.int64)).size
    return filled < _EVENLY_FILLED * bins * (1 - math.exp(-across.size / bins))


def length_needed(local: _Floats, frame: _Floats) -> float:
    """Half the length of edge that has enough points: the shorter, the straighter it is."""
    along = np.abs(local[:, 0] * math.cos(frame[0]) + local[:, 1] * math.sin(frame[0]))
    if along.size <= _ENOUGH:
        return PATCH_M
    return max(_LEAST_ALONG_M, float(np.partition(along, _ENOUGH)[_ENOUGH]))


def _first_frame(local: _Floats) -> _Floats:
    """Heading and grade of the direction square to all normals."""
    step = max(1, local.shape[0] // _ENOUGH)
    thinned = local[::step]
    spacing = math.sqrt(math.pi * float((thinned[:, :2] ** 2).sum(axis=1).max()) / len(thinned))
    scatters = _scatters(thinned, max(0.08, spacing * math.sqrt(_NEIGHBOURS / math.pi)))
    values, vectors = np.linalg.eigh(scatters)
    is_surface = values[:, 1] > 0.02 * values[:, 2]
    if not is_surface.any():
        return np.zeros(3)
    normals = vectors[is_surface, :, 0]
    along = np.linalg.eigh(normals.T @ normals)[1][:, 0]
    level = math.hypot(along[0], along[1])
    grade = float(along[2]) / level if level > 0.7 else 0.0
    heading = math.atan2(along[1], along[0])
    return np.array([heading, grade, 0.0])


def _scatters(xyz: _Floats, radius: float) -> _Floats:
    """(n, 3, 3) covariance of the neighbours of every point."""
    squares = (xyz**2).sum(axis=1)
    apart = squares[:, None] + squares - 2 * xyz @ xyz.T
    is_near = (apart <= radius**2).astype(np.float64)
    counts = is_near.sum(axis=1)[:, None]
    means = is_near @ xyz / counts
    products = is_near @ np.einsum("ij,ik->ijk", xyz, xyz).reshape(-1, 9) / counts
    return np.asarray(products.reshape(-1, 3, 3) - np.einsum("ij,ik->ijk", means, means))


@dataclass(frozen=True)
class _Row:
    """Points of a row near a point: their distance in pixels, and places."""

    offsets: _Integers
    xyz: _Floats
    middle: int

    @property
    def reach_m(self) -> float:
        """How far the row goes from its middle."""
        away = self.xyz - self.xyz[self.middle]
        return min(_MOST_REACH_M, float(np.linalg.norm(away, axis=1).max()))


def _row_around(drive: Drive, point: int, within_px: int) -> _Row:
    pulses = drive.columns["pulse"]
    here = int(pulses[point])
    start, stop = np.searchsorted(pulses, [here - within_px - 1, here + within_px + 2])
    xyz = drive.xyz(slice(int(start), int(stop)))
    return _Row(np.asarray(pulses[start:stop], np.int64) - here, xyz, point - int(start))


def _outward(xyz: _Floats, middle: int) -> list[int]:
    """Places along a row from its middle to both sides, so far apart that patches overlap well."""
    chosen = [middle]
    order = np.argsort(np.linalg.norm(xyz - xyz[middle], axis=1), kind="stable")
    for k in order:
        if np.linalg.norm(xyz[k] - xyz[middle]) > _MOST_REACH_M:
            break
        if np.linalg.norm(xyz[chosen] - xyz[k], axis=1).min() >= _TRUSTED_M * 0.8:
            chosen.append(int(k))
    return chosen


def neighbours(drive: Drive, point: int, radius_m: float) -> _Integers:
    """Points within a distance of a point, in rising order, taken from the rows around its own.

    Rows are skipped where they are so close that others reach as far.

    Returns
    -------
    (k,) int64
    """
    pulses = drive.columns["pulse"]
    turns = drive.turns
    period = turns.pulses_per_turn if turns is not None else float(drive.info.cells_per_row)
    here, place = int(pulses[point]), drive.xyz(np.array([point]))[0]
    span = max(2, int(period / 4))
    stride, aside = rows_to_take(drive, point, radius_m)
    middles = here + np.rint(period * stride * np.arange(-aside, aside + 1)).astype(np.int64)
    edges = np.searchsorted(pulses, np.concatenate([middles - span, middles + span + 1]))
    parts = []
    for start, stop in edges.reshape(2, -1).T:
        if stop > start:
            xyz = drive.xyz(slice(int(start), int(stop)))
            near = ((xyz - place) ** 2).sum(axis=1) <= radius_m**2
            parts.append(np.flatnonzero(near) + start)
    return np.unique(np.concatenate(parts)) if parts else np.empty(0, np.int64)


def rows_to_take(drive: Drive, point: int, radius_m: float) -> tuple[int, int]:
    """Stride between rows, and how many of them on each side reach as far as the radius."""
    pulses = drive.columns["pulse"]
    turns = drive.turns
    period = turns.pulses_per_turn if turns is not None else float(drive.info.cells_per_row)
    here, place = int(pulses[point]), drive.xyz(np.array([point]))[0]
    span = max(2, int(period / 8))
    stride = 1
    while stride < 256:
        for side in (1, -1):
            middle = here + round(side * stride * period)
            start, stop = np.searchsorted(pulses, [middle - span, middle + span + 1])
            if stop > start:
                xyz = drive.xyz(slice(int(start), int(stop)))
                gap = float(np.linalg.norm(xyz - place, axis=1).min())
                if gap * _ROWS_ASIDE * 2 >= radius_m:
                    return stride, min(2 * _ROWS_ASIDE, max(2, math.ceil(radius_m / gap)))
        stride *= 2
    return 1, _ROWS_ASIDE


def _off_line(xyz: _Floats, place: _Floats, direction: _Floats) -> _Floats:
    """(n,) distances of points from a line."""
    away = xyz - place
    along = away @ direction
    return np.asarray(np.linalg.norm(away - along[:, None] * direction, axis=1))


def _best_on_edge(xyz: _Floats, row_xyz: _Floats, place: _Floats, direction: _Floats) -> int:
    """The point that lies best on an edge, near where the row passes it."""
    passing = row_xyz[_off_line(row_xyz, place, direction).argmin()]
    along = np.abs((xyz - place) @ direction - float((passing - place) @ direction))
    # A point 10 cm along the edge is as good as one 1 mm farther off it.
    away = _off_line(xyz, place, direction) + 0.01 * along
    return int(np.where(along <= _ON_EDGE_M, away, np.inf).argmin())
