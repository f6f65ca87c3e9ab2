"""DriveFolders: the recordings of a project on disk; a kill leaves all or nothing of an import."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from uuid import uuid4

from processing.errors import UserError, told_as_user_error
from processing.owned_files import remove_emptied, remove_folder
from processing.project.database import Database
from processing.project.database_errors import damaged
from processing.project.import_journal import PLAN
from processing.project.project_settings import JsonValue, ProjectSettings, write_setting
from processing.project.unfinished_imports import TEMPORARY, remove_import, remove_litter

DRIVES = "drives"
_ARRIVING = "arriving_drives"


class DriveFolders:
    """Which drives a project has is said by its database alone.

    Before folders are moved in, the database notes which, and where from: what a killed program
    moved in without recording it goes back by that note, and no other folder is ever touched.
    """

    def __init__(self, folder: Path, database: Database, settings: ProjectSettings) -> None:
        self._folder = folder
        self._database = database
        self._settings = settings
        self.ids = tuple(
            str(id_) for (id_,) in database.rows("SELECT id FROM zuka_drives ORDER BY place")
        )
        for id_ in self.ids:
            if not _is_name(id_):
                raise damaged(database.path, f"zuka_drives.id: {id_}")

    def path_of(self, id: str) -> Path:  # noqa: A002 - the word of the trade
        """A drive's folder."""
        return self._folder / DRIVES / id

    def temporary(self) -> Path:
        """A new name for a folder of drives; what is left there goes at the next opening."""
        return self._folder / TEMPORARY / uuid4().hex

    @contextmanager
    def adopting(self, folders: Mapping[str, Path]) -> Iterator[sqlite3.Connection]:
        """Move folders in and record them, in one transaction with the body.

        Parameters
        ----------
        folders : mapping of str to Path
            Finished temporary folders by drive id.

        Raises
        ------
        ValueError
            The project has a drive of that id.
        NoSpace, InUse
            The folders are where they were.
        """
        known = [id_ for id_ in folders if id_ in self.ids or self.path_of(id_).exists()]
        if known:
            message = f"the project has these drives: {known}"
            raise ValueError(message)
        self._settings.put(_ARRIVING, {id_: one.parent.name for id_, one in folders.items()})
        moved: list[tuple[Path, Path]] = []
        try:
            for id_, folder in folders.items():
                target = self.path_of(id_)
                with told_as_user_error(target):
                    target.parent.mkdir(exist_ok=True)
                    folder.rename(target)
                moved.append((folder, target))
            with self._database.transaction() as connection:
                places = range(len(self.ids), len(self.ids) + len(folders))
                connection.executemany(
                    "INSERT INTO zuka_drives VALUES (?, ?)", zip(folders, places, strict=True)
                )
                write_setting(connection, _ARRIVING, [])
                yield connection
        except BaseException:
            self._move_back(moved)
            raise
        self._settings.took(_ARRIVING, [])
        self.ids = (*self.ids, *folders)
        for parent in {folder.parent for folder in folders.values()}:
            # The import's own folder, once the last drive is gone from it.
            if (parent / PLAN).exists():
                remove_import(parent)
            remove_emptied(parent)

    def remove_leftovers(self) -> None:
        """Remove what was never part of the project, but for imports that can go on."""
        self._send_back(self._settings.get(_ARRIVING))
        remove_litter(self._folder, self.ids)

    def _send_back(self, arriving: JsonValue) -> None:
        """Undo an adoption that was killed: drives go back to their import, or away."""
        if not arriving or not isinstance(arriving, (dict, list)):
            return
        imports = arriving if isinstance(arriving, dict) else dict.fromkeys(map(str, arriving), "")
        for id_, name in imports.items():
            if not _is_name(id_) or id_ in self.ids:
                continue
            home = self._folder / TEMPORARY / str(name)
            if isinstance(name, str) and _is_name(name) and (home / PLAN).is_file():
                with suppress(OSError):
                    self.path_of(id_).rename(home / id_)
            remove_folder(self.path_of(id_), self._folder)
        # On a full disk the note stays until the next time.
        with suppress(UserError):
            self._settings.put(_ARRIVING, [])

    def _move_back(self, moved: Sequence[tuple[Path, Path]]) -> None:
        for folder, target in reversed(moved):
            with suppress(OSError):
                target.rename(folder)
        with suppress(UserError):
            self._settings.put(_ARRIVING, [])


def _is_name(id_: str) -> bool:
    """Whether an id is one folder's name, and can't lead out of the project."""
    return Path(id_).name == id_ and id_ not in ("", ".", "..")
