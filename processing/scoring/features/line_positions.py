"""Where lines are near each other in plan: the nearest place on any of them, exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers

_ALIKE_M = 1e-6  # below what coordinates are written to: lines so near are one place
_SHORTEST_M = 1e-9


@dataclass(frozen=True)
class NearestPositions:
    """The nearest places on lines.

    Attributes
    ----------
    line : (n,) int64
        Which line; -1 where none is near enough.
    xyz : (n, 3) float64
        The place on it, m; NaN where there is none.
    off_m : (n,) float64
        How far it is in plan, m; inf where there is none.
    """

    line: Integers
    xyz: Floats
    off_m: Floats


class PolylineIndex:
    """Polylines that can be asked for their nearest places.

    Parameters
    ----------
    lines : sequence of (n, 3) float64
        Corners, m; lines without length are never near.
    """

    def __init__(self, lines: Sequence[Floats]) -> None:
        import shapely

        starts = [line[:-1] for line in lines]
        ends = [line[1:] for line in lines]
        numbers = np.repeat(np.arange(len(lines)), [max(len(line) - 1, 0) for line in lines])
        self._starts = np.vstack([np.empty((0, 3)), *starts])
        self._ways = np.vstack([np.empty((0, 3)), *ends]) - self._starts
        is_long = np.hypot(*self._ways[:, :2].T) > _SHORTEST_M
        self._starts, self._ways = self._starts[is_long], self._ways[is_long]
        self._line: Integers = numbers[is_long].astype(np.int64)
        plan = np.stack([self._starts[:, :2], (self._starts + self._ways)[:, :2]], axis=1)
        self._tree = shapely.STRtree(shapely.linestrings(plan) if len(plan) else [])

    def nearest(self, xyz: Floats, within_m: float) -> NearestPositions:
        """The nearest place on any line to each of (n, 3) places, by their distance in plan.

        Of lines that are equally near, the one given first.
        """
        import shapely

        line = np.full(len(xyz), -1, np.int64)
        found = np.full((len(xyz), 3), np.nan)
        off = np.full(len(xyz), np.inf)
        if len(xyz) and len(self._line):
            # A millionth more: a place just at the limit counts.
            asked, segment = self._tree.query_nearest(
                shapely.points(xyz[:, :2]), max_distance=within_m * (1 + 1e-6)
            )
            on, away = self._feet(xyz[asked], segment)
            order = np.lexsort((self._line[segment], np.rint(away / _ALIKE_M), asked))
            first = order[np.r_[True, np.diff(asked[order]) > 0]] if len(order) else order
            line[asked[first]] = self._line[segment[first]]
            found[asked[first]] = on[first]
            off[asked[first]] = away[first]
        return NearestPositions(line, found, off)

    def _feet(self, xyz: Floats, segment: Integers) -> tuple[Floats, Floats]:
        """Where places are nearest to segments in plan, with the segments' heights; how far off."""
        start, way = self._starts[segment], self._ways[segment]
        square = (way[:, :2] ** 2).sum(axis=1)
        share = ((xyz - start)[:, :2] * way[:, :2]).sum(axis=1) / square
        on = start + np.clip(share, 0.0, 1.0)[:, None] * way
        return on, np.hypot(*(xyz - on)[:, :2].T)


def length_m(line: Floats) -> float:
    """Length of an (n, 3) line in plan, m."""
    return float(np.hypot(*np.diff(line[:, :2], axis=0).T).sum())


def positions_along(line: Floats, at_m: Floats) -> Floats:
    """(k, 3) places on an (n, 3) line at (k,) lengths from its beginning, in plan."""
    ends = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))]
    return np.column_stack([np.interp(at_m, ends, axis) for axis in line.T])


def middle_positions(line: Floats, step_m: float) -> Floats:
    """(k, 3) places on an (n, 3) line, about so far apart: the middles of equal pieces."""
    long_m = length_m(line)
    count = max(1, round(long_m / step_m))
    return positions_along(line, (np.arange(count) + 0.5) * long_m / count)


def between(line: Floats, start_m: float, end_m: float) -> Floats:
    """The part of an (n, 3) line between two lengths from its beginning, in plan."""
    ends = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))]
    low, high = np.clip([start_m, end_m], 0.0, ends[-1])
    first, last = positions_along(line, np.array([low, high]))
    return np.vstack([first, line[(ends > low) & (ends < high)], last])
