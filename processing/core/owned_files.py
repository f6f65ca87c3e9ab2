"""What the program made itself: how it is known again, and the only ways to remove or write it.

A folder of a project, or one beside an output, may hold links to what belongs to somebody else,
and a folder of any name may be somebody else's. So nothing is removed or written through a link,
and what is found lying about is removed only where the program's own mark is in it.
"""

from __future__ import annotations

import os
import shutil
import stat
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from processing.core.errors import InUse
from processing.core.text import Text

MARK = ".zuka-made"
"""A file in each folder that the program makes for a while."""

_CONTENT = b"Zuka made this folder for a while; it may be removed when Zuka is not running.\n"


def is_link(path: Path) -> bool:
    """Whether a path is a symbolic link or a junction; False where nothing is."""
    try:
        status = path.lstat()
    except OSError:
        return False
    return _is_link(status)


def links_below(folder: Path) -> Iterator[Path]:
    """The links in a folder and its folders, or the folder itself if it is one.

    None is followed. What can't be listed has none.
    """
    if is_link(folder):
        yield folder
        return
    try:
        with os.scandir(folder) as listed:
            entries = sorted(listed, key=lambda entry: entry.name)
    except OSError:
        return
    for entry in entries:
        with suppress(FileNotFoundError):
            if _is_link(entry.stat(follow_symlinks=False)):
                yield Path(entry.path)
            elif entry.is_dir(follow_symlinks=False):
                yield from links_below(Path(entry.path))


def make_marked(folder: Path) -> None:
    """Make a new folder, and those above it, that is known as the program's own.

    Raises
    ------
    OSError
        It is there already, or can't be made.
    """
    folder.mkdir(parents=True)
    mark(folder)


def mark(folder: Path) -> None:
    """Let a folder be known as the program's own.

    Raises
    ------
    OSError
    """
    with new_file(folder / MARK) as file:
        file.write(_CONTENT)


def unmark(folder: Path) -> None:
    """Let a folder be like any other from now on: it is whole, and somebody's."""
    (folder / MARK).unlink(missing_ok=True)


def is_marked(folder: Path) -> bool:
    """Whether a path is a folder, not a link to one, that the program made for a while."""
    own = folder / MARK
    if is_link(folder) or is_link(own):
        return False
    try:
        return own.stat().st_size == len(_CONTENT) and own.read_bytes() == _CONTENT
    except OSError:
        return False


def remove_folder(folder: Path, within: Path | None = None) -> bool:
    """Remove a folder that the caller made or has on record; links in it go, not what they lead to.

    Parameters
    ----------
    within : Path, optional
        A folder above it from which on no link may lead to it.

    Returns
    -------
    bool
        Whether it could be tried: False where it is a link or lies behind one.
    """
    if _is_behind_link(folder, within):
        return False
    # The mark goes last, so that what a kill leaves is still known as the program's own.
    with suppress(OSError), os.scandir(folder) as listed:
        for entry in [one for one in listed if one.name != MARK]:
            if entry.is_dir(follow_symlinks=False):
                shutil.rmtree(entry.path, ignore_errors=True)
            else:
                with suppress(OSError):
                    Path(entry.path).unlink()
    shutil.rmtree(folder, ignore_errors=True)
    return True


def remove_marked(folder: Path, within: Path | None = None) -> bool:
    """As :func:`remove_folder`, of a folder that was found: only where it has the mark."""
    return is_marked(folder) and remove_folder(folder, within)


def remove_emptied(folder: Path) -> None:
    """Remove a folder that the caller took the last thing from; it stays where there is more."""
    with suppress(OSError):
        if is_marked(folder) and [one.name for one in folder.iterdir()] == [MARK]:
            unmark(folder)
        folder.rmdir()


def holds_only(folder: Path, is_known: Callable[[str], bool]) -> bool:
    """Whether a path is a folder, no link, of plain files whose names are all known."""
    try:
        return not is_link(folder) and all(
            (is_known(one.name) or one.name == MARK) and one.is_file() and not is_link(one)
            for one in folder.iterdir()
        )
    except OSError:
        return False


def new_file(path: Path) -> BinaryIO:
    """Open a new file for writing; what has its name goes, and is not written through.

    Raises
    ------
    OSError
    """
    path.unlink(missing_ok=True)
    return path.open("xb")


def refuse_link(path: Path) -> None:
    """Refuse a link where the program keeps what is its own.

    Raises
    ------
    InUse
        Names the link.
    """
    if is_link(path):
        raise InUse(
            Text(
                "There is a link where Zuka keeps files of its own; nothing was touched.",
                "Zukaが自分のファイルを置く場所にリンクがあります。何も変更していません。",
            ),
            Text.same(str(path)),
            Text(
                "Remove the link, or put what it leads to in its place, then try again.",
                "リンクを削除するか、リンク先の実体をその場所に置いてから、"
                "もう一度実行してください。",
            ),
        )


def _is_behind_link(path: Path, within: Path | None) -> bool:
    """Whether a path, or a folder above it below another, is a link."""
    if within is None:
        return is_link(path)
    parts = path.relative_to(within).parts
    return ".." in parts or any(
        is_link(within.joinpath(*parts[:depth])) for depth in range(1, len(parts) + 1)
    )


def _is_link(status: os.stat_result) -> bool:
    # Windows tells of junctions, which are no symbolic links, by their tag.
    junction = getattr(stat, "IO_REPARSE_TAG_MOUNT_POINT", None)
    return stat.S_ISLNK(status.st_mode) or (
        junction is not None and getattr(status, "st_reparse_tag", 0) == junction
    )
