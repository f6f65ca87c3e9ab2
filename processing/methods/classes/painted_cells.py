"""What somebody painted, as rows of features that trees can learn from.

What was left as it was says something too: whoever corrects a street looks at what is around. A
brush changes nothing where the class is right already, so cells beside the paint that a run gave a
class count as confirmed: from mistakes alone trees would learn that nothing is right. Where they
were sure and nobody painted near by, they are held to what they said, so that a correction of some
things doesn't change others.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.monitor import Monitor
from processing.methods.classes.boosting import ClassExamples
from processing.methods.classes.class_models import ClassModels
from processing.methods.classes.drive_classes import PartCells, cells_of_drive, rows_seen_again
from processing.recording.drive import Drive

PLACE_M = 10.0
"""Side of the squares that count as one place: twice as far as features see (4.8 m), so that what
is learnt at one place has hardly been seen from another."""

_POINTS_PER_PART = 300_000
"""Points in memory at a time, with those around: parts are small, since most hold no paint."""

_SURE = 0.8
"""From which confidence on it counts what was said and left as it is: four of five such cells of
unseen streets are right, which is the worst that may be taught where nobody painted."""

_PAINTED_CELLS, _LEFT_CELLS = 300, 150
"""Of each class that are learnt from, at a place and in a part: a wall that is labelled by one
click has thousands that say the same, and what was left should not be more than the paint."""

_BESIDE_LEVEL = 2
"""Cells of 0.4 m: within one of them the usual brush (0.3 m) covers most. In cells of 0.8 m there
is more that is wrong and not painted yet (street_worn: gains of 1.0 and 1.9 points)."""

_CODES = 256


@dataclass(frozen=True)
class PaintedLabels:
    """The labels of a drive's points, by where they come from.

    Attributes
    ----------
    by_hand, by_runs : (n,) uint8
        Each 0 where it has none.
    """

    by_hand: NDArray[np.uint8]
    by_runs: NDArray[np.uint8]


@dataclass(frozen=True)
class PaintedCells:
    """Cells that were painted, and some about them that were left as they were.

    Attributes
    ----------
    painted, left : ClassExamples
        With weights of 1. What was confirmed beside the paint counts as painted.
    painted_places, left_places : (n,) int64
        The place of each, by a number that is the same for no two places.
    classes : frozenset of int
        Those that were painted by hand.
    """

    painted: ClassExamples
    left: ClassExamples
    painted_places: Integers
    left_places: Integers
    classes: frozenset[int]

    @staticmethod
    def joined(parts: Sequence[PaintedCells]) -> PaintedCells:
        """Those of several parts or drives, of one at least."""
        return PaintedCells(
            ClassExamples.joined([one.painted for one in parts]),
            ClassExamples.joined([one.left for one in parts]),
            np.concatenate([one.painted_places for one in parts]),
            np.concatenate([one.left_places for one in parts]),
            frozenset[int]().union(*(one.classes for one in parts)),
        )


def painted_cells(
    drive: Drive,
    labels: PaintedLabels,
    scratch: Path,
    monitor: Monitor,
    *,
    models: ClassModels,
) -> Iterator[PaintedCells]:
    """The cells of a drive that somebody painted, and some beside them, a part at a time.

    Parameters
    ----------
    labels : PaintedLabels
    scratch : Path
        A folder for files meanwhile; the caller deletes it.

    Raises
    ------
    NoSpace, Cancelled
    """
    rng = np.random.default_rng(0)
    is_wanted = labels.by_hand > 0
    parts = cells_of_drive(drive, scratch, monitor, most=_POINTS_PER_PART, wanted=is_wanted)
    for one in parts:
        rows = rows_seen_again(one.cells, models, monitor)
        codes = _told_codes(one, labels, rng)
        shares = models.say_again(rows, monitor)
        is_own = np.zeros(len(rows), np.bool_)
        is_own[one.cells.cell_of[: one.own]] = True
        said = np.where(shares.max(axis=1) >= _SURE, models.codes[shares.argmax(axis=1)], 0)
        said[(codes > 0) | ~is_own] = 0
        places = _places_of(one)
        chosen = _some_at_each_place(codes, places, rng)
        left = _some_of_each(said, rng, _LEFT_CELLS)
        yield PaintedCells(
            ClassExamples.alike(rows[chosen], codes[chosen]),
            ClassExamples.alike(rows[left], said[left].astype(np.uint8)),
            places[chosen],
            places[left],
            frozenset(np.unique(labels.by_hand[one.points[: one.own]]).tolist()) - {0},
        )


def _told_codes(part: PartCells, labels: PaintedLabels, rng: Generator) -> NDArray[np.uint8]:
    """(c,) the class of each of a part's own cells that was painted, or confirmed beside paint.

    As many are confirmed as were painted at most: what is painted is sure.
    """
    own, count = part.points[: part.own], len(part.cells.rows)
    cell_of = part.cells.cell_of[: part.own]
    codes = _codes_of_cells(cell_of, np.asarray(labels.by_hand[own]), count)
    stands = _codes_of_cells(cell_of, np.asarray(labels.by_runs[own]), count)
    around = part.cells.held_by[_BESIDE_LEVEL]
    is_beside = np.isin(around, np.unique(around[codes > 0])) & (codes == 0) & (stands > 0)
    beside, painted = np.flatnonzero(is_beside), int(np.count_nonzero(codes))
    some = rng.choice(beside, min(beside.size, painted), replace=False)
    codes[some] = stands[some]
    return codes


def _codes_of_cells(
    cell_of: NDArray[np.int32], labels: NDArray[np.uint8], count: int
) -> NDArray[np.uint8]:
    """(c,) the label of most painted points of each cell; 0 where none was."""
    is_painted = labels > 0
    places = cell_of[is_painted].astype(np.int64) * _CODES + labels[is_painted]
    votes = np.bincount(places, minlength=count * _CODES).reshape(count, _CODES)
    codes: NDArray[np.uint8] = votes.argmax(axis=1).astype(np.uint8)
    return codes


def _places_of(part: PartCells) -> Integers:
    """(c,) the place of each cell's first point."""
    count = len(part.cells.rows)
    first = np.zeros(count, np.int64)
    first[part.cells.cell_of[::-1]] = np.arange(part.points.size)[::-1]
    squares = np.floor(part.xyz[first, :2] / PLACE_M).astype(np.int64)
    places: Integers = (squares[:, 0] << 32) + squares[:, 1]
    return places


def _some_at_each_place(codes: NDArray[np.uint8], places: Integers, rng: Generator) -> Integers:
    """Some of each class's at each place, rising."""
    painted = np.flatnonzero(codes)
    chosen = [np.empty(0, np.int64)]
    for place in np.unique(places[painted]):
        here = painted[places[painted] == place]
        chosen.append(here[_some_of_each(codes[here], rng, _PAINTED_CELLS)])
    return np.sort(np.concatenate(chosen))


def _some_of_each(codes: NDArray[np.integer], rng: Generator, most: int) -> Integers:
    """Some of each class's, rising."""
    chosen = [np.empty(0, np.int64)]
    for code in np.unique(codes[codes > 0]):
        of_class = np.flatnonzero(codes == code)
        few = min(of_class.size, most)
        chosen.append(rng.choice(of_class, few, replace=False))
    return np.sort(np.concatenate(chosen))
