"""Stems: what the circles of a column's slabs join to, and the tapered, leaning body through each.

The thesis cuts the wires of the image every 5 mm, draws a circle through each cut and a robust
line through the diameters (Takahashi 2022, 5.2). Few points lie at any one height, so circles of
thin slabs tell only where stems are; the diameter comes from all points of a stem at once, as a
cone whose axis may lean.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.circle_kernels import (
    ARC,
    CIRCLE_WIDTH,
    EAST,
    INLIERS,
    MOST_CIRCLES,
    NORTH,
    RADIUS,
    ChainLimits,
    CircleLimits,
    chain_kernel,
    circles_kernel,
)

BREAST_M = 1.2
"""Height of the diameter above the foot: 胸高 in Japan (Takahashi 2022, 5.1)."""

LOWEST_M, HIGHEST_M = 0.3, 2.6
"""Of the slabs above the foot: above grass and the flare of the roots, below most crowns."""

STEP_M, THICK_M = 0.1, 0.2
"""From slab to slab, and how thick one is: scan lines of a moving scanner lie up to 0.2 m apart on
a trunk, so one of them crosses most slabs. A lean of 10 degrees moves a circle by 3.5 cm in it."""

_NOISE_M = 0.012
"""First tolerance, before the noise is known: three times the 4 mm of usual scanners."""

_LEAST_NOISE_M = 0.002
"""Bark is no smoother."""

_SHIFT_M, _SWELL_M = 0.03, 0.02
"""How far middle and radius may be off what the circles below tell: three times the noise."""

_SWELL = 0.15
"""And as a share of the radius, for knots."""

_SKIPPED = 3
"""Slabs that may lack a circle between two of a stem: a stake's strap, a missing scan line."""

_REMEMBERED = 5
"""Circles from which a stem's next one is foretold: half a metre."""

_FEWEST_SLABS = 4
"""Of a stem: 0.5 m of it."""

_STEEPEST = 0.5
"""Run over rise of a stem's lean: 27 degrees; what leans more is a branch or a stay."""

_MOST_TAPER = 0.06
"""Metres of radius lost in a metre of height: twice the swelling at the foot of old trees."""

_OVAL = 0.06
"""Standard deviation of half the difference of a trunk's two diameters, as a share of their mean:
trunks of street trees are seldom wider one way than the other by more than a quarter."""

_SHAPE_M = 0.003
"""How far bark and the points at a trunk's edges make its shape seem off; as for the girth."""

_CLEARLY = 0.85
"""A trunk is taken for flatter than that if its points then lie nearer by so much: of a round one
they don't, by more than chance."""

_FEWEST_POINTS = 8
"""As many as a body has numbers."""

_TURNS = 6
"""Steps of the last fit; it ends within four. By trial; no measurement is recorded."""


@dataclass(frozen=True)
class FittedStem:
    """One upright round body.

    Attributes
    ----------
    base : (2,) float64
        Its axis at the foot's height, m about the column.
    lean : (2,) float64
        Metres that the axis moves to the east and north in a metre of height.
    radius_m, taper : float
        Radius 1.2 m above the foot, m; what it loses in a metre of height.
    deviation_m : float
        Standard deviation of the radius, m.
    noise_m : float
        How far its points lie off it.
    low_m, high_m : float
        Between which heights above the foot it was seen.
    arc : float
        Share of its circumference that was seen.
    lines : (n,) int64
        Its points, by their line among those of the column.
    """

    base: Floats
    lean: Floats
    radius_m: float
    taper: float
    deviation_m: float
    noise_m: float
    low_m: float
    high_m: float
    arc: float
    lines: Integers

    def middle_at(self, height_m: float) -> Floats:
        """Its axis at a height above the foot: (2,) float64."""
        middle: Floats = self.base + self.lean * height_m
        return middle


def stems_of(points: Floats, most_diameter_m: float) -> tuple[FittedStem, ...]:
    """All stems of a column, those with the most points first.

    Parameters
    ----------
    points : (n, 3) float64
        m about the column's foot.
    most_diameter_m : float
    """
    count = round((HIGHEST_M - LOWEST_M) / STEP_M) + 1
    heights = np.linspace(LOWEST_M, HIGHEST_M, count)
    order = np.argsort(points[:, 2], kind="stable")
    rising = points[order, 2]
    first = np.searchsorted(rising, heights - THICK_M / 2)
    end = np.searchsorted(rising, heights + THICK_M / 2)
    if not (end > first).any():
        return ()
    members = np.concatenate([order[a:b] for a, b in zip(first, end, strict=True)])
    starts = np.concatenate([[0], np.cumsum(end - first)])
    limits = CircleLimits(0.015, most_diameter_m / 2, _NOISE_M, 5, 0.12, 0.15)
    circles = np.zeros((heights.size, MOST_CIRCLES, CIRCLE_WIDTH))
    circles_kernel(np.ascontiguousarray(points[members, :2]), starts, limits, circles)
    found = [
        stem
        for chain in _chains(circles, heights)
        if (stem := _fitted(points, chain, most_diameter_m)) is not None
    ]
    return tuple(sorted(found, key=lambda stem: -stem.lines.size))


def _chains(circles: Floats, heights: Floats) -> list[Floats]:
    """Circles that follow each other upwards: (k, 5) height, middle, radius, arc."""
    free = circles[..., RADIUS] > 0
    worth = np.where(free, circles[..., INLIERS] * (0.5 + circles[..., ARC]), 0.0)
    limits = ChainLimits(_SHIFT_M, _SWELL_M, _SWELL, _SKIPPED, _REMEMBERED)
    chains: list[Floats] = []
    while worth.max(initial=0.0) > 0:
        slab, number = divmod(int(worth.argmax()), MOST_CIRCLES)
        chain = np.full(len(circles), -1, np.int64)
        chain_kernel(circles, worth, slab, number, 1, limits, chain)
        chain_kernel(circles, worth, slab, number, -1, limits, chain)
        slabs = np.flatnonzero(chain >= 0)
        worth[slabs, chain[slabs]] = 0.0
        if slabs.size >= _FEWEST_SLABS:
            rows = circles[slabs, chain[slabs]][:, [EAST, NORTH, RADIUS, ARC]]
            chains.append(np.column_stack([heights[slabs], rows]))
    return chains


def _fitted(points: Floats, chain: Floats, most_diameter_m: float) -> FittedStem | None:
    """The cone through the points of a chain of circles; None where there is none."""
    low, high = chain[0, 0] - THICK_M / 2, chain[-1, 0] + THICK_M / 2
    about = np.flatnonzero((points[:, 2] >= low) & (points[:, 2] <= high))
    local = points[about] - (0.0, 0.0, BREAST_M)
    start = _body_of(chain)
    cone, oval = _settled(local, start, _SHAPE_M), _settled(local, start, 0.0)
    if cone is None or oval is None:
        return None
    if _scatter(local, oval, cone) < _CLEARLY * _scatter(local, cone, oval):
        cone = oval
    radius = float(cone.body[4])
    lean = cone.body[2:4]
    if not 0.015 <= radius <= most_diameter_m / 2 or np.hypot(*lean) > _STEEPEST:
        return None
    return FittedStem(
        base=cone.body[:2] - lean * BREAST_M,
        lean=lean,
        radius_m=radius,
        taper=float(-cone.body[5]),
        deviation_m=cone.deviation_m,
        noise_m=cone.noise_m,
        low_m=float(low),
        high_m=float(high),
        arc=_arc_of(local[cone.near], cone.body),
        lines=about[cone.near],
    )


class _Cone(NamedTuple):
    """A body, its radius' standard deviation, how far its points lie off it, and which they are."""

    body: Floats
    deviation_m: float
    noise_m: float
    near: NDArray[np.bool_]


def _body_of(chain: Floats) -> Floats:
    """The round body that circles tell."""
    height = chain[:, 0] - BREAST_M
    body = np.zeros(8)
    for axis in range(2):
        slope = np.polyfit(height, chain[:, 1 + axis], 1, w=0.1 + chain[:, 4])
        body[axis], body[2 + axis] = slope[1], slope[0]
    body[4] = float(np.median(chain[:, 3]))
    return body


def _settled(local: Floats, body: Floats, shape_m: float) -> _Cone | None:
    """The body that the points near it give; None where too few are."""
    tolerance = _NOISE_M
    cone: _Cone | None = None
    for _ in range(_TURNS):
        off, jacobian = _offsets(local, body)
        near = np.abs(off) <= tolerance
        if np.count_nonzero(near) < _FEWEST_POINTS:
            return None
        body, deviation = _stepped(off[near], jacobian[near], body, shape_m)
        noise = max(_LEAST_NOISE_M, 1.4826 * float(np.median(np.abs(off[near]))))
        tolerance = float(np.clip(3.0 * noise, 0.006, _NOISE_M))
        cone = _Cone(body, deviation, noise, near)
    return cone


def _scatter(local: Floats, cone: _Cone, other: _Cone) -> float:
    """How far the points of either of two bodies lie off the first, m."""
    off, _ = _offsets(local[cone.near | other.near], cone.body)
    return float(np.sqrt(np.mean(np.minimum(np.abs(off), _NOISE_M) ** 2)))


def _offsets(local: Floats, body: Floats) -> tuple[Floats, Floats]:
    """How far points lie outside an oval cone, and how that changes with its eight numbers."""
    up = local[:, 2]
    east = local[:, 0] - body[0] - body[2] * up
    north = local[:, 1] - body[1] - body[3] * up
    away = np.maximum(np.hypot(east, north), 1e-6)
    east, north = east / away, north / away
    oval = np.column_stack([east**2 - north**2, 2 * east * north])
    jacobian = np.column_stack(
        [-east, -north, -east * up, -north * up, -np.ones(up.size), -up, -oval]
    )
    return away - body[4] - body[5] * up - oval @ body[6:], jacobian


def _stepped(off: Floats, jacobian: Floats, body: Floats, shape_m: float) -> tuple[Floats, float]:
    """A step of Gauss and Newton, and the standard deviation of the radius after it.

    Taper, lean and flattening are held to what trees have, by as much as their points leave them
    open: of half a trunk only its far side tells whether it is a circle.
    """
    noise = max(_LEAST_NOISE_M, float(np.sqrt(np.mean(off**2))))
    oval = _OVAL * abs(float(body[4]))
    # Standard deviations; infinite: not held.
    held = np.array([np.inf, np.inf, 0.1, 0.1, np.inf, 0.02, oval, oval])
    # What bark and mixed points do to the shape doesn't get less with more of them.
    weight = (noise / held) ** 2
    weight[6:] += off.size * (shape_m / oval) ** 2
    normal = jacobian.T @ jacobian + np.diag(weight + 1e-9)
    step = np.linalg.solve(normal, -jacobian.T @ off - weight * body)
    stepped = body + step
    stepped[5] = np.clip(stepped[5], -_MOST_TAPER, _MOST_TAPER)
    return stepped, noise * float(np.sqrt(np.linalg.inv(normal)[4, 4]))


def _arc_of(local: Floats, body: Floats) -> float:
    """Share of the circumference that has points."""
    east = local[:, 0] - body[0] - body[2] * local[:, 2]
    north = local[:, 1] - body[1] - body[3] * local[:, 2]
    sectors = ((np.arctan2(north, east) / np.pi + 1) * 12).astype(np.int64) % 24
    return float(np.unique(sectors).size / 24)
