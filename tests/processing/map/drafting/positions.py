"""Places of lines for tests, far from the origin as survey coordinates are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature, PointReference, Position, Vertex

CORNER = np.array([-11_030.123, -35_139.915, 12.345])


def positions(*local: Sequence[float]) -> tuple[Position, ...]:
    """Places from easting, northing and height (0 if left out) about a far corner."""
    return tuple(_position(np.append(position, 0.0)[:3] + CORNER) for position in local)


def local(positions: Iterable[Position]) -> NDArray[np.float64]:
    """(n, 3): places about the far corner."""
    return np.array(list(positions)) - CORNER


def line(id: str, *local: Sequence[float], kind: str = "curb") -> Feature:
    """A line each of whose vertices rests on a measured point of its own."""
    return Feature(id, kind, Geometry.LINE, vertices(*local), {"note": id})


def area(id: str, *local: Sequence[float]) -> Feature:
    return Feature(id, "lid", Geometry.AREA, vertices(*local), {"note": id})


def vertices(*local: Sequence[float]) -> tuple[Vertex, ...]:
    return tuple(
        Vertex(xyz, PointReference("left", 1000 + number))
        for number, xyz in enumerate(positions(*local))
    )


def kind(id: str, geometry: Geometry, *attributes) -> FeatureKind:
    from processing.core.text import Text

    return FeatureKind(
        id, Text.same(id), geometry, "", id, "#000000", 7, attributes=tuple(attributes)
    )


def distances_to(positions: Sequence[Position], others: Iterable[Position]) -> NDArray[np.float64]:
    """Plan distances of places from a line, the plain way: every place to every side."""
    xy = local(positions)[:, :2]
    found = []
    for position in local(others)[:, :2]:
        steps, away = xy[1:] - xy[:-1], position - xy[:-1]
        squares = (steps**2).sum(axis=1)
        t = np.divide((away * steps).sum(axis=1), squares, where=squares > 0, out=0 * squares)
        found.append(np.linalg.norm(away - t.clip(0, 1)[:, None] * steps, axis=1).min())
    return np.array(found)


def _position(position: NDArray[np.float64]) -> Position:
    return (float(position[0]), float(position[1]), float(position[2]))
