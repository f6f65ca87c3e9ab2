"""DriveFolders: the recordings of a project on disk; a kill leaves all or nothing of an import."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from uuid import uuid4

from processing.core.errors import UserError, report_as_user_error
from processing.core.owned_files import remove_emptied, remove_folder
from processing.map.change import Change, ListedDrive
from processing.project.importing.import_journal import PLAN
from processing.project.importing.unfinished_imports import TEMPORARY, remove_import, remove_litter
from processing.project.store.database import Database
from processing.project.store.database_errors import damaged
from processing.project.store.history import History
from processing.project.store.project_settings import JsonValue, ProjectSettings, write_setting

DRIVES = "drives"
_ARRIVING = "arriving_drives"
_NAMES = "drive_folders"
_LEAVING = "leaving_drives"
_INSERT = "INSERT INTO zuka_drives VALUES (?, ?)"


class DriveFolders:
    """Which drives a project has is said by its database alone.

    Before folders are moved in, the database notes which, and where from: what a killed program
    moved in without recording it goes back by that note, and no other folder is ever touched.

    A folder that a drive no longer has stays where it is, since undo or redo may want it. The
    database notes that it leaves, and it goes when the project is closed, or opened after a kill.
    """

    def __init__(self, folder: Path, database: Database, settings: ProjectSettings) -> None:
        self._folder = folder
        self._database = database
        self._settings = settings
        self._soon: dict[str, JsonValue] = {}
        self._positions: dict[str, int] = {}
        self._read()

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all drives, in their order."""
        return tuple(self._positions)

    @property
    def taken(self) -> tuple[str, ...]:
        """Ids that no new drive may get: those of all drives, and of those that leave."""
        return tuple({**self._positions, **dict.fromkeys(map(_id_in, self._leaving()))})

    def path_of(self, id: str) -> Path:  # noqa: A002 - the word of the trade
        """A drive's folder."""
        return self._folder / DRIVES / self._name_of(id)

    def holds(self, name: str) -> bool:
        """Whether there is a folder of a drive of this name."""
        return _is_name(name) and (self._folder / DRIVES / name).is_dir()

    def listed(self, id: str) -> ListedDrive:  # noqa: A002 - the word of the trade
        """A drive as it is listed; KeyError when there is none of that id."""
        return ListedDrive(id, self._positions[id], self._name_of(id))

    def temporary(self) -> Path:
        """A new name for a folder of drives; what is left there goes at the next opening."""
        return self._folder / TEMPORARY / uuid4().hex

    @contextmanager
    def moving_in(
        self, arriving: Mapping[str, Path], others: Mapping[str, Path]
    ) -> Iterator[tuple[ListedDrive, ...]]:
        """Move folders to where drives have theirs; the body records them, or they go back.

        Parameters
        ----------
        arriving, others : mapping of str to Path
            Finished temporary folders by the ids of new drives, and of drives of the project that
            get another folder.

        Yields
        ------
        tuple of ListedDrive
            New drives and those with other folders, as a step restores them.

        Raises
        ------
        ValueError
            The project has a drive of the id of a new one.
        NoSpace, InUse
            The folders are where they were, and the drives have those that they had.
        """
        known = [id_ for id_ in arriving if id_ in self.taken or self.path_of(id_).exists()]
        if known:
            message = f"the project has these drives: {known}"
            raise ValueError(message)
        names = {id_: self._free_name(id_) for id_ in others}
        first, leaving = max(self._positions.values(), default=-1) + 1, self._leaving()
        listed = [ListedDrive(id_, first + at, id_) for at, id_ in enumerate(arriving)]
        listed += [ListedDrive(id_, self._positions[id_], name) for id_, name in names.items()]
        # A kill before the transaction leaves folders that no drive has: they are noted first.
        if others:
            self._settings.put(_LEAVING, [*leaving, *names.values()])
        if arriving:
            notes = {id_: one.parent.name for id_, one in arriving.items()}
            self._settings.put(_ARRIVING, {**notes})
        moved: list[tuple[Path, Path]] = []
        try:
            for one in listed:
                folder = others[one.id] if one.id in others else arriving[one.id]
                target = self._folder / DRIVES / one.folder
                with report_as_user_error(target):
                    target.parent.mkdir(exist_ok=True)
                    folder.rename(target)
                moved.append((folder, target))
            yield tuple(listed)
        except BaseException:
            self._move_back(moved)
            with suppress(UserError):
                self._settings.put(_LEAVING, [*leaving])
            raise
        for parent in {folder.parent for folder in arriving.values()}:
            # The import's own folder, once the last drive is gone from it.
            if (parent / PLAN).exists():
                remove_import(parent)
            remove_emptied(parent)

    def write(self, connection: sqlite3.Connection, change: Change) -> None:
        """Write which drives there are after a change, in the caller's transaction."""
        if not change.drive_ids:
            return
        gone = [one.folder for one in change.removed_drives]
        here = {one.folder for one in change.restored_drives}
        names = self._table(_NAMES)
        for one in change.restored_drives:
            names.pop(one.id, None)
            if one.folder != one.id:
                names[one.id] = one.folder
        connection.executemany(
            "DELETE FROM zuka_drives WHERE id = ?", [(one.id,) for one in change.removed_drives]
        )
        connection.executemany(_INSERT, [(one.id, one.position) for one in change.restored_drives])
        leaving = [name for name in dict.fromkeys((*self._leaving(), *gone)) if name not in here]
        self._soon = {_NAMES: names, _LEAVING: [*leaving], _ARRIVING: []}
        for name, value in self._soon.items():
            write_setting(connection, name, value)

    def follow(self) -> None:
        """The transaction of :meth:`write` is through."""
        for name, value in self._soon.items():
            self._settings.took(name, value)
        self._read()

    def remove_leaving(self, history: History) -> None:
        """Remove folders that no drive has any longer; undo can't bring them back then.

        Those of drives whose coming was taken back stay as long as it can be done again.
        """
        leaving = self._leaving()
        if not leaving:
            return
        # On a full disk, or where a step is damaged, they stay until the next time.
        with suppress(UserError):
            steps = history.drive_steps()
            undone = [change for place, change in steps if place > history.position]
            kept = {one.folder for change in undone for one in change.restored_drives}
            going = [name for name in leaving if name not in kept]
            wanting = [
                place
                for place, change in steps
                if place <= history.position
                and any(one.folder in going for one in change.removed_drives)
            ]
            if wanting:
                last = max(wanting)
                with self._database.transaction() as connection:
                    standing = history.end_undo(connection, last)
                history.ended_undo(standing, last)
            self._remove(going)

    def _remove(self, going: Sequence[str]) -> None:
        used = {self._name_of(id_) for id_ in self.ids}
        for name in going:
            if name not in used and _is_name(name):
                remove_folder(self._folder / DRIVES / name, self._folder)
        # What a system holds on to goes the next time.
        there: list[JsonValue] = [
            name
            for name in self._leaving()
            if name not in used and _is_name(name) and (self._folder / DRIVES / name).exists()
        ]
        self._settings.put(_LEAVING, there)

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

    def _read(self) -> None:
        rows = self._database.rows("SELECT id, place FROM zuka_drives ORDER BY place, id")
        self._positions = {str(id_): int(str(position)) for id_, position in rows}
        for id_ in self._positions:
            if not _is_name(id_):
                raise damaged(self._database.path, f"zuka_drives.id: {id_}")

    def _name_of(self, id_: str) -> str:
        name = self._table(_NAMES).get(id_)
        return name if isinstance(name, str) and _is_name(name) else id_

    def _free_name(self, id_: str) -> str:
        """No drive's id has a dot in it."""
        numbered = (f"{id_}.{number}" for number in count(2))
        return next(name for name in numbered if not (self._folder / DRIVES / name).exists())

    def _leaving(self) -> list[str]:
        """Folders that no drive has."""
        stored = self._settings.get(_LEAVING)
        return [one for one in stored if isinstance(one, str)] if isinstance(stored, list) else []

    def _table(self, name: str) -> dict[str, JsonValue]:
        stored = self._settings.get(name)
        return dict(stored) if isinstance(stored, dict) else {}

    def _move_back(self, moved: Sequence[tuple[Path, Path]]) -> None:
        for folder, target in reversed(moved):
            with suppress(OSError):
                target.rename(folder)
        with suppress(UserError):
            self._settings.put(_ARRIVING, [])


def _id_in(name: str) -> str:
    """The id of the drive that had a folder."""
    return name.partition(".")[0]


def _is_name(id_: str) -> bool:
    """Whether an id is one folder's name, and can't lead out of the project."""
    return Path(id_).name == id_ and id_ not in ("", ".", "..")
