"""TOML as people write it: read with its lines, so that whatever is wrong is told with its line."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text

_LARGEST_BYTES = 1 << 20
_LONGEST_WORDS = 60


def toml_content(path: Path) -> bytes:
    """What a file holds; of one that is too long for :func:`toml_of`, no more than tells that.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read.
    """
    with report_as_user_error(path), path.open("rb") as file:
        return file.read(_LARGEST_BYTES + 1)


def toml_of(content: bytes, path: Path, remedy: Text) -> tuple[list[str], dict[str, Any]]:
    """The lines of a file's content, and what they say.

    Parameters
    ----------
    path : Path
        For what is said of it.
    remedy : Text
        What is to be done where it can't be read.

    Raises
    ------
    BadFile
        It is no TOML in UTF-8, or longer than 1 MiB; the line is named.
    """
    text = content[:_LARGEST_BYTES].decode("utf-8-sig", errors="replace")
    lines = text.replace("\r\n", "\n").split("\n")
    if len(content) > _LARGEST_BYTES:
        what = Text("The file is too long.", "ファイルが大きすぎます。")
        raise line_error(what, path, 1, remedy)
    try:
        return lines, tomllib.loads(content.decode("utf-8-sig").replace("\r\n", "\n"))
    except (ValueError, RecursionError) as error:
        raise _not_toml(error, path, lines, remedy) from error


def line_error(what: Text, path: Path, line: int, remedy: Text) -> BadFile:
    """The error that names a line of a file."""
    where = Text(f"{path}, line {line:,}", f"{path}、{line:,}行目")
    return BadFile(what, where, remedy)


def short(value: object) -> str:
    """A value in one line that is not too long for a message."""
    words = " ".join(str(value).split())
    return words if len(words) <= _LONGEST_WORDS else words[: _LONGEST_WORDS - 1] + "…"


def _not_toml(
    error: ValueError | RecursionError, path: Path, lines: Sequence[str], remedy: Text
) -> BadFile:
    position = re.search(r"\(at line (\d+), column \d+\)", str(error))
    at_end = len(lines) if "end of document" in str(error) else 1
    reason = short(re.sub(r"\s*\(at .*\)$", "", str(error)))
    what = Text("The file is not TOML: {reason}.", "TOMLとして読めません（{reason}）。")
    if isinstance(error, UnicodeDecodeError):
        at_end = error.object.count(b"\n", 0, error.start) + 1
        what = Text("The file is not text in UTF-8.", "UTF-8のテキストではありません。")
    line = int(position[1]) if position else at_end
    return line_error(what.filled(reason=reason), path, line, remedy)
