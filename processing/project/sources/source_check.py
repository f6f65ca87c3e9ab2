"""Whether a delivered file is still the one that was imported: size, date, then its checksum."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from enum import Enum
from pathlib import Path

from processing.core.errors import BadFile, MissingInput, report_as_user_error
from processing.core.text import Text
from processing.recording.drive_info import SourceFile

_HASHED_BYTES = 1 << 22
CancelCheck = Callable[[], None]
"""Raises what stops the reading of a long file."""


class FileState(Enum):
    """What became of a noted file."""

    AS_DELIVERED = "as delivered"
    MISSING = "missing"
    CHANGED = "changed"


def state_of(source: SourceFile, path: Path, check: CancelCheck) -> FileState:
    """Look at a file; read it only where its date alone speaks against it.

    Parameters
    ----------
    source : SourceFile
        The file as it was.
    path : Path
        Where it should be now.
    check : callable
        Called now and then while the file is read.

    Raises
    ------
    UserError
        The operating system refuses to let it be read.
    """
    try:
        status = path.stat()
    except OSError:
        return FileState.MISSING
    # A recording of raw pulses is a folder.
    if not (path.is_file() or path.is_dir()):
        return FileState.MISSING
    if status.st_size != source.size:
        return FileState.CHANGED
    if status.st_mtime_ns == source.modified_ns or not source.sha256:
        return FileState.AS_DELIVERED
    is_same = _checksum(path, check) == source.sha256
    return FileState.AS_DELIVERED if is_same else FileState.CHANGED


def require_delivered(source: SourceFile, path: Path, check: CancelCheck) -> None:
    """Refuse to go on without the file that was imported.

    Raises
    ------
    MissingInput
        It is no longer there.
    BadFile
        It is another one now.
    """
    state = state_of(source, path, check)
    if state is FileState.MISSING:
        raise MissingInput(
            Text("The delivered file is no longer there.", "納品ファイルが元の場所にありません。"),
            Text.same(str(path)),
            Text(
                "Put it back, or tell where it is now by “Find delivered files” in the File menu;"
                " its points are needed for the output.",
                "出力に必要です。元の場所に戻すか、ファイルメニューの「納品ファイルの場所を指定」で"
                "現在の場所を指定してください。",
            ),
        )
    if state is FileState.CHANGED:
        raise BadFile(
            Text(
                "The delivered file has changed since it was imported.",
                "納品ファイルがインポート後に変更されています。",
            ),
            Text.same(str(path)),
            Text(
                "Put the delivered one back; its points are needed for the output.",
                "出力に必要なため、納品されたファイルに戻してください。",
            ),
        )


def _checksum(path: Path, check: CancelCheck) -> str:
    digest = hashlib.sha256()
    with report_as_user_error(path):
        files = sorted(one for one in path.rglob("*") if one.is_file()) if path.is_dir() else [path]
        for name in files:
            with name.open("rb") as file:
                while block := file.read(_HASHED_BYTES):
                    check()
                    digest.update(block)
    return digest.hexdigest()
