"""Features and projects made in a line."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import (
    AttributeValue,
    Feature,
    PointReference,
    Provenance,
    Status,
    Vertex,
)
from processing.map.own_points import own_points
from processing.project.project import Project
from processing.project.store.feature_rows import change_from_json
from processing.project.store.reading_connection import connect

LABEL = Text("Draw", "作図")


def sign(id: str, easting: float = 1.0, northing: float = 2.0) -> Feature:
    return Feature(id, "sign", Geometry.POINT, (Vertex((easting, northing, 3.5)),))


def curb(id: str, *, vertices: int = 2) -> Feature:
    """A candidate along the street, each vertex on a measured point."""
    line = tuple(
        Vertex((-11000.123 + n, -35000.456, 12.0 + n / 1000), PointReference("left", n))
        for n in range(vertices)
    )
    provenance = Provenance("curbs", 3, {"step_m": 0.05, "both": True}, 0.75, "run-1")
    attributes: dict[str, AttributeValue] = {"height_m": 0.15, "note": "縁石"}
    return Feature(id, "curb_lower", Geometry.LINE, line, attributes, Status.CANDIDATE, provenance)


def with_own_points(id: str, *points: tuple[str, list[int]]) -> Feature:
    """A tree that consists of these points of drives."""
    own = tuple(own_points(drive, numbers) for drive, numbers in points)
    foot = (Vertex((-11000.1, -35000.2, 3.5)),)
    return Feature(id, "street_tree", Geometry.POINT, foot, own_points=own)


def new_project(folder: Path, *features: Feature) -> Path:
    """A closed project with these features, drawn in one step."""
    with closing(Project.create(folder, "EPSG:6677")) as project:
        if features:
            project.features.apply(LABEL, Change(added=features))
    return folder


def features_of(project: Project) -> dict[str, Feature]:
    return {feature.id: feature for feature in project.features.all()}


def replayed_history(folder: Path) -> dict[str, Feature]:
    """The features that the stored changes make, one after the other, from an empty map."""
    with closing(connect(folder / "project.gpkg", "ro")) as connection:
        query = "SELECT value FROM zuka_settings WHERE key = 'history_position'"
        found = connection.execute(query).fetchone()
        last_position = int(found[0]) if found else 0
        stored = connection.execute(
            "SELECT place, change FROM zuka_history WHERE place <= ? ORDER BY place",
            (last_position,),
        ).fetchall()
    assert [position for position, _ in stored] == list(range(1, last_position + 1))
    features: dict[str, Feature] = {}
    for _, text in stored:
        change = change_from_json(text, folder)
        for feature in change.removed:
            assert features.pop(feature.id) == feature
        for pair in change.replaced:
            assert features[pair.before.id] == pair.before
            features[pair.after.id] = pair.after
        for feature in change.added:
            assert feature.id not in features
            features[feature.id] = feature
    return features


def tree_of(folder: Path) -> dict[str, bytes]:
    """All files of a project but the lock, which nobody reads."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != "lock"
    }
