"""Power lines over a landscape, as a flight sees them: returns of conductors, towers and poles."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.airborne.flight import FlightPoints
from processing.laboratory.simulate.airborne.landscapes import CELL_M, Floats, Landscape

WIRE, TOWER, POLE = 14, 15, 66

_POSITION_M, _HEIGHT_M = 0.15, 0.05
_CONDUCTOR_HITS = 0.6
"""Returns of a conductor for each distance between pulses: footprints are as wide as gaps."""

_SHELL_HITS = 1.5
"""Returns of a lattice for each square of that distance that its outline covers."""


class LineStyle(NamedTuple):
    """Heights and spans of a kind of line, m; conductors on each side; what carries them."""

    height_m: tuple[float, float]
    span_m: tuple[float, float]
    arm_m: tuple[float, float]
    foot_m: tuple[float, float]
    conductors: tuple[int, int]
    code: int


HIGH = LineStyle((22.0, 55.0), (90.0, 260.0), (3.0, 8.0), (3.0, 9.0), (1, 3), TOWER)
LOW = LineStyle((8.0, 15.0), (25.0, 50.0), (0.5, 1.2), (0.25, 0.4), (1, 3), POLE)


def power_line(land: Landscape, seed: int, spacing_m: float, style: LineStyle) -> FlightPoints:
    """Returns of a line that crosses a landscape somewhere."""
    random = np.random.default_rng((seed, 79))
    extent_m = land.ground.shape[0] * CELL_M
    turn, through = random.uniform(0, np.pi), random.uniform(0.25, 0.75, 2) * extent_m
    ahead = np.array([np.cos(turn), np.sin(turn)])
    span, height = random.uniform(*style.span_m), random.uniform(*style.height_m)
    # Beyond either edge stands another one, so that a span reaches in from there.
    stations = np.arange(-extent_m - span * random.random(), extent_m + span, span)
    feet = through + stations[:, None] * ahead
    floors = _ground_at(land, feet)
    points, codes = [], []
    for foot, floor in zip(feet, floors, strict=True):
        carrier = _carrier(random, style, height, spacing_m)
        carrier[:, :2] = carrier[:, :1] * np.array([-ahead[1], ahead[0]]) + carrier[:, 1:2] * ahead
        points.append(carrier + np.array([*foot, floor]))
        codes.append(np.full(len(carrier), style.code))
    arm, levels = (
        random.uniform(*style.arm_m),
        int(random.integers(*style.conductors, endpoint=True)),
    )
    sag = span * random.uniform(0.01, 0.035)
    for side in (-arm, arm):
        for level in range(levels):
            top = height * (1.0 - 0.12 * level)
            wire = _conductor(random, stations, floors + top, sag, spacing_m)
            place = through + wire[:, :1] * ahead + side * np.array([-ahead[1], ahead[0]])
            points.append(np.column_stack([place, wire[:, 1]]))
            codes.append(np.full(len(wire), WIRE))
    xyz, code = np.concatenate(points), np.concatenate(codes).astype(np.uint8)
    xyz += random.normal(0, 1, xyz.shape) * (_POSITION_M, _POSITION_M, _HEIGHT_M)
    inside = np.all((xyz[:, :2] > 0) & (xyz[:, :2] < extent_m - CELL_M), axis=1)
    xyz, code = xyz[inside], code[inside]
    returns = random.integers(1, 2, len(xyz), endpoint=True).astype(np.uint8)
    none = np.zeros(len(xyz), np.bool_)
    return FlightPoints(xyz, none, code, np.ones(len(xyz), np.uint8), returns)


def _ground_at(land: Landscape, places: Floats) -> Floats:
    last = land.ground.shape[0] - 1
    column, row = np.clip((places / CELL_M).astype(int), 0, last).T
    heights: Floats = land.ground[row, column]
    return heights


def _carrier(random: Generator, style: LineStyle, height: float, spacing_m: float) -> Floats:
    """Returns of a tower or pole about its foot: across, along, up."""
    foot, arm = random.uniform(*style.foot_m), style.arm_m[1]
    count = int(_SHELL_HITS * height * (foot + 1.0) / spacing_m**2) + int(height / spacing_m)
    up = height * random.random(count) ** 0.7
    wide = foot / 2 * (1.0 - 0.8 * up / height)
    body = np.column_stack([random.uniform(-wide, wide), random.uniform(-wide, wide), up])
    arms = int(6 * arm / spacing_m)
    level = height * (1.0 - 0.12 * random.integers(0, style.conductors[1], arms))
    beams = np.column_stack([random.uniform(-arm, arm, arms), random.normal(0, 0.2, arms), level])
    return np.concatenate([body, beams])


def _conductor(
    random: Generator, stations: Floats, tops: Floats, sag: float, spacing_m: float
) -> Floats:
    """(n, 2) places along a line and heights of returns of one conductor, m."""
    length = stations[-1] - stations[0]
    along = stations[0] + length * random.random(int(2 * _CONDUCTOR_HITS * length / spacing_m))
    between = np.clip(np.searchsorted(stations, along) - 1, 0, stations.size - 2)
    part = (along - stations[between]) / (stations[between + 1] - stations[between])
    straight = tops[between] + part * (tops[between + 1] - tops[between])
    return np.column_stack([along, straight - 4.0 * sag * part * (1.0 - part)])
