"""Text as Japanese offices deliver it: UTF-8 with or without mark, cp932, UTF-16 from Excel."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text

_UTF8_MARK = b"\xef\xbb\xbf"
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")


def decode_text(data: bytes, path: Path) -> str:
    """Bytes as text, by what they can be: UTF-8, UTF-16 with a mark, cp932.

    Parameters
    ----------
    path : Path
        Where they come from, for the message.

    Raises
    ------
    BadFile
        They are none of these; names the first byte that fits none.
    """
    if data.startswith(_UTF16_MARKS):
        encodings = ["utf-16"]
    elif b"\0" in data:
        raise _not_text(path, data.index(b"\0"))
    else:
        encodings = ["utf-8-sig"] if data.startswith(_UTF8_MARK) else ["utf-8", "cp932"]
    position = 0
    for encoding in encodings:
        try:
            return data.decode(encoding)
        except UnicodeDecodeError as error:
            position = max(position, error.start)
    raise _not_text(path, position)


def read_text(path: Path) -> str:
    """A whole text file.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or is not text.
    """
    with report_as_user_error(path):
        data = path.read_bytes()
    return decode_text(data, path)


def read_lines(path: Path) -> list[str]:
    """The lines of a text file without their ends, whichever kind of ends it has.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or is not text.
    """
    # str.splitlines would also split at form feeds and other rare marks inside a cell.
    return read_text(path).replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _not_text(path: Path, position: int) -> BadFile:
    return BadFile(
        Text(
            "The file is not text in UTF-8 or Shift_JIS (cp932).",
            "UTF-8またはShift_JIS（cp932）のテキストファイルではありません。",
        ),
        Text(f"{path}, byte {position:,}", f"{path}、{position:,}バイト目"),
        Text(
            "Choose the right file, or save it again as UTF-8 text.",
            "正しいファイルを選ぶか、UTF-8のテキストとして保存し直してください。",
        ),
    )
