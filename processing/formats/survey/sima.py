"""SIMA: points and closed parcels as Japanese survey programs exchange them.

Lines of text with a comma behind each field, in Shift_JIS; X is northing, Y easting, metres with
three decimals. The form has no open lines that all readers agree on: those are left out and told.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.accepted_features import accepted_features
from processing.formats.map_delivery import MapDelivery
from processing.formats.shift_jis import ShiftJisText
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature, Position

_NAME_BYTES = 16
"""Of a point's or parcel's name: the shortest field among the programs that read them."""

_STEM_BYTES = 8
"""Of names that are made up: four kanji, which leaves room for numbers."""

_USUAL_CORNERS = 98
"""Some programs divide a parcel of more corners when they read it."""

_CHECK_EVERY = 256  # features


def write_sima_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write a map's accepted points, and its areas as parcels with a point at each corner.

    Corners at one place, to the millimetre, are one point. Names are the features' numbers or
    names, else the kind's with a number; no two are the same.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    日本測量機器工業会, 測量データ共通フォーマット (SIMA); record layouts as files and readers have
    them: G00 title, A00–A99 points, D00–D99 a parcel with B01 corners.
    """
    texts = ShiftJisText()
    table = _PointTable(texts)
    left_out: Counter[str] = Counter()
    features = accepted_features(delivery, Text("SIMA file", "SIMA"))
    for number, feature in enumerate(features):
        if number % _CHECK_EVERY == 0:
            monitor.check()
            monitor.report(number / len(features))
        kind = delivery.catalogue[feature.kind]
        match feature.geometry:
            case Geometry.POINT:
                table.add_point(feature.vertices[0].xyz, kind, feature)
            case Geometry.AREA:
                table.add_parcel([vertex.xyz for vertex in feature.vertices], kind, feature)
            case Geometry.LINE:
                left_out[kind.id] += 1
    lines = _lines(texts.fitted(delivery.name.replace(",", " ")), table)
    content = "".join(f"{line}\r\n" for line in lines).encode("cp932")
    with write_safely(path, never=never) as temporary:
        temporary.write_bytes(content)
    _tell(delivery, left_out, table, texts)


def _lines(title: str, table: _PointTable) -> Iterator[str]:
    yield f"G00,01,{title},"
    yield "Z00,座標ﾃﾞｰﾀ,,"
    yield "A00,"
    for number, ((x, y, z), name) in enumerate(table.points, 1):
        yield f"A01,{number},{name},{_metres(x)},{_metres(y)},{_metres(z)},"
    yield "A99,"
    if table.parcels:
        yield "Z00,区画ﾃﾞｰﾀ,"
    for number, (name, corners) in enumerate(table.parcels, 1):
        yield f"D00,{number},{name},1,"
        for corner in corners:
            yield f"B01,{corner + 1},{table.points[corner][1]},"
        yield "D99,"


def _metres(millimetres: int) -> str:
    sign = "-" if millimetres < 0 else ""
    return f"{sign}{abs(millimetres) // 1000}.{abs(millimetres) % 1000:03d}"


@dataclass
class _PointTable:
    """Points and parcels with their names; X, Y and height in millimetres."""

    texts: ShiftJisText
    points: list[tuple[tuple[int, int, int], str]] = field(default_factory=list)
    parcels: list[tuple[str, list[int]]] = field(default_factory=list)
    _corners: dict[tuple[int, int, int], int] = field(default_factory=dict)
    _names: set[str] = field(default_factory=set)
    _numbers: Counter[str] = field(default_factory=Counter)

    def add_point(self, position: Position, kind: FeatureKind, feature: Feature) -> None:
        """Add a point of its own, even where another is at its place."""
        place = _place(position)
        self._corners.setdefault(place, len(self.points))
        self.points.append((place, self._own_name(kind, feature)))

    def add_parcel(
        self, positions: Iterable[Position], kind: FeatureKind, feature: Feature
    ) -> None:
        """Add a parcel and those of its corners that are no points yet."""
        name = self._own_name(kind, feature)
        corners = []
        for position in positions:
            place = _place(position)
            if place not in self._corners:
                self._corners[place] = len(self.points)
                self.points.append((place, self._numbered(kind.name.ja)))
            corners.append(self._corners[place])
        self.parcels.append((name, corners))

    def _own_name(self, kind: FeatureKind, feature: Feature) -> str:
        values = (feature.attributes.get(name) for name in ("number", "name"))
        words = next((str(value) for value in values if value not in (None, "")), "")
        name = self.texts.fitted(words.replace(",", " "), _NAME_BYTES)
        if not name or name in self._names:
            return self._numbered(name or kind.name.ja)
        self._names.add(name)
        return name

    def _numbered(self, words: str) -> str:
        """A stem with the next number that makes a name of its own."""
        stem = words.partition("（")[0].encode("cp932", "replace")[:_STEM_BYTES]
        short = stem.decode("cp932", "ignore").strip()
        while True:
            self._numbers[short] += 1
            name = f"{short}-{self._numbers[short]}"
            if name not in self._names:
                self._names.add(name)
                return name


def _place(position: Position) -> tuple[int, int, int]:
    easting, northing, height = position
    return round(northing * 1000), round(easting * 1000), round(height * 1000)


def _tell(
    delivery: MapDelivery, left_out: Counter[str], table: _PointTable, texts: ShiftJisText
) -> None:
    if left_out:
        names = [delivery.catalogue[kind].name for kind in left_out]
        delivery.tell(
            Text(
                "Not in the SIMA file, which has no open lines: {count} of {kinds};"
                " hand those in as DXF.",
                "SIMAには開いた線がないため、次の{count}本は含まれていません: {kinds}。"
                "線はDXFで渡してください",
            ).filled(
                count=left_out.total(),
                kinds=Text(
                    ", ".join(name.en for name in names), "、".join(name.ja for name in names)
                ),
            )
        )
    long = [name for name, corners in table.parcels if len(corners) > _USUAL_CORNERS]
    if long:
        delivery.tell(
            Text(
                "Some programs divide parcels of more than {most} corners: {names}.",
                "{most}点を超える区画は、読み込み時に分割するソフトウェアがあります: {names}",
            ).filled(most=_USUAL_CORNERS, names=", ".join(long))
        )
    for note in texts.notes:
        delivery.tell(note)
