"""The tool MARKINGS: white and yellow lines of a road, stop lines, bars of crossings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.markings.street_markings import (
    FoundMarkings,
    StreetMarking,
    street_markings,
)
from processing.recording.drive import Drive
from processing.scoring.scorers import MARKING_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_KINDS = {"stop_line": "stop_line", "crosswalk_bar": "crosswalk_bar"}


@dataclass(frozen=True)
class MarkingParameters:
    """How long markings must be, and how sure one must be to be shown."""

    shortest_m: float = length(
        1.0,
        low=0.3,
        high=50.0,
        name=Text("Shortest marking", "区画線の最短の長さ"),
        explanation=Text(
            "Shorter pieces are left out; of a broken line all dashes together count.",
            "これより短いものは出力しません。破線は各線分の合計で判定します。",
        ),
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a marking is left out.",
            "区画線である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_markings(
    drives: tuple[Drive, ...], parameters: MarkingParameters, monitor: Monitor
) -> CandidateResult:
    """Markings of a survey: one result for all heads and passes."""
    found = street_markings(drives, monitor)
    kept = [
        one
        for one in found.markings
        if one.confidence >= parameters.least_confidence and one.painted_m >= parameters.shortest_m
    ]
    return CandidateResult(tuple(_candidate(one) for one in kept), _note(drives, found, kept))


def _candidate(marking: StreetMarking) -> Candidate:
    attributes: dict[str, CandidateValue] = {
        "type": marking.type,
        "width_m": round(marking.width_m, 3),
        "paint_share": round(min(marking.paint, 1.0), 2),
    }
    if marking.pattern_m is not None:
        dash, gap = marking.pattern_m
        attributes["dash_m"], attributes["gap_m"] = round(dash, 1), round(gap, 1)
        attributes["pattern_m"] = f"{dash:.1f}/{gap:.1f}"
    return Candidate(
        _KINDS.get(marking.type, "marking_line"),
        "line",
        marking.line,
        np.full(len(marking.line), -1, np.int64),  # it lies between measured points
        marking.confidence,
        attributes,
    )


def _note(drives: Sequence[Drive], found: FoundMarkings, kept: Sequence[StreetMarking]) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if all(head.is_flat for head in found.heads):
        return Text(
            "The points have no intensity, or the same everywhere: paint can't be told from road.",
            "反射強度がないか、全点で同じ値のため、塗装と路面を区別できません。",
        )
    if any(head.is_saturated for head in found.heads):
        share = max(head.full_share for head in found.heads)
        return Text(
            f"Intensities are cut off: {share:.0%} of the road's points have the highest value, so "
            "markings are missing.",
            f"反射強度が飽和しています（路面の点の{share:.0%}が最大値）。抽出できない区画線があります。",
        )
    if not found.markings:
        return Text(
            "Nothing on the road is brighter than the road itself as paint would be.",
            "路面より明るい、塗装とみなせる線は計測されていません。",
        )
    if not kept:
        return Text(
            f"None of {len(found.markings)} bright strokes is likely enough to be a marking.",
            f"明るい線{len(found.markings)}件のうち、区画線とみなせるものはありませんでした。",
        )
    if all(drive.trajectory is None for drive in drives):
        return Text(
            "Without a trajectory stop lines can't be told from other lines.",
            "軌跡がないため、停止線とほかの線を区別できません。",
        )
    return Text("", "")


MARKINGS = Tool(
    id="markings",
    name=Text("Road markings", "区画線の抽出"),
    explanation=Text(
        "Finds solid and broken lines, stop lines and the bars of crossings on the road, with "
        "width and pattern, by what is brighter than the road around it, from all heads and "
        "passes of a survey.",
        "路面の実線・破線・停止線・横断歩道の縞を、周囲の路面との反射強度の差から"
        "全スキャナー・全走行のデータで抽出し、中心線と幅、破線の間隔を求めます。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=MarkingParameters,
    method=SurveyFinder(find_markings),
    makes=("marking_line", "stop_line", "crosswalk_bar"),
    button=ToolButton(
        Text("Find road markings", "区画線を抽出"), "Ctrl+Shift+F6", "mdi6.road-variant"
    ),
    scorer=MARKING_SCORER,
)
