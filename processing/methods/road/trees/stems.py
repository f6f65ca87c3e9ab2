"""Stems: what the circles of a column's slabs join to, and the tapered, leaning body through each.

The thesis cuts the wires of the image every 5 mm, draws a circle through each cut and a robust
line through the diameters (Takahashi 2022, 5.2). Few points lie at any one height, so circles of
thin slabs tell only where stems are; the diameter comes from all points of a stem at once, as a
cone whose axis may lean.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.circle_kernels import (
    ARC,
    CIRCLE_WIDTH,
    EAST,
    MOST_CIRCLES,
    NORTH,
    RADIUS,
    WORTH,
    ChainLimits,
    CircleLimits,
    chains_kernel,
    circles_kernel,
)
from processing.methods.road.trees.cone_kernels import (
    EVEN_NOISE_M,
    NUMBERS,
    TOLERANCE_M,
    arc_kernel,
    free_slabs_kernel,
    scatter_kernel,
    settle_kernel,
)
from processing.methods.road.trees.wall_kernels import without_rows_kernel

BREAST_M = 1.2
"""Height of the diameter above the foot: 胸高 in Japan (Takahashi 2022, 5.1)."""

LOWEST_M, HIGHEST_M = 0.3, 2.6
"""Of the slabs above the foot: above grass and the flare of the roots, below most crowns."""

STEP_M, THICK_M = 0.1, 0.2
"""From slab to slab, and how thick one is: scan lines of a moving scanner lie up to 0.2 m apart on
a trunk, so one of them crosses most slabs. A lean of 10 degrees moves a circle by 3.5 cm in it."""

_SPARSE_THICK_M = 0.4
"""How thick slabs are where no stem was found: of a slender trunk far from the scanner, two points
a scan line, a slab of 0.2 m holds three or four, and a circle needs five."""

_MOST_OF_SLAB = 160
"""Points of a slab in which rows and circles are looked for: a stake with a twentieth of them has
eight. The bodies are fitted to all."""

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

_STEEP = 0.35
"""Run over rise of the stems of a tree that has several: they lean outwards by up to 20 degrees."""

_THINNEST_M = 0.015
"""Radius: a cane of 3 cm; what is thinner shows as a few points however near it stands."""

_ABOUT_M = 0.1
"""From a body's surface to the points that are looked at: what it may move while it is fitted."""

SHAPE_M = 0.003
"""How far bark and the points at a trunk's edges make its shape seem off; as for the girth."""

_SHAPES_M = (SHAPE_M, 0.001, 0.0)
"""Less and less of what is seen is held for bark, and more for a trunk that isn't round. Of the
stems that were looked at, sectors of 15 degrees lie 0.4 to 1.3 mm off an ellipse."""

_ALIKE = 10
"""Points that lie off a trunk together: a burr or a lobe of bark holds so many."""

_FLATTER = (0.0, 5.0, 6.0)
"""How much likelier (natural logarithm, halves) each shape must make the points: Akaike's 2 for
each of the two numbers of an ellipse, and somewhat more, since few trunks are flat."""


EVENLY_M = 0.75 * EVEN_NOISE_M
"""Off a stem: points that lie so far off it fill what is allowed nearly evenly. There is no stem,
or it bends."""

_PIECE_M, _STRAIGHTER = 0.65, 0.75
"""m to either side of 1.2 m in which a stem that bends is straight enough: slender stems of one
tree curve out by 0.1 m in a metre and a half, a hundredth of a metre there; and how far its points
lie off it then, over how far they lay: mere noise stays as it is."""

_FEWEST_FREE = 2
"""Slabs of 0.2 m in which a stem stands free: circles at the corner of a wall and among twigs have
as many points beside them as on them at every height. Of 110 trees of own avenues that were looked
at one stood free in fewer than three, with a cane beside it; of things taken for trees that were
corners and shrubs all but one in none."""

_OPEN = 0.5
"""Standard deviation of the radius over what its shapes differ in it: where they do, half a trunk
was seen, and how flat it is stays open."""


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
    free_slabs: int
    lines: Integers

    def about(self, higher_m: float) -> FittedStem:
        """The same with a foot that lies so much higher."""
        return replace(
            self,
            base=self.base + self.lean * higher_m,
            radius_m=self.radius_m - self.taper * higher_m,
            low_m=self.low_m - higher_m,
            high_m=self.high_m - higher_m,
        )

    @property
    def density(self) -> float:
        """Points over what was seen of its surface, 1/m²."""
        seen = self.radius_m * self.arc * (self.high_m - self.low_m)
        return self.lines.size / max(seen, 1e-6)

    @property
    def body(self) -> Floats:
        """(8,) as kernels have it, round."""
        body = np.zeros(NUMBERS)
        body[:2], body[2:4] = self.middle_at(BREAST_M), self.lean
        body[4], body[5] = self.radius_m, -self.taper
        return body

    def middle_at(self, height_m: float) -> Floats:
        """Its axis at a height above the foot: (2,) float64."""
        middle: Floats = self.base + self.lean * height_m
        return middle


def stems_of(
    points: Floats, most_diameter_m: float, most_circles: int = MOST_CIRCLES
) -> tuple[FittedStem, ...]:
    """All stems of a column, those with the most points first.

    Parameters
    ----------
    points : (n, 3) float64
        m about the column's foot.
    most_diameter_m : float
    most_circles : int
        Of a slab.
    """
    rising = _Rising.of(points)
    for thick_m in (THICK_M, _SPARSE_THICK_M):
        slabs = _slab_circles(rising, most_diameter_m, thick_m)
        slabs.circles[:, most_circles:] = 0.0
        found = [
            stem
            for chain in _chains(slabs.circles, slabs.heights)
            if (stem := _fitted(points, chain, most_diameter_m)) is not None
        ]
        free = _standing_free(points, found)
        if any(stem.low_m < BREAST_M < stem.high_m for stem in free):
            break
    return tuple(sorted(free, key=lambda stem: -stem.lines.size))


def _standing_free(points: Floats, stems: Sequence[FittedStem]) -> list[FittedStem]:
    """Stems without what is a piece of a wall, of a shrub or of a crown.

    What stands beside one that is free counts without it: stems of one tree stand close.
    """
    told = [_told_free(points, stem) for stem in stems]
    left = np.ones(len(points), np.bool_)
    for stem in told:
        if stem.free_slabs >= _FEWEST_FREE:
            left[stem.lines] = False
    if not left.all():
        others = points[left]
        told = [
            stem if stem.free_slabs >= _FEWEST_FREE else _told_free(others, stem) for stem in told
        ]
    return [stem for stem in told if stem.free_slabs >= _FEWEST_FREE]


def _told_free(points: Floats, stem: FittedStem) -> FittedStem:
    slabs = free_slabs_kernel(points, BREAST_M, stem.body, (stem.low_m, stem.high_m))
    return replace(stem, free_slabs=int(slabs))


class SlabCircles(NamedTuple):
    """Circles in slabs.

    Attributes
    ----------
    heights : (n,) float64
        Of the slabs' middles above the foot, m.
    circles : (n, MOST_CIRCLES, CIRCLE_WIDTH) float64
        Of each slab, the best first; radius 0 where there are no more.
    """

    heights: Floats
    circles: Floats


def slab_circles(points: Floats, most_diameter_m: float, thick_m: float = THICK_M) -> SlabCircles:
    """The circles of level slabs through a column.

    Parameters
    ----------
    points : (n, 3) float64
        m about the column's foot.
    thick_m : float
        Of a slab.
    """
    return _slab_circles(_Rising.of(points), most_diameter_m, thick_m)


class _Rising(NamedTuple):
    """Points of a column from the lowest on: heights (n,), and places in plan (n, 2)."""

    heights: Floats
    plan: Floats

    @staticmethod
    def of(points: Floats) -> _Rising:
        """Points without those above and below all slabs."""
        up = points[:, 2]
        chosen = np.flatnonzero(
            (up >= LOWEST_M - _SPARSE_THICK_M) & (up <= HIGHEST_M + _SPARSE_THICK_M)
        )
        order = chosen[np.argsort(up[chosen], kind="stable")]
        return _Rising(up[order], points[:, :2].take(order, axis=0))


def _slab_circles(rising: _Rising, most_diameter_m: float, thick_m: float) -> SlabCircles:
    count = round((HIGHEST_M - LOWEST_M) / STEP_M) + 1
    heights = np.linspace(LOWEST_M, HIGHEST_M, count)
    circles = np.zeros((heights.size, MOST_CIRCLES, CIRCLE_WIDTH))
    first = np.searchsorted(rising.heights, heights - thick_m / 2)
    end = np.searchsorted(rising.heights, heights + thick_m / 2)
    if (end > first).any():
        plan = rising.plan
        members = np.empty(int((end - first).sum()), np.int64)
        starts = np.empty(heights.size + 1, np.int64)
        spans = np.column_stack([first, end])
        without_rows_kernel(plan, spans, TOLERANCE_M, _MOST_OF_SLAB, members, starts)
        limits = CircleLimits(_THINNEST_M, most_diameter_m / 2, TOLERANCE_M, 5, 0.12, 0.15)
        circles_kernel(plan[members[: starts[-1]]], starts, limits, circles)
    return SlabCircles(heights, circles)


def _chains(circles: Floats, heights: Floats) -> list[Floats]:
    """Circles that follow each other upwards: (k, 5) height, middle, radius, arc."""
    free = circles[..., RADIUS] > 0
    if np.count_nonzero(free) < _FEWEST_SLABS:
        return []
    worth = np.where(free, circles[..., WORTH], 0.0)
    limits = ChainLimits(_SHIFT_M, _STEEP * STEP_M, _SWELL_M, _SWELL, _SKIPPED, _REMEMBERED)
    chains = np.empty((np.count_nonzero(free) // _FEWEST_SLABS + 1, len(circles)), np.int64)
    count = chains_kernel(circles, worth, limits, _FEWEST_SLABS, chains)
    told: list[Floats] = []
    for chain in chains[:count]:
        slabs = np.flatnonzero(chain >= 0)
        rows = circles[slabs, chain[slabs]][:, [EAST, NORTH, RADIUS, ARC]]
        told.append(np.column_stack([heights[slabs], rows]))
    return told


def _fitted(points: Floats, chain: Floats, most_diameter_m: float) -> FittedStem | None:
    """The cone through the points of a chain of circles; None where there is none."""
    low, high = chain[0, 0] - THICK_M / 2, chain[-1, 0] + THICK_M / 2
    start = _body_of(chain)
    about = _points_near(points, start, low, high)
    local = points[about] - (0.0, 0.0, BREAST_M)
    cone = _likeliest(local, start)
    if cone is None:
        return None
    piece = _unbent_piece(points, chain) if cone.noise_m > EVENLY_M else None
    if piece is not None and piece.cone.noise_m < _STRAIGHTER * cone.noise_m:
        about, local, cone = piece
    radius = float(cone.body[4])
    lean = cone.body[2:4]
    if not _THINNEST_M <= radius <= most_diameter_m / 2 or np.hypot(*lean) > _STEEPEST:
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
        arc=float(arc_kernel(local, cone.body, cone.near)),
        free_slabs=0,
        lines=about[cone.near],
    )


class _Cone(NamedTuple):
    """A body, its radius' standard deviation, how far its points lie off it, and which they are."""

    body: Floats
    deviation_m: float
    noise_m: float
    near: NDArray[np.bool_]


class _Piece(NamedTuple):
    """Which points are near a piece of a stem, where they are about it, and its cone."""

    about: Integers
    local: Floats
    cone: _Cone


def _unbent_piece(points: Floats, chain: Floats) -> _Piece | None:
    """The piece of a stem about 1.2 m; None where it has too few circles or points there."""
    rows = chain[np.abs(chain[:, 0] - BREAST_M) < _PIECE_M]
    if not _FEWEST_SLABS <= len(rows) < len(chain):
        return None
    start = _body_of(rows)
    about = _points_near(points, start, rows[0, 0] - THICK_M / 2, rows[-1, 0] + THICK_M / 2)
    local = points[about] - (0.0, 0.0, BREAST_M)
    cone = _likeliest(local, start)
    return _Piece(about, local, cone) if cone is not None else None


def _points_near(points: Floats, body: Floats, low: float, high: float) -> Integers:
    """Points of some heights within a hand's breadth of a body."""
    up = points[:, 2]
    about = np.flatnonzero((up >= low) & (up <= high))
    beside = points[about, :2] - body[:2] - (up[about, None] - BREAST_M) * body[2:4]
    near: Integers = about[np.hypot(beside[:, 0], beside[:, 1]) < body[4] + _ABOUT_M]
    return near


def _body_of(chain: Floats) -> Floats:
    """The round body that circles tell."""
    height = chain[:, 0] - BREAST_M
    body = np.zeros(NUMBERS)
    weight = (0.1 + chain[:, 4]) ** 2
    weight /= weight.sum()
    about = height - weight @ height
    slope = (weight * about) @ chain[:, 1:3] / max(float(weight @ about**2), 1e-9)
    body[2:4] = slope
    body[:2] = weight @ (chain[:, 1:3] - height[:, None] * slope)
    body[4] = float(np.median(chain[:, 3]))
    return body


def _likeliest(local: Floats, start: Floats) -> _Cone | None:
    """The body that the points near it give, as flat as they show it; None where too few are."""
    cones: list[_Cone] = []
    for shape_m in _SHAPES_M:
        cone = _settled(local, cones[-1].body if cones else start, shape_m)
        if cone is None:
            break
        cones.append(cone)
    if not cones:
        return None
    near = np.any([cone.near for cone in cones], axis=0)
    number = np.count_nonzero(near) / _ALIKE
    worse = [
        2 * number * math.log(scatter_kernel(local, cone.body, near)) + more
        for cone, more in zip(cones, _FLATTER, strict=False)
    ]
    chosen = cones[int(np.argmin(worse))]
    open_m = _OPEN * float(np.ptp([cone.body[4] for cone in cones]))
    return chosen._replace(deviation_m=math.hypot(chosen.deviation_m, open_m))


def _settled(local: Floats, start: Floats, shape_m: float) -> _Cone | None:
    """The body that the points near it give; None where too few are."""
    body, near = start.copy(), np.zeros(len(local), np.bool_)
    deviation, noise = settle_kernel(local, shape_m, body, np.empty(len(local)), near)
    return _Cone(body, deviation, noise, near) if noise > 0 else None
