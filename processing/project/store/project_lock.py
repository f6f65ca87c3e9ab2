"""ProjectLock: one program at a time changes a project; a killed one leaves nothing behind."""

from __future__ import annotations

import errno
import json
import os
import platform
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

from filelock import FileLock, Timeout

from processing.core.errors import InUse, NoSpace, report_as_user_error
from processing.core.owned_files import new_file, refuse_link
from processing.core.stored_json import json_of
from processing.core.text import Text

LOCK_FILES = ("lock", "lock-owner.json")
_LOCK, _OWNER = LOCK_FILES


class ProjectLock:
    """Held from its making to :meth:`release`; the operating system releases a dead program's.

    Raises
    ------
    InUse
        Another program, or another window of this one, has the project open; says which.
        So says a link in the lock's place.
    NoSpace
        The folder can't be written.
    """

    def __init__(self, folder: Path) -> None:
        self._owner_path = folder / _OWNER
        # To lock a file is to open it for writing, which empties what a link leads to.
        for name in LOCK_FILES:
            refuse_link(folder / name)
        # Not a singleton: a second window of the same process must be refused too.
        self._lock = FileLock(folder / _LOCK, timeout=0)
        with report_as_user_error(folder / _LOCK):
            try:
                self._lock.acquire()
            except Timeout as error:
                raise _in_use(folder, self._owner()) from error
            except OSError as error:
                if error.errno in (errno.EROFS, errno.EACCES, errno.EPERM):
                    raise _read_only(folder) from error
                raise
        owner = {
            "host": platform.node(),
            "process": os.getpid(),
            "since": datetime.now(UTC).astimezone().strftime("%Y-%m-%d %H:%M"),
        }
        # On a full disk the project can still be looked at; who has it is a courtesy.
        with suppress(OSError), new_file(self._owner_path) as file:
            file.write(json.dumps(owner).encode())

    def release(self) -> None:
        """Let others have the project; may be called again."""
        if self._lock.is_locked:
            with suppress(OSError):
                self._owner_path.unlink(missing_ok=True)
        self._lock.release()

    def _owner(self) -> Text:
        try:
            owner = json_of(self._owner_path.read_text(encoding="utf-8"))
            return Text(
                "on {host} by process {process} since {since}",
                "{host}、プロセス {process}、{since} から",
            ).filled(host=owner["host"], process=owner["process"], since=owner["since"])
        except (OSError, ValueError, KeyError, TypeError):
            # That it is locked is the fact; who it is may not be written down.
            return Text("by another program", "別のプログラム")


def _read_only(folder: Path) -> NoSpace:
    return NoSpace(
        Text(
            "The project is where nothing may be written, so it can't be opened.",
            "プロジェクトが書き込みできない場所にあるため、開けません。",
        ),
        Text.same(str(folder)),
        Text(
            "Copy its folder to a disk of your own and open it there; its files are found from it.",
            "フォルダごと書き込みできるディスクにコピーして開いてください。"
            "納品ファイルの場所はそのまま参照されます。",
        ),
    )


def _in_use(folder: Path, owner: Text) -> InUse:
    return InUse(
        Text(
            "The project is open in another window.",
            "プロジェクトは別のウィンドウで開かれています。",
        ),
        Text("{folder}: {owner}", "{folder}: {owner}").filled(folder=folder, owner=owner),
        Text(
            "Close it there, or work there.",
            "そのウィンドウで作業するか、閉じてから開いてください。",
        ),
    )
