"""A drive worked on in a process of its own: its memory goes back with it, its crash is its own.

The same function stands behind a thread of this machine and behind a task of a cluster.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue

from filelock import FileLock, Timeout

import processing
from processing.core.errors import report_as_user_error
from processing.core.process_memory import memory_of_tree
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.operations.batch.job import JobFile, job_of_order, order_of
from processing.operations.batch.unit_state import (
    LOG_FILE,
    Became,
    ErrorWords,
    TaskState,
    UnitProgress,
    UnitState,
    read_state,
    with_trouble,
    write_progress,
)
from processing.operations.batch.unit_work import BatchUnit
from processing.operations.written_values import Table

STOP_FILE = "stop"
"""In the job's folder of results: whoever works on the job ends."""

TRIES = 2
"""A process that somebody killed is started once more; it goes on where it was."""

_LOCK = ".working"
_WAIT_S = 0.1
_TELL_S = 1.0
_GIB = 1 << 30
_THREADS = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
_WORK = Text("Work on the drive", "走行データの処理")
_AGAIN = Text(
    "Run the job again: it goes on where this ended.",
    "ジョブをもう一度実行すると、続きから処理します。",
)


class Stopped(Exception):
    """The work on a drive was stopped; what was noted stays."""


@dataclass(frozen=True)
class _Ended:
    """How a process ended: its exit status, or why it was ended."""

    status: int
    trouble: TaskState | None = None


def order_for(file: JobFile, unit: BatchUnit, threads: int) -> Table:
    """What a process has to know to work on a unit, as JSON holds it.

    Parameters
    ----------
    threads : int
        How many threads kernels may use.
    """
    deliveries = [[one.name, str(one.path)] for one in unit.deliveries]
    return {
        **order_of(file),
        "name": unit.name,
        "folder": str(unit.folder),
        "deliveries": deliveries,
        "threads": threads,
    }


def work_apart(order: Table, is_stopped: Callable[[], bool]) -> UnitState:
    """Have a unit worked on by a process of its own; gives what has become of it.

    Parameters
    ----------
    is_stopped : callable
        Asked ten times a second.

    Raises
    ------
    Stopped
    NoSpace, MissingInput
        The folder of the results can't be written.
    """
    folder, name = Path(order["folder"]), str(order["name"])
    with report_as_user_error(folder):
        folder.mkdir(parents=True, exist_ok=True)
    lock = FileLock(folder / _LOCK, timeout=0)
    while True:  # somebody of an earlier run may still be at it
        if is_stopped():
            raise Stopped
        with suppress(Timeout):
            lock.acquire()
            break
        time.sleep(_WAIT_S)
    try:
        ended = _Ended(0)
        for _ in range(TRIES):
            ended = _Process(order, folder).run(is_stopped)
            if ended.trouble is not None or ended.status in (0, 1):
                break
        return _state_after(ended, folder, name)
    finally:
        lock.release()


def _state_after(ended: _Ended, folder: Path, name: str) -> UnitState:
    if ended.trouble is not None:
        return with_trouble(folder, name, ended.trouble)
    if ended.status == 0:
        return read_state(folder, name)
    what = Text(
        "The process ended with {status}; what it said stands in the log.",
        "処理プロセスが異常終了しました（{status}）。詳細はログにあります。",
    ).filled(status=str(ended.status))
    words = ErrorWords(what, Text.same(str(folder / LOG_FILE)), _AGAIN)
    became: Became = "defect" if ended.status == 1 else "failed"
    return with_trouble(folder, name, TaskState("", _WORK, became, error=words))


class _Process:
    """The process of one drive, watched from here."""

    def __init__(self, order: Table, folder: Path) -> None:
        self._order = order
        self._folder = folder
        self._most_bytes = int(job_of_order(order).job.memory_gib * _GIB)
        self._lines: SimpleQueue[str] = SimpleQueue()

    def run(self, is_stopped: Callable[[], bool]) -> _Ended:
        """Work until it ends, or is ended."""
        with (self._folder / LOG_FILE).open("ab") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", "processing.operations.batch.worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=_environment(int(self._order["threads"])),
                text=True,
                encoding="utf-8",
                errors="surrogateescape",
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
            listener = threading.Thread(target=self._listen, args=(process,), daemon=True)
            listener.start()
            try:
                _hand_over(process, json.dumps(self._order))
                return self._watch(process, is_stopped)
            finally:
                process.kill()
                process.wait()
                listener.join()
                _close(process)

    def _watch(self, process: subprocess.Popen[str], is_stopped: Callable[[], bool]) -> _Ended:
        progress, told_s = UnitProgress(), 0.0
        while (status := process.poll()) is None:
            if is_stopped():
                raise Stopped
            said = self._last_said(progress)
            held = memory_of_tree(process.pid)[1]
            progress = UnitProgress(said.fraction, said.text, held, max(said.peak_bytes, held))
            if held > self._most_bytes:
                return _Ended(0, self._too_much(said.text))
            if time.monotonic() > told_s + _TELL_S:
                told_s = time.monotonic()
                write_progress(self._folder, progress)
        write_progress(self._folder, UnitProgress(1.0, progress.text, 0, progress.peak_bytes))
        return _Ended(status)

    def _last_said(self, before: UnitProgress) -> UnitProgress:
        """What the process said last; waits a moment for it."""
        last = ""
        with suppress(Empty):
            last = self._lines.get(timeout=_WAIT_S)
            while True:
                last = self._lines.get_nowait()
        if not last:
            return before
        said = json_of(last)
        text = Text(said["en"], said["ja"])
        return UnitProgress(float(said["fraction"]), text, before.held_bytes, before.peak_bytes)

    def _too_much(self, text: Text) -> TaskState:
        limit = f"{self._most_bytes / _GIB:g}"
        words = ErrorWords(
            Text(
                f"The work takes more memory than the job allows ({limit} GiB).",
                f"ジョブで許可したメモリー（{limit} GiB）を超えました。",
            ),
            text,
            Text(
                "Raise memory_gib, and have fewer workers if the machine hasn't that much.",
                "memory_gib を増やしてください。足りないときは workers を減らしてください。",
            ),
        )
        return TaskState("", _WORK, "failed", error=words)

    def _listen(self, process: subprocess.Popen[str]) -> None:
        for line in process.stdout or ():
            if line.startswith("{"):  # libraries may print what they like
                self._lines.put(line)


def _hand_over(process: subprocess.Popen[str], order: str) -> None:
    # One that died at once is noticed by its exit status.
    if process.stdin is not None:
        with suppress(OSError):
            process.stdin.write(order + "\n")
            process.stdin.flush()


def _close(process: subprocess.Popen[str]) -> None:
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with suppress(OSError):
                pipe.close()


def _environment(threads: int) -> Mapping[str, str]:
    root = str(Path(processing.__file__).parent.parent)
    path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
    own = {"PYTHONPATH": path, "PYTHONIOENCODING": "utf-8:surrogateescape"}
    return {**os.environ, **dict.fromkeys(_THREADS, str(max(1, threads))), **own}
