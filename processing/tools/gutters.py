"""The tool GUTTERS: lids and gratings of covered gutters, with the gutters' outline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.parameters import count, least_confidence, length
from processing.core.text import Text
from processing.methods.road.curbs.edges.curb_points import LineCells
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.gutters.grating_facts import GratingFound, one_of_each
from processing.methods.road.gutters.gratings import GratingParameters, gratings_of
from processing.methods.road.gutters.gutter_bars import barred_run
from processing.methods.road.gutters.gutter_confidence import CoverFacts, chance_of, facts_of
from processing.methods.road.gutters.gutter_gratings import RatedCovers, add_gratings
from processing.methods.road.gutters.gutter_lids import POINTS_WITHIN_M, GutterCover, covers_of
from processing.methods.road.gutters.gutter_lines import REACH_M
from processing.methods.road.gutters.gutter_outline import edge_lines
from processing.methods.road.gutters.gutter_runs import GutterRun, gutter_runs
from processing.methods.road.gutters.notches.gutter_notches import notches_of
from processing.methods.road.gutters.notches.notch_diagnostics import notch_diagnostics
from processing.methods.road.gutters.notches.notches import Notches, NotchParameters
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.recording.passes import passes_of
from processing.scoring.scorers import GUTTER_SCORER
from processing.tools.tool import Candidate, CandidateResult, Needs, SurveyFinder, Tool, ToolButton

_FINDING = 0.8  # of the time goes into notches
_OUTLINE_GAP_M = 6.0
_FEW_NOTCHES = 10

_LOOKING = Text("Looking for drain holes", "水抜き穴を探しています")
_LAYING = Text("Laying the lids", "側溝蓋を配置しています")
_NO_PASS = Text(
    "The vehicle does not move along a road in any drive, so no gutters were looked for.",
    "どの走行データでも車両が道路に沿って走行していないため、側溝を探索できません。",
)
_NO_NOTCHES = Text(
    "No drain holes were found beside the vehicle's path: the road has no covered gutter, the "
    "holes are filled, or the points are too sparse to fall into them.",
    "走行軌跡の周辺に水抜き穴が見つかりません（蓋付き側溝がない、穴が土砂等で塞がっている、"
    "または点密度が不足しています）。",
)
_NOT_REGULAR = Text(
    "There are dents in the road, but nowhere at the regular spacing of lids, nor as close as in "
    "a grating.",
    "路面にくぼみはありますが、側溝蓋の間隔で規則的に並ぶものも、グレーチングのように密集するものも"
    "ありません。",
)


@dataclass(frozen=True)
class GutterParameters:
    """What an operator may set; defaults by the thesis' Table 7-3 where it has them."""

    reach_m: float = length(
        REACH_M,
        low=1.0,
        high=20.0,
        name=Text("Reach beside the vehicle", "探索範囲（車両からの離れ）"),
        explanation=Text(
            "Gutters farther from the vehicle's path are not looked for: few points fall there.",
            "走行軌跡からこの距離より離れた側溝は探索しません（穴に入る点が少ないため）。",
        ),
        picture="vehicle/reach",
    )
    aside_m: float = length(
        0.02,
        low=0.005,
        high=0.2,
        name=Text("Least jump aside (h_t)", "水平変化量の下限（h_t）"),
        explanation=Text(
            "How far a point that fell into a hole lies aside of its neighbours at least.",
            "穴に入った点が前後の点から水平方向にずれる量の最小値です。",
        ),
        picture="hole/aside",
    )
    down_m: float = length(
        0.01,
        low=0.003,
        high=0.2,
        name=Text("Least drop (z_t)", "鉛直変化量の下限（z_t）"),
        explanation=Text(
            "How far such a point lies below its neighbours at least.",
            "穴に入った点が前後の点より下がる量の最小値です。",
        ),
        picture="hole/down",
    )
    most_missed: int = count(
        5,
        low=1,
        high=20,
        name=Text("Lids bridged (n_max)", "補間する蓋の枚数（n_max）"),
        explanation=Text(
            "Fewer lids in a row without a hole are laid all the same; more break the gutter.",
            "穴が確認できない蓋の連続がこの枚数未満であれば補間し、それ以上は途切れとします。",
        ),
        picture="lids/most",
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "Lids that are less likely to be right are left out.",
            "正しい見込みがこの値より低い蓋は出力しません。",
        ),
    )


def find_gutters(
    drives: tuple[Drive, ...], parameters: GutterParameters, monitor: Monitor
) -> CandidateResult:
    """Lids, gratings and outlines on all drives of a survey.

    References
    ----------
    Takahashi 2022, chapter 7; mms.md, 7.3.
    """
    passes = [one for drive in drives for one in passes_of(drive)]
    if not passes:
        return CandidateResult(note=_NO_PASS)
    monitor.report(0.0, _LOOKING)
    notches = _notches(drives, parameters, PartMonitor(monitor, 0.0, _FINDING))
    if sum(one.count for one in notches) < _FEW_NOTCHES:
        return CandidateResult(note=_NO_NOTCHES)
    monitor.report(_FINDING, _LAYING)
    laid, gratings = _evidence(drives, notches, parameters, PartMonitor(monitor, _FINDING, 1.0))
    candidates = [*_choose_candidates(laid, gratings, parameters.least_confidence)]
    if not candidates:
        return CandidateResult(note=_NOT_REGULAR)
    return CandidateResult(tuple(candidates))


@dataclass(frozen=True)
class CoveredGutter:
    """One gutter with all its covers.

    Attributes
    ----------
    run : GutterRun
    covers : tuple of GutterCover
    facts : tuple of CoverFacts
        What is known of each.
    """

    run: GutterRun
    covers: tuple[GutterCover, ...]
    facts: tuple[CoverFacts, ...]


def gutter_evidence(
    drives: tuple[Drive, ...], parameters: GutterParameters, monitor: Monitor
) -> tuple[list[CoveredGutter], tuple[GratingFound, ...]]:
    """All gutters and gratings of a survey, none left out that is not sure."""
    notches = _notches(drives, parameters, PartMonitor(monitor, 0.0, _FINDING))
    return _evidence(drives, notches, parameters, PartMonitor(monitor, _FINDING, 1.0))


def _evidence(
    drives: tuple[Drive, ...],
    notches: Sequence[Notches],
    parameters: GutterParameters,
    monitor: Monitor,
) -> tuple[list[CoveredGutter], tuple[GratingFound, ...]]:
    gratings = one_of_each(
        replace(found, drive=number)
        for number, (drive, own) in enumerate(zip(drives, notches, strict=True))
        for found in gratings_of(drive, own, GratingParameters(), monitor)
    )
    passes = [one for drive in drives for one in passes_of(drive)]
    missed, reach_m = parameters.most_missed, parameters.reach_m
    runs = gutter_runs(passes, notches, missed, reach_m, monitor) if passes else ()
    if not runs:
        return [], gratings
    cells = LineCells([one.axis for one in runs], POINTS_WITHIN_M)
    parts = parts_of(monitor, [drive.count for drive in drives])
    about = [cells.about(drive, part) for drive, part in zip(drives, parts, strict=True)]
    laid = []
    for number, found in enumerate(runs):
        monitor.check()
        own = [(one, slice(one.starts[number], one.starts[number + 1])) for one in about]
        run = barred_run(found, drives, own, missed)
        covers = covers_of(run, number, about)
        laid.append(CoveredGutter(run, covers, tuple(facts_of(run, covers, notches))))
    return laid, gratings


def _choose_candidates(
    laid: Sequence[CoveredGutter], gratings: tuple[GratingFound, ...], least: float
) -> Iterator[Candidate]:
    """Covers of all gutters that are sure enough, then the gratings beside them."""
    gratings = tuple(one for one in gratings if one.confidence >= least)
    for number, one in enumerate(laid, 1):
        sure = np.array([chance_of(facts) for facts in one.facts])
        own, gratings = add_gratings(one.run.axis, RatedCovers(one.covers, sure), gratings)
        is_kept = own.sure >= least
        kept = [cover for cover, keep in zip(own.covers, is_kept, strict=True) if keep]
        yield from _candidates(kept, own.sure[is_kept], number)
    for number, found in enumerate(gratings, len(laid) + 1):
        yield _basin(found, number)


def notch_parameters(parameters: GutterParameters) -> NotchParameters:
    """What counts as a notch by the tool's parameters."""
    return replace(
        NotchParameters(),
        reach_m=parameters.reach_m,
        aside_m=parameters.aside_m,
        down_m=parameters.down_m,
    )


def diagnose_gutters(
    asked: RequestedPosition, parameters: GutterParameters
) -> tuple[Diagnostic, ...]:
    """What the tool makes of the dents on the scanline through a place."""
    return notch_diagnostics(asked, notch_parameters(parameters))


def _notches(
    drives: Sequence[Drive], parameters: GutterParameters, monitor: Monitor
) -> list[Notches]:
    wanted = notch_parameters(parameters)
    parts = parts_of(monitor, [drive.count for drive in drives])
    return [notches_of(drive, wanted, part) for drive, part in zip(drives, parts, strict=True)]


def _candidates(
    covers: Sequence[GutterCover], sure: NDArray[np.float64], run: int
) -> Iterator[Candidate]:
    for one, confidence in zip(covers, sure.tolist(), strict=True):
        yield Candidate(
            "gutter_grating" if one.is_grating else "gutter_lid",
            "area",
            one.corners,
            np.array(one.points, np.int64),
            confidence,
            {
                "type": "grating" if one.is_grating else "lid",
                "width_m": round(one.width_m, 3),
                "length_m": round(one.length_m, 3),
                "evidence": "bridged" if one.is_bridged else "seen",
                "run": run,
            },
            drives=np.array(one.drives, np.int64),
        )
    for edge in edge_lines(covers, _OUTLINE_GAP_M):
        yield Candidate(
            "gutter_covered",
            "line",
            edge,
            np.full(len(edge), -1, np.int64),
            float(np.mean(sure)),
            {"width_m": round(covers[0].width_m, 3), "run": run},
            is_drawing=True,
        )


def _basin(one: GratingFound, run: int) -> Candidate:
    """A grating by itself: the cover of a catch basin."""
    return Candidate(
        "gutter_grating",
        "area",
        one.corners,
        np.array(one.points, np.int64),
        one.confidence,
        {
            "type": "grating",
            "width_m": round(one.width_m, 3),
            "length_m": round(one.length_m, 3),
            "evidence": "seen",
            "run": run,
        },
        drives=np.full(4, one.drive, np.int64),
    )


GUTTERS = Tool(
    id="gutters",
    name=Text("Covered gutters", "蓋付き側溝"),
    explanation=Text(
        "Finds the lids and gratings of covered U-shaped gutters by their drain holes and regular "
        "joints, and draws the gutters' outline.",
        "蓋付きU字溝の側溝蓋・グレーチングを、水抜き穴と規則的な継ぎ目から抽出し、"
        "側溝の外形線を描きます。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.TRAJECTORY,
    parameters=GutterParameters,
    method=SurveyFinder(find_gutters),
    makes=("gutter_lid", "gutter_grating", "gutter_covered"),
    button=ToolButton(
        Text("Find covered gutters", "蓋付き側溝を抽出"), "Shift+F9", "mdi6.view-parallel-outline"
    ),
    diagnostics=diagnose_gutters,
    scorer=GUTTER_SCORER,
)
