"""The edge of the carriageway on each side of a way, station by station, and what it is there."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.road.edges.cross_cells import CrossCells
from processing.methods.road.edges.edge_facts import PlaceFacts, likeliest_courses
from processing.methods.road.edges.fact_kernels import CELL_M

Source = Literal["edge", "curb", "gap"]
"""What closes the carriageway at a station: an edge without a step, a curb, or nothing seen."""

LEFT, RIGHT = 1, -1

_MOST = 4.0
_TOLD = -0.5
"""Log-odds, as they are learnt of single places, at which those of all stations around tell an
edge as often as not."""

_SEEN = 4
"""Cells to each side of an edge, of which one at least holds points where the edge was seen."""

_CURB_IN, _CURB_OUT = 3, 17
"""Cells in and out of an edge in which a step makes it the front of a curb: behind a gutter, which
is 0.66 m wide at most and a decimetre that its lines may be off."""

_CURB_M, _HIGHEST_M = 0.02, 0.3
_INSIDE, _TOP, _BEHIND, _BANK_M = (-4, -1), (1, 4), (6, 10), 0.05
"""Cells in and out of a step by which its heights are told, without its face; where the ground goes
on rising by more than 1 in 5, or isn't seen, a bank or a wall begins."""

_BLADES = 1.5
"""Standard deviations that blades of grass reach above the ground they stand on."""

_AROUND = 5
"""Stations to each side by whose majority a curb stands; where points are missing it goes on."""

_ENTRANCE = 24
"""Stations, 12 m: so wide are entrances over a lowered curb at most, which belongs to the curb."""


@dataclass(frozen=True)
class EdgeCourse:
    """One side of one way.

    Attributes
    ----------
    side : int
        `LEFT` or `RIGHT`.
    stations : (n,) int64
    places : (n,) int64
        Cell from the way outwards before which the carriageway ends.
    away_m : (n,) float64
        How far from the way it ends, m.
    chances : (n,) float64
        Of an edge there, by what is seen at the station.
    curbs : (n,) bool
        Where a curb stands.
    """

    side: int
    stations: Integers
    places: Integers
    away_m: Floats
    chances: Floats
    curbs: NDArray[np.bool_]

    def source(self, at: int) -> Source:
        """What closes the carriageway at one of its stations."""
        if self.curbs[at]:
            return "curb"
        return "edge" if self.chances[at] >= TOLD else "gap"


TOLD = 0.5
"""Chance from which a station tells an edge."""


def edge_courses(cells: CrossCells, facts: PlaceFacts, monitor: Monitor) -> Iterator[EdgeCourse]:
    """Both sides of each way."""
    stretches = cells.ways.stretches()
    courses = likeliest_courses(facts.outward, stretches, monitor)
    for number, side in enumerate((LEFT, RIGHT)):
        levels, counts = _levels(cells, side), cells.counts[:, _columns(cells, side)]
        for first, end in stretches:
            monitor.check()
            places = courses[first:end, number]
            rows = np.arange(end - first)
            logits = facts.outward[first:end, number][rows, places]
            usual = _shares(np.clip(logits, -_MOST, _MOST), _AROUND)
            usual[_are_blind(counts[first:end], places)] = -_MOST
            yield EdgeCourse(
                side,
                np.arange(first, end),
                places,
                _smooth(np.asarray(places * CELL_M, np.float64), usual > _TOLD),
                1.0 / (1.0 + np.exp(_TOLD - usual)),
                _curbs(levels[first:end], facts.steps[first:end, number], places),
            )


def _columns(cells: CrossCells, side: int) -> slice:
    """The cells of one side, from the way outwards."""
    half = cells.counts.shape[1] // 2
    return slice(half, None) if side == LEFT else slice(half - 1, None, -1)


def _are_blind(counts: NDArray[np.float32], places: Integers) -> Flags:
    """Stations that show nothing on one side of the edge or the other."""
    around = np.clip(places[:, None] + np.arange(-_SEEN, _SEEN), 0, counts.shape[1] - 1)
    near = np.take_along_axis(counts, around, axis=1) > 0
    return np.asarray(~near[:, :_SEEN].any(axis=1) | ~near[:, _SEEN:].any(axis=1))


def _levels(cells: CrossCells, side: int) -> Floats:
    columns = _columns(cells, side)
    heights, rough = cells.heights[:, columns], cells.rough[:, columns]
    return np.asarray(heights - _BLADES * np.exp(np.where(np.isfinite(rough), rough, -np.inf)))


def _curbs(levels: Floats, steps: NDArray[np.float32], places: Integers) -> Flags:
    """Where at most stations around a step leads up to more than 2 cm over the carriageway.

    Parameters
    ----------
    levels : (n, cells) float64
        Heights from the way outwards, m, less what blades of grass may do.
    """
    own = _mean_at(levels, places[:, None], _INSIDE)[:, 0]
    around = places[:, None] + np.arange(-_CURB_IN, _CURB_OUT)
    near = np.take_along_axis(steps, np.clip(around, 0, steps.shape[1] - 1), axis=1)
    top = _mean_at(levels, around, _TOP)
    above = top - own[:, None]
    is_flat = _mean_at(levels, around, _BEHIND) - top <= _BANK_M
    is_curb = (near > _CURB_M) & (above > _CURB_M) & (above < _HIGHEST_M) & is_flat
    mostly = _shares(np.asarray(is_curb.any(axis=1), np.float64), _AROUND) > 0.5
    return _without_entrances(np.asarray(mostly))


def _without_entrances(curbs: Flags) -> Flags:
    """Curbs that go on where they are lowered to the road for a while."""
    whole = curbs.copy()
    standing = np.flatnonzero(curbs)
    for before, after in itertools.pairwise(standing.tolist()):
        if after - before <= _ENTRANCE:
            whole[before:after] = True
    return whole


def _mean_at(values: Floats, at: Integers, span: tuple[int, int]) -> Floats:
    """Means of what is known of some cells about others; NaN where nothing is."""
    total, count = np.zeros(at.shape), np.zeros(at.shape)
    for step in range(*span):
        one = np.take_along_axis(values, np.clip(at + step, 0, values.shape[1] - 1), axis=1)
        known = np.isfinite(one)
        total += np.where(known, one, 0.0)
        count += known
    return np.asarray(total / np.where(count > 0, count, np.nan))


def _shares(values: Floats, around: int) -> Floats:
    """Means over so many neighbours to each side, fewer at the ends."""
    sums = np.r_[0.0, np.cumsum(values)]
    at = np.arange(len(values))
    low, high = np.maximum(at - around, 0), np.minimum(at + around + 1, len(values))
    return np.asarray((sums[high] - sums[low]) / (high - low))


def _smooth(away: Floats, is_told: Flags) -> Floats:
    """Without the width of cells: means with the told neighbours that lie within a decimetre."""
    total, count = np.zeros(len(away)), np.zeros(len(away))
    for step in (-2, -1, 0, 1, 2):
        other = np.clip(np.arange(len(away)) + step, 0, len(away) - 1)
        opposite = np.clip(np.arange(len(away)) - step, 0, len(away) - 1)
        # Both neighbours or none: at an end one of them alone would turn the line.
        fits = (np.abs(away[other] - away) < 0.11) & (np.abs(away[opposite] - away) < 0.11)
        fits &= (is_told[other] & is_told[opposite]) | (step == 0)
        total += np.where(fits, away[other], 0.0)
        count += fits
    return total / count
