"""Points of all classes against a truth: the whole matrix, every class in turn, and their mean."""

from __future__ import annotations

import numpy as np

from processing.core.text import Text
from processing.recording.columns.classes import point_classes
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.point_scores import (
    GROUND_CODES,
    NOISE_CODES,
    ClassScore,
    NamedFigure,
    NamedShare,
    PointScore,
)
from processing.scoring.points.reliability import share_of

_OTHER = 1
"""What belongs to no class: the thesis leaves it out of its evaluation (section 4.2)."""

_DRAWN = 1_000_000
"""Points of each class in balanced sampling, as the thesis' areas have (Takahashi 2022, table 4-3);
so many that rounding is no matter."""

NOT_KNOWN = 0
"""Points whose true class nobody gave; what a tool calls them is neither right nor wrong."""


def class_score(counts: ConfusionMatrix) -> PointScore:
    """Precision, recall and F of each class, their mean, and the share of right points.

    The mean is over the classes that the truth has, without noise, which another tool finds, and
    without “other”.
    Ground and road surface are also counted as one class, as the thesis has them, over all points
    and, as its own figures are, without those that are truly “other”. “Balanced” is the mean for as
    many points of each of these classes and none of others.

    References
    ----------
    Takahashi 2022, sections 4.2 (classes) and 4.6 (mean F).
    """
    known = counts.without_true((NOT_KNOWN,))
    classes = _each_class(known)
    judged = judged_classes(known)
    ground = known.against_rest(GROUND_CODES)
    if not set(judged).isdisjoint(GROUND_CODES):
        name = Text("2, 11 ground and road surface", "2・11 地面と路面")
        classes.append(ClassScore("ground_and_road", name, ground))
    return PointScore(
        "classify",
        known.count,
        tuple(classes),
        (
            NamedShare(
                "right",
                Text("points of the right class", "正しいクラスの点"),
                share_of(int(known.counts.trace()), known.count),
            ),
            NamedShare(
                "not_known",
                Text("points without a true class", "正解のない点"),
                share_of(counts.count - known.count, counts.count),
            ),
        ),
        _figures(known),
        matrix=known,
    )


def _figures(known: ConfusionMatrix) -> tuple[NamedFigure, ...]:
    judged = judged_classes(known)
    return (
        NamedFigure(
            "mean_f", Text("mean F of the classes", "F値のクラス平均"), known.mean_f_of(judged)
        ),
        NamedFigure(
            "mean_f_ground_joined",
            Text("mean F, ground and road as one", "F値のクラス平均（地面・路面は1クラス）"),
            _mean_f_ground_joined(known),
        ),
        NamedFigure(
            "mean_f_as_thesis",
            Text("the same, points that are “other” left out", "同上、正解が「その他」の点を除く"),
            _mean_f_ground_joined(known.without_true((_OTHER,))),
        ),
        NamedFigure(
            "mean_f_balanced",
            Text("mean F, as many points of each class", "F値のクラス平均（各クラス同数の点）"),
            balanced_sample(known).mean_f,
        ),
        NamedFigure("kappa", Text("kappa", "カッパ係数"), known.kappa),
    )


def judged_classes(known: ConfusionMatrix) -> tuple[int, ...]:
    """The classes that count: those that the truth has, without noise and “other”."""
    return tuple(
        code
        for code, points in zip(known.codes, known.true_counts.tolist(), strict=True)
        if points and code not in NOISE_CODES and code != _OTHER
    )


def _mean_f_ground_joined(known: ConfusionMatrix) -> float:
    judged = judged_classes(known)
    f_of = dict(zip(known.codes, known.f_measure.tolist(), strict=True))
    joined = [f_of[code] for code in judged if code not in GROUND_CODES]
    if len(joined) < len(judged):
        joined.append(known.against_rest(GROUND_CODES).f_measure)
    return float(np.mean(joined)) if joined else float("nan")


def balanced_sample(known: ConfusionMatrix) -> ConfusionMatrix:
    """The same for as many points of each class that counts."""
    return known.balanced(judged_classes(known), _DRAWN)


def _each_class(known: ConfusionMatrix) -> list[ClassScore]:
    names = {one.code: one.name for one in point_classes()}
    return [
        ClassScore(
            str(code),
            Text.same(f"{code} {{name}}").filled(name=names.get(code, Text.same(""))),
            known.against_rest((code,)),
        )
        for code in known.codes
    ]
