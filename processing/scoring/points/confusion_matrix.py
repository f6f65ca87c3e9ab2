"""Two classifications of the same points compared: counts, and what is computed from them.

A :class:`ConfusionMatrix` has any number of classes. A question with two answers, such as noise or
ground, is the case where some classes stand against all others
(:meth:`ConfusionMatrix.against_rest`). Which class is called positive decides what precision and
recall mean, so nothing here has a positive class of its own: a :class:`BinaryConfusionMatrix` is
made for named codes, and :meth:`BinaryConfusionMatrix.turned` is the same for all other codes.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

CODES = 256


@dataclass(frozen=True)
class BinaryConfusionMatrix:
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
    Kogure et al. 2022 (road surface), equations 1 to 3; Sakurai et al., table 2.
    """

    hits: int
    false_alarms: int
    misses: int
    rejections: int

    @staticmethod
    def of(is_true: NDArray[np.bool_], is_found: NDArray[np.bool_]) -> BinaryConfusionMatrix:
        """Count a block of points: (n,) bool each, whether a point is positive and is called so."""
        true, found = int(np.count_nonzero(is_true)), int(np.count_nonzero(is_found))
        hits = int(np.count_nonzero(is_true & is_found))
        return BinaryConfusionMatrix(
            hits, found - hits, true - hits, is_true.size - true - found + hits
        )

    def __add__(self, other: BinaryConfusionMatrix) -> BinaryConfusionMatrix:
        return BinaryConfusionMatrix(
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

    def turned(self) -> BinaryConfusionMatrix:
        """The same with the other class positive."""
        return BinaryConfusionMatrix(self.rejections, self.misses, self.false_alarms, self.hits)

    def if_nothing_was_positive(self) -> BinaryConfusionMatrix:
        """What the same truth would give a method that calls no point positive."""
        return BinaryConfusionMatrix(
            0, 0, self.hits + self.misses, self.false_alarms + self.rejections
        )


@dataclass(frozen=True, eq=False)
class ConfusionMatrix:
    """How many points of each true class got which class; added up over blocks of any size.

    Attributes
    ----------
    codes : tuple of int
        Codes of the n classes, rising.
    counts : (n, n) int64
        By true class, then by the result's.

    References
    ----------
    Congalton 1991, Remote Sensing of Environment 37(1): the error matrix, with the accuracies that
    follow from it. There, precision is called user's accuracy and recall producer's accuracy.
    """

    codes: tuple[int, ...] = ()
    counts: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 0), np.int64))

    def __post_init__(self) -> None:
        """Refuse counts of other classes than are named.

        Raises
        ------
        ValueError
        """
        if self.counts.shape != (len(self.codes), len(self.codes)):
            message = f"counts of shape {self.counts.shape} for {len(self.codes)} classes"
            raise ValueError(message)

    @staticmethod
    def of(truth: NDArray[np.uint8], result: NDArray[np.uint8]) -> ConfusionMatrix:
        """Count a block of points, with the classes that it has on either side.

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
        counted = np.bincount(pairs, minlength=CODES * CODES).astype(np.int64)
        return _of_classes_met(np.arange(CODES), counted.reshape(CODES, CODES))

    def __add__(self, other: ConfusionMatrix) -> ConfusionMatrix:
        codes = tuple(sorted({*self.codes, *other.codes}))
        counts = np.zeros((len(codes), len(codes)), np.int64)
        for one in (self, other):
            places = np.searchsorted(codes, one.codes)
            counts[np.ix_(places, places)] += one.counts
        return ConfusionMatrix(codes, counts)

    @property
    def count(self) -> int:
        """All points."""
        return int(self.counts.sum())

    @property
    def true_counts(self) -> NDArray[np.int64]:
        """Points of each true class: (n,) int64."""
        counts: NDArray[np.int64] = self.counts.sum(axis=1)
        return counts

    @property
    def found_counts(self) -> NDArray[np.int64]:
        """Points that were given each class: (n,) int64."""
        counts: NDArray[np.int64] = self.counts.sum(axis=0)
        return counts

    @property
    def precision(self) -> NDArray[np.float64]:
        """Share of those given a class that are of it: (n,); NaN where none was given it."""
        return _shares(self.counts.diagonal(), self.found_counts)

    @property
    def recall(self) -> NDArray[np.float64]:
        """Share of those of a class that were given it: (n,); NaN where there are none."""
        return _shares(self.counts.diagonal(), self.true_counts)

    @property
    def f_measure(self) -> NDArray[np.float64]:
        """Harmonic mean of both: (n,); NaN for a class that neither side has."""
        return _shares(2 * self.counts.diagonal(), self.true_counts + self.found_counts)

    @property
    def mean_f(self) -> float:
        """Mean F-measure of the classes that the truth has; NaN without points."""
        return self.mean_f_of(self.codes)

    def mean_f_of(self, codes: Collection[int]) -> float:
        """Mean F-measure of those of some classes that the truth has; NaN where it has none."""
        is_chosen = np.isin(self.codes, sorted(codes)) & (self.true_counts > 0)
        return float(self.f_measure[is_chosen].mean()) if is_chosen.any() else math.nan

    @property
    def overall_accuracy(self) -> float:
        """Share of all points that have their true class; NaN without points."""
        return _share(int(self.counts.trace()), self.count)

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
        by_chance = float((self.true_counts / whole) @ (self.found_counts / whole))
        return (self.overall_accuracy - by_chance) / (1 - by_chance) if by_chance < 1 else math.nan

    def without_true(self, codes: Collection[int]) -> ConfusionMatrix:
        """The same without the points of some true classes."""
        counts = self.counts.copy()
        counts[np.isin(self.codes, sorted(codes))] = 0
        return _of_classes_met(np.array(self.codes, np.int64), counts)

    def balanced(self, codes: Collection[int], each: int) -> ConfusionMatrix:
        """The same for as many points of each of some true classes, those of others left out.

        As if so many had been drawn of each: precision no longer follows from how frequent a class
        is on the street at hand.

        Parameters
        ----------
        each : int
            Points of a class.
        """
        kept = self.counts * np.isin(self.codes, sorted(codes))[:, None]
        total = kept.sum(axis=1, keepdims=True)
        drawn = np.rint(kept * (each / np.maximum(total, 1))).astype(np.int64)
        return _of_classes_met(np.array(self.codes, np.int64), drawn)

    def pairs(self, truth: Collection[int], result: Collection[int]) -> int:
        """Points whose true code is one of some, and the result's one of others."""
        is_true, is_found = (np.isin(self.codes, sorted(codes)) for codes in (truth, result))
        return int(self.counts[np.ix_(is_true, is_found)].sum())

    def against_rest(self, positive: Collection[int]) -> BinaryConfusionMatrix:
        """Two classes alone: some codes as the positive one, and all others against them."""
        is_positive = np.isin(self.codes, sorted(positive))
        true, found = self.true_counts[is_positive].sum(), self.found_counts[is_positive].sum()
        hits = int(self.counts[np.ix_(is_positive, is_positive)].sum())
        return BinaryConfusionMatrix(
            hits=hits,
            false_alarms=int(found) - hits,
            misses=int(true) - hits,
            rejections=self.count - int(true) - int(found) + hits,
        )


def is_one_of(codes: NDArray[np.uint8], chosen: Collection[int]) -> NDArray[np.bool_]:
    """Which points have one of some codes: (n,) bool for (n,) uint8."""
    table = np.zeros(CODES, np.bool_)
    table[list(chosen)] = True
    found: NDArray[np.bool_] = table[codes]
    return found


def _share(hits: int, of: int) -> float:
    return hits / of if of else math.nan


def _shares(hits: NDArray[np.int64], of: NDArray[np.int64]) -> NDArray[np.float64]:
    shares = np.full(of.shape, math.nan)
    np.divide(hits, of, out=shares, where=of > 0)
    return shares


def _of_classes_met(codes: NDArray[np.int64], counts: NDArray[np.int64]) -> ConfusionMatrix:
    """Counts of the classes alone that points have on either side."""
    met = np.flatnonzero(counts.any(axis=0) | counts.any(axis=1))
    return ConfusionMatrix(tuple(codes[met].tolist()), counts[np.ix_(met, met)])
