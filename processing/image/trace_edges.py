"""Following an edge of the cloud: the corner of the profile across it, again and again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.image.edge_kernels import (
    AFTER,
    BEFORE,
    BEND,
    STRENGTH,
)
from processing.image.edge_sections import (
    LEAST_STRENGTH_M,
    PATCH_M,
    Section,
    length_needed,
    section_along,
    section_at,
)
from processing.image.edge_steps import LONGER_M, Step, step_at
from processing.image.trace_points import PointsBetween
from processing.image.trace_search import Place, off_line

_Floats = NDArray[np.float64]

_BESIDE_M = 0.12  # lines this near to a click are meant
_LOOKED_AROUND_M = (0.0, 0.3, 0.6)
_ACROSS_M = (0.25, 0.12)
_UNLIKE = math.radians(30.0)
_MOST_UNLIKE = 3.0
_ALIKE = 0.3
_SEEN_M = 0.2
_MOST_POINTS, _FEW_POINTS = 400, 90


class EdgeFollower:
    """Follows curb edges, wall feet and wall tops.

    The look of an edge: 1 for a hollow one, −1 for a raised one; directions of the two surfaces
    in the profile, rad.
    """

    def __init__(self, cloud: PointsBetween) -> None:
        self._cloud = cloud

    def places_at(self, xyz: _Floats) -> Sequence[Place]:
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
                return sorted(found, key=lambda place: off_line(xyz, place))
        return []

    def places_near(self, expected: Place, slack_m: float) -> Sequence[tuple[Place, float]]:
        """Edges of the same kind within so much of an expected one, with how unlike they look."""
        local = self._around(expected.xyz)
        if not local.size:
            return []
        frame = np.array([expected.heading_rad, expected.grade, expected.curvature])
        # A narrow profile where what stands or rises beside the edge spoils the wide one.
        for across in _ACROSS_M:
            reach = (length_needed(local, frame, LONGER_M), across + slack_m)
            section = section_along(local, frame, reach, 0)
            found = [] if section is None else _like(_places_of(section), expected, slack_m)
            if found:
                break
        if not found or min(unlike for _, unlike in found) > _ALIKE:
            step = step_at(local, np.zeros(3))
            if isinstance(step, Step):
                found += _like(_places_of_step(step, expected.heading_rad), expected, slack_m)
        # A long piece would lead on beyond the last points.
        return [one for one in found if self._cloud.near(one[0].xyz, _SEEN_M).size]

    def _around(self, xyz: _Floats) -> _Floats:
        """Points about a place, about it; of a longer piece where they are few."""
        near = self._cloud.near(xyz, PATCH_M)
        if near.size < _FEW_POINTS:
            near = self._cloud.near(xyz, LONGER_M)
        local = self._cloud.xyz[near] - xyz
        return np.ascontiguousarray(local[:: max(1, local.shape[0] // _MOST_POINTS)])

    def _edges_about(self, center: _Floats, xyz: _Floats) -> list[Place]:
        step = step_at(self._cloud.xyz[self._cloud.near(center, LONGER_M)], center)
        if isinstance(step, Step):
            places = _places_of_step(step, step.heading_rad)
        else:
            section = section_at(self._cloud.xyz[self._cloud.near(center, PATCH_M)], center)
            places = [] if section is None else _places_of(section)
        near = 2 * _BESIDE_M + float(np.linalg.norm(center - xyz))
        return [
            place
            for place in places
            if off_line(xyz, place) <= _BESIDE_M and np.linalg.norm(place.xyz - xyz) <= near
        ]

    def turned(self, place: Place) -> Place:
        """The same edge for the opposite direction."""
        return _turned(place)


def _places_of(section: Section) -> list[Place]:
    places = []
    for corner, xyz in zip(section.corners, section.places, strict=True):
        if corner[STRENGTH] >= LEAST_STRENGTH_M:
            look = (math.copysign(1.0, corner[BEND]), float(corner[BEFORE]), float(corner[AFTER]))
            places.append(Place(xyz, section.heading_rad, section.grade, section.curvature, look))
    return places


def _places_of_step(step: Step, heading_rad: float) -> list[Place]:
    """Both edges of a step, in that one of its directions that is nearer to a heading."""
    is_turned = math.cos(step.heading_rad - heading_rad) < 0
    lower, face, upper = step.slopes_rad
    looks = ((1.0, lower, face), (-1.0, face, upper))
    places = []
    for xyz, grade, look in zip((step.lower, step.upper), step.grades, looks, strict=True):
        place = Place(xyz, step.heading_rad, grade, 0.0, look)
        places.append(_turned(place) if is_turned else place)
    return places


def _turned(place: Place) -> Place:
    kind, before, after = place.look
    return Place(
        place.xyz,
        place.heading_rad + math.pi,
        -place.grade,
        -place.curvature,
        (kind, -after, -before),
    )


def _difference(look: tuple[float, ...], other: tuple[float, ...]) -> float:
    if look[0] != other[0]:
        return math.inf
    turned = [
        abs(math.remainder(a - b, 2 * math.pi)) for a, b in zip(look[1:], other[1:], strict=True)
    ]
    return float(sum(turned) / _UNLIKE) ** 2 / 2


def _like(places: Sequence[Place], expected: Place, slack_m: float) -> list[tuple[Place, float]]:
    found = []
    for place in places:
        unlike = _difference(place.look, expected.look)
        if np.linalg.norm(place.xyz) <= slack_m and unlike <= _MOST_UNLIKE:
            found.append((replace(place, xyz=place.xyz + expected.xyz), unlike))
    return found
