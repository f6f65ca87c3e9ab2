"""What is said of a tool that classifies points: both classes, the errors, and shares by kind."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from processing.core.text import Text
from processing.scoring.points.coded_points import CodePairs
from processing.scoring.points.confusion_matrix import (
    BinaryConfusionMatrix,
    ConfusionMatrix,
    is_one_of,
)
from processing.scoring.points.reliability import ShareInterval, share_of


@dataclass(frozen=True)
class ClassScore:
    """One class called positive.

    Attributes
    ----------
    id : str
        Its name in JSON.
    name : Text
    counts : BinaryConfusionMatrix
    """

    id: str
    name: Text
    counts: BinaryConfusionMatrix


@dataclass(frozen=True)
class NamedShare:
    """So many points of so many."""

    id: str
    name: Text
    share: ShareInterval


@dataclass(frozen=True)
class NamedFigure:
    """A figure that isn't a share of points; NaN where there is none."""

    id: str
    name: Text
    value: float


@dataclass(frozen=True)
class KindShare:
    """Points of one kind of thing, and how many of them got the class they should have.

    Attributes
    ----------
    group : str
        What kinds they are, as the truth names it: ``kind``, ``noise``.
    kind : int
        The truth's number.
    right : ShareInterval
    """

    group: str
    kind: int
    right: ShareInterval


@dataclass(frozen=True)
class PointScore:
    """A result against the truth.

    Attributes
    ----------
    tool : str
    points : int
    classes : tuple of ClassScore
    shares : tuple of NamedShare
    figures : tuple of NamedFigure
    kinds : tuple of KindShare
        By group and number; empty where the truth has no kinds.
    matrix : ConfusionMatrix or None
        Every class against every other; None where the question has two answers only.
    """

    tool: str
    points: int
    classes: tuple[ClassScore, ...]
    shares: tuple[NamedShare, ...]
    figures: tuple[NamedFigure, ...] = ()
    kinds: tuple[KindShare, ...] = ()
    matrix: ConfusionMatrix | None = None

    def class_of(self, id: str) -> BinaryConfusionMatrix:  # noqa: A002 - the field's name
        """The counts with one class positive.

        Raises
        ------
        KeyError
        """
        return {one.id: one.counts for one in self.classes}[id]


@dataclass(frozen=True)
class PointScorer:
    """How results of one tool are scored; see :mod:`processing.scoring.scorers`.

    Attributes
    ----------
    tool : str
    name : Text
    codes : frozenset of int
        The codes that the tool is asked for; kinds are right where truth and result agree on
        these. None: every code counts for itself.
    if_false, if_true : int
        Codes of a truth that says only no and yes: text with classes 0 and 1.
    flags : mapping of str to (int, int)
        Names of yes-or-no arrays in a truth, with the codes for no and yes.
    score_counts : callable
        Classes, shares and figures out of counts.
    """

    tool: str
    name: Text
    codes: frozenset[int]
    if_false: int
    if_true: int
    flags: Mapping[str, tuple[int, int]]
    score_counts: Callable[[ConfusionMatrix], PointScore]

    def score(self, pairs: Iterable[CodePairs]) -> PointScore:
        """Score points that are paired with their truth, a block at a time."""
        counts = ConfusionMatrix()
        kinds: dict[tuple[str, int], list[int]] = {}
        for pair in pairs:
            counts += ConfusionMatrix.of(pair.truth.codes, pair.result.codes)
            _count_kinds(pair, self.codes, kinds)
        score = self.score_counts(counts)
        by_kind = tuple(
            KindShare(group, kind, share_of(right, of))
            for (group, kind), (right, of) in sorted(kinds.items())
        )
        return replace(score, kinds=by_kind)


NOISE_CODES = frozenset({7, 18})
GROUND_CODES = frozenset({2, 11})
"""A road's surface is ground too, where a classification has it apart."""


def noise_score(counts: ConfusionMatrix) -> PointScore:
    """Noise: both classes, what doing nothing would score, and what went wrong.

    References
    ----------
    Kogure et al. 2022 (road surface), equations 1 to 3, of kept points.
    """
    noise = counts.against_rest(NOISE_CODES)
    true_noise, kept = noise.hits + noise.misses, noise.turned()
    right_code = sum(counts.pairs((code,), (code,)) for code in NOISE_CODES)
    return PointScore(
        "noise",
        counts.count,
        (
            ClassScore("kept", Text("kept point (the study's)", "残した点（論文の正例）"), kept),
            ClassScore(
                "kept_if_nothing_is_removed",
                Text("kept point, if nothing is removed", "残した点（何も除去しない場合）"),
                noise.if_nothing_was_positive().turned(),
            ),
            ClassScore("noise", Text("noise point", "ノイズ点"), noise),
        ),
        (
            _share(
                "noise_share", ("noise in the truth", "正解のノイズ率"), true_noise, counts.count
            ),
            _share("noise_left", ("noise left", "残ったノイズ"), noise.misses, true_noise),
            _share(
                "true_lost",
                ("true points lost", "失われた真の点"),
                kept.misses,
                kept.hits + kept.misses,
            ),
            _share(
                "right_code",
                (
                    "noise found, with the true code (7 or 18)",
                    "検出ノイズのうちコード（7・18）も正しい点",
                ),
                right_code,
                noise.hits,
            ),
        ),
    )


def ground_score(counts: ConfusionMatrix) -> PointScore:
    """Ground: both classes, errors of both types, and the agreement beyond chance.

    References
    ----------
    Sakurai et al., table 2 (positive: the removed point); Sithole and Vosselman 2004,
    ISPRS Journal 59, section 4.2 (types of error: I rejects ground, II accepts objects).
    """
    ground = counts.against_rest(GROUND_CODES)
    removed = ground.turned()
    true_ground, true_objects = ground.hits + ground.misses, removed.hits + removed.misses
    return PointScore(
        "ground",
        counts.count,
        (
            ClassScore("removed", Text("removed point (object)", "除去した点（地物）"), removed),
            ClassScore("ground", Text("ground point", "地面の点"), ground),
        ),
        (
            _share(
                "object_share", ("objects in the truth", "正解の地物率"), true_objects, counts.count
            ),
            _share(
                "type_1",
                ("ground points lost (type I)", "失われた地面点（第1種の誤り）"),
                ground.misses,
                true_ground,
            ),
            _share(
                "type_2",
                ("object points left as ground (type II)", "地面に残った地物点（第2種の誤り）"),
                removed.misses,
                true_objects,
            ),
            _share(
                "total_error",
                ("total error", "全体の誤り"),
                ground.misses + ground.false_alarms,
                counts.count,
            ),
        ),
        (NamedFigure("kappa", Text("kappa", "カッパ係数"), ground.kappa),),
    )


def _share(id_: str, name: tuple[str, str], hits: int, of: int) -> NamedShare:
    return NamedShare(id_, Text(*name), share_of(hits, of))


def _count_kinds(
    pair: CodePairs, codes: Collection[int], kinds: dict[tuple[str, int], list[int]]
) -> None:
    if not pair.truth.kinds:
        return
    is_right = (
        is_one_of(pair.truth.codes, codes) == is_one_of(pair.result.codes, codes)
        if codes
        else pair.truth.codes == pair.result.codes
    )
    for group, values in pair.truth.kinds.items():
        found, position = np.unique(values, return_inverse=True)
        of = np.bincount(position, minlength=found.size)
        right = np.bincount(position[is_right], minlength=found.size)
        for kind, hits, count in zip(found.tolist(), right.tolist(), of.tolist(), strict=True):
            total = kinds.setdefault((group, kind), [0, 0])
            total[0] += hits
            total[1] += count
