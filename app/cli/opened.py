"""Inputs of a command as drives: a project's own, or delivered files imported for the moment."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from app.settings.language import system_language
from processing.core.errors import MissingInput
from processing.core.monitor import Monitor, TerminalMonitor
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
from processing.map.catalogue import Catalogue
from processing.map.catalogue_file import read_catalogue
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project, is_project
from processing.project.work_store import WorkStore
from processing.recording.drive import Drive
from resources import path_of


def terminal_monitor() -> Monitor:
    """Progress on standard error, in the user's language."""
    return TerminalMonitor(language=system_language())


@dataclass(frozen=True)
class OpenedInput:
    """What a command works on.

    Attributes
    ----------
    crs : str
        ``EPSG:n``, or empty when unknown.
    catalogue : Catalogue
        The project's own, or the one that comes with the program.
    work : WorkStore or None
        What a project has for its papers; None without one.
    """

    drives: tuple[Drive, ...]
    crs: str
    catalogue: Catalogue
    work: WorkStore | None = None


@contextmanager
def opened_input(arguments: argparse.Namespace, monitor: Monitor) -> Iterator[OpenedInput]:
    """What ``arguments.inputs`` name; what is imported for it is removed afterwards.

    It is imported to the disk of ``arguments.output``: a system's temporary folder is often small.

    Raises
    ------
    UserError
        For inputs that can't be read, or a project among several inputs.
    """
    inputs: list[Path] = arguments.inputs
    if any(is_project(path) for path in inputs):
        if len(inputs) > 1:
            raise MissingInput(
                Text(
                    "A project can only be given alone.", "プロジェクトは単独で指定してください。"
                ),
                Text.same(", ".join(str(path) for path in inputs)),
                Text(
                    "Name one project, or point files.",
                    "1つのプロジェクトか点群ファイルを指定してください。",
                ),
            )
        project = Project.open(inputs[0], writing=False)
        try:
            project.find_sources()
            work = WorkStore(project.settings)
            yield OpenedInput(project.drives, project.crs, project.catalogue, work)
        finally:
            project.close()
        return
    with scratch_folder(arguments.output.parent) as folder:
        folders = import_drives(request_of(arguments), folder / "drives", monitor)
        drives = tuple(Drive(path) for path in folders)
        crs = next((drive.info.crs for drive in drives if drive.info.crs), "")
        yield OpenedInput(drives, crs, read_catalogue(path_of("catalogue/level500.toml")))


def request_of(arguments: argparse.Namespace) -> ImportRequest:
    """The import that a command's arguments ask for."""
    return ImportRequest(
        inputs=tuple(arguments.inputs),
        trajectories=tuple(arguments.trajectory),
        images=tuple(arguments.images),
        crs=arguments.crs,
        columns=columns_of(arguments),
    )


def columns_of(arguments: argparse.Namespace) -> tuple[str, ...]:
    """What ``--columns`` says of the columns of text files; nothing without it."""
    return tuple(name.strip() for name in arguments.columns.split(",")) if arguments.columns else ()
