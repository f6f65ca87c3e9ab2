"""The tool COVERS: manholes, valves, hand holes and gratings of inlets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.covers.cover_diagnostics import cover_diagnostics
from processing.methods.road.covers.street_covers import (
    FoundCovers,
    StreetCover,
    street_covers,
)
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.scoring.scorers import COVER_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_KINDS = {"square": "manhole_area", "grating": "rain_inlet"}
_VALVE_M = 0.35
"""Round covers up to here are of valves: they have 0.1 to 0.3 m, manholes 0.6 m and more."""


@dataclass(frozen=True)
class CoverParameters:
    """How large covers must be, and how sure one must be to be shown."""

    smallest_m: float = length(
        0.15,
        low=0.1,
        high=1.0,
        name=Text("Smallest cover", "蓋の最小の大きさ"),
        explanation=Text(
            "Diameter or shorter side: smaller ones are left out. Valves have 0.1 to 0.3 m.",
            "直径または短辺です。これより小さいものは出力しません。バルブの蓋は0.1〜0.3 mです。",
        ),
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a cover is left out.",
            "蓋である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_covers(
    drives: tuple[Drive, ...], parameters: CoverParameters, monitor: Monitor
) -> CandidateResult:
    """Covers of a survey: one result for all heads and passes."""
    found = street_covers(drives, parameters.least_confidence, monitor)
    kept = [one for one in found.covers if min(one.sides_m) >= parameters.smallest_m]
    return CandidateResult(tuple(_candidate(one) for one in kept), _note(drives, found, kept))


def diagnose_covers(
    asked: RequestedPosition, parameters: CoverParameters
) -> tuple[Diagnostic, ...]:
    """The shapes in the road about a section that are covers and those that are none."""
    return cover_diagnostics(asked, parameters.least_confidence)


def _candidate(cover: StreetCover) -> Candidate:
    long, wide = cover.sides_m
    attributes: dict[str, CandidateValue] = {
        "shape": "round" if cover.type == "round" else "square"
    }
    if cover.type == "round":
        attributes["diameter_m"] = round(long, 3)
        kind = "valve_cover" if long <= _VALVE_M else "manhole"
    else:
        attributes["width_m"], attributes["length_m"] = round(wide, 3), round(long, 3)
        attributes["direction_deg"] = round(cover.direction_deg, 1)
        kind = _KINDS[cover.type]
    attributes["raised_m"] = round(cover.raised_m, 3)
    if cover.lies_in:
        attributes["lies_in"] = cover.lies_in
    is_point = cover.type == "round"
    xyz = cover.middle[None] if is_point else cover.corners
    return Candidate(
        kind,
        "point" if is_point else "area",
        xyz,
        np.full(len(xyz), -1, np.int64),  # it lies between measured points
        cover.confidence,
        attributes,
    )


def _note(drives: Sequence[Drive], found: FoundCovers, kept: Sequence[StreetCover]) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if all(head.is_flat for head in found.heads):
        return Text(
            "The points have no intensity, or the same everywhere: only covers that stand out of "
            "the road or are open are found.",
            "反射強度がないか、全点で同じ値のため、路面との段差や開口がある蓋だけを抽出しています。",
        )
    if any(head.is_saturated for head in found.heads):
        share = max(head.full_share for head in found.heads)
        return Text(
            f"Intensities are cut off: {share:.0%} of the road's points have the highest value, so "
            "covers are missing.",
            f"反射強度が飽和しています（路面の点の{share:.0%}が最大値）。抽出できない蓋があります。",
        )
    if not found.shapes:
        return Text(
            "Nothing in the road has an edge all around as a cover would have.",
            "路面・歩道に、蓋のように周囲と区別できる形は計測されていません。",
        )
    if not kept:
        return Text(
            f"None of {found.shapes} shapes in the road is likely enough to be a cover.",
            f"路面・歩道の形{found.shapes}件のうち、蓋とみなせるものはありませんでした。",
        )
    if all(drive.trajectory is None for drive in drives):
        return Text(
            "Without a trajectory covers in walks can't be told from those in carriageways.",
            "軌跡がないため、歩道の蓋と車道の蓋を区別できません。",
        )
    return Text("", "")


COVERS = Tool(
    id="covers",
    name=Text("Covers and inlets", "マンホール・蓋の抽出"),
    explanation=Text(
        "Finds manholes, valves, covers of hand holes and gratings of inlets in carriageways and "
        "walks, with shape, size and direction, by brightness, height and what lies below, from "
        "all heads and passes of a survey.",
        "車道・歩道のマンホール、バルブ、ハンドホールの蓋と雨水桝のグレーチングを、"
        "反射強度・段差・下方の点から、形状・寸法・方向とともに、"
        "全スキャナー・全走行のデータから抽出します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=CoverParameters,
    method=SurveyFinder(find_covers),
    makes=("manhole", "valve_cover", "manhole_area", "rain_inlet"),
    button=ToolButton(
        Text("Find covers", "マンホール・蓋を抽出"), "Ctrl+Shift+F3", "mdi6.circle-double"
    ),
    diagnostics=diagnose_covers,
    scorer=COVER_SCORER,
)
