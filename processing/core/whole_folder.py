"""A folder that is either whole or not there: after an error, a cancel, a kill or a full disk."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from processing.core.errors import InUse, report_as_user_error
from processing.core.owned_files import (
    make_marked,
    refuse_link,
    remove_folder,
    remove_marked,
    unmark,
)
from processing.core.text import Text

_NAME_LETTERS = 24  # of at most 4 bytes each: names on a disk have 255 at most


@contextmanager
def write_whole_folder(folder: Path) -> Iterator[Path]:
    """A hidden folder beside ``folder``; it takes the real name when the body is through.

    A lock beside it is held meanwhile: a second program that shall make the same folder is
    refused at once, and what a killed one left of it is removed by whoever makes it next.

    Parameters
    ----------
    folder : Path
        Missing, or empty.

    Raises
    ------
    InUse
        There is something in it, another program is about to make it, or somebody else's file is
        where it would be made.
    NoSpace, MissingInput, BadFile
        What the operating system says, of the body's own writing too.
    """
    with report_as_user_error(folder):
        # What a link leads to is replaced; the link stays.
        folder = folder.resolve()
        _refuse_what_is_there(folder)
        folder.parent.mkdir(parents=True, exist_ok=True)
        hidden = _beside(folder)
        with _locked(folder, hidden.with_name(f"{hidden.name}.lock")):
            # It may have been made since.
            _refuse_what_is_there(folder)
            if not remove_marked(hidden) and os.path.lexists(hidden):
                raise _in_the_way(hidden)
            make_marked(hidden)
            try:
                yield hidden
                if folder.exists():
                    folder.rmdir()
                hidden.rename(folder)
            except BaseException:
                remove_folder(hidden)
                raise
            unmark(folder)


def _beside(folder: Path) -> Path:
    """The same for the same folder, and no longer than a name may be."""
    known = hashlib.sha256(folder.name.encode("utf-8", "surrogateescape")).hexdigest()[:8]
    return folder.with_name(f".{folder.name[:_NAME_LETTERS]}-{known}")


@contextmanager
def _locked(folder: Path, path: Path) -> Iterator[None]:
    refuse_link(path)
    lock = FileLock(path, timeout=0)
    try:
        lock.acquire()
    except Timeout as error:
        raise InUse(
            Text(
                "Another program is writing this folder.",
                "このフォルダには別のプログラムが書き込み中です。",
            ),
            Text.same(str(folder)),
            Text(
                "Name another folder, or wait until it is ready.",
                "別のフォルダを指定するか、完了するまでお待ちください。",
            ),
        ) from error
    try:
        yield
    finally:
        # Windows removes it when it is given free, and not before.
        with suppress(PermissionError):
            path.unlink(missing_ok=True)
        lock.release()


def _in_the_way(hidden: Path) -> InUse:
    return InUse(
        Text(
            "Something that Zuka did not make is where the folder would be written.",
            "書き込みに使う場所に、Zukaが作成したものではないファイルがあります。",
        ),
        Text.same(str(hidden)),
        Text(
            "Move it away, or name another folder.",
            "それを移動するか、別のフォルダを指定してください。",
        ),
    )


def _refuse_what_is_there(folder: Path) -> None:
    if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise InUse(
            Text("There is something in this folder.", "このフォルダにはファイルがあります。"),
            Text.same(str(folder)),
            Text(
                "Name a new folder, or empty this one.",
                "新しいフォルダを指定するか、このフォルダを空にしてください。",
            ),
        )
    if os.path.ismount(folder):
        raise InUse(
            Text("This folder is a disk of its own.", "このフォルダはディスクそのものです。"),
            Text.same(str(folder)),
            Text("Name a new folder in it.", "その中の新しいフォルダを指定してください。"),
        )
