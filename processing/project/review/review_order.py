"""In which order the candidates of runs are judged."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from processing.map.feature import Feature, PointReference, Position
from processing.map.feature_middle import middle_of
from processing.project.review.review_state import ReviewOrder
from processing.recording.drive import Drive

_Key = tuple[int, int]


def review_order(
    features: Iterable[Feature], order: ReviewOrder, drives: Sequence[Drive]
) -> list[str]:
    """Ids of features in the order of a review; equals stay as they were given."""
    if order is ReviewOrder.STREET:
        return along_street(features, drives)
    return worst_first(features)


def worst_first(features: Iterable[Feature]) -> list[str]:
    """Ids by rising confidence."""
    return [one.id for one in sorted(features, key=lambda one: one.provenance.confidence)]


def along_street(features: Iterable[Feature], drives: Sequence[Drive]) -> list[str]:
    """Ids as the vehicle passed the features, drive by drive.

    Points are kept in the order in which they were measured, so a feature's place along the street
    is the number of the point near its middle. Of a feature without measured points, or whose drive
    is gone, it is the point that was measured when the vehicle was nearest to it; where no
    trajectory tells that, it comes last.
    """
    members = list(features)
    number_of = {drive.id: number for number, drive in enumerate(drives)}
    keys: dict[str, _Key] = {}
    lost: list[tuple[str, Position]] = []
    for feature in members:
        reference = _reference(feature)
        if reference is not None and reference.drive in number_of:
            keys[feature.id] = (number_of[reference.drive], reference.point)
        else:
            lost.append((feature.id, middle_of(feature).xyz))
    if lost:
        keys.update(_nearest_passed(lost, drives))
    return sorted((one.id for one in members), key=keys.__getitem__)


def _reference(feature: Feature) -> PointReference | None:
    """The measured point of the vertex nearest to the middle vertex that has one."""
    middle = len(feature.vertices) // 2
    measured = [
        (abs(number - middle), number)
        for number, vertex in enumerate(feature.vertices)
        if vertex.measured is not None
    ]
    return feature.vertices[min(measured)[1]].measured if measured else None


def _nearest_passed(
    lost: Sequence[tuple[str, Position]], drives: Sequence[Drive]
) -> dict[str, _Key]:
    from scipy.spatial import cKDTree

    positions = np.array([xyz for _, xyz in lost])
    best = np.full(len(lost), np.inf)
    keys: list[_Key] = [(len(drives), 0)] * len(lost)
    for number, drive in enumerate(drives):
        trajectory = drive.trajectory
        if trajectory is None or not drive.count:
            continue
        found = cKDTree(trajectory.xyz).query(positions)
        distances, nearest = np.asarray(found[0]), np.asarray(found[1])
        points = np.searchsorted(drive.columns["time"], trajectory.time[nearest])
        for one in np.flatnonzero(distances < best).tolist():
            best[one] = distances[one]
            keys[one] = (number, int(points[one]))
    return {id_: key for (id_, _), key in zip(lost, keys, strict=True)}
