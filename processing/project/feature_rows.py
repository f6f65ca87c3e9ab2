"""Features and changes as rows and JSON, exactly: what is read is what was written."""

from __future__ import annotations

import dataclasses
import json
from typing import Any

from processing.project.catalogue import Geometry
from processing.project.change import Change, Replacement
from processing.project.feature import (
    Feature,
    PointReference,
    Position,
    Provenance,
    Status,
    Vertex,
)
from processing.project.geometry_blob import blob_of, places_of

COLUMNS = ("geom", "id", "kind", "status", "confidence", "attributes", "provenance", "measured")
"""Columns of the table ``features``, in the order of rows."""

Row = tuple[bytes, str, str, str, float, str, str, str]


def row_of(feature: Feature, srs_id: int) -> Row:
    """A feature as a row of the table ``features``."""
    places = tuple(vertex.xyz for vertex in feature.vertices)
    return (
        blob_of(feature.geometry, places, srs_id),
        feature.id,
        feature.kind,
        feature.status.value,
        feature.provenance.confidence,
        _json(dict(feature.attributes)),
        _json(dataclasses.asdict(feature.provenance)),
        _json([_reference(vertex) for vertex in feature.vertices]),
    )


# Rows come from SQLite untyped.
def feature_of(row: tuple[Any, ...]) -> Feature:
    """The feature of a row.

    Raises
    ------
    ValueError, KeyError, TypeError
        The row was not written by :func:`row_of`.
    """
    blob, id_, kind, status, _, attributes, provenance, measured = row
    geometry, places = places_of(blob)
    references = json.loads(measured)
    return Feature(
        id=id_,
        kind=kind,
        geometry=geometry,
        vertices=tuple(
            _vertex(place, reference) for place, reference in zip(places, references, strict=True)
        ),
        attributes=json.loads(attributes),
        status=Status(status),
        provenance=Provenance(**json.loads(provenance)),
    )


def change_to_json(change: Change) -> str:
    """A change as compact JSON that stands for itself."""
    return _json(
        {
            "added": [_plain(feature) for feature in change.added],
            "replaced": [[_plain(r.before), _plain(r.after)] for r in change.replaced],
            "removed": [_plain(feature) for feature in change.removed],
        }
    )


def change_from_json(text: str) -> Change:
    """The change of :func:`change_to_json`."""
    stored = json.loads(text)
    return Change(
        added=tuple(_from_plain(one) for one in stored["added"]),
        replaced=tuple(Replacement(_from_plain(b), _from_plain(a)) for b, a in stored["replaced"]),
        removed=tuple(_from_plain(one) for one in stored["removed"]),
    )


def _plain(feature: Feature) -> dict[str, object]:
    return {
        "id": feature.id,
        "kind": feature.kind,
        "geometry": feature.geometry.value,
        "places": [vertex.xyz for vertex in feature.vertices],
        "measured": [_reference(vertex) for vertex in feature.vertices],
        "attributes": dict(feature.attributes),
        "status": feature.status.value,
        "provenance": dataclasses.asdict(feature.provenance),
    }


# What comes out of JSON has no types of its own.
def _from_plain(plain: dict[str, Any]) -> Feature:
    pairs = zip(plain["places"], plain["measured"], strict=True)
    return Feature(
        id=plain["id"],
        kind=plain["kind"],
        geometry=Geometry(plain["geometry"]),
        vertices=tuple(_vertex((p[0], p[1], p[2]), reference) for p, reference in pairs),
        attributes=plain["attributes"],
        status=Status(plain["status"]),
        provenance=Provenance(**plain["provenance"]),
    )


def _reference(vertex: Vertex) -> list[str | int] | None:
    measured = vertex.measured
    return None if measured is None else [measured.drive, measured.point]


def _vertex(place: Position, reference: list[Any] | None) -> Vertex:
    measured = None if reference is None else PointReference(reference[0], reference[1])
    return Vertex(place, measured)


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
