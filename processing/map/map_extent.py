"""The plan extent of a map while it changes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from processing.map.change import Change
from processing.map.feature import Feature

Bounds = tuple[float, float, float, float]
"""Lowest easting and northing, highest easting and northing, m."""


def extent_of(features: Iterable[Feature]) -> Bounds | None:
    """The extent of features; None when there are none."""
    eastings: list[float] = []
    northings: list[float] = []
    for feature in features:
        for vertex in feature.vertices:
            eastings.append(vertex.xyz[0])
            northings.append(vertex.xyz[1])
    if not eastings:
        return None
    return min(eastings), min(northings), max(eastings), max(northings)


def extent_after(
    change: Change, features: Mapping[str, Feature], extent: Bounds | None
) -> Bounds | None:
    """The extent once a change is done.

    Parameters
    ----------
    features : mapping
        All features before it.
    extent : Bounds or None
        Theirs.
    """
    gone = extent_of([*change.removed, *(pair.before for pair in change.replaced)])
    new = extent_of([*change.added, *(pair.after for pair in change.replaced)])
    # Only what lay at the edge, and lies there no more, can make the extent smaller.
    if gone is not None and (extent is None or _leaves_edge(gone, new, extent)):
        ids = frozenset(change.feature_ids)
        extent = extent_of(feature for id_, feature in features.items() if id_ not in ids)
    if extent is None or new is None:
        return new if extent is None else extent
    return (
        min(extent[0], new[0]),
        min(extent[1], new[1]),
        max(extent[2], new[2]),
        max(extent[3], new[3]),
    )


def _leaves_edge(gone: Bounds, new: Bounds | None, extent: Bounds) -> bool:
    if new is None:
        new = (extent[2], extent[3], extent[0], extent[1])
    return any(
        (gone[low] <= extent[low] < new[low]) or (gone[high] >= extent[high] > new[high])
        for low, high in ((0, 2), (1, 3))
    )
