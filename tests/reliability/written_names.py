"""Which files and folders the program writes and removes in a project, and links in their place.

Python tells of every file that is opened to be written, moved and removed (audit events). A name
that two runs of an operation have in common can be foreseen: whoever makes a project can put a
link there that leads out of it.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_PATHS = {
    "os.remove": 1,
    "os.rename": 2,
    "os.rmdir": 1,
    "os.mkdir": 1,
    "os.truncate": 1,
    "os.link": 2,
    "os.symlink": 2,
    "shutil.rmtree": 1,
    "sqlite3.connect": 1,
}
"""By an audit event: how many of its first arguments are paths that it changes."""


class _Listener:
    """What the one hook of this process does now; a hook can't be taken away."""

    hears: Callable[[object], None] | None = None
    is_hooked = False


# Any: what an event has for arguments.
def _on_event(event: str, arguments: tuple[Any, ...]) -> None:
    hears = _Listener.hears
    if hears is None:
        return
    if event == "open":
        path, _mode, flags = arguments
        if isinstance(flags, int) and flags & _WRITES:
            hears(path)
    elif event in _PATHS:
        for path in arguments[: _PATHS[event]]:
            hears(path)


@contextmanager
def names_changed_below(folder: Path) -> Iterator[set[str]]:
    """The names below a folder that are written, moved or removed while the body runs."""
    names: set[str] = set()
    start = f"{os.path.realpath(folder)}{os.sep}"

    def hear(path: object) -> None:
        if isinstance(path, (str, bytes, os.PathLike)):
            text = os.fsdecode(path)
            whole = text if os.path.isabs(text) else os.path.abspath(text)  # noqa: PTH100, PTH117
            if whole.startswith(start):
                names.add(whole[len(start) :])

    if not _Listener.is_hooked:
        sys.addaudithook(_on_event)
        _Listener.is_hooked = True
    _Listener.hears = hear
    try:
        yield names
    finally:
        _Listener.hears = None


def foreseen_names(whole: Path, work: Path, act: Callable[[Path], object]) -> set[str]:
    """The names that an operation changes in a project and that anybody can foresee.

    Parameters
    ----------
    whole : Path
        The project; it is copied.
    work : Path
        An empty folder for the copies.
    act : callable
        Does the operation on a project.
    """
    found = []
    for number in range(2):
        copied = Path(shutil.copytree(whole, work / f"{number}.zuka"))
        with names_changed_below(copied) as names:
            act(copied)
        found.append(names)
        shutil.rmtree(copied)
    return found[0] & found[1]


def put_link(position: Path, outside: Path) -> None:
    """A link in the place of what may be there, to a file or folder of the same kind outside."""
    if position.is_dir() and not position.is_symlink():
        shutil.rmtree(position)
        target, is_folder = outside / "folder", True
    else:
        position.unlink(missing_ok=True)
        target, is_folder = outside / "mine.txt", False
    position.parent.mkdir(parents=True, exist_ok=True)
    position.symlink_to(target, target_is_directory=is_folder)


def make_outside(folder: Path) -> None:
    """Somebody else's folder, which must stay as it is."""
    (folder / "folder" / "inside").mkdir(parents=True)
    for name in ("mine.txt", "folder/mine.txt", "folder/inside/deep.txt", "folder/parts.bin"):
        (folder / name).write_text(f"mine: {name}", encoding="utf-8")
