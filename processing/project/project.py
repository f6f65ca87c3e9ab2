"""Project: a folder with the recordings of a job, their map, and its history."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import MissingInput, report_as_user_error
from processing.core.owned_files import remove_folder
from processing.core.text import Text
from processing.map.catalogue import Catalogue
from processing.map.catalogue_change import CatalogueComparison, compare
from processing.map.catalogue_file import read_catalogue
from processing.map.catalogue_writing import write_catalogue
from processing.map.change import ListedDrive
from processing.map.filed_labels import LABEL_STEPS
from processing.map.reference_system import (
    CRS,
    other_system,
    reference_system,
    srs_number,
    write_reference_system,
)
from processing.project.importing.drive_completion import CompletedDrive, drive_changed
from processing.project.importing.unfinished_imports import TEMPORARY, unfinished_imports
from processing.project.sources.source_files import HOMES, SourceFiles
from processing.project.store.catalogue_adoption import CatalogueFile
from processing.project.store.database import Database
from processing.project.store.database_errors import damaged
from processing.project.store.drive_folders import DRIVES, DriveFolders
from processing.project.store.feature_store import FeatureStore
from processing.project.store.history import History
from processing.project.store.label_filing import remove_unlisted
from processing.project.store.label_layer import LabelLayer
from processing.project.store.map_origin import ORIGIN, origin_of, stored_origin
from processing.project.store.new_folder import (
    UNFINISHED,
    database_files,
    make_database,
    refuse_occupied,
    remove_database,
)
from processing.project.store.no_links import refuse_links
from processing.project.store.open_drives import OpenDrives
from processing.project.store.project_lock import LOCK_FILES, ProjectLock
from processing.project.store.project_settings import ProjectSettings, write_setting
from processing.project.store.runs import Runs
from processing.project.volumes.volume_store import VOLUMES
from processing.recording.drive import Drive
from resources import path_of

_DATABASE = "project.gpkg"
_FOLDERS = (DRIVES, TEMPORARY, LABEL_STEPS)
_FILES = (*database_files(_DATABASE), *database_files(UNFINISHED), *LOCK_FILES)
_OWN = (*_FOLDERS, VOLUMES, *_FILES)


def is_project(path: Path) -> bool:
    """Whether a path is a project's folder."""
    return (path / _DATABASE).is_file()


class Project:
    """The folder and all it holds; made by :meth:`create` and :meth:`open`.

    Used by one thread; long work gets drives and values, never the project.

    Attributes
    ----------
    settings : ProjectSettings
        What else is remembered with the project, by name.
    sources : SourceFiles
        The delivered files and camera images.
    """

    def __init__(self, folder: Path, *, writing: bool) -> None:
        self.folder = folder
        refuse_links(folder, _OWN)
        with ExitStack() as stack:
            if writing:
                stack.callback(ProjectLock(folder).release)
            self._database = Database(folder / _DATABASE, writing=writing)
            stack.callback(self._database.close)
            self._catalogue = CatalogueFile(folder)
            with self._database.snapshot():
                self.settings = ProjectSettings(self._database)
                self.history = History(self._database, self.settings)
                labels = LabelLayer(self.drive)
                self._folders = DriveFolders(folder, self._database, self.settings)
                self._drives = OpenDrives(self._folders)
                self.features = FeatureStore(
                    self._database,
                    self.history,
                    self.catalogue,
                    self._srs_number(),
                    labels=labels,
                    drives=self._drives,
                )
                self.runs = Runs(self._database)
                self._origin = stored_origin(self.settings, self._database.path)
            self._drives.open(self._folders.ids)
            self.sources = SourceFiles(folder, self.settings, writing=writing)
            self.sources.use_known(self.drives)
            labels.follow(self.history.pending(), writing=writing)
            if writing:
                remove_unlisted(folder / LABEL_STEPS, self.history.label_folders())
                self._folders.remove_leftovers()
                self._folders.remove_leaving(self.history)
                self._catalogue.correct_layers(self.features, self._database)
                stack.callback(self._folders.remove_leaving, self.history)
            self._closing = stack.pop_all()

    @staticmethod
    def create(folder: Path, crs: str) -> Project:
        """Make a new, empty project and open it.

        Parameters
        ----------
        folder : Path
            Ends in ``.zuka`` by custom; must not exist, or be empty.
        crs : str
            ``EPSG:n``; empty to take that of the first drive.

        Raises
        ------
        InUse
            There is something in the folder.
        OutOfRange
            The reference system is unknown.
        NoSpace
        """
        folder = folder.absolute()
        system = reference_system(crs) if crs else ""
        with report_as_user_error(folder):
            refuse_occupied(folder)
            folder.mkdir(parents=True, exist_ok=True)
        refuse_links(folder, _OWN)
        lock = ProjectLock(folder)
        try:
            # The database takes its name when it is whole: until then there is no project.
            make_database(folder / _DATABASE, system)
        except BaseException:
            lock.release()
            Project.remove_new(folder)
            raise
        lock.release()
        return Project(folder, writing=True)

    @staticmethod
    def open(folder: Path, *, writing: bool = True) -> Project:
        """Open a project.

        Parameters
        ----------
        writing : bool
            False: for reading only, possible while a window has it open; not a byte is written.

        Raises
        ------
        MissingInput, BadFile, InUse, NoSpace
            The folder is left as it was.
        """
        if not is_project(folder):
            raise MissingInput(
                Text("There is no project here.", "ここにプロジェクトはありません。"),
                Text.same(str(folder)),
                Text(
                    "Choose a project's folder, or make one with zuka import.",
                    "プロジェクトのフォルダを選ぶか、zuka import で作成してください。",
                ),
            )
        return Project(folder.absolute(), writing=writing)

    @staticmethod
    def remove_new(folder: Path) -> None:
        """Remove a closed project that was made for something that failed.

        Only what the program makes is removed; the folder too when nothing else is in it.
        """
        for name in _FOLDERS:
            remove_folder(folder / name)
        remove_database(folder, _DATABASE)

    @property
    def name(self) -> str:
        """The folder's name without its ending."""
        return self.folder.stem

    @property
    def crs(self) -> str:
        """``EPSG:n``, or empty when unknown."""
        return self.settings.text(CRS)

    @property
    def catalogue(self) -> Catalogue:
        """The kinds it is drawn by: its own, or those that come with the program."""
        return self._catalogue.current

    @property
    def drives(self) -> tuple[Drive, ...]:
        """All drives, in the order in which they were imported."""
        return self._drives.all

    @property
    def origin(self) -> NDArray[np.float64]:
        """The (3,) local origin of drawing: near the first drive, to whole 100 m; a copy."""
        return self._origin.copy()

    @property
    def is_empty(self) -> bool:
        """Whether nothing is in it: no drive, no feature, no import that can go on."""
        return not (self.drives or len(self.features) or unfinished_imports(self.folder))

    def drive(self, id: str) -> Drive:  # noqa: A002 - the word of the trade
        """One drive; KeyError when there is none of that id."""
        return self._drives[id]

    def listed_drive(self, drive: Drive) -> ListedDrive:
        """A drive as a step that removes it names it."""
        return self._folders.listed(drive.id)

    def find_sources(self) -> None:
        """Look where delivered files and camera images are now; may wait for file systems.

        A window asks ``sources.survey`` in a thread of its own instead.
        """
        moves = self.sources.survey(self.drives).moves_found(lambda: None)
        for drive in self.drives:
            drive.use_moves(moves)

    def label_folder(self) -> Path:
        """A new name for a folder in which labels of many points are filed."""
        return self.folder / LABEL_STEPS / uuid4().hex

    @property
    def taken_ids(self) -> tuple[str, ...]:
        """Ids that no new drive may get."""
        return self._folders.taken

    def temporary_folder(self) -> Path:
        """A new name for a folder of an import; what is left there goes at the next opening."""
        return self._folders.temporary()

    def adopt_drive(self, folder: Path) -> Drive:
        """Make a finished temporary drive folder part of the project.

        Raises
        ------
        OutOfRange
            Its reference system is not the project's.
        NoSpace, InUse
            The project and the folder are as they were.
        """
        return self.adopt_drives((folder,))[0]

    def adopt_drives(self, folders: tuple[Path, ...]) -> tuple[Drive, ...]:
        """As :meth:`adopt_drive` for several, all or none; ``BadFile`` for a damaged one."""
        new = [Drive(folder) for folder in folders]
        if not new:
            return ()
        crs = self._crs_with(new)
        origin = self._origin if self.drives else origin_of(new[0])
        homes = self.sources.homes_with(drive.id for drive in new)
        arriving = {drive.id: folder for drive, folder in zip(new, folders, strict=True)}
        with self._folders.adopting(arriving) as connection:
            write_setting(connection, ORIGIN, origin.tolist())
            write_setting(connection, HOMES, homes)
            if crs != self.crs:
                self._write_crs(connection, crs)
        self._origin = origin
        self.settings.took(ORIGIN, origin.tolist())
        self.settings.took(HOMES, homes)
        if crs != self.crs:
            self._took_crs(crs)
        return self._drives.open(drive.id for drive in new)

    def complete_drives(self, completed: Sequence[CompletedDrive]) -> tuple[Drive, ...]:
        """Let drives be as they were completed, all of them or none; map and labels stay theirs.

        Where points have another order now, what was done before can't be undone any longer.

        Raises
        ------
        OutOfRange
            A drive is gone, or what is known of its points changed since: nothing was changed.
        NoSpace, InUse, BadFile
            Nothing was changed.
        """
        if not completed:
            return ()
        for one in completed:
            if one.id not in self._folders.ids or not one.fits(self.drive(one.id)):
                raise drive_changed(one.name)
        positions = {one.id: where for one in completed if (where := one.positions()) is not None}
        with self._folders.replacing({one.id: one.folder for one in completed}) as connection:
            moved = self.features.rewrite_points(connection, positions)
            standing = self.history.begin_anew(connection) if positions else None
        self.features.took_points(moved)
        if standing is not None:
            self.history.ended_undo(standing, standing.position)
        for one in completed:
            one.remove_rest()
        return self.reopen_drives(one.id for one in completed)

    def reopen_drives(self, ids: Iterable[str]) -> tuple[Drive, ...]:
        """Open drives anew whose folders have changed."""
        drives = self._drives.open(ids)
        self.sources.use_known(drives)
        return drives

    def set_crs(self, crs: str) -> None:
        """Say what reference system all coordinates of the project are in.

        Raises
        ------
        OutOfRange
            There is no such system, or a drive was delivered in another.
        NoSpace, InUse
            The project is as it was.
        """
        code = reference_system(crs)
        for drive in self.drives:
            if drive.info.crs not in ("", code):
                raise other_system(drive.info.name, drive.info.crs, code)
        with self._database.transaction() as connection:
            self._write_crs(connection, code)
        self._took_crs(code)

    def compare_catalogue(self, path: Path) -> CatalogueComparison:
        """What :meth:`adopt_catalogue` would change.

        Raises
        ------
        MissingInput, NoSpace, BadFile
            The file can't be read, or is no catalogue; names the line.
        """
        return compare(self.catalogue, read_catalogue(path), self.features.all())

    def adopt_catalogue(self, path: Path, *, keep_used: bool = False) -> CatalogueComparison:
        """Take an office's catalogue: a copy in the project's folder, by which it draws from now.

        Parameters
        ----------
        keep_used : bool
            Whether kinds that the new one lacks and features use are kept in the copy.

        Raises
        ------
        MissingInput, BadFile
            As :meth:`compare_catalogue`.
        Unsuitable
            Features would lose their kind, or not fit it.
        NoSpace, InUse
            The project is as it was.
        """
        return self._catalogue.adopt(path, self.features, self._database, keep_used=keep_used)

    def export_catalogue(self, path: Path) -> None:
        """Write the project's catalogue to a file, for an office to start its own from.

        Raises
        ------
        InUse
            The path is a file of the project or the program, or a delivered one.
        NoSpace, MissingInput
        """
        delivered = [file for drive in self.drives for file in drive.delivered_files]
        ours = (self._catalogue.path, self._database.path, path_of("catalogue/level500.toml"))
        write_catalogue(path, self.catalogue, never=(*ours, *delivered))

    def close(self) -> None:
        """Close the database and let others have the project; may be called again."""
        self._closing.close()

    def _crs_with(self, new: list[Drive]) -> str:
        """The project's reference system once drives are in it."""
        crs = self.crs
        for drive in new:
            theirs = drive.info.crs
            if theirs and crs and theirs != crs:
                raise other_system(drive.info.name, theirs, crs)
            crs = crs or (reference_system(theirs) if theirs else "")
        return crs

    def _write_crs(self, connection: sqlite3.Connection, crs: str) -> None:
        write_reference_system(connection, crs)
        write_setting(connection, CRS, crs)
        self.features.rewrite_srs(connection, srs_number(crs))

    def _took_crs(self, crs: str) -> None:
        self.settings.took(CRS, crs)
        self.features.took_srs(srs_number(crs))

    def _srs_number(self) -> int:
        try:
            return srs_number(self.crs)
        except ValueError as error:
            raise damaged(self._database.path, f"zuka_settings.crs: {error}") from error
