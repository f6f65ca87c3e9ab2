"""The tool BARRIERS: guard rails, pipes and cables, fences, parapets and noise walls of a road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.barriers.barrier_diagnostics import barrier_diagnostics
from processing.methods.road.barriers.street_barriers import StreetBarrier, street_barriers
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.scoring.scorers import BARRIER_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_KINDS = {"parapet": "guard_wall"}


@dataclass(frozen=True)
class BarrierParameters:
    """How long barriers must be, and how sure one must be to be shown."""

    shortest_m: float = length(
        1.5,
        low=0.5,
        high=100.0,
        name=Text("Shortest barrier", "防護柵の最短の長さ"),
        explanation=Text(
            "Shorter pieces are left out.",
            "これより短いものは出力しません。",
        ),
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a barrier is left out.",
            "防護柵・柵である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_barriers(
    drives: tuple[Drive, ...], parameters: BarrierParameters, monitor: Monitor
) -> CandidateResult:
    """Barriers of a survey: one result for all heads and passes."""
    found = street_barriers(drives, monitor)
    kept = [
        one
        for one in found
        if one.confidence >= parameters.least_confidence and one.length_m >= parameters.shortest_m
    ]
    return CandidateResult(tuple(_candidate(one) for one in kept), _note(drives, found, kept))


def diagnose_barriers(
    asked: RequestedPosition, parameters: BarrierParameters
) -> tuple[Diagnostic, ...]:
    """The band in which something stands at a place of a section, and what speaks for it."""
    return barrier_diagnostics(asked, parameters.least_confidence)


def _candidate(barrier: StreetBarrier) -> Candidate:
    attributes: dict[str, CandidateValue] = {
        "type": barrier.type,
        "height_m": round(barrier.height_m, 2),
        "length_m": round(barrier.length_m, 2),
    }
    if barrier.posts_m is not None:
        attributes["posts_m"] = round(barrier.posts_m, 2)
    return Candidate(
        _KINDS.get(barrier.type, barrier.type),
        "line",
        barrier.line,
        np.full(len(barrier.line), -1, np.int64),  # its foot lies between measured points
        barrier.confidence,
        attributes,
    )


def _note(
    drives: Sequence[Drive], found: Sequence[StreetBarrier], kept: Sequence[StreetBarrier]
) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if not found:
        return Text(
            "No long thin strip stands on the ground as a barrier would.",
            "地面の上に、防護柵・柵とみなせる細長い物は計測されていません。",
        )
    if not kept:
        return Text(
            f"None of {len(found)} long thin strips is likely enough to be a barrier.",
            f"細長い物{len(found)}件のうち、防護柵・柵とみなせるものはありませんでした。",
        )
    if all(drive.trajectory is None for drive in drives):
        return Text(
            "Without a trajectory nothing tells which side of a beam its posts are on where they "
            "aren't seen, and what runs along the road.",
            "軌跡がないため、道路に沿う方向と、支柱が計測されていないビームの支柱側は判定できません。",
        )
    return Text("", "")


BARRIERS = Tool(
    id="barriers",
    name=Text("Barriers and fences", "防護柵・柵の抽出"),
    explanation=Text(
        "Finds guard rails, guard pipes, guard cables, fences, concrete barriers and noise walls "
        "beside a road as lines of their feet, with type, height, length and the spacing of their "
        "posts, from all heads and passes of a survey.",
        "道路沿いのガードレール・ガードパイプ・ガードケーブル・柵・剛性防護柵・遮音壁を、"
        "全スキャナー・全走行のデータから下端の線として抽出し、種類・高さ・延長・支柱間隔を求めます。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=BarrierParameters,
    method=SurveyFinder(find_barriers),
    makes=("guard_rail", "guard_pipe", "guard_cable", "fence", "guard_wall", "noise_barrier"),
    button=ToolButton(Text("Find barriers", "防護柵・柵を抽出"), "Ctrl+Shift+F5", "mdi6.fence"),
    diagnostics=diagnose_barriers,
    scorer=BARRIER_SCORER,
)
