"""ImportJournal: what of an import is safe on the disk, so that it can go on after a kill.

Notes are kept in memory and written every ten seconds, after the columns they speak of were handed
to the disk: a power cut is survived, and an import that takes less pays nothing.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

from processing.core.errors import report_as_user_error
from processing.core.stored_json import json_of
from processing.recording.columns.replacing import flush_folder, flush_names

PLAN, JOURNAL, FINISHED = "plan.json", "journal.jsonl", "finished.json"
SECONDS = 10.0
"""Work that a kill may cost."""

_ROOM, _ROOM_BYTES = "room", 1 << 18

# What is noted under a name: JSON, whose types its reader knows.
JournalEntries = dict[str, Any]


class ImportJournal:
    """Facts by name, in the folder of an import.

    Parameters
    ----------
    folder : Path
        The import's own; exists.
    is_kept : bool
        Whether the import may go on one day; if not, nothing is ever written.
    """

    def __init__(self, folder: Path, *, is_kept: bool) -> None:
        self.folder = folder
        self._is_kept = is_kept
        self._facts: dict[str, JournalEntries] = {}
        self._waiting: dict[str, JournalEntries] = {}
        self._unsafe: set[Path] = set()
        self._last = time.monotonic()
        self._pool = ThreadPoolExecutor(max_workers=1)
        self._writing: Future[None] | None = None
        self._is_begun = False
        if is_kept:
            self._read()

    @property
    def is_begun(self) -> bool:
        """Whether anything was ever written."""
        return self._is_begun

    def begin(self, plan: object) -> None:
        """Write down what is imported, and take room for a last note on a full disk."""
        path = self.folder / PLAN
        with report_as_user_error(path):
            (self.folder / _ROOM).write_bytes(bytes(_ROOM_BYTES))
            temporary = path.with_suffix(".part")
            text = json.dumps(plan, ensure_ascii=False)
            # Names of files may be no text; JSON reads them back.
            temporary.write_text(text, encoding="utf-8", errors="backslashreplace")
            temporary.replace(path)

    def known(self, name: str) -> JournalEntries | None:
        """What was noted last under a name."""
        return self._facts.get(name)

    def note(self, name: str, facts: JournalEntries, unsafe: Iterable[Path] = ()) -> None:
        """Note facts, to be written when it is time.

        Parameters
        ----------
        unsafe : iterable of Path
            Folders whose files the facts speak of, not yet known to be on the disk.

        Raises
        ------
        NoSpace
            Of this note or of one before.
        """
        self._facts[name] = facts
        self._waiting[name] = facts
        self._unsafe.update(unsafe)
        if self._is_time and (self._writing is None or self._writing.done()):
            self._wait()
            self._start()

    def settle(self) -> None:
        """Have all notes on the disk now, if any was ever written or it is time.

        Called where columns are about to be replaced by what an older note does not know. Where
        nothing was written yet, an import that is killed starts from the beginning anyhow.

        Raises
        ------
        NoSpace
        """
        self._wait()
        if self._waiting and (self._is_begun or self._is_time):
            self._start()
            self._wait()

    def save(self) -> None:
        """Have all notes on the disk now, as far as it takes them: it may be full."""
        if not self._is_kept:
            return
        with suppress(OSError):
            (self.folder / _ROOM).unlink(missing_ok=True)
        # What was being written failed with the disk; its lines are written again.
        self._waiting = dict(self._facts)
        if self._writing is not None:
            self._writing.exception()
            self._writing = None
        self._start()
        if self._writing is not None:
            self._writing.exception()
            self._writing = None

    def finish(self, drives: Iterable[str]) -> None:
        """Note the ids of all drives: what is left when they are in the project is litter."""
        self.settle()
        if self._is_kept:
            path = self.folder / FINISHED
            with report_as_user_error(path):
                path.write_text(json.dumps(list(drives)), encoding="utf-8")

    def close(self) -> None:
        """End the thread that writes; what was not written is lost. May be called again."""
        self._pool.shutdown()

    @property
    def _is_time(self) -> bool:
        return self._is_kept and time.monotonic() - self._last >= SECONDS

    def _read(self) -> None:
        path = self.folder / JOURNAL
        if not path.is_file():
            return
        with report_as_user_error(path):
            lines = path.read_bytes().splitlines()
        for line in lines:
            # The last line may be cut off by the kill.
            with suppress(ValueError, TypeError, AttributeError):
                self._facts.update(json_of(line))
        self._is_begun = bool(self._facts)

    def _start(self) -> None:
        waiting, unsafe = self._waiting, self._unsafe
        self._waiting, self._unsafe = {}, set()
        self._is_begun = True
        self._writing = self._pool.submit(self._write, waiting, unsafe)

    def _wait(self) -> None:
        if self._writing is not None:
            writing, self._writing = self._writing, None
            writing.result()
            self._last = time.monotonic()

    def _write(self, waiting: dict[str, JournalEntries], unsafe: set[Path]) -> None:
        path = self.folder / JOURNAL
        with report_as_user_error(path):
            for folder in sorted(unsafe):
                flush_folder(folder)
            is_new = not path.exists()
            with path.open("ab") as file:
                for name, facts in waiting.items():
                    line = json.dumps({name: facts}, ensure_ascii=False)
                    # A line begins anew even where the one before was cut off.
                    file.write(b"\n" + line.encode("utf-8", "backslashreplace"))
                file.flush()
                os.fsync(file.fileno())
            if is_new:
                flush_names(self.folder)
        self._last = time.monotonic()
