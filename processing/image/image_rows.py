"""ImageRows: where the rows of an image begin in a recording, kept beside it.

To find them every pulse of the recording is read, seconds for some hundred million points; a
project is opened more often than imported. What is kept may be deleted at any time.
"""

from __future__ import annotations

import threading
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.image.gaps import STOP_S, closed_up
from processing.image.kinds import ImageKind
from processing.image.rows_of_kind import Revolutions, RowPlan, plan_of_cells, plan_of_turns
from processing.points.array_files import read_arrays
from processing.points.ordering import read_stretch, stretches

_Integers = NDArray[np.int64]

_POINTS_AT_ONCE = 4_000_000
_FEW_POINTS = 100_000
"""Found anew sooner than read."""

_MADE_OF = "made_of"


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

    row_starts: _Integers
    origins: _Integers
    spans: _Integers
    per_span: int
    segments: NDArray[np.int32]
    widths: _Integers


def image_rows(
    kind: ImageKind, pulses: _Integers, folding: Revolutions | int, folder: Path | None = None
) -> ImageRows:
    """The rows of an image.

    Parameters
    ----------
    pulses : (n,) int64
        Pulse of every point, not decreasing.
    folding : Revolutions or int
        The recording's turns; of a recording without, the number of cells per row.
    folder : Path, optional
        The recording's; rows that were found are kept there and taken from there.
    """
    if folder is None or pulses.size < _FEW_POINTS:
        return _found(kind, pulses, folding, None)
    path = folder / f"image_rows_{kind.value}.npz"
    made_of = _made_of(pulses, folding)
    kept = _read(path, made_of)
    if kept is None:
        kept = _found(kind, pulses, folding, folder)
        _write(path, kept, made_of)
    return kept


def _found(
    kind: ImageKind, pulses: _Integers, folding: Revolutions | int, folder: Path | None
) -> ImageRows:
    if isinstance(folding, int):
        plan = plan_of_cells(folding, pulses)
        starts = _row_starts(plan, pulses, folder)
    else:
        plan = plan_of_turns(kind, folding, pulses)
        starts = _row_starts(plan, pulses, folder)
        plan, starts = closed_up(plan, starts, pulses, STOP_S * folding.pulse_rate_hz)
    return ImageRows(
        starts,
        plan.doubled_origins,
        plan.doubled_spans,
        plan.columns_per_span,
        plan.segments,
        plan.widths,
    )


def _row_starts(plan: RowPlan, pulses: _Integers, folder: Path | None) -> _Integers:
    """(rows + 1,) int64: where the points of each row begin."""
    firsts = plan.first_pulses
    starts = np.full(firsts.size + 1, pulses.size, np.int64)
    done = 0
    for start, stretch in _stretches_of(pulses, folder):
        # Rows that begin behind the stretch are sought in the next one.
        end = int(np.searchsorted(firsts, stretch[-1], side="right"))
        starts[done:end] = start + np.searchsorted(stretch, firsts[done:end])
        done = end
    return starts


def _stretches_of(pulses: _Integers, folder: Path | None) -> Iterator[tuple[int, _Integers]]:
    """First point and pulses of consecutive stretches; read, for what is mapped stays in memory."""
    for start, stop in stretches(pulses.size, _POINTS_AT_ONCE):
        if folder is None:
            yield start, pulses[start:stop]
        else:
            yield start, read_stretch(folder, "pulse", start, stop)


def _made_of(pulses: _Integers, folding: Revolutions | int) -> _Integers:
    """A few numbers that are others for other pulses or turns."""
    ends = [pulses.size, int(pulses[0]), int(pulses[-1])]
    if isinstance(folding, int):
        return np.array([*ends, folding], np.int64)
    sums = [
        int(np.sum(values, dtype=np.int64))
        for values in (folding.fold_pulses, folding.row_ends, folding.segments)
    ]
    rates = np.array([folding.pulses_per_turn, folding.pulse_rate_hz]).view(np.int64)
    return np.array([*ends, folding.fold_pulses.size, *sums, *rates.tolist()], np.int64)


def _read(path: Path, made_of: _Integers) -> ImageRows | None:
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
    return rows if _fits(rows) else None


def _fits(rows: ImageRows) -> bool:
    """Whether arrays belong to each other."""
    count = rows.row_starts.size - 1
    others = (rows.origins, rows.spans, rows.segments, rows.widths)
    return all(values.shape == (count,) for values in others)


def _write(path: Path, rows: ImageRows, made_of: _Integers) -> None:
    temporary = path.with_suffix(f".{threading.get_ident()}.part")
    try:
        with temporary.open("wb") as file:
            np.savez(file, allow_pickle=False, **{_MADE_OF: made_of}, **vars(rows))
        temporary.replace(path)
    except OSError:
        # A read-only or full disk: the rows are found again next time.
        temporary.unlink(missing_ok=True)
