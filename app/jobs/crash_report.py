"""Crash reports: a run of the window that did not end properly is told of at the next start."""

from __future__ import annotations

import faulthandler
import platform
import sys
from contextlib import suppress
from datetime import datetime
from importlib.metadata import version
from pathlib import Path
from typing import IO
from uuid import uuid4

from filelock import FileLock, Timeout

from app.jobs.error_log import log_path

_KEPT_REPORTS = 10
_LOG_TAIL_BYTES = 64 * 1024
_TRACE, _LOCK = ".trace", ".lock"


def runs_folder() -> Path:
    """Where runs are noted while they last, and the reports of those that broke off."""
    return log_path().parent / "runs"


class NotedRun:
    """A run of the window, noted on the disk until it ends properly.

    The note holds a lock that the system takes back from a dead process, so that a run that
    still lasts is told from one that was killed, and the place where the interpreter writes
    what all threads were doing when the process crashed.
    """

    def __init__(self, folder: Path) -> None:
        self._path: Path | None = None
        self._lock: FileLock | None = None
        self._file: IO[str] | None = None
        path = folder / f"{uuid4().hex}{_TRACE}"
        with suppress(OSError, Timeout):  # a run goes on without its note where the disk is full
            folder.mkdir(parents=True, exist_ok=True)
            lock = FileLock(path.with_suffix(_LOCK))
            lock.acquire(timeout=0)
            self._path, self._lock = path, lock
            self._file = path.open("w", encoding="utf-8")
            self._file.write(_headline() + "\n")
            self._file.flush()
            faulthandler.enable(self._file)

    def end(self) -> None:
        """Take the note away: the run ended properly."""
        if self._file is not None:
            faulthandler.disable()
            self._file.close()
        if self._path is not None and self._lock is not None:
            _forget(self._path, self._lock)


def _headline() -> str:
    began = datetime.now().astimezone().isoformat(timespec="seconds")
    system = f"Python {platform.python_version()}, {platform.platform()}"
    return f"Zuka {version('zuka')}, {system}, {sys.executable}, begun {began}"


def _forget(path: Path, lock: FileLock) -> None:
    with suppress(OSError):
        path.unlink(missing_ok=True)
    lock.release()
    with suppress(OSError):
        path.with_suffix(_LOCK).unlink(missing_ok=True)


def report_broken_runs(folder: Path) -> tuple[Path, ...]:
    """Write a report of every run that is noted and no longer lasts.

    Returns
    -------
    tuple of Path
        The new reports, oldest first. The ten newest reports of all are kept; nothing is sent
        anywhere.
    """
    reports = []
    for path in sorted(folder.glob(f"*{_TRACE}"), key=_age):
        lock = FileLock(path.with_suffix(_LOCK))
        with suppress(OSError, Timeout):
            lock.acquire(timeout=0)
            try:
                report = folder / f"crash-{path.stem}.txt"
                report.write_text(_report_of(path), encoding="utf-8", errors="backslashreplace")
                reports.append(report)
            finally:
                _forget(path, lock)
    for old in sorted(folder.glob("crash-*.txt"), key=_age)[:-_KEPT_REPORTS]:
        with suppress(OSError):
            old.unlink()
    return tuple(report for report in reports if report.exists())


def _age(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def _report_of(path: Path) -> str:
    """What the interpreter wrote when the process crashed, and the end of the log."""
    head, _, trace = path.read_text(encoding="utf-8", errors="replace").partition("\n")
    return "\n".join(
        (
            head,
            "",
            "What its threads did when it crashed:",
            trace.strip() or "Nothing was written: it was killed, or the power was cut.",
            "",
            f"The end of the log ({log_path()}):",
            _end_of_log(),
        )
    )


def _end_of_log() -> str:
    try:
        with log_path().open("rb") as file:
            file.seek(max(0, log_path().stat().st_size - _LOG_TAIL_BYTES))
            return file.read().decode("utf-8", errors="replace")
    except OSError:
        return ""
