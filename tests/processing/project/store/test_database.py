"""The database beside other programs, after kills, and across versions."""

from __future__ import annotations

import signal
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing
from pathlib import PurePosixPath, PureWindowsPath

import pytest

from processing.core.errors import BadFile, InUse
from processing.map.change import Change
from processing.project.project import Project
from processing.project.store import database_errors
from processing.project.store.database import Database
from processing.project.store.reading_connection import connect, uri_of
from tests.processing.project.drawn import LABEL, features_of, new_project, sign, tree_of

# Pages written before the commit: the journal alone knows what they held.
KILLED_IN_A_TRANSACTION = """
import os, signal, sqlite3, sys
connection = sqlite3.connect(sys.argv[1], isolation_level=None)
connection.execute("PRAGMA cache_size = 1")
connection.execute("BEGIN IMMEDIATE")
connection.execute("DELETE FROM features")
for number in range(2000):
    connection.execute("INSERT INTO zuka_settings VALUES (?, ?)", (str(number), "1" * 500))
os.kill(os.getpid(), signal.SIGKILL)
"""


def killed_in_a_transaction(folder):
    command = [sys.executable, "-c", KILLED_IN_A_TRANSACTION, folder / "project.gpkg"]
    killed = subprocess.run(command, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert (folder / "project.gpkg-journal").stat().st_size > 0


def test_a_reader_sees_the_last_finished_step_after_a_kill_and_writes_nothing(tmp_path):
    folder = new_project(tmp_path / "街路 #1 %41?.zuka", sign("a"))
    killed_in_a_transaction(folder)
    before = tree_of(folder)
    with closing(Project.open(folder, writing=False)) as project:
        assert features_of(project) == {"a": sign("a")}
        with pytest.raises(database_errors.NoSpace):
            project.features.apply(LABEL, Change(added=(sign("b"),)))
    assert tree_of(folder) == before


def test_a_writer_rolls_back_what_a_killed_program_left(tmp_path):
    folder = new_project(tmp_path / "a.zuka", sign("a"))
    killed_in_a_transaction(folder)
    with closing(Project.open(folder)) as project:
        assert features_of(project) == {"a": sign("a")}
    assert sorted(tree_of(folder)) == ["project.gpkg"]


def test_a_write_ahead_log_left_by_a_gis_program_is_read_without_a_byte_and_then_put_away(
    tmp_path,
):
    folder = new_project(tmp_path / "a.zuka", sign("a"))
    path = folder / "project.gpkg"
    with closing(sqlite3.connect(path)) as gis:
        assert gis.execute("PRAGMA journal_mode = WAL").fetchone() == ("wal",)
    before = tree_of(folder)
    with closing(Project.open(folder, writing=False)) as project:
        assert features_of(project) == {"a": sign("a")}
        assert tree_of(folder) == before
    assert tree_of(folder) == before
    Project.open(folder).close()
    with closing(connect(path, "ro")) as connection:
        assert connection.execute("PRAGMA journal_mode").fetchone() == ("delete",)


def test_drawing_goes_on_while_a_gis_program_holds_the_database_in_wal_mode(tmp_path):
    folder = new_project(tmp_path / "a.zuka", sign("a"))
    with closing(sqlite3.connect(folder / "project.gpkg", isolation_level=None)) as gis:
        gis.execute("PRAGMA journal_mode = WAL")
        gis.execute("BEGIN")
        assert gis.execute("SELECT count(*) FROM features").fetchone() == (1,)
        with closing(Project.open(folder)) as project:
            project.features.apply(LABEL, Change(added=(sign("b"),)))
        with closing(Project.open(folder, writing=False)) as reading:
            assert set(features_of(reading)) == {"a", "b"}
        gis.execute("COMMIT")


def test_a_reader_that_does_not_let_go_is_named_and_nothing_is_changed(tmp_path, monkeypatch):
    monkeypatch.setattr("processing.project.store.reading_connection.BUSY_S", 0.05)
    folder = new_project(tmp_path / "a.zuka", sign("a"))
    with (
        closing(sqlite3.connect(folder / "project.gpkg", isolation_level=None)) as gis,
        closing(Project.open(folder)) as project,
    ):
        gis.execute("BEGIN")
        gis.execute("SELECT * FROM features").fetchone()
        before = (folder / "project.gpkg").read_bytes()
        with pytest.raises(InUse):
            project.features.apply(LABEL, Change(added=(sign("b"),)))
        assert features_of(project) == {"a": sign("a")}
        assert (folder / "project.gpkg").read_bytes() == before
        gis.execute("COMMIT")
        project.features.apply(LABEL, Change(added=(sign("b"),)))
        assert project.history.position == 2


def test_another_thread_is_a_defect_and_not_told_as_a_damaged_file(tmp_path):
    folder = new_project(tmp_path / "a.zuka", sign("a"))
    raised: list[BaseException] = []

    def draw(project: Project) -> None:
        try:
            project.features.apply(LABEL, Change(added=(sign("b"),)))
        except sqlite3.ProgrammingError as error:
            raised.append(error)

    with closing(Project.open(folder)) as project:
        thread = threading.Thread(target=draw, args=(project,))
        thread.start()
        thread.join()
        assert len(raised) == 1
        assert features_of(project) == {"a": sign("a")}


@pytest.mark.parametrize("writing", [True, False])
def test_a_project_of_another_version_is_refused_and_stays_as_it_was(tmp_path, writing):
    path = new_project(tmp_path / "a.zuka", sign("a")) / "project.gpkg"
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE zuka_settings SET value = '7' WHERE key = 'schema'")
    before = path.read_bytes()
    with pytest.raises(BadFile, match="another version"):
        Database(path, writing=writing)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("path", "uri"),
    [
        (PurePosixPath("/data/a b#.zuka/p.gpkg"), "file:///data/a%20b%23.zuka/p.gpkg?mode=ro"),
        (PureWindowsPath(r"C:\図化\p.gpkg"), "file:///C%3A/%E5%9B%B3%E5%8C%96/p.gpkg?mode=ro"),
        (PureWindowsPath(r"\\nas\jobs\p.gpkg"), "file:////nas/jobs/p.gpkg?mode=ro"),
    ],
)
def test_paths_of_every_system_are_written_as_sqlite_reads_them(path, uri):
    assert uri_of(path, "ro") == uri
