"""What the database of a project holds, and what lies beside it: read whole, once."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

from processing.core.errors import UserError
from processing.core.text import Text
from processing.project.checking.findings import FileFinding, finding_of
from processing.project.project import Project
from processing.project.store.reading_connection import connect
from processing.project.template_store import TemplateStore
from processing.project.volumes.volume_store import VOLUMES, VolumeStore
from processing.project.work_store import WorkStore

_DATABASE = "project.gpkg"
_PAGES = Text("The database is damaged: {said}.", "データベースが壊れています（{said}）。")
_BACKUP = Text(
    "Work on a copy of the folder: export what still opens, or restore project.gpkg from a backup.",
    "フォルダを複製してから作業してください。開ける内容を書き出すか、"
    "project.gpkg をバックアップから戻してください。",
)


def map_findings(folder: Path) -> Iterator[FileFinding]:
    """What is wrong with the map, its history and what else a project remembers."""
    yield from _page_findings(folder / _DATABASE)
    try:
        project = Project.open(folder, writing=False)
    except UserError as error:
        yield finding_of(_DATABASE, error)
        return
    with closing(project):
        for read in _readings(project):
            try:
                read()
            except UserError as error:
                yield finding_of(_DATABASE, error)
        yield from _volume_findings(folder)


def _readings(project: Project) -> Iterator[Callable[[], object]]:
    yield lambda: list(project.features.all())
    yield project.history.last
    yield project.history.coming
    yield project.history.drive_steps
    yield project.history.file_folders
    yield project.runs.all
    yield lambda: project.catalogue
    yield TemplateStore(project.settings).all
    yield WorkStore(project.settings).details
    yield WorkStore(project.settings).limits


def _page_findings(database: Path) -> Iterator[FileFinding]:
    try:
        with closing(connect(database, "ro")) as connection:
            rows = connection.execute("PRAGMA quick_check(3)").fetchall()
    except (sqlite3.Error, UserError):
        return  # opening the project tells
    said = "; ".join(str(row[0]) for row in rows)
    if said != "ok":
        yield FileFinding(_DATABASE, _PAGES.filled(said=" ".join(said.split())), _BACKUP)


def _volume_findings(folder: Path) -> Iterator[FileFinding]:
    for name, error in VolumeStore(folder).damage():
        yield finding_of(f"{VOLUMES}/{name}", error)
