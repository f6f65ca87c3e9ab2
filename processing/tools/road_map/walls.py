"""The tool WALLS: feet of walls and retaining walls, faces of buildings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.walls.street_walls import StreetWall, street_walls
from processing.methods.road.walls.wall_diagnostics import wall_diagnostics
from processing.recording.drive import Drive
from processing.scoring.scorers import WALL_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_KINDS = {"wall": "wall", "retaining": "revetment_concrete", "building": "building_face"}

_TOLD_HIDDEN_M = 0.3


@dataclass(frozen=True)
class WallParameters:
    """Which walls are wanted, and at which height faces of buildings are drawn."""

    face_height_m: float = length(
        1.0,
        low=0.2,
        high=3.0,
        name=Text("Height of faces", "壁面線の高さ"),
        explanation=Text(
            "Above the ground before it, where the line of a building's face lies; higher where "
            "the face is seen from there on only.",
            "建物の壁面線を描く、前面の地面からの高さです。それより下が計測されていない場合は、"
            "計測された最も低い高さに描きます。",
        ),
    )
    shortest_m: float = length(
        1.0,
        low=0.5,
        high=50.0,
        name=Text("Shortest wall", "塀・壁面の最短の長さ"),
        explanation=Text(
            "Shorter pieces are left out: sides of porches and posts.",
            "これより短いものは出力しません。玄関の側面や門柱などです。",
        ),
    )
    lowest_m: float = length(
        0.4,
        low=0.3,
        high=3.0,
        name=Text("Lowest wall", "塀の最低の高さ"),
        explanation=Text(
            "What rises less above the ground before it is a curb or a step.",
            "前面の地面からの高さがこれより低いものは、縁石や段差とみなして出力しません。",
        ),
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a wall is left out.",
            "塀・擁壁・建物である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_walls(
    drives: tuple[Drive, ...], parameters: WallParameters, monitor: Monitor
) -> CandidateResult:
    """Walls of a survey: one result for all heads and passes."""
    found = street_walls(drives, parameters.face_height_m, monitor)
    kept = [
        one
        for one in found
        if one.confidence >= parameters.least_confidence
        and one.long_m >= parameters.shortest_m
        and one.height_m >= parameters.lowest_m
    ]
    return CandidateResult(tuple(_candidate(one) for one in kept), _note(drives, found, kept))


def diagnose_walls(asked: RequestedPosition, parameters: WallParameters) -> tuple[Diagnostic, ...]:
    """The faces through a section that are walls and those that are none."""
    return wall_diagnostics(
        asked, (parameters.shortest_m, parameters.lowest_m, parameters.least_confidence)
    )


def _candidate(wall: StreetWall) -> Candidate:
    attributes: dict[str, CandidateValue] = {"type": wall.type, "run": wall.run}
    if wall.type != "building":
        attributes["height_m"] = round(wall.height_m, 2)
        attributes["top_m"] = round(wall.top_m, 2)
    for name, width in zip(("opening_before_m", "opening_after_m"), wall.openings_m, strict=True):
        if width > 0:
            attributes[name] = round(width, 2)
    if wall.hidden_m >= _TOLD_HIDDEN_M:
        attributes["hidden_m"] = round(wall.hidden_m, 1)
    return Candidate(
        _KINDS[wall.type],
        "line",
        wall.line,
        wall.points,
        wall.confidence,
        attributes,
        wall.drives,
    )


def _note(drives: Sequence[Drive], found: Sequence[StreetWall], kept: Sequence[StreetWall]) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if not found:
        return Text(
            "Nothing upright and flat was measured beside the road.",
            "道路の両側に、塀や建物とみなせる鉛直な面は計測されていません。",
        )
    if not kept:
        return Text(
            f"None of {len(found)} upright faces is likely enough to be a wall.",
            f"鉛直な面{len(found)}件のうち、塀や建物とみなせるものはありませんでした。",
        )
    if all(drive.trajectory is None for drive in drives):
        return Text(
            "Without a trajectory the sides of walls are told by where more ground was seen.",
            "軌跡がないため、壁のどちら側が道路かは、地面の見え方で判定しています。",
        )
    return Text("", "")


WALLS = Tool(
    id="walls",
    name=Text("Walls and buildings", "塀・擁壁・建物の抽出"),
    explanation=Text(
        "Finds the feet of walls and retaining walls and the faces of buildings as lines, with "
        "heights and openings, from all heads and passes of a survey.",
        "塀・擁壁の下端と建物の壁面を、高さ・開口部とともに、"
        "全スキャナー・全走行のデータから線として抽出します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=WallParameters,
    method=SurveyFinder(find_walls),
    makes=("wall", "revetment_concrete", "building_face"),
    button=ToolButton(Text("Find walls", "塀・建物を抽出"), "Ctrl+Shift+F10", "mdi6.wall"),
    diagnostics=diagnose_walls,
    scorer=WALL_SCORER,
)
