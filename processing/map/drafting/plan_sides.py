"""Sides seen from above: nearest places, crossings; thousands at once.

Sides are (m, 2, 2) float64, start and end, in metres about an origin near them.
"""

from __future__ import annotations

import numpy as np
import shapely

from processing.core.arrays import Floats, Integers

_PARALLEL = 1e-12
_FIRST_BLOCK = 32


def cross(one: Floats, other: Floats) -> Floats:
    """Cross product of plan vectors (…, 2): positive where the other lies to the left."""
    product: Floats = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
    return product


def nearest_fractions(sides: Floats, positions: Floats) -> tuple[Floats, Floats]:
    """Where on sides the place nearest to another place is, side by side.

    Parameters
    ----------
    sides : (k, 2, 2) float64
    positions : (k, 2) or (2,) float64

    Returns
    -------
    fractions : (k,) float64
        0 at a side's start, 1 at its end; 0 on a side without length.
    distances : (k,) float64
        m.
    """
    steps = sides[:, 1] - sides[:, 0]
    away = positions - sides[:, 0]
    squares = (steps**2).sum(axis=1)
    along = (away * steps).sum(axis=1)
    fractions = np.divide(along, squares, out=np.zeros_like(along), where=squares > 0).clip(0, 1)
    distances = np.linalg.norm(away - fractions[:, None] * steps, axis=1)
    return fractions, distances


class SideIndex:
    """Sides sorted in plan, so that the one nearest to a place is found at once.

    Parameters
    ----------
    sides : (m, 2, 2) float64
    """

    def __init__(self, sides: Floats) -> None:
        self._sides = sides
        self._tree = shapely.STRtree(shapely.linestrings(sides))

    def nearest(self, positions: Floats) -> tuple[Integers, Floats, Floats]:
        """The side nearest to each of many places.

        Parameters
        ----------
        positions : (k, 2) float64

        Returns
        -------
        sides : (k,) int64
        fractions, distances : (k,) float64
            See :func:`nearest_fractions`.
        """
        _, found = self._tree.query_nearest(shapely.points(positions), all_matches=False)
        nearest = np.asarray(found, dtype=np.int64)
        fractions, distances = nearest_fractions(self._sides[nearest], positions)
        return nearest, fractions, distances


def meeting_pairs(sides: Floats, others: Floats) -> tuple[Integers, Integers]:
    """Which sides meet which others, touching included: indices of both, sorted by the first."""
    tree = shapely.STRtree(shapely.linestrings(others))
    one, other = tree.query(shapely.linestrings(sides), predicate="intersects")
    order = np.lexsort([other, one])
    return np.asarray(one, np.int64)[order], np.asarray(other, np.int64)[order]


def crossing_fractions(sides: Floats, others: Floats) -> tuple[Floats, Floats]:
    """Where the straight lines through sides cross, side by side.

    Returns
    -------
    on_sides, on_others : (k,) float64
        0 at the start, 1 at the end, beyond outside; NaN where they are parallel.
    """
    steps, other_steps = sides[:, 1] - sides[:, 0], others[:, 1] - others[:, 0]
    away = others[:, 0] - sides[:, 0]
    turn = cross(steps, other_steps)
    lengths = np.linalg.norm(steps, axis=1) * np.linalg.norm(other_steps, axis=1)
    is_open = np.abs(turn) > _PARALLEL * lengths
    nothing = np.full(turn.shape, np.nan)
    on_sides = np.divide(cross(away, other_steps), turn, out=nothing.copy(), where=is_open)
    on_others = np.divide(cross(away, steps), turn, out=nothing, where=is_open)
    return on_sides, on_others


def first_meeting(sides: Floats, *, is_closed: bool) -> tuple[int, int] | None:
    """The first two sides of one line that meet and aren't neighbours; None where none do.

    Parameters
    ----------
    sides : (m, 2, 2) float64
        One after the other, each with a length. Where an open line ends on itself, or returns to
        its start, that is no meeting.
    """
    count = sides.shape[0]
    shapes = shapely.linestrings(sides)
    tree = shapely.STRtree(shapes)
    ends = shapely.points(np.array([sides[0, 0], sides[-1, 1]]))
    start, block = 0, _FIRST_BLOCK
    while start < count:
        # Small blocks first: a scribble meets itself at once, and thousands of times.
        one, other = tree.query(shapes[start : start + block], predicate="intersects")
        one = one + start
        apart = other - one
        chosen = apart > 1
        if is_closed:
            chosen &= apart < count - 1
        else:
            at_end = (one == 0) & shapely.intersects(shapes[other], ends[0])
            at_end |= (other == count - 1) & shapely.intersects(shapes[one], ends[1])
            chosen &= ~at_end
        if chosen.any():
            order = np.lexsort([other[chosen], one[chosen]])[0]
            return int(one[chosen][order]), int(other[chosen][order])
        start, block = start + block, 2 * block
    return None
