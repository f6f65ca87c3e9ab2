"""Registration: what brings the drives of a survey onto each other and onto control points.

Twice the same: places are found that several visits saw, and the corrections that make them agree.
The second time points are compared where the first time has put them, and control points are
looked for in what all visits together show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from processing.core.arrays import Flags, Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.methods.registration.adjustment import Adjusted, adjust
from processing.methods.registration.control_points import (
    ControlPoint,
    LocatedPoint,
    Role,
    locate,
)
from processing.methods.registration.drift_correction import DriftCorrection
from processing.methods.registration.found_ties import CHECKED, find_ties
from processing.methods.registration.ties import NO_TIES, Ties
from processing.methods.registration.tracks import tracks_of
from processing.methods.registration.unknowns import Unknowns
from processing.methods.registration.visits import Survey
from processing.recording.drive import Drive

_FIRST, _ADJUSTED, _SECOND, _LOCATED = 0.35, 0.45, 0.8, 0.9
_FEWEST_TIES = 30
"""Fewer places in common tell no drift."""

_FEWEST_CONTROL = 3


@dataclass(frozen=True, eq=False)
class SurveyRegistration:
    """What a registration found.

    Attributes
    ----------
    survey : Survey
    adjusted : Adjusted
    corrections : tuple of DriftCorrection
        Of every drive.
    ties : Ties
        All places in common, gaps as delivered; those that took part and those kept out.
    after_m : (m,) float64
        Their gaps after it.
    is_checked : (m,) bool
        Which were kept out of the adjustment.
    located : tuple of LocatedPoint
    """

    survey: Survey
    adjusted: Adjusted
    corrections: tuple[DriftCorrection, ...]
    ties: Ties
    after_m: Floats
    is_checked: Flags
    located: tuple[LocatedPoint, ...]


def register_drives(
    drives: Sequence[Drive], control: Sequence[ControlPoint], monitor: Monitor
) -> SurveyRegistration:
    """Set drives on each other, and on control points where there are any.

    Raises
    ------
    Unsuitable
        A drive has no trajectory; nothing was seen twice and no control point is near; there are
        too few control points.
    Cancelled
    """
    _check_control(control)
    origin = np.floor(np.min([drive.info.lowest for drive in drives], axis=0))
    survey = Survey(tuple(drives), tracks_of(drives), origin)
    unknowns = Unknowns(survey)
    monitor.report(0.0, Text("Comparing what the drives saw", "走行データを比較中"))
    first = find_ties(survey, None, PartMonitor(monitor, 0.0, _FIRST))
    if len(first) < _FEWEST_TIES:
        _check_alone(survey, control)
        first = NO_TIES
    monitor.report(_FIRST, Text("Adjusting", "平差計算中"))
    solved = adjust(unknowns, first, PartMonitor(monitor, _FIRST, _ADJUSTED)).solved
    corrections = unknowns.corrections(solved)
    ties = first
    if len(first):
        monitor.report(_ADJUSTED, Text("Comparing once more", "再比較中"))
        moved = find_ties(survey, corrections, PartMonitor(monitor, _ADJUSTED, _SECOND))
        ties = _as_delivered(moved, unknowns, solved)
    located = _located(survey, control, corrections, PartMonitor(monitor, _SECOND, _LOCATED))
    located = tuple(replace(one, ties=_as_delivered(one.ties, unknowns, solved)) for one in located)
    _check_found(located)
    monitor.report(_LOCATED, Text("Adjusting", "平差計算中"))
    is_checked = ties.place % CHECKED == 0
    taking_part = Ties.joined(
        [
            ties.chosen(~is_checked),
            *(one.ties for one in located if one.point.role is Role.CONTROL),
        ]
    )
    adjusted = adjust(unknowns, taking_part, PartMonitor(monitor, _LOCATED, 1.0))
    after = ties.gap_m + unknowns.design(ties) @ adjusted.solved
    return SurveyRegistration(
        survey,
        adjusted,
        unknowns.corrections(adjusted.solved),
        ties,
        after,
        is_checked,
        located,
    )


def _as_delivered(ties: Ties, unknowns: Unknowns, solved: Floats) -> Ties:
    """Gaps as they are without the corrections with which they were measured."""
    return replace(ties, gap_m=ties.gap_m - unknowns.design(ties) @ solved)


def _located(
    survey: Survey,
    control: Sequence[ControlPoint],
    corrections: tuple[DriftCorrection, ...],
    monitor: Monitor,
) -> tuple[LocatedPoint, ...]:
    found = []
    for number, point in enumerate(control):
        monitor.report(number / len(control), _LOOKING)
        monitor.check()
        found.append(locate(survey, point, number, corrections, monitor))
    return tuple(found)


_LOOKING = Text("Looking for control points", "標定点を探索中")


def _check_control(control: Sequence[ControlPoint]) -> None:
    used = [point for point in control if point.role is Role.CONTROL]
    if 0 < len(used) < _FEWEST_CONTROL:
        raise Unsuitable(
            Text(
                "Fewer than three control points are too few: a wrong one couldn't be found.",
                "標定点が3点未満では、誤った点を検出できないため位置合わせに使えません。",
            ),
            Text.same(", ".join(point.id for point in used)),
            Text(
                "Give three or more, or give these the role “check”.",
                "3点以上を指定するか、これらの役割を「check」にしてください。",
            ),
        )


def _check_alone(survey: Survey, control: Sequence[ControlPoint]) -> None:
    if any(point.role is Role.CONTROL for point in control):
        return
    names = ", ".join(drive.info.name for drive in survey.drives)
    remedy = Text(
        "Give drives that pass the same street, or control points with --set control=FILE.csv.",
        "同じ道路を走行したデータを指定するか、--set control=FILE.csv で標定点を指定してください。",
    )
    if len(survey.drives) == 1:
        raise Unsuitable(
            Text(
                "One drive that passes a street once has nothing to be set on.",
                "1回だけ走行した単独の走行データには、合わせる相手がありません。",
            ),
            Text.same(names),
            remedy,
        )
    raise Unsuitable(
        Text(
            "The drives have hardly any hard surface in common.",
            "走行データに共通する固い面がほとんどありません。",
        ),
        Text.same(names),
        remedy,
    )


def _check_found(located: Sequence[LocatedPoint]) -> None:
    used = [one for one in located if one.point.role is Role.CONTROL]
    seen = [one for one in used if len(one.ties)]
    if used and len(seen) < _FEWEST_CONTROL:
        raise Unsuitable(
            Text(
                "Ground was measured around fewer than three of the control points.",
                "標定点のうち、周囲の地面が計測されている点は3点未満です。",
            ),
            Text(
                f"{len(seen)} of {len(used)} control points; first: {used[0].point.id}",
                f"{len(used)} 点のうち {len(seen)} 点。先頭の点：{used[0].point.id}",
            ),
            Text(
                "Check the coordinates, their zone and the order of easting and northing.",
                "座標値、系番号、東と北の列の順序を確認してください。",
            ),
        )
