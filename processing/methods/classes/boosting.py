"""More trees for a forest of classes, from examples: what it said before is where they start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.classes.class_trees import class_shares
from processing.methods.classes.tree_growing import (
    CUT,
    FEATURE,
    LEFT,
    RIGHT,
    GrownTree,
    GrowthLimits,
    grow_tree,
)
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.tree_files import Forest
from processing.methods.noise.trees import Trees

_BINS = 64
"""Of each feature's values."""

AS_SAID = 0
"""The code of an example that is to stay as likely of each class as a forest says."""

_BALANCE = 0.5
"""Power of a class's share by which it counts."""

_LEAST_SHARE = 1e-6
"""How likely a class is at least that trees said is none; also what a class starts from that they
never met."""


@dataclass(frozen=True)
class BoostingLimits:
    """How many rounds of a tree for each class, and how far each may go."""

    rounds: int
    tree: GrowthLimits


@dataclass(frozen=True)
class ClassExamples:
    """Rows of features whose class is known, or is to stay what a forest says.

    Attributes
    ----------
    rows : (n, f) float32
    codes : (n,) uint8
        :data:`AS_SAID` where a forest is held to what it says.
    weights : (n,) float64
        How much each counts.
    """

    rows: NDArray[np.float32]
    codes: NDArray[np.uint8]
    weights: Floats

    def __len__(self) -> int:
        return self.codes.size

    def of(self, chosen: NDArray[np.bool_]) -> ClassExamples:
        """Some of them."""
        return ClassExamples(self.rows[chosen], self.codes[chosen], self.weights[chosen])

    @staticmethod
    def alike(rows: NDArray[np.float32], codes: NDArray[np.uint8]) -> ClassExamples:
        """Examples that all count the same."""
        return ClassExamples(rows, codes, np.ones(codes.size))

    @staticmethod
    def joined(parts: Sequence[ClassExamples]) -> ClassExamples:
        """Several together, one at least."""
        return ClassExamples(
            np.concatenate([one.rows for one in parts]),
            np.concatenate([one.codes for one in parts]),
            np.concatenate([one.weights for one in parts]),
        )

    def as_said(self) -> ClassExamples:
        """The same, each to stay as likely of each class as a forest says."""
        return ClassExamples(self.rows, np.full_like(self.codes, AS_SAID), self.weights)

    def weighed(self, total: float) -> ClassExamples:
        """The same, with weights of so much in all; a class counts by the root of its share.

        Between as frequent as it is and all alike, as the shipped models were made.
        """
        weights = self.weights.copy()
        for code in np.unique(self.codes):
            own = self.codes == code
            weights[own] *= weights[own].sum() ** -_BALANCE
        return ClassExamples(
            self.rows, self.codes, weights * (total / max(weights.sum(), _LEAST_SHARE))
        )


def boosted_further(
    forest: Forest, examples: ClassExamples, limits: BoostingLimits, monitor: Monitor
) -> Forest:
    """A forest with more trees, which correct what it says of examples.

    Classes that it didn't know are added.

    Raises
    ------
    Cancelled
    """
    codes = np.setdiff1d(np.union1d(forest.codes, examples.codes), [AS_SAID]).astype(np.uint8)
    known = np.searchsorted(codes, forest.codes)
    shares = np.zeros((len(examples), codes.size))
    shares[:, known] = class_shares(forest, examples.rows, monitor)
    said = np.log(np.maximum(shares, _LEAST_SHARE))
    wanted = np.where(examples.codes[:, None] == AS_SAID, shares, examples.codes[:, None] == codes)
    weights = examples.weights * (len(examples) / examples.weights.sum())
    edges = _edges_of(examples)
    bins = _bins_of(examples.rows, edges)
    grown: list[GrownTree] = []
    for done in range(limits.rounds):
        monitor.report(done / limits.rounds)
        grown += _round(bins, said, wanted, weights, limits.tree, monitor=monitor)
    bases = np.full(codes.size, _base_of_unmet(forest))
    bases[known] = forest.bases
    return _with_trees(forest, codes, bases, grown, edges)


def _round(
    bins: NDArray[np.uint8],
    said: Floats,
    wanted: Floats,
    weights: Floats,
    limits: GrowthLimits,
    *,
    monitor: Monitor,
) -> list[GrownTree]:
    """A tree for each class; ``said`` (n, k) gets what they add to come nearer to it."""
    likely = np.exp(said - said.max(axis=1, keepdims=True))
    likely /= likely.sum(axis=1, keepdims=True)
    found: dict[int, GrownTree] = {}

    def grow(start: int, stop: int) -> None:
        for which in range(start, stop):
            share = likely[:, which]
            gradients = weights * (share - wanted[:, which])
            curvatures = weights * share * (1.0 - share)
            found[which], added = grow_tree(bins, gradients, curvatures, limits)
            said[:, which] += added

    share_out(grow, said.shape[1], 1, monitor)
    return [found[which] for which in range(said.shape[1])]


def _edges_of(examples: ClassExamples) -> list[NDArray[np.float32]]:
    """Where each feature's bins end: as much weight of examples in each, as far as they differ."""
    order_of = np.argsort(examples.rows, axis=0, kind="stable")
    edges = []
    for feature in range(examples.rows.shape[1]):
        order = order_of[:, feature]
        values = examples.rows[order, feature]
        reached = np.cumsum(examples.weights[order])
        wanted = np.linspace(0.0, reached[-1], _BINS + 1)[1:-1]
        places = np.minimum(np.searchsorted(reached, wanted), values.size - 1)
        ends = np.unique(values[places])
        edges.append(ends[np.isfinite(ends)])
    return edges


def _bins_of(rows: NDArray[np.float32], edges: list[NDArray[np.float32]]) -> NDArray[np.uint8]:
    """(f, n) the bin of each value; a missing one is in the last, since NaN goes right."""
    bins = np.empty((rows.shape[1], rows.shape[0]), np.uint8)
    for feature, ends in enumerate(edges):
        bins[feature] = np.searchsorted(ends, rows[:, feature], side="left")
    return bins


def _base_of_unmet(forest: Forest) -> float:
    """What a class starts from that the forest never met."""
    return float(forest.bases.min()) + float(np.log(_LEAST_SHARE))


def _with_trees(
    forest: Forest,
    codes: NDArray[np.uint8],
    bases: Floats,
    grown: list[GrownTree],
    edges: list[NDArray[np.float32]],
) -> Forest:
    old = forest.trees
    starts = np.cumsum([old.features.size, *(one.values.size for one in grown)])[:-1]
    nodes = np.concatenate([one.nodes for one in grown])
    firsts = np.repeat(starts, [one.values.size for one in grown])
    values = np.concatenate([one.values for one in grown])
    is_leaf = nodes[:, FEATURE] < 0
    cuts = [
        value if feature < 0 else float(edges[feature][cut])
        for feature, cut, value in zip(
            nodes[:, FEATURE].tolist(), nodes[:, CUT].tolist(), values.tolist(), strict=True
        )
    ]
    trees = Trees(
        np.concatenate([old.features, nodes[:, FEATURE]]).astype(np.int32),
        # As the file holds them.
        np.concatenate([old.thresholds, cuts]).astype(np.float32).astype(np.float64),
        np.concatenate([old.lefts, np.where(is_leaf, 0, firsts + nodes[:, LEFT])]).astype(np.int32),
        np.concatenate([old.rights, np.where(is_leaf, 0, firsts + nodes[:, RIGHT])]).astype(
            np.int32
        ),
        np.concatenate([old.roots, starts]).astype(np.int32),
        old.base,
    )
    places = np.searchsorted(codes, forest.codes)
    new = np.arange(len(grown)) % codes.size
    class_of = np.concatenate([places[forest.class_of], new]).astype(np.int32)
    return Forest(trees, class_of, bases.astype(np.float32).astype(np.float64), codes)
