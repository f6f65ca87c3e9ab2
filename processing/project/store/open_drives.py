"""OpenDrives: the recordings of an open project; steps of its history remove and restore them."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterable, Mapping

from processing.core.errors import UserError
from processing.map.change import Change
from processing.map.step_files import StepFiles
from processing.project.store.drive_folders import DriveFolders
from processing.recording.camera_images.image_store import IMAGES
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.drive import Drive
from processing.recording.drive_info import FILE_NAME

READ_AT_OPENING = frozenset({IMAGES, FILE_NAME})
"""Files of a drive that steps exchange, and that it reads once."""


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
        self._damaged: dict[str, UserError] = {}
        self._on_open: Callable[[Iterable[Drive]], None] | None = None

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
        if self._on_open is not None:
            self._on_open(opened)
        return tuple(opened)

    @property
    def damaged(self) -> Mapping[str, UserError]:
        """Drives that :meth:`open_all` left out, and why."""
        return dict(self._damaged)

    def open_all(self) -> None:
        """Open all drives of the project, but for those that are damaged or gone."""
        for id_ in self.folders.ids:
            try:
                self.open((id_,))
            except UserError as error:
                self._damaged[id_] = error

    def tell_opened(self, to: Callable[[Iterable[Drive]], None]) -> None:
        """Have a function called with drives that are opened from now on, and with those open."""
        self._on_open = to
        to(self.all)

    def follow_files(self, files: StepFiles) -> None:
        """Files of drives are others now; some are read when a drive is opened."""
        self.open(
            id_
            for id_ in files.drives
            if READ_AT_OPENING & set(files.names_of(id_)) and id_ in self._drives
        )

    def misfits(self, change: Change) -> list[str]:
        """Drives that a change removes and that aren't there, or restores and that can't be."""
        going = {one.id for one in change.removed_drives}
        return [
            *(id_ for id_ in going if id_ not in self._drives),
            *(
                one.id
                for one in change.restored_drives
                if (one.id in self._drives and one.id not in going)
                or not self.folders.holds(one.folder)
            ),
        ]

    def write(self, connection: sqlite3.Connection, change: Change) -> None:
        """Write which drives there are after a change, in the caller's transaction."""
        self.folders.write(connection, change)

    def follow(self, change: Change) -> None:
        """The transaction of :meth:`write` is through."""
        if not change.drive_ids:
            return
        self.folders.follow()
        for one in change.removed_drives:
            self._removed[one.folder] = self._drives.pop(one.id)
        for one in change.restored_drives:
            if one.folder in self._removed:
                self._drives[one.id] = self._removed.pop(one.folder)
            else:
                self.open((one.id,))
        for id_ in change.drive_ids:
            self._damaged.pop(id_, None)
        self._drives = {id_: self._drives[id_] for id_ in self.folders.ids if id_ in self._drives}
