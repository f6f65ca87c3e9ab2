"""Labels and results of a drive, carried over to a folder that has its points in another order.

Normals, shapes and segments rest on the rows, which are others: they are found anew.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import forget_sums, refuse_damaged
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.recording.columns.columns import COLUMN_TYPES, column_path
from processing.recording.columns.error_map import ERROR_MAP
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.drive import Drive

_COLUMNS = ("label", ERROR_MAP, "seen_color", "is_seen", "height_above_ground", "confidence")
_WHOLE = ("camera_offsets.json", "ground_surface.tiles")
_TRUTHS, _FINDINGS, _GIVEN = "truths/*/truth.bin", "runs/*/*.bits", "runs/*/*.codes"
_BYTE = 8


def results_mark(drive: Drive) -> tuple[tuple[str, int, int], ...]:
    """By what it is seen that labels or results of a drive have changed: sizes and times."""
    marks = []
    for path in _files(drive):
        with report_as_user_error(path):
            status = path.stat()
        name = path.relative_to(drive.folder).as_posix()
        marks.append((name, status.st_size, status.st_mtime_ns))
    return tuple(marks)


def carry_results(drive: Drive, folder: Path, positions: Path | None, monitor: Monitor) -> None:
    """Give a drive's labels and results to the folder that is to take its place.

    Parameters
    ----------
    positions : Path or None
        Where each point of the folder is in the drive, int64; None where all are in their places.

    Raises
    ------
    NoSpace, Cancelled
    """
    before = None if positions is None else np.memmap(positions, "<i8", "r", shape=(drive.count,))
    for path in _files(drive):
        monitor.check()
        target = folder / path.relative_to(drive.folder)
        refuse_damaged(path)
        with report_as_user_error(target):
            target.parent.mkdir(parents=True, exist_ok=True)
            forget_sums(target)
            if before is None or path.name in _WHOLE:
                shutil.copy2(path, target)
            elif path.suffix == ".bits":
                _carry_bits(path, target, before)
            else:
                _carry_column(path, target, before)


def _files(drive: Drive) -> list[Path]:
    named = [column_path(drive.folder, name) for name in _COLUMNS]
    named += [drive.folder / name for name in _WHOLE]
    found = [
        path
        for pattern in (_TRUTHS, _FINDINGS, _GIVEN)
        for path in sorted(drive.folder.glob(pattern))
    ]
    return [*(path for path in named if path.is_file()), *found]


def _carry_column(path: Path, target: Path, before: NDArray[np.int64]) -> None:
    is_given = path.suffix == Path(_GIVEN).suffix
    dtype, width = COLUMN_TYPES["label" if is_given else path.stem]
    shape = (before.size,) if width == 1 else (before.size, width)
    values = np.memmap(path, dtype, "r", shape=shape)
    with target.open("wb") as file:
        for start, stop in chunk_ranges(before.size):
            file.write(np.ascontiguousarray(values[before[start:stop]]).data)


def _carry_bits(path: Path, target: Path, before: NDArray[np.int64]) -> None:
    """Bits that say yes or no about each point; stretches are whole bytes but for the last."""
    packed = np.memmap(path, np.uint8, "r")
    with target.open("wb") as file:
        for start, stop in chunk_ranges(before.size):
            positions = np.asarray(before[start:stop])
            bits = (
                packed[positions // _BYTE] >> (_BYTE - 1 - positions % _BYTE).astype(np.uint8) & 1
            )
            file.write(np.packbits(bits).tobytes())
