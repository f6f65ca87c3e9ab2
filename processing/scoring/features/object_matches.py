"""Things that stand at one place, found and true ones paired: what trees, signs and poles share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.scoring.features.file_scores import ErrorStatistics, errors_of
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.one_to_one import pairs_within
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix


@dataclass(frozen=True)
class ObjectMatch:
    """A true thing and what was found of it."""

    result: MappedFeature
    truth: MappedFeature


@dataclass(frozen=True)
class ObjectMatches:
    """Found things against true ones.

    Attributes
    ----------
    partners : tuple of ObjectMatch
        Things that were asked for and found, in the truth's order.
    counts : BinaryConfusionMatrix
        Without those that were not asked for.
    alone : tuple of MappedFeature
        Found where nothing is.
    unseen, unseen_found : int
        True things that the points don't show, and how many of them were found all the same.
    """

    partners: tuple[ObjectMatch, ...]
    counts: BinaryConfusionMatrix
    alone: tuple[MappedFeature, ...]
    unseen: int
    unseen_found: int

    @property
    def left_out(self) -> dict[str, int]:
        """What was neither required nor held against the result."""
        return {"unseen": self.unseen, "unseen_found": self.unseen_found}


def match_objects(
    result: Sequence[MappedFeature],
    truth: Sequence[MappedFeature],
    is_asked: Sequence[bool],
    within_m: float,
    *,
    in_space: bool = False,
) -> ObjectMatches:
    """Pair found things with true ones, one to one.

    A thing found at one that isn't asked for counts neither as a hit nor as a false alarm.

    Parameters
    ----------
    is_asked : sequence of bool
        Of each true thing, whether the points show it.
    within_m : float
        The farthest partner.
    in_space : bool
        Whether heights count too, where all things have them.
    """
    found, true = positions_of(result), positions_of(truth)
    has_heights = not (np.isnan(found[:, 2]).any() or np.isnan(true[:, 2]).any())
    axes = 3 if in_space and has_heights else 2
    of_result, of_truth = pairs_within(found[:, :axes], true[:, :axes], within_m)
    asked: NDArray[np.bool_] = np.array(is_asked, dtype=np.bool_)
    is_hit = asked[of_truth]
    partners = tuple(
        ObjectMatch(result[one], truth[other])
        for one, other in zip(of_result[is_hit], of_truth[is_hit], strict=True)
    )
    paired = set(of_result.tolist())
    alone = tuple(one for number, one in enumerate(result) if number not in paired)
    hits, wanted = len(partners), int(asked.sum())
    return ObjectMatches(
        partners,
        BinaryConfusionMatrix(hits, len(alone), wanted - hits, 0),
        alone,
        len(truth) - wanted,
        len(of_result) - hits,
    )


def positions_of(features: Sequence[MappedFeature]) -> Floats:
    """(n, 3) places of points; heights are NaN where the file has none."""
    return np.array([one.xyz[0] for one in features], dtype=np.float64).reshape(-1, 3)


def is_in_span(feature: MappedFeature) -> bool:
    """Whether the vehicle passed it; true where the truth doesn't say."""
    return feature.facts.get("in_span") in (None, True)  # 1 in a GeoPackage


def shows_enough(truth: MappedFile, feature: MappedFeature, name: str, least: float) -> bool:
    """Whether a count or a share is large enough; true where the truth doesn't give it.

    Raises
    ------
    BadFile
        It is no number.
    """
    return not truth.number(feature, name) < least


@dataclass(frozen=True)
class Differences:
    """Measures of partners: what the result says minus what is true.

    Attributes
    ----------
    result, truth : MappedFile
        For messages.
    partners : tuple of ObjectMatch
    """

    result: MappedFile
    truth: MappedFile
    partners: tuple[ObjectMatch, ...]

    def of(self, fact: str, name: tuple[str, str], unit: str = "m") -> ErrorStatistics:
        """Errors of a fact that both have under one name.

        Raises
        ------
        BadFile
            It is no number.
        """
        return errors_of(
            fact.rpartition("_")[0] if fact.endswith("_m") else fact,
            name,
            unit,
            [
                self.result.number(one.result, fact) - self.truth.number(one.truth, fact)
                for one in self.partners
            ],
        )

    def positions(self) -> Floats:
        """(n, 3) found minus true places, m."""
        return positions_of([one.result for one in self.partners]) - positions_of(
            [one.truth for one in self.partners]
        )
