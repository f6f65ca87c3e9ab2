"""The tool WIRES: wires along and over a street with sag and clearance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.wires.street_wires import StreetWire, WireSettings, street_wires
from processing.methods.road.wires.wire_diagnostics import wire_diagnostics
from processing.recording.drive import Drive
from processing.scoring.scorers import WIRE_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_NAMED = 5
"""Crossings that the sentence names one by one; the map shows all."""


@dataclass(frozen=True)
class WireParameters:
    """Where wires are looked for, and which clearance they must leave over the road."""

    lowest_m: float = length(
        3.5,
        low=2.0,
        high=20.0,
        name=Text("Lowest wire", "架線の最低の高さ"),
        explanation=Text(
            "Thin lines nearer to the ground are no wires.",
            "地面からこの高さより低い線状の物は、架線とみなしません。",
        ),
        picture="wire/lowest",
    )
    shortest_m: float = length(
        3.0,
        low=1.0,
        high=50.0,
        name=Text("Shortest wire", "架線の最短の長さ"),
        explanation=Text(
            "Shorter pieces are left out: railings and pipes of buildings.",
            "これより短いものは出力しません。建物の手すりや配管などです。",
        ),
        picture="wire/shortest",
    )
    road_clearance_m: float = length(
        5.0,
        low=2.0,
        high=20.0,
        name=Text("Clearance over the road", "路面上の高さの基準値"),
        explanation=Text(
            "Wires that hang lower over the vehicle's way are listed. Communication cables need "
            "5 m (enforcement rules of the wired telecommunications order, article 7), low and "
            "high voltage 6 m (interpretation of the technical standards for electrical "
            "equipment, article 68), service drops 5 m (article 116).",
            "走行路の上でこれより低い架線を一覧に挙げます。通信線は5 m（有線電気通信設備令施行規則"
            "第7条）、低圧・高圧架空電線は6 m（電気設備の技術基準の解釈 第68条）、"
            "引込線は5 m（同 第116条）です。",
        ),
        picture="wire/road",
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a wire is left out.",
            "架線である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_wires(
    drives: tuple[Drive, ...], parameters: WireParameters, monitor: Monitor
) -> CandidateResult:
    """Wires of a survey: one result for all heads and passes."""
    settings = WireSettings(parameters.lowest_m, parameters.shortest_m)
    found = street_wires(drives, settings, monitor)
    wires = [one for one in found if one.confidence >= parameters.least_confidence]
    return CandidateResult(
        tuple(_candidate(one, parameters.road_clearance_m) for one in wires),
        _note(drives, found, wires, parameters.road_clearance_m),
    )


def diagnose_wires(asked: RequestedPosition, parameters: WireParameters) -> tuple[Diagnostic, ...]:
    """The lines through a section that are wires and those that are none, with their points."""
    settings = WireSettings(parameters.lowest_m, parameters.shortest_m)
    return wire_diagnostics(asked, settings, parameters.least_confidence)


def _note(
    drives: Sequence[Drive],
    found: Sequence[StreetWire],
    wires: Sequence[StreetWire],
    least_m: float,
) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if not found:
        return Text(
            "No thin line was measured above the street.",
            "道路の上空に、架線とみなせる線状の物は計測されていません。",
        )
    if not wires:
        return Text(
            f"None of {len(found)} thin lines is likely enough to be a wire.",
            f"線状の物{len(found)}件のうち、架線とみなせるものはありませんでした。",
        )
    if all(drive.trajectory is None for drive in drives):
        return Text(
            "Without a trajectory nothing tells which wires hang over the road.",
            "軌跡がないため、どの架線が路面の上にあるかは判定できません。",
        )
    low = sorted(one.road_clearance_m for one in wires if one.road_clearance_m < least_m)
    if not low:
        return Text("", "")
    told = ", ".join(f"{one:.2f} m" for one in low[:_NAMED]) + " …" * (len(low) > _NAMED)
    return Text(
        f"Wires that hang lower than {least_m:g} m over the road: {len(low)} ({told}).",
        f"路面上の高さが{least_m:g} m未満の架線が{len(low)}本あります（{told}）。",
    )


def _candidate(wire: StreetWire, least_m: float) -> Candidate:
    attributes: dict[str, CandidateValue] = {
        "sag_m": round(wire.sag_m, 3),
        "residual_m": round(wire.noise_m, 4),
    }
    if math.isfinite(wire.clearance_m):
        attributes["clearance_m"] = round(wire.clearance_m, 2)
    if math.isfinite(wire.road_clearance_m):
        attributes["road_clearance_m"] = round(wire.road_clearance_m, 2)
        attributes["is_low"] = "yes" if wire.road_clearance_m < least_m else "no"
    return Candidate(
        "wire",
        "line",
        wire.line,
        wire.points,
        wire.confidence,
        attributes,
        wire.drives,
        own_points=wire.own_points,
        own_drives=wire.own_drives,
    )


WIRES = Tool(
    id="wires",
    name=Text("Wires", "架線の抽出"),
    explanation=Text(
        "Finds the wires along and over a street as they hang, with sag and clearance, and lists "
        "those that hang too low over the road, from all heads and passes of a survey.",
        "道路沿い・道路上空の架線を全スキャナー・全走行のデータから懸垂線として抽出し、"
        "弛度と地上高を求め、路面上の高さが足りない架線を一覧に挙げます。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=WireParameters,
    method=SurveyFinder(find_wires),
    makes=("wire",),
    button=ToolButton(
        Text("Find wires", "架線を抽出"), "Ctrl+Shift+F12", "mdi6.transmission-tower"
    ),
    diagnostics=diagnose_wires,
    scorer=WIRE_SCORER,
)
