"""What became of the last map as candidates of a run, to be judged in the review like any other."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np
from scipy.spatial import cKDTree

from processing.core.errors import UNCHANGED, MissingInput
from processing.core.text import Text
from processing.map.catalogue import CHANGE_KIND, Catalogue
from processing.map.change import Change
from processing.map.feature import (
    AttributeValue,
    Feature,
    Provenance,
    Status,
    Vertex,
    new_feature_id,
)
from processing.map.feature_middle import middle_of
from processing.map.renewal.map_comparison import (
    COMPARISON,
    ChangeName,
    MapComparison,
    MapDifference,
)
from processing.project.project import Project
from processing.project.store.runs import Run, new_run_id

_VERSION = 1
_CHANGE, _WHAT, _MOVED, _MAP = "change", "changed_kind", "moved_m", "last_map"
_SUMMARY = Text(
    "{map}: {new} new, {moved} moved, {gone} gone", "{map}: 新設{new}、移動{moved}、消滅{gone}"
)
_BESIDE = Text("{summary}; {count} had been judged", "{summary}（判定済み{count}件を除く）")
_DECIMALS = 2
_SAME_PLACE_M = 0.1


@dataclass(frozen=True)
class FoundDifferences:
    """A comparison, to be stored as one step.

    Attributes
    ----------
    run : Run
    features : tuple of Feature
        The changes, as candidates.
    comparison : MapComparison
    """

    run: Run
    features: tuple[Feature, ...]
    comparison: MapComparison


def found_differences(
    comparison: MapComparison,
    catalogue: Catalogue,
    now: Iterable[Feature],
    parameters: Mapping[str, AttributeValue],
    started: datetime,
) -> FoundDifferences:
    """The changes as candidates of a run.

    Where the last map has no heights, they are those of the nearest vertices of today's.

    Parameters
    ----------
    now : iterable of Feature
        The map of today.
    parameters : mapping
        ``map`` names the last map's file.
    started : datetime
        With its time zone.

    Raises
    ------
    MissingInput
        The catalogue has no kind for changes.
    """
    if CHANGE_KIND not in catalogue:
        raise MissingInput(
            Text(
                "The project's catalogue has no kind for changes of the map.",
                "プロジェクトのカタログに、変化箇所の種別がありません。",
            ),
            Text.same(CHANGE_KIND),
            Text(
                "Add this kind of the program's own catalogue to the office's. {unchanged}",
                "標準カタログのこの種別を事務所のカタログに追加してください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )
    name = str(parameters["map"])
    summary = summary_of(comparison.differences, name)
    finished = datetime.now().astimezone()
    run = Run(new_run_id(), COMPARISON, _VERSION, parameters, (), started, finished, summary)
    heights = _Heights(now)
    features = tuple(_feature(one, catalogue, run, heights, name) for one in comparison.differences)
    return FoundDifferences(run, features, comparison)


def summary_of(differences: Iterable[MapDifference], name: str) -> Text:
    """What came of a comparison in one line."""
    counts: Counter[ChangeName] = Counter(one.change for one in differences)
    return _SUMMARY.filled(
        map=name, **{each: f"{counts[each]:,}" for each in ("new", "moved", "gone")}
    )


def store_differences(project: Project, found: FoundDifferences) -> Change:
    """Put the changes into a project as one step to be undone.

    Undecided ones of earlier comparisons with the same map go; places that were judged are not
    asked about again.

    Raises
    ------
    NoSpace, InUse, BadFile
        The map is as it was.
    """
    name = found.run.parameters["map"]
    earlier = [
        one
        for one in project.features.all()
        if one.provenance.tool == COMPARISON and one.attributes.get(_MAP) == name
    ]
    judged = [one for one in earlier if one.status is not Status.CANDIDATE]
    added = tuple(one for one in found.features if not _is_known(one, judged))
    removed = tuple(one for one in earlier if one.status is Status.CANDIDATE)
    run = found.run
    if len(added) < len(found.features):
        left = f"{len(found.features) - len(added):,}"
        run = replace(run, summary=_BESIDE.filled(summary=run.summary, count=left))
    change = Change(added=added, removed=removed)
    if change.is_empty:
        project.runs.add(run)
    else:
        project.features.apply(run.summary, change, run=run)
    return change


def _is_known(one: Feature, judged: Iterable[Feature]) -> bool:
    """Whether the same change of the same thing was judged: it begins and ends at its places."""
    said = {name: one.attributes.get(name) for name in (_CHANGE, _WHAT)}
    return any(
        all(other.attributes.get(name) == value for name, value in said.items())
        and other.geometry is one.geometry
        and math.dist(middle_of(other).xyz[:2], middle_of(one).xyz[:2]) <= _SAME_PLACE_M
        for other in judged
    )


class _Heights:
    """Heights for places that the last map gives none."""

    def __init__(self, features: Iterable[Feature]) -> None:
        xyz = [v.xyz for one in features for v in one.vertices if not v.is_occluded]
        self._xyz = np.array(xyz, np.float64).reshape(-1, 3)
        self._tree = cKDTree(self._xyz[:, :2]) if len(self._xyz) else None

    def filled(self, vertices: tuple[Vertex, ...]) -> tuple[Vertex, ...]:
        lacks = all(one.is_occluded or one.xyz[2] == 0.0 for one in vertices)
        if self._tree is None or not lacks:
            return vertices
        _, near = self._tree.query(np.array([one.xyz[:2] for one in vertices]))
        return tuple(
            Vertex((*one.xyz[:2], float(self._xyz[at, 2])), is_occluded=True)
            for one, at in zip(vertices, np.atleast_1d(near).tolist(), strict=True)
        )


def _feature(
    one: MapDifference, catalogue: Catalogue, run: Run, heights: _Heights, name: str
) -> Feature:
    attributes: dict[str, AttributeValue] = {
        _CHANGE: one.change,
        _WHAT: catalogue[one.kind].layer,
        _MAP: name,
    }
    if not math.isnan(one.distance_m):
        attributes[_MOVED] = round(one.distance_m, _DECIMALS)
    return Feature(
        new_feature_id(),
        CHANGE_KIND,
        one.geometry,
        heights.filled(one.vertices) if one.change == "gone" else one.vertices,
        attributes,
        Status.CANDIDATE,
        Provenance(COMPARISON, _VERSION, run.parameters, one.confidence, run.id),
    )
