"""Writing so that a file is either whole or not there: after an error, a kill or a full disk."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock

from processing.core.errors import InUse, MissingInput, report_as_user_error
from processing.core.text import Text

_WRITING = ".zuka-writing-"
_LOCK = "lock"


@contextmanager
def write_safely(path: Path, *, never: Iterable[Path] = ()) -> Iterator[Path]:
    """A temporary name beside ``path``; it takes the real name when the body is through.

    Parameters
    ----------
    path : Path
        Where the result shall be; what is there already is replaced at the very end.
    never : iterable of Path
        Files that must not be overwritten: the inputs of the work.

    Yields
    ------
    Path
        To be written by the body. The folder is made if it is missing.

    Raises
    ------
    InUse
        ``path`` is one of ``never``.
    NoSpace, MissingInput, BadFile
        What the operating system says, of the body's own writing too.
    """
    refuse_inputs(path, never)
    with report_as_user_error(path):
        _make_folder(path.parent)
        _remove_broken_writing(path.parent)
        with _writing_folder(path.parent) as folder:
            temporary = folder / path.name
            try:
                yield temporary
                _flush(temporary)
                temporary.replace(path)
            except OSError as error:
                if error.filename == str(temporary):  # a name that nobody ever sees
                    error.filename = str(path)
                raise


@contextmanager
def _writing_folder(parent: Path) -> Iterator[Path]:
    """A hidden folder for what is not whole yet.

    It is locked while it is written to, so that that of a killed process is told from one in use.
    """
    folder = parent / f"{_WRITING}{uuid.uuid4().hex[:8]}"
    folder.mkdir()
    lock = FileLock(folder / _LOCK)
    with suppress(OSError, RuntimeError):  # some network disks have no locks
        lock.acquire(timeout=0)
    try:
        yield folder
    finally:
        _remove(folder, lock)


def _remove_broken_writing(parent: Path) -> None:
    """Remove what killed processes left of files that they were writing in a folder.

    Only folders of the name that the program gives them, with its lock in them and nobody
    holding it, are touched, and of what lies in them only files; links are not followed.
    """
    with suppress(OSError):
        names = [one.name for one in os.scandir(parent) if one.name.startswith(_WRITING)]
        for folder in (parent / name for name in names):
            mark = folder / _LOCK
            if folder.is_symlink() or mark.is_symlink() or not mark.is_file():
                continue
            lock = FileLock(mark)
            with suppress(OSError, RuntimeError):  # held: somebody is writing there
                lock.acquire(timeout=0)
                _remove(folder, lock)


def _remove(folder: Path, lock: FileLock) -> None:
    """Remove a folder of ours and the files in it; the lock comes last."""
    with suppress(OSError):
        for entry in list(os.scandir(folder)):
            if entry.name != _LOCK and not entry.is_dir(follow_symlinks=False):
                Path(entry).unlink(missing_ok=True)
    lock.release()
    with suppress(OSError):
        (folder / _LOCK).unlink(missing_ok=True)
        folder.rmdir()


def _make_folder(folder: Path) -> None:
    """Make a folder and those above it; full disks and lacking rights are left to the caller."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileNotFoundError, FileExistsError, NotADirectoryError) as error:
        raise MissingInput(
            Text("The folder can't be made.", "フォルダを作成できません。"),
            Text.same(str(folder)),
            Text(
                "Choose another folder: a file has its name or that of a folder above it, or the"
                " disk is not there; nothing was written.",
                "別のフォルダを指定してください。同じ名前のファイルがあるか、ディスクがありません。"
                "何も書き込まれていません。",
            ),
        ) from error


def refuse_inputs(path: Path, never: Iterable[Path]) -> None:
    """Refuse to write where an input of the work is.

    Raises
    ------
    InUse
        ``path`` is one of ``never``.
    """
    with report_as_user_error(path):
        for source in never:
            is_same_name = source.resolve() == path.resolve()
            if is_same_name or (path.exists() and source.exists() and path.samefile(source)):
                raise InUse(
                    Text(
                        "The result would overwrite a file it is made from.",
                        "結果の出力先が入力ファイルと同じです。",
                    ),
                    Text.same(str(path)),
                    Text(
                        "Choose another name or folder; nothing was written.",
                        "別の名前かフォルダを指定してください。何も書き込まれていません。",
                    ),
                )


def _flush(path: Path) -> None:
    # Renamed before its content is on the disk, a file could be empty after a power cut.
    with path.open("rb+") as file:
        os.fsync(file.fileno())
