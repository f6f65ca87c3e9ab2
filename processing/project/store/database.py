"""The project's database: a GeoPackage, opened so that a kill at any instant loses nothing done."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from processing.core.errors import report_as_user_error
from processing.project.store.database_errors import damaged, report_database_errors
from processing.project.store.geometry_blob import SQL_FUNCTIONS
from processing.project.store.reading_connection import connect, connect_for_reading
from processing.project.store.schema import (
    make_tables,
    refuse_other_version,
    stored_version,
)


class Database:
    """One connection to a project's GeoPackage; used by the thread that opened it.

    Parameters
    ----------
    path : Path
        Made by :meth:`create`.
    writing : bool
        False: not a byte is written.

    Raises
    ------
    BadFile
        It is no project, a damaged one, or one of another version of the program.
    NoSpace, InUse
        It can't be written; another program holds it.
    """

    def __init__(self, path: Path, *, writing: bool) -> None:
        self.path = path
        with ExitStack() as stack, report_database_errors(path):
            if writing:
                self._connection = connect(path, "rw")
            else:
                self._connection, clean_up = connect_for_reading(path)
                stack.callback(clean_up)
            stack.callback(self._connection.close)
            self._prepare(writing=writing)
            self._check_length()
            refuse_other_version(stored_version(self._connection, path), path)
            self._seen = self._data_version()
            self._closing = stack.pop_all()

    @staticmethod
    def create(path: Path) -> None:
        """Make the database of a new project; there must be no such file.

        Raises
        ------
        NoSpace
            It can't be written.
        """
        with report_database_errors(path), contextlib.closing(connect(path, "rwc")) as connection:
            connection.execute("PRAGMA encoding = 'UTF-8'")
            connection.execute("BEGIN IMMEDIATE")
            make_tables(connection)
            connection.execute("COMMIT")

    @contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """All that is done in the body, or nothing of it.

        Raises
        ------
        NoSpace, InUse, BadFile
            Nothing was changed.
        """
        with report_database_errors(self.path):
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield self._connection
                self._connection.execute("COMMIT")
            except BaseException:
                # After a full disk SQLite may have rolled back by itself.
                with contextlib.suppress(sqlite3.Error):
                    self._connection.execute("ROLLBACK")
                raise

    @contextmanager
    def snapshot(self) -> Iterator[sqlite3.Connection]:
        """All that is read in the body is of the same instant; one may lie in another.

        Raises
        ------
        InUse, BadFile
        """
        with report_database_errors(self.path):
            if self._connection.in_transaction:
                yield self._connection
                return
            self._connection.execute("BEGIN")
            try:
                yield self._connection
            finally:
                with contextlib.suppress(sqlite3.Error):
                    self._connection.execute("COMMIT")

    def rows(self, query: str, values: tuple[object, ...] = ()) -> list[tuple[object, ...]]:
        """All rows of a query.

        Raises
        ------
        BadFile, InUse
        """
        with report_database_errors(self.path):
            return list(self._connection.execute(query, values))

    def was_changed_elsewhere(self) -> bool:
        """Whether another connection has written since opening, or :meth:`accept_changes`."""
        return self._data_version() != self._seen

    def accept_changes(self) -> None:
        """What another connection has written was looked at and does no harm."""
        self._seen = self._data_version()

    def close(self) -> None:
        """Close the connection; may be called again."""
        self._closing.close()

    def _prepare(self, *, writing: bool) -> None:
        for name, argument_count, function in SQL_FUNCTIONS:
            self._connection.create_function(name, argument_count, function, deterministic=True)
        self._connection.execute("PRAGMA foreign_keys = ON")
        if writing:
            # A rollback journal, since a reader can follow it without writing a byte. QGIS turns
            # a database to a write-ahead log while it is open there; that is as safe.
            self._connection.execute("PRAGMA synchronous = FULL")
            with contextlib.suppress(sqlite3.OperationalError):
                if self._connection.execute("PRAGMA journal_mode").fetchone()[0] == "wal":
                    self._connection.execute("PRAGMA journal_mode = DELETE").fetchone()

    def _check_length(self) -> None:
        """Refuse a file that was cut off, even where nothing is read from its end."""
        with self.snapshot() as connection:
            (pages,) = connection.execute("PRAGMA page_count").fetchone()
            (page_size,) = connection.execute("PRAGMA page_size").fetchone()
            (journal,) = connection.execute("PRAGMA journal_mode").fetchone()
            (_, _, name) = connection.execute("PRAGMA database_list").fetchone()
            with report_as_user_error(self.path):
                size = Path(name).stat().st_size
        # The newest pages of a write-ahead log are not in the file yet.
        if journal != "wal" and size < pages * page_size:
            raise damaged(self.path, f"{size} of {pages * page_size} bytes")

    def _data_version(self) -> int:
        (version,) = self._connection.execute("PRAGMA data_version").fetchone()
        return int(version)
