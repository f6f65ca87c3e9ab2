"""Control points: places that were surveyed by themselves, and where the points show them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.registration.control_marks import FoundMark, find_corner, find_foot
from processing.methods.registration.drift_correction import DriftCorrection
from processing.methods.registration.ties import NO_TIES, TieKind, Ties
from processing.methods.registration.visits import Area, Survey, Visit, visits_of

SURVEYED_M = 0.005
"""Standard deviation of a control point itself, measured by total station or GNSS with care."""

_AROUND_M = 1.0
_NEAR_M = 20.0
_GROUND_M = 0.4
"""Radius in which ground is taken for a plane."""

_LAYER_M = 0.5
_FEWEST = 15
_ROUGHEST_M = 0.015
_CLOSEST_M = 0.002
"""What a plane through many points can't tell better: grains of asphalt."""

_TURNS = 4


class Role(Enum):
    """Whether a point takes part in the adjustment or checks it."""

    CONTROL = "control"
    CHECK = "check"


@dataclass(frozen=True, eq=False)
class ControlPoint:
    """A surveyed point.

    Attributes
    ----------
    id : str
    xyz : (3,) float64
        m, project CRS.
    role : Role
    where : str
        What it is on, as its file says; empty where it doesn't.
    """

    id: str
    xyz: Floats
    role: Role = Role.CONTROL
    where: str = ""


@dataclass(frozen=True, eq=False)
class LocatedPoint:
    """A control point in the points.

    Attributes
    ----------
    point : ControlPoint
    ties : Ties
        Of the visits that saw it; none where nobody did.
    mark : FoundMark or None
        What tells its place in plan; None where only its height is known.
    """

    point: ControlPoint
    ties: Ties
    mark: FoundMark | None


def locate(
    survey: Survey,
    point: ControlPoint,
    number: int,
    corrections: tuple[DriftCorrection, ...],
    monitor: Monitor,
) -> LocatedPoint:
    """Find a control point in the points of all visits, set on each other by corrections.

    Notes
    -----
    Its height is that of the ground about it as each visit saw it. Its place in plan is told by the
    corner of a marking or the foot of a pole, found in all visits together: what they see of it
    is little each, and they lie within millimetres of each other already.
    """
    low = point.xyz[:2] - _AROUND_M
    area = Area(float(low[0]), float(low[1]), 2 * _AROUND_M, _NEAR_M)
    visits = visits_of(survey, area, corrections, check=monitor.check, fewest=1)
    place = point.xyz - survey.origin
    grounds = [(visit, ground) for visit in visits if (ground := _ground(visit, place)) is not None]
    if not grounds:
        return LocatedPoint(point, NO_TIES, None)
    mark = _mark(point, place, grounds)
    parts = [_height_ties(grounds, place, number)]
    if mark is not None:
        parts.append(_plan_ties([visit for visit, _ in grounds], mark, place, number))
    return LocatedPoint(point, Ties.joined(parts), mark)


@dataclass(frozen=True, eq=False)
class _Ground:
    """The ground about a place: height there, normal, how sure, and which points lie on it."""

    height: float
    normal: Floats
    sigma_m: float
    time: float
    points: Integers


def _ground(visit: Visit, place: Floats) -> _Ground | None:
    about = visit.xyz - place
    near = np.flatnonzero(
        (np.hypot(about[:, 0], about[:, 1]) < _GROUND_M) & (np.abs(about[:, 2]) < _LAYER_M)
    )
    if near.size < _FEWEST:
        return None
    # The ground is the lowest layer: half of the points about a pole are the pole's.
    low = np.percentile(about[near, 2], 10)
    kept = near[np.abs(about[near, 2] - low) < 4 * _ROUGHEST_M + 0.1 * _GROUND_M]
    plane, off = np.zeros(3), np.zeros(kept.size)
    for _ in range(_TURNS):
        if kept.size < _FEWEST:
            return None
        matrix = np.column_stack([about[kept, :2], np.ones(kept.size)])
        plane = np.linalg.lstsq(matrix, about[kept, 2], rcond=None)[0]
        whole = about[near, 2] - about[near, :2] @ plane[:2] - plane[2]
        off = about[kept, 2] - matrix @ plane
        scatter = 1.4826 * float(np.median(np.abs(off)))
        kept = near[np.abs(whole) < max(3 * scatter, _CLOSEST_M)]
    scatter = float(np.std(off))
    if scatter > _ROUGHEST_M or kept.size < _FEWEST:
        return None
    normal = np.array([-plane[0], -plane[1], 1.0])
    normal /= np.linalg.norm(normal)
    sigma = float(np.hypot(scatter / np.sqrt(kept.size), _CLOSEST_M))
    return _Ground(float(plane[2]), normal, sigma, float(visit.time[kept].mean()), kept)


def _mark(
    point: ControlPoint, place: Floats, grounds: list[tuple[Visit, _Ground]]
) -> FoundMark | None:
    words = point.where.lower()
    about = [visit.xyz - place for visit, _ in grounds]
    if not any(word in words for word in ("pole", "foot", "柱", "ポール")):
        tones = [visit.intensity for visit, _ in grounds]
        on = [ground.points for _, ground in grounds]
        flat = [one[rows, :2] for one, rows in zip(about, on, strict=True)]
        tone = [
            one[rows] / max(float(np.median(one[rows])), 1.0)
            for one, rows in zip(tones, on, strict=True)
        ]
        corner = find_corner(np.concatenate(flat), np.concatenate(tone))
        if corner is not None:
            return corner
    if not any(word in words for word in ("corner", "marking", "隅", "標示")):
        return find_foot(np.concatenate(about))
    return None


def _height_ties(grounds: list[tuple[Visit, _Ground]], place: Floats, number: int) -> Ties:
    drive = np.array([[visit.drive, -1] for visit, _ in grounds])
    normal = np.array([ground.normal for _, ground in grounds])
    height = np.array([ground.height for _, ground in grounds])
    time = np.array([[ground.time] * 2 for _, ground in grounds])
    own = np.array([ground.sigma_m for _, ground in grounds])
    # The point's own error is the same for all visits.
    sigma = np.hypot(own, SURVEYED_M * np.sqrt(len(grounds)))
    return Ties(
        np.full(len(grounds), int(TieKind.CONTROL_HEIGHT), np.int64),
        np.full(len(grounds), number, np.int64),
        drive,
        time,
        np.broadcast_to(place, (len(grounds), 2, 3)).copy(),
        normal,
        height * normal[:, 2],
        sigma,
    )


def _plan_ties(visits: list[Visit], mark: FoundMark, place: Floats, number: int) -> Ties:
    count = len(visits)
    times = np.array([float(_time_near(visit, place)) for visit in visits])
    sigma = np.sqrt(count) * np.hypot(mark.sigma_m, SURVEYED_M)
    direction = np.repeat(np.eye(3)[:2], count, axis=0)
    return Ties(
        np.full(2 * count, int(TieKind.CONTROL_PLAN), np.int64),
        np.full(2 * count, number, np.int64),
        np.column_stack([np.tile([visit.drive for visit in visits], 2), np.full(2 * count, -1)]),
        np.tile(times[:, None], (2, 2)),
        np.broadcast_to(place, (2 * count, 2, 3)).copy(),
        direction,
        np.repeat(mark.offset[:2], count),
        np.full(2 * count, sigma),
    )


def _time_near(visit: Visit, place: Floats) -> float:
    away = np.hypot(*(visit.xyz[:, :2] - place[:2]).T)
    nearest = np.argsort(away)[:_FEWEST]
    return float(np.mean(visit.time[nearest]))
