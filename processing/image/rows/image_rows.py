"""ImageRows: where the rows of an image begin in a recording, kept beside it.

To find them every pulse of the recording is read, seconds for some hundred million points; a
project is opened more often than imported. What is kept may be deleted at any time.
"""

from __future__ import annotations

import threading
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.owned_files import new_file
from processing.image.rows.gaps import STOP_S, close_gaps
from processing.image.rows.rows_of_kind import (
    RevolutionSource,
    RowPlan,
    plan_of_cells,
    plan_of_revolutions,
)
from processing.recording.columns.array_files import read_arrays
from processing.recording.columns.columns import column_path
from processing.recording.columns.damaged_pulses import damaged_pulses
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.kinds import ImageKind

_POINTS_AT_ONCE = 4_000_000
"""Pulses read at a time: 32 MB."""

_FEW_POINTS = 100_000
"""Rows of a recording with fewer points are found anew sooner than read."""

_MADE_OF = "made_of"

_MOST_PIXELS = 1 << 40
"""The facts on the tiles of more would not fit in memory; no recording has as many."""

_ASKED_ROWS = 512
"""Of kept rows so many are held against the pulses: few enough for a disk that must seek."""


@dataclass(frozen=True, eq=False)
class ImageRows:
    """The rows of one kind of image over one recording.

    Attributes
    ----------
    row_starts : (rows + 1,) int64
        Row r holds the points ``row_starts[r] … row_starts[r + 1] − 1``.
    origins, spans : (rows,) int64
        As `RowPlan.doubled_origins` and `RowPlan.doubled_spans`.
    per_span : int
        As `RowPlan.columns_per_span`.
    segments : (rows,) int32
    widths : (rows,) int64
    """

    row_starts: Integers
    origins: Integers
    spans: Integers
    per_span: int
    segments: NDArray[np.int32]
    widths: Integers


def image_rows(
    kind: ImageKind, pulses: Integers, folding: RevolutionSource | int, folder: Path | None = None
) -> ImageRows:
    """The rows of an image.

    Parameters
    ----------
    pulses : (n,) int64
        Pulse of every point, not decreasing.
    folding : Revolutions or int
        The recording's revolutions; of a recording without, the number of cells per row.
    folder : Path, optional
        The recording's; rows that were found are kept there and taken from there.

    Raises
    ------
    BadFile
        The pulses are damaged.
    """
    plan = (
        plan_of_cells(folding, pulses, folder)
        if isinstance(folding, int)
        else plan_of_revolutions(kind, folding, pulses, folder)
    )
    if folder is None or pulses.size < _FEW_POINTS:
        return _find_rows(plan, pulses, folding, folder)
    path = _path(folder, kind)
    made_of = _made_of(pulses, folding, folder)
    kept = _read(path, made_of)
    if kept is None or not _belongs(kept, plan, pulses):
        kept = _find_rows(plan, pulses, folding, folder)
        _write(path, kept, made_of)
    return kept


def forget_rows(kind: ImageKind, folder: Path | None) -> None:
    """Have the rows of an image found anew the next time."""
    if folder is not None:
        # Where it can't be removed it can't be written either, and no other rows are kept.
        with suppress(OSError):
            _path(folder, kind).unlink(missing_ok=True)


def _path(folder: Path, kind: ImageKind) -> Path:
    return folder / f"image_rows_{kind.value}.npz"


def _find_rows(
    plan: RowPlan, pulses: Integers, folding: RevolutionSource | int, folder: Path | None
) -> ImageRows:
    starts = _row_starts(plan, pulses, folder)
    if not isinstance(folding, int):
        plan, starts = close_gaps(plan, starts, pulses, STOP_S * folding.pulse_rate_hz)
    found = ImageRows(
        starts,
        plan.doubled_origins,
        plan.doubled_spans,
        plan.columns_per_span,
        plan.segments,
        plan.widths,
    )
    if not _fits(found, pulses.size):
        raise damaged_pulses(folder)
    return found


def _row_starts(plan: RowPlan, pulses: Integers, folder: Path | None) -> Integers:
    """(rows + 1,) int64: where the points of each row begin; refuses pulses that fall."""
    firsts = plan.first_pulses
    starts = np.full(firsts.size + 1, pulses.size, np.int64)
    done, before = 0, pulses[:1]
    for start, stretch in _stretches_of(pulses, folder):
        if stretch[0] < before[0] or (stretch[1:] < stretch[:-1]).any():
            raise damaged_pulses(folder)
        before = stretch[-1:]
        # Rows that begin behind the stretch are sought in the next one.
        end = int(np.searchsorted(firsts, stretch[-1], side="right"))
        starts[done:end] = start + np.searchsorted(stretch, firsts[done:end])
        done = end
    return starts


def _stretches_of(pulses: Integers, folder: Path | None) -> Iterator[tuple[int, Integers]]:
    """First point and pulses of consecutive stretches; read, for what is mapped stays in memory."""
    for start, stop in chunk_ranges(pulses.size, _POINTS_AT_ONCE):
        if folder is None:
            yield start, pulses[start:stop]
        else:
            yield start, read_chunk(folder, "pulse", start, stop)


def _made_of(pulses: Integers, folding: RevolutionSource | int, folder: Path) -> Integers:
    """A few numbers that differ for other pulses or revolutions, or for pulses written since."""
    path = column_path(folder, "pulse")
    written_ns = path.stat().st_mtime_ns if path.is_file() else 0
    ends = [pulses.size, int(pulses[0]), int(pulses[-1]), written_ns]
    if isinstance(folding, int):
        return np.array([*ends, folding], np.int64)
    sums = [
        int(np.sum(values, dtype=np.int64))
        for values in (folding.fold_pulses, folding.row_ends, folding.segments)
    ]
    rates = np.array([folding.pulses_per_revolution, folding.pulse_rate_hz]).view(np.int64)
    return np.array([*ends, folding.fold_pulses.size, *sums, *rates.tolist()], np.int64)


def _read(path: Path, made_of: Integers) -> ImageRows | None:
    try:
        kept = read_arrays(path)
        if not np.array_equal(kept[_MADE_OF], made_of):
            return None
        rows = ImageRows(
            row_starts=kept["row_starts"],
            origins=kept["origins"],
            spans=kept["spans"],
            per_span=int(kept["per_span"]),
            segments=kept["segments"],
            widths=kept["widths"],
        )
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile):
        # What can be computed again is computed again when the file is lost or damaged.
        return None
    return rows if _fits(rows, int(made_of[0])) else None


def _fits(rows: ImageRows, points: int) -> bool:
    """Whether arrays belong to each other, and kernels may go by them."""
    starts, count = rows.row_starts, rows.row_starts.size - 1
    others = (rows.origins, rows.spans, rows.widths)
    if not all(values.shape == (count,) for values in (*others, rows.segments)):
        return False
    types = {values.dtype for values in (starts, *others)}
    if starts.ndim != 1 or types != {np.dtype(np.int64)} or rows.segments.dtype != np.int32:
        return False
    ends_fit = starts[0] == (0 if count else points) and starts[-1] == points
    are_rising = (np.diff(starts) >= 0).all() and (np.diff(rows.segments) >= 0).all()
    least = min(rows.per_span, int(rows.spans.min(initial=1)), int(rows.widths.min(initial=1)))
    pixels = int(rows.widths.max(initial=0)) * count
    return bool(ends_fit and are_rising and least >= 1 and pixels <= _MOST_PIXELS)


def _belongs(kept: ImageRows, plan: RowPlan, pulses: Integers) -> bool:
    """Whether kept rows are some of a plan's, and points lie in theirs, as far as is asked."""
    if kept.per_span != plan.columns_per_span:
        return False
    if not kept.origins.size:
        return True
    order = np.argsort(plan.doubled_origins, kind="stable")
    positions = np.searchsorted(plan.doubled_origins, kept.origins, sorter=order)
    same = order[np.minimum(positions, order.size - 1)]
    is_planned = plan.doubled_origins[same] == kept.origins
    is_planned &= plan.doubled_spans[same] == kept.spans
    is_planned &= plan.widths[same] == kept.widths
    filled = np.flatnonzero(np.diff(kept.row_starts))
    asked = filled[:: -(-filled.size // _ASKED_ROWS)]
    ends = np.stack([kept.row_starts[asked], kept.row_starts[asked + 1] - 1])
    columns = (2 * pulses[ends] - kept.origins[asked]) * kept.per_span // kept.spans[asked]
    are_inside = (columns >= 0) & (columns < kept.widths[asked])
    return bool(is_planned.all() and are_inside.all())


def _write(path: Path, rows: ImageRows, made_of: Integers) -> None:
    temporary = path.with_suffix(f".{threading.get_ident()}.part")
    try:
        with new_file(temporary) as file:
            np.savez(file, allow_pickle=False, **{_MADE_OF: made_of}, **vars(rows))
        temporary.replace(path)
    except OSError:
        # A read-only or full disk: the rows are found again next time.
        temporary.unlink(missing_ok=True)
