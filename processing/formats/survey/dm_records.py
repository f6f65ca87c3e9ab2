"""Records of the extended DM: 84 bytes of Shift_JIS, numbers right-justified, texts left-justified.

Fields after the appendix on digital map files of the Japanese rules of public surveys (作業規程の
準則 付録7, 拡張DM), with the widths that files of cities have.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.survey.map_sheets import SHEET_X_MM, SHEET_Y_MM, MapSheet
from processing.formats.survey.sheet_cuts import PlaceMm

RECORD_BYTES = 84
LEVEL = 500
MOST_PLACES = 9999
"""Of one element: the field of their number has four digits."""

_MOST_UNDER_HEADER = 9999
"""Elements are numbered from 1 under each header, in four digits."""

_TYPES = ("E1", "E2", "E3", "E4", "E5", "E6", "E7", "E8")
_UNIT_MM = 1
_KANJI_TEXT, _NARROW_TEXT = 1, 2
_TEXT_BYTES = 64  # of a record of a note
_PEN = 3  # 0.15 mm, the usual pen of level 500
NO_DATE = "0000"


@dataclass(frozen=True)
class DmNote:
    """What an E7 says, and how it lies.

    Attributes
    ----------
    words : str
        All of two bytes, or all of one.
    angle_deg : int
        Counter-clockwise from east.
    height_mm : float
        Of the letters, on paper.
    """

    words: str
    angle_deg: int
    height_mm: float


@dataclass(frozen=True)
class DmElement:
    """An element on its sheet.

    Attributes
    ----------
    type : str
        ``E1`` area, ``E2`` line, ``E3`` circle, ``E4`` arc, ``E5`` point, ``E6`` direction, ``E7``
        note.
    code : str
        Class code, four digits.
    places : tuple of PlaceMm
        Of the map; a closed outline repeats its first place; one place for E5 and E7.
    has_heights : bool
        Whether ``places`` are written with their heights.
    figure : int
        Figure type (図形区分).
    on_structure : bool
        Heights are those of a structure, not of the ground.
    value : int
        Height in millimetres of contours and spot heights, number of a control point; else 0.
    surveyed : str
        Year and month, ``YYMM``.
    """

    type: str
    code: str
    places: tuple[PlaceMm, ...]
    has_heights: bool = False
    figure: int = 0
    on_structure: bool = False
    value: int = 0
    surveyed: str = NO_DATE
    note: DmNote | None = None


@dataclass(frozen=True)
class DmFacts:
    """What the records of every sheet say of the job.

    Attributes
    ----------
    title, device, approval, company : str
        In cp932; at most 30, 30, 30 and 40 bytes.
    made : str
        Year and month, ``YYMM``.
    accuracy : int
        Accuracy class: tens the method, units the level.
    """

    title: str
    device: str
    approval: str
    company: str
    made: str
    accuracy: int


def sheet_records(
    sheet: MapSheet, elements: Sequence[DmElement], facts: DmFacts, job: Collection[MapSheet]
) -> list[bytes]:
    """All records of a sheet's file.

    Parameters
    ----------
    job : collection of MapSheet
        The sheets that are handed in: those around this one are named.

    Raises
    ------
    OutOfRange
        A number has more digits than its field.
    """
    body = list(_layers(sheet, elements, facts))
    return [*_sheet_header(sheet, len(elements), len(body), facts, job), *body]


def _sheet_header(
    sheet: MapSheet, elements: int, records: int, facts: DmFacts, job: Collection[MapSheet]
) -> Iterator[bytes]:
    south, west = (one // 1000 for one in sheet.south_west_mm)
    north, east = south + SHEET_X_MM // 1000, west + SHEET_Y_MM // 1000
    name = sheet.identifier
    yield _record(
        _text("M", 2), _text(name, 8), _text(name, 20), _number(LEVEL, 5), _text(facts.title, 30),
        _number(0, 2), _text("10", 2),
    )  # fmt: skip
    yield _record(
        *(_number(one, 7) for one in (south, west, north, east)), _number(elements, 9),
        _number(records, 7), _number(_UNIT_MM, 3),
        *(_number(one, 7) for one in (north, west, south, east)),
    )  # fmt: skip
    yield _record(*(_text(one.identifier * (one in job), 8) for one in sheet.neighbours))
    yield _record(
        _text(facts.made * 2, 8), _text("00", 2), _text(facts.device, 30),
        _text(facts.approval, 30), _text("1000", 4), *(_number(0, 2) for _ in range(5)),
    )  # fmt: skip
    yield _record(_text(facts.company, 40), *(_number(0, 4) for _ in range(8)))


def _layers(sheet: MapSheet, elements: Sequence[DmElement], facts: DmFacts) -> Iterator[bytes]:
    """Headers, each followed by its elements, in the order of the codes' first two digits."""
    for layer, members in groupby(sorted(elements, key=_layer_of), key=_layer_of):
        found = list(members)
        for start in range(0, len(found), _MOST_UNDER_HEADER):
            under = found[start : start + _MOST_UNDER_HEADER]
            yield _header(layer, under, facts)
            for number, element in enumerate(under, 1):
                yield from _element(sheet, element, number, facts)


def _layer_of(element: DmElement) -> str:
    return element.code[:2]


def _header(layer: str, under: Sequence[DmElement], facts: DmFacts) -> bytes:
    counts = Counter(element.type for element in under)
    return _record(
        _text("H", 2), _text(f"{layer}00", 4), _number(0, 2), _number(0, 4), _number(0, 4),
        _number(1, 2), _number(len(under), 5), _number(0, 5),
        *(_number(counts[one], 5) for one in _TYPES),
        _number(0, 1), _text(facts.made + NO_DATE * 2, 12),
    )  # fmt: skip


def _element(sheet: MapSheet, element: DmElement, number: int, facts: DmFacts) -> Iterator[bytes]:
    offsets = [_offset(sheet, place) for place in element.places]
    note = element.note
    data: list[bytes] = []
    kind, count, annotation = 0, 0, 0
    if note is not None:
        encoded = note.words.encode("cp932")
        annotation = _NARROW_TEXT if len(encoded) == len(note.words) else _KANJI_TEXT
        kind, count, data = 4, len(note.words), list(_note_records(note, encoded))
    elif element.type != "E5":
        kind = (6 if element.on_structure else 3) if element.has_heights else 2
        count, data = len(offsets), list(_place_records(offsets, 3 if element.has_heights else 2))
    x, y = offsets[0][:2] if element.type in ("E5", "E7") else (0, 0)
    if count > MOST_PLACES:
        raise _too_long(element)
    yield _record(
        _text(element.type, 2), _text(element.code, 4), _number(0, 2), _number(0, 4),
        _number(number, 4), _number(2, 2), _number(element.figure, 2), _number(kind, 1),
        _number(facts.accuracy, 2), _number(annotation, 1), _number(0, 2), _number(0, 1),
        _number(count, 4), _number(len(data), 4), _number(x, 7), _number(y, 7),
        _number(element.value, 7), _number(0, 2), _text("", 7),
        _text(element.surveyed + NO_DATE * 2, 12), _text("", 6), _text("1", 1),
    )  # fmt: skip
    yield from data


def _offset(sheet: MapSheet, place: PlaceMm) -> PlaceMm:
    south, west = sheet.south_west_mm
    x, y = place[0] - south, place[1] - west
    # Readers take 0, 0 for a place that isn't there.
    return (x, y, place[2]) if (x, y) != (0, 0) else (0, 1, place[2])


def _place_records(offsets: Sequence[PlaceMm], axes: int) -> Iterator[bytes]:
    """Six places of two axes a record, or four of three; unused ones are 0."""
    each = {2: 6, 3: 4}[axes]
    for start in range(0, len(offsets), each):
        values = [value for place in offsets[start : start + each] for value in place[:axes]]
        values += [0] * (each * axes - len(values))
        yield _record(*(_number(value, 7) for value in values))


def _note_records(note: DmNote, encoded: bytes) -> Iterator[bytes]:
    """The words, 64 bytes a record: never half a kanji, since all have two bytes or all one."""
    looks = [_number(0, 1), _number(note.angle_deg, 7), _number(round(note.height_mm * 10), 5),
             _number(0, 5), _number(_PEN, 2)]  # fmt: skip
    for start in range(0, len(encoded), _TEXT_BYTES):
        words = encoded[start : start + _TEXT_BYTES].ljust(_TEXT_BYTES)
        yield _record(*(looks if start == 0 else [b" " * 20]), words)


def _number(value: int, width: int) -> bytes:
    words = str(value).rjust(width).encode("ascii")
    if len(words) > width:
        raise OutOfRange(
            Text(
                f"A number has more than the {width} digits that the extended DM has for it.",
                f"拡張DMの{width}桁の欄に入らない数値があります。",
            ),
            Text.same(str(value)),
            Text(
                "Check the heights of the features; nothing was written.",
                "地物の標高を確認してください。何も書き込まれていません。",
            ),
        )
    return words


def _text(words: str, width: int) -> bytes:
    encoded = words.encode("cp932")
    if len(encoded) > width:
        message = f"{words!r} is longer than {width} bytes"
        raise ValueError(message)
    return encoded.ljust(width)


def _record(*fields: bytes) -> bytes:
    joined = b"".join(fields)
    if len(joined) > RECORD_BYTES:
        message = f"a record of {len(joined)} bytes"
        raise ValueError(message)
    return joined.ljust(RECORD_BYTES)


def _too_long(element: DmElement) -> Unsuitable:
    return Unsuitable(
        Text(
            f"An element of the extended DM has at most {MOST_PLACES} vertices or letters.",
            f"拡張DMの要素の頂点数・文字数は{MOST_PLACES}までです。",
        ),
        Text(f"code {element.code}", f"分類コード {element.code}"),
        Text(
            "Divide the feature, or take out vertices; nothing was written.",
            "地物を分割するか、頂点を減らしてください。何も書き込まれていません。",
        ),
    )
