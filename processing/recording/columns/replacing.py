"""Replacing columns of a drive folder so that a kill leaves the old ones or the new ones.

New columns are made in a folder of their own. When they are whole it gets another name; from then
on they count, and moving them to their places can be done again as often as needed.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from processing.core.block_sums import place_with_sums
from processing.core.errors import report_as_user_error
from processing.core.owned_files import refuse_link, remove_folder

_UNFINISHED, _WHOLE = "unfinished", "whole"


def _nothing() -> None:
    """What to do where nothing is to be done."""


def new_columns(folder: Path) -> Path:
    """An empty folder for new columns of a drive folder; what an earlier try left there goes.

    Raises
    ------
    NoSpace
    """
    unfinished = folder / _UNFINISHED
    with report_as_user_error(unfinished):
        refuse_link(unfinished)
        remove_folder(unfinished)
        unfinished.mkdir()
    return unfinished


def replace_columns(
    folder: Path, note: Callable[[], object] = _nothing, *, is_flushed: bool = True
) -> None:
    """Let the new columns take the places of the old ones.

    Parameters
    ----------
    note : callable
        Called when all are in place and before that is forgotten here.
    is_flushed : bool
        Whether they shall be on the disk before; needless where nothing else is.

    Raises
    ------
    NoSpace
    """
    with report_as_user_error(folder):
        if is_flushed:
            flush_folder(folder / _UNFINISHED)
        (folder / _UNFINISHED).rename(folder / _WHOLE)
    finish_replacing(folder, note)


def finish_replacing(folder: Path, note: Callable[[], object] = _nothing) -> bool:
    """Put new columns that are whole into their places; says whether there were any.

    To be called before anything else when a killed work goes on; else as
    :func:`replace_columns`.
    """
    whole = folder / _WHOLE
    if not whole.is_dir():
        return False
    refuse_link(whole)
    with report_as_user_error(folder):
        for path in sorted(whole.iterdir()):
            place_with_sums(path, folder / path.name)
    note()
    with report_as_user_error(folder):
        whole.rmdir()
    return True


def flush_folder(folder: Path) -> None:
    """Have the files of a folder on the disk, and their names.

    Raises
    ------
    OSError
    """
    if not folder.is_dir():
        return
    for path in folder.iterdir():
        # What is gone by now has another place or none.
        with suppress(FileNotFoundError):
            if path.is_file():
                # Windows flushes only what may be written.
                with path.open("rb+") as file:
                    os.fsync(file.fileno())
    flush_names(folder)


def flush_names(folder: Path) -> None:
    """Have the names in a folder on the disk.

    Raises
    ------
    OSError
    """
    # Windows can't open folders; its file systems keep names in order by themselves.
    if os.name == "nt":
        return
    number = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)
