"""A tool for points in one file: what lies above a height is a tree crown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import length
from processing.core.text import Text
from processing.scoring.points.asked_classes import AskedClass
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.point_scores import ClassScore, PointScore, PointScorer
from processing.tools.tool import Needs, OutputColumn, PerPoint, PointBlock, PointResult, Tool

CROWN, OTHER = 5, 1
_NAME = Text("High points", "高い点")


@dataclass(frozen=True)
class HighPointsParameters:
    """From where on points are high."""

    above_m: float = length(
        2.0,
        low=-1000.0,
        high=1000.0,
        name=Text("Height", "高さ"),
        explanation=Text("Points above it are high.", "これより上の点を高い点とします。"),
    )


def mark_high(
    block: PointBlock, parameters: HighPointsParameters, _monitor: Monitor
) -> PointResult:
    """A class for each point."""
    is_high = block.xyz[:, 2] > parameters.above_m
    return PointResult({"classification": np.where(is_high, CROWN, OTHER).astype(np.uint8)})


def high_score(counts: ConfusionMatrix) -> PointScore:
    """High points against all others."""
    high = ClassScore("high", _NAME, counts.against_rest((CROWN,)))
    return PointScore("high_points", counts.count, (high,), ())


HIGH_POINTS = Tool(
    id="high_points",
    name=_NAME,
    explanation=Text("Marks what lies high.", "高い所にある点を分類します。"),
    group=Text("Points", "点群"),
    needs=Needs.POINTS,
    parameters=HighPointsParameters,
    method=PerPoint(
        mark_high, outputs=(OutputColumn("classification", "uint8", 1, Text("Class", "クラス")),)
    ),
    gives_classes=(CROWN, OTHER),
    scorer=PointScorer(
        tool="high_points",
        name=_NAME,
        codes=frozenset({CROWN}),
        if_false=OTHER,
        if_true=CROWN,
        flags={"is_high": (OTHER, CROWN)},
        score_counts=high_score,
    ),
    asked=AskedClass(
        frozenset({CROWN}), Text("high point", "高い点"), Text("low point", "低い点"), removes=False
    ),
)
