"""Tests in a process of their own, which can have the libraries already: what it takes is a fork.

A fork is what this command needs and Linux and macOS have; on Windows it doesn't run.
"""

from __future__ import annotations

import importlib
import os
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest

PASSED, KILLED, NONE_RUN = "passed", "killed", "not run"
# Not those that pytest itself wants to import first.
_LIBRARIES = (
    *("numpy", "scipy.spatial", "scipy.ndimage", "numba", "shapely", "pyproj", "laspy", "cv2"),
    *("ezdxf", "pyogrio", "PySide6.QtWidgets"),
)
SAID = "tests.log"
"""What the last tests said, in the root of the copy."""

_OPTIONS = ("-x", "-q", "-p", "no:cacheprovider")
_LOOK_S = 0.02


def load_libraries() -> None:
    """Import what tests need, once for all the processes that are forked later."""
    for name in _LIBRARIES:
        importlib.import_module(name)


def run_tests(
    root: Path, tests: Sequence[Path], longest_s: float, *, is_changed: bool = True
) -> tuple[str, float]:
    """Run tests of a copy of the program in a process of their own.

    Parameters
    ----------
    root : Path
        Of the copy.
    tests : sequence of Path
        Relative to it.
    longest_s : float
        When they count as failed.
    is_changed : bool
        Whether a file is changed: what is compiled of it is then not kept, as two changes of one
        second and one length can't be told apart by it.

    Returns
    -------
    (str, float)
        `PASSED`, `KILLED` or `NONE_RUN`, and how many seconds they took.
    """
    started = time.monotonic()
    child, code = os.fork(), int(pytest.ExitCode.INTERNAL_ERROR)
    if child == 0:
        sys.dont_write_bytecode = is_changed
        try:
            code = _run_here(root, tests)
        finally:  # whatever happens, the parent's work is not done twice
            os._exit(code)
    status: int | None = None
    while status is None and time.monotonic() - started < longest_s:
        time.sleep(_LOOK_S)
        done, waited = os.waitpid(child, os.WNOHANG)
        status = waited if done else None
    if status is None:
        os.killpg(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return KILLED, time.monotonic() - started
    return _outcome(status), time.monotonic() - started


def _outcome(status: int) -> str:
    code = os.waitstatus_to_exitcode(status)
    if code == pytest.ExitCode.NO_TESTS_COLLECTED:
        return NONE_RUN
    return PASSED if code == pytest.ExitCode.OK else KILLED


def _run_here(root: Path, tests: Sequence[Path]) -> int:
    """In the child: the copy's modules instead of these, and what is said in a file."""
    os.setsid()
    os.chdir(root)
    said = os.open(root / SAID, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(said, 1)
    os.dup2(said, 2)
    here = str(Path(__file__).parents[2])
    sys.path[:] = [str(root), *(one for one in sys.path if one not in ("", here))]
    for name in [one for one in sys.modules if one.partition(".")[0] == "tests"]:
        del sys.modules[name]
    return int(pytest.main([*_OPTIONS, *map(str, tests)]))
