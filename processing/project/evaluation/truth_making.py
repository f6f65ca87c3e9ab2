"""Making a truth of the classes as they stand now, after somebody corrected them.

The column is written into a folder of its own, a chunk at a time, in a worker's thread;
:class:`processing.project.evaluation.truth_store.TruthStore` adopts the folder.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable, report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import remove_folder
from processing.core.scratch_folder import whole_folder
from processing.core.text import Text
from processing.image.search.clip import Clip
from processing.labels.label_column import LABEL
from processing.project.evaluation.truth_store import TRUTH
from processing.project.results.run_findings import set_by_hand
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive

OTHER = 1
"""The code of a point that is known to be none of the classes asked for."""

_CLASS = "classification"
_AT_ONCE = 1_000_000


class CheckedPoints(Enum):
    """Which points a person vouches for."""

    WHOLE = "whole"
    """All points: every class is right as it stands."""
    CLIP = "clip"
    """All within the part that the 3D view shows."""
    PAINTED = "painted"
    """Those that were given a class by hand, and no others."""


@dataclass(frozen=True)
class MadeTruth:
    """Finished columns.

    Attributes
    ----------
    folders : mapping of str to Path
        By drive.
    known : mapping of str to int
        By drive, points whose truth is known.
    """

    folders: Mapping[str, Path]
    known: Mapping[str, int]


def truth_as_it_stands(
    drives: Sequence[Drive],
    into: Path,
    monitor: Monitor,
    *,
    clip: Clip | None = None,
    only_painted: bool = False,
) -> MadeTruth:
    """Take the classes of drives as they stand now for the truth.

    A label counts before the delivered class; a point without either is `OTHER`. A drive of which
    nothing is known has no part in the truth.

    Parameters
    ----------
    drives : sequence of Drive
        Those recorded together, as a run takes them.
    into : Path
        A new folder on the drives' disk.
    clip : Clip or None
        Outside of it nothing is known.
    only_painted : bool
        Only points count that have a label which no run gave, since that one was set by hand.

    Raises
    ------
    Unsuitable
        Nothing is known of any point.
    NoSpace, Cancelled
    """
    folders, known = {}, {}
    with whole_folder(into):
        for number, drive in enumerate(drives):
            part = PartMonitor(monitor, number / len(drives), (number + 1) / len(drives))
            folder = into / drive.id
            count = _write(drive, folder, part, clip=clip, only_painted=only_painted)
            if count:
                folders[drive.id], known[drive.id] = folder, count
            else:
                remove_folder(folder)
        if not known:
            raise _nothing_known(drives, only_painted=only_painted)
    return MadeTruth(folders, known)


def _write(
    drive: Drive, folder: Path, monitor: Monitor, *, clip: Clip | None, only_painted: bool
) -> int:
    """The truth of one drive; gives how many points are known."""
    known = 0
    with report_as_user_error(folder):
        folder.mkdir()
    with ColumnWriter(folder) as writer:
        writer.append({TRUTH: np.empty(0, np.uint8)})
        for start in range(0, drive.count, _AT_ONCE):
            monitor.check()
            monitor.report(start / drive.count)
            stop = min(start + _AT_ONCE, drive.count)
            codes = classes_as_they_stand(drive, start, stop)
            if clip is not None:
                codes[~clip.holds(drive.xyz(slice(start, stop)))] = 0
            if only_painted:
                codes[~_is_by_hand(drive, start, stop)] = 0
            known += int(np.count_nonzero(codes))
            writer.append({TRUTH: codes})
    return known


def _nothing_known(drives: Sequence[Drive], *, only_painted: bool) -> Unsuitable:
    where = Text.same(", ".join(drive.info.name for drive in drives))
    if only_painted:
        return Unsuitable(
            Text("No point was painted by hand.", "手動で塗られた点がありません。"),
            where,
            Text(
                "Paint points whose class is certain, then make the truth.",
                "クラスが確実な点を塗ってから、正解を作成してください。",
            ),
        )
    return Unsuitable(
        Text("No point lies in the part shown in 3D.", "3Dビューの表示範囲に点がありません。"),
        where,
        Text(
            "Clip the 3D view to the part that was checked.",
            "確認した範囲を3Dビューで切り出してください。",
        ),
    )


def classes_as_they_stand(drive: Drive, start: int, stop: int) -> NDArray[np.uint8]:
    """Labels over delivered classes of the points ``start … stop − 1``: (k,) uint8, never 0."""
    codes = np.zeros(stop - start, np.uint8)
    if drive.columns.has(_CLASS):
        codes = np.asarray(read_chunk(drive.folder, _CLASS, start, stop))
    if drive.columns.has(LABEL):
        labels = np.asarray(drive.columns[LABEL][start:stop])
        codes = np.where(labels > 0, labels, codes)
    return np.maximum(codes, np.uint8(OTHER))


def _is_by_hand(drive: Drive, start: int, stop: int) -> NDArray[np.bool_]:
    if not drive.columns.has(LABEL):
        return np.zeros(stop - start, np.bool_)
    labels = np.asarray(drive.columns[LABEL][start:stop])
    return set_by_hand(drive, np.arange(start, stop), labels)
