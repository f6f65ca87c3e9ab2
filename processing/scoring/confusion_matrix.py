"""Two classifications of the same points compared: counts, and what is computed from them.

Which class is called positive decides what precision and recall mean, so nothing here has a
positive class of its own: a :class:`ConfusionMatrix` is made for named codes, and
:meth:`ConfusionMatrix.turned` is the same for all other codes.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

CODES = 256


@dataclass(frozen=True)
class ConfusionMatrix:
    """How points of a positive class and all others were classified.

    Attributes
    ----------
    hits : int
        Positive, and classified so (TP).
    false_alarms : int
        Classified positive, but are not (FP).
    misses : int
        Positive, but not classified so (FN).
    rejections : int
        Neither (TN).

    References
    ----------
    Specification noise_ground.md, A5: equations 1 to 3 of the road-surface study; B4.
    """

    hits: int
    false_alarms: int
    misses: int
    rejections: int

    @staticmethod
    def of(is_true: NDArray[np.bool_], is_found: NDArray[np.bool_]) -> ConfusionMatrix:
        """Count a block of points: (n,) bool each, whether a point is positive and is called so."""
        true, found = int(np.count_nonzero(is_true)), int(np.count_nonzero(is_found))
        hits = int(np.count_nonzero(is_true & is_found))
        return ConfusionMatrix(hits, found - hits, true - hits, is_true.size - true - found + hits)

    def __add__(self, other: ConfusionMatrix) -> ConfusionMatrix:
        return ConfusionMatrix(
            self.hits + other.hits,
            self.false_alarms + other.false_alarms,
            self.misses + other.misses,
            self.rejections + other.rejections,
        )

    @property
    def count(self) -> int:
        """All points."""
        return self.hits + self.false_alarms + self.misses + self.rejections

    @property
    def precision(self) -> float:
        """Share of those classified positive that are (eq. 1); NaN where none was."""
        return _share(self.hits, self.hits + self.false_alarms)

    @property
    def recall(self) -> float:
        """Share of the positive that were classified so (eq. 2); NaN where there are none."""
        return _share(self.hits, self.hits + self.misses)

    @property
    def f_measure(self) -> float:
        """Harmonic mean of both (eq. 3); 0 where nothing was hit, NaN where nothing could be."""
        return _share(2 * self.hits, 2 * self.hits + self.false_alarms + self.misses)

    @property
    def total_error(self) -> float:
        """Share of all points that are classified wrong; NaN without points."""
        return _share(self.false_alarms + self.misses, self.count)

    @property
    def kappa(self) -> float:
        """Agreement beyond chance; NaN where chance alone agrees wholly.

        References
        ----------
        Cohen 1960, Educational and Psychological Measurement 20(1), equation 1.
        """
        if not self.count:
            return math.nan
        whole = float(self.count)
        called, true = self.hits + self.false_alarms, self.hits + self.misses
        by_chance = called / whole * (true / whole) + (1 - called / whole) * (1 - true / whole)
        agreed = (self.hits + self.rejections) / whole
        return (agreed - by_chance) / (1 - by_chance) if by_chance < 1 else math.nan

    def turned(self) -> ConfusionMatrix:
        """The same with the other class positive."""
        return ConfusionMatrix(self.rejections, self.misses, self.false_alarms, self.hits)

    def if_nothing_was_positive(self) -> ConfusionMatrix:
        """What the same truth would give a method that calls no point positive."""
        return ConfusionMatrix(0, 0, self.hits + self.misses, self.false_alarms + self.rejections)


@dataclass(frozen=True)
class ClassCounts:
    """How many points of each true code got which code; added up over blocks of any size.

    Attributes
    ----------
    table : (256, 256) int64
        By true code, then by the result's.
    """

    table: NDArray[np.int64] = field(default_factory=lambda: np.zeros((CODES, CODES), np.int64))

    @staticmethod
    def of(truth: NDArray[np.uint8], result: NDArray[np.uint8]) -> ClassCounts:
        """Count a block of points.

        Parameters
        ----------
        truth, result : (n,) uint8
            Codes of the same points.

        Raises
        ------
        ValueError
            The arrays are not of one length.
        """
        if truth.shape != result.shape:
            message = f"{truth.shape} true codes for {result.shape} of the result"
            raise ValueError(message)
        pairs = truth.astype(np.intp) * CODES + result
        counted = np.bincount(pairs, minlength=CODES * CODES)
        return ClassCounts(counted.astype(np.int64).reshape(CODES, CODES))

    def __add__(self, other: ClassCounts) -> ClassCounts:
        return ClassCounts(self.table + other.table)

    @property
    def count(self) -> int:
        """All points."""
        return int(self.table.sum())

    def pairs(self, truth: Collection[int], result: Collection[int]) -> int:
        """Points whose true code is one of some, and the result's one of others."""
        return int(self.table[np.ix_(sorted(truth), sorted(result))].sum())

    def confusion_matrix(self, positive: Collection[int]) -> ConfusionMatrix:
        """Counts with some codes as the positive class, and all others against them."""
        codes = frozenset(positive)
        others = frozenset(range(CODES)) - codes
        return ConfusionMatrix(
            hits=self.pairs(codes, codes),
            false_alarms=self.pairs(others, codes),
            misses=self.pairs(codes, others),
            rejections=self.pairs(others, others),
        )


def is_one_of(codes: NDArray[np.uint8], chosen: Collection[int]) -> NDArray[np.bool_]:
    """Which points have one of some codes: (n,) bool for (n,) uint8."""
    table = np.zeros(CODES, np.bool_)
    table[list(chosen)] = True
    found: NDArray[np.bool_] = table[codes]
    return found


def _share(hits: int, of: int) -> float:
    return hits / of if of else math.nan
