"""M, M&A and M&A&I: a forest on each, and the choice between them for each class.

References
----------
Takahashi 2022, sections 4.6.3 (the final forest) and 4.7 (the choice for each class).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.laboratory.class_training.forests import fitted_forest, mean_f, whole_score
from processing.laboratory.class_training.point_samples import PointSample
from processing.scoring.points.point_scores import PointScore

_GROUND, _ROAD = 2, 11

_MOST_LEARNT = 12_000
"""Points of a forest: one of 250 features then takes half a minute of a core."""


@dataclass(frozen=True)
class Described:
    """A sample with the features of one kind of forest, by name of the kind.

    Attributes
    ----------
    sample : PointSample
    rows : mapping of str to (k, f) float32
    """

    sample: PointSample
    rows: Mapping[str, NDArray[np.float32]]


@dataclass(frozen=True)
class Forests:
    """A forest for each kind of features, learnt from the same points.

    Attributes
    ----------
    codes : (c,) uint8
        Classes, ground as road.
    forests : mapping of str to forest
    """

    codes: NDArray[np.uint8]
    forests: Mapping[str, Any]  # scikit-learn's classes have no types

    @staticmethod
    def of(learnt: Sequence[Described], known: Forests | None = None) -> Forests:
        """Learn from samples of streets; kinds that are known needn't be learnt again."""
        codes = np.concatenate([_joined(one.sample.codes) for one in learnt])
        some = np.random.default_rng(0).permutation(codes.size)[:_MOST_LEARNT]
        forests = dict(known.forests) if known else {}
        for kind in learnt[0].rows:
            if kind not in forests:
                rows = np.concatenate([one.rows[kind] for one in learnt])
                forests[kind] = fitted_forest(rows[some], codes[some])
        return Forests(np.unique(codes[some]), forests)

    def without(self, kind: str) -> Forests:
        """The others."""
        return Forests(
            self.codes, {name: one for name, one in self.forests.items() if name != kind}
        )

    def shares(self, asked: Described) -> dict[str, Floats]:
        """By kind, (k, c): how likely each class is for each point."""
        return {
            kind: forest.predict_proba(asked.rows[kind]) for kind, forest in self.forests.items()
        }


def best_kinds(
    scores: Mapping[str, PointScore], codes: Sequence[int], kinds: Sequence[str]
) -> list[str]:
    """For each class the kind whose forest had the best F; the last one of a class not met."""
    of_kind = {kind: f_of_classes(score) for kind, score in scores.items()}
    return [
        max(reversed(kinds), key=lambda kind, code=code: of_kind[kind].get(code, 0.0))  # type: ignore[misc]  # mypy knows no defaults of lambdas
        for code in codes
    ]


def chosen_shares(shares: Mapping[str, Floats], chosen: Sequence[str]) -> Floats:
    """(k, c) how likely each class is, as the forest says that was chosen for it."""
    return np.stack([shares[kind][:, at] for at, kind in enumerate(chosen)], axis=1)


def score_of(sample: PointSample, codes: NDArray[np.uint8], shares: Floats) -> PointScore:
    """The score of a street if every point is of the class that is likeliest."""
    counts = dict(sample.counts)
    counts[_ROAD] = counts.get(_ROAD, 0) + counts.pop(_GROUND, 0)
    found: NDArray[np.uint8] = codes[shares.argmax(axis=1)]
    return whole_score(_joined(sample.codes), found, counts)


def f_of_classes(score: PointScore) -> dict[int, float]:
    """F of each class by its code."""
    return {int(one.id): one.counts.f_measure for one in score.classes if one.id.isdigit()}


def mean_f_of(score: PointScore) -> float:
    """Mean F, ground and road as one."""
    return mean_f(score)


def _joined(codes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Ground as road."""
    return np.where(codes == _GROUND, _ROAD, codes).astype(np.uint8)
