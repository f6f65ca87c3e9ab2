"""The truth as a file says it: one class for each point of a delivered file, in its order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import remove_folder
from processing.core.scratch_folder import whole_folder
from processing.core.text import Text
from processing.formats.points.point_codes import read_truth
from processing.project.evaluation.truth_making import OTHER, MadeTruth
from processing.project.evaluation.truth_store import TRUTH
from processing.recording.columns.columns import ColumnWriter, column_path
from processing.recording.columns.source_order import damaged_sources
from processing.recording.drive import Drive
from processing.scoring.points.coded_points import CodedFile
from processing.scoring.points.point_scores import PointScorer
from processing.scoring.scorers import GROUND_SCORER
from processing.tools.listed.registry import scorers

_AT_ONCE = 1_000_000
_READING = 0.5


def coded_truth(path: Path) -> CodedFile:
    """The classes in a file, whichever tool they were made to judge.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is damaged, or has no classes.
    """
    known = [one for one in scorers().values() if isinstance(one, PointScorer)]
    flags = {name: codes for one in known for name, codes in one.flags.items()}
    # Text with yes and no alone is that of the ISPRS filter test, which is about the ground.
    no, yes = GROUND_SCORER.if_false, GROUND_SCORER.if_true
    return read_truth(path, if_false=no, if_true=yes, flags=flags)


def truth_of_file(
    drives: Sequence[Drive], file: CodedFile, into: Path, monitor: Monitor
) -> MadeTruth:
    """Take the classes in a file for the truth of the delivered file with as many points.

    All its points are known; where it says 0 they are `OTHER`.

    Parameters
    ----------
    drives : sequence of Drive
        Those of the project.
    file : CodedFile
    into : Path
        A new folder on the drives' disk.

    Raises
    ------
    BadFile
        No delivered file has as many points, or several have and none has its name.
    NoSpace, Cancelled

    Notes
    -----
    1. The codes are dealt to the disk in the file's order.
    2. Each drive's points are looked up there by their index in the delivered file.
    """
    source = _source_of(drives, file)
    with whole_folder(into):
        scratch = into / "codes"
        codes = _dealt(file, scratch, PartMonitor(monitor, 0.0, _READING))
        writing = PartMonitor(monitor, _READING, 1.0)
        folders, known = {}, {}
        beside = [drive for drive in drives if source in _paths(drive)]
        for number, drive in enumerate(beside):
            part = PartMonitor(writing, number / len(beside), (number + 1) / len(beside))
            folders[drive.id] = into / drive.id
            known[drive.id] = _write(drive, source, codes, folders[drive.id], part)
        del codes
        remove_folder(scratch)
    return MadeTruth(folders, known)


def _write(
    drive: Drive, source: Path, codes: NDArray[np.uint8], folder: Path, monitor: Monitor
) -> int:
    """The truth of one drive; gives how many points are known."""
    number, known = _paths(drive).index(source), 0
    with report_as_user_error(folder):
        folder.mkdir()
    with ColumnWriter(folder) as writer:
        writer.append({TRUTH: np.empty(0, np.uint8)})
        for start in range(0, drive.count, _AT_ONCE):
            monitor.check()
            monitor.report(start / drive.count)
            stop = min(start + _AT_ONCE, drive.count)
            files, indices = drive.sources(start, stop)
            found = np.zeros(stop - start, np.uint8)
            is_here = files == number
            if is_here.any() and int(indices[is_here].max()) >= codes.size:
                raise damaged_sources(drive.folder)
            found[is_here] = np.maximum(codes[indices[is_here]], np.uint8(OTHER))
            known += int(np.count_nonzero(is_here))
            writer.append({TRUTH: found})
    return known


def _dealt(file: CodedFile, scratch: Path, monitor: Monitor) -> NDArray[np.uint8]:
    with report_as_user_error(scratch):
        scratch.mkdir()
    with ColumnWriter(scratch) as writer:
        writer.append({TRUTH: np.empty(0, np.uint8)})
        for block in file.blocks():
            monitor.check()
            writer.append({TRUTH: block.codes})
            monitor.report(writer.count / max(1, file.count))
    if not file.count:
        return np.empty(0, np.uint8)
    return np.memmap(column_path(scratch, TRUTH), np.uint8, mode="r")


def _paths(drive: Drive) -> list[Path]:
    return [drive.source_path(source) for source in drive.info.sources]


def _source_of(drives: Sequence[Drive], file: CodedFile) -> Path:
    """The delivered file that the codes belong to, by its number of points, then by its name."""
    points: dict[Path, int] = {}
    for drive in drives:
        for source in drive.info.sources:
            path = drive.source_path(source)
            points[path] = points.get(path, 0) + source.points
    found = [path for path, count in points.items() if count == file.count]
    if len(found) > 1:
        named = [path for path in found if path.stem.lower() in file.path.stem.lower()]
        found = named if len(named) == 1 else []
    if found:
        return found[0]
    raise BadFile(
        Text(
            "The truth is for {count} points; the delivered files have {wanted}.",
            "真値は{count}点分ですが、納品ファイルの点数は{wanted}です。",
        ).filled(count=f"{file.count:,}", wanted=", ".join(f"{one:,}" for one in points.values())),
        Text.same(str(file.path)),
        Text(
            "Give a file with all points of one delivered file in its order, and its name where "
            "several have as many.",
            "納品ファイル1つ分の全点を同じ順序で含むファイルを指定してください。"
            "点数の同じ納品ファイルが複数ある場合は、対応するファイル名を含めてください。",
        ),
    )
