"""What somebody painted, as rows of features that trees can learn from.

What was left as it was says something too: whoever corrects a street looks at what is around. Where
the trees were sure and nobody painted, they are held to what they said, so that a correction of
some things doesn't change others.
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
from processing.methods.classes.boosting import Examples
from processing.methods.classes.class_models import ClassModels
from processing.methods.classes.class_trees import class_shares
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

_LEFT_CELLS = 150
"""Of each class and part that were left as they are; enough to hold the trees to what they said,
few beside what was painted."""

_CODES = 256


@dataclass(frozen=True)
class PaintedCells:
    """Cells that were painted, and some about them that were left as they were.

    Attributes
    ----------
    painted, left : Examples
        With weights of 1.
    painted_places, left_places : (n,) int64
        The place of each, by a number that is the same for no two places.
    """

    painted: Examples
    left: Examples
    painted_places: Integers
    left_places: Integers

    @staticmethod
    def joined(parts: Sequence[PaintedCells]) -> PaintedCells:
        """Those of several parts or drives, of one at least."""
        return PaintedCells(
            Examples.joined([one.painted for one in parts]),
            Examples.joined([one.left for one in parts]),
            np.concatenate([one.painted_places for one in parts]),
            np.concatenate([one.left_places for one in parts]),
        )


def painted_cells(
    drive: Drive,
    by_hand: NDArray[np.uint8],
    scratch: Path,
    monitor: Monitor,
    *,
    models: ClassModels,
) -> Iterator[PaintedCells]:
    """The cells of a drive that somebody painted, and some beside them, a part at a time.

    Parameters
    ----------
    by_hand : (n,) uint8
        Labels set by hand; 0 elsewhere.
    scratch : Path
        A folder for files meanwhile; the caller deletes it.

    Raises
    ------
    NoSpace, Cancelled
    """
    rng = np.random.default_rng(0)
    is_wanted = by_hand > 0
    parts = cells_of_drive(drive, scratch, monitor, most=_POINTS_PER_PART, wanted=is_wanted)
    for one in parts:
        labels = by_hand[one.points]
        # What is around a part is another part's own.
        labels[one.own :] = 0
        rows = rows_seen_again(one.cells, models, monitor)
        codes = _codes_of_cells(one.cells.cell_of, labels, len(rows))
        shares = class_shares(models.again, rows, monitor)
        is_own = np.zeros(len(rows), np.bool_)
        is_own[one.cells.cell_of[: one.own]] = True
        said = np.where(shares.max(axis=1) >= _SURE, models.again.codes[shares.argmax(axis=1)], 0)
        said[(codes > 0) | ~is_own] = 0
        chosen, places = codes > 0, _places_of(one)
        left = _some_of_each(said, rng)
        yield PaintedCells(
            Examples.alike(rows[chosen], codes[chosen]),
            Examples.alike(rows[left], said[left].astype(np.uint8)),
            places[chosen],
            places[left],
        )


def _codes_of_cells(
    cell_of: NDArray[np.int32], labels: NDArray[np.uint8], count: int
) -> NDArray[np.uint8]:
    """(c,) the label of most painted points of each cell; 0 where none was."""
    is_painted = labels > 0
    places = cell_of[is_painted].astype(np.int64) * _CODES + labels[is_painted]
    votes = np.bincount(places, minlength=count * _CODES).reshape(count, _CODES)
    return votes.argmax(axis=1).astype(np.uint8)


def _places_of(part: PartCells) -> Integers:
    """(c,) the place of each cell's first point."""
    count = len(part.cells.rows)
    first = np.zeros(count, np.int64)
    first[part.cells.cell_of[::-1]] = np.arange(part.points.size)[::-1]
    squares = np.floor(part.xyz[first, :2] / PLACE_M).astype(np.int64)
    places: Integers = (squares[:, 0] << 32) + squares[:, 1]
    return places


def _some_of_each(codes: NDArray[np.integer], rng: Generator) -> Integers:
    """Some of each class's, rising."""
    chosen = [np.empty(0, np.int64)]
    for code in np.unique(codes[codes > 0]):
        of_class = np.flatnonzero(codes == code)
        few = min(of_class.size, _LEFT_CELLS)
        chosen.append(rng.choice(of_class, few, replace=False))
    return np.sort(np.concatenate(chosen))
