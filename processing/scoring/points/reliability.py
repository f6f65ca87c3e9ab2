"""How far a tool's confidence can be trusted: shares with their intervals, and the curve."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_Z_95 = 1.959963984540054
"""Half the width of the middle 95 % of the standard normal distribution."""

BINS = 10


@dataclass(frozen=True)
class ShareInterval:
    """So many of so many, with the interval in which the true share lies, 19 times of 20.

    Attributes
    ----------
    hits, of : float
        Usually whole; lengths in metres are allowed too, the interval is then NaN.
    low, high : float
        Wilson's interval at 95 %; NaN where there is none.
    """

    hits: float
    of: float
    low: float = math.nan
    high: float = math.nan

    @property
    def value(self) -> float:
        """The share, 0 to 1; NaN of nothing."""
        return self.hits / self.of if self.of else math.nan


@dataclass(frozen=True)
class ReliabilityBin:
    """Candidates of about the same confidence.

    Attributes
    ----------
    low, high : float
        The bin's ends; the lower one is in it, of the last bin the upper one too.
    mean_confidence : float
        Of the candidates in it; NaN for an empty bin.
    accepted : ShareInterval
        Those that a person agreed to.
    """

    low: float
    high: float
    mean_confidence: float
    accepted: ShareInterval


@dataclass(frozen=True)
class Reliability:
    """What became of candidates, by their confidence.

    Attributes
    ----------
    bins : tuple of ReliabilityBin
        From 0 to 1, of equal width.
    calibration_error : float
        Mean distance of the accepted share from the mean confidence, weighted by the bins' counts;
        NaN without candidates.
    """

    bins: tuple[ReliabilityBin, ...]
    calibration_error: float


def share_of(hits: int, of: int) -> ShareInterval:
    """A share with Wilson's 95 % interval.

    References
    ----------
    Wilson 1927, JASA 22(158), p. 209-212; Brown, Cai, DasGupta 2001, Statistical Science 16(2),
    equation 4.
    """
    if of == 0:
        return ShareInterval(hits, of)
    share, square = hits / of, _Z_95**2
    middle = (share + square / (2 * of)) / (1 + square / of)
    inside = share * (1 - share) / of + square / (4 * of**2)
    half = _Z_95 * math.sqrt(inside) / (1 + square / of)
    low = 0.0 if hits == 0 else max(0.0, middle - half)
    high = 1.0 if hits == of else min(1.0, middle + half)
    return ShareInterval(hits, of, low, high)


def reliability_of_pairs(pairs: Sequence[tuple[float, bool]]) -> Reliability:
    """The same of candidates as pairs: a confidence, and whether it was right."""
    return reliability_of(
        np.array([one for one, _ in pairs], np.float64),
        np.array([is_right for _, is_right in pairs], np.bool_),
    )


def reliability_of(
    confidence: NDArray[np.float64], is_accepted: NDArray[np.bool_], bins: int = BINS
) -> Reliability:
    """The reliability curve of judged candidates, and its expected calibration error.

    Parameters
    ----------
    confidence : (n,) float64
        0 to 1; what lies outside counts in the first or the last bin.
    is_accepted : (n,) bool
    bins : int
        At least 1.

    Raises
    ------
    ValueError
        The arrays are not of one length.

    References
    ----------
    Niculescu-Mizil, Caruana 2005, ICML, section 4 (curve); Naeini, Cooper, Hauskrecht 2015, AAAI,
    equation 1 (expected calibration error).
    """
    if confidence.shape != is_accepted.shape:
        message = f"{confidence.shape} confidences for {is_accepted.shape} decisions"
        raise ValueError(message)
    number = np.clip(np.floor(confidence * bins), 0, bins - 1).astype(np.int64)
    counts = np.bincount(number, minlength=bins)
    hits = np.bincount(number[is_accepted], minlength=bins)
    sums = np.bincount(number, weights=confidence, minlength=bins)
    made = []
    error = 0.0
    for one, (count, hit, total) in enumerate(
        zip(counts.tolist(), hits.tolist(), sums.tolist(), strict=True)
    ):
        mean = total / count if count else math.nan
        accepted = share_of(hit, count)
        made.append(ReliabilityBin(one / bins, (one + 1) / bins, mean, accepted))
        error += abs(accepted.value - mean) * count if count else 0.0
    whole = int(counts.sum())
    return Reliability(tuple(made), error / whole if whole else math.nan)
