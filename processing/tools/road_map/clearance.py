"""The tool CLEARANCE: what hangs into the room that must be kept free over a road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.clearance.street_clearance import (
    ClearanceLimits,
    ClearancePlace,
    StreetClearance,
    street_clearance,
)
from processing.recording.drive import Drive
from processing.scoring.scorers import CLEARANCE_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_KIND = "clearance_place"
_SHOWN = 6
_MOSTLY_SEEN = 0.5


@dataclass(frozen=True)
class ClearanceParameters:
    """How high the room over carriageway and walks is."""

    road_m: float = length(
        4.5,
        low=2.0,
        high=10.0,
        name=Text("Free over the carriageway", "車道の建築限界の高さ"),
        explanation=Text(
            "Road Structure Ordinance, article 12: 4.5 m; 4.0 m on small local roads with few "
            "large vehicles, 3.0 m on roads for small vehicles.",
            "道路構造令第12条では4.5 mです（大型車の少ない第3種第5級・第4種第4級の道路は"
            "4.0 mまで縮小可、小型道路は3.0 m）。",
        ),
    )
    walk_m: float = length(
        2.5,
        low=1.2,
        high=10.0,
        name=Text("Free over walks", "歩道の建築限界の高さ"),
        explanation=Text(
            "Road Structure Ordinance, article 12: 2.5 m.", "道路構造令第12条では2.5 mです。"
        ),
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to hang there is left out.",
            "支障物である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_clearance(
    drives: tuple[Drive, ...], parameters: ClearanceParameters, monitor: Monitor
) -> CandidateResult:
    """Places of a survey where something hangs too low: one result for all heads and passes."""
    found = street_clearance(drives, ClearanceLimits(parameters.road_m, parameters.walk_m), monitor)
    kept = [one for one in found.places if one.confidence >= parameters.least_confidence]
    candidates = tuple(_candidate(one) for one in kept)
    return CandidateResult(candidates, _note(drives, found, kept))


def _candidate(place: ClearancePlace) -> Candidate:
    first, last = place.stretch_m
    attributes: dict[str, CandidateValue] = {
        "thing": place.type,
        "told_by": "class" if place.is_classified else "shape",
        "above": "walk" if place.is_walk else "carriageway",
        "lowest_m": round(place.lowest_m, 2),
        "limit_m": place.limit_m,
        "length_m": round(last - first, 1),
        "inside_m": round(place.depth_m, 1),
    }
    return Candidate(
        _KIND,
        "point",
        place.xyz[None],
        np.array([place.point], np.int64),
        place.confidence,
        attributes,
        np.array([place.drive], np.int64),
        own_points=place.own_points,
        own_drives=place.own_drives,
    )


def _note(drives: Sequence[Drive], found: StreetClearance, kept: Sequence[ClearancePlace]) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if found.checked_m2 == 0:
        return Text(
            "No surface of a road was measured along the trajectory.",
            "軌跡に沿って計測された路面がありません。",
        )
    words = _found_note(found, kept)
    if found.seen_share < _MOSTLY_SEEN:
        return Text("{found} {edges}", "{found}{edges}").filled(
            found=words,
            edges=Text(
                "Along most of the road no curb or gutter was seen: 3 m to either side of the "
                "way were checked, 5 m where there is room.",
                "大半の区間で縁石・側溝が見えないため、走行軌跡の両側3 m"
                "（余裕がある側は5 m）を車道として判定しました。",
            ),
        )
    return words


def _found_note(found: StreetClearance, kept: Sequence[ClearancePlace]) -> Text:
    if not kept:
        return Text(
            f"Nothing hangs into the room over {found.checked_m2:,.0f} m² of carriageway.",
            f"車道{found.checked_m2:,.0f} m²の上に、建築限界を侵すものはありませんでした。",
        )
    lowest = sorted(kept, key=lambda one: one.lowest_m - one.limit_m)[:_SHOWN]
    heights = ", ".join(f"{one.lowest_m:.2f} m" for one in lowest)
    return Text(
        f"{len(kept)} places below the clearance; lowest: {heights}.",
        f"建築限界の支障箇所は{len(kept)}か所です（低いもの: {heights}）。",
    )


CLEARANCE = Tool(
    id="clearance",
    name=Text("Clearance over the road", "建築限界の確認"),
    explanation=Text(
        "Finds what hangs lower over carriageway and walks than the law lets it: branches, wires, "
        "signs, eaves, bridges.",
        "車道・歩道の建築限界を侵す枝・架線・標識・軒・橋などを、"
        "路面からの高さとともに抽出します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.TRAJECTORY,
    parameters=ClearanceParameters,
    method=SurveyFinder(find_clearance),
    makes=(_KIND,),
    button=ToolButton(
        Text("Check the clearance", "建築限界を確認"), "Ctrl+Shift+F1", "mdi6.arrow-expand-vertical"
    ),
    scorer=CLEARANCE_SCORER,
)
