"""The extended DM read as a map: elements with their class codes, whoever wrote them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.errors import BadFile, Unsuitable, report_as_user_error
from processing.core.text import Text
from processing.formats.survey.dm_records import RECORD_BYTES
from processing.map.drafting.constructions import arc_through
from processing.scoring.features.mapped_features import GeometryType, MappedFeature, MappedFile

_METRES = {1: 0.001, 10: 0.01}
"""By the unit that the second record says."""

_FIRST_ZONE = 6668  # EPSG of zone n of JGD2011 is this and n
_ZONES = 19
_AXES = {2: (2, 6), 3: (3, 4), 6: (3, 4)}
"""By kind of data: axes of a place, and places of a record."""

_SHAPES: dict[str, GeometryType] = {"E1": "area", "E2": "line", "E4": "line"}
_POINTS = frozenset({"E3", "E5", "E6", "E7"})
_NOTE = 4  # kind of data


@dataclass(frozen=True)
class _Sheet:
    """Where a file's numbers are counted from."""

    path: Path
    south_m: float
    west_m: float
    metres: float

    def place(self, offsets: Sequence[int]) -> tuple[float, float, float]:
        """Easting, northing and height; NaN where there is none."""
        x, y, *z = (one * self.metres for one in offsets)
        return self.west_m + y, self.south_m + x, z[0] if z else math.nan


def read_dm_features(path: Path) -> MappedFile:
    """The areas, lines, points, circles' centres and notes of a sheet; X is northing there.

    Its zone is that of the sheet's identifier, on JGD2011. Lines that the sheet's edge cuts stay
    cut. Attributes (E8) and grids are passed over.

    Raises
    ------
    MissingInput, NoSpace
        It can't be read.
    BadFile
        It is no extended DM; a record can't be read.
    Unsuitable
        Its unit of length is none that maps of levels 250 to 1000 have.
    """
    with report_as_user_error(path):
        data = path.read_bytes()
    records = [line.rstrip(b"\r").ljust(RECORD_BYTES) for line in data.split(b"\n")]
    if not data.startswith(b"M ") or len(records) < 2:
        raise _damage(path, 1)
    try:
        zone = int(records[0][2:4])
        sheet = _sheet_of(path, records[1])
    except ValueError as error:
        raise _damage(path, 2) from error
    crs = f"EPSG:{_FIRST_ZONE + zone}" if 1 <= zone <= _ZONES else ""
    features = tuple(_features(sheet, records))
    return MappedFile(path, crs, features)


def _sheet_of(path: Path, record: bytes) -> _Sheet:
    south, west = int(record[:7]), int(record[7:14])
    unit = int(record[44:47])
    if unit not in _METRES:
        raise Unsuitable(
            Text(f"The unit of length is {unit}.", f"座標の単位が{unit}です。"),
            Text.same(f"{path}, 2"),
            Text(
                "Give sheets whose unit is 1 (mm) or 10 (cm).",
                "単位が1（mm）または10（cm）の図郭を指定してください。",
            ),
        )
    return _Sheet(path, south, west, _METRES[unit])


def _features(sheet: _Sheet, records: Sequence[bytes]) -> Iterator[MappedFeature]:
    at = next((i for i, one in enumerate(records) if i > 1 and one[:2] == b"H "), len(records))
    number = 0
    while at < len(records):
        head = records[at]
        type_ = head[:2].decode("ascii", "replace")
        at += 1
        if not type_.startswith("E"):
            continue
        try:
            more = int(head[31:35])
            body = records[at : at + more]
            found = _element(sheet, type_, head, body) if len(body) == more else None
        except (ValueError, KeyError, IndexError) as error:
            raise _damage(sheet.path, at) from error
        if len(body) < more:
            raise _damage(sheet.path, at)
        at += more
        if found is not None:
            number += 1
            shape, places, facts = found
            yield MappedFeature(number, shape, np.array(places, dtype=np.float64), facts)


_Found = tuple[GeometryType, list[tuple[float, float, float]], dict[str, object]]


def _element(sheet: _Sheet, type_: str, head: bytes, body: Sequence[bytes]) -> _Found | None:
    facts: dict[str, object] = {"dm_code": head[2:6].decode("ascii").strip()}
    kind, count = int(head[20:21]), int(head[27:31])
    if type_ in _POINTS and (not body or kind == _NOTE):
        place = sheet.place((int(head[35:42]), int(head[42:49])))
        if kind == _NOTE:
            words = b"".join(one[20:RECORD_BYTES] for one in body)
            facts["name"] = words.decode("cp932").strip()
        return "point", [place], facts
    if type_ not in _POINTS and type_ not in _SHAPES:
        return None
    places = [sheet.place(one) for one in _offsets(body, kind, count)]
    if type_ == "E3":
        return "point", [_centre(places)], facts
    if type_ in _POINTS:
        return "point", places[:1], facts
    if type_ == "E4":
        places = _arc(places)
    shape = _SHAPES[type_]
    if shape == "area" and places[0] == places[-1]:
        places = places[:-1]
    enough = len(places) > (2 if shape == "area" else 1)
    return (shape, places, facts) if enough else None


def _offsets(body: Sequence[bytes], kind: int, count: int) -> list[tuple[int, ...]]:
    axes, each = _AXES[kind]
    numbers = [
        int(record[at : at + 7]) for record in body for at in range(0, 7 * axes * each, 7)
        if record[at : at + 7].strip()
    ]  # fmt: skip
    found = [tuple(numbers[at : at + axes]) for at in range(0, axes * count, axes)]
    if not found or len(found[-1]) < axes:
        raise ValueError(count)
    return found


def _centre(places: Sequence[tuple[float, float, float]]) -> tuple[float, float, float]:
    """Of the circle through the first three places; the first, where they lie on a line."""
    first, *others = (np.array(one[:2]) for one in places[:3])
    if len(others) < 2:
        return places[0]
    (ax, ay), (bx, by) = (one - first for one in others)
    turn = 2 * (ax * by - ay * bx)
    if turn == 0:
        return places[0]
    a, b = ax * ax + ay * ay, bx * bx + by * by
    x, y = first + np.array([by * a - ay * b, ax * b - bx * a]) / turn
    return float(x), float(y), places[0][2]


def _arc(places: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """The arc over three places; without heights it lies in plan."""
    first, second, third = places[:3]
    if all(math.isfinite(one[2]) for one in (first, second, third)):
        return list(arc_through(first, second, third))
    flat = [(x, y, 0.0) for x, y, _ in (first, second, third)]
    return [(x, y, math.nan) for x, y, _ in arc_through(flat[0], flat[1], flat[2])]


def _damage(path: Path, record: int) -> BadFile:
    return BadFile(
        Text("The record is none of the extended DM.", "拡張DMのレコードとして読めません。"),
        Text(f"{path}, record {record:,}", f"{path}、{record:,}レコード目"),
        Text(
            "Choose the right file, or have it delivered once more.",
            "正しいファイルを選ぶか、もう一度納品を受けてください。",
        ),
    )
