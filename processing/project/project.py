"""Project: a folder with the recordings of a job, their map, and its history."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import MissingInput, UserError, report_as_user_error
from processing.core.owned_files import remove_folder
from processing.core.text import Text
from processing.map.catalogue import Catalogue
from processing.map.catalogue_change import CatalogueComparison, compare
from processing.map.catalogue_file import read_catalogue
from processing.map.catalogue_writing import write_catalogue
from processing.map.change import Change, ListedDrive, SystemChange
from processing.map.filed_labels import LABEL_STEPS
from processing.map.reference_system import (
    CRS,
    other_system,
    reference_system,
)
from processing.map.step_files import STEP_FILES, StepFiles
from processing.project.importing.drive_completion import CompletedDrive, drive_changed
from processing.project.importing.unfinished_imports import TEMPORARY, unfinished_imports
from processing.project.own_models import OWN_MODELS
from processing.project.photos import PHOTOS
from processing.project.sources.source_files import HOMES, SourceFiles
from processing.project.store.catalogue_adoption import CatalogueFile
from processing.project.store.database import Database
from processing.project.store.drive_folders import DRIVES, DriveFolders
from processing.project.store.exchanged_files import ExchangedFiles, NewStepFiles
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
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_store import IMAGES, write_images
from processing.recording.drive import Drive
from resources import path_of

_DATABASE = "project.gpkg"
_FOLDERS = (DRIVES, TEMPORARY, LABEL_STEPS, STEP_FILES)
_FILES = (*database_files(_DATABASE), *database_files(UNFINISHED), *LOCK_FILES)
OWN = (*_FOLDERS, VOLUMES, OWN_MODELS, PHOTOS, *_FILES)
"""Files and folders that belong to the program in a project's folder."""

_MOST_NAMES = 3


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
        refuse_links(folder, OWN)
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
                self._files = ExchangedFiles(folder, self.drive)
                self._folders = DriveFolders(folder, self._database, self.settings)
                self._drives = OpenDrives(self._folders)
                self.features = FeatureStore(
                    self._database,
                    self.history,
                    self.catalogue,
                    self.settings,
                    labels=labels,
                    drives=self._drives,
                    files=self._files,
                )
                self.runs = Runs(self._database)
                self._origin = stored_origin(self.settings, self._database.path)
            self._drives.open_all()
            self.sources = SourceFiles(folder, self.settings, writing=writing)
            self._drives.tell_opened(self.sources.use_known)
            pending = self.history.pending()
            if writing and pending.files is not None:
                self._files.follow(pending.files)
                self._drives.follow_files(pending.files)
            labels.follow(pending, writing=writing)
            if writing:
                remove_unlisted(folder / LABEL_STEPS, self.history.label_folders())
                self._folders.remove_leftovers()
                self._remove_unwanted()
                self._catalogue.correct_layers(self.features, self._database)
                stack.callback(self._remove_unwanted)
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
        refuse_links(folder, OWN)
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

    @property
    def drive_folders(self) -> tuple[Path, ...]:
        """Where the drives are, those that can't be opened too."""
        return tuple(self._folders.path_of(id_) for id_ in self._folders.ids)

    @property
    def damaged_drives(self) -> Mapping[str, UserError]:
        """Drives that can't be opened, by id, and why; the rest of the project is open."""
        return self._drives.damaged

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

    def new_step_files(self) -> NewStepFiles:
        """For files of a step that takes others' places, those of drives or the project's own."""
        return self._files.new()

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
        return self.take_in(folders)

    def take_in(
        self,
        folders: tuple[Path, ...],
        completed: Sequence[CompletedDrive] = (),
        images: Mapping[str, ImageList] | None = None,
        *,
        leaving: Change | None = None,
    ) -> tuple[Drive, ...]:
        """Take new drives in, and what completes others, as one step that can be undone.

        Map and labels of completed drives stay theirs.

        Parameters
        ----------
        folders : tuple of Path
            Finished temporary folders of new drives.
        images : mapping of str to ImageList
            By drive: all camera images that it has from now on.
        leaving : Change, optional
            Drives that the new ones take the place of, and what goes with them.

        Returns
        -------
        tuple of Drive
            New ones, then those that are others now.

        Raises
        ------
        OutOfRange
            A new drive's reference system is not the project's; one that was completed is gone, or
            what is known of its points changed since.
        NoSpace, InUse, BadFile
            Nothing was changed.
        """
        images, going = images or {}, leaving or Change()
        new = [Drive(folder) for folder in folders]
        self._refuse_changed(completed)
        others = dict.fromkeys([*(one.id for one in completed), *images])
        if not (new or others):
            return ()
        crs = self._crs_with(new)
        built = tuple(self._folders.listed(one.id) for one in completed)
        change = Change(
            replaced=self.features.points_elsewhere(_positions(completed)),
            removed=going.removed,
            removed_drives=(*built, *going.removed_drives),
            files=self._with_images(images, completed),
            system=None if crs == self.crs else SystemChange(self.crs, crs),
        )
        had = [self.drive(id_).info.name for id_ in others]
        label = _label_of([one.info.name for one in new], had, going)
        arriving = {drive.id: folder for drive, folder in zip(new, folders, strict=True)}
        with (
            self._folders.moving_in(arriving, {one.id: one.folder for one in completed}) as moved,
            self._noted_places(new) as note,
        ):
            self.features.apply(label, replace(change, restored_drives=moved), also=note)
        for one in completed:
            one.remove_rest()
        return tuple(self.drive(id_) for id_ in (*arriving, *others))

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
        if code == self.crs:
            return
        for drive in self.drives:
            if drive.info.crs not in ("", code):
                raise other_system(drive.info.name, drive.info.crs, code)
        with self._database.transaction() as connection:
            self.features.write_system(connection, code)
            # A drive of another system that was taken back can't come again.
            standing = self.history.end_redo(connection)
        self.history.stands(standing)
        self.features.took_system(code)

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

    def _refuse_changed(self, completed: Sequence[CompletedDrive]) -> None:
        for one in completed:
            if one.id not in self._folders.ids or not one.fits(self.drive(one.id)):
                raise drive_changed(one.name)

    def _crs_with(self, new: list[Drive]) -> str:
        """The project's reference system once drives are in it."""
        crs = self.crs
        for drive in new:
            theirs = drive.info.crs
            if theirs and crs and theirs != crs:
                raise other_system(drive.info.name, theirs, crs)
            crs = crs or (reference_system(theirs) if theirs else "")
        return crs

    @contextmanager
    def _noted_places(self, new: Sequence[Drive]) -> Iterator[Callable[[sqlite3.Connection], None]]:
        """What writes, and then follows, where drawing has its origin and drives have files."""
        origin = self._origin if self.drives or not new else origin_of(new[0])
        homes = self.sources.homes_with(drive.id for drive in new)

        def note(connection: sqlite3.Connection) -> None:
            write_setting(connection, ORIGIN, origin.tolist())
            write_setting(connection, HOMES, homes)

        yield note
        self._origin = origin
        self.settings.took(ORIGIN, origin.tolist())
        self.settings.took(HOMES, homes)

    def _with_images(
        self, images: Mapping[str, ImageList], completed: Sequence[CompletedDrive]
    ) -> StepFiles | None:
        """Lists of images: in the folder that a drive gets, or in place of the one that it has."""
        folders, files = {one.id: one.folder for one in completed}, self.new_step_files()
        for id_, taken in images.items():
            write_images(folders.get(id_) or files.expect(IMAGES, id_).parent, taken)
        return files.files()

    def _remove_unwanted(self) -> None:
        """Remove what no step of the history can bring back or do again."""
        self._folders.remove_leaving(self.history)
        # What is damaged stays until it is used, which tells.
        with suppress(UserError):
            self._files.remove_unlisted(self.history.file_folders())


def _positions(completed: Sequence[CompletedDrive]) -> dict[str, NDArray[np.int64]]:
    """By drive, where its points are now; without those whose points are where they were."""
    return {one.id: where for one in completed if (where := one.positions()) is not None}


def _label_of(new: Sequence[str], others: Sequence[str], going: Change) -> Text:
    """What the undo menu calls drives that came, or got what they lacked."""
    names = [*new, *others]
    listed = ", ".join(names[:_MOST_NAMES])
    words = (
        Text("Import {names}", "{names} のインポート")
        if new
        else Text("Add to {names}", "{names} への追加")
    )
    if going.removed_drives:
        words = Text("Replace by {names}", "{names} への差し替え")
    return words.filled(names=listed if len(names) <= _MOST_NAMES else f"{listed} …")
