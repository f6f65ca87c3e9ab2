"""What the LAZ decoder prints when it panics must not reach the terminal.

A Rust panic writes a paragraph to the process's standard error before Python sees an exception,
and nothing in Python can stop it. So while the decoder runs, standard error goes to a temporary
file; all that others wrote there in this time is written out right after.
"""

from __future__ import annotations

import os
import re
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

_STDERR = 2
_PANIC = re.compile(
    rb"^\n?thread '[^\n]*panicked at [^\n]*\n[^\n]*\n"
    rb"(?:stack backtrace:\n|note: [^\n]*\n| +\d+: [^\n]*\n| +at [^\n]*\n)*",
    re.MULTILINE,
)


class _StderrAside:
    """Standard error set aside, once however many threads ask for it at the same time."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._users = 0
        self._real = -1
        self._file: BinaryIO | None = None

    def begin(self) -> None:
        with self._lock:
            self._users += 1
            if self._users > 1:
                return
            try:
                self._real = os.dup(_STDERR)
            except OSError:
                # A program without a console has no standard error, so nothing can show either.
                return
            self._file = tempfile.TemporaryFile()  # noqa: SIM115 - closed by end()
            os.dup2(self._file.fileno(), _STDERR)

    def end(self) -> None:
        with self._lock:
            self._users -= 1
            if self._users or self._file is None:
                return
            os.dup2(self._real, _STDERR)
            os.close(self._real)
            self._file.seek(0)
            others = _PANIC.sub(b"", self._file.read())
            self._file.close()
            self._file = None
            if others:
                os.write(_STDERR, others)


_ASIDE = _StderrAside()


@contextmanager
def panics_unprinted() -> Iterator[None]:
    """Keep what a panicking decoder prints from the terminal; other output comes a bit later."""
    _ASIDE.begin()
    try:
        yield
    finally:
        _ASIDE.end()


def is_panic(error: BaseException) -> bool:
    """Whether this is a Rust panic, which pyo3 does not make an ``Exception``."""
    return type(error).__name__ == "PanicException"
