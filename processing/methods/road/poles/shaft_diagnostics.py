"""Why something is a pole or none: the circles of its shaft, for the diagnostic layer."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.methods.road.asked_points import points_beside
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.objects.foot import foot_height
from processing.methods.road.poles.shaft_kernels import (
    ARC,
    BESIDE_M,
    EAST,
    INSIDE,
    LEAN_EAST,
    LEAST_ARC,
    LEAST_SLABS,
    LEVEL_M,
    LOW,
    MOST_INSIDE,
    NOISE,
    NORTH,
    RADIUS,
    SLABS,
    TAPER,
    TOP,
)
from processing.methods.road.poles.shafts import (
    ABOUT_M,
    LEAST_LONG_M,
    MOST_DIAMETER_M,
    shafts_about,
)
from processing.methods.road.poles.surface_lines import SLAB_M
from processing.methods.road.requested_position import RequestedPosition

_LOWEST_SHARE = 0.02
"""Of the points: about the ground, which foot_height then finds."""

_SLICE_M = 2 * SLAB_M
"""Between the circles that are told: two scan lines and more meet each."""

_FEWEST = 3
"""Points from which a circle about a known axis is told."""

_DIAMETER = Text("Diameter of the circle", "円の直径")
_NUMBER = Text("Points on the circle", "円上の点数")
_OFF = Text("Off the straight shaft", "まっすぐな柱からのずれ")
_BESIDE = Text(
    "Points within 30 cm beside it, for each on it", "円上の1点あたりの、周囲30 cm以内の点数"
)
_LONG = Text("Length that was seen", "計測された長さ")
_SEEN = Text("Share of its heights that were seen", "高さのうち計測された割合")
_ARC = Text("Share of its circumference that was seen", "円周のうち計測された割合")
_INSIDE = Text("Points inside it, for each on it", "円上の1点あたりの内部の点数")


def shaft_diagnostics(asked: RequestedPosition) -> tuple[Diagnostic, ...]:
    """The shafts about a place: each as a whole at its foot, then its circles upwards.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    local = points_beside(asked, ABOUT_M)
    if not len(local):
        return ()
    foot = foot_height(local, np.zeros(2), float(np.quantile(local[:, 2], _LOWEST_SHARE)))
    points = local - (0.0, 0.0, foot)
    ground = asked.xyz + np.array([0.0, 0.0, foot])
    found: list[Diagnostic] = []
    for shaft in shafts_about(points):
        whole = _whole(shaft, ground)
        found += [whole, *_circles(points, shaft, ground, is_shaft=whole.is_taken)]
    return tuple(found)


def _whole(shaft: Floats, ground: Floats) -> Diagnostic:
    """A shaft at the lowest place where it was seen, and what makes it one."""
    long_m = float(shaft[TOP] - shaft[LOW])
    tests = (
        DiagnosticTest(_LONG, long_m, LEAST_LONG_M, "m", long_m >= LEAST_LONG_M),
        _at_least(_SEEN, float(shaft[SLABS]), LEAST_SLABS),
        _at_least(_ARC, float(shaft[ARC]), LEAST_ARC),
        DiagnosticTest(
            _INSIDE, float(shaft[INSIDE]), MOST_INSIDE, "", bool(shaft[INSIDE] <= MOST_INSIDE)
        ),
    )
    place = ground + _middle(shaft, float(shaft[LOW]))
    return Diagnostic(place, tests, all(one.is_met for one in tests))


def _circles(points: Floats, shaft: Floats, ground: Floats, *, is_shaft: bool) -> list[Diagnostic]:
    """The circles about the axis between its lowest and highest place."""
    above = points[:, 2] - LEVEL_M
    beside = (
        points[:, :2] - shaft[[EAST, NORTH]] - above[:, None] * shaft[LEAN_EAST : LEAN_EAST + 2]
    )
    off = np.hypot(beside[:, 0], beside[:, 1]) - shaft[RADIUS] + shaft[TAPER] * above
    tolerance = max(0.008, 3 * float(shaft[NOISE]))
    found: list[Diagnostic] = []
    for low in np.arange(float(shaft[LOW]), float(shaft[TOP]), _SLICE_M).tolist():
        is_here = (points[:, 2] >= low) & (points[:, 2] < low + _SLICE_M)
        on = off[is_here & (np.abs(off) < BESIDE_M / 2) & (np.abs(off) < 4 * tolerance)]
        if on.size < _FEWEST:
            continue
        surface = ground + points[is_here & (np.abs(off) < tolerance)]
        swell = float(np.median(on))
        number = int(np.count_nonzero(np.abs(on) < tolerance))
        others = int(np.count_nonzero(is_here & (off >= tolerance) & (off < BESIDE_M)))
        diameter = 2 * float(shaft[RADIUS] - shaft[TAPER] * (low + _SLICE_M / 2 - LEVEL_M) + swell)
        tests = (
            DiagnosticTest(_DIAMETER, diameter, MOST_DIAMETER_M, "m", diameter <= MOST_DIAMETER_M),
            DiagnosticTest(_OFF, abs(swell), tolerance, "m", abs(swell) <= tolerance),
            _at_least(_NUMBER, float(number), float(_FEWEST)),
            DiagnosticTest(_BESIDE, others / max(number, 1), 1.0, "", others < number),
        )
        is_taken = is_shaft and all(one.is_met for one in tests[:3])
        place = ground + _middle(shaft, low + _SLICE_M / 2)
        found.append(Diagnostic(place, tests, is_taken, points=surface if is_taken else None))
    return found


def _at_least(name: Text, value: float, limit: float) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, "", value >= limit)


def _middle(shaft: Floats, height_m: float) -> Floats:
    """Of the shaft at a height, m about the ground below the place."""
    up = height_m - LEVEL_M
    return np.array(
        [
            shaft[EAST] + shaft[LEAN_EAST] * up,
            shaft[NORTH] + shaft[LEAN_EAST + 1] * up,
            height_m,
        ]
    )
