"""What SQLite says, in sentences a user can act on."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from processing.core.errors import BadFile, InUse, NoSpace
from processing.core.text import Text

# A wrong thread, a closed connection, too few values: our defects, told as such.
_DEFECTS = (sqlite3.ProgrammingError, sqlite3.InterfaceError)
_BUSY = frozenset({sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED})
_REFUSED = frozenset(
    {
        sqlite3.SQLITE_FULL,
        sqlite3.SQLITE_IOERR,
        sqlite3.SQLITE_READONLY,
        sqlite3.SQLITE_CANTOPEN,
        sqlite3.SQLITE_PERM,
    }
)
_UNREADABLE = frozenset({sqlite3.SQLITE_IOERR_READ, sqlite3.SQLITE_IOERR_SHORT_READ})


@contextmanager
def report_database_errors(path: Path) -> Iterator[None]:
    """Turn what SQLite says about a project's database into a `UserError`.

    Raises
    ------
    InUse, NoSpace, BadFile
        In place of what SQLite raises in the body; defects of the program pass.
    """
    try:
        yield
    except _DEFECTS:
        raise
    except sqlite3.Error as error:
        raise _from_sqlite(error, path) from error
    except UnicodeDecodeError as error:
        # SQLite tells of a damaged table in the table's own words.
        raise damaged(path, error) from error


def damaged(path: Path, reason: object) -> BadFile:
    """The database is not what the program wrote."""
    return BadFile(
        Text("The project's database is damaged.", "プロジェクトのデータベースが壊れています。"),
        Text.same(f"{path}: {reason}"),
        Text(
            "Take the project from a backup; the delivered files are untouched.",
            "バックアップからプロジェクトを復元してください。納品ファイルに影響はありません。",
        ),
    )


def changed_elsewhere(path: Path, ids: str) -> BadFile:
    """Another program has changed features under the open project."""
    return BadFile(
        Text(
            "Another program has changed the map in the database.",
            "別のプログラムがデータベース内の地物を変更しました。",
        ),
        Text.same(f"{path}: {ids}"),
        Text(
            "Close the project and open it again, then repeat the step; nothing was changed.",
            "プロジェクトを開き直してから、もう一度実行してください。変更はされていません。",
        ),
    )


def _from_sqlite(error: sqlite3.Error, path: Path) -> BadFile | NoSpace | InUse:
    extended = getattr(error, "sqlite_errorcode", 0)
    code = extended & 0xFF
    if code in _BUSY:
        return InUse(
            Text(
                "Another program is using the project's database.",
                "別のプログラムがプロジェクトのデータベースを使用しています。",
            ),
            Text.same(f"{path}: {error}"),
            Text(
                "Finish the work there, then try again; nothing was changed.",
                "そのプログラムでの作業を終えてから、もう一度実行してください。"
                "変更はされていません。",
            ),
        )
    if code in _REFUSED and extended not in _UNREADABLE:
        return NoSpace(
            Text(
                "The project can't be written: the disk is full or does not allow it.",
                "プロジェクトに書き込めません"
                "（ディスクの空きがないか、書き込みが許可されていません）。",
            ),
            Text.same(f"{path}: {error}"),
            Text(
                "Free some space or get the rights, then try again; nothing was changed.",
                "空き容量を増やすか権限を得てから、もう一度実行してください。"
                "変更はされていません。",
            ),
        )
    return damaged(path, error)
