"""The tool POLES: poles and posts along a street with foot, height, diameter and type."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.coarse.coarse_uprights import (
    CoarseUpright,
    coarse_uprights,
    sparse_note,
)
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.poles.shaft_diagnostics import shaft_diagnostics
from processing.methods.road.poles.street_poles import StreetPole, street_poles
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.density import are_sparse
from processing.recording.drive import Drive
from processing.scoring.scorers import POLE_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)


@dataclass(frozen=True)
class PoleParameters:
    """How high poles must be, and how sure one must be to be shown."""

    lowest_m: float = length(
        0.4,
        low=0.3,
        high=10.0,
        name=Text("Lowest pole", "柱状物の最低の高さ"),
        explanation=Text(
            "Lower posts are left out: 1.5 m leaves out bollards and delineators.",
            "これより低いものは出力しません。1.5 mにすると車止めと視線誘導標を除きます。",
        ),
        picture="pole/lowest",
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a pole is left out.",
            "柱状物である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_poles(
    drives: tuple[Drive, ...], parameters: PoleParameters, monitor: Monitor
) -> CandidateResult:
    """Poles of a survey: one result for all heads and passes."""
    if are_sparse(drives):
        return _of_sparse_drives(drives, parameters, monitor)
    found = street_poles(drives, monitor)
    poles = [
        one
        for one in found
        if one.confidence >= parameters.least_confidence and one.height_m >= parameters.lowest_m
    ]
    return CandidateResult(tuple(_candidate(one) for one in poles), _note(drives, found, poles))


def diagnose_poles(asked: RequestedPosition, _parameters: PoleParameters) -> tuple[Diagnostic, ...]:
    """The circles of the shafts about a place, and what makes them shafts."""
    return shaft_diagnostics(asked)


def _note(
    drives: Sequence[Drive], found: Sequence[StreetPole], poles: Sequence[StreetPole]
) -> Text:
    if poles:
        return Text("", "")
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if not found:
        return Text(
            "Nothing straight and upright was measured beside the road.",
            "道路沿いに、柱とみなせる直立した物は計測されていません。",
        )
    return Text(
        f"None of {len(found)} upright things is likely enough to be a pole.",
        f"直立した物{len(found)}件のうち、柱状物とみなせるものはありませんでした。",
    )


def _candidate(pole: StreetPole) -> Candidate:
    shaft, carried = pole.shaft, pole.carried
    attributes: dict[str, CandidateValue] = {
        "type": pole.type,
        "height_m": round(pole.height_m, 2),
        "diameter_m": round(pole.diameter_m, 4),
        "diameter_within_m": round(pole.diameter_within_m, 4),
        "taper_m_per_m": round(2 * shaft.taper, 4),
        "lean_deg": round(pole.lean_deg, 1),
    }
    if carried.arm_m > 0 and pole.type in ("street_light", "signal_pole", "arm_pole"):
        attributes["arm_m"] = round(carried.arm_m, 1)
        attributes["arm_height_m"] = round(carried.arm_height_m, 1)
    is_mirror = pole.type == "mirror_pole"
    if is_mirror and math.isfinite(carried.mirror_deg):
        attributes["direction_deg"] = round(carried.mirror_deg) % 360
    return Candidate.at_foot(
        "mirror" if is_mirror else "pole",
        pole.foot,
        pole.confidence,
        attributes,
        own_points=pole.points,
        own_drives=pole.drives,
    )


def _of_sparse_drives(
    drives: tuple[Drive, ...], parameters: PoleParameters, monitor: Monitor
) -> CandidateResult:
    found = coarse_uprights(drives, monitor)
    likely = [
        one
        for one in found
        if one.pole >= max(parameters.least_confidence, one.tree)
        and one.top_m >= parameters.lowest_m
    ]
    candidates = tuple(_coarse_candidate(one) for one in likely)
    return CandidateResult(candidates, sparse_note(len(likely), len(found)))


def _coarse_candidate(upright: CoarseUpright) -> Candidate:
    attributes: dict[str, CandidateValue] = {
        "type": "other",
        "height_m": round(upright.top_m, 2),
        "lean_deg": round(upright.lean_deg, 1),
    }
    return Candidate.at_foot(
        "pole",
        upright.foot,
        upright.pole,
        attributes,
        own_points=upright.points,
        own_drives=upright.drives,
    )


POLES = Tool(
    id="poles",
    name=Text("Poles", "柱状物の抽出"),
    explanation=Text(
        "Finds utility poles, lamps, signals, posts of signs and mirrors, bollards and delineators "
        "with foot, height, diameter, lean and type, from all heads and passes of a survey.",
        "電柱・照明灯・信号柱・標識柱・カーブミラー・車止め・視線誘導標を"
        "全スキャナー・全走行のデータから抽出し、根元の位置・高さ・直径・傾き・種類を求めます。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=PoleParameters,
    method=SurveyFinder(find_poles),
    makes=("pole", "mirror"),
    button=ToolButton(Text("Find poles", "柱状物を抽出"), "Ctrl+Shift+F11", "mdi6.post-lamp"),
    diagnostics=diagnose_poles,
    scorer=POLE_SCORER,
)
