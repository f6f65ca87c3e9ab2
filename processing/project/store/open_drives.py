"""OpenDrives: the recordings of an open project; steps of its history remove and restore them."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable

from processing.map.change import Change
from processing.project.store.drive_folders import DriveFolders
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.drive import Drive


class OpenDrives:
    """Drives by id, in the order in which they were imported.

    Parameters
    ----------
    folders : DriveFolders
        Says which there are.
    """

    def __init__(self, folders: DriveFolders) -> None:
        self.folders = folders
        self._pages = MappedPages()
        self._drives: dict[str, Drive] = {}
        self._removed: dict[str, Drive] = {}

    @property
    def all(self) -> tuple[Drive, ...]:
        """All drives."""
        return tuple(self._drives.values())

    def __getitem__(self, id_: str) -> Drive:
        return self._drives[id_]

    def open(self, ids: Iterable[str]) -> tuple[Drive, ...]:
        """Open drives of the project, anew where they were open.

        Raises
        ------
        MissingInput, BadFile
            A folder is missing or damaged.
        """
        opened = [Drive(self.folders.path_of(id_), self._pages) for id_ in ids]
        self._drives.update((drive.id, drive) for drive in opened)
        return tuple(opened)

    def misfits(self, change: Change) -> list[str]:
        """Drives that a change removes and that aren't there, or restores and that are."""
        return [
            *(one.id for one in change.removed_drives if one.id not in self._drives),
            *(one.id for one in change.restored_drives if one.id not in self._removed),
        ]

    def write(self, connection: sqlite3.Connection, change: Change, position: int) -> None:
        """Write which drives there are after a change, in the caller's transaction.

        Parameters
        ----------
        position : int
            Of the change in the history.
        """
        self.folders.write(connection, change, position)

    def follow(self, change: Change) -> None:
        """The transaction of :meth:`write` is through."""
        if not (change.removed_drives or change.restored_drives):
            return
        self.folders.follow()
        for one in change.removed_drives:
            self._removed[one.id] = self._drives.pop(one.id)
        for one in change.restored_drives:
            self._drives[one.id] = self._removed.pop(one.id)
        self._drives = {id_: self._drives[id_] for id_ in self.folders.ids}
