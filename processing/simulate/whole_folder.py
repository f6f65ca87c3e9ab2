"""A folder that is either whole or not there: after an error, a cancel, a kill or a full disk."""

from __future__ import annotations

import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from processing.errors import InUse, told_as_user_error
from processing.text import Text


@contextmanager
def made_whole(folder: Path) -> Iterator[Path]:
    """A hidden folder beside ``folder``; it takes the real name when the body is through.

    Parameters
    ----------
    folder : Path
        Missing, or empty.

    Raises
    ------
    InUse
        There is something in it.
    NoSpace, MissingInput, BadFile
        What the operating system says, of the body's own writing too.
    """
    with told_as_user_error(folder):
        if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
            raise InUse(
                Text("There is something in this folder.", "このフォルダにはファイルがあります。"),
                Text.same(str(folder)),
                Text(
                    "Name a new folder, or empty this one.",
                    "新しいフォルダを指定するか、このフォルダを空にしてください。",
                ),
            )
        folder.parent.mkdir(parents=True, exist_ok=True)
        hidden = folder.with_name(f".{folder.name}-{uuid.uuid4().hex[:8]}")
        hidden.mkdir()
        try:
            yield hidden
            if folder.exists():
                folder.rmdir()
            hidden.rename(folder)
        except BaseException:
            shutil.rmtree(hidden, ignore_errors=True)
            raise
