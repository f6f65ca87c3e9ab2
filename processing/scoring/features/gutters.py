"""Covered gutters against a truth: by slots along the gutter, and lid by lid.

The thesis asks in every slot of 0.6 m whether a lid was found (Takahashi 2022, 7.5); that
says nothing of where the lids' joints are, so lids are also compared one to one by the area they
share, by their type and by their corners.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.scoring.features.file_scores import (
    DetectionCounts,
    FileScore,
    errors_of,
    named_share,
)
from processing.scoring.features.gutter_runs import (
    JOINT_M,
    LEAST_SCANNED,
    LEAST_UNCOVERED,
    SLOT_M,
    Areas,
    GutterSlots,
    areas_of,
    is_seen,
    runs_of,
)
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.one_to_one import best_pairs
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

GUTTERS: dict[str, dict[str, object]] = {
    "gutter": {},
    "gutter_lid": {"type": "lid"},
    "gutter_grating": {"type": "grating"},
}
"""Kinds of features that are covers of gutters, with the type that a kind implies."""

TYPES = ("lid", "grating")

LEAST_IOU = 0.5
"""Half of what both cover together: a lid shifted by a third of its length still counts."""

RUN_SHARE = 0.5
"""A run is found if most of its slots are."""

_CORNERS = 4
_NAME = Text("lids of gutters", "側溝蓋")


@dataclass(frozen=True)
class ScoredGutters:
    """What was found, missed and made up, place by place.

    Attributes
    ----------
    found, missed, false : (n, 3) float64
        Middles of slots along true gutters, m.
    beside : tuple of MappedFeature
        Covers of the result that lie on no gutter.
    is_right : tuple of (MappedFeature, bool)
        Covers of the result, and whether each shares enough with a true one of its type, seen or
        not; without those on covers that nobody can see.
    """

    found: Floats
    missed: Floats
    false: Floats
    beside: tuple[MappedFeature, ...]
    is_right: tuple[tuple[MappedFeature, bool], ...]


@dataclass(frozen=True)
class _Pieces:
    """Lids and gratings of both sides, and which were paired."""

    result: Sequence[MappedFeature]
    truth: Sequence[MappedFeature]
    is_asked: NDArray[np.bool_]
    is_on_unseen: NDArray[np.bool_]  # of the result: most of it lies on lids that nobody can see
    pairs: tuple[tuple[int, int], ...]

    def counts(self, kind: str | None = None) -> BinaryConfusionMatrix:
        """Of one type, or of both alike; one taken for the other is a miss and a false alarm."""

        def is_of(feature: MappedFeature) -> bool:
            return kind is None or feature.facts["type"] == kind

        hits = sum(
            self.is_asked[j] and is_of(self.truth[j]) and is_of(self.result[i])
            for i, j in self.pairs
        )
        left_out = {*np.flatnonzero(self.is_on_unseen).tolist()} - {i for i, _ in self.pairs}
        left_out |= {i for i, j in self.pairs if not self.is_asked[j]}
        given = sum(is_of(one) for i, one in enumerate(self.result) if i not in left_out)
        wanted = sum(is_of(one) for j, one in enumerate(self.truth) if self.is_asked[j])
        return BinaryConfusionMatrix(int(hits), int(given - hits), int(wanted - hits), 0)


def gutter_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score covers of gutters.

    Raises
    ------
    BadFile
        Features aren't areas of lids and gratings, or a share is no number.
    """
    pieces, found_areas = _pieces(result, truth)
    found, true, asked = pieces.result, pieces.truth, pieces.is_asked
    runs = runs_of(truth, true)
    slots, found_runs, asked_runs = _slot_counts(runs, found, found_areas)
    right = [(found[i], true[j]) for i, j in pieces.pairs if asked[j]]
    corners = [_corners_off(one.xyz, other.xyz) for one, other in right]
    off = np.concatenate([np.empty((0, 2)), *corners])
    return FileScore(
        "gutters",
        (
            DetectionCounts("slots", Text("0.6 m slots", "0.6m区間"), slots, has_rejections=True),
            DetectionCounts(
                "pieces", Text("lids and gratings", "側溝蓋・グレーチング"), pieces.counts()
            ),
            DetectionCounts("lids", Text("lids", "側溝蓋"), pieces.counts("lid")),
            DetectionCounts("gratings", Text("gratings", "グレーチング"), pieces.counts("grating")),
        ),
        (named_share("runs", ("runs found", "検出した側溝"), found_runs, asked_runs),),
        (
            errors_of("corner_plan", ("corners in plan", "四隅の水平位置"), "m", off[:, 0]),
            errors_of("corner_height", ("corners' height", "四隅の標高"), "m", off[:, 1]),
        ),
        left_out={
            "unseen": int((~asked).sum()),
            "unseen_found": sum(not asked[j] for _, j in pieces.pairs),
            "unseen_slots": sum(int((~run.is_asked).sum()) for run in runs),
        },
        limits={
            "slot_m": SLOT_M,
            "joint_m": JOINT_M,
            "least_iou": LEAST_IOU,
            "run_share": RUN_SHARE,
            "least_uncovered": LEAST_UNCOVERED,
            "least_scanned": LEAST_SCANNED,
        },
    )


def score_gutters(result: MappedFile, truth: MappedFile) -> ScoredGutters:
    """The places behind the counts of :func:`gutter_score`.

    Raises
    ------
    BadFile
        As there.
    """
    pieces, areas = _pieces(result, truth)
    found, missed, false = ([np.empty((0, 3))] for _ in range(3))
    runs = runs_of(truth, pieces.truth)
    for run in runs:
        is_found, _ = _on_run(run, areas)
        found.append(run.slots[run.is_asked & run.has_lid & is_found])
        missed.append(run.slots[run.is_asked & run.has_lid & ~is_found])
        false.append(run.slots[run.is_asked & ~run.has_lid & is_found])
    right = {i for i, j in pieces.pairs if _type(pieces.result[i]) == _type(pieces.truth[j])}
    paired = {i for i, _ in pieces.pairs}
    return ScoredGutters(
        np.vstack(found),
        np.vstack(missed),
        np.vstack(false),
        tuple(_beside_runs(runs, pieces.result, areas)),
        tuple(
            (one, i in right)
            for i, one in enumerate(pieces.result)
            if i in paired or not pieces.is_on_unseen[i]
        ),
    )


def _type(cover: MappedFeature) -> object:
    return cover.facts["type"]


def _pieces(result: MappedFile, truth: MappedFile) -> tuple[_Pieces, Areas]:
    """Covers of both sides, and the result's outlines in plan."""
    found, true = _covers(result), _covers(truth)
    found_areas, true_areas = areas_of(found), areas_of(true)
    asked = np.array([is_seen(truth, one) for one in true], np.bool_)
    on_unseen = _mostly_on(found_areas, true_areas[~asked])
    return _Pieces(
        found, true, asked, on_unseen, _pair_covers(found_areas, true_areas)
    ), found_areas


def _covers(file: MappedFile) -> list[MappedFeature]:
    covers = file.of_kinds(GUTTERS, "area", _NAME)
    for one in covers:
        file.word(one, "type", TYPES)
    return covers


def _pair_covers(found: Areas, true: Areas) -> tuple[tuple[int, int], ...]:
    """Pairs of covers that share enough of their area in plan, one to one."""
    import shapely

    i, j = shapely.STRtree(true).query(found, predicate="intersects")
    shared = shapely.area(shapely.intersection(found[i], true[j]))
    both = shapely.area(found[i]) + shapely.area(true[j]) - shared
    iou = shared / np.maximum(both, 1e-9)
    is_enough = iou >= LEAST_IOU - 1e-9
    # Covers just alike enough gain a little too, so that they count.
    gains = iou[is_enough] - LEAST_IOU + 1e-6
    pairs = best_pairs(i[is_enough], j[is_enough], gains)
    return tuple(zip(*(one.tolist() for one in pairs), strict=True))


def _mostly_on(found: Areas, unseen: Areas) -> NDArray[np.bool_]:
    """(n,) which covers lie mostly on some that no points show, wherever their joints are."""
    import shapely

    i, j = shapely.STRtree(unseen).query(found, predicate="intersects")
    shared = np.bincount(
        i, weights=shapely.area(shapely.intersection(found[i], unseen[j])), minlength=len(found)
    )
    return np.asarray(shared > shapely.area(found) / 2)


def _slot_counts(
    runs: Sequence[GutterSlots], found: Sequence[MappedFeature], areas: Areas
) -> tuple[BinaryConfusionMatrix, int, int]:
    """Slots along all runs and beside them; how many runs were found, and of how many."""
    counts, found_runs, asked_runs = BinaryConfusionMatrix(0, 0, 0, 0), 0, 0
    for run in runs:
        is_found, _ = _on_run(run, areas)
        counts += BinaryConfusionMatrix.of(run.has_lid[run.is_asked], is_found[run.is_asked])
        wanted = run.has_lid & run.is_asked
        asked_runs += bool(wanted.any())
        found_runs += bool(wanted.any() and is_found[wanted].mean() >= RUN_SHARE)
    beside = sum(map(_slots_of, _beside_runs(runs, found, areas)))
    return counts + BinaryConfusionMatrix(0, beside, 0, 0), found_runs, asked_runs


def _on_run(run: GutterSlots, areas: Areas) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which slots of a run have a cover on them, and which covers lie on the run."""
    import shapely

    tree = shapely.STRtree(areas)
    is_found = np.zeros(len(run.slots), np.bool_)
    middles = shapely.points(run.slots[:, :2])
    is_found[tree.query(middles, predicate="dwithin", distance=JOINT_M)[0]] = True
    is_on = np.zeros(len(areas), np.bool_)
    axis = shapely.linestrings(run.axis[:, :2])
    is_on[tree.query(axis, predicate="dwithin", distance=JOINT_M)] = True
    return is_found, is_on


def _beside_runs(
    runs: Sequence[GutterSlots], found: Sequence[MappedFeature], areas: Areas
) -> list[MappedFeature]:
    """Covers that lie on no run."""
    is_on = np.zeros(len(areas), np.bool_)
    for run in runs:
        is_on |= _on_run(run, areas)[1]
    return [one for one, on in zip(found, is_on, strict=True) if not on]


def _slots_of(cover: MappedFeature) -> int:
    """How many slots a cover takes that lies on no gutter."""
    sides = np.roll(cover.xyz, -1, axis=0) - cover.xyz
    return max(1, round(float(np.hypot(*sides[:, :2].T).max()) / SLOT_M))


def _corners_off(found: Floats, true: Floats) -> Floats:
    """(4, 2) distances of corners in plan and their heights' differences, m.

    Corners are paired in the order round the outline, from whichever one and in whichever
    direction fits best; none where a side hasn't four.
    """
    if len(found) != _CORNERS or len(true) != _CORNERS:
        return np.empty((0, 2))
    turned = [
        np.roll(outline, first, axis=0) - true
        for outline in (found, found[::-1])
        for first in range(_CORNERS)
    ]
    best = min(turned, key=lambda off: float(np.hypot(*off[:, :2].T).sum()))
    return np.column_stack([np.hypot(*best[:, :2].T), best[:, 2]])
