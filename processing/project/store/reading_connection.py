"""Connections to a project's database by its path: for writing, or without writing a byte.

A program that was killed may leave a journal that has to be rolled back before anything can be
read. A reader that must not write does that on a copy.
"""

from __future__ import annotations

import shutil
import sqlite3
import tempfile
from collections.abc import Callable
from contextlib import closing
from pathlib import Path, PurePath
from urllib.parse import quote

from processing.core.errors import report_as_user_error

BUSY_S = 5.0

_ATTEMPTS = 5
_WAL_VERSION = 2
_VERSION_POSITION = 18
_NEED_A_COPY = frozenset(
    {
        sqlite3.SQLITE_READONLY_ROLLBACK,
        sqlite3.SQLITE_READONLY_RECOVERY,
        sqlite3.SQLITE_READONLY_CANTINIT,
    }
)


def uri_of(path: PurePath, mode: str) -> str:
    """A path as SQLite's URI, shared folders of Windows (``//server/share``) among them.

    Parameters
    ----------
    path : PurePath
        Absolute.
    mode : str
        ``ro``, ``rw`` or ``rwc``.
    """
    posix = path.as_posix()
    rooted = posix if posix.startswith("/") else f"/{posix}"
    return f"file://{quote(rooted)}?mode={mode}"


def connect(path: Path, mode: str) -> sqlite3.Connection:
    """A connection on which every transaction is begun and ended by its user."""
    with report_as_user_error(path):
        return sqlite3.connect(
            uri_of(path.absolute(), mode), uri=True, isolation_level=None, timeout=BUSY_S
        )


def connect_for_reading(path: Path) -> tuple[sqlite3.Connection, Callable[[], None]]:
    """A connection that never writes to the project.

    Returns
    -------
    connection : sqlite3.Connection
    clean_up : callable
        To be called when the connection is closed.

    Raises
    ------
    sqlite3.Error
        The database can't be read.
    """
    for _ in range(_ATTEMPTS):
        if not _would_make_files(path):
            connection = connect(path, "ro")
            try:
                connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
            except BaseException as error:
                connection.close()
                if getattr(error, "sqlite_errorcode", 0) not in _NEED_A_COPY:
                    raise
            else:
                return connection, _nothing
        copied = _copied(path)
        if copied is not None:
            return copied
    # Another program is at it again and again; SQLite's own words say how.
    return connect(path, "ro"), _nothing


def _would_make_files(path: Path) -> bool:
    """Whether the database is in WAL mode and nobody has it open: a reader would make files."""
    with report_as_user_error(path), path.open("rb") as file:
        head = file.read(_VERSION_POSITION + 1)
    is_wal = len(head) > _VERSION_POSITION and head[_VERSION_POSITION] == _WAL_VERSION
    return is_wal and not Path(f"{path}-shm").exists()


def _copied(path: Path) -> tuple[sqlite3.Connection, Callable[[], None]] | None:
    """A connection to a recovered copy; None when the database was changed meanwhile."""
    with report_as_user_error(path):
        folder = Path(tempfile.mkdtemp(prefix="zuka-"))

    def clean_up() -> None:
        shutil.rmtree(folder, ignore_errors=True)

    try:
        with report_as_user_error(path):
            before = _states(path)
            for end in ("", "-journal", "-wal"):
                source = Path(f"{path}{end}")
                if source.exists():
                    shutil.copyfile(source, folder / f"{path.name}{end}")
            is_whole = _states(path) == before
        if is_whole:
            copy = folder / path.name
            with closing(connect(copy, "rw")) as recovering:
                recovering.execute("PRAGMA journal_mode = DELETE").fetchall()
                recovering.execute("SELECT count(*) FROM sqlite_master").fetchone()
            return connect(copy, "ro"), clean_up
    except BaseException:
        clean_up()
        raise
    clean_up()
    return None


def _states(path: Path) -> list[tuple[int, int] | None]:
    states: list[tuple[int, int] | None] = []
    for end in ("", "-journal", "-wal"):
        file = Path(f"{path}{end}")
        if file.exists():
            status = file.stat()
            states.append((status.st_size, status.st_mtime_ns))
        else:
            states.append(None)
    return states


def _nothing() -> None:
    """There is nothing to clean up."""
