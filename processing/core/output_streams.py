"""Standard output and error that write every character, whatever their encoding lacks.

A Japanese Windows gives a program that writes into a file or a pipe cp932, and a file's name may
be no text at all. Neither may end a command.
"""

from __future__ import annotations

import codecs
import io
import sys

_HANDLER = "zuka.written"

_SUBSTITUTES = {
    "¹": "1",
    "²": "2",
    "³": "3",
    "°": " deg",
    "±": "+/-",
    "×": "x",
    "÷": "/",
    "·": "*",
    "σ": "sigma",
    "µ": "u",
    "–": "-",
    "—": "-",
    "―": "-",
    "−": "-",
    "“": '"',
    "”": '"',
    "‘": "'",
    "’": "'",
    "…": "...",
    "→": "->",
    "≈": "~",
    "≠": "!=",
    "≤": "<=",
    "≥": ">=",
    "‖": "||",
    "∥": "||",
    "\N{NO-BREAK SPACE}": " ",
}
"""How the signs of our own sentences read where they are lacking."""


def write_every_character() -> None:
    r"""Let standard output and error replace what their encoding lacks, from now on.

    Signs of our own sentences become what one types for them, bytes of a file's name that are no
    text ``\xff``, other characters ``\u9ad9``.
    """
    codecs.register_error(_HANDLER, _substitute)
    for stream in (sys.stdout, sys.stderr):
        # A program without a terminal has no streams; a test's own keep their manners.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_HANDLER)


def _substitute(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(map(_write_character, lacking)), error.end


def _write_character(character: str) -> str:
    if character in _SUBSTITUTES:
        return _SUBSTITUTES[character]
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:  # how Python carries a byte that is no text
        return f"\\x{code - 0xDC00:02x}"
    return character.encode("ascii", "backslashreplace").decode("ascii")
