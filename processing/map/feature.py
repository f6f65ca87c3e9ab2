"""Feature: one thing on the map, a plain value that can be stored, sent and compared."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.map.catalogue import Geometry
from processing.map.own_points import OwnPoints, own_points

AttributeValue = str | float | int | bool | None
Position = tuple[float, float, float]


class Status(Enum):
    """Whether a person has agreed to a feature."""

    CANDIDATE = "candidate"
    ACCEPTED = "accepted"
    REJECTED = "rejected"


@dataclass(frozen=True)
class PointReference:
    """The measured point a vertex rests on: a drive's id and the point's index in it."""

    drive: str
    point: int


@dataclass(frozen=True)
class Vertex:
    """A place on a feature.

    Attributes
    ----------
    xyz : tuple of float
        Easting, northing, height in metres, project CRS.
    measured : PointReference or None
        The measured point that it is; or, on an edge that was fitted through many points, the one
        nearest to it (within a few centimetres).
    is_occluded : bool
        No measured point is at this place: its height comes from its neighbours or from a working
        plane. Views show it hollow, the table lists it.
    """

    xyz: Position
    measured: PointReference | None = None
    is_occluded: bool = False


@dataclass(frozen=True)
class Provenance:
    """Where a feature comes from.

    Attributes
    ----------
    tool : str
        ``"hand"``, or the tool's id.
    version : int
        The tool's version; 0 for the hand.
    parameters : mapping
        The tool's parameters as given.
    confidence : float
        0 to 1; 1 for the hand.
    run : str
        The run's id, or empty.
    unseen : bool
        It was accepted by its confidence alone, together with others: nobody has looked at it.
    """

    tool: str = "hand"
    version: int = 0
    parameters: Mapping[str, AttributeValue] = field(default_factory=dict)
    confidence: float = 1.0
    run: str = ""
    unseen: bool = False


@dataclass(frozen=True)
class Feature:
    """One thing on the map.

    Attributes
    ----------
    id : str
        Unique for ever.
    kind : str
        Key of a :class:`processing.map.catalogue.FeatureKind`.
    geometry : Geometry
        How ``vertices`` are read: one vertex, an open line, a ring (its first vertex not repeated).
    own_points : tuple of OwnPoints
        The measured points that it consists of, as a tool found them: of a tree those of its trunk;
        one for each drive that has some, none where nobody knows.
    """

    id: str
    kind: str
    geometry: Geometry
    vertices: tuple[Vertex, ...]
    attributes: Mapping[str, AttributeValue] = field(default_factory=dict)
    status: Status = Status.ACCEPTED
    provenance: Provenance = field(default_factory=Provenance)
    own_points: tuple[OwnPoints, ...] = ()

    def with_vertices(self, vertices: tuple[Vertex, ...]) -> Feature:
        """The same feature in another place; of which points it consists there, nobody knows."""
        return dataclasses.replace(self, vertices=vertices, own_points=())

    def with_status(self, status: Status, *, unseen: bool = False) -> Feature:
        """The same feature, decided on by a person who looks at it or by its confidence alone."""
        provenance = dataclasses.replace(self.provenance, unseen=unseen)
        return dataclasses.replace(self, status=status, provenance=provenance)


def with_points_at(feature: Feature, positions: Mapping[str, NDArray[np.int64]]) -> Feature:
    """A feature whose vertices rest on the same points, where drives have another order now.

    Parameters
    ----------
    positions : mapping of str to (n,) int64
        By drive: where each of its points is now. What rests on other drives stays as it is.

    Returns
    -------
    Feature
        The same object where nothing changes.
    """

    def moved(vertex: Vertex) -> Vertex:
        rests = vertex.measured
        if rests is None or rests.drive not in positions:
            return vertex
        there = PointReference(rests.drive, int(positions[rests.drive][rests.point]))
        return dataclasses.replace(vertex, measured=there)

    on = {vertex.measured.drive for vertex in feature.vertices if vertex.measured is not None}
    if on.isdisjoint(positions) and positions.keys().isdisjoint(
        one.drive for one in feature.own_points
    ):
        return feature
    own = tuple(
        own_points(one.drive, there[one.numbers(there.size)])
        if (there := positions.get(one.drive)) is not None
        else one
        for one in feature.own_points
    )
    vertices = tuple(map(moved, feature.vertices))
    return dataclasses.replace(feature, vertices=vertices, own_points=own)


def new_feature_id() -> str:
    """An id that no other feature has."""
    return uuid4().hex
