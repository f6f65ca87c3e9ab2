"""The pulses of a flight: from where, in which direction and when each is sent."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.airborne.flight_sensors import FlightSensor
from processing.laboratory.simulate.airborne.landscapes import Floats

CHUNK = 4096
"""Pulses that are computed together: some 50 MB of samples."""

SPEED_M_S = 60.0
_BETWEEN_LINES_S = 120.0
_SIDE_OVERLAP = 0.5
_LEAST_LINES = 2
_ATTITUDE_RAD, _ATTITUDE_S = 0.01, 7.0
"""Roll and pitch that an aircraft sways by, and the time of a swing."""

_INSET_M = 2.0
"""No pulse is aimed nearer to the landscape's edge, behind which nothing stands."""


class FlightPlan(NamedTuple):
    """How a square is flown: its side, m; pulses per m²; above its middle height, m."""

    extent_m: float
    density: float
    height_m: float
    ground_m: float


class SentPulses(NamedTuple):
    """Pulses in the order of time.

    ``origin`` and ``direction`` (n, 3) float64, the landscape's frame; ``time_s`` (n,) float64
    since the flight's beginning; ``line`` (n,) uint8 from 1 on; ``angle_deg`` (n,) float64,
    across the line, to the right positive.
    """

    origin: Floats
    direction: Floats
    time_s: Floats
    line: NDArray[np.uint8]
    angle_deg: Floats


def line_count(sensor: FlightSensor, flight: FlightPlan) -> int:
    """Lines side by side that cover the square, each place twice."""
    swath = 2.0 * flight.height_m * np.tan(np.radians(sensor.half_swath_deg))
    return max(_LEAST_LINES, int(np.ceil(1.1 * flight.extent_m / (swath * (1 - _SIDE_OVERLAP)))))


def flight_seconds(sensor: FlightSensor, flight: FlightPlan) -> float:
    """How long the flight takes, with the turns between its lines."""
    lines = line_count(sensor, flight)
    return lines * flight.extent_m / SPEED_M_S + (lines - 1) * _BETWEEN_LINES_S


def pulses_of(sensor: FlightSensor, flight: FlightPlan, random: Generator) -> Iterator[SentPulses]:
    """All pulses that are aimed into the square, some thousand at a time."""
    lines = line_count(sensor, flight)
    swath = 2.0 * flight.height_m * np.tan(np.radians(sensor.half_swath_deg))
    apart = min(swath * (1 - _SIDE_OVERLAP), 1.1 * flight.extent_m / lines)
    seen = min(lines, max(1.0, swath / apart))
    spacing = float(np.sqrt(seen / flight.density))
    heading = random.uniform(0, 2 * np.pi)
    for number in range(lines):
        aside = (number - (lines - 1) / 2) * apart
        turned = heading + np.pi * (number % 2)
        line = _Line(number + 1, turned, aside * (1 - 2 * (number % 2)), spacing)
        yield from _line_pulses(sensor, flight, line, random.uniform(0, 2 * np.pi, 4))


class _Line(NamedTuple):
    number: int
    heading: float
    aside_m: float
    spacing_m: float


def _line_pulses(
    sensor: FlightSensor, flight: FlightPlan, line: _Line, phases: Floats
) -> Iterator[SentPulses]:
    is_conical = sensor.pattern == "conical"
    half = np.radians(sensor.half_swath_deg)
    reach = 0.75 * flight.extent_m + (flight.height_m * np.tan(half) if is_conical else 5.0)
    # A cone meets each place with its fore and its aft side.
    rows = np.arange(-reach, reach, line.spacing_m * (2.0 if is_conical else 1.0))
    scan = _scan_angles(sensor, flight, line.spacing_m)
    share = np.arange(len(scan)) / len(scan)
    waiting: list[SentPulses] = []
    count = 0
    for number, along in enumerate(rows):
        place = along + share * (rows[1] - rows[0])
        pulses = _aimed(flight, line, (place, phases), scan)
        inside = _is_inside(flight, pulses)
        seconds = _BETWEEN_LINES_S * line.number + (place + reach) / SPEED_M_S
        if inside.any():
            pulses = pulses._replace(time_s=seconds, line=np.full(len(scan), line.number, np.uint8))
            waiting.append(SentPulses._make(one[inside] for one in pulses))
            count += int(inside.sum())
        if waiting and (count >= CHUNK or number + 1 == rows.size):
            joined = SentPulses._make(np.concatenate(one) for one in zip(*waiting, strict=True))
            for begin in range(0, count, CHUNK):
                yield SentPulses._make(one[begin : begin + CHUNK] for one in joined)
            waiting, count = [], 0


def _scan_angles(sensor: FlightSensor, flight: FlightPlan, spacing_m: float) -> Floats:
    """(k, 2) of one sweep: to the right and forward, tangents of the angles off nadir."""
    half = np.radians(sensor.half_swath_deg)
    if sensor.pattern == "conical":
        steps = int(np.ceil(2 * np.pi * flight.height_m * np.tan(half) / spacing_m))
        turn = 2 * np.pi * np.arange(steps) / steps
        circle: Floats = np.tan(half) * np.column_stack([np.sin(turn), np.cos(turn)])
        return circle
    steps = int(np.ceil(2 * half * flight.height_m / spacing_m))
    angles = np.linspace(-half, half, max(2, steps))
    return np.column_stack([np.tan(angles), np.zeros(len(angles))])


def _aimed(flight: FlightPlan, line: _Line, at: tuple[Floats, Floats], scan: Floats) -> SentPulses:
    place, phases = at
    seconds = place / SPEED_M_S
    swing = 2 * np.pi * seconds / _ATTITUDE_S
    roll, pitch = (
        _ATTITUDE_RAD * np.sin(swing * rate + phase)
        for rate, phase in zip((1.0, 0.7), phases[:2], strict=True)
    )
    right, ahead = scan[:, 0] + roll, scan[:, 1] + pitch
    forward = np.array([np.sin(line.heading), np.cos(line.heading)])
    sideways = np.array([forward[1], -forward[0]])
    plan = right[:, None] * sideways + ahead[:, None] * forward
    direction = np.column_stack([plan, -np.ones(len(plan))])
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    middle = flight.extent_m / 2 + line.aside_m * sideways
    sway = 0.5 * np.sin(swing * 0.3 + phases[2])
    origin = np.column_stack(
        [middle + place[:, None] * forward, flight.ground_m + flight.height_m + sway]
    )
    none = np.zeros(len(plan))
    return SentPulses(origin, direction, none, none.astype(np.uint8), np.degrees(np.arctan(right)))


def _is_inside(flight: FlightPlan, pulses: SentPulses) -> NDArray[np.bool_]:
    down = (flight.ground_m - pulses.origin[:, 2]) / pulses.direction[:, 2]
    plan = pulses.origin[:, :2] + down[:, None] * pulses.direction[:, :2]
    inside: NDArray[np.bool_] = np.all(
        (plan > _INSET_M) & (plan < flight.extent_m - _INSET_M), axis=1
    )
    return inside
