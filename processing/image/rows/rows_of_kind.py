"""How each kind of image folds the pulses of a recording into rows.

Pulses are counted at the constant rate of the laser, so the pulse number is the clock of
equations (3-3) to (3-6), free of the rounding of delivered times.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.recording.columns.damaged_pulses import damaged_pulses
from processing.recording.kinds import ImageKind

FIXED_WIDTH_SHARE = 0.99
"""Width of fixed-width kinds in pulses per revolution: a little less, so that no stripes appear."""


_MOST_ROWS = 1 << 25
"""More than a scanner of 200 Hz makes in a day and a half: no recording has as many."""


class RevolutionSource(Protocol):
    """What the image needs to know of a recording's `Revolutions`.

    Attributes
    ----------
    fold_pulses : (R + 1,) int64
        First pulse of every revolution, and of the one after the last.
    reference_times : (R + 1,) float64
        Their times, s.
    row_ends : (R,) int64
        First pulse after revolution k; less than ``fold_pulses[k + 1]`` before a stop.
    segments : (R,) int32
        Changes at stops.
    """

    @property
    def pulses_per_revolution(self) -> float:
        """Pulses in a revolution, median."""

    @property
    def pulse_rate_hz(self) -> float:
        """Pulses in a second."""

    @property
    def fold_pulses(self) -> Integers:
        """First pulses."""

    @property
    def reference_times(self) -> NDArray[np.float64]:
        """Times of the first pulses."""

    @property
    def row_ends(self) -> Integers:
        """First pulses after the revolutions."""

    @property
    def segments(self) -> NDArray[np.int32]:
        """Stretches between stops."""


@dataclass(frozen=True)
class RowPlan:
    """The rows of an image, as runs of pulses.

    A pulse p of row r has the column ``(2 p − doubled_origins[r]) × columns_per_span div
    doubled_spans[r]``. Twice the pulse number is used because rows of the trajectory-centre kind
    begin half-way between two folds; so the arithmetic stays in whole numbers.

    Attributes
    ----------
    first_pulses, end_pulses : (rows,) int64
        Row r holds the pulses ``first_pulses[r] … end_pulses[r] − 1``.
    doubled_origins : (rows,) int64
        Twice the pulse at the left edge of column 0; a row that begins after a stop begins right
        of it.
    doubled_spans : (rows,) int64
        Twice the number of pulses that `columns_per_span` columns show.
    columns_per_span : int
        1 where every pulse has its own pixel.
    segments : (rows,) int32
    widths : (rows,) int64
        Columns of each row.
    """

    first_pulses: Integers
    end_pulses: Integers
    doubled_origins: Integers
    doubled_spans: Integers
    columns_per_span: int
    segments: NDArray[np.int32]
    widths: Integers

    def kept(self, rows: NDArray[np.bool_], segments: NDArray[np.int32]) -> RowPlan:
        """The plan of some of the rows, with the segments of all rows numbered anew."""
        return RowPlan(
            first_pulses=self.first_pulses[rows],
            end_pulses=self.end_pulses[rows],
            doubled_origins=self.doubled_origins[rows],
            doubled_spans=self.doubled_spans[rows],
            columns_per_span=self.columns_per_span,
            segments=segments[rows],
            widths=self.widths[rows],
        )


def plan_of_revolutions(
    kind: ImageKind, revolutions: RevolutionSource, pulses: Integers, folder: Path | None = None
) -> RowPlan:
    """The rows of a recording with revolutions.

    Pulses before the first and after the last fold of a stretch get rows of the usual length, so
    that every point has a pixel.

    Parameters
    ----------
    pulses : (n,) int64
        Pulse of every point, not decreasing.
    folder : Path, optional
        The recording's, to be named where it is damaged.

    Raises
    ------
    BadFile
        Pulses fall between stops, or there are more rows than any recording has.
    """
    pulses_per_revolution = max(1, round(revolutions.pulses_per_revolution))
    stretches = list(_stretches(revolutions, pulses, pulses_per_revolution))
    if not all(stretch.is_possible(pulses_per_revolution) for stretch in stretches):
        raise damaged_pulses(folder)
    parts = [
        _rows_of_stretch(kind, stretch.covered(pulses_per_revolution), pulses_per_revolution)
        for stretch in stretches
    ]
    edges = [part[0] for part in parts]
    origins = np.concatenate([edge[:-1] for edge in edges] or [np.empty(0, np.int64)])
    spans = np.concatenate([np.diff(edge) for edge in edges] or [np.empty(0, np.int64)])
    firsts = np.concatenate([part[1] for part in parts] or [np.empty(0, np.int64)])
    ends = np.concatenate([part[2] for part in parts] or [np.empty(0, np.int64)])
    numbers = [np.full(part[1].size, number, np.int32) for number, part in enumerate(parts)]
    segments = np.concatenate(numbers or [np.empty(0, np.int32)])
    if kind in (ImageKind.REVERSIBLE, ImageKind.TRAJECTORY_REVERSIBLE):
        return RowPlan(firsts, ends, origins, np.full_like(spans, 2), 1, segments, spans // 2)
    width = max(1, round(FIXED_WIDTH_SHARE * revolutions.pulses_per_revolution))
    return RowPlan(firsts, ends, origins, spans, width, segments, np.full_like(spans, width))


def plan_of_cells(cells_per_row: int, cells: Integers, folder: Path | None = None) -> RowPlan:
    """The rows of a top view or a standing scanner's grid, whose cells play the pulses.

    Parameters
    ----------
    cells : (n,) int64
        Cell of every point, not decreasing.
    folder : Path, optional
        The recording's, to be named where it is damaged.

    Raises
    ------
    BadFile
        Cells are less than 0, or more than any recording has.
    """
    if cells.size and not 0 <= int(cells[0]) <= int(cells[-1]) < _MOST_ROWS * cells_per_row:
        raise damaged_pulses(folder)
    rows = int(cells[-1]) // cells_per_row + 1 if cells.size else 0
    firsts = np.arange(rows, dtype=np.int64) * cells_per_row
    return RowPlan(
        first_pulses=firsts,
        end_pulses=firsts + cells_per_row,
        doubled_origins=2 * firsts,
        doubled_spans=np.full(rows, 2, np.int64),
        columns_per_span=1,
        segments=np.zeros(rows, np.int32),
        widths=np.full(rows, cells_per_row, np.int64),
    )


@dataclass(frozen=True)
class _Stretch:
    """Pulses ``start … stop − 1`` between two stops, and the folds between them."""

    start: int
    stop: int
    folds: Integers

    def is_possible(self, pulses_per_revolution: int) -> bool:
        """Whether pulses don't fall in it, and no more rows cover it than a recording has."""
        first, last = min(self.start, int(self.folds[0])), max(self.stop, int(self.folds[-1]))
        return self.start < self.stop and (last - first) // pulses_per_revolution < _MOST_ROWS

    def covered(self, pulses_per_revolution: int) -> _Stretch:
        """The same with folds at the usual distance before and after, as far as it goes."""
        folds = self.folds
        before = max(0, -(-(int(folds[0]) - self.start) // pulses_per_revolution))
        after = max(0, -(-(self.stop - int(folds[-1])) // pulses_per_revolution))
        firsts = folds[0] - pulses_per_revolution * np.arange(before, 0, -1, dtype=np.int64)
        lasts = folds[-1] + pulses_per_revolution * np.arange(1, after + 1, dtype=np.int64)
        return _Stretch(self.start, self.stop, np.concatenate([firsts, folds, lasts]))


def _stretches(
    revolutions: RevolutionSource, pulses: Integers, pulses_per_revolution: int
) -> Iterator[_Stretch]:
    """Parts of the recording between stops; together they hold every pulse with a point."""
    rows = revolutions.row_ends.size
    starts = np.flatnonzero(np.diff(revolutions.segments, prepend=revolutions.segments[:1] - 1))
    stops = np.append(starts[1:], rows)
    after = 0  # points before this one are in earlier stretches
    for first_row, end_row in zip(starts, stops, strict=True):
        is_last = end_row == rows
        limit = int(revolutions.row_ends[end_row - 1])
        end = pulses.size if is_last else int(np.searchsorted(pulses, limit))
        if end <= after:
            continue
        folds = np.array(revolutions.fold_pulses[first_row : end_row + 1])
        if limit < folds[-1]:
            # The laser stopped in this revolution; the next fold belongs to after the stop.
            folds[-1] = max(int(folds[-2]) + pulses_per_revolution, limit)
        start, stop = int(pulses[after]), int(pulses[end - 1]) + 1
        yield _Stretch(start, stop, np.unique(folds))
        after = end


def _rows_of_stretch(
    kind: ImageKind, stretch: _Stretch, pulses_per_revolution: int
) -> tuple[Integers, Integers, Integers]:
    """Doubled row edges (rows + 1,), first and end pulses (rows,) of a stretch."""
    folds = stretch.folds
    if kind is ImageKind.REVERSIBLE:
        rows = -(-(stretch.stop - stretch.start) // pulses_per_revolution)
        edges = 2 * (stretch.start + pulses_per_revolution * np.arange(rows + 1, dtype=np.int64))
    elif kind is ImageKind.TRAJECTORY_CENTER:
        middles = folds[:-1] + folds[1:]
        first, last = 2 * folds[:1] - pulses_per_revolution, 2 * folds[-1:] + pulses_per_revolution
        edges = np.concatenate([first, middles, last])
    else:
        edges = 2 * folds
    # The first whole pulse at or after an edge.
    limits = np.clip(-(-edges // 2), stretch.start, stretch.stop)
    filled = np.flatnonzero(limits[1:] > limits[:-1])
    inside = slice(int(filled[0]), int(filled[-1]) + 2)
    edges, limits = edges[inside], limits[inside]
    return edges, limits[:-1], limits[1:]
