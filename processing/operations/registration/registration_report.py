"""The report of a registration: numbers as JSON and CSV, and a few lines for the terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from processing.core.text import Text
from processing.methods.registration.control_points import Role
from processing.methods.registration.registration import SurveyRegistration
from processing.methods.registration.summary import (
    PointResidual,
    Spread,
    Sureness,
    pair_gaps,
    point_residuals,
    rmse,
    spreads,
    sureness,
)
from processing.methods.registration.ties import TieKind
from processing.methods.registration.tracks import UNKNOWNS

_MILLIMETRES = 1000.0
_DECIMALS = 5

# Any: whatever JSON can hold.
Json = dict[str, Any]


def report_of(
    found: SurveyRegistration, files: Mapping[str, str], trajectories: tuple[str, ...]
) -> Json:
    """All numbers of a registration, as JSON holds them.

    Parameters
    ----------
    files : mapping of str to str
        From each delivered file to the corrected one's name.
    trajectories : tuple of str
        Names of the corrected trajectories' files.
    """
    residuals = point_residuals(found)
    return {
        "files": dict(files),
        "drives": [_drive(found, number) for number in range(len(found.survey.drives))],
        "trajectories": [
            _track(found, number, name, one)
            for number, (name, one) in enumerate(zip(trajectories, sureness(found), strict=True))
        ],
        "between_drives": _between(found),
        "control_points": [_point(one) for one in residuals],
        "control": _both(residuals, Role.CONTROL),
        "check": _both(residuals, Role.CHECK),
        "notes": [{"en": one.en, "ja": one.ja} for one in notes_of(found, residuals)],
    }


def _drive(found: SurveyRegistration, number: int) -> Json:
    drive, correction = found.survey.drives[number], found.corrections[number]
    mounting = correction.mounting
    spread = _spread(found, found.adjusted.unknowns.head(number))
    return {
        "name": drive.info.name,
        "points": drive.count,
        "trajectory": found.survey.track_of(number),
        "boresight_deg": _rounded(np.degrees(mounting[:3]), _DECIMALS + 1),
        "boresight_sigma_deg": _rounded(np.degrees(spread[:3]), _DECIMALS + 1),
        "lever_arm_m": _rounded(mounting[3:]),
        "lever_arm_sigma_m": _rounded(spread[3:]),
    }


def _spread(found: SurveyRegistration, which: slice) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.asarray(np.sqrt((found.adjusted.samples[which] ** 2).mean(axis=1)))


def _track(found: SurveyRegistration, number: int, name: str, sure: Sureness) -> Json:
    track = found.survey.tracks[number]
    knots = found.adjusted.solved[found.adjusted.unknowns.knots(number)].reshape(-1, UNKNOWNS)
    return {
        "file": name,
        "drives": [found.survey.drives[one].info.name for one in track.drives],
        "from_s": float(track.knots[0]),
        "to_s": float(track.knots[-1]),
        "largest_shift_m": _rounded(np.abs(knots[:, :3]).max(axis=0)),
        "largest_turn_deg": _rounded(np.degrees(np.abs(knots[:, 3:]).max(axis=0)), _DECIMALS + 1),
        "sigma_plan_m": round(sure.plan_m, _DECIMALS),
        "sigma_height_m": round(sure.height_m, _DECIMALS),
        "largest_sigma_plan_m": round(sure.worst_plan_m, _DECIMALS),
        "largest_sigma_height_m": round(sure.worst_height_m, _DECIMALS),
    }


def _between(found: SurveyRegistration) -> Json:
    passes, heads = (spreads(found, of_one_track=one) for one in (False, True))
    names = [drive.info.name for drive in found.survey.drives]
    return {
        "passes": {"before": _gaps(passes[0]), "after": _gaps(passes[1])},
        "heads": {"before": _gaps(heads[0]), "after": _gaps(heads[1])},
        "pairs": [
            {
                "first": names[pair.first],
                "second": names[pair.second],
                "relation": "heads" if pair.is_one_track else "passes",
                "before": _gaps(pair.before),
                "after": _gaps(pair.after),
            }
            for pair in pair_gaps(found)
        ],
    }


def _gaps(spread: Spread) -> Json:
    return {
        "places": spread.count,
        "median_m": _number(spread.median_m),
        "p95_m": _number(spread.p95_m),
    }


def _point(residual: PointResidual) -> Json:
    located = residual.located
    mark = located.mark
    return {
        "id": located.point.id,
        "role": located.point.role.value,
        "measured": bool(len(located.ties)),
        "plan_by": None if mark is None else mark.kind,
        "left_out": residual.is_wrong,
        "before_m": [_number(one) for one in residual.before.tolist()],
        "after_m": [_number(one) for one in residual.after.tolist()],
    }


def _both(residuals: tuple[PointResidual, ...], role: Role) -> Json:
    return {
        "before": rmse(residuals, role, after=False),
        "after": rmse(residuals, role, after=True),
    }


def notes_of(found: SurveyRegistration, residuals: tuple[PointResidual, ...]) -> tuple[Text, ...]:
    """What a reader has to know beside the numbers, each in a sentence."""
    notes = [
        Text(
            "Control point {id} doesn't fit and was left out: it is off by {off:.3f} m.",
            "標定点 {id} は適合しないため除外しました（差 {off:.3f} m）。",
        ).filled(id=one.located.point.id, off=float(np.nanmax(np.abs(one.after))))
        for one in residuals
        if one.is_wrong
    ]
    unseen = [one.located.point.id for one in residuals if not len(one.located.ties)]
    if unseen:
        notes.append(
            Text(
                "No ground was measured around: {ids}.", "周囲の地面が計測されていない点：{ids}"
            ).filled(ids=", ".join(unseen))
        )
    level = [
        one.located.point.id for one in residuals if len(one.located.ties) and not one.located.mark
    ]
    if level:
        notes.append(
            Text(
                "Only the height is used, as no corner or foot was found: {ids}.",
                "角や支柱の根元が見つからず、高さだけを使う点：{ids}",
            ).filled(ids=", ".join(level))
        )
    return (*notes, *_weak(found))


def _weak(found: SurveyRegistration) -> list[Text]:
    alone = [
        drive.info.name
        for number, drive in enumerate(found.survey.drives)
        if not (found.ties.drive == number).any()
    ]
    notes = []
    if alone:
        notes.append(
            Text(
                "Nothing that another drive saw: {names}.",
                "他の走行データと共通する面がないデータ：{names}",
            ).filled(names=", ".join(alone))
        )
    if not (found.ties.kind == TieKind.UPRIGHT).any() and len(found.ties):
        notes.append(
            Text(
                "No upright surfaces were seen twice: plan rests on the trajectories.",
                "共通の鉛直面がないため、平面位置は走行軌跡によります。",
            )
        )
    return notes


def registration_words(found: SurveyRegistration) -> tuple[Text, ...]:
    """What a registration came to, in a few lines."""
    residuals = point_residuals(found)
    before, after = spreads(found, of_one_track=False)
    lines = []
    if after.count:
        lines.append(
            Text(
                "Between passes: median {a:.1f} -> {b:.1f} mm, 95 % {c:.1f} -> {d:.1f} mm",
                "往復間：中央値 {a:.1f} → {b:.1f} mm、95 % {c:.1f} → {d:.1f} mm",
            ).filled(
                a=before.median_m * _MILLIMETRES,
                b=after.median_m * _MILLIMETRES,
                c=before.p95_m * _MILLIMETRES,
                d=after.p95_m * _MILLIMETRES,
            )
        )
    return (*lines, *notes_of(found, residuals))


def residual_table(found: SurveyRegistration) -> str:
    """Gaps at the places kept out of the adjustment, as CSV: along the way, before and after."""
    names = [drive.info.name for drive in found.survey.drives]
    lines = ["first,second,time_s,easting_m,northing_m,height_m,surface,before_m,after_m"]
    ties = found.ties
    places = ties.xyz[:, 0] + found.survey.origin
    for row in np.flatnonzero(found.is_checked).tolist():
        one, other = ties.drive[row].tolist()
        surface = TieKind(int(ties.kind[row])).name.lower()
        east, north, up = places[row].tolist()
        lines.append(
            f"{names[one]},{names[other]},{ties.time[row, 0]:.3f},{east:.3f},{north:.3f},{up:.3f},"
            f"{surface},{ties.gap_m[row]:.5f},{found.after_m[row]:.5f}"
        )
    return "\n".join(lines) + "\n"


def drift_table(found: SurveyRegistration, number: int) -> str:
    """The correction of a track knot by knot, as CSV, with standard deviations."""
    unknowns = found.adjusted.unknowns
    mine = unknowns.knots(number)
    values = found.adjusted.solved[mine].reshape(-1, UNKNOWNS)
    spread = _spread(found, mine).reshape(-1, UNKNOWNS)
    table = np.column_stack(
        [
            found.survey.tracks[number].knots,
            values[:, :3],
            np.degrees(values[:, 3:]) * [1.0, -1.0, -1.0],
            spread[:, :3],
            np.degrees(spread[:, 3:]),
        ]
    )
    names = ("easting_m", "northing_m", "height_m", "roll_deg", "pitch_deg", "heading_deg")
    header = ["time_s", *(f"d_{name}" for name in names), *(f"sigma_{name}" for name in names)]
    lines = [",".join(header)]
    lines += [",".join([f"{row[0]:.6f}", *(f"{one:.6f}" for one in row[1:])]) for row in table]
    return "\n".join(lines) + "\n"


def _rounded(values: Any, decimals: int = _DECIMALS) -> list[float]:  # any sequence of numbers
    return [round(float(one), decimals) for one in values]


def _number(value: float) -> float | None:
    return round(value, _DECIMALS) if math.isfinite(value) else None
