"""What a run said about each point, one bit a point, so that it can be judged on another day.

The labels that came of a run change with undo and by hand, and to run the tool again takes its
time; a bit a point is an eighth of the smallest column. It lies in the drive's folder, in
``runs/<run>.bits``; the runs of the project say with which parameters it was made.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.errors import told_as_user_error
from processing.points.drive import Drive
from processing.score.point_classes import is_one_of
from processing.tools.tool import FinishedColumns

_CLASS = "classification"
_FOLDER, _ENDING = "runs", ".bits"
_AT_ONCE = 1 << 20
_BYTE = 8


def finding_path(drive: Drive, run: str) -> Path:
    """Where what a run said about a drive is kept."""
    return drive.folder / _FOLDER / f"{run}{_ENDING}"


def write_finding(result: FinishedColumns, codes: Collection[int], path: Path) -> None:
    """Keep which points of a result have one of some classes.

    Raises
    ------
    NoSpace
    """
    with told_as_user_error(path), path.open("wb") as file:
        for start in range(0, result.count, _AT_ONCE):
            stop = min(start + _AT_ONCE, result.count)
            found = is_one_of(result.read(_CLASS, start, stop), codes)
            file.write(np.packbits(found).tobytes())


def adopt_finding(drive: Drive, run: str, file: Path) -> None:
    """Let a finished file on the drive's disk be what a run said.

    Raises
    ------
    NoSpace, MissingInput, InUse
    """
    path = finding_path(drive, run)
    with told_as_user_error(path):
        path.parent.mkdir(exist_ok=True)
        file.replace(path)


def has_finding(drive: Drive, run: str) -> bool:
    """Whether it is kept, whole, what a run said about a drive."""
    path = finding_path(drive, run)
    return path.is_file() and path.stat().st_size == -(-drive.count // _BYTE)


def read_finding(drive: Drive, run: str, start: int, stop: int) -> NDArray[np.bool_]:
    """Whether a run said yes about the points ``start … stop − 1``: (k,) bool.

    Raises
    ------
    MissingInput
        It isn't kept.
    """
    path = finding_path(drive, run)
    first = start // _BYTE
    with told_as_user_error(path):
        packed = np.fromfile(path, np.uint8, count=-(-stop // _BYTE) - first, offset=first)
    bits: NDArray[np.bool_] = np.unpackbits(packed).view(np.bool_)
    return bits[start - first * _BYTE : stop - first * _BYTE]
