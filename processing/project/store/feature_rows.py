"""Features and changes as rows and JSON, exactly: what is read is what was written."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from processing.core.stored_json import json_of
from processing.map.catalogue import Geometry
from processing.map.change import Change, ListedDrive, Replacement, SystemChange
from processing.map.feature import Feature, PointReference, Position, Provenance, Status, Vertex
from processing.map.filed_labels import LABEL_STEPS, filed_of_plain, filed_to_plain
from processing.map.own_points import OwnPoints
from processing.map.step_files import STEP_FILES, step_files_of_plain, step_files_to_plain
from processing.project.store.geometry_blob import blob_of, positions_of

COLUMNS = (
    "geom", "id", "kind", "layer", "status", "confidence", "attributes", "provenance", "measured",
    "occluded",
)  # fmt: skip
"""Columns of the table ``features``, in the order of rows."""

_OWN_POINTS, _VERTICES = "own_points", "vertices"
"""What a feature rests on in a drive of which it has own points, too."""

FeatureRow = tuple[bytes, str, str, str, str, float, str, str, str, str]


def row_of(feature: Feature, layer: str, srs_id: int) -> FeatureRow:
    """A feature as a row of the table ``features``.

    Raises
    ------
    ValueError
        A value can't be stored: a coordinate that is not finite, too few vertices.
    """
    positions = tuple(vertex.xyz for vertex in feature.vertices)
    return (
        blob_of(feature.geometry, positions, srs_id),
        feature.id,
        feature.kind,
        layer,
        feature.status.value,
        feature.provenance.confidence,
        _json(dict(feature.attributes)),
        _json(_plain_provenance(feature.provenance)),
        _json(_measured(feature)),
        _json(_occluded(feature.vertices)),
    )


# Rows come from SQLite untyped.
def feature_of(row: tuple[Any, ...]) -> Feature:
    """The feature of a row.

    Raises
    ------
    ValueError, KeyError, TypeError
        The row is damaged.
    """
    blob, id_, kind, _, status, _, attributes, provenance, measured, occluded = row
    geometry, positions = positions_of(blob)
    rests = {} if measured == "{}" else _mapping(json_of(measured))
    own = {drive: one[_OWN_POINTS] for drive, one in rests.items() if isinstance(one, dict)}
    return Feature(
        id=id_,
        kind=kind,
        geometry=geometry,
        vertices=_vertices(
            positions,
            _vertex_references(rests) if own else rests,
            [] if occluded == "[]" else json_of(occluded),
        ),
        attributes={} if attributes == "{}" else _mapping(json_of(attributes)),
        status=Status(status),
        provenance=_provenance(provenance),
        own_points=_own_points_from(own),
    )


def change_to_json(change: Change) -> str:
    """A change as compact JSON that stands for itself."""
    return _json(
        {
            "added": [_plain(feature) for feature in change.added],
            "replaced": [[_plain(r.before), _plain(r.after)] for r in change.replaced],
            "removed": [_plain(feature) for feature in change.removed],
            **({} if change.filed is None else {"filed": filed_to_plain(change.filed)}),
            **_plain_drives("removed_drives", change.removed_drives),
            **_plain_drives("restored_drives", change.restored_drives),
            **({} if change.files is None else {"files": step_files_to_plain(change.files)}),
            **({} if change.system is None else {"system": _plain_system(change.system)}),
        }
    )


def change_from_json(text: str, project: Path) -> Change:
    """The change of :func:`change_to_json`.

    Parameters
    ----------
    project : Path
        Its folder, in which steps have folders of their own.

    Raises
    ------
    ValueError, KeyError, TypeError, IndexError
        The text is damaged.
    """
    stored = json_of(text)
    return Change(
        added=tuple(_from_plain(one) for one in stored["added"]),
        replaced=tuple(Replacement(_from_plain(b), _from_plain(a)) for b, a in stored["replaced"]),
        removed=tuple(_from_plain(one) for one in stored["removed"]),
        filed=filed_of_plain(stored["filed"], project / LABEL_STEPS) if "filed" in stored else None,
        removed_drives=_drives_from(stored.get("removed_drives", [])),
        restored_drives=_drives_from(stored.get("restored_drives", [])),
        files=step_files_of_plain(stored["files"], project / STEP_FILES)
        if "files" in stored
        else None,
        system=SystemChange(*map(str, stored["system"])) if "system" in stored else None,
    )


def _plain_system(system: SystemChange) -> list[str]:
    return [system.before, system.after]


def _plain_drives(name: str, drives: tuple[ListedDrive, ...]) -> dict[str, object]:
    """Nothing where there are none, as in nearly every step."""
    return {name: [[one.id, one.position, one.folder] for one in drives]} if drives else {}


def _drives_from(plain: list[Any]) -> tuple[ListedDrive, ...]:
    return tuple(ListedDrive(str(id_), int(position), str(name)) for id_, position, name in plain)


def _plain(feature: Feature) -> dict[str, object]:
    return {
        "id": feature.id,
        "kind": feature.kind,
        "geometry": feature.geometry.value,
        "places": [vertex.xyz for vertex in feature.vertices],
        "measured": _references(feature.vertices),
        "occluded": _occluded(feature.vertices),
        "attributes": dict(feature.attributes),
        "status": feature.status.value,
        "provenance": _plain_provenance(feature.provenance),
        **({_OWN_POINTS: _plain_own_points(feature)} if feature.own_points else {}),
    }


# What comes out of JSON has no types of its own.
def _from_plain(plain: dict[str, Any]) -> Feature:
    positions = tuple((position[0], position[1], position[2]) for position in plain["places"])
    return Feature(
        id=plain["id"],
        kind=plain["kind"],
        geometry=Geometry(plain["geometry"]),
        vertices=_vertices(positions, plain["measured"], plain["occluded"]),
        attributes=_mapping(plain["attributes"]),
        status=Status(plain["status"]),
        provenance=Provenance(**plain["provenance"]),
        own_points=_own_points_from(plain.get(_OWN_POINTS, {})),
    )


def _plain_provenance(provenance: Provenance) -> dict[str, object]:
    return {
        "tool": provenance.tool,
        "version": provenance.version,
        "parameters": dict(provenance.parameters),
        "confidence": provenance.confidence,
        "run": provenance.run,
        "unseen": provenance.unseen,
    }


@lru_cache(maxsize=4096)
def _provenance(text: str) -> Provenance:
    """Candidates of a run share theirs; a value that nobody changes may be shared."""
    return Provenance(**json_of(text))


def _measured(feature: Feature) -> dict[str, object]:
    """By drive: what the vertices rest on, where there are own points both of them."""
    measured: dict[str, object] = {**_references(feature.vertices)}
    for drive, runs in _plain_own_points(feature).items():
        vertices = {_VERTICES: measured[drive]} if drive in measured else {}
        measured[drive] = {**vertices, _OWN_POINTS: runs}
    return measured


def _vertex_references(rests: dict[str, Any]) -> dict[str, list[int | None]]:
    """What the vertices rest on, of what :func:`_measured` made."""
    vertices = {
        drive: one.get(_VERTICES) if isinstance(one, dict) else one for drive, one in rests.items()
    }
    return {drive: one for drive, one in vertices.items() if one is not None}


def _plain_own_points(feature: Feature) -> dict[str, str]:
    return {one.drive: one.runs for one in feature.own_points}


def _own_points_from(plain: Any) -> tuple[OwnPoints, ...]:
    return tuple(OwnPoints(str(drive), str(runs)) for drive, runs in _mapping(plain).items())


def _references(vertices: tuple[Vertex, ...]) -> dict[str, list[int | None]]:
    """For each drive, the measured point of each vertex; None where it has none of that drive."""
    references: dict[str, list[int | None]] = {}
    for number, vertex in enumerate(vertices):
        if vertex.measured is not None:
            points = references.setdefault(vertex.measured.drive, [None] * len(vertices))
            points[number] = int(vertex.measured.point)
    return references


def _occluded(vertices: tuple[Vertex, ...]) -> list[int]:
    """Numbers of the vertices without a measured point."""
    return [number for number, vertex in enumerate(vertices) if vertex.is_occluded]


def _vertices(
    positions: tuple[Position, ...], references: dict[str, list[int | None]], occluded: list[int]
) -> tuple[Vertex, ...]:
    vertices = _resting(positions, references)
    if not occluded:
        return vertices
    hidden = set(occluded)
    return tuple(
        Vertex(one.xyz, one.measured, is_occluded=number in hidden)
        for number, one in enumerate(vertices)
    )


def _resting(
    positions: tuple[Position, ...], references: dict[str, list[int | None]]
) -> tuple[Vertex, ...]:
    # Where a GIS program added or removed vertices, nobody knows what they rest on.
    fitting = {
        drive: points for drive, points in references.items() if len(points) == len(positions)
    }
    if len(fitting) == 1:  # nearly always, and then quickly
        ((drive, points),) = fitting.items()
        pairs = zip(positions, points, strict=True)
        return tuple([Vertex(p, None if n is None else PointReference(drive, n)) for p, n in pairs])
    vertices = [Vertex(position) for position in positions]
    for drive, points in fitting.items():
        for number, point in enumerate(points):
            if point is not None:
                vertices[number] = Vertex(positions[number], PointReference(drive, point))
    return tuple(vertices)


def _mapping(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        message = f"attributes that are none: {value}"
        raise TypeError(message)
    return value


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
