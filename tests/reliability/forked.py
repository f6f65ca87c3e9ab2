"""Operations in processes forked from this one, whose modules and kernels are loaded."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.reliability.operations import Answer

_MOST_SECONDS = 120


@contextmanager
def silence() -> Iterator[None]:
    """Keep what commands say of their progress from the terminal."""
    kept = os.dup(sys.stderr.fileno())
    with Path(os.devnull).open("w", encoding="utf-8") as nowhere:
        os.dup2(nowhere.fileno(), sys.stderr.fileno())
    try:
        yield
    finally:
        os.dup2(kept, sys.stderr.fileno())
        os.close(kept)


def answer_of_child(act: Callable[[], Answer]) -> Answer | None:
    """The answer of a child process; none where it did not end by itself."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        signal.alarm(_MOST_SECONDS)
        try:
            with silence():
                answer = act()
            os.write(writing, f"{answer.status}\n{answer.line}".encode())
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8", errors="replace") as said:
        text = said.read()
    os.waitpid(child, 0)
    if not text:
        return None
    status, line = text.split("\n", 1)
    return Answer(int(status), line)
