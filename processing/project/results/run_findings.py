"""What a run said about each point, so that it can be judged, and told from labels set by hand.

The labels that came of a run change with undo and by hand, and to run the tool again takes its
time. What a question with two answers was answered is kept as a bit a point, an eighth of the
smallest column, in ``runs/<tool>/<run>.bits`` of the drive's folder; of a tool with many classes
``runs/<tool>/<run>.codes`` has the labels that the run gave, a byte a point. The runs of the
project say with which parameters it was made.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import keep_sums, place_with_sums, refuse_damaged
from processing.core.errors import report_as_user_error
from processing.labels.label_column import labels_of
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import is_one_of
from processing.tools.listed.registry import TOOLS
from processing.tools.tool import FinishedColumns, Tool

_CLASS = "classification"
_FOLDER, _ENDING, _GIVEN = "runs", ".bits", ".codes"
_AT_ONCE = 1 << 20
_BYTE = 8


def finding_path(drive: Drive, tool: str, run: str) -> Path:
    """Where what a run of a tool said about a drive is kept."""
    return drive.folder / _FOLDER / tool / f"{run}{_ENDING}"


def given_path(drive: Drive, tool: str, run: str) -> Path:
    """Where the labels are kept that a run of a tool with many classes gave."""
    return drive.folder / _FOLDER / tool / f"{run}{_GIVEN}"


def write_finding(result: FinishedColumns, codes: Collection[int], path: Path) -> None:
    """Keep which points of a result have one of some classes.

    Raises
    ------
    NoSpace
    """
    with report_as_user_error(path), path.open("wb") as file:
        for start in range(0, result.count, _AT_ONCE):
            stop = min(start + _AT_ONCE, result.count)
            found = is_one_of(result.read(_CLASS, start, stop), codes)
            file.write(np.packbits(found).tobytes())
    with report_as_user_error(path):
        keep_sums(path)


def write_given(drive: Drive, result: FinishedColumns, path: Path) -> None:
    """Keep which labels a result gives to the points of a drive, as they are now.

    None where it says what was delivered, nor where a label set by hand stands.

    Raises
    ------
    NoSpace
    """
    with report_as_user_error(path), path.open("wb") as file:
        for start in range(0, result.count, _AT_ONCE):
            points = np.arange(start, min(start + _AT_ONCE, result.count))
            given = new_labels(drive, result, start, start + points.size)
            labels = labels_of(drive, points)
            given[set_by_hand(drive, points, labels)] = 0
            file.write(given.tobytes())
    with report_as_user_error(path):
        keep_sums(path)


def new_labels(drive: Drive, result: FinishedColumns, start: int, stop: int) -> NDArray[np.uint8]:
    """The classes of a result where it says another than was delivered, else 0: (k,) uint8."""
    found = result.read(_CLASS, start, stop)
    if not drive.columns.has(_CLASS):
        return np.array(found, np.uint8)
    delivered = read_chunk(drive.folder, _CLASS, start, stop)
    return np.where(found != delivered, found, 0).astype(np.uint8)


def adopt_finding(drive: Drive, tool: Tool, run: str, file: Path) -> None:
    """Let a finished file on the drive's disk be what a run said.

    Raises
    ------
    NoSpace, MissingInput, InUse
    """
    path = (given_path if tool.asked is None else finding_path)(drive, tool.id, run)
    with report_as_user_error(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        place_with_sums(file, path)


def has_finding(drive: Drive, tool: str, run: str) -> bool:
    """Whether it is kept, whole, what a run said about a drive."""
    return _is_whole(drive, finding_path(drive, tool, run))


def read_finding(drive: Drive, tool: str, run: str, start: int, stop: int) -> NDArray[np.bool_]:
    """Whether a run said yes about the points ``start … stop − 1``: (k,) bool.

    Raises
    ------
    MissingInput
        It isn't kept.
    """
    return _read(finding_path(drive, tool, run), start, stop)


def newest_run(drive: Drive, tool: str) -> str:
    """The run of a tool that was kept last with a drive; empty where there is none."""
    found = [
        (path.stat().st_mtime_ns, path.stem)
        for path in (drive.folder / _FOLDER / tool).glob(f"*{_ENDING}")
        if _is_whole(drive, path)
    ]
    return max(found, default=(0, ""))[1]


def finding_of(drive: Drive, tool: str, run: str, points: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether a run said yes about some points: (n,) bool.

    Raises
    ------
    MissingInput
        It isn't kept.
    """
    path = finding_path(drive, tool, run)
    if not points.size:
        return np.zeros(0, np.bool_)
    with report_as_user_error(path):
        packed = np.memmap(path, np.uint8, "r")
        bits = packed[points // _BYTE] >> (_BYTE - 1 - points % _BYTE).astype(np.uint8)
    said: NDArray[np.bool_] = (bits & 1).astype(np.bool_)
    return said


def labelled_by_runs(
    drive: Drive, tool: Tool, points: NDArray[np.int64], labels: NDArray[np.uint8]
) -> NDArray[np.bool_]:
    """Which labels a run of a tool gave, or would have given: all others were set by hand.

    Parameters
    ----------
    tool : Tool
        One that gives classes.
    points : (n,) int64
        Rising.
    labels : (n,) uint8
        What they have.

    Returns
    -------
    (n,) bool
    """
    found = np.zeros(points.size, np.bool_)
    if not points.size:
        return found
    if tool.asked is None:
        for path in sorted((drive.folder / _FOLDER / tool.id).glob(f"*{_GIVEN}")):
            found |= _read_given(drive, path, points) == labels
        return found & (labels > 0)
    yes, own = tool.asked.codes, frozenset(tool.gives_classes)
    is_yes, is_no = is_one_of(labels, yes & own), is_one_of(labels, own - yes)
    first = int(points[0])
    for path in sorted((drive.folder / _FOLDER / tool.id).glob(f"*{_ENDING}")):
        if _is_whole(drive, path):
            said = _read(path, first, int(points[-1]) + 1)[points - first]
            found |= np.where(said, is_yes, is_no)
    return found


def set_by_hand(
    drive: Drive, points: NDArray[np.int64], labels: NDArray[np.uint8]
) -> NDArray[np.bool_]:
    """Which labels no run of any tool gave: (n,) bool.

    Parameters
    ----------
    points : (n,) int64
        Rising.
    labels : (n,) uint8
        What they have; 0 was set by nobody.
    """
    is_by_hand = labels > 0
    for tool in TOOLS.values():
        if tool.gives_classes and is_by_hand.any():
            is_by_hand &= ~labelled_by_runs(drive, tool, points, labels)
    return is_by_hand


def _read_given(drive: Drive, path: Path, points: NDArray[np.int64]) -> NDArray[np.uint8]:
    """The labels that a run gave to rising points; none where the file is not whole."""
    if path.stat().st_size != drive.count:
        return np.zeros(points.size, np.uint8)
    first = int(points[0])
    refuse_damaged(path, first, int(points[-1]) + 1)
    with report_as_user_error(path):
        read = np.fromfile(path, np.uint8, count=int(points[-1]) + 1 - first, offset=first)
    given: NDArray[np.uint8] = read[points - first]
    return given


def _is_whole(drive: Drive, path: Path) -> bool:
    return path.is_file() and path.stat().st_size == -(-drive.count // _BYTE)


def _read(path: Path, start: int, stop: int) -> NDArray[np.bool_]:
    first = start // _BYTE
    refuse_damaged(path, first, -(-stop // _BYTE))
    with report_as_user_error(path):
        packed = np.fromfile(path, np.uint8, count=-(-stop // _BYTE) - first, offset=first)
    bits: NDArray[np.bool_] = np.unpackbits(packed).view(np.bool_)
    return bits[start - first * _BYTE : stop - first * _BYTE]
