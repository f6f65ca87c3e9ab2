"""A folder for what is only needed while something is written; a killed program's is removed."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from filelock import FileLock, Timeout

from processing.errors import told_as_user_error

_PREFIX = ".zuka-"
_LOCK = "lock"


@contextmanager
def scratch_folder(beside: Path) -> Iterator[Path]:
    """A new folder on the disk of an output, removed afterwards.

    Whoever makes the next one in the same place removes what killed programs left there.

    Parameters
    ----------
    beside : Path
        The output's folder; made if it is missing.

    Raises
    ------
    NoSpace, MissingInput
        The folder can't be written.
    """
    with told_as_user_error(beside):
        beside.mkdir(parents=True, exist_ok=True)
        for left in beside.glob(f"{_PREFIX}*"):
            _remove_if_left(left)
        folder, lock = _locked(beside)
    try:
        yield folder
    finally:
        lock.release()
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """A new folder for what is kept when it is whole; removed where the body fails.

    Raises
    ------
    NoSpace, MissingInput
        The folder can't be made.
    """
    with told_as_user_error(folder):
        folder.mkdir(parents=True)
    try:
        yield folder
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def _locked(beside: Path) -> tuple[Path, FileLock]:
    while True:
        folder = beside / f"{_PREFIX}{uuid4().hex}"
        folder.mkdir()
        lock = FileLock(folder / _LOCK, timeout=0)
        try:
            lock.acquire()
        except (Timeout, FileNotFoundError):
            # Another program took it for one that was left, before it was locked.
            continue
        return folder, lock


def _remove_if_left(folder: Path) -> None:
    lock = FileLock(folder / _LOCK, timeout=0)
    try:
        lock.acquire()
    except (Timeout, OSError):
        return
    lock.release()
    shutil.rmtree(folder, ignore_errors=True)
