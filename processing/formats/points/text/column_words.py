"""What a line says of the columns of points below it: for certain, perhaps, or nothing.

A header is a comment sign or none, perhaps words with a colon, then a name for each column, divided
by commas, tabs, semicolons or blanks, perhaps in quotes and with a unit in brackets.
"""

from __future__ import annotations

import csv
import re
import unicodedata
from dataclasses import dataclass
from enum import Enum

from processing.formats.points.delivered.field_names import FIELD_NAMES, plain_name

POSITION = ("x", "y", "z")
PASSED_OVER = "-"
"""A column whose values are not taken."""

_SPOKEN: dict[str, tuple[str, ...]] = {
    "x": ("e", "xcoord", "xcoordinate", "x座標", "x座標値", "東", "東距", "東座標", "経距"),
    "y": ("n", "ycoord", "ycoordinate", "y座標", "y座標値", "北", "北距", "北座標", "緯距"),
    "z": (
        *("h", "alt", "altitude", "altitudem", "elevationm", "elev", "zcoord", "zcoordinate"),
        *("z座標", "z座標値", "標高", "標高値", "高さ", "高度", "楕円体高", "地盤高"),
    ),
    "red": ("赤",),
    "green": ("緑",),
    "blue": ("青",),
    "gpstime": ("gpssec", "gpsseconds", "時刻", "gps時刻"),
    "intensity": ("intens", "refl", "反射強度", "反射率", "強度", "輝度"),
    "classification": ("classid", "classcode", "label", "labels", "クラス", "分類", "ラベル"),
}
_MEANINGS = {
    in_language: field
    for field, names in FIELD_NAMES.items()
    for in_language in (*names, *_SPOKEN.get(field, ()))
}
_RANKS = {
    in_language: rank
    for field, names in FIELD_NAMES.items()
    for rank, in_language in enumerate((*names, *_SPOKEN.get(field, ())))
}
_KNOWN_BUT_UNUSED = frozenset(
    (
        *("id", "no", "no.", "nr", "num", "number", "point", "pointid", "pointno", "pointname"),
        *("name", "index", "station", "code", "nx", "ny", "nz", "normalx", "normaly", "normalz"),
        *("点", "点番", "点番号", "点名", "測点", "測点名", "番号", "備考", PASSED_OVER),
    )
)
_DEGREES = frozenset(("lon", "lat", "longitude", "latitude", "経度", "緯度"))
_METRES = frozenset(("m", "meter", "metre", "meters", "metres", "メートル"))
_COMMENT = re.compile(r"^\s*(?:#+|//+|;+|%+)\s*")
_BRACKETS = re.compile(r"^(?P<name>[^\[\](){}]*?)[\[({](?P<inside>[^\[\](){}]*)[\])}]$")
_BEFORE_BRACKET = re.compile(r"\s+(?=[\[({])")
_DIVIDERS = (",", "\t", ";")
_QUOTES = " \t\r\n\"'/#"


class Certainty(Enum):
    """How well a line is understood as a header."""

    CERTAIN = "certain"
    UNCLEAR = "unclear"
    NO_HEADER = "no header"


@dataclass(frozen=True)
class HeaderReading:
    """What a line says of the columns.

    Attributes
    ----------
    columns : tuple of str
        The field of each column, as
        :data:`processing.formats.points.delivered.field_names.FIELD_NAMES` calls it; ``-`` for one
        that is passed over. Empty where it is not certain.
    """

    certainty: Certainty
    columns: tuple[str, ...] = ()


def field_of(name: str) -> str:
    """The field that a column's name means; empty for none, ``-`` for one that is passed over.

    Brackets behind a coordinate hold metres or the direction: ``X座標(北)`` is the northing.
    """
    plain, inside = _plain(name)
    field = _MEANINGS.get(plain, "")
    if inside and field in POSITION and inside not in _METRES:
        within = _MEANINGS.get(inside, "")
        return within if within in POSITION else ""
    return field or (PASSED_OVER if plain in _KNOWN_BUT_UNUSED else "")


def read_header(line: str, width: int) -> HeaderReading:
    """Understand a line of text above points.

    Parameters
    ----------
    width : int
        Columns that the points have.

    Returns
    -------
    HeaderReading
        Certain: as many names as columns, each coordinate named once. Unclear: it may be a header,
        but which column is which can't be known. A line without a comment sign is never no header.
    """
    line = unicodedata.normalize("NFKC", line)
    body = _COMMENT.sub("", line)
    is_comment = body != line.lstrip()
    found = HeaderReading(Certainty.NO_HEADER if is_comment else Certainty.UNCLEAR)
    for words in dict.fromkeys((body, body.rpartition(":")[2])):
        names, is_by_blanks = _names_in(words)
        if len(names) == width:
            columns = _certain(names, is_strict=is_by_blanks)
            if columns:
                return HeaderReading(Certainty.CERTAIN, columns)
        if _may_be_header(names, width):
            found = HeaderReading(Certainty.UNCLEAR)
    return found


def taken_columns(names: tuple[str, ...]) -> tuple[str, ...]:
    """The field of each named column, ``-`` for what isn't one; empty where it is ambiguous.

    Each coordinate must be named once. Of several names of another field the most usual is taken.
    """
    fields = [field_of(name) for name in names]
    if any(fields.count(axis) != 1 for axis in POSITION):
        return ()
    columns = [PASSED_OVER] * len(names)
    for field in dict.fromkeys(fields):
        if field in ("", PASSED_OVER):
            continue
        ranks = {at: _rank(names[at]) for at, one in enumerate(fields) if one == field}
        best = [at for at, rank in ranks.items() if rank == min(ranks.values())]
        if len(best) > 1:
            return ()
        columns[best[0]] = field
    return tuple(columns)


def _certain(names: list[str], *, is_strict: bool) -> tuple[str, ...]:
    """The fields; nothing where prose, degrees or a name before a coordinate could mislead."""
    fields = [field_of(name) for name in names]
    if any(_plain(name)[0] in _DEGREES for name in names):
        return ()
    columns = taken_columns(tuple(names))
    if columns and is_strict:
        last = max(columns.index(axis) for axis in POSITION)
        if "" in fields[:last]:
            return ()
    return columns


def _may_be_header(names: list[str], width: int) -> bool:
    fields = [field_of(name) for name in names]
    degrees = sum(_plain(name)[0] in _DEGREES for name in names)
    axes = len(set(fields) & set(POSITION)) + degrees
    if axes >= len(POSITION) or (names and all(fields)):
        return axes > 0
    return len(names) == width and axes > 0


def _names_in(words: str) -> tuple[list[str], bool]:
    """The names on a line, and whether nothing but blanks divides them."""
    divider = next((mark for mark in _DIVIDERS if mark in words), " ")
    if divider == " ":
        words = _BEFORE_BRACKET.sub("", " ".join(words.split()))
    try:
        cells = next(csv.reader([words], delimiter=divider, skipinitialspace=True), [])
    except csv.Error:
        cells = words.split(divider)
    names = [cell.strip(_QUOTES) for cell in cells]
    while names and not names[-1]:
        names.pop()
    return names, divider == " "


def _rank(name: str) -> int:
    return _RANKS.get(_plain(name)[0], 0)


def _plain(name: str) -> tuple[str, str]:
    """A name in one form, and what its brackets hold."""
    name = unicodedata.normalize("NFKC", name).strip(_QUOTES)
    parts = _BRACKETS.match(name)
    inside = "" if parts is None else plain_name(parts["inside"].strip())
    plain = plain_name(name if parts is None else parts["name"]).replace("-", "")
    return (plain or name.strip()), inside
