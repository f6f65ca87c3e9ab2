"""A finder in one file: a pole stands where the highest point of a drive is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import ratio
from processing.core.text import Text
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.scoring.features.file_scores import DetectionCounts, FeatureScorer, FileScore
from processing.scoring.features.mapped_features import MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.tool import Candidate, CandidateResult, Finder, Needs, Tool, ToolButton

_NAME = Text("Highest point", "最高点")


@dataclass(frozen=True)
class HighestPointParameters:
    """How sure the tool is."""

    confidence: float = ratio(
        0.5,
        low=0.0,
        high=1.0,
        name=Text("Confidence", "信頼度"),
        explanation=Text("What the candidate gets.", "候補に付ける値です。"),
    )


def find_highest(
    drive: Drive, parameters: HighestPointParameters, monitor: Monitor
) -> CandidateResult:
    """One pole on a drive that has points."""
    monitor.check()
    if not drive.count:
        return CandidateResult(note=Text("There are no points.", "点がありません。"))
    point = np.array([drive.xyz(slice(0, drive.count))[:, 2].argmax()])
    found = Candidate("pole", "point", drive.xyz(point), point, parameters.confidence)
    return CandidateResult((found,))


def diagnose_highest(
    asked: RequestedPosition, _parameters: HighestPointParameters
) -> tuple[Diagnostic, ...]:
    """The place that was pointed at, which is never the highest."""
    return (Diagnostic(asked.xyz, (), is_taken=False),)


def highest_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Poles that stand to the centimetre where they should."""
    true, found = (
        {tuple(np.round(one.xyz[0], 2).tolist()) for one in file.features}
        for file in (truth, result)
    )
    hits = len(true & found)
    counts = BinaryConfusionMatrix(hits, len(found) - hits, len(true) - hits, 0)
    return FileScore("highest_point", (DetectionCounts("highest", _NAME, counts),))


HIGHEST_POINT = Tool(
    id="highest_point",
    name=_NAME,
    explanation=Text("Finds the highest point.", "最も高い点を探します。"),
    group=Text("Poles", "柱状物"),
    needs=Needs.POINTS,
    parameters=HighestPointParameters,
    method=Finder(find_highest),
    makes=("pole",),
    button=ToolButton(Text("Find the highest point", "最高点を抽出"), "Ctrl+Alt+F9", "mdi6.flag"),
    diagnostics=diagnose_highest,
    scorer=FeatureScorer("highest_point", _NAME, highest_score),
)
