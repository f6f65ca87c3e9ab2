"""Rows of equal rectangles: lids laid at the size and the spacing of those that lie there already.

A gutter is covered by lids of one size at one spacing. Where some were missed, or a stretch lies
under soil, new ones are laid by the pattern of the nearest run: between two places, or one where a
run has a gap.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats

MOST_LIDS = 500
"""In one row: a quarter of a kilometre of half-metre lids."""

_CORNERS = 4
_NEIGHBOUR_TIMES = 1.6
"""A lid whose middle is farther than so many lengths is no neighbour in its run."""

_BESIDE_SHARE = 0.5
"""Lids of a run lie in line by so much of their width."""

_GAP_TIMES = 0.75
"""A place counts as free where no middle is nearer than so much of the spacing."""


@dataclass(frozen=True)
class LidPattern:
    """Size and spacing of the lids of a run.

    Attributes
    ----------
    middle : (3,) float64
        Of the lid from which it was read, m, project CRS.
    along, across : (3,) float64
        Its sides, unit vectors; along the run.
    length_m, width_m, spacing_m : float
        Along the run, across it, and from one middle to the next.
    """

    middle: Floats
    along: Floats
    across: Floats
    length_m: float
    width_m: float
    spacing_m: float


def pattern_near(lids: Sequence[Floats], place: Floats) -> LidPattern | None:
    """The pattern of the run whose lid is nearest to a place; None where there is no lid.

    Parameters
    ----------
    lids : sequence of (4, 3) float64
        Corners in their order.
    """
    rings = [ring for ring in lids if len(ring) == _CORNERS]
    if not rings:
        return None
    middles = np.array([ring.mean(axis=0) for ring in rings])
    nearest = int(np.linalg.norm(middles - place, axis=1).argmin())
    ring, middle = rings[nearest], middles[nearest]
    sides = ring[1] - ring[0], ring[2] - ring[1]
    reach_m = _NEIGHBOUR_TIMES * max(float(np.linalg.norm(side)) for side in sides)
    away = np.linalg.norm(middles - middle, axis=1)
    beside = np.flatnonzero((away > 0) & (away <= reach_m))
    # Without a neighbour the longer side is taken to lie along: lids that are square have none.
    along = max(sides, key=lambda side: float(np.linalg.norm(side)))
    if beside.size:
        to_next = middles[beside[away[beside].argmin()]] - middle
        along = max(sides, key=lambda side: abs(float(side @ to_next)) / np.linalg.norm(side))
    across = sides[1] if along is sides[0] else sides[0]
    length_m, width_m = float(np.linalg.norm(along)), float(np.linalg.norm(across))
    if not (length_m > 0 and width_m > 0):
        return None
    found = LidPattern(middle, along / length_m, across / width_m, length_m, width_m, length_m)
    return LidPattern(
        middle, found.along, found.across, length_m, width_m, _spacing_of(found, middles)
    )


def row_between(pattern: LidPattern, first: Floats, last: Floats) -> tuple[Floats, ...]:
    """Lids from one middle to another, evenly, as near to the pattern's spacing as fits.

    Returns
    -------
    tuple of (4, 3) float64
        One lid where both are the same; `MOST_LIDS` at most.
    """
    way = last - first
    long_m = float(np.linalg.norm(way))
    steps = min(round(long_m / pattern.spacing_m), MOST_LIDS - 1)
    if steps == 0:
        return (_lid_at(pattern, first, pattern.along),)
    # The row leads; across it the lids lean as those of the pattern do.
    along = way / long_m
    middles = first + np.linspace(0.0, 1.0, steps + 1)[:, None] * way
    return tuple(_lid_at(pattern, middle, along) for middle in middles)


def lid_in_gap(pattern: LidPattern, lids: Sequence[Floats], place: Floats) -> Floats | None:
    """The one lid that a run lacks at a place; None where the place is no gap of a single lid.

    Returns
    -------
    (4, 3) float64 or None
    """
    middles = np.array([ring.mean(axis=0) for ring in lids if len(ring) == _CORNERS])
    offsets = middles - pattern.middle
    is_in_line = np.abs(offsets @ pattern.across) <= _BESIDE_SHARE * pattern.width_m
    stations = np.sort((offsets @ pattern.along)[is_in_line])
    at = float((place - pattern.middle) @ pattern.along)
    if abs(float((place - pattern.middle) @ pattern.across)) > pattern.width_m:
        return None
    before, after = stations[stations < at], stations[stations > at]
    if not (before.size and after.size):
        return None
    gap_m = float(after[0] - before[-1])
    if abs(gap_m - 2 * pattern.spacing_m) > _GAP_TIMES * pattern.spacing_m:
        return None
    ends = [
        middles[is_in_line][_nearest(offsets[is_in_line] @ pattern.along, one)]
        for one in (before[-1], after[0])
    ]
    middle = np.mean(ends, axis=0)
    way = ends[1] - ends[0]
    return _lid_at(pattern, middle, way / float(np.linalg.norm(way)))


def _nearest(values: Floats, wanted: float) -> int:
    return int(np.abs(values - wanted).argmin())


def _spacing_of(pattern: LidPattern, middles: Floats) -> float:
    """From one lid of the run to the next, median; its length where it has no neighbour."""
    offsets = middles - pattern.middle
    is_in_line = np.abs(offsets @ pattern.across) <= _BESIDE_SHARE * pattern.width_m
    steps = np.diff(np.sort((offsets @ pattern.along)[is_in_line]))
    near = steps[(steps > 0) & (steps <= _NEIGHBOUR_TIMES * pattern.length_m)]
    return float(np.median(near)) if near.size else pattern.length_m


def _lid_at(pattern: LidPattern, middle: Floats, along: Floats) -> Floats:
    """The corners of a lid, in the order of those of the pattern."""
    flat = math.hypot(along[0], along[1])
    side = float(np.sign(along[0] * pattern.across[1] - along[1] * pattern.across[0])) or 1.0
    lean = float(pattern.across[2])
    level = math.sqrt(max(1.0 - lean * lean, 0.0))
    across = np.array([-along[1] / flat * side * level, along[0] / flat * side * level, lean])
    one, other = along * pattern.length_m / 2, across * pattern.width_m / 2
    return np.stack(
        [middle - one - other, middle + one - other, middle + one + other, middle - one + other]
    )
