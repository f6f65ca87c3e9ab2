"""Handing in a project's map: a value that says in which formats and where, and what does it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.operations.export import ExportRequest, check_formats, export
from processing.operations.inputs import opened_project
from processing.project.project import Project
from processing.project.work_store import WorkStore

_LEFT_OUT = Text("A drive was left out: {line}", "走行データを1つ除外しました: {line}")


@dataclass(frozen=True)
class ExportOperation:
    """A project's map to be handed in.

    Attributes
    ----------
    project : Path
    request : ExportRequest
        Delivered files are never overwritten, whether it names them or not.
    """

    project: Path
    request: ExportRequest

    def check(self) -> None:
        """Refuse a format that there isn't before anything is opened.

        Raises
        ------
        OutOfRange
        """
        check_formats(self.request.formats)


@dataclass(frozen=True)
class WrittenFiles:
    """What an operation wrote.

    Attributes
    ----------
    paths : tuple of Path
    notes : tuple of Text
        Sentences about what they hold otherwise than the project has it.
    """

    paths: tuple[Path, ...]
    notes: tuple[Text, ...] = ()

    @property
    def words(self) -> tuple[Text, ...]:
        """A line for each file."""
        return tuple(Text.same(str(path)) for path in self.paths)


def export_project(operation: ExportOperation, monitor: Monitor) -> WrittenFiles:
    """Write a project's map; the project is only read.

    Raises
    ------
    UserError, Cancelled
        As :func:`processing.operations.export.export`; nothing was written.
    """
    operation.check()
    with opened_project(operation.project, writing=False) as project:
        return export_of(project, operation.request)(monitor)


def export_of(project: Project, request: ExportRequest) -> Callable[[Monitor], WrittenFiles]:
    """What writes the map as it is now, in any thread.

    Parameters
    ----------
    request : ExportRequest
        As of :class:`ExportOperation`.

    Raises
    ------
    BadFile
        The work details that the project keeps can't be read.
    """
    features = tuple(project.features.all())
    catalogue, crs, drives = project.catalogue, project.crs, project.drives
    folder, damaged = project.folder, project.damaged_drives
    details = WorkStore(project.settings).details()
    work_facts = details.facts(crs, version("zuka"), datetime.now().astimezone().date())
    left_out = [Text(error.line("en"), error.line("ja")) for error in damaged.values()]
    delivered = (path for drive in drives for path in drive.delivered_files)
    request = replace(request, never=(*request.never, *delivered))

    def work(monitor: Monitor) -> WrittenFiles:
        notes = [_LEFT_OUT.filled(line=one) for one in left_out]
        paths = export(
            features,
            catalogue,
            crs,
            request,
            monitor,
            drives=drives,
            project=folder,
            work=work_facts,
            tell=notes.append,
        )
        return WrittenFiles(paths, tuple(notes))

    return work
