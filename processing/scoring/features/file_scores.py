"""What is said of a result that is no point cloud: counts, shares, errors, and the limits used."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from processing.core.text import Text
from processing.scoring.features.mapped_features import MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.scoring.points.point_scores import NamedFigure, NamedShare
from processing.scoring.points.reliability import share_of


@dataclass(frozen=True)
class DetectionCounts:
    """What was found, missed and made up.

    Attributes
    ----------
    id : str
        Its name in JSON.
    name : Text
    counts : BinaryConfusionMatrix
    has_rejections : bool
        Whether there are places where nothing is and nothing was found; else its TN says nothing.
    """

    id: str
    name: Text
    counts: BinaryConfusionMatrix
    has_rejections: bool = False


@dataclass(frozen=True)
class ErrorStatistics:
    """How far measured values are from the true ones: result minus truth, or a distance.

    Attributes
    ----------
    id : str
        Its name in JSON.
    name : Text
    unit : str
        ``m``, ``°``.
    count : int
    mean, mean_size, rms, within_95, largest : float
        Mean with its sign, mean of the sizes, root of the mean square, size that 95 % stay below,
        largest size; NaN without values.
    """

    id: str
    name: Text
    unit: str
    count: int
    mean: float
    mean_size: float
    rms: float
    within_95: float
    largest: float


@dataclass(frozen=True)
class FileScore:
    """A result against the truth.

    Attributes
    ----------
    tool : str
    counts : tuple of DetectionCounts
        Those first that the tool is judged by.
    shares : tuple of NamedShare
    errors : tuple of ErrorStatistics
    figures : tuple of NamedFigure
    left_out : mapping of str to int
        What was neither required nor held against the result, by what it is.
    limits : mapping of str to float
        Every threshold, with its unit in the name.
    """

    tool: str
    counts: tuple[DetectionCounts, ...] = ()
    shares: tuple[NamedShare, ...] = ()
    errors: tuple[ErrorStatistics, ...] = ()
    figures: tuple[NamedFigure, ...] = ()
    left_out: Mapping[str, int] = field(default_factory=dict)
    limits: Mapping[str, float] = field(default_factory=dict)

    def counts_of(self, id: str) -> BinaryConfusionMatrix:  # noqa: A002 - the field's name
        """The counts of one name.

        Raises
        ------
        KeyError
        """
        return {one.id: one.counts for one in self.counts}[id]

    def errors_of(self, id: str) -> ErrorStatistics:  # noqa: A002 - the field's name
        """The errors of one name.

        Raises
        ------
        KeyError
        """
        return {one.id: one for one in self.errors}[id]

    def share_of(self, id: str) -> float:  # noqa: A002 - the field's name
        """The share of one name, 0 to 1; NaN of nothing.

        Raises
        ------
        KeyError
        """
        return {one.id: one.share.value for one in self.shares}[id]


@dataclass(frozen=True)
class FeatureScorer:
    """How a map of features is scored; see :mod:`processing.scoring.scorers`.

    Attributes
    ----------
    tool : str
    name : Text
    score : callable
        Of the result and the truth; raises `BadFile` for features that aren't what they should be.
    """

    tool: str
    name: Text
    score: Callable[[MappedFile, MappedFile], FileScore]


@dataclass(frozen=True)
class VolumeScorer:
    """How volumes are scored.

    Attributes
    ----------
    tool : str
    name : Text
    score : callable
        Of the numbers of the result and the truth.
    """

    tool: str
    name: Text
    score: Callable[[Mapping[str, float], Mapping[str, float]], FileScore]


def errors_of(id: str, name: tuple[str, str], unit: str, values: ArrayLike) -> ErrorStatistics:  # noqa: A002
    """Errors out of their values; those that are NaN, because a side lacks them, don't count."""
    off = np.asarray(values, dtype=np.float64).ravel()
    off = off[np.isfinite(off)]
    if not off.size:
        return ErrorStatistics(id, Text(*name), unit, 0, *[math.nan] * 5)
    size = np.abs(off)
    return ErrorStatistics(
        id,
        Text(*name),
        unit,
        int(off.size),
        float(off.mean()),
        float(size.mean()),
        float(np.sqrt((off**2).mean())),
        float(np.quantile(size, 0.95)),
        float(size.max()),
    )


def named_share(id: str, name: tuple[str, str], hits: int, of: int) -> NamedShare:  # noqa: A002
    """So many of so many, with its name."""
    return NamedShare(id, Text(*name), share_of(hits, of))
