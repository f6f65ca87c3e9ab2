"""Edges of the cloud near a measured point: what snapping asks of the image.

Neighbours come from the pulses: a few pulses before and after, in this revolution and in those
around it (cells and rows of cells in a top view). All else is measured in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.image.edges.edge_kernels import ACROSS, BEND, HEIGHT, LONGEST_ARM_M, ORDER, STRENGTH
from processing.image.edges.edge_sections import (
    LEAST_STRENGTH_M,
    PATCH_M,
    EdgeProfile,
    length_needed,
    section_along,
    section_at,
)
from processing.image.edges.edge_steps import EdgeStep, StepGround, reach_needed, step_at
from processing.image.neighbourhoods.points_around import neighbours
from processing.recording.columns.damaged_pulses import damaged_pulses

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive


"""No point."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_TRUSTED_M = 0.25
"""Edges farther from the middle of a patch are left to the next patch: half of its radius."""

_MOST_REACH_M, _APART_M = 2.0, 0.24
"""How far a row is followed to either side, and how far apart patches are along it: half a patch,
so that each place is near the middle of one."""

_FARTHER = 1.2
"""Points are read again where a step needs so many times the radius of a patch."""

_ACROSS_AGAIN_M = (0.25, 0.15)
"""Half widths of the second look, m: with one edge only, and closer. By trial."""

_SAME_M = 0.05
"""An edge seen again lies within so much of where it was: less than half a face. By trial."""

_DENSE, _LEAST_WHERE_SPARSE_M = 90, 0.06
"""Of fewer points a patch is cut to splinters now and then, which only look like low edges; real
ones are found as steps, and only edges at least so strong, m, as profiles. By trial."""

_COMPARABLE = 0.5
"""Edges at least so strong, as a share of the strongest, are alike: of them the nearest is
taken."""

_AS_NEAR = 0.05
"""A metre along the row counts like so much off an edge."""

_ON_EDGE_M = 0.05
"""A row that runs along an edge is on it within so much. By trial."""

_LEAST_CUT, _TANGENT_POINTS = 0.2, 3
"""Sine of the angle at which a row must cut an edge (12°), its direction being taken over so many
points to either side. By trial."""

_COMPANY, _COMPANY_M, _COMPANY_SPACINGS = 3, 0.05, 2.0
"""So many others that lie within this, or within so many spacings, bear a point out: returns from
below the surface come alone."""


@dataclass(frozen=True)
class EdgePosition:
    """A place on an edge of the cloud.

    Attributes
    ----------
    point : int
        The measured point nearest to it.
    xyz : tuple of float
        m, project CRS: where the row that was clicked cuts the edge that was fitted to the points
        around; on the far side of a street measured points lie several cm apart.
    """

    point: int
    xyz: tuple[float, float, float]


def edge_beside(drive: Drive, point: int, within_px: int = 8) -> EdgePosition | None:
    """The edge of the cloud beside a point: curb edge, wall foot, wall top.

    Parameters
    ----------
    point : int
        A point of the drive.
    within_px : int
        The edge passes the point's row within so many pixels on either side.

    Returns
    -------
    EdgePosition or None
        None where the surface doesn't bend: on a flat road, in leaves, on a wire.

    Notes
    -----
    1. Points of the rows around are looked at along the direction in which the surface stays the
       same (that of the least eigenvalue of the sum of n·nᵀ over the surface normals n), so they
       fall on one profile, much denser than one row.
    2. The profile is cut into straight pieces; neighbouring pieces cross on the edge.
    3. Where such pieces would tell nothing, since all points lie within centimetres of a plane, a
       low step is looked for as a whole: a dropped curb.
    4. Of the edges at least half as strong as the strongest, the nearest is taken, where the row
       cuts it. Points of the row may be 10 cm apart, so the measured point nearest to that place
       may be one of a row beside.
    """
    row = _row_around(drive, point, within_px)
    around, xyz = _around_row(drive, point, row.reach_m)
    edges: list[_Edge] = []
    for offset in _outward(row.xyz, row.middle):
        ground = step_at(xyz, row.xyz[offset])
        if isinstance(ground, EdgeStep):
            edges += _edges_of_step(xyz, row, ground, within_px)
        elif ground is StepGround.OTHER:
            edges += _edges_beside(xyz, row, row.xyz[offset], within_px)
        # No edge is twice as strong as these.
        if any(edge.strength_m >= _COMPARABLE * LONGEST_ARM_M for edge in edges):
            break
    if not edges:
        return None
    strongest = max(edge.strength_m for edge in edges)
    edge = min(
        (edge for edge in edges if edge.strength_m >= _COMPARABLE * strongest),
        key=lambda edge: edge.distance_m,
    )
    position = row.nearest_on(edge.position, edge.direction)
    nearest = int(np.linalg.norm(xyz - position, axis=1).argmin())
    easting, northing, height = position.tolist()
    return EdgePosition(int(around[nearest]), (easting, northing, height))


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
    company = max(_COMPANY_M, _COMPANY_SPACINGS * spacing)
    for candidate in inside[np.argsort(-sign * away[inside, 2], kind="stable")]:
        distances = np.linalg.norm(away - away[candidate], axis=1)
        if int((distances <= company).sum()) > _COMPANY:
            return int(around[candidate])
    return point


@dataclass(frozen=True)
class _Edge:
    """An edge that passes a row: place and direction, strength, distance from the row's middle."""

    position: Floats
    direction: Floats
    strength_m: float
    distance_m: float


def _edges_beside(xyz: Floats, row: _Row, center: Floats, within_px: int) -> list[_Edge]:
    """Strong edges near a place that pass the row within the pixels, each looked at again.

    Where one of a section's edges is confirmed, its other plain ones are believed.
    """
    section = section_at(xyz, center)
    if section is None:
        return []
    near = np.hypot(section.corners[:, ACROSS], section.corners[:, HEIGHT]) <= _TRUSTED_M
    strengths = section.corners[:, STRENGTH]
    number = int((((xyz - center) ** 2).sum(axis=1) <= PATCH_M**2).sum())
    least = LEAST_STRENGTH_M if number >= _DENSE else _LEAST_WHERE_SPARSE_M
    corners = np.flatnonzero(near & (strengths >= least))
    again = {int(k): _seen_again(xyz, row, section, int(k)) for k in corners}
    if all(seen is None for seen in again.values()):
        return []
    edges = []
    for k, seen in again.items():
        if seen is None and strengths[k] >= _COMPARABLE * LONGEST_ARM_M:
            seen = _SeenEdge(section.positions[k], section.direction, float(strengths[k]))
        if seen is not None and (edge := _passing(row, seen, within_px)) is not None:
            edges.append(edge)
    return edges


def _around_row(drive: Drive, point: int, reach_m: float) -> tuple[Integers, Floats]:
    """Points about a row, farther where they are few, and where they are."""
    around = neighbours(drive, point, reach_m + PATCH_M)
    xyz = drive.xyz(around)
    needed = reach_needed(xyz, xyz[np.searchsorted(around, point)])
    if needed > _FARTHER * PATCH_M:
        around = neighbours(drive, point, reach_m + needed)
        xyz = drive.xyz(around)
    return around, xyz


def _edges_of_step(xyz: Floats, row: _Row, step: EdgeStep, within_px: int) -> list[_Edge]:
    """Both edges of a step where the row cuts it; tested as a whole, they count like plain ones."""
    again = step_at(xyz, row.nearest_on(*step.edges[0]))
    step = again if isinstance(again, EdgeStep) else step
    strength = max(step.height_m, _COMPARABLE * LONGEST_ARM_M)
    passing = [_passing(row, _SeenEdge(*edge, strength), within_px) for edge in step.edges]
    return [edge for edge in passing if edge is not None]


class _SeenEdge(NamedTuple):
    """An edge: a place of it, m, its direction, its strength, m."""

    position: Floats
    direction: Floats
    strength_m: float


def _passing(row: _Row, seen: _SeenEdge, within_px: int) -> _Edge | None:
    """The edge, if the row cuts it within the pixels; a row that runs along it doesn't."""
    position, direction, strength = seen
    off = _off_line(row.xyz, position, direction)
    nearest = row.nearest_to(position, direction)
    first, last = max(0, nearest - _TANGENT_POINTS), min(off.size - 1, nearest + _TANGENT_POINTS)
    tangent = row.xyz[last, :2] - row.xyz[first, :2]
    sine = abs(tangent[0] * direction[1] - tangent[1] * direction[0])
    is_cut = sine >= _LEAST_CUT * float(np.linalg.norm(row.xyz[last] - row.xyz[first]))
    if not (is_cut or off[nearest] <= _ON_EDGE_M) or abs(row.offsets[nearest]) > within_px + 1:
        return None
    return _Edge(position, direction, strength, float(off[row.middle]))


def _seen_again(xyz: Floats, row: _Row, section: EdgeProfile, corner: int) -> _SeenEdge | None:
    """The same corner in a narrow profile where the row cuts it; None where it isn't there."""
    position = row.nearest_on(section.positions[corner], section.direction)
    local = xyz - position
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
            return _SeenEdge(position + again.positions[k], again.direction, strength)
    return None


@dataclass(frozen=True)
class _Row:
    """Points of a row near a point: their distance in pixels, and places."""

    offsets: Integers
    xyz: Floats
    middle: int

    @property
    def reach_m(self) -> float:
        """How far the row goes from its middle."""
        away = self.xyz - self.xyz[self.middle]
        return min(_MOST_REACH_M, float(np.linalg.norm(away, axis=1).max()))

    def nearest_to(self, position: Floats, direction: Floats) -> int:
        """The point of the row nearest to a line; near the middle where the row runs along it."""
        aside = np.linalg.norm(self.xyz - self.xyz[self.middle], axis=1)
        return int((_off_line(self.xyz, position, direction) + _AS_NEAR * aside).argmin())

    def nearest_on(self, position: Floats, direction: Floats) -> Floats:
        """(3,) where the row comes nearest to a line."""
        nearest = self.nearest_to(position, direction)
        return np.asarray(position + ((self.xyz[nearest] - position) @ direction) * direction)


def _row_around(drive: Drive, point: int, within_px: int) -> _Row:
    pulses = drive.columns["pulse"]
    here = int(pulses[point])
    start, stop = np.searchsorted(pulses, [here - within_px - 1, here + within_px + 2])
    if not start <= point < stop:
        raise damaged_pulses(drive.folder)
    xyz = drive.xyz(slice(int(start), int(stop)))
    return _Row(np.asarray(pulses[start:stop], np.int64) - here, xyz, point - int(start))


def _outward(xyz: Floats, middle: int) -> list[int]:
    """Places along a row from its middle to both sides, so far apart that patches overlap well."""
    chosen = [middle]
    order = np.argsort(np.linalg.norm(xyz - xyz[middle], axis=1), kind="stable")
    for k in order:
        if np.linalg.norm(xyz[k] - xyz[middle]) > _MOST_REACH_M:
            break
        if np.linalg.norm(xyz[chosen] - xyz[k], axis=1).min() >= _APART_M:
            chosen.append(int(k))
    return chosen


def _off_line(xyz: Floats, position: Floats, direction: Floats) -> Floats:
    """(n,) distances of points from a line."""
    away = xyz - position
    along = away @ direction
    return np.asarray(np.linalg.norm(away - along[:, None] * direction, axis=1))
