"""The tool CURBS: upper and lower edges of curbs along the streets that were driven."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.parameters import angle, least_confidence, length
from processing.core.text import Text
from processing.methods.road.curbs.edges.approximate_lines import (
    ApproximateLine,
    approximate_lines_of,
)
from processing.methods.road.curbs.edges.curb_edges import (
    EdgeSettings,
    MeasuredEdges,
    measure_edges,
)
from processing.methods.road.curbs.edges.curb_evidence import (
    UsualMeasures,
    facts_of,
    is_front,
    noise_of,
    raised_by_others,
    usual_step_m,
)
from processing.methods.road.curbs.edges.curb_extension import extend_lines
from processing.methods.road.curbs.edges.curb_features import CurbFeature, EdgeLine, features_of
from processing.methods.road.curbs.edges.curb_fronts import PathSides, raised_shares
from processing.methods.road.curbs.edges.curb_joins import JointEdges, join_edges
from processing.methods.road.curbs.edges.curb_lines import CurbLine, lines_of
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, chance_of
from processing.methods.road.curbs.steps.curb_diagnostics import curb_diagnostics
from processing.methods.road.curbs.steps.curb_filters import (
    remove_inner_faces,
    remove_lone_edging,
    remove_rear_edges,
    step_runs,
)
from processing.methods.road.curbs.steps.curb_notes import note_on
from processing.methods.road.curbs.steps.curb_profile import StepSettings
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.scoring.scorers import CURB_SCORER
from processing.tools.tool import Candidate, CandidateResult, Needs, SurveyFinder, Tool, ToolButton

_FINDING = 0.7  # of the time goes into runs of steps
_LOOKING = Text("Looking for steps on the scanlines", "スキャンライン上の段差を探しています")
_FOLLOWING = Text("Following curbs beyond their ends", "縁石の端の先を追跡しています")
_MEASURING = Text("Measuring the edges of curbs", "縁石の上端・下端を計測しています")


@dataclass(frozen=True)
class CurbParameters:
    """The thesis' Table 6-1, and how far a curb goes on where nobody saw it."""

    lowest_m: float = length(
        0.03,
        low=0.01,
        high=0.2,
        name=Text("Lowest curb", "縁石の最小高"),
        explanation=Text(
            "Lower rises of the ground are no curbs; where one is dropped its step may be lower.",
            "これより低い段差は縁石とみなしません。切下げ部では、より低い段差も追跡します。",
        ),
        picture="curb/lowest",
    )
    highest_m: float = length(
        0.45,
        low=0.1,
        high=1.0,
        name=Text("Highest curb", "縁石の最大高"),
        explanation=Text(
            "What is higher is a wall, a hedge or a guard rail.",
            "これより高いものは、塀・生垣・ガードレールなどとみなします。",
        ),
        picture="curb/highest",
    )
    along_m: float = length(
        0.5,
        low=0.1,
        high=2.0,
        name=Text("Search range along the road", "道路縦断方向の探索範囲"),
        explanation=Text(
            "The planes of a curb are laid through the points this far before and behind a place; "
            "where points are dense, half as far.",
            "各位置から前後この距離までの点に縁石の面を当てはめます。点が密な場合は半分の範囲を使います。",
        ),
        picture="curb_along/along",
    )
    across_m: float = length(
        0.4,
        low=0.2,
        high=1.0,
        name=Text("Search range across the road", "道路横断方向の探索範囲"),
        explanation=Text(
            "And through the points this far to either side.",
            "各位置から左右この距離までの点に縁石の面を当てはめます。",
        ),
        picture="curb/across",
    )
    inlier_m: float = length(
        0.005,
        low=0.001,
        high=0.05,
        name=Text("Inlier tolerance", "平面の許容差"),
        explanation=Text(
            "Points this near to a plane lie on it.",
            "平面からこの距離以内の点を、その面の点とみなします。",
        ),
        picture="curb/inlier",
    )
    face_deg: float = angle(
        30.0,
        low=5.0,
        high=60.0,
        name=Text("Face to the vertical", "側面の傾きの上限"),
        explanation=Text(
            "The face of a curb leans by no more.",
            "縁石の側面と鉛直軸のなす角の上限です。",
        ),
        picture="curb/vertical",
    )
    ground_deg: float = angle(
        70.0,
        low=45.0,
        high=89.0,
        name=Text("Ground to the vertical", "水平面の角度の下限"),
        explanation=Text(
            "Carriageway and top make at least this angle with the vertical.",
            "車道面・天端面と鉛直軸のなす角の下限です。",
        ),
        picture="curb/horizontal",
    )
    joining_m: float = length(
        2.5,
        low=0.5,
        high=10.0,
        name=Text("Joining distance", "結合距離"),
        explanation=Text(
            "Places of a curb this near to each other are joined.",
            "この距離以内の縁石の点を1本の線に結びます。",
        ),
        picture="curb_along/joining",
    )
    bridge_m: float = length(
        8.0,
        low=0.0,
        high=30.0,
        name=Text("Longest bridge", "補間する最大長"),
        explanation=Text(
            "Behind parked cars a curb goes on over this length where it is seen on both sides; "
            "such stretches are marked.",
            "駐車車両などで隠れた区間は、両側で縁石が見えていればこの長さまで補間します（補間区間は記録されます）。",
        ),
        picture="curb_along/bridge",
    )
    least_confidence: float = least_confidence(
        0.6,
        Text(
            "Lines that are less likely to be curbs are left out.",
            "縁石である見込みがこの値より低い線は出力しません。",
        ),
    )


@dataclass(frozen=True)
class MeasuredCurb:
    """A line with exact edges, whether it is a curb or not.

    Attributes
    ----------
    approximate_line : ApproximateLine
    line : CurbLine
    measured : tuple of MeasuredEdges
        Of each drive.
    facts : CurbFacts
        What tells whether it is one.
    """

    approximate_line: ApproximateLine
    line: CurbLine
    measured: tuple[MeasuredEdges, ...]
    facts: CurbFacts


def step_settings(parameters: CurbParameters) -> StepSettings:
    """What the tool looks for on scanlines."""
    return StepSettings(
        least_step_m=parameters.lowest_m,
        most_step_m=parameters.highest_m,
        face_deg=parameters.face_deg,
        ground_deg=parameters.ground_deg,
        join_m=parameters.joining_m,
    )


def diagnose_curbs(asked: RequestedPosition, parameters: CurbParameters) -> tuple[Diagnostic, ...]:
    """What the tool makes of the steps on the scanline through a place."""
    return curb_diagnostics(asked, step_settings(parameters))


def find_curbs(
    drives: tuple[Drive, ...], parameters: CurbParameters, monitor: Monitor
) -> CandidateResult:
    """Curbs of a survey: one result for all heads and passes."""
    settings = step_settings(parameters)
    monitor.report(0.0, _LOOKING)
    runs = survey_runs(drives, settings, PartMonitor(monitor, 0.0, _FINDING))
    features: list[CurbFeature] = []
    for one in measure_curbs(drives, runs, parameters, PartMonitor(monitor, _FINDING, 1.0)):
        chance = chance_of(one.facts)
        if chance >= parameters.least_confidence:
            features.extend(features_of(one.approximate_line, one.line, one.measured, chance))
    return CandidateResult(
        curb_candidates(features), note_on(drives, runs, settings, len(features))
    )


def survey_runs(
    drives: Sequence[Drive], settings: StepSettings, monitor: Monitor
) -> tuple[StepRun, ...]:
    """Runs of all drives that are taken for curbs."""
    runs: list[StepRun] = []
    parts = parts_of(monitor, [drive.count for drive in drives])
    for number, (drive, part) in enumerate(zip(drives, parts, strict=True)):
        runs.extend(step_runs(drive, number, settings, part))
    # What hides the front of a stone from one scanner doesn't hide it from all.
    fronts = remove_lone_edging(remove_rear_edges(runs, settings), settings)
    return remove_inner_faces(fronts, settings)


def measure_curbs(
    drives: Sequence[Drive],
    runs: Sequence[StepRun],
    parameters: CurbParameters,
    monitor: Monitor,
) -> Iterator[MeasuredCurb]:
    """Exact edges of rough runs, by all that was measured about them."""
    bridge_m = max(parameters.bridge_m, parameters.joining_m)
    approximate_lines = approximate_lines_of(runs, bridge_m)
    if not approximate_lines:
        return
    settings = EdgeSettings(parameters.along_m, parameters.across_m, parameters.inlier_m)
    limits = (parameters.highest_m, bridge_m)
    monitor.report(0.0, _FOLLOWING)
    approximate_lines = extend_lines(
        approximate_lines, drives, settings, limits, PartMonitor(monitor, 0.0, 0.4)
    )
    rest = PartMonitor(monitor, 0.4, 1.0)
    rest.report(0.0, _MEASURING)
    measured = [
        measure_edges(drive, approximate_lines, settings, part)
        for drive, part in zip(drives, parts_of(rest, [d.count for d in drives]), strict=True)
    ]
    noise_m = noise_of([one.measures for ones in measured for one in ones])
    found: list[tuple[int, CurbLine, JointEdges]] = []
    for number, approximate_line in enumerate(approximate_lines):
        monitor.check()
        edges = join_edges([one[number].measures for one in measured], parameters.highest_m)
        found += [(number, line, edges) for line in lines_of(approximate_line, edges, bridge_m)]
    step_m = usual_step_m([line for _, line, _ in found])
    usual = UsualMeasures(parameters.inlier_m, noise_m, step_m)
    curbs: list[MeasuredCurb] = []
    for number, line, edges in found:
        monitor.check()
        ours = tuple(one[number] for one in measured)
        facts = facts_of((approximate_lines[number], line), runs, edges, ours, usual)
        curbs.append(MeasuredCurb(approximate_lines[number], line, ours, facts))
    fronts = [is_front(one.approximate_line, one.facts) for one in curbs]
    shares = raised_shares([one.line for one in curbs], fronts, PathSides(drives))
    for one, share in zip(curbs, shares, strict=True):
        yield replace(one, facts=raised_by_others(one.facts, share))


def curb_candidates(features: Sequence[CurbFeature]) -> tuple[Candidate, ...]:
    """Both edges of each stretch, as candidates."""
    return tuple(
        candidate
        for run, feature in enumerate(features, start=1)
        for candidate in (
            _candidate(feature, "upper", feature.upper, run),
            _candidate(feature, "lower", feature.lower, run),
        )
    )


def _candidate(feature: CurbFeature, edge: str, line: EdgeLine, run: int) -> Candidate:
    return Candidate(
        f"curb_{edge}",
        "line",
        line.xyz,
        line.points,
        feature.confidence,
        {
            "edge": edge,
            "run": run,
            "type": feature.type,
            "height_m": round(feature.height_m, 3),
            "bridged_m": round(feature.bridged_m, 2),
        },
        line.drives,
    )


CURBS = Tool(
    id="curbs",
    name=Text("Curbs", "縁石の抽出"),
    explanation=Text(
        "Finds the upper and lower edges of curbs and dropped curbs along the streets, from all "
        "heads and passes of a survey, as candidate lines.",
        "道路沿いの縁石と切下げの上端・下端を、全スキャナー・全走行のデータから抽出し、候補線を作成します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.TRAJECTORY,
    parameters=CurbParameters,
    method=SurveyFinder(find_curbs),
    makes=("curb_upper", "curb_lower"),
    button=ToolButton(Text("Find curbs", "縁石を抽出"), "F9", "mdi6.stairs"),
    diagnostics=diagnose_curbs,
    scorer=CURB_SCORER,
)
