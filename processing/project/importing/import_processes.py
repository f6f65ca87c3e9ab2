"""Delivered files read into columns by this process, or by several beside it."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
import tempfile
import threading
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

import processing
from processing.core.errors import (
    BadFile,
    InUse,
    MissingInput,
    NoSpace,
    OutOfRange,
    Unsuitable,
    UserError,
)
from processing.core.text import Text
from processing.project.importing.file_record import FileJob, FileRecord, record_from
from processing.project.importing.file_recorder import NotAsPlanned, record_file
from processing.project.importing.import_worker import MIXED, REFUSED, WHOLE

MOST_PROCESSES = 4
FEWEST_POINTS = 10_000_000
"""Points for which a second process is worth its start."""
LAZ_CORES = 2
"""Cores that one process keeps busy with compressed files, whose decoder uses several by itself."""

_WAIT_S = 0.05
_LAZ = ("LAZ", "COPC")
_ERRORS = {
    kind.__name__: kind for kind in (BadFile, InUse, MissingInput, NoSpace, OutOfRange, Unsuitable)
}

FileBatch = Sequence[tuple[FileJob, FileRecord]]
ProgressListener = Callable[[int, FileRecord], None]


class MixedFile(Exception):
    """A file is not as planned; says which."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def record_files(work: FileBatch, reported: ProgressListener, check: Callable[[], None]) -> None:
    """Read files into columns; what is written does not depend on how many processes do it.

    Parameters
    ----------
    work : sequence of (FileJob, FileRecord)
        Files and how far they are.
    reported : callable
        Called with a file's number and record after each stretch, and at its end.
    check : callable
        Called all the time; what it raises ends the work.

    Raises
    ------
    UserError
        A file can't be read, or the disk is full.
    MixedFile
    """
    number = processes_for(work)
    if number > 1:
        _record_beside(deque(work), number, reported, check)
        return
    for job, record in work:

        def tell(so_far: FileRecord, file: int = job.number) -> None:
            reported(file, so_far)
            check()

        check()
        try:
            reported(job.number, record_file(job, record, tell))
        except NotAsPlanned as surprise:
            raise MixedFile(job.number) from surprise


def processes_for(work: FileBatch) -> int:
    """How many processes are worth their start."""
    left = sum(job.count - record.done for job, record in work)
    if left < FEWEST_POINTS:
        return 1
    is_laz = any(job.format in _LAZ for job, _ in work)
    cores = (os.cpu_count() or 1) // (LAZ_CORES if is_laz else 1)
    return max(1, min(MOST_PROCESSES, cores, len(work)))


def _record_beside(
    left: deque[tuple[FileJob, FileRecord]],
    number: int,
    reported: ProgressListener,
    check: Callable[[], None],
) -> None:
    answers: SimpleQueue[tuple[_Worker, str | None]] = SimpleQueue()
    workers = [_Worker(answers) for _ in range(number)]
    try:
        busy = len([worker for worker in workers if worker.go_on(left)])
        while busy:
            check()
            try:
                worker, line = answers.get(timeout=_WAIT_S)
            except Empty:
                continue
            if line is None:
                raise worker.death()
            what, file, facts = json.loads(line)
            if what == REFUSED:
                raise _error_from(facts)
            if what == MIXED:
                raise MixedFile(file)
            reported(file, record_from(facts))
            if what == WHOLE and not worker.go_on(left):
                busy -= 1
    finally:
        for worker in workers:
            worker.end()


class _Worker:
    """A process beside this one that reads files; its answers go to a queue, at last None."""

    def __init__(self, answers: SimpleQueue[tuple[_Worker, str | None]]) -> None:
        self._answers = answers
        root = str(Path(processing.__file__).parent.parent)
        path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
        self._complaints = tempfile.TemporaryFile()  # noqa: SIM115 - closed by end()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "processing.project.importing.import_worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaints,
            env={**os.environ, "PYTHONPATH": path, "PYTHONIOENCODING": "utf-8:surrogateescape"},
            text=True,
            encoding="utf-8",
            errors="surrogateescape",
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self._listener = threading.Thread(target=self._listen, name="import", daemon=True)
        self._listener.start()

    def go_on(self, left: deque[tuple[FileJob, FileRecord]]) -> bool:
        """Give it the next file; says whether there was one."""
        if not left:
            return False
        job, record = left.popleft()
        asked = {"job": dataclasses.asdict(job), "record": record.to_json()}
        if self._process.stdin is not None:
            # A process that died is noticed by its last answer.
            with suppress(OSError):
                self._process.stdin.write(json.dumps(asked) + "\n")
                self._process.stdin.flush()
        return True

    def death(self) -> ChildProcessError:
        """Why it ended by itself."""
        status = self._process.wait()
        self._complaints.seek(0)
        words = self._complaints.read().decode("utf-8", "replace")
        return ChildProcessError(f"a process that reads files ended with {status}: {words}")

    def end(self) -> None:
        """End it, whatever it does."""
        self._process.kill()
        self._process.wait()
        self._listener.join()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        self._complaints.close()

    def _listen(self) -> None:
        if self._process.stdout is not None:
            for line in self._process.stdout:
                self._answers.put((self, line))
        self._answers.put((self, None))


def _error_from(facts: dict[str, Any]) -> UserError:
    what, where, remedy = (Text(**one) for one in facts["texts"])
    error = _ERRORS.get(facts["kind"], UserError)(what, where, remedy)
    if facts["errno"] is not None:
        error.__cause__ = OSError(facts["errno"], os.strerror(facts["errno"]))
    return error
