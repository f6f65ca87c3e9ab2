"""The project's database: a GeoPackage, opened so that a kill at any instant loses nothing done."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from processing.errors import BadFile, InUse, NoSpace
from processing.text import Text

APPLICATION_ID = 0x47504B47  # "GPKG"
GEOPACKAGE_VERSION = 10300
SCHEMA_VERSION = 1

_GEOPACKAGE = """
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined cartesian SRS', -1, 'NONE', -1, 'undefined', NULL),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', NULL);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
"""
_FIRST_SCHEMA = """
CREATE TABLE features (
  fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom BLOB NOT NULL, id TEXT NOT NULL UNIQUE,
  kind TEXT NOT NULL, status TEXT NOT NULL, confidence DOUBLE NOT NULL,
  attributes TEXT NOT NULL, provenance TEXT NOT NULL, measured TEXT NOT NULL);
INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id)
  VALUES ('features', 'features', 'features', -1);
INSERT INTO gpkg_geometry_columns VALUES ('features', 'geom', 'GEOMETRY', -1, 2, 0);
CREATE TABLE zuka_settings (key TEXT PRIMARY KEY NOT NULL, value TEXT NOT NULL);
CREATE TABLE zuka_drives (id TEXT PRIMARY KEY NOT NULL, place INTEGER NOT NULL);
CREATE TABLE zuka_history (
  place INTEGER PRIMARY KEY NOT NULL, label_en TEXT NOT NULL, label_ja TEXT NOT NULL,
  change TEXT NOT NULL);
CREATE TABLE zuka_runs (id TEXT PRIMARY KEY NOT NULL, run TEXT NOT NULL);
"""


def _make_first_schema(connection: sqlite3.Connection) -> None:
    for statement in (_GEOPACKAGE + _FIRST_SCHEMA).split(";\n"):
        if statement.strip():
            connection.execute(statement)


MIGRATIONS: tuple[Callable[[sqlite3.Connection], None], ...] = (_make_first_schema,)
"""The step from each schema version to the next, from an empty file on."""


class Database:
    """One connection to a project's GeoPackage; used by the thread that opened it.

    Parameters
    ----------
    path : Path
    writing : bool
        False: not a byte is written.

    Raises
    ------
    BadFile
        It is no project, or one of a newer version of the program.
    NoSpace, InUse
        It can't be written; another program holds it.
    """

    def __init__(self, path: Path, *, writing: bool) -> None:
        self.path = path
        mode = "rwc" if writing else "ro"
        with self._told():
            self._connection = sqlite3.connect(
                f"{path.resolve().as_uri()}?mode={mode}",
                uri=True,
                isolation_level=None,
                timeout=5.0,
            )
            try:
                # A rollback journal, since a reader can follow it without writing a byte.
                self._connection.execute("PRAGMA synchronous = FULL")
                self._connection.execute("PRAGMA foreign_keys = ON")
                self._migrate(writing=writing)
            except BaseException:
                self._connection.close()
                raise

    @contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """All that is done in the body, or nothing of it.

        Raises
        ------
        NoSpace, InUse, BadFile
            Nothing was changed.
        """
        with self._told():
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield self._connection
                self._connection.execute("COMMIT")
            except BaseException:
                # After a full disk SQLite may have rolled back by itself.
                with contextlib.suppress(sqlite3.Error):
                    self._connection.execute("ROLLBACK")
                raise

    def rows(self, query: str, values: tuple[object, ...] = ()) -> list[tuple[object, ...]]:
        """All rows of a query.

        Raises
        ------
        BadFile, InUse
        """
        with self._told():
            return list(self._connection.execute(query, values))

    def close(self) -> None:
        """Close the connection; may be called again."""
        self._connection.close()

    def _migrate(self, *, writing: bool) -> None:
        (found,) = self._connection.execute("PRAGMA user_version").fetchone()
        version = self._schema_version() if found else 0
        if version > SCHEMA_VERSION:
            raise BadFile(
                Text(
                    "The project was made by a newer version of Zuka.",
                    "新しいバージョンのZukaで作成されたプロジェクトです。",
                ),
                Text.same(f"{self.path}: {version} > {SCHEMA_VERSION}"),
                Text("Open it with that version.", "新しいバージョンのZukaで開いてください。"),
            )
        if version == SCHEMA_VERSION:
            return
        if not writing:
            raise _no_project(self.path)
        with self.transaction() as connection:
            for step in MIGRATIONS[version:]:
                step(connection)
            connection.execute(
                "INSERT OR REPLACE INTO zuka_settings VALUES ('schema', ?)", (str(SCHEMA_VERSION),)
            )
            connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            connection.execute(f"PRAGMA user_version = {GEOPACKAGE_VERSION}")

    def _schema_version(self) -> int:
        tables = {name for (name,) in self._connection.execute("SELECT name FROM sqlite_master")}
        if "zuka_settings" not in tables:
            raise _no_project(self.path)
        query = "SELECT value FROM zuka_settings WHERE key = 'schema'"
        found = self._connection.execute(query).fetchone()
        if found is None or not str(found[0]).isdigit():
            raise _no_project(self.path)
        return int(found[0])

    @contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise _from_sqlite(error, self.path) from error


def _no_project(path: Path) -> BadFile:
    return BadFile(
        Text("This is not a project of Zuka.", "Zukaのプロジェクトではありません。"),
        Text.same(str(path)),
        Text(
            "Choose a folder that ends in .zuka, or import the delivered files into a new one.",
            ".zuka で終わるフォルダを選ぶか、"
            "納品ファイルを新しいプロジェクトにインポートしてください。",
        ),
    )


def _from_sqlite(error: sqlite3.Error, path: Path) -> BadFile | NoSpace | InUse:
    where = Text.same(f"{path}: {error}")
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return InUse(
            Text(
                "Another program is using the project's database.",
                "別のプログラムがプロジェクトのデータベースを使用しています。",
            ),
            where,
            Text(
                "Finish the work there, then try again; nothing was changed.",
                "そのプログラムでの作業を終えてから、もう一度実行してください。変更はされていません。",
            ),
        )
    if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_READONLY,
                sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM):  # fmt: skip
        return NoSpace(
            Text(
                "The project can't be written: the disk is full or does not allow it.",
                "プロジェクトに書き込めません（ディスクの空きがないか、書き込みが許可されていません）。",
            ),
            where,
            Text(
                "Free some space or get the rights, then try again; nothing was changed.",
                "空き容量を増やすか権限を得てから、もう一度実行してください。変更はされていません。",
            ),
        )
    return BadFile(
        Text("The project's database is damaged.", "プロジェクトのデータベースが壊れています。"),
        where,
        Text(
            "Take the project from a backup; the delivered files are untouched.",
            "バックアップからプロジェクトを復元してください。納品ファイルに影響はありません。",
        ),
    )
