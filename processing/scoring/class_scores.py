"""Points of all classes against a truth: every class called positive in turn, and their mean."""

from __future__ import annotations

import numpy as np

from processing.core.text import Text
from processing.recording.columns.classes import point_classes
from processing.scoring.confusion_matrix import ClassCounts
from processing.scoring.point_scores import (
    NOISE_CODES,
    ClassScore,
    NamedFigure,
    NamedShare,
    PointScore,
)
from processing.scoring.reliability import share_of

NOT_KNOWN = 0
"""Points whose true class nobody gave; what a tool calls them is neither right nor wrong."""

_GROUND = frozenset({2, 11})


def class_score(counts: ClassCounts) -> PointScore:
    """Precision, recall and F of each class, their mean, and the share of right points.

    The mean is over the classes that the truth has, without noise, which another tool finds.
    Ground and road surface are also counted as one class, as the thesis has them.

    References
    ----------
    Specification mms.md, 4.2 (classes) and 4.6 (mean F).
    """
    table = counts.table.copy()
    table[NOT_KNOWN] = 0
    known = ClassCounts(table)
    true = np.flatnonzero(table.sum(axis=1))
    met = np.union1d(true, np.flatnonzero(table.sum(axis=0))).tolist()
    names = {one.code: one.name for one in point_classes()}
    classes = [
        ClassScore(
            str(code),
            Text.same(f"{code} {{name}}").filled(name=names.get(code, Text.same(""))),
            known.confusion_matrix((code,)),
        )
        for code in met
    ]
    judged = {*true.tolist()} - NOISE_CODES
    of_class = {int(one.id): one.counts.f_measure for one in classes}
    own = [of_class[code] for code in judged]
    ground = known.confusion_matrix(_GROUND)
    joined = [of_class[code] for code in judged - _GROUND]
    if judged & _GROUND:
        joined.append(ground.f_measure)
        name = Text("2, 11 ground and road surface", "2・11 地面と路面")
        classes.append(ClassScore("ground_and_road", name, ground))
    right = int(np.trace(table))
    return PointScore(
        "classify",
        known.count,
        tuple(classes),
        (
            NamedShare(
                "right",
                Text("points of the right class", "正しいクラスの点"),
                share_of(right, known.count),
            ),
            NamedShare(
                "not_known",
                Text("points without a true class", "正解のない点"),
                share_of(counts.count - known.count, counts.count),
            ),
        ),
        (
            NamedFigure("mean_f", Text("mean F of the classes", "F値のクラス平均"), _mean(own)),
            NamedFigure(
                "mean_f_ground_joined",
                Text("mean F, ground and road as one", "F値のクラス平均（地面・路面は1クラス）"),
                _mean(joined),
            ),
        ),
    )


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else float("nan")
