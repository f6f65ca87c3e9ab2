"""LabelLayer: the labels of all drives, which follow the history of the map."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np

from processing.core.errors import BadFile, UserError, report_as_user_error
from processing.core.monitor import SilentMonitor
from processing.labels.label_column import (
    LABEL,
    flush,
    labels_of,
    make_column,
    settle_labels,
    write_labels,
)
from processing.map.change import Change
from processing.map.filed_labels import FiledLabels
from processing.map.label_change import LabelChange
from processing.project.store.label_filing import make_columns
from processing.recording.columns.replacing import flush_names
from processing.recording.drive import Drive

DriveOf = Callable[[str], Drive]


class LabelLayer:
    """Writes labels into the drives' columns after the database says that they are so.

    Parameters
    ----------
    drive_of : callable
        From an id to the open drive; KeyError when there is none.
    """

    def __init__(self, drive_of: DriveOf) -> None:
        self._drive_of = drive_of
        self._unflushed: dict[str, Drive] = {}

    def misfits(self, labels: Sequence[LabelChange]) -> list[str]:
        """Drives that are gone, or whose points have other labels than a change takes them for."""
        found = {one.drive for one in labels if not self._fits(one)}
        for drive in {one.drive for one in labels} - found:
            changes = [one for one in labels if one.drive == drive]
            if len(changes) > 1 and _share_points(changes):
                found.add(drive)
        return sorted(found)

    def prepare(self, labels: Sequence[LabelChange]) -> None:
        """Let the disk have all that was written, and room for what comes.

        Raises
        ------
        NoSpace, MissingInput, BadFile
            Nothing was changed but that a drive may have an empty column of labels.
        """
        for drive_id, drive in tuple(self._unflushed.items()):
            flush(drive)
            del self._unflushed[drive_id]
        for one in labels:
            make_column(self._drive_of(one.drive))

    def write(self, labels: Sequence[LabelChange]) -> None:
        """Write what a change gives the points.

        Raises
        ------
        NoSpace, MissingInput, BadFile
            The labels are as they were, as far as the disk still takes anything.
        """
        try:
            self._write(labels)
        except UserError:
            with suppress(UserError):
                self._write([one.inverse() for one in labels])
            raise

    def make(self, filed: FiledLabels) -> list[str]:
        """Make the columns of labels of many points; gives the drives that have other labels.

        Raises
        ------
        NoSpace, MissingInput, BadFile
            Nothing was changed.
        """
        if all(self._is_there(id_) for id_ in filed.counts) and make_columns(
            filed, self._drive_of, SilentMonitor()
        ):
            return []
        return sorted(filed.counts)

    def follow(self, change: Change, *, writing: bool) -> None:
        """Let points have what a change gives them, where a killed program left that undone."""
        self.correct(change.labels, writing=writing)
        if change.filed is not None:
            self.complete(change.filed, writing=writing)

    def correct(self, labels: Sequence[LabelChange], *, writing: bool) -> None:
        """Let points have what a change gives them, where a killed program left that undone.

        A column that is damaged, or a drive that is gone, is left as it is: using it tells.

        Parameters
        ----------
        writing : bool
            False: in memory only.
        """
        for one in labels:
            with suppress(UserError, KeyError):
                drive, points = self._drive_of(one.drive), one.unpacked_points()
                if writing:
                    settle_labels(drive, points)
                codes = one.codes_after()
                if (labels_of(drive, points) == codes).all():
                    continue
                if writing:
                    make_column(drive)
                    write_labels(drive, points, codes)
                    self._unflushed[one.drive] = drive
                else:
                    corrected = labels_of(drive, np.arange(drive.count))
                    corrected[points] = codes
                    drive.columns.hold(LABEL, corrected)

    def adopt(self, filed: FiledLabels) -> None:
        """Let the columns that were made beside those that count take their places.

        Raises
        ------
        MissingInput, InUse, NoSpace
            The labels are as they were, as far as the disk still takes anything.
        """
        adopted: list[str] = []
        try:
            for id_ in filed.counts:
                self._drive_of(id_).columns.take_over(LABEL, filed.column_file(id_))
                adopted.append(id_)
                # The next step's note replaces this one's: by then the new name must be safe.
                with report_as_user_error(filed.folder):
                    flush_names(self._drive_of(id_).folder)
        except UserError:
            with suppress(UserError):
                for id_ in adopted:
                    self._write(list(filed.inverse().changes(id_)))
            raise

    def complete(self, filed: FiledLabels, *, writing: bool) -> None:
        """Let columns take their places where a killed program left that undone.

        Parameters
        ----------
        writing : bool
            False: in memory only.
        """
        for id_ in filed.counts:
            file = filed.column_file(id_)
            with suppress(UserError, KeyError):
                columns = self._drive_of(id_).columns
                if not file.is_file():
                    continue
                if writing:
                    columns.take_over(LABEL, file)
                else:
                    columns.hold(LABEL, np.fromfile(file, np.uint8))

    def _write(self, labels: Sequence[LabelChange]) -> None:
        for one in labels:
            drive = self._drive_of(one.drive)
            write_labels(drive, one.unpacked_points(), one.codes_after())
            self._unflushed[one.drive] = drive

    def _is_there(self, drive: str) -> bool:
        try:
            self._drive_of(drive)
        except KeyError:
            return False
        return True

    def _fits(self, label: LabelChange) -> bool:
        try:
            drive = self._drive_of(label.drive)
        except KeyError:
            return False
        points = label.unpacked_points()
        if points.size and points[-1] >= drive.count:
            return False
        try:
            return bool((labels_of(drive, points) == label.codes_before()).all())
        except BadFile:
            return True  # it says nothing against the change; preparing to write tells


def _share_points(labels: Sequence[LabelChange]) -> bool:
    """Whether two changes of one drive are about the same point.

    A long recording is changed by many, chunk after chunk: only what overlaps is compared.
    """
    reached: list[tuple[int, LabelChange]] = []
    for first, last, one in sorted(
        ((*_extent(one), one) for one in labels if one.count), key=lambda extent: extent[:2]
    ):
        reached = [(end, other) for end, other in reached if end >= first]
        for _, other in reached:
            if np.intersect1d(one.unpacked_points(), other.unpacked_points()).size:
                return True
        reached.append((last, one))
    return False


def _extent(label: LabelChange) -> tuple[int, int]:
    points = label.unpacked_points()
    return int(points[0]), int(points[-1])
