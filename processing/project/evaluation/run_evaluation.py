"""How good the runs of a tool were, by what the operator decided and had to draw."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Status
from processing.map.feature_middle import middle_of
from processing.map.measures import length_m
from processing.project.store.runs import Run
from processing.recording.drive import Drive
from processing.scoring.points.reliability import (
    Reliability,
    ShareInterval,
    reliability_of,
    share_of,
)

_HAND = "hand"
_SAME_M = 1e-6


@dataclass(frozen=True)
class RunEvaluation:
    """One run, or all runs of one version of a tool, judged.

    Attributes
    ----------
    tool, version : str, int
    runs : tuple of str
        Ids; one for a single run.
    is_whole_tool : bool
        All runs of this tool and version together.
    undecided, accepted, rejected : int
        Candidates; corrected ones are accepted too. Those that were accepted for their
        confidence alone are undecided: nobody looked at them.
    corrected : int
        Accepted after their place, kind or attributes were changed.
    shift_m : float
        Mean distance of the vertices of corrected ones from where the tool had put the feature;
        NaN where none was moved.
    precision : ShareInterval
        Accepted of all that were decided.
    recall : ShareInterval
        Accepted of accepted and drawn by hand: features of the same kinds, within the drives that
        the tool was run on. The undecided are left out.
    recall_by_length : ShareInterval
        The same in metres, of lines; of nothing where there are none.
    reliability : Reliability
        Of the decided.
    """

    tool: str
    version: int
    runs: tuple[str, ...]
    is_whole_tool: bool
    undecided: int
    accepted: int
    rejected: int
    corrected: int
    shift_m: float
    precision: ShareInterval
    recall: ShareInterval
    recall_by_length: ShareInterval
    reliability: Reliability

    @property
    def drawn(self) -> int:
        """How many features had to be drawn by hand."""
        return round(self.recall.of - self.recall.hits)


def evaluate_runs(
    features: Iterable[Feature],
    runs: Sequence[Run],
    drives: Sequence[Drive],
    originals: Mapping[str, Feature],
) -> tuple[RunEvaluation, ...]:
    """Evaluate every run that has candidates on the map, and each tool over all its runs.

    Parameters
    ----------
    features : iterable of Feature
        All features of the map.
    runs : sequence of Run
    drives : sequence of Drive
        Those of the project; what was drawn by hand counts where a run's drives reach.
    originals : mapping of str to Feature
        Features by id as their run gave them.

    Returns
    -------
    tuple of RunEvaluation
        Each tool, followed by its runs if there are several.
    """
    by_run: dict[str, list[Feature]] = {}
    by_hand = []
    for feature in features:
        if feature.provenance.run:
            by_run.setdefault(feature.provenance.run, []).append(feature)
        elif feature.provenance.tool == _HAND and feature.status is Status.ACCEPTED:
            by_hand.append(feature)
    drawn = _Drawn.of(by_hand)
    groups: dict[tuple[str, int], list[Run]] = {}
    for run in runs:
        if run.id in by_run:
            groups.setdefault((run.tool, run.version), []).append(run)
    found: list[RunEvaluation] = []
    for members in groups.values():
        parts = [members, *([one] for one in members)] if len(members) > 1 else [members]
        found.extend(
            _evaluation(
                part,
                [feature for run in part for feature in by_run[run.id]],
                drawn.within(part, drives),
                originals,
                is_whole_tool=part is members,
            )
            for part in parts
        )
    return tuple(found)


def within_drives(features: Iterable[Feature], run: Run, drives: Sequence[Drive]) -> list[Feature]:
    """Those whose middle lies within the extent of a drive that a run was on."""
    return _Drawn.of(list(features)).within((run,), drives)


def was_corrected(feature: Feature, original: Feature | None) -> bool:
    """Whether place, kind or attributes aren't any longer as the run gave them."""
    return original is not None and (
        [vertex.xyz for vertex in feature.vertices] != [vertex.xyz for vertex in original.vertices]
        or feature.kind != original.kind
        or dict(feature.attributes) != dict(original.attributes)
    )


@dataclass(frozen=True)
class _Drawn:
    """What was drawn by hand, and where."""

    features: list[Feature]
    positions: NDArray[np.float64]  # (n, 2)

    @staticmethod
    def of(features: list[Feature]) -> _Drawn:
        positions = [middle_of(feature).xyz[:2] for feature in features]
        return _Drawn(features, np.array(positions, np.float64).reshape(-1, 2))

    def within(self, runs: Sequence[Run], drives: Sequence[Drive]) -> list[Feature]:
        """Those within the extent of a drive that one of the runs was on."""
        ids = {drive for run in runs for drive in run.drives}
        is_within = np.zeros(len(self.features), bool)
        for drive in drives:
            if drive.id in ids:
                low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
                inside = (self.positions >= low[:2]) & (self.positions <= high[:2])
                is_within |= inside.all(axis=1)
        return [self.features[one] for one in np.flatnonzero(is_within).tolist()]


def _evaluation(
    runs: Sequence[Run],
    features: list[Feature],
    drawn: list[Feature],
    originals: Mapping[str, Feature],
    *,
    is_whole_tool: bool,
) -> RunEvaluation:
    found = [one for one in features if one.status is Status.ACCEPTED]
    accepted = [one for one in found if not one.provenance.unseen]
    rejected = [one for one in features if one.status is Status.REJECTED]
    decided = [*accepted, *rejected]
    kinds = {one.kind for one in (*features, *_originals(features, originals))}
    missed = [one for one in drawn if one.kind in kinds]
    corrected = [one for one in accepted if was_corrected(one, originals.get(one.id))]
    shifts = [_shift_m(one, originals[one.id]) for one in corrected]
    moved = [shift for shift in shifts if shift > _SAME_M]
    length, missing = _length_m(found), _length_m(missed)
    return RunEvaluation(
        tool=runs[0].tool,
        version=runs[0].version,
        runs=tuple(run.id for run in runs),
        is_whole_tool=is_whole_tool,
        undecided=len(features) - len(decided),
        accepted=len(accepted),
        rejected=len(rejected),
        corrected=len(corrected),
        shift_m=float(np.mean(moved)) if moved else math.nan,
        precision=share_of(len(accepted), len(decided)),
        recall=share_of(len(found), len(found) + len(missed)),
        recall_by_length=ShareInterval(length, length + missing),
        reliability=reliability_of(
            np.array([one.provenance.confidence for one in decided], np.float64),
            np.array([one.status is Status.ACCEPTED for one in decided], bool),
        ),
    )


def _originals(features: list[Feature], originals: Mapping[str, Feature]) -> list[Feature]:
    return [originals[one.id] for one in features if one.id in originals]


def _length_m(features: Iterable[Feature]) -> float:
    lines = (one for one in features if one.geometry is Geometry.LINE)
    return sum((length_m([vertex.xyz for vertex in one.vertices]) for one in lines), 0.0)


def _shift_m(feature: Feature, original: Feature) -> float:
    """Mean distance of a feature's vertices from what the original drew."""
    positions = np.array([vertex.xyz for vertex in feature.vertices])
    drawn = np.array([vertex.xyz for vertex in original.vertices])
    if original.geometry is Geometry.AREA:
        drawn = np.concatenate([drawn, drawn[:1]])
    if len(drawn) == 1:
        return float(np.linalg.norm(positions - drawn[0], axis=1).mean())
    starts, steps = drawn[:-1], np.diff(drawn, axis=0)
    squares = np.maximum((steps**2).sum(axis=1), 1e-12)
    ways = positions[:, None] - starts[None]
    shares = np.clip((ways * steps).sum(axis=2) / squares, 0.0, 1.0)
    away = ways - shares[..., None] * steps
    return float(np.linalg.norm(away, axis=2).min(axis=1).mean())
