"""The column of labels: read where it may be missing, and written in place, point by point."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import (
    BLOCK,
    begin_writing,
    end_writing,
    is_whole,
    settle_sums,
)
from processing.core.errors import report_as_user_error
from processing.recording.columns.columns import column_path
from processing.recording.columns.replacing import flush_names
from processing.recording.drive import Drive

LABEL = "label"
CODES = 256


def labels_of(drive: Drive, points: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Labels of points, 0 without; a copy of the points' shape.

    Raises
    ------
    BadFile
        The column is not as long as the drive has points.
    """
    if not drive.columns.has(LABEL):
        return np.zeros(points.shape, np.uint8)
    labels: NDArray[np.uint8] = np.asarray(drive.columns[LABEL])[points]
    return labels


def make_column(drive: Drive) -> None:
    """Let a drive have a column of labels, on which the disk's room is spent from now on.

    Raises
    ------
    BadFile
        The column is there, and not as long as the drive has points.
    NoSpace
        There is no room; the drive is as it was.
    """
    if not drive.columns.has(LABEL):
        drive.columns.add(LABEL, np.zeros(drive.count, np.uint8))
    elif drive.columns[LABEL].shape != (drive.count,):
        message = "a column is mapped in another shape than it has"
        raise RuntimeError(message)


def write_labels(drive: Drive, points: NDArray[np.int64], codes: NDArray[np.uint8]) -> None:
    """Write labels of points into the column that :func:`make_column` made.

    Parameters
    ----------
    points : (n,) int64
        Rising.
    codes : (n,) uint8

    Raises
    ------
    MissingInput, NoSpace
        The file can't be written; some of the points may have been.
    """
    write_codes(column_path(drive.folder, LABEL), points, codes)


def write_codes(path: Path, points: NDArray[np.int64], codes: NDArray[np.uint8]) -> None:
    """Write labels of points into the file of a column, as :func:`write_labels`.

    Raises
    ------
    MissingInput, NoSpace
        The file can't be written; some of the points may have been.
    """
    with report_as_user_error(path), path.open("rb+", buffering=0) as file:
        known, written = begin_writing(path), dict[int, bool]()
        try:
            for start, part in _by_block(points):
                file.seek(start)
                block = bytearray(file.read(BLOCK))
                number = start // BLOCK
                written[number] = known is None or is_whole(block, known, number)
                np.frombuffer(block, np.uint8)[points[part] - start] = codes[part]
                file.seek(start)
                _write_all(file.fileno(), block)
        finally:
            end_writing(path, known, written)


def settle_labels(drive: Drive, points: NDArray[np.int64]) -> None:
    """Know the column again by its checksums after a kill while these points were written.

    Raises
    ------
    MissingInput, NoSpace
    """
    path = column_path(drive.folder, LABEL)
    with report_as_user_error(path):
        settle_sums(path, np.unique(points // BLOCK).tolist())


def flush(drive: Drive) -> None:
    """Wait until what was written is on the disk.

    Raises
    ------
    MissingInput, NoSpace
        It can't be written.
    """
    path = column_path(drive.folder, LABEL)
    with report_as_user_error(path), path.open("rb+") as file:
        os.fsync(file.fileno())
    with report_as_user_error(path):
        flush_names(drive.folder)


def _by_block(points: NDArray[np.int64]) -> Iterator[tuple[int, slice]]:
    """First byte of each block that holds points, and which points they are."""
    blocks = points // BLOCK
    firsts = np.concatenate([[0], np.flatnonzero(np.diff(blocks)) + 1, [points.size]])
    for first, end in zip(firsts[:-1].tolist(), firsts[1:].tolist(), strict=True):
        if end > first:
            yield int(blocks[first]) * BLOCK, slice(first, end)


def _write_all(descriptor: int, block: bytearray) -> None:
    left = memoryview(block)
    while left:
        left = left[os.write(descriptor, left) :]
