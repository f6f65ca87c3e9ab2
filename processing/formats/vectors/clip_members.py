"""One feature as a member of a GeoJSON collection, and back: exactly, where it is one of ours."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from processing.core.text import Text
from processing.formats.vectors.geojson import ESCAPE, is_reserved, member_of
from processing.formats.vectors.geojson_shapes import GeoJsonGeometry, JsonObject, refusal, short
from processing.map.feature import (
    AttributeValue,
    Feature,
    PointReference,
    Provenance,
    Status,
    Vertex,
    new_feature_id,
)

OURS = "zuka"
"""The member of an object that holds what GeoJSON has no place for."""

_OWN_PROPERTIES = ("kind", "status", "confidence", "tool")
_LAST_POINT = (1 << 63) - 1


def clip_member(feature: Feature) -> JsonObject:
    """A feature as GeoJSON, with what only this program keeps of it."""
    provenance = feature.provenance
    return {
        **member_of(feature),
        OURS: {
            "version": provenance.version,
            "parameters": dict(provenance.parameters),
            "run": provenance.run,
            "unseen": provenance.unseen,
            "measured": [
                None if one.measured is None else [one.measured.drive, one.measured.point]
                for one in feature.vertices
            ],
            "occluded": [at for at, one in enumerate(feature.vertices) if one.is_occluded],
        },
    }


def features_of(
    member: JsonObject, shapes: Sequence[GeoJsonGeometry], number: int
) -> Iterator[Feature]:
    """The features of a member, one for each of its shapes, with new ids.

    Parameters
    ----------
    shapes : sequence of Shape
        Of the member's geometry.
    number : int
        Of the member, from 1, for the message.

    Yields
    ------
    Feature
        Its kind is empty where another program wrote the member.

    Raises
    ------
    BadFile
        The member is one of ours, and damaged.
    """
    properties = member.get("properties")
    if properties is None:
        properties = {}
    if not isinstance(properties, dict):
        raise _make_damage_error("properties", number)
    if not all(name in properties for name in _OWN_PROPERTIES):
        attributes = {name: _attribute(value) for name, value in properties.items()}
        for shape in shapes:
            vertices = tuple(map(Vertex, shape.positions))
            yield Feature(new_feature_id(), "", shape.geometry, vertices, attributes)
        return
    own = member.get(OURS, {})
    if not isinstance(own, dict):
        raise _make_damage_error(OURS, number)
    kind, status = properties["kind"], properties["status"]
    if not isinstance(kind, str) or not kind:
        raise _make_damage_error("kind", number)
    if not isinstance(status, str) or status not in {one.value for one in Status}:
        raise _make_damage_error(f"status {status!r}", number)
    for shape in shapes:
        yield Feature(
            new_feature_id(),
            kind,
            shape.geometry,
            _vertices(shape, own, number),
            {
                _unescape_name(name): _attribute(value)
                for name, value in properties.items()
                if name not in _OWN_PROPERTIES
            },
            Status(status),
            _provenance(properties, own, number),
        )


def _vertices(shape: GeoJsonGeometry, own: JsonObject, number: int) -> tuple[Vertex, ...]:
    measured, occluded = own.get("measured", []), own.get("occluded", [])
    if not isinstance(measured, list) or not isinstance(occluded, list):
        raise _make_damage_error("measured", number)
    references = [_reference(one, number) for one in measured]
    if len(references) != len(shape.positions):
        # Another program added or removed vertices: nobody knows what they rest on.
        return tuple(map(Vertex, shape.positions))
    hidden = {one for one in occluded if isinstance(one, int)}
    return tuple(
        Vertex(position, reference, is_occluded=at in hidden)
        for at, (position, reference) in enumerate(zip(shape.positions, references, strict=True))
    )


# What comes out of JSON has no types of its own.
def _reference(value: Any, number: int) -> PointReference | None:
    match value:
        case None:
            return None
        case [str(drive), int(point)] if 0 <= point <= _LAST_POINT and point is not True:
            return PointReference(drive, point)
        case _:
            raise _make_damage_error("measured", number)


def _provenance(properties: JsonObject, own: JsonObject, number: int) -> Provenance:
    values = (
        properties["tool"],
        own.get("version", 0),
        own.get("parameters", {}),
        properties["confidence"],
        own.get("run", ""),
        own.get("unseen", False),
    )
    match values:
        case (
            str(tool),
            int(version),
            dict(parameters),
            int() | float() as sure,
            str(run),
            bool(unseen),
        ):
            if 0 <= sure <= 1:
                return Provenance(tool, version, parameters, float(sure), run, unseen)
    raise _make_damage_error("tool", number)


def _attribute(value: Any) -> AttributeValue:
    """Lists and objects of other programs stay readable as JSON."""
    if value is None or isinstance(value, (str, float, int)):
        return value
    return json.dumps(value, ensure_ascii=False)


def _unescape_name(name: str) -> str:
    is_escaped = name.startswith(ESCAPE) and is_reserved(name.removeprefix(ESCAPE))
    return name.removeprefix(ESCAPE) if is_escaped else name


def _make_damage_error(reason: str, number: int) -> Exception:
    return refusal(
        Text(
            "The text of a feature is damaged: {reason}.",
            "地物のテキストが壊れています（{reason}）。",
        ).filled(reason=short(reason)),
        number,
    )
