"""The tables of a project: a GeoPackage's own and the map's."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from processing.core.errors import BadFile
from processing.core.text import Text

APPLICATION_ID = 0x47504B47  # "GPKG"
GEOPACKAGE_VERSION = 10300

SCHEMA = 1
"""Version of the tables; a project of another one is refused."""

_GEOPACKAGE = """
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY NOT NULL, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined cartesian SRS', -1, 'NONE', -1, 'undefined', NULL),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', NULL),
  ('WGS 84', 4326, 'EPSG', 4326, 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,'
    || '298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,'
    || 'AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],'
    || 'AUTHORITY["EPSG","4326"]]', NULL);
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
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_extensions (
  table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL,
  scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name));
"""
_TABLES = """
CREATE TABLE features (
  fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom GEOMETRY NOT NULL,
  id TEXT NOT NULL UNIQUE, kind TEXT NOT NULL, layer TEXT NOT NULL, status TEXT NOT NULL,
  confidence DOUBLE NOT NULL, attributes TEXT NOT NULL, provenance TEXT NOT NULL,
  measured TEXT NOT NULL, occluded TEXT NOT NULL);
INSERT INTO gpkg_contents (table_name, data_type, identifier, description, srs_id)
  VALUES ('features', 'features', 'features', 'The map', -1);
INSERT INTO gpkg_geometry_columns VALUES ('features', 'geom', 'GEOMETRY', -1, 2, 0);
CREATE TABLE zuka_runs (
  fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, id TEXT NOT NULL UNIQUE, tool TEXT NOT NULL,
  version INTEGER NOT NULL, parameters TEXT NOT NULL, drives TEXT NOT NULL,
  started TEXT NOT NULL, finished TEXT NOT NULL,
  summary_en TEXT NOT NULL, summary_ja TEXT NOT NULL);
INSERT INTO gpkg_contents (table_name, data_type, identifier, description)
  VALUES ('zuka_runs', 'attributes', 'zuka_runs', 'What tools were run');
CREATE TABLE zuka_settings (key TEXT PRIMARY KEY NOT NULL, value TEXT NOT NULL);
CREATE TABLE zuka_drives (id TEXT PRIMARY KEY NOT NULL, place INTEGER NOT NULL);
CREATE TABLE zuka_history (
  place INTEGER PRIMARY KEY NOT NULL, label_en TEXT NOT NULL, label_ja TEXT NOT NULL,
  change TEXT NOT NULL);
CREATE TABLE zuka_history_labels (
  place INTEGER NOT NULL, number INTEGER NOT NULL, drive TEXT NOT NULL, count INTEGER NOT NULL,
  points BLOB NOT NULL, before BLOB NOT NULL, after BLOB NOT NULL, PRIMARY KEY (place, number));
INSERT INTO gpkg_extensions VALUES
  ('zuka_settings', NULL, 'zuka_project', 'Tables of the program Zuka', 'read-write'),
  ('zuka_drives', NULL, 'zuka_project', 'Tables of the program Zuka', 'read-write'),
  ('zuka_history', NULL, 'zuka_project', 'Tables of the program Zuka', 'read-write'),
  ('zuka_history_labels', NULL, 'zuka_project', 'Tables of the program Zuka', 'read-write');
"""
# features.occluded: a JSON list of the numbers of vertices that rest on no measured point.
# zuka_history_labels: points whose labels a step changed; packed, since they are millions.


def make_tables(connection: sqlite3.Connection) -> None:
    """Make the tables of a new project in an empty file, in the caller's transaction."""
    for statement in (_GEOPACKAGE + _TABLES).split(";\n"):
        if statement.strip():
            connection.execute(statement)
    connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    connection.execute(f"PRAGMA user_version = {GEOPACKAGE_VERSION}")
    connection.execute("INSERT INTO zuka_settings VALUES ('schema', ?)", (str(SCHEMA),))


def stored_version(connection: sqlite3.Connection, path: Path) -> int:
    """The schema version of a project.

    Raises
    ------
    BadFile
        It is no project.
    """
    query = "SELECT value FROM zuka_settings WHERE key = 'schema'"
    tables = {name for (name,) in connection.execute("SELECT name FROM sqlite_master")}
    found = connection.execute(query).fetchone() if "zuka_settings" in tables else None
    if found is None or not str(found[0]).isdecimal():
        raise BadFile(
            Text("This is not a project of Zuka.", "Zukaのプロジェクトではありません。"),
            Text.same(str(path)),
            Text(
                "Take the project from a backup, or import the delivered files into a new one.",
                "バックアップからプロジェクトを復元するか、"
                "納品ファイルを新しいプロジェクトにインポートしてください。",
            ),
        )
    return int(found[0])


def refuse_other_version(version: int, path: Path) -> None:
    """Refuse tables that only another version of the program understands.

    Raises
    ------
    BadFile
    """
    if version != SCHEMA:
        raise BadFile(
            Text(
                "The project was made by another version of Zuka.",
                "別のバージョンのZukaで作成されたプロジェクトです。",
            ),
            Text.same(f"{path}: {version}, {SCHEMA}"),
            Text("Open it with that version.", "そのバージョンのZukaで開いてください。"),
        )
