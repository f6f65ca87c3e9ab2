"""GeoJSON as it comes from anywhere, taken apart: shapes that a map can hold, nothing left out."""

from __future__ import annotations

import json
import re
import reprlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from processing.core.errors import UNCHANGED, BadFile
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.feature import Position

MOST_CHARACTERS = 64 << 20
"""The longest text that is read: about a million vertices."""

_MOST_METRES = 1e8
"""No plane coordinate in metres is larger; drawing could not bear it either."""

_MOST_TOLD = 60
_LEAST_VERTICES = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}
_SINGLE = {"Point": Geometry.POINT, "LineString": Geometry.LINE, "Polygon": Geometry.AREA}
_EPSG = re.compile(r"(?:urn:ogc:def:crs:)?EPSG:(?:[0-9.]*:)?([0-9]{4,6})", re.IGNORECASE)
_CRS84 = re.compile(r"(?:urn:ogc:def:crs:)?OGC:(?:[0-9.]*:)?CRS84", re.IGNORECASE)

WHERE = Text("the clipboard", "クリップボード")
_COPY_AGAIN = Text(
    "Copy the features again, then paste. {unchanged}",
    "地物をもう一度コピーしてから貼り付けてください。{unchanged}",
).filled(unchanged=UNCHANGED)


@dataclass(frozen=True)
class GeoJsonGeometry:
    """One geometry of a GeoJSON feature.

    Attributes
    ----------
    positions : tuple of Position
        As many as the geometry needs; a ring without its first place repeated.
    heightless : int
        Number of places that came without a height and got 0.
    is_hole : bool
        Whether it was a hole of a polygon.
    """

    geometry: Geometry
    positions: tuple[Position, ...]
    heightless: int = 0
    is_hole: bool = False


# What comes out of JSON has no types of its own.
JsonObject = dict[str, Any]


def read_collection(text: str) -> tuple[JsonObject, list[JsonObject]]:
    """A GeoJSON text as its outermost object and its features.

    A feature or a geometry alone counts as a collection of one.

    Raises
    ------
    BadFile
        It is no GeoJSON, or a damaged one.
    """
    if len(text) > MOST_CHARACTERS:
        raise refusal(Text("The text is too long.", "テキストが長すぎます。"))
    words = text.strip("\ufeff \t\r\n")
    if not words.startswith("{"):
        raise BadFile(
            Text("There are no features.", "地物がありません。"),
            WHERE,
            Text(
                "Copy features in a map first, then paste. {unchanged}",
                "先に地図で地物をコピーしてから貼り付けてください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )
    try:
        whole = json.loads(words, parse_constant=_refuse_constant)
        if "\\ud" in words or "\\uD" in words:
            # Half of a character, which no file could hold, can only be written as an escape.
            json.dumps(whole, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        raise _make_damage_error(str(error)) from error
    kind = _type_of(whole)
    if kind == "Feature":
        members = [whole]
    elif kind == "FeatureCollection":
        members = whole.get("features")
    elif kind in _SINGLE or kind in _PARTS or kind == "GeometryCollection":
        members = [{"type": "Feature", "geometry": whole, "properties": {}}]
    else:
        raise refusal(
            Text("The text is JSON, but not GeoJSON.", "JSONですが、GeoJSONではありません。")
        )
    if not isinstance(members, list) or not all(isinstance(one, dict) for one in members):
        raise _make_damage_error("features")
    return whole, members


def crs_member(crs: str) -> JsonObject | None:
    """How GeoJSON names a reference system; None for an empty one: unknown."""
    if not crs:
        return None
    authority, _, code = crs.partition(":")
    name = f"urn:ogc:def:crs:{authority}::{code}" if code else crs
    return {"type": "name", "properties": {"name": name}}


def system_of(whole: JsonObject, shapes: list[GeoJsonGeometry]) -> str:
    """The reference system that a GeoJSON names; empty where nobody knows it.

    Returns
    -------
    str
        ``EPSG:n``, or ``OGC:CRS84``, which the standard prescribes where nothing is said and the
        coordinates can be degrees.

    Raises
    ------
    BadFile
        It names one that is not understood.

    References
    ----------
    RFC 7946, section 4; GeoJSON format specification 2008, section 3.
    """
    if "crs" not in whole:
        return "OGC:CRS84" if shapes and all(map(_is_in_degrees, shapes)) else ""
    member = whole["crs"]
    if member is None:
        return ""
    properties = member.get("properties") if isinstance(member, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    if isinstance(name, str):
        found = _EPSG.fullmatch(name.strip())
        if found is not None:
            return f"EPSG:{found[1]}"
        if _CRS84.fullmatch(name.strip()):
            return "OGC:CRS84"
    raise refusal(
        Text(
            "The reference system “{name}” is not understood.",
            "座標参照系「{name}」を解釈できません。",
        ).filled(name=short(name if isinstance(name, str) else member))
    )


def shapes_of(geometry: object, number: int) -> Iterator[GeoJsonGeometry]:
    """The shapes of a feature's geometry; none for ``null``.

    Parts of a multi-geometry and holes are shapes of their own.

    Parameters
    ----------
    number : int
        Of the feature, from 1, for the message.

    Raises
    ------
    BadFile
        It is no geometry of GeoJSON, or has too few places or a coordinate that is no number.
    """
    if geometry is None:
        return
    if not isinstance(geometry, dict):
        raise _make_damage_error("geometry", number)
    kind = _type_of(geometry)
    if kind == "GeometryCollection":
        for part in _list(geometry.get("geometries"), number):
            yield from shapes_of(part, number)
    elif kind in _SINGLE:
        yield from _single(kind, geometry.get("coordinates"), number)
    elif kind in _PARTS:
        for part in _list(geometry.get("coordinates"), number):
            yield from _single(_PARTS[kind], part, number)
    else:
        raise _make_damage_error(f"geometry {kind}", number)


def refusal(what: Text, number: int = 0) -> BadFile:
    """The error for a text that can't be pasted; ``number`` of the feature from 1, or 0."""
    where = WHERE
    if number:
        where = Text(f"{WHERE.en}, feature {number:,}", f"{WHERE.ja}、{number:,}番目の地物")
    return BadFile(what, where, _COPY_AGAIN)


def short(value: object) -> str:
    """A value from a foreign text as it may stand in a message."""
    # A foreign value may be nested or long without end; reprlib looks no further than it tells.
    words = " ".join((value[:200] if isinstance(value, str) else reprlib.repr(value)).split())
    return words if len(words) <= _MOST_TOLD else words[: _MOST_TOLD - 1] + "…"


_PARTS = {"MultiPoint": "Point", "MultiLineString": "LineString", "MultiPolygon": "Polygon"}


def _type_of(value: JsonObject) -> str:
    kind = value.get("type")
    return kind if isinstance(kind, str) else ""


def _single(kind: str, coordinates: object, number: int) -> Iterator[GeoJsonGeometry]:
    geometry = _SINGLE[kind]
    if geometry is Geometry.POINT:
        yield _shape(geometry, [coordinates], number)
    elif geometry is Geometry.LINE:
        yield _shape(geometry, _list(coordinates, number), number)
    else:
        rings = _list(coordinates, number)
        if not rings:
            raise _make_damage_error("polygon", number)
        for position, ring in enumerate(rings):
            yield _shape(geometry, _list(ring, number), number, is_hole=position > 0)


def _shape(
    geometry: Geometry, coordinate_lists: list[Any], number: int, *, is_hole: bool = False
) -> GeoJsonGeometry:
    read = [_position(coordinates, number) for coordinates in coordinate_lists]
    if geometry is Geometry.AREA and len(read) > 1 and read[0] == read[-1]:
        read.pop()
    if len(read) < _LEAST_VERTICES[geometry]:
        raise refusal(
            Text(
                "It has {count} of at least {least} vertices.",
                "頂点が{count}個しかありません（{least}個以上必要）。",
            ).filled(count=len(read), least=_LEAST_VERTICES[geometry]),
            number,
        )
    heightless = sum(not has_height for _, has_height in read)
    return GeoJsonGeometry(geometry, tuple(position for position, _ in read), heightless, is_hole)


def _position(position: Any, number: int) -> tuple[Position, bool]:
    if not isinstance(position, list) or len(position) < 2:
        raise _make_damage_error("coordinates", number)
    numbers = position[:3]
    if not all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in numbers):
        raise _no_position(position, number)
    # Compared before they are turned to floats: JSON's whole numbers have no end.
    if not all(-_MOST_METRES < one < _MOST_METRES for one in numbers):
        raise _no_position(position, number)
    height = float(numbers[2]) if len(numbers) > 2 else 0.0
    return (float(numbers[0]), float(numbers[1]), height), len(numbers) > 2


def _no_position(position: object, number: int) -> BadFile:
    return refusal(
        Text("“{place}” is no place.", "「{place}」は座標として使えません。").filled(
            place=short(position)
        ),
        number,
    )


def _is_in_degrees(shape: GeoJsonGeometry) -> bool:
    return all(abs(x) <= 180 and abs(y) <= 90 for x, y, _ in shape.positions)


def _list(value: object, number: int) -> list[Any]:
    if not isinstance(value, list):
        raise _make_damage_error("coordinates", number)
    return value


def _make_damage_error(reason: str, number: int = 0) -> BadFile:
    return refusal(
        Text("The text is damaged: {reason}.", "テキストが壊れています（{reason}）。").filled(
            reason=short(reason)
        ),
        number,
    )


def _refuse_constant(name: str) -> float:
    message = f"{name} is no number"
    raise ValueError(message)
