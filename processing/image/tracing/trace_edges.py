"""Following an edge of the cloud: the corner of the profile across it, again and again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats
from processing.image.edges.edge_kernels import AFTER, BEFORE, BEND, STRENGTH
from processing.image.edges.edge_sections import (
    LEAST_STRENGTH_M,
    PATCH_M,
    EdgeProfile,
    length_needed,
    section_along,
    section_at,
)
from processing.image.edges.edge_steps import LONGER_M, EdgeStep, step_at
from processing.image.tracing.trace_points import PointsBetween
from processing.image.tracing.trace_search import TracePoint, off_line

_BESIDE_M = 0.12
"""Lines this near to a click are meant: less than half the height of a curb beside its other edge.
By trial; no measurement is recorded."""

_LOOKED_AROUND_M = (0.0, 0.3, 0.6)
"""Where nothing is found at a click sections are made so far around it, m. By trial; no measurement
is recorded."""

_ACROSS_M = (0.25, 0.12)
"""Half widths of the section, m: as `_ACROSS_AGAIN_M` of `edges`, somewhat closer. By trial; no
measurement is recorded."""

_UNLIKE = math.radians(30.0)
"""Directions before and after an edge that differ by this much together are as unlike as one
standard deviation. By trial; no measurement is recorded."""

_MOST_UNLIKE = 3.0
"""In half squares of that: two and a half standard deviations."""

_ALIKE = 0.3
"""Where an edge so like is found, the closer section is not made. By trial; no measurement is
recorded."""

_SEEN_M = 0.2
"""A place of an edge has a measured point so near, else it is made up. By trial; no measurement is
recorded."""

_MOST_POINTS, _FEW_POINTS = 400, 90
"""Points of a section at most, for the time; from so few on points are looked for farther around:
as `_DENSE` of `edges`."""


class EdgeFollower:
    """Follows curb edges, wall feet and wall tops.

    The look of an edge: 1 for a hollow one, −1 for a raised one; directions of the two surfaces
    in the profile, rad.
    """

    def __init__(self, cloud: PointsBetween) -> None:
        self._cloud = cloud

    def positions_at(self, xyz: Floats) -> Sequence[TracePoint]:
        """Edges that pass a place within 12 cm, the nearest first.

        A place may be the very end of an edge, or a car may stand there: then what passes it is
        looked for a little way off.
        """
        for distance in _LOOKED_AROUND_M:
            found = []
            for turn in range(1 if distance == 0 else 8):
                angle = turn * math.pi / 4
                center = xyz + distance * np.array([math.cos(angle), math.sin(angle), 0.0])
                found += self._edges_about(center, xyz)
            if found:
                return sorted(found, key=lambda position: off_line(xyz, position))
        return []

    def positions_near(
        self, expected: TracePoint, slack_m: float
    ) -> Sequence[tuple[TracePoint, float]]:
        """Edges of the same kind within so much of an expected one, with how unlike they look."""
        local = self._around(expected.xyz)
        if not local.size:
            return []
        frame = np.array([expected.heading_rad, expected.grade, expected.curvature])
        # A narrow profile where what stands or rises beside the edge spoils the wide one.
        for across in _ACROSS_M:
            reach = (length_needed(local, frame, LONGER_M), across + slack_m)
            section = section_along(local, frame, reach, 0)
            found = [] if section is None else _like(_positions_of(section), expected, slack_m)
            if found:
                break
        if not found or min(unlike for _, unlike in found) > _ALIKE:
            step = step_at(local, np.zeros(3))
            if isinstance(step, EdgeStep):
                found += _like(_positions_of_step(step, expected.heading_rad), expected, slack_m)
        # A long piece would lead on beyond the last points.
        return [one for one in found if self._cloud.near(one[0].xyz, _SEEN_M).size]

    def _around(self, xyz: Floats) -> Floats:
        """Points about a place, about it; of a longer piece where they are few."""
        near = self._cloud.near(xyz, PATCH_M)
        if near.size < _FEW_POINTS:
            near = self._cloud.near(xyz, LONGER_M)
        local = self._cloud.xyz[near] - xyz
        return np.ascontiguousarray(local[:: max(1, local.shape[0] // _MOST_POINTS)])

    def _edges_about(self, center: Floats, xyz: Floats) -> list[TracePoint]:
        step = step_at(self._cloud.xyz[self._cloud.near(center, LONGER_M)], center)
        if isinstance(step, EdgeStep):
            positions = _positions_of_step(step, step.heading_rad)
        else:
            section = section_at(self._cloud.xyz[self._cloud.near(center, PATCH_M)], center)
            positions = [] if section is None else _positions_of(section)
        near = 2 * _BESIDE_M + float(np.linalg.norm(center - xyz))
        return [
            position
            for position in positions
            if off_line(xyz, position) <= _BESIDE_M and np.linalg.norm(position.xyz - xyz) <= near
        ]

    def turned(self, position: TracePoint) -> TracePoint:
        """The same edge for the opposite direction."""
        return _turn_position(position)


def _positions_of(section: EdgeProfile) -> list[TracePoint]:
    positions = []
    for corner, xyz in zip(section.corners, section.positions, strict=True):
        if corner[STRENGTH] >= LEAST_STRENGTH_M:
            look = (math.copysign(1.0, corner[BEND]), float(corner[BEFORE]), float(corner[AFTER]))
            positions.append(
                TracePoint(xyz, section.heading_rad, section.grade, section.curvature, look)
            )
    return positions


def _positions_of_step(step: EdgeStep, heading_rad: float) -> list[TracePoint]:
    """Both edges of a step, in that one of its directions that is nearer to a heading."""
    is_turned = math.cos(step.heading_rad - heading_rad) < 0
    lower, face, upper = step.slopes_rad
    looks = ((1.0, lower, face), (-1.0, face, upper))
    positions = []
    for xyz, grade, look in zip((step.lower, step.upper), step.grades, looks, strict=True):
        position = TracePoint(xyz, step.heading_rad, grade, 0.0, look)
        positions.append(_turn_position(position) if is_turned else position)
    return positions


def _turn_position(position: TracePoint) -> TracePoint:
    kind, before, after = position.look
    return TracePoint(
        position.xyz,
        position.heading_rad + math.pi,
        -position.grade,
        -position.curvature,
        (kind, -after, -before),
    )


def _difference(look: tuple[float, ...], other: tuple[float, ...]) -> float:
    if look[0] != other[0]:
        return math.inf
    turned = [
        abs(math.remainder(a - b, 2 * math.pi)) for a, b in zip(look[1:], other[1:], strict=True)
    ]
    return float(sum(turned) / _UNLIKE) ** 2 / 2


def _like(
    positions: Sequence[TracePoint], expected: TracePoint, slack_m: float
) -> list[tuple[TracePoint, float]]:
    found = []
    for position in positions:
        unlike = _difference(position.look, expected.look)
        if np.linalg.norm(position.xyz) <= slack_m and unlike <= _MOST_UNLIKE:
            found.append((replace(position, xyz=position.xyz + expected.xyz), unlike))
    return found
