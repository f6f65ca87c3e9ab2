"""Classes that a tool found, as labels over the delivered classes: one step that can be undone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.label_change import MOST_POINTS, LabelChange
from processing.project.results.found_features import FoundFeatures, parameter_values
from processing.project.results.run_findings import labelled_by_runs, new_labels, set_by_hand
from processing.project.store.label_filing import labels_as_change
from processing.project.store.runs import Run, new_run_id
from processing.recording.drive import Drive
from processing.tools.tool import FinishedColumns, Tool

_FOUND = Text("{tool}: {count} points classified", "{tool}: {count}点を分類")
_NOTHING = Text("{tool}: no point gets another class", "{tool}: クラスの変わる点はありません")
_NO_NOTE = Text("", "")
_NOTED = Text("{found} ({note})", "{found}（{note}）")
_TAKEN_BACK = Text(
    "{found}, earlier ones of {count} points taken back",
    "{found}（以前の分類{count}点を取り消し）",
)


def found_classes(
    results: Sequence[tuple[Drive, FinishedColumns]],
    tool: Tool,
    parameters: object,
    into: Path,
    monitor: Monitor,
    *,
    started: datetime,
    finished: datetime,
    note: Text = _NO_NOTE,
) -> FoundFeatures:
    """Make labels of the classes in a tool's results.

    Delivered classes stay as they are. A point gets a label where the tool gives it another class
    than it was delivered with. Labels by hand count more and stay, also those of the tool's own
    classes; what an earlier run gave is taken back where the tool no longer says so.

    Parameters
    ----------
    results : sequence of (Drive, FinishedColumns)
        Of the drives that the run is about, with the column ``classification``; they can be
        removed afterwards.
    parameters : object
        An instance of the tool's own parameter class.
    into : Path
        A new folder of the project, for labels of many points.
    started, finished : datetime
        With their time zone.
    note : Text, optional
        What the data chose, for the run's summary.

    Raises
    ------
    NoSpace, MissingInput, BadFile, Cancelled
        ``into`` is gone again.
    """
    tally = _Tally()
    drives = {drive.id: drive for drive, _ in results}
    labels = (
        tally.counted(one)
        for drive, result in results
        for start in range(0, drive.count, MOST_POINTS)
        if (one := _labels_within(drive, result, start, tool)) is not None
    )
    change = labels_as_change(labels, into, drives.__getitem__, monitor)
    run = Run(
        id=new_run_id(),
        tool=tool.id,
        version=tool.version,
        parameters=parameter_values(tool, parameters),
        drives=tuple(drive.id for drive, _ in results),
        started=started,
        finished=finished,
        summary=_summary(tool, tally, note),
    )
    return FoundFeatures(run, change, tool, note)


class _Tally:
    """How many points get a label, and how many lose it."""

    def __init__(self) -> None:
        self.given = self.taken_back = 0

    def counted(self, change: LabelChange) -> LabelChange:
        given = int(np.count_nonzero(change.codes_after()))
        self.given += given
        self.taken_back += change.count - given
        return change


def _labels_within(
    drive: Drive, result: FinishedColumns, start: int, tool: Tool
) -> LabelChange | None:
    """The labels of a stretch."""
    stop = min(start + MOST_POINTS, drive.count)
    after = new_labels(drive, result, start, stop)
    return relabel_points(drive, np.arange(start, stop), after, tool)


def _summary(tool: Tool, tally: _Tally, note: Text) -> Text:
    summary = (_FOUND if tally.given else _NOTHING).filled(tool=tool.name, count=f"{tally.given:,}")
    if tally.taken_back:
        summary = _TAKEN_BACK.filled(found=summary, count=f"{tally.taken_back:,}")
    return _NOTED.filled(found=summary, note=note) if note.en else summary


def classes_now(
    found: FoundFeatures, tool: Tool, drive_of: Callable[[str], Drive]
) -> FoundFeatures:
    """The same labels for points that may have been painted since the tool ran."""
    labels = [
        relabel_points(drive_of(one.drive), one.unpacked_points(), one.codes_after(), tool)
        for one in found.change.labels
    ]
    kept = tuple(one for one in labels if one is not None)
    return replace(found, change=replace(found.change, labels=kept))


def relabel_points(
    drive: Drive, points: NDArray[np.int64], after: NDArray[np.uint8], tool: Tool
) -> LabelChange | None:
    """What a tool's codes change of the labels of points as they are now: see `found_classes`.

    Parameters
    ----------
    points : (n,) int64
        Rising.
    after : (n,) uint8
        0 where the tool says what was delivered.
    """
    before = labels_of(drive, points)
    is_own = labelled_by_runs(drive, tool, points, before)
    if tool.asked is None:
        # It tells all classes apart: what a question with two answers gave was less.
        is_other = np.isin(before, tool.gives_classes) & ~set_by_hand(drive, points, before)
        is_own |= is_other
    is_free = (before == 0) | is_own
    changed = is_free & (before != after)
    if not changed.any():
        return None
    return LabelChange.of(drive.id, points[changed], before[changed], after[changed])
