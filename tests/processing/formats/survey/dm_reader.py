"""A reader of the extended DM, written from its description and from nothing of the writer."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class ReadElement:
    """An element: its columns as they stand, places in metres (easting, northing, height)."""

    type: str
    code: str
    number: int
    kind: int
    places: list[tuple[float, ...]]
    columns: dict[str, str]
    words: str = ""
    angle_deg: int = 0
    letters_mm: float = 0.0


@dataclass
class ReadSheet:
    """A file: what its head says, and the elements under each header."""

    identifier: str
    title: str
    level: int
    corners: list[int]
    neighbours: list[str]
    company: str
    elements: list[ReadElement] = field(default_factory=list)
    headers: list[tuple[str, int, list[int]]] = field(default_factory=list)


def read_dm(path: Path) -> ReadSheet:
    """Read a sheet of level 500; every count in it is checked."""
    data = path.read_bytes()
    assert len(data) % 86 == 0
    lines = [data[at : at + 86] for at in range(0, len(data), 86)]
    assert all(line.endswith(b"\r\n") and b"\r" not in line[:84] for line in lines)
    records = [line[:84] for line in lines]
    a, b, c, d, e = records[:5]
    assert (a[:2], a[65:67], d[9:10]) == (b"M ", b" 0", b"0")
    assert b[44:47] == b"  1"
    assert e[40:72] == b"   0" * 8
    sheet = ReadSheet(
        _text(a[2:10]), _text(a[35:65]), int(a[30:35]),
        [int(b[at : at + 7]) for at in (0, 7, 14, 21, 47, 54, 61, 68)],
        [_text(c[at : at + 8]) for at in range(0, 64, 8)], _text(e[:40]),
    )  # fmt: skip
    rest = records[5:]
    assert int(b[37:44]) == len(rest)
    at = 0
    while at < len(rest):
        head = rest[at]
        at += 1
        if head[:2] == b"H ":
            counts = [int(head[i : i + 5]) for i in range(28, 68, 5)]
            sheet.headers.append((_text(head[2:6]), int(head[18:23]), counts))
            continue
        more = int(head[31:35])
        sheet.elements.append(_element(head, rest[at : at + more], sheet.corners[:2]))
        at += more
    assert int(b[28:37]) == len(sheet.elements) == sum(count for _, count, _ in sheet.headers)
    assert all(sum(counts) == count for _, count, counts in sheet.headers)
    return sheet


def _element(head: bytes, data: list[bytes], corner: list[int]) -> ReadElement:
    type_, kind, count = _text(head[:2]), int(head[20:21]), int(head[27:31])
    columns = {
        "figure": _text(head[18:20]), "accuracy": _text(head[21:23]), "note": _text(head[23:24]),
        "value": _text(head[49:56]), "surveyed": _text(head[65:69]), "level": _text(head[16:18]),
    }  # fmt: skip
    read = ReadElement(type_, _text(head[2:6]), int(head[12:16]), kind, [], columns)
    if type_ in ("E5", "E7"):
        read.places = [_place((int(head[35:42]), int(head[42:49])), corner)]
    if type_ == "E7":
        assert kind == 4
        read.angle_deg, read.letters_mm = int(data[0][1:8]), int(data[0][8:13]) / 10
        joined = b"".join(record[20:84] for record in data)
        width = 2 if columns["note"] == "1" else 1
        assert not joined[count * width :].strip()
        read.words = joined[: count * width].decode("cp932")
        return read
    if type_ == "E5":
        assert (kind, count, data) == (0, 0, [])
        return read
    axes, each = {2: (2, 6), 3: (3, 4), 6: (3, 4)}[kind]
    assert len(data) == -(-count // each)
    numbers = [int(r[i : i + 7]) for r in data for i in range(0, 7 * axes * each, 7)]
    found = [tuple(numbers[i : i + axes]) for i in range(0, len(numbers), axes)]
    assert all(one == (0,) * axes for one in found[count:])
    read.places = [_place(one, corner) for one in found[:count]]
    return read


def _place(offsets: tuple[int, ...], corner: list[int]) -> tuple[float, ...]:
    x, y, *z = offsets
    assert 0 <= x <= 300_000
    assert 0 <= y <= 400_000
    assert (x, y) != (0, 0)
    millimetres = (corner[1] * 1000 + y, corner[0] * 1000 + x, *z)
    return tuple(one / 1000 for one in millimetres)


def _text(field_: bytes) -> str:
    return field_.decode("cp932").strip()
