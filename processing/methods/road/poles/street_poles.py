"""Poles of a survey: shafts beside the road, how sure each is a pole, and of which type.

The steps stand in a file each: shafts among the columns, what stands beside them, what they carry.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.column_points import ColumnPoints, points_about_each
from processing.methods.road.objects.survey import raised_columns, survey_columns
from processing.methods.road.poles.carried import (
    ARMS_FROM_M,
    Carried,
    ShaftNeighbourhood,
    asks_for_brightness,
    carried_of,
    type_of,
)
from processing.methods.road.poles.mirror_images import mirror_images
from processing.methods.road.poles.pole_confidence import (
    chances_of,
    facts_of,
    is_low,
    most_chances_of,
)
from processing.methods.road.poles.reflectors import ReflectorSearch
from processing.methods.road.poles.roofs import fellows_of
from processing.methods.road.poles.shaft_kernels import LEVEL_M, POINTS
from processing.methods.road.poles.shaft_sides import seen_sides
from processing.methods.road.poles.shafts import (
    Shaft,
    find_hidden_shafts,
    find_shafts,
    with_whole_sides,
)
from processing.methods.road.poles.surroundings import Surroundings, surroundings_of
from processing.recording.drive import Drive

REACH_M = 5.0
"""Points so near to a shaft may be of what it carries: arms over the road reach 4 to 5 m."""

_APART_M = 0.4
"""Two poles never stand nearer to each other: the surer one stays."""

_LEAST_CHANCE = 0.05
"""What is less likely a pole, or would be if all that isn't known yet spoke for it, is measured no
further."""

_NOTHING = Surroundings(rails=0.0, cover=0.0, over=0.0, roof=0.0, crown=None)

_LIKELY = 0.3
"""Of what is less likely a pole nobody asks whether a pane mirrors it."""

_ROUGH = 2.5
"""Noise over the usual one beyond which nobody asks what a shaft carries."""

_MANY_POINTS, _SMOOTH_SHARE, _LEAST_NOISE_M = 60, 0.2, 5e-4
"""Points of a shaft whose noise counts; the share of shafts that are smoother than the recording's
usual ones; and the least noise of any scanner."""


@dataclass(frozen=True)
class StreetPole:
    """One pole, or what might be one.

    Attributes
    ----------
    foot : (3,) float64
        Where its axis meets the ground, m, project CRS.
    shaft : Shaft
    carried : Carried
    type : str
        The contract's name.
    height_m : float
        Of its shaft's top above the foot.
    diameter_m, diameter_within_m : float
        1.2 m above the foot, of low ones at half their height; off by no more in 95 of 100 cases.
    confidence : float
        The share of its like that are poles.
    """

    foot: Floats
    shaft: Shaft
    carried: Carried
    type: str
    height_m: float
    diameter_m: float
    diameter_within_m: float
    confidence: float

    @property
    def lean_deg(self) -> float:
        """From the vertical."""
        return math.degrees(math.atan(float(np.hypot(*self.shaft.lean))))

    @property
    def points(self) -> Integers:
        """Measured points of the shaft by their number in their drive, the lowest first."""
        return self.shaft.points

    @property
    def drives(self) -> Integers:
        """Which of the drives each is of."""
        return self.shaft.drives


def street_poles(drives: Sequence[Drive], monitor: Monitor) -> tuple[StreetPole, ...]:
    """All shafts that may be poles; a confidence tells poles from the others.

    Notes
    -----
    1. Columns stand free at some heights (:mod:`processing.methods.road.objects.columns`); in
       each, straight cones are fitted and followed upwards, pass by pass.
    2. Rails, roofs and crowns about a shaft speak against a pole.
    3. Wires, arms, plates and reflectors tell its type.
    """
    below, columns = survey_columns(drives, PartMonitor(monitor, 0.0, 0.4))
    plan = below.plan
    raised = raised_columns(drives, monitor)
    shafts = find_shafts(drives, plan, columns, PartMonitor(monitor, 0.4, 0.7))
    hidden = find_hidden_shafts(drives, plan, raised, shafts, PartMonitor(monitor, 0.7, 0.75))
    if not shafts and not hidden:
        return ()
    usual_m = usual_noise_m(shafts or hidden)
    part = PartMonitor(monitor, 0.75, 0.9)
    # What stands out of a crown or behind a wall takes no points from what stands on the ground.
    feet = _feet(shafts), _feet(hidden)
    shafts, around = shafts + hidden, points_about_each(drives, plan, feet, REACH_M, part)
    shafts = with_whole_sides(shafts, around, monitor)
    besides = _hopeful(shafts, around, usual_m, monitor)
    carried, facts = {}, []
    for number, beside in besides.items():
        monitor.check()
        carried[number] = carried_if_likely(around, number, shafts, usual_m)
        sides = seen_sides(drives, shafts[number], plan.origin)
        facts.append(facts_of(shafts[number], beside, carried[number], sides, usual_m))
    chances = chances_of([shafts[number] for number in besides], facts)
    sure = [
        (chance, number)
        for chance, number in zip(chances.tolist(), besides, strict=True)
        if chance >= _LEAST_CHANCE
    ]
    asked = [number for chance, number in sure if chance >= _LIKELY]
    images = mirror_images(drives, plan, shafts, asked, PartMonitor(monitor, 0.9, 1.0))
    sure = [one for one in sure if one[1] not in images]
    reflectors = ReflectorSearch(drives, shafts, around, plan.origin)
    poles: list[StreetPole] = []
    for chance, number in sorted(sure, key=lambda one: (-one[0], one[1])):
        shaft = shafts[number]
        if all(np.hypot(*(shaft.foot - one.shaft.foot)[:2]) >= _APART_M for one in poles):
            is_reflecting = asks_for_brightness(shaft) and reflectors.is_reflecting(number, shaft)
            over = besides[number].over
            kind = type_of(shaft, carried[number], over=over, is_reflecting=is_reflecting)
            poles.append(_pole(shaft, (carried[number], kind), chance, plan.origin))
    monitor.report(1.0)
    return tuple(poles)


def _hopeful(
    shafts: Sequence[Shaft], around: ColumnPoints, usual_m: float, monitor: Monitor
) -> dict[int, Surroundings]:
    """What stands beside those shafts that may be poles if all else spoke for it, by number."""
    fellows = fellows_of(shafts)
    hopeful = most_chances_of(shafts, [_NOTHING] * len(shafts), usual_m) >= _LEAST_CHANCE
    besides = {}
    for number in np.flatnonzero(hopeful).tolist():
        monitor.check()
        local = around.local[around.of(number)] - shafts[number].foot
        besides[number] = surroundings_of(local, shafts[number], usual_m, fellows[number])
    own = [shafts[number] for number in besides]
    chances = most_chances_of(own, list(besides.values()), usual_m)
    return {
        number: beside
        for (number, beside), chance in zip(besides.items(), chances.tolist(), strict=True)
        if chance >= _LEAST_CHANCE
    }


def _feet(shafts: Sequence[Shaft]) -> Floats:
    return np.array([one.foot[:2] for one in shafts]).reshape(-1, 2)


def own_points(around: ColumnPoints, number: int, shafts: Sequence[Shaft]) -> ShaftNeighbourhood:
    """Points about a shaft, by its number, of the heads that measured it.

    Passes lie centimetres apart, which would make two plates of one and no smooth surface.
    """
    shaft = shafts[number]
    part = around.of(number)
    is_head = np.zeros(int(around.drives.max(initial=0)) + 1, np.bool_)
    is_head[shaft.drives] = True
    is_own = is_head[around.drives[part]]
    beyond = [np.empty((0, 3))]
    if shaft.top_m > ARMS_FROM_M:
        away = np.hypot(*(_feet(shafts) - shaft.foot[:2]).T)
        for other in np.flatnonzero((away > 0) & (away < 2 * REACH_M)).tolist():
            theirs = around.of(other)
            high = np.flatnonzero(around.local[theirs, 2] - shaft.foot[2] > ARMS_FROM_M)
            local = around.local[theirs].take(high, axis=0) - shaft.foot
            is_near = np.hypot(local[:, 0], local[:, 1]) < REACH_M
            is_near &= is_head[around.drives[theirs].take(high)]
            beyond.append(local[is_near])
    return ShaftNeighbourhood(
        around.local[part][is_own] - shaft.foot,
        around.drives[part][is_own],
        np.concatenate(beyond),
    )


def carried_if_likely(
    around: ColumnPoints, number: int, shafts: Sequence[Shaft], usual_m: float
) -> Carried:
    """What a shaft carries; nothing, of low ones and of those too rough for a pole.

    Parameters
    ----------
    around : ColumnPoints
        Points about all shafts, of which the one with the number is asked.
    usual_m : float
        Noise of the recording's smooth shafts.
    """
    shaft = shafts[number]
    if is_low(shaft) or shaft.noise_m > _ROUGH * usual_m:
        return Carried()
    return carried_of(own_points(around, number, shafts), shaft)


def usual_noise_m(shafts: Sequence[Shaft]) -> float:
    """How far points lie off the smooth shafts of a recording, m."""
    noise = [one.noise_m for one in shafts if one.told[POINTS] >= _MANY_POINTS]
    if not noise:
        noise = [one.noise_m for one in shafts]
    return max(float(np.quantile(noise, _SMOOTH_SHARE)), _LEAST_NOISE_M)


def _pole(shaft: Shaft, told: tuple[Carried, str], chance: float, origin: Floats) -> StreetPole:
    """The pole that a shaft is, by what it carries and its type."""
    level = min(LEVEL_M, shaft.top_m / 2)
    return StreetPole(
        foot=shaft.foot + origin,
        shaft=shaft,
        carried=told[0],
        type=told[1],
        height_m=shaft.top_m,
        diameter_m=2 * shaft.radius_at(level),
        diameter_within_m=1.96 * 2 * math.hypot(shaft.deviation_m, shaft.noise_m / 2),
        confidence=chance,
    )
