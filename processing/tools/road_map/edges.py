"""The tool EDGES: where the carriageway ends without a curb, and what closes it elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.edges.edge_diagnostics import edge_diagnostics
from processing.methods.road.edges.street_edges import FoundEdges, StreetEdge, street_edges
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.scoring.scorers import EDGE_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_KINDS = {"walk": "sidewalk"}
_SATURATED = 0.3
"""Of the points at a head's highest intensity, from which brightness tells little."""


@dataclass(frozen=True)
class EdgeParameters:
    """How long edges must be, and how sure one must be to be shown."""

    shortest_m: float = length(
        2.0,
        low=0.5,
        high=100.0,
        name=Text("Shortest edge", "縁の最短の長さ"),
        explanation=Text(
            "Shorter pieces are left out.",
            "これより短いものは出力しません。",
        ),
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be the edge of the carriageway is left out. Gaps between what "
            "was seen are bridged by lines of low confidence, which a lower value shows.",
            "車道の縁である見込みがこの値より低いものは出力しません。計測されていない区間は"
            "信頼度の低い線で補間され、この値を下げると表示されます。",
        ),
    )


def find_edges(
    drives: tuple[Drive, ...], parameters: EdgeParameters, monitor: Monitor
) -> CandidateResult:
    """Edges without a step of a survey: one result for all heads and passes."""
    found = street_edges(drives, monitor)
    kept = [
        one
        for one in found.edges
        if one.confidence >= parameters.least_confidence and one.length_m >= parameters.shortest_m
    ]
    return CandidateResult(tuple(_candidate(one) for one in kept), _note(drives, found, kept))


def diagnose_edges(asked: RequestedPosition, parameters: EdgeParameters) -> tuple[Diagnostic, ...]:
    """Where the carriageway ends on both sides of a place of a section, and what speaks for it."""
    return edge_diagnostics(asked, parameters.least_confidence)


def _candidate(edge: StreetEdge) -> Candidate:
    before, after = edge.ends
    attributes: dict[str, CandidateValue] = {
        "type": edge.type,
        "evidence": ", ".join(edge.evidence),
        "side": edge.side,
        "bridged_m": round(edge.bridged_m, 2),
        "before": before,
        "after": after,
    }
    return Candidate(
        _KINDS.get(edge.type, "road_edge"),
        "line",
        edge.line,
        np.full(len(edge.line), -1, np.int64),  # it lies between measured points
        edge.confidence,
        attributes,
    )


def _note(drives: Sequence[Drive], found: FoundEdges, kept: Sequence[StreetEdge]) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if not found.closed_m:
        return Text(
            "The vehicle hardly moved, so there is no road to look along.",
            "車両がほとんど移動していないため、道路に沿った抽出ができません。",
        )
    closed = _closed(found)
    if not found.has_tones:
        return Text(
            f"The points have no intensity, or the same everywhere: edges are told by roughness "
            f"and slope alone. {closed.en}",
            f"反射強度がないか、全点で同じ値のため、粗さと勾配のみで判定しました。{closed.ja}",
        )
    if found.full_share > _SATURATED:
        return Text(
            f"Intensities are cut off: {found.full_share:.0%} of the points have the highest "
            f"value, so edges are missing. {closed.en}",
            f"反射強度が飽和しています（{found.full_share:.0%}の点が最大値）。"
            f"抽出できない縁があります。{closed.ja}",
        )
    if not kept and not found.edges:
        return Text(
            f"Nowhere does the road end without a step. {closed.en}",
            f"段差のない車道の縁は計測されていません。{closed.ja}",
        )
    if not kept:
        return Text(
            f"None of {len(found.edges)} lines is likely enough to be the edge of the carriageway. "
            f"{closed.en}",
            f"線{len(found.edges)}件のうち、車道の縁とみなせるものはありませんでした。{closed.ja}",
        )
    return closed


def _closed(found: FoundEdges) -> Text:
    """What closes the carriageway, both sides together."""
    edge, curb, gap = (found.closed_m.get(name, 0.0) for name in ("edge", "curb", "gap"))
    return Text(
        f"Both sides of the carriageway: {edge:,.0f} m end without a step, {curb:,.0f} m at a "
        f"curb, {gap:,.0f} m were not seen.",
        f"車道両側の内訳: 段差なし{edge:,.0f} m、縁石{curb:,.0f} m、不明{gap:,.0f} m。",
    )


EDGES = Tool(
    id="edges",
    name=Text("Edges of the carriageway", "車道の縁の抽出"),
    explanation=Text(
        "Finds where the carriageway ends without a curb: at flush walks, gutters, soil and grass, "
        "by brightness, roughness and slope, from all heads and passes of a survey.",
        "縁石のない車道の縁（段差のない歩道・側溝・土・草地との境）を、反射強度・粗さ・勾配から"
        "全スキャナー・全走行のデータで抽出します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.TRAJECTORY,
    parameters=EdgeParameters,
    method=SurveyFinder(find_edges),
    makes=("road_edge", "sidewalk"),
    button=ToolButton(
        Text("Find edges without curbs", "縁石のない車道の縁を抽出"),
        "Ctrl+Shift+F4",
        "mdi6.road",
    ),
    diagnostics=diagnose_edges,
    scorer=EDGE_SCORER,
)
