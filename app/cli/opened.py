"""Inputs of a command as drives: a project's own, or delivered files imported for the moment."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from app.language import system_language
from processing.errors import MissingInput
from processing.monitor import Monitor, TerminalMonitor
from processing.points.drive import Drive
from processing.project.importing import ImportRequest, import_drives
from processing.project.project import Project, is_project
from processing.text import Text


def terminal_monitor() -> Monitor:
    """Progress on standard error, in the user's language."""
    return TerminalMonitor(language=system_language())


@contextmanager
def opened_drives(arguments: argparse.Namespace, monitor: Monitor) -> Iterator[tuple[Drive, ...]]:
    """The drives of ``arguments.inputs``; what was imported for it is removed afterwards.

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
            yield project.drives
        finally:
            project.close()
        return
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        folders = import_drives(request_of(arguments), Path(folder) / "drives", monitor)
        yield tuple(Drive(path) for path in folders)


def request_of(arguments: argparse.Namespace) -> ImportRequest:
    """The import that a command's arguments ask for."""
    return ImportRequest(
        inputs=tuple(arguments.inputs),
        trajectories=tuple(arguments.trajectory),
        images=tuple(arguments.images),
        crs=arguments.crs,
    )
