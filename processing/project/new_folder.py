"""The folder of a new project: empty, or with what is left of one that was never whole."""

from __future__ import annotations

from pathlib import Path

from processing.errors import InUse
from processing.project.project_lock import LOCK_FILES
from processing.text import Text

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


def database_files(name: str) -> tuple[str, ...]:
    """A database's file and those that SQLite puts beside it."""
    return name, f"{name}-journal", f"{name}-wal", f"{name}-shm"
