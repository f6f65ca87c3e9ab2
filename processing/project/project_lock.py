"""ProjectLock: one program at a time changes a project; a killed one leaves nothing behind."""

from __future__ import annotations

import json
import os
import platform
from datetime import UTC, datetime
from pathlib import Path

from filelock import FileLock, Timeout

from processing.errors import InUse, told_as_user_error
from processing.text import Text

_LOCK, _OWNER = "lock", "lock-owner.json"


class ProjectLock:
    """Held from its making to :meth:`release`; the operating system releases a dead program's.

    Raises
    ------
    InUse
        Another program, or another window of this one, has the project open; says which.
    NoSpace
        The folder can't be written.
    """

    def __init__(self, folder: Path) -> None:
        self._owner_path = folder / _OWNER
        # Not a singleton: a second window of the same process must be refused too.
        self._lock = FileLock(folder / _LOCK, timeout=0)
        with told_as_user_error(folder):
            try:
                self._lock.acquire()
            except Timeout as error:
                raise _in_use(folder, self._owner()) from error
        owner = {
            "host": platform.node(),
            "process": os.getpid(),
            "since": datetime.now(UTC).astimezone().strftime("%Y-%m-%d %H:%M"),
        }
        with told_as_user_error(self._owner_path):
            self._owner_path.write_text(json.dumps(owner), encoding="utf-8")

    def release(self) -> None:
        """Let others have the project; may be called again."""
        self._lock.release()

    def _owner(self) -> str:
        try:
            owner = json.loads(self._owner_path.read_text(encoding="utf-8"))
            return f"{owner['host']}, process {owner['process']}, {owner['since']}"
        except (OSError, ValueError, KeyError, TypeError):
            # Who it is is a courtesy; that it is locked is the fact.
            return "?"


def _in_use(folder: Path, owner: str) -> InUse:
    return InUse(
        Text(
            "The project is open in another window.",
            "プロジェクトは別のウィンドウで開かれています。",
        ),
        Text.same(f"{folder} ({owner})"),
        Text(
            "Close it there, or work there.",
            "そのウィンドウで作業するか、閉じてから開いてください。",
        ),
    )
