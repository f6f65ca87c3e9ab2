"""Storing what a run gave in a project: one path for the window, the command line and batch jobs.

The project's thread does it; what takes time was done before, by
:mod:`processing.operations.runs.finished_runs`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Status
from processing.operations.runs.finished_runs import FinishedRun
from processing.operations.runs.repeated_runs import with_earlier_decisions
from processing.project.project import Project
from processing.project.results.found_classes import classes_now
from processing.project.results.found_features import FoundFeatures
from processing.project.review.decisions import accept_unseen, label_of_many
from processing.project.store.runs import Run
from processing.recording.columns.columns import column_path
from processing.recording.drive import Drive
from processing.tools.tool import FinishedColumns

_COLUMNS = Text("{name}: {columns}", "{name}: {columns}")


@dataclass(frozen=True)
class StoredRun:
    """What a project has of a run.

    Attributes
    ----------
    summary : Text
        What came of it: “Curbs: 214 candidates”.
    change : Change
        What became of the map; empty where nothing did.
    run : Run or None
        None for a tool that makes columns: they say nothing that a person decides on.
    """

    summary: Text
    change: Change
    run: Run | None = None


def store_run(project: Project, done: FinishedRun) -> StoredRun:
    """Put what a run gave into a project: candidates, labels, columns as one step to be undone.

    Candidates of earlier runs that nobody decided on are replaced, what was decided stays. Columns
    and the surface of the ground that a drive had before are kept with the step.

    Raises
    ------
    NoSpace, InUse, BadFile
        The map is as it was.
    """
    files = project.new_step_files()
    if done.found is not None:
        done.keep_with(project.drive, files)
        change = replace(done.found.change, files=files.files())
        return _store_found(project, replace(done.found, change=change))
    drive, columns = _columns_of(project, done)
    if columns.count != drive.count:
        message = f"columns of {columns.count} points for a drive of {drive.count}"
        raise ValueError(message)
    for name in columns.names:
        file = column_path(columns.folder, name)
        files.give(file, file.name, drive.id)
    columns.remove()
    summary = _summary(drive, columns)
    change = Change(files=files.files())
    project.features.apply(summary, change)
    return StoredRun(summary, change)


def store_prepared(project: Project, done: FinishedRun) -> StoredRun:
    """Put columns with their drive that nobody asked for: there is nothing to take back.

    Raises
    ------
    NoSpace, InUse
        A column can't be replaced; it and those behind it are as they were.
    """
    drive, columns = _columns_of(project, done)
    columns.hand_over(drive.columns)
    return StoredRun(_summary(drive, columns), Change())


def accept_above(project: Project, stored: Iterable[StoredRun], least: float) -> int:
    """Accept candidates of runs from a confidence up, as one step; gives how many.

    Raises
    ------
    NoSpace, InUse, BadFile
        None was accepted.
    """
    added = [project.features.get(one.id) for each in stored for one in each.change.added]
    chosen = [
        one
        for one in added
        if one is not None
        and one.status is Status.CANDIDATE
        and (one.provenance.confidence or 0.0) >= least
    ]
    if chosen:
        label = label_of_many(len(chosen), least)
        project.features.apply(label, accept_unseen(chosen))
    return len(chosen)


def _store_found(project: Project, found: FoundFeatures) -> StoredRun:
    if found.change.labels and not project.features.fits(found.change):
        # Points were painted while the tool ran.
        found = classes_now(found, found.tool, project.drive)
    new = with_earlier_decisions(found, project)
    if new.change.is_empty:
        project.runs.add(new.run)
    else:
        project.features.apply(new.run.summary, new.change, run=new.run)
    return StoredRun(new.run.summary, new.change, new.run)


def _columns_of(project: Project, done: FinishedRun) -> tuple[Drive, FinishedColumns]:
    if done.columns is None:
        raise TypeError(done)
    return project.drive(done.drive), done.columns


def _summary(drive: Drive, columns: FinishedColumns) -> Text:
    return _COLUMNS.filled(name=drive.info.name, columns=", ".join(columns.names))
