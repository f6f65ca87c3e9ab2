"""A tool that runs again: which of its earlier candidates go, and what isn't proposed once more.

Candidates that nobody decided on are replaced by those of the new run. What a person accepted,
rejected or corrected stays, and the new run is silent about those places. What was deleted is
proposed again: who clears a run's undecided candidates away says nothing of their places, and to
say no to one is to reject it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Status
from processing.project.evaluation.run_evaluation import was_corrected
from processing.project.project import Project
from processing.project.results.found_features import Beside, FoundFeatures, summary_of
from processing.project.store.runs import Run

SAME_POINT_M = 0.5
"""How far apart two finds of one thing lie at most: the distance within which poles are scored.
Plates on one post hang further apart."""

SAME_LINE_M = 0.2
"""The same across a line: twice the tolerance by which curbs are scored. Wires of one line hang
further apart."""

SAME_LEVEL_M = 1.0
"""Areas whose heights differ more lie above each other: a bridge and the road below it."""

COVERED = 0.5
"""More of a line lies on what was decided, or of the smaller of two areas within the other."""

_THING_OF_KIND = {"mirror": "pole"}
"""Kinds that may be one thing, under the kind of one of them: a mirror was found as the pole that
carries it before it had a kind of its own, and who took one for the other decided about both."""

_STEP_M = 0.1
_FLAT_M2 = 1e-6

Floats = NDArray[np.float64]


def with_earlier_decisions(found: FoundFeatures, project: Project) -> FoundFeatures:
    """What a run found, as it goes on the map of a project on which its tool ran before.

    Parameters
    ----------
    found : FoundFeatures
        Of a run that isn't stored yet; one without candidates is given back as it is.

    Returns
    -------
    FoundFeatures
        The change removes what the run replaces and adds what is new; its summary says so.

    Raises
    ------
    BadFile
        The project's history is damaged.
    """
    if not found.tool.gives_candidates:
        return found
    runs = project.runs.all()
    earlier = _Earlier.of(found, project, runs)
    is_known = are_known(found.change.added, earlier.decided)
    added = tuple(one for one, known in zip(found.change.added, is_known, strict=True) if not known)
    beside = Beside(
        replaced=len(earlier.replaced),
        decided=sum(is_known),
        kept=sum(are_known(earlier.replaced, added)),
        new=len(added) - sum(are_known(added, earlier.replaced)),
    )
    summary = summary_of(found.tool, len(added), found.note, beside)
    change = replace(found.change, added=added, removed=earlier.replaced)
    return replace(found, run=replace(found.run, summary=summary), change=change)


def runs_before(run: Run, runs: Iterable[Run]) -> tuple[Run, ...]:
    """Earlier runs of the same tool whose decided candidates a run doesn't propose again.

    Parameters
    ----------
    runs : iterable of Run
        In their order, with or without the run itself.
    """
    before = []
    for one in runs:
        if one.id == run.id:
            break
        if one.tool == run.tool and set(one.drives) & set(run.drives):
            before.append(one)
    return tuple(before)


@dataclass(frozen=True)
class _Earlier:
    """What earlier runs left on the map.

    Attributes
    ----------
    replaced : tuple of Feature
        Undecided, of runs on no other drives that looked for the same.
    decided : list of Feature
        As they are and as they were found: a corrected one is known at both places.
    """

    replaced: tuple[Feature, ...]
    decided: list[Feature]

    @staticmethod
    def of(found: FoundFeatures, project: Project, runs: Iterable[Run]) -> _Earlier:
        before = {run.id: run for run in runs_before(found.run, runs)}
        originals = {one.id: one for run in before for one in project.history.additions_of(run)}
        replaced: list[Feature] = []
        decided: list[Feature] = []
        for feature in project.features.all():
            run = before.get(feature.provenance.run)
            if run is None:
                continue
            original = originals.get(feature.id)
            # What the history doesn't know was cut off from a candidate by hand.
            is_touched = original is None or was_corrected(feature, original)
            if feature.status is not Status.CANDIDATE or is_touched:
                decided.extend(one for one in (feature, original) if one is not None)
            elif _replaces(found, run):
                replaced.append(feature)
        return _Earlier(tuple(replaced), decided)


def _replaces(found: FoundFeatures, run: Run) -> bool:
    """Whether the new run was on all drives of an earlier one, and looked for the same."""
    is_same = all(
        found.run.parameters.get(one) == run.parameters.get(one) for one in found.tool.sought
    )
    return is_same and set(run.drives) <= set(found.run.drives)


def are_known(features: Sequence[Feature], decided: Iterable[Feature]) -> list[bool]:
    """Of each feature, whether one of the decided may be the same thing and is at its place.

    It is where its kind is the same, or may be: a mirror and the pole that carries it.

    A point: within :data:`SAME_POINT_M`. A line: more than half of it within
    :data:`SAME_LINE_M` of decided lines. An area: it shares more than half of the smaller one's
    plan with a decided one at its level; one that stands upright is compared by its outline.
    Heights count everywhere.
    """
    groups: dict[tuple[str, Geometry], tuple[list[int], list[Floats], list[Floats]]] = {}
    for number, feature in enumerate(features):
        geometry, xyz = _compared(feature)
        numbers, new, _ = groups.setdefault((_thing_of(feature), geometry), ([], [], []))
        numbers.append(number)
        new.append(xyz)
    for feature in decided:
        geometry, xyz = _compared(feature)
        if (_thing_of(feature), geometry) in groups:
            groups[_thing_of(feature), geometry][2].append(xyz)
    known = [False] * len(features)
    for (_, geometry), (numbers, new, old) in groups.items():
        if old:
            for number, is_known in zip(numbers, _KNOWN[geometry](new, old), strict=True):
                known[number] = bool(is_known)
    return known


def _thing_of(feature: Feature) -> str:
    return _THING_OF_KIND.get(feature.kind, feature.kind)


def _compared(feature: Feature) -> tuple[Geometry, Floats]:
    """By what a feature is compared, and its places."""
    xyz = np.array([vertex.xyz for vertex in feature.vertices], np.float64)
    is_area = feature.geometry is Geometry.AREA
    if is_area and shapely.polygons(xyz[:, :2]).buffer(0).area <= _FLAT_M2:
        return Geometry.LINE, np.vstack([xyz, xyz[:1]])
    return feature.geometry, xyz


def _points_known(new: Sequence[Floats], old: Sequence[Floats]) -> NDArray[np.bool_]:
    off_m, _ = cKDTree(np.vstack(old)).query(np.vstack(new))
    return np.asarray(off_m <= SAME_POINT_M)


def _lines_known(new: Sequence[Floats], old: Sequence[Floats]) -> NDArray[np.bool_]:
    tree = cKDTree(np.vstack([_along(line) for line in old]))
    covered = [np.mean(tree.query(_along(line))[0] <= SAME_LINE_M) for line in new]
    return np.array(covered) > COVERED


def _along(line: Floats) -> Floats:
    """Places at even steps along a line in space, its ends included."""
    ends = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    at = np.linspace(0.0, ends[-1], int(ends[-1] / _STEP_M) + 2)
    return np.column_stack([np.interp(at, ends, axis) for axis in line.T])


def _areas_known(new: Sequence[Floats], old: Sequence[Floats]) -> NDArray[np.bool_]:
    rings = [
        np.array([shapely.Polygon(ring[:, :2]).buffer(0) for ring in one]) for one in (new, old)
    ]
    levels = [np.array([ring[:, 2].mean() for ring in one]) for one in (new, old)]
    of_new, of_old = shapely.STRtree(rings[1]).query(rings[0], predicate="intersects")
    ours, theirs = rings[0][of_new], rings[1][of_old]
    shared = shapely.area(shapely.intersection(ours, theirs))
    smaller = np.minimum(shapely.area(ours), shapely.area(theirs))
    is_level = np.abs(levels[0][of_new] - levels[1][of_old]) <= SAME_LEVEL_M
    known = np.zeros(len(new), np.bool_)
    known[of_new[is_level & (shared > COVERED * smaller)]] = True
    return known


_Known = Callable[[Sequence[Floats], Sequence[Floats]], NDArray[np.bool_]]
_KNOWN: Mapping[Geometry, _Known] = {
    Geometry.POINT: _points_known,
    Geometry.LINE: _lines_known,
    Geometry.AREA: _areas_known,
}
