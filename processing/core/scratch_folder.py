"""A folder for what is only needed while something is written; a killed program's is removed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from filelock import FileLock, Timeout

from processing.core.errors import report_as_user_error
from processing.core.owned_files import (
    is_link,
    is_marked,
    make_marked,
    mark,
    remove_folder,
    remove_marked,
)

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
    with report_as_user_error(beside):
        beside.mkdir(parents=True, exist_ok=True)
        for left in beside.glob(f"{_PREFIX}*"):
            _remove_if_left(left)
        folder, lock = _lock_folder(beside)
    try:
        yield folder
    finally:
        lock.release()
        remove_folder(folder)


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """A new, marked folder for what is kept when it is whole; removed where the body fails.

    Raises
    ------
    NoSpace, MissingInput
        The folder can't be made.
    """
    with report_as_user_error(folder):
        make_marked(folder)
    try:
        yield folder
    except BaseException:
        remove_folder(folder)
        raise


def _lock_folder(beside: Path) -> tuple[Path, FileLock]:
    while True:
        folder = beside / f"{_PREFIX}{uuid4().hex}"
        folder.mkdir()
        lock = FileLock(folder / _LOCK, timeout=0)
        try:
            lock.acquire()
        except (Timeout, FileNotFoundError):
            # Another program took it for one that was left, before it was locked.
            continue
        mark(folder)
        return folder, lock


def _remove_if_left(folder: Path) -> None:
    # Any other folder of such a name, and a link to one, is somebody else's.
    if not is_marked(folder) or is_link(folder / _LOCK):
        return
    lock = FileLock(folder / _LOCK, timeout=0)
    try:
        lock.acquire()
    except (Timeout, OSError):
        return
    lock.release()
    remove_marked(folder)
