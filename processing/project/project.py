"""Project: a folder with the recordings of a job, their map, and its history."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.errors import UNCHANGED, InUse, MissingInput, OutOfRange, told_as_user_error
from processing.points.drive import Drive
from processing.project.catalogue import Catalogue, read_catalogue
from processing.project.database import Database
from processing.project.feature_store import FeatureStore
from processing.project.history import History
from processing.project.project_lock import ProjectLock
from processing.project.reference_system import reference_system
from processing.text import Text
from resources import path_of

_DATABASE = "project.gpkg"
_CATALOGUE = "catalogue.toml"
_DRIVES, _TEMPORARY = "drives", "tmp"
_ORIGIN_STEP_M = 100.0


def is_project(path: Path) -> bool:
    """Whether a path is a project's folder."""
    return (path / _DATABASE).is_file()


class Project:
    """The folder and all it holds; made by :meth:`create` and :meth:`open`.

    Used by one thread; long work gets drives and values, never the project.
    """

    def __init__(self, folder: Path, *, writing: bool) -> None:
        self.folder = folder
        self._lock = ProjectLock(folder) if writing else None
        try:
            self._database = Database(folder / _DATABASE, writing=writing)
            self._settings = self._read_settings()
            self.history = History(self._database)
            self.features = FeatureStore(self._database, self.history, self._srs_id())
            self.catalogue = self._read_catalogue()
            rows = self._database.rows("SELECT id FROM zuka_drives ORDER BY place")
            ids = [str(id_) for (id_,) in rows]
            if writing:
                self._remove_leftovers(frozenset(ids))
            self._drives = {id_: Drive(folder / _DRIVES / id_) for id_ in ids}
        except BaseException:
            self.close()
            raise

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
        with told_as_user_error(folder):
            if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
                raise InUse(
                    Text(
                        "There is something else in this place.", "この場所には別のものがあります。"
                    ),
                    Text.same(str(folder)),
                    Text(
                        "Choose another name for the project.",
                        "別のプロジェクト名を選んでください。",
                    ),
                )
            is_new = not folder.exists()
            folder.mkdir(parents=True, exist_ok=True)
        try:
            project = Project(folder, writing=True)
        except BaseException:
            if is_new:
                shutil.rmtree(folder, ignore_errors=True)
            raise
        if system:
            project.set_crs(system)
        return project

    @staticmethod
    def open(folder: Path, *, writing: bool = True) -> Project:
        """Open a project.

        Parameters
        ----------
        writing : bool
            False: for reading only, possible while a window has it open.

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
        """Remove a closed project that was made for an import that failed."""
        shutil.rmtree(folder, ignore_errors=True)

    @property
    def name(self) -> str:
        """The folder's name without its ending."""
        return self.folder.stem

    @property
    def crs(self) -> str:
        """``EPSG:n``, or empty when unknown."""
        return self._settings.get("crs", "")

    @property
    def drives(self) -> tuple[Drive, ...]:
        """All drives, in the order in which they were imported."""
        return tuple(self._drives.values())

    @property
    def origin(self) -> NDArray[np.float64]:
        """The (3,) local origin of drawing: near the first drive, to whole 100 m."""
        if not self._drives:
            return np.zeros(3)
        info = self.drives[0].info
        middle = (np.array(info.lowest) + np.array(info.highest)) / 2
        return np.asarray(np.rint(middle / _ORIGIN_STEP_M) * _ORIGIN_STEP_M)

    def drive(self, id: str) -> Drive:  # noqa: A002 - the word of the trade
        """One drive; KeyError when there is none of that id."""
        return self._drives[id]

    def temporary_folder(self) -> Path:
        """A new name for a folder of an import; what is left there goes at the next opening."""
        return self.folder / _TEMPORARY / uuid4().hex

    def adopt_drive(self, folder: Path) -> Drive:
        """Make a finished temporary drive folder part of the project.

        Raises
        ------
        OutOfRange
            Its reference system is not the project's.
        NoSpace
            The project is as it was.
        """
        drive = Drive(folder)
        crs = drive.info.crs
        if crs and self.crs and crs != self.crs:
            raise OutOfRange(
                Text(
                    "The drive's reference system {theirs} is not the project's {ours}.",
                    "ドライブの座標参照系 {theirs} がプロジェクトの {ours} と異なります。",
                ).filled(theirs=crs, ours=self.crs),
                Text.same(drive.info.name),
                Text(
                    "Import it into a project of its own. {unchanged}",
                    "別のプロジェクトにインポートしてください。{unchanged}",
                ).filled(unchanged=UNCHANGED),
            )
        final = self.folder / _DRIVES / drive.id
        with told_as_user_error(final):
            final.parent.mkdir(exist_ok=True)
            folder.rename(final)
        try:
            with self._database.transaction() as connection:
                connection.execute(
                    "INSERT INTO zuka_drives VALUES (?, ?)", (drive.id, len(self._drives))
                )
        except BaseException:
            shutil.rmtree(final, ignore_errors=True)
            raise
        if crs and not self.crs:
            self.set_crs(crs)
        self._drives[drive.id] = Drive(final)
        return self._drives[drive.id]

    def set_crs(self, crs: str) -> None:
        """Say what reference system all coordinates of the project are in.

        Raises
        ------
        OutOfRange
            There is no such system.
        """
        code = reference_system(crs)
        number = int(code.partition(":")[2])
        from pyproj import CRS

        system = CRS.from_user_input(code)
        with self._database.transaction() as connection:
            connection.execute(
                "INSERT OR REPLACE INTO gpkg_spatial_ref_sys VALUES (?, ?, 'EPSG', ?, ?, NULL)",
                (system.name, number, number, system.to_wkt("WKT1_GDAL")),
            )
            for table in ("gpkg_contents", "gpkg_geometry_columns"):
                connection.execute(f"UPDATE {table} SET srs_id = ?", (number,))  # noqa: S608 - constants
            connection.execute(
                "INSERT OR REPLACE INTO zuka_settings VALUES ('crs', ?)", (json.dumps(code),)
            )
            self.features.rewrite_srs(connection, number)
        self._settings["crs"] = code

    def close(self) -> None:
        """Close the database and let others have the project; may be called again."""
        if hasattr(self, "_database"):
            self._database.close()
        if self._lock is not None:
            self._lock.release()

    def _remove_leftovers(self, ids: frozenset[str]) -> None:
        """What an import that was killed left behind: it was never part of the project."""
        shutil.rmtree(self.folder / _TEMPORARY, ignore_errors=True)
        drives = self.folder / _DRIVES
        if drives.is_dir():
            for folder in drives.iterdir():
                if folder.name not in ids:
                    shutil.rmtree(folder, ignore_errors=True)

    def _read_settings(self) -> dict[str, str]:
        rows = self._database.rows("SELECT value FROM zuka_settings WHERE key = 'crs'")
        return {"crs": str(json.loads(str(rows[0][0])))} if rows else {}

    def _srs_id(self) -> int:
        return int(self.crs.partition(":")[2]) if self.crs else -1

    def _read_catalogue(self) -> Catalogue:
        own = self.folder / _CATALOGUE
        return read_catalogue(own if own.is_file() else path_of("catalogue/level500.toml"))
