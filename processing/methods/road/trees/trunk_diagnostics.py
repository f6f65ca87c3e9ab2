"""Why a trunk is as thick as it is: the circles of its slabs, for the diagnostic layer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.methods.road.asked_points import points_beside
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.objects.foot import foot_height
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.trees.circle_kernels import ARC, EAST, INLIERS, NORTH, RADIUS
from processing.methods.road.trees.stem_bodies import BREAST_M
from processing.methods.road.trees.stems import (
    STEP_M,
    FittedStem,
    slab_circles,
    stems_of,
)
from processing.methods.road.trees.trunks import Trunk, trunk_of

_TRUNK_M = 0.9
"""Points so near to the place in plan are looked at, as those of a column are."""

_SAME_M = 0.03
"""A circle whose middle and radius are no farther off is the trunk's."""

_LEAST_ARC = 0.12
_LOWEST_SHARE = 0.02
"""Of the points: about the ground, which foot_height then finds."""

_RING = 24
"""Corners of a circle as it is drawn."""

_DIAMETER = Text("Diameter of the circle", "円の直径")
_SEEN = Text("Share of its circumference that was seen", "円周のうち計測された割合")
_OFF = Text("Off the trunk that all points give", "全点から求めた幹とのずれ")
_NUMBER = Text("Points on the circle", "円上の点数")
_FEWEST = 5


def trunk_diagnostics(asked: RequestedPosition, most_diameter_m: float) -> tuple[Diagnostic, ...]:
    """The circles of the slabs about a place, from below.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    local = points_beside(asked, _TRUNK_M)
    if not len(local):
        return ()
    foot = foot_height(local, np.zeros(2), float(np.quantile(local[:, 2], _LOWEST_SHARE)))
    points = local - (0.0, 0.0, foot)
    ground = asked.xyz + np.array([0.0, 0.0, foot])
    trunk = trunk_of(stems_of(points, most_diameter_m))
    slabs = slab_circles(points, most_diameter_m)
    found: list[Diagnostic] = []
    for height, circles in zip(slabs.heights.tolist(), slabs.circles, strict=True):
        for circle in circles[circles[:, RADIUS] > 0]:
            place = ground + np.array([circle[EAST], circle[NORTH], height])
            one = _diagnostic_of(circle, height, place, trunk, most_diameter_m)
            if one.is_taken:
                on = points[_points_on(circle, height, points, trunk)]
                one = replace(one, points=on + ground)
            found.append(one)
    return tuple(found)


def _points_on(circle: Floats, height_m: float, points: Floats, trunk: Trunk | None) -> Integers:
    """Which points of a slab the stem stands on that is nearest to a circle."""
    stems = trunk.stems if trunk else ()
    if not stems:
        return np.empty(0, np.int64)
    lines = min(stems, key=lambda stem: _off(circle, height_m, stem)).lines
    on: Integers = lines[np.abs(points[lines, 2] - height_m) <= STEP_M / 2]
    return on


def _diagnostic_of(
    circle: Floats, height_m: float, place: Floats, trunk: Trunk | None, most_diameter_m: float
) -> Diagnostic:
    stems = trunk.stems if trunk else ()
    off = min((_off(circle, height_m, stem) for stem in stems), default=np.nan)
    diameter, arc = 2 * float(circle[RADIUS]), float(circle[ARC])
    number = float(circle[INLIERS])
    is_taken = bool(off <= _SAME_M)
    return Diagnostic(
        place,
        (
            DiagnosticTest(_DIAMETER, diameter, most_diameter_m, "m", diameter <= most_diameter_m),
            DiagnosticTest(_SEEN, arc, _LEAST_ARC, "", arc >= _LEAST_ARC),
            DiagnosticTest(_NUMBER, number, _FEWEST, "", number >= _FEWEST),
            DiagnosticTest(_OFF, off, _SAME_M, "m", is_taken),
        ),
        is_taken,
        _ring(place, float(circle[RADIUS])),
    )


def _ring(middle: Floats, radius_m: float) -> Floats:
    """(n, 3) a level circle."""
    turn = 2 * np.pi * np.arange(_RING) / _RING
    level = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(_RING)])
    ring: Floats = middle + radius_m * level
    return ring


def _off(circle: Floats, height_m: float, stem: FittedStem) -> float:
    """How far a circle is off a stem, in place or radius."""
    beside = circle[[EAST, NORTH]] - stem.middle_at(height_m)
    swell = circle[RADIUS] - stem.radius_m + stem.taper * (height_m - BREAST_M)
    return float(max(np.hypot(*beside), abs(swell)))
