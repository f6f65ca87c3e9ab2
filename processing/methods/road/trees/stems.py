"""Stems: what the circles of a column's slabs join to, and the tapered, leaning body through each.

The thesis cuts the wires of the image every 5 mm, draws a circle through each cut and a robust
line through the diameters (Takahashi 2022, 5.2). Few points lie at any one height, so circles of
thin slabs tell only where stems are; the diameter comes from all points of a stem at once, as a
cone whose axis may lean.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.alike_stems import lines_of, pieces_of
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
    free_slabs_kernel,
)
from processing.methods.road.trees.stem_bodies import BREAST_M, body_through
from processing.methods.road.trees.wall_kernels import without_rows_kernel

LOWEST_M, HIGHEST_M = 0.3, 2.6
"""Of the slabs above the foot: above grass and the flare of the roots, below most crowns."""

STEP_M, THICK_M = 0.1, 0.2
"""From slab to slab, and how thick one is: scan lines of a moving scanner lie up to 0.2 m apart on
a trunk, so one of them crosses most slabs. A lean of 10 degrees moves a circle by 3.5 cm in it."""

HEIGHTS_M = np.linspace(LOWEST_M, HIGHEST_M, round((HIGHEST_M - LOWEST_M) / STEP_M) + 1)
"""Of the slabs' middles above the foot."""

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

_THINNEST_M = 0.01
"""Radius: a cane of 3 cm; what is thinner shows as a few points however near it stands."""

_SLENDER_M, _FROM_M, _BESIDE_M = 0.08, 1.7, 0.03
"""Radius of stems that have others like them which show too little; below which height one is seen;
and how far off its surface others' points lie."""

_LEANS = 0.03
"""Run over rise: posts and stakes are set plumber, stems of one tree lean away from each other."""

_THICKER, _TOLD_ARC = 2.0, 0.3
"""How many times as thick stems of one tree are as others; and share of a circumference that few
points show."""

EVENLY_M = 0.75 * EVEN_NOISE_M
"""Off a stem: points that lie so far off it fill what is allowed nearly evenly. There is no stem,
or it bends."""

_LEAST_EVEN = 0.6
"""How evenly a stem's points fill its seen side: of 92 trunks on eight own streets, two of them by
scanners whose lines cross a trunk steeply, one had less than 0.65; circles through several stems,
or through the bars of a guard, had 0.54 to 0.58. Slender ones may have less: bars of a guard hide
sides of them."""

_FEWEST_FREE = 2
"""Slabs of 0.2 m in which a stem stands free: circles at the corner of a wall and among twigs have
as many points beside them as on them at every height. Of 110 trees of own avenues that were looked
at one stood free in fewer than three, with a cane beside it; of things taken for trees that were
corners and shrubs all but one in none."""


@dataclass(frozen=True)
class FittedStem:
    """One upright round body.

    Attributes
    ----------
    base : (2,) float64
        Its axis at the foot's height, m about the column.
    lean : (2,) float64
        Metres that the axis moves to the east and north in a metre of height, from the foot to
        1.2 m above it.
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
    bend : (2,) float64
        How far east and north the axis leaves its tangent a metre above and below, m.
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
    bend: Floats = field(default_factory=lambda: np.zeros(2))

    def about(self, higher_m: float) -> FittedStem:
        """The same with a foot that lies so much higher."""
        return replace(
            self,
            base=self.middle_at(higher_m),
            lean=self.lean + 2 * higher_m * self.bend,
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
        """(10,) as kernels have it, round."""
        body = np.zeros(NUMBERS)
        body[:2], body[2:4] = self.base + BREAST_M * self.lean, self.lean + BREAST_M * self.bend
        body[4], body[5] = self.radius_m, -self.taper
        body[8:10] = self.bend
        return body

    @property
    def slope(self) -> Floats:
        """(2,) how far its axis moves in a metre, from the foot to where it was last seen."""
        slope: Floats = self.lean + (self.high_m - BREAST_M) * self.bend
        return slope

    @property
    def straight_on(self) -> Floats:
        """(10,) the straight body that goes on above it."""
        body = self.body
        body[2:4] = self._end_slope
        body[:2] = self.middle_at(self.high_m) - (self.high_m - BREAST_M) * body[2:4]
        body[8:10] = 0.0
        return body

    @property
    def _end_slope(self) -> Floats:
        """(2,) how far its axis moves in a metre, from where it was first seen to where last."""
        slope: Floats = self.lean + (self.low_m + self.high_m - BREAST_M) * self.bend
        return slope

    def middle_at(self, height_m: float) -> Floats:
        """Its axis at a height above the foot: (2,) float64."""
        middle: Floats = self.axis_at(np.array([height_m]))[0]
        return middle

    def axis_at(self, heights_m: Floats) -> Floats:
        """Its axis at heights above the foot, straight above where it was seen: (n, 2) float64."""
        up = np.minimum(heights_m, self.high_m)[:, None]
        axis: Floats = self.base + up * (self.lean + (up - BREAST_M) * self.bend)
        return axis + (heights_m[:, None] - up) * self._end_slope


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
    for thick_m in (THICK_M, _SPARSE_THICK_M):
        slabs = slab_circles(points, most_diameter_m, thick_m)
        slabs.circles[:, most_circles:] = 0.0
        found = [
            stem
            for chain in _chains(slabs.circles, slabs.heights)
            if (stem := _fitted(points, chain, most_diameter_m)) is not None
        ]
        free = [one.stem for one in _standing_free(points, found)]
        alike = _alike(points, free, most_diameter_m)
        free = [one for one in free if all(_are_apart(one, other) for other in alike)] + alike
        if any(stem.low_m < BREAST_M < stem.high_m for stem in free):
            break
    return tuple(sorted(free, key=lambda stem: -stem.lines.size))


class _CladStem(NamedTuple):
    """A stem, and the body about what clings to it."""

    stem: FittedStem
    outer: Floats

    @property
    def is_free(self) -> bool:
        """Whether it is no piece of a wall, of a shrub or of a crown."""
        return self.stem.free_slabs >= _FEWEST_FREE

    def told_free(self, points: Floats) -> _CladStem:
        """The same with the slabs in which it stands free of points: ivy stands on it."""
        heights = self.stem.low_m, self.stem.high_m
        slabs = max(
            int(free_slabs_kernel(points, BREAST_M, body, heights))
            for body in (self.stem.body, self.outer)
        )
        return self._replace(stem=replace(self.stem, free_slabs=slabs))


def _standing_free(points: Floats, stems: Sequence[_CladStem]) -> list[_CladStem]:
    """Stems without what is a piece of a wall, of a shrub or of a crown.

    What stands beside one that is free counts without it: stems of one tree stand close.
    """
    told = [one.told_free(points) for one in stems]
    left = np.ones(len(points), np.bool_)
    for one in told:
        if one.is_free:
            left[one.stem.lines] = False
    if not left.all():
        others = points[left]
        told = [one if one.is_free else one.told_free(others) for one in told]
    return [one for one in told if one.is_free]


def _alike(points: Floats, free: Sequence[FittedStem], most_m: float) -> list[FittedStem]:
    """Stems that show too little for circles but leave the ground with a slender one.

    Circles that end below the tape may have shown a piece of one.
    """
    known = [one for one in free if _has_others(one)]
    if not known:
        return []
    whole = [one for one in free if one.high_m >= BREAST_M or one.radius_m > _SLENDER_M]
    radius = float(np.median([one.radius_m for one in known]))
    pieces = pieces_of(points[_beside(points, whole)], HEIGHTS_M, THICK_M, radius)
    alike: list[FittedStem] = []
    for one in known:
        aside = (points[one.lines, :2] - one.axis_at(points[one.lines, 2])).mean(axis=0)
        axis = np.concatenate([one.base, one.slope])
        for line in lines_of(pieces, axis, max(one.radius_m, TOLERANCE_M)):
            told = np.full((len(line), 2), (one.radius_m, _TOLD_ARC))
            chain = np.column_stack([line[:, 0], line[:, 1:] - aside, told])
            found = _fitted(points, chain, most_m)
            stem = found.told_free(points).stem if found is not None else None
            if stem is not None and _is_like(stem, one):
                alike += [stem] if all(_are_apart(stem, it) for it in (*whole, *alike)) else []
    return alike


def _has_others(stem: FittedStem) -> bool:
    """Whether it may be one of several stems of a tree: slender ones that lean, unlike posts."""
    is_seen = stem.low_m <= _FROM_M and stem.high_m >= BREAST_M
    return is_seen and stem.radius_m <= _SLENDER_M and float(np.hypot(*stem.slope)) > _LEANS


def _beside(points: Floats, stems: Sequence[FittedStem]) -> NDArray[np.bool_]:
    """Which points lie off the surfaces of stems."""
    left = np.ones(len(points), np.bool_)
    for one in stems:
        over = np.maximum(one.radius_m - one.taper * (points[:, 2] - BREAST_M), 0.0)
        away = np.hypot(*(points[:, :2] - one.axis_at(points[:, 2])).T)
        left &= np.abs(away - over) > _BESIDE_M
    return left


def _is_like(stem: FittedStem, known: FittedStem) -> bool:
    """Whether it stands free, is as thick, about, and shows a surface."""
    thick = stem.radius_m / known.radius_m
    is_surface = stem.noise_m < EVENLY_M and stem.free_slabs >= _FEWEST_FREE
    return is_surface and 1 / _THICKER < thick < _THICKER


def _are_apart(one: FittedStem, other: FittedStem) -> bool:
    """Whether two stems don't go through each other, as one that drives show twice does."""
    middle = (one.low_m + one.high_m) / 2
    away = np.hypot(*(one.middle_at(middle) - other.middle_at(middle)))
    return bool(away > one.radius_m + other.radius_m)


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
    heights = HEIGHTS_M
    circles = np.zeros((heights.size, MOST_CIRCLES, CIRCLE_WIDTH))
    order = np.argsort(points[:, 2], kind="stable")
    rising = points[order, 2]
    first = np.searchsorted(rising, heights - thick_m / 2)
    end = np.searchsorted(rising, heights + thick_m / 2)
    if (end > first).any():
        plan = np.ascontiguousarray(points[order, :2])
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


def _fitted(points: Floats, chain: Floats, most_diameter_m: float) -> _CladStem | None:
    """The body through the points of a chain of circles; None where there is none."""
    body = body_through(points, chain, THICK_M / 2)
    if body is None:
        return None
    radius, bend = float(body.numbers[4]), body.numbers[8:10]
    lean = body.numbers[2:4] - bend * BREAST_M
    if not _THINNEST_M <= radius <= most_diameter_m / 2 or np.hypot(*lean) > _STEEPEST:
        return None
    if radius > _SLENDER_M and body.evenness < _LEAST_EVEN:
        return None
    stem = FittedStem(
        base=body.numbers[:2] - lean * BREAST_M,
        lean=lean,
        bend=bend,
        radius_m=radius,
        taper=float(-body.numbers[5]),
        deviation_m=body.deviation_m,
        noise_m=body.noise_m,
        low_m=float(chain[0, 0]) - THICK_M / 2,
        high_m=float(chain[-1, 0]) + THICK_M / 2,
        arc=body.arc,
        free_slabs=0,
        lines=body.lines,
    )
    return _CladStem(stem, body.outer)
