"""Truths of simulated streets scored against themselves, as they are and disturbed.

As they are they must score 1; moved, thinned out or changed they must fall as far as the rules of
the score say. A score that stays at 1 would say nothing about a tool.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.formats.vectors.mapped_shapes import read_mapped
from processing.scoring.features.file_scores import FeatureScorer
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.tools.listed.registry import scorers

Disturbance = Callable[[MappedFile], MappedFile]

_OTHER_SHAPES = {"circle": "square", "square": "circle"}


def _make_shift(by_m: float) -> Disturbance:
    def move(truth: MappedFile) -> MappedFile:
        """All together, across the direction in which most of them lie."""
        positions = np.concatenate([one.xyz[:, :2] for one in truth.features])
        across = np.linalg.svd(positions - positions.mean(axis=0), full_matrices=False)[2][-1]
        shift = by_m * np.array([*across, 0.0])
        return _with(truth, [replace(one, xyz=one.xyz + shift) for one in truth.features])

    return move


def _without_each_third(truth: MappedFile) -> MappedFile:
    """Objects without each third one; lines and lids by their runs, as a tool would miss them."""
    runs = [one.facts.get("run", one.number) for one in truth.features]
    order = {run: number for number, run in enumerate(dict.fromkeys(runs))}
    kept = [one for one, run in zip(truth.features, runs, strict=True) if order[run] % 3 != 2]
    return _with(truth, kept)


def _of_other_kinds(truth: MappedFile) -> MappedFile:
    """Lowered curbs as full ones, gratings as lids, plates of another shape, trees by 1.1 thick."""
    changed = []
    for one in truth.features:
        facts = dict(one.facts)
        if facts.get("type") in ("dropped", "grating", "utility_pole"):
            facts["type"] = {"dropped": "curb", "grating": "lid"}.get(str(facts["type"]), "bollard")
        if "shape" in facts:
            facts["shape"] = _OTHER_SHAPES.get(str(facts["shape"]), "square")
        if isinstance(facts.get("dbh_m"), float):
            facts["dbh_m"] = 1.1 * float(str(facts["dbh_m"]))
        changed.append(replace(one, facts=facts))
    return _with(truth, changed)


def _with(truth: MappedFile, features: list[MappedFeature]) -> MappedFile:
    return replace(truth, features=tuple(features))


DISTURBANCES: dict[str, Disturbance] = {
    "as it is": lambda truth: truth,
    "5 cm aside": _make_shift(0.05),
    "30 cm aside": _make_shift(0.3),
    "3 m aside": _make_shift(3.0),
    "each third left out": _without_each_third,
    "of other kinds": _of_other_kinds,
}


def score_disturbed(folder: Path) -> Iterator[list[str]]:
    """Rows of cells, the head first: F-measure per kind of truth and disturbance.

    Parameters
    ----------
    folder : Path
        Truth of a simulated street.
    """
    yield ["truth", "F of", *DISTURBANCES]
    for scorer in (one for one in scorers().values() if isinstance(one, FeatureScorer)):
        truth = read_mapped(folder / f"{scorer.tool}.geojson")
        if not truth.features:
            continue
        scores = [scorer.score(disturb(truth), truth) for disturb in DISTURBANCES.values()]
        for position, counted in enumerate(scores[0].counts):
            values = [one.counts[position].counts.f_measure for one in scores]
            if not np.isnan(values[0]):
                yield [scorer.tool, counted.name.en, *map(_cell, values)]
        for position, share in enumerate(scores[0].shares):
            values = [one.shares[position].share.value for one in scores]
            if not np.isnan(values[0]):
                yield [scorer.tool, f"share: {share.name.en}", *map(_cell, values)]


def _cell(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.3f}"
