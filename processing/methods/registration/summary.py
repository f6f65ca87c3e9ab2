"""What a registration is worth: gaps before and after, control points, how sure it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.methods.registration.control_points import LocatedPoint, Role
from processing.methods.registration.registration import SurveyRegistration
from processing.methods.registration.ties import TieKind, Ties
from processing.methods.registration.tracks import UNKNOWNS

_OUTLYING = 3.0
"""Standard deviations: a control point farther off is named and left out."""

_NOTABLE_M = 0.02
"""A control point that is off by less is never called wrong."""

_ANOTHER_M = 0.05
"""A check point that is off by more is another place."""

_EVALUATED = 400
"""Places in which sureness is worked out."""


@dataclass(frozen=True)
class Spread:
    """Absolute gaps: how many, their median and what 95 of 100 are below, m."""

    count: int
    median_m: float
    p95_m: float

    @staticmethod
    def of(gaps: Floats) -> Spread:
        """Of gaps, m."""
        size = np.abs(gaps)
        if not size.size:
            return Spread(0, float("nan"), float("nan"))
        return Spread(size.size, float(np.median(size)), float(np.percentile(size, 95)))


@dataclass(frozen=True)
class PairGaps:
    """Two drives: gaps at places that took no part in the adjustment.

    Attributes
    ----------
    first, second : int
        Among the drives.
    is_one_track : bool
        Two heads on one vehicle, or else two passes.
    before, after : Spread
    """

    first: int
    second: int
    is_one_track: bool
    before: Spread
    after: Spread


@dataclass(frozen=True)
class PointResidual:
    """A control point.

    Attributes
    ----------
    located : LocatedPoint
    before, after : (3,) float64
        Where the points show it minus where it is: east, north, up, m; NaN where unknown.
    is_wrong : bool
        Whether it fits nothing else, so that it was left out.
    """

    located: LocatedPoint
    before: Floats
    after: Floats
    is_wrong: bool


@dataclass(frozen=True)
class Sureness:
    """Standard deviations of corrected points of a track, m: the median over its length."""

    plan_m: float
    height_m: float
    worst_plan_m: float
    worst_height_m: float


def pair_gaps(found: SurveyRegistration) -> tuple[PairGaps, ...]:
    """Every two drives that saw something in common, at places kept out of the adjustment."""
    survey, ties = found.survey, found.ties
    pairs = np.unique(np.sort(ties.drive, axis=1), axis=0) if len(ties) else ties.drive
    gaps = []
    for first, second in pairs.tolist():
        mine = (np.sort(ties.drive, axis=1) == [first, second]).all(axis=1) & found.is_checked
        is_one = survey.track_of(first) == survey.track_of(second)
        gaps.append(
            PairGaps(
                first,
                second,
                is_one and first != second,
                Spread.of(ties.gap_m[mine]),
                Spread.of(found.after_m[mine]),
            )
        )
    return tuple(gaps)


def spreads(found: SurveyRegistration, *, of_one_track: bool) -> tuple[Spread, Spread]:
    """Before and after, between heads of one vehicle or between passes."""
    number = np.array([found.survey.track_of(n) for n in range(len(found.survey.drives))])
    drive = found.ties.drive
    is_one = (number[drive[:, 0]] == number[drive[:, 1]]) & (drive[:, 0] != drive[:, 1])
    mine = (is_one if of_one_track else ~is_one) & found.is_checked
    return Spread.of(found.ties.gap_m[mine]), Spread.of(found.after_m[mine])


def point_residuals(found: SurveyRegistration) -> tuple[PointResidual, ...]:
    """Every control and check point, before and after."""
    unknowns, solved = found.adjusted.unknowns, found.adjusted.solved
    residuals = []
    for located in found.located:
        ties = located.ties
        after = ties.gap_m + unknowns.design(ties) @ solved
        left = _offset(ties, after)
        residuals.append(
            PointResidual(located, _offset(ties, ties.gap_m), left, _is_wrong(located, after, left))
        )
    return tuple(residuals)


def _offset(ties: Ties, gaps: Floats) -> Floats:
    offset = np.full(3, np.nan)
    height = ties.kind == TieKind.CONTROL_HEIGHT
    if height.any():
        offset[2] = float(np.mean(gaps[height] / ties.direction[height, 2]))
    plan = ties.kind == TieKind.CONTROL_PLAN
    for axis in range(2):
        mine = plan & (ties.direction[:, axis] > 0.5)
        if mine.any():
            offset[axis] = float(np.mean(gaps[mine]))
    return offset


def _is_wrong(located: LocatedPoint, after: Floats, left: Floats) -> bool:
    if not len(located.ties):
        return False
    off = np.abs(after) / located.ties.sigma_m
    far = np.nanmax(np.abs(left))
    if located.point.role is Role.CHECK:
        # Checks tell what the registration is worth, so only what can't be the same place is left
        # out: another mark, or a mistake in the list.
        return bool(far > _ANOTHER_M)
    count = max(1, int((located.ties.kind == TieKind.CONTROL_HEIGHT).sum()))
    return bool(off.max() * np.sqrt(count) > _OUTLYING and far > _NOTABLE_M)


def rmse(residuals: tuple[PointResidual, ...], role: Role, *, after: bool) -> dict[str, Any]:
    """Root mean squares in plan and height of points of a role that aren't wrong."""
    kept = [one for one in residuals if one.located.point.role is role and not one.is_wrong]
    table = np.array([one.after if after else one.before for one in kept]).reshape(-1, 3)
    plan = np.hypot(table[:, 0], table[:, 1])
    plan, height = plan[np.isfinite(plan)], table[np.isfinite(table[:, 2]), 2]
    return {
        "points_plan": int(plan.size),
        "points_height": int(height.size),
        "rmse_plan_m": float(np.sqrt(np.mean(plan**2))) if plan.size else None,
        "rmse_height_m": float(np.sqrt(np.mean(height**2))) if height.size else None,
    }


def sureness(found: SurveyRegistration) -> tuple[Sureness, ...]:
    """How sure points of every track are, on the hard surfaces that were compared."""
    adjusted = found.adjusted
    result = []
    for number, track in enumerate(found.survey.tracks):
        spread = _spread_of_points(found, track.drives)
        if spread is None:
            table = adjusted.samples[adjusted.unknowns.knots(number)]
            spread = np.sqrt((table**2).mean(axis=1)).reshape(-1, UNKNOWNS)[:, :3]
        plan = np.hypot(spread[:, 0], spread[:, 1])
        result.append(
            Sureness(
                float(np.median(plan)),
                float(np.median(spread[:, 2])),
                float(plan.max()),
                float(spread[:, 2].max()),
            )
        )
    return tuple(result)


def _spread_of_points(found: SurveyRegistration, drives: tuple[int, ...]) -> Floats | None:
    ties = found.ties
    mine = np.flatnonzero(np.isin(ties.drive[:, 0], drives))
    if not mine.size:
        return None
    some = ties.chosen(mine[:: max(1, mine.size // _EVALUATED)])
    spread = np.empty((len(some), 3))
    for axis in range(3):
        alone = Ties(
            some.kind,
            some.place,
            np.column_stack([some.drive[:, 0], np.full(len(some), -1)]),
            some.time,
            some.xyz,
            np.repeat(np.eye(3)[axis : axis + 1], len(some), axis=0),
            some.gap_m,
            some.sigma_m,
        )
        off = found.adjusted.unknowns.design(alone) @ found.adjusted.samples
        spread[:, axis] = np.sqrt((off**2).mean(axis=1))
    return spread
