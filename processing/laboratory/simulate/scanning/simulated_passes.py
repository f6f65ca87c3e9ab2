"""How the vehicle drives: speed, waiting, its way in the lane, its attitude, and their errors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.alignment import Alignment
from processing.laboratory.simulate.street.plan import SectionPlan

RECORDS_PER_S = 200.0
REFERENCE_HIGH_M = (1.7, 2.0)
"""Of the trajectory's reference point above the road."""

_STEP_M = 0.05
_SLOWEST_M_S = 0.15
_BRAKING_M_S2 = 1.5
_WAVES = 5
_MINUTE_S = 60.0
_JUMPS_PER_S = 1 / 30.0


@dataclass(frozen=True)
class SimulatedPass:
    """One drive along the street, as it truly was.

    Attributes
    ----------
    number : int
        0 drives along the chainage; odd ones come back on the other side.
    time_s : (m,) float64
        From 0, 200 records a second.
    positions : (m, 3) float64
        Of the reference point, m, the street's frame.
    rotations : (m, 3, 3) float64
        Columns: the vehicle's forward, left and up axes.
    chainages : (m,) float64
    angles_deg : (m, 3) float64
        Roll, pitch and heading as the contract counts them.
    errors : (m, 3) float64
        What the delivered positions are off, m.
    turned_rad : (m, 3) float64
        What the delivered attitude is off: small turns about the vehicle's forward, left and up
        axes, rad.
    """

    number: int
    time_s: Floats
    positions: Floats
    rotations: Floats
    chainages: Floats
    angles_deg: Floats
    errors: Floats
    turned_rad: Floats

    @property
    def duration_s(self) -> float:
        """From the first record to the last."""
        return float(self.time_s[-1])

    @property
    def delivered_deg(self) -> Floats:
        """(m, 3) roll, pitch and heading as delivered, degrees.

        Turns about forward, left and up are roll (right side down), pitch (nose down) and heading
        (to the left), as long as they are small.
        """
        angles: Floats = self.angles_deg + np.degrees(self.turned_rad) * np.array([1.0, -1.0, -1.0])
        angles[:, 2] %= 360.0
        return angles

    def chainage_at(self, time_s: Floats) -> Floats:
        """Where the vehicle is at times from the pass' beginning."""
        return np.interp(time_s, self.time_s, self.chainages)


@dataclass(frozen=True)
class Driving:
    """How a pass shall be driven.

    Attributes
    ----------
    speed_m_s : float
        On free road.
    stops : bool
        Whether it waits at junctions, or else once on the way.
    drift_m, attitude_deg : float
        Standard deviations of the delivered positions and angles.
    jumps_m, wander_m : float
        Of steps in the delivered positions, and of their random walk within a minute.
    """

    speed_m_s: float
    stops: bool
    drift_m: float
    attitude_deg: float = 0.0
    jumps_m: float = 0.0
    wander_m: float = 0.0


def pass_of(street: Street, number: int, driving: Driving) -> SimulatedPass:
    """A pass along the whole street; the first one of a longer street begins the same."""
    random = chance(street.seed, "pass", number)
    direction = -1 if number % 2 else 1
    times, driven = _times(street, random, driving, number)
    chainages = driven if direction > 0 else street.length_m - driven
    records = np.arange(0.0, times[-1], 1.0 / RECORDS_PER_S)
    at = np.interp(records, times, chainages)
    beside = direction * (
        _lane_m(street, at) + 0.12 * _swaying(random, at, (15.0, 120.0)) + random.normal(0, 0.08)
    )
    high = float(random.uniform(*REFERENCE_HIGH_M)) + 0.006 * _swaying(random, records, (0.6, 2))
    positions = street.alignment.at(
        at, beside, street.alignment.carriageway_height(at, beside) + high
    )
    rotations, angles = _attitude(street.alignment, random, records, (at, beside, direction))
    errors = driving.drift_m * np.column_stack(
        [_swaying(random, records, (60.0, 600.0)) for _ in range(3)]
    )
    if driving.jumps_m or driving.wander_m:
        errors = errors + _unsteady(chance(street.seed, "unsteady", number), records, driving)
    turning = chance(street.seed, "attitude", number)
    turned = math.radians(driving.attitude_deg) * np.column_stack(
        [_swaying(turning, records, (60.0, 600.0)) for _ in range(3)]
    )
    return SimulatedPass(number, records, positions, rotations, at, angles, errors, turned)


def _unsteady(random: Generator, records: Floats, driving: Driving) -> Floats:
    """Errors that walk at random and jump: (m, 3) m, about their mean."""
    steps = random.normal(size=(records.size, 3)) * driving.wander_m
    steps /= math.sqrt(_MINUTE_S * RECORDS_PER_S)
    if driving.jumps_m:
        is_jump = random.random(records.size) < _JUMPS_PER_S / RECORDS_PER_S
        steps[is_jump] += random.normal(size=(int(is_jump.sum()), 3)) * driving.jumps_m
    walked: Floats = np.cumsum(steps, axis=0)
    return np.asarray(walked - walked.mean(axis=0))


def _lane_m(street: Street, chainages: Floats) -> Floats:
    plan: SectionPlan = street.plans[0]
    return np.full(chainages.shape, plan.lane_offset_m(0))


def _swaying(random: Generator, at: Floats, periods: tuple[float, float]) -> Floats:
    """A sum of waves of these periods with standard deviation 1; the same however long ``at``."""
    lengths = np.exp(random.uniform(math.log(periods[0]), math.log(periods[1]), _WAVES))
    phases = random.uniform(0, 2 * np.pi, _WAVES)
    waves: Floats = np.zeros(at.shape)
    for long, phase in zip(lengths, phases, strict=True):
        waves += np.sin(2 * np.pi * at / long + phase)
    waves /= math.sqrt(_WAVES / 2)
    return waves


def _times(
    street: Street, random: Generator, driving: Driving, number: int
) -> tuple[Floats, Floats]:
    """Times and metres driven: slower and faster, and waiting where it stops."""
    driven = np.arange(0.0, street.length_m + _STEP_M, _STEP_M)
    speed = driving.speed_m_s * (1 + 0.08 * _swaying(random, driven, (40.0, 400.0)))
    waits = _waits(street, number) if driving.stops else []
    for at, _ in waits:
        braked = np.sqrt(2 * _BRAKING_M_S2 * np.abs(driven - at))
        speed = np.minimum(speed, braked)
    speed = np.maximum(speed, _SLOWEST_M_S)
    times = np.concatenate([[0.0], np.cumsum(_STEP_M / ((speed[1:] + speed[:-1]) / 2))])
    for at, wait in waits:
        row = int(np.searchsorted(driven, at))
        if row >= driven.size:
            continue
        late = times[row:] + wait
        times = np.concatenate([times[: row + 1], late])
        driven = np.concatenate([driven[: row + 1], driven[row:]])
    return times, driven


def _waits(street: Street, number: int) -> list[tuple[float, float]]:
    """Metres driven and seconds of every wait, the last first."""
    positions = [one.start_m - 3.0 for one in street.plans if one.junctions]
    if number % 2:
        positions = [street.length_m - one for one in positions]
    random = chance(street.seed, "waits", number)
    positions.append(float(random.uniform(15, 60)))
    within = sorted((one for one in positions if 5 < one < street.length_m - 5), reverse=True)
    waits = []
    for at in within:
        one = chance(street.seed, "wait", number, int(at))
        if at == min(within) or one.random() < 0.5:
            waits.append((at, float(one.uniform(2.0, 12.0))))
    return waits


def _attitude(
    alignment: Alignment,
    random: Generator,
    records: Floats,
    where: tuple[Floats, Floats, int],
) -> tuple[Floats, Floats]:
    """Axes of the vehicle, and its roll, pitch and heading in degrees."""
    at, beside, direction = where
    ahead, back = (
        alignment.at(one, beside, alignment.carriageway_height(one, beside))
        for one in (at + direction, at - direction)
    )
    drift = np.gradient(beside, records)
    speed = np.maximum(np.abs(np.gradient(at, records)), 1.0)
    yaw = np.arctan2(ahead[:, 1] - back[:, 1], ahead[:, 0] - back[:, 0])
    yaw += np.clip(drift * direction / speed, -0.1, 0.1)
    rise = (ahead[:, 2] - back[:, 2]) / 2.0
    left = alignment.carriageway_height(at, beside + direction * 0.7)
    right = alignment.carriageway_height(at, beside - direction * 0.7)
    pitch = np.arctan(rise) + 0.003 * _swaying(random, records, (0.7, 3.0))
    roll = np.arctan((left - right) / 1.4) + 0.005 * _swaying(random, records, (0.8, 4.0))
    angles = np.column_stack([roll, pitch, np.pi / 2 - yaw])
    return _axes(yaw, pitch, roll), _in_degrees(angles)


def _axes(yaw: Floats, pitch: Floats, roll: Floats) -> Floats:
    """Columns forward, left, up from yaw (anticlockwise from east), pitch up, roll right down."""
    cy, sy, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    cr, sr = np.cos(roll), np.sin(roll)
    forward = np.stack([cy * cp, sy * cp, sp], -1)
    level = np.stack([-sy, cy, np.zeros_like(cy)], -1)
    over = np.cross(forward, level)
    left = cr[:, None] * level + sr[:, None] * over
    up = np.cross(forward, left)
    return np.stack([forward, left, up], axis=-1)


def _in_degrees(angles: Floats) -> Floats:
    degrees: Floats = np.degrees(angles)
    degrees[:, 2] %= 360.0
    return degrees
