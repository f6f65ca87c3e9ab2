"""Importing delivered files into a project: a value that says which, and what does it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from processing.core.errors import OutOfRange, use_one_of
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.project.additions import Additions, Home, bring_in, home_of, take_over
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.unfinished_imports import unfinished_imports
from processing.project.project import Project, is_project
from processing.recording.drive import Drive

_LONG_POINTS = 10_000_000


@dataclass(frozen=True)
class ImportOperation:
    """Delivered files that become a project's drives, or complete them.

    Attributes
    ----------
    project : Path
        Its folder; the project is made where there is none.
    request : ImportRequest
    only : tuple of str
        Ids of drives that trajectories and images without point files are for; empty for all that
        lack them.
    replaces : tuple of str
        Ids or names of drives that the new ones take the place of.
    """

    project: Path
    request: ImportRequest
    only: tuple[str, ...] = ()
    replaces: tuple[str, ...] = ()


@dataclass(frozen=True)
class ImportOutcome:
    """What came of an import.

    Attributes
    ----------
    drives : tuple of Drive
        Those that are new or others now.
    brought : Additions
    """

    drives: tuple[Drive, ...]
    brought: Additions

    @property
    def words(self) -> tuple[Text, ...]:
        """A line for each drive."""
        line = Text("{name}: {points:,} points", "{name}: {points:,}点")
        return tuple(line.filled(name=drive.info.name, points=drive.count) for drive in self.drives)


def import_files(operation: ImportOperation, monitor: Monitor) -> ImportOutcome:
    """Import files into a project; an import that was killed goes on.

    What the project has already is not imported again; with a trajectory or images it is completed.
    A project made for it goes again if nothing comes of it.

    Raises
    ------
    UserError, Cancelled
        The project is as it was.
    """
    folder, request = operation.project, operation.request
    is_new = not is_project(folder)
    project = Project.create(folder, request.crs) if is_new else Project.open(folder)
    is_finished = False
    try:
        going = _named(project, operation.replaces)
        brought = bring_prepared(request, home_of(project), monitor, only=operation.only)
        if request.crs and not brought.folders:
            project.set_crs(request.crs)
        drives = take_over(project, replace(brought, replaced=going))
        is_finished = True
    finally:
        project.close()
        if is_new and not is_finished and not unfinished_imports(project.folder):
            Project.remove_new(folder)
    return ImportOutcome(drives, brought)


def _named(project: Project, names: Sequence[str]) -> tuple[str, ...]:
    """The ids of drives by their ids or names."""
    ids = {one: drive.id for drive in project.drives for one in (drive.info.name, drive.id)}
    for name in names:
        if name not in ids:
            raise OutOfRange(
                Text(
                    "The project has no such drive.", "その走行データはプロジェクトにありません。"
                ),
                Text.same(name),
                use_one_of(drive.info.name for drive in project.drives),
            )
    return tuple(dict.fromkeys(ids[name] for name in names))


def bring_prepared(
    request: ImportRequest, home: Home, monitor: Monitor, *, only: Collection[str] = ()
) -> Additions:
    """As :func:`processing.project.additions.bring_in`, and rows of long drives are noted.

    They are found while the recording is still in the system's memory; those of a short drive are
    found before anybody notices.

    Raises
    ------
    UserError, Cancelled
    """
    brought = bring_in(request, home, monitor, only=only)
    for folder in (*brought.folders, *(one.folder for one in brought.completed)):
        drive = Drive(folder)
        for kind in drive.image_kinds if drive.count >= _LONG_POINTS else ():
            monitor.check()
            monitor.report(1.0, kind.title)
            image_of(drive, kind)
    return brought
