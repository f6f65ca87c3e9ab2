"""Filing labels of many points, in a worker's thread: the parts, and the columns that follow.

Painting goes on meanwhile. What is painted while labels are filed is told to
:func:`drop_repainted`, which leaves those points to the painter.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Collection, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import keep_sums
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import holds_only, is_link, remove_folder, unmark
from processing.core.scratch_folder import whole_folder
from processing.labels.label_column import LABEL, labels_of, write_codes
from processing.map.change import Change
from processing.map.filed_labels import PARTS, FiledLabels, FiledPart, check_of, is_file_of_step
from processing.map.label_change import LabelChange
from processing.recording.columns.columns import column_path
from processing.recording.columns.replacing import flush_folder, flush_names
from processing.recording.drive import Drive

MANY_POINTS = 200_000
"""Labels of more points than these are filed: to store them takes more than an instant."""

DriveOf = Callable[[str], Drive]
Relabel = Callable[[Drive, NDArray[np.int64], NDArray[np.uint8]], "LabelChange | None"]
"""From points and the codes they shall get to what changes as they are labelled now."""


def are_many(labels: Iterable[LabelChange]) -> bool:
    """Whether labels should be filed, in a worker's thread."""
    return sum(one.count for one in labels) > MANY_POINTS


def labels_as_change(
    labels: Iterable[LabelChange], folder: Path, drive_of: DriveOf, monitor: Monitor
) -> Change:
    """Labels as the change that is stored: those of many points are filed.

    Parameters
    ----------
    labels : iterable of LabelChange
        Gone through once, so that they need not be in memory together.
    folder : Path
        A new folder of the project's ``label_steps``; not made where the labels are few.

    Raises
    ------
    NoSpace, MissingInput, BadFile, Cancelled
        No folder is left.
    """
    rest, held = iter(labels), []
    for one in rest:
        monitor.check()
        held.append(one)
        if are_many(held):
            break
    else:
        return Change(labels=tuple(held))
    with whole_folder(folder):
        with report_as_user_error(folder), (folder / PARTS).open("wb") as file:
            parts = [_filed(file, one) for one in held]
            held.clear()
            for one in rest:
                monitor.check()
                parts.append(_filed(file, one))
        filed = FiledLabels(folder, tuple(parts))
        make_columns(filed, drive_of, monitor)
        with report_as_user_error(folder):
            unmark(folder)
    return Change(filed=filed)


def make_columns(filed: FiledLabels, drive_of: DriveOf, monitor: Monitor) -> bool:
    """Make the drives' columns as the labels make them, beside those that count.

    Returns
    -------
    bool
        Whether all points had the labels that the change takes them for.

    Raises
    ------
    NoSpace, MissingInput, BadFile, Cancelled
    """
    fits = True
    total, done = sum(filed.counts.values()), 0
    for id_ in filed.counts:
        drive, file = drive_of(id_), filed.column_file(id_)
        with report_as_user_error(file):
            _copy_column(drive, file)
        for one in filed.changes(id_):
            monitor.check()
            done += one.count
            monitor.report(done / total)
            points = one.unpacked_points()
            fits &= bool((labels_of(drive, points) == one.codes_before()).all())
            write_codes(file, points, one.codes_after())
        with report_as_user_error(file):
            keep_sums(file)
    _flush(filed.folder)
    return fits


def drop_repainted(
    filed: FiledLabels,
    painted: Sequence[LabelChange],
    drive_of: DriveOf,
    monitor: Monitor,
    *,
    relabel: Relabel | None = None,
) -> FiledLabels:
    """The same labels without the points that were painted since.

    Parameters
    ----------
    painted : sequence of LabelChange
        What else became of labels since the columns were begun.
    relabel : callable, optional
        Where labels of many points became others: what to make of each part now.

    Raises
    ------
    NoSpace, MissingInput, BadFile, Cancelled
    """
    later = _points_by_drive(painted)
    parts = []
    path = filed.folder / PARTS
    with report_as_user_error(path), path.open("ab") as file:
        file.seek(0, os.SEEK_END)
        for part in filed.parts:
            monitor.check()
            others = later.get(part.drive, np.empty(0, np.int64))
            first, end = np.searchsorted(others, [part.first, part.last + 1])
            if relabel is None and first == end:
                parts.append(part)
                continue
            one = _without(filed.read(part), others[first:end])
            if one is not None and relabel is not None:
                one = relabel(drive_of(one.drive), one.unpacked_points(), one.codes_after())
            if one is not None:
                parts.append(_filed(file, one))
    anew = FiledLabels(filed.folder, tuple(parts))
    if relabel is not None:
        make_columns(anew, drive_of, monitor)
        return anew
    for id_, points in later.items():
        column = filed.column_file(id_)
        if column.is_file():
            write_codes(column, points, labels_of(drive_of(id_), points))
    _flush(filed.folder)
    return anew


def remove_unlisted(steps: Path, listed: Collection[str]) -> None:
    """Remove what no step of the history names, and columns that took no other's place.

    Parameters
    ----------
    steps : Path
        The project's folder of folders with labels of many points.
    """
    with suppress(OSError):
        for folder in () if is_link(steps) else steps.iterdir():
            # What the program didn't file there is somebody else's.
            if not holds_only(folder, is_file_of_step):
                continue
            if folder.name not in listed:
                remove_folder(folder)
                continue
            for file in folder.iterdir():
                if file.name != PARTS:
                    file.unlink()


def rebase_labels(
    labels: Sequence[LabelChange], painted: Sequence[LabelChange], drive_of: DriveOf
) -> tuple[LabelChange, ...]:
    """What was wished for, over the labels as they are, but for points that were painted since."""
    later, none = _points_by_drive(painted), np.empty(0, np.int64)
    rest = [_without(one, later.get(one.drive, none)) for one in labels]
    found = [
        relabelled_by_hand(drive_of(one.drive), one.unpacked_points(), one.codes_after())
        for one in rest
        if one is not None
    ]
    return tuple(one for one in found if one is not None)


def relabelled_by_hand(
    drive: Drive, points: NDArray[np.int64], after: NDArray[np.uint8]
) -> LabelChange | None:
    """What painting points changes as they are labelled now; None where they have it already."""
    before = labels_of(drive, points)
    changed = before != after
    if not changed.any():
        return None
    return LabelChange.of(drive.id, points[changed], before[changed], after[changed])


def _points_by_drive(labels: Sequence[LabelChange]) -> dict[str, NDArray[np.int64]]:
    points: dict[str, list[NDArray[np.int64]]] = {}
    for one in labels:
        points.setdefault(one.drive, []).append(one.unpacked_points())
    return {id_: np.unique(np.concatenate(found)) for id_, found in points.items()}


def _without(one: LabelChange, others: NDArray[np.int64]) -> LabelChange | None:
    """A change without some points."""
    points = one.unpacked_points()
    kept = ~np.isin(points, others)
    if kept.all():
        return one
    if not kept.any():
        return None
    before, after = one.codes_before(), one.codes_after()
    return LabelChange.of(one.drive, points[kept], before[kept], after[kept])


def _filed(file: BinaryIO, one: LabelChange) -> FiledPart:
    position, points = file.tell(), one.unpacked_points()
    content = one.points + one.before + one.after
    file.write(content + check_of(content))
    sizes = len(one.points), len(one.before), len(one.after)
    first, last = (int(points[0]), int(points[-1])) if points.size else (0, -1)
    return FiledPart(one.drive, one.count, first, last, position, sizes)


def _copy_column(drive: Drive, file: Path) -> None:
    if drive.columns.has(LABEL):
        shutil.copyfile(column_path(drive.folder, LABEL), file)
    else:
        with file.open("wb") as column:
            column.truncate(drive.count)


def _flush(folder: Path) -> None:
    with report_as_user_error(folder):
        flush_folder(folder)
        flush_names(folder.parent)
