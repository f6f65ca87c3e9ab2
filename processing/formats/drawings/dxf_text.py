r"""Text as DXF holds it: one line, with escapes for what a code page or the format lacks.

CAD programs read ``\U+XXXX`` (UTF-16 units) in every version, and ``^J`` for control characters.
"""

from __future__ import annotations

_TWINS = {"²": "2", "³": "3"}
"""How signs are written where they are missing: m2."""

_LONGEST_BYTES = 250  # of one string of extended data; the format allows 255


def dxf_text(text: str, encoding: str) -> str:
    """Text that any DXF file of this encoding can hold, and that reads as the same text.

    Parameters
    ----------
    encoding : str
        ``utf-8`` or ``cp932``.

    References
    ----------
    Autodesk, DXF reference, "ASCII control characters in DXF files" and Unicode escapes.
    """
    return "".join(_escape_character(text, position, encoding) for position in range(len(text)))


def dxf_strings(text: str, encoding: str) -> list[str]:
    """The same in pieces short enough for extended data; joined they are :func:`dxf_text`."""
    pieces = [""]
    size = 0
    for position in range(len(text)):
        escaped = _escape_character(text, position, encoding)
        bytes_ = len(escaped.encode(encoding))
        if size + bytes_ > _LONGEST_BYTES:
            pieces.append("")
            size = 0
        pieces[-1] += escaped
        size += bytes_
    return pieces


def label_text(text: str, encoding: str) -> str:
    """The text of a TEXT entity: control characters are blanks, and ``%%`` is no code."""
    words = "".join(one if one.isprintable() else " " for one in text).strip()
    while "%%" in words:  # begins a special character: %%d is a degree sign
        words = words.replace("%%", "％％")
    # What is drawn is better a twin of the sign than an escape that not every program reads.
    words = "".join(_read_back(one, encoding) or _TWINS.get(one, one) for one in words)
    return dxf_text(words, encoding)


def _escape_character(text: str, position: int, encoding: str) -> str:
    character = text[position]
    code = ord(character)
    if character == "\\":
        # What looks like an escape must not become one.
        is_escape = text[position + 1 : position + 3] in ("U+", "u+", "M+", "m+")
        return "\\U+005C" if is_escape else character
    if character == "^":
        return "^ "
    if code < 0x20:
        return "^" + chr(code + 0x40)
    if 0x7F <= code <= 0x9F or 0x2028 <= code <= 0x2029 or 0xD800 <= code <= 0xDFFF:
        return f"\\U+{code:04X}"  # ends a line for some readers, or is no character
    if _read_back(character, encoding) == character:
        return character
    units = character.encode("utf-16-be")
    return "".join(f"\\U+{units[i : i + 2].hex().upper()}" for i in range(0, len(units), 2))


def _read_back(character: str, encoding: str) -> str:
    """What readers make of a character: ¢ 〜 − are ￠ ～ － in cp932; of nothing nothing."""
    try:
        return character.encode(encoding).decode(encoding)
    except UnicodeEncodeError:
        return ""
