"""The folder of a new project: empty, or with what is left of one that was never whole."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from processing.core.errors import InUse, report_as_user_error
from processing.core.text import Text
from processing.map.reference_system import CRS, write_reference_system
from processing.project.store.database import Database
from processing.project.store.project_lock import LOCK_FILES
from processing.project.store.project_settings import write_setting

UNFINISHED = "unfinished.gpkg"
"""A new project's database until it is whole."""


def refuse_occupied(folder: Path) -> None:
    """Refuse a folder with anything but what a killed making of a project left there.

    Raises
    ------
    InUse
    """
    leftovers = {*database_files(UNFINISHED), *LOCK_FILES}
    if folder.is_dir() and {one.name for one in folder.iterdir()} <= leftovers:
        for name in database_files(UNFINISHED):
            (folder / name).unlink(missing_ok=True)
    elif folder.exists():
        raise InUse(
            Text("There is something else in this place.", "この場所には別のものがあります。"),
            Text.same(str(folder)),
            Text(
                "Choose another name for the project.",
                "別のプロジェクト名を選んでください。",
            ),
        )


def remove_database(folder: Path, name: str) -> None:
    """Remove a closed project's database and lock; the folder too when nothing else is in it."""
    for one in (*database_files(name), *database_files(UNFINISHED), *LOCK_FILES):
        with suppress(OSError):
            (folder / one).unlink(missing_ok=True)
    with suppress(OSError):
        folder.rmdir()


def database_files(name: str) -> tuple[str, ...]:
    """A database's file and those that SQLite puts beside it."""
    return name, f"{name}-journal", f"{name}-wal", f"{name}-shm"


def make_database(path: Path, crs: str) -> None:
    """Make a project's database, which takes its name when it is whole.

    Raises
    ------
    NoSpace
        Until it is whole there is no project.
    """
    unfinished = path.with_name(UNFINISHED)
    Database.create(unfinished)
    if crs:
        database = Database(unfinished, writing=True)
        try:
            with database.transaction() as connection:
                write_reference_system(connection, crs)
                write_setting(connection, CRS, crs)
        finally:
            database.close()
    with report_as_user_error(path):
        unfinished.rename(path)
