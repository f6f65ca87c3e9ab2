"""A landscape recorded from the air: first and last returns of crossing strips, with truth."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.airborne.landscapes import CELL_M, Floats, Landscape

_POSITION_M, _HEIGHT_M = 0.2, 0.04
"""Standard deviations of a return in plan and in height, as of scanners of about the year 2000."""

_THROUGH_LEAVES = 0.4
"""Share of the pulses into a crown whose last return comes from the ground."""

_BESIDE_WALL = 0.3
"""Share of the pulses beside a roof's edge that meet the wall."""

_OVER_WATER = 0.02
_LOW_SHARE, _HIGH_SHARE = 3e-4, 2e-4
"""Shares of returns from below the ground, by several reflections, and from birds."""


class FlightPoints(NamedTuple):
    """Returns: (n, 3) m, and which came from the ground."""

    xyz: Floats
    is_ground: NDArray[np.bool_]


def fly_over(land: Landscape, seed: int, spacing_m: float) -> FlightPoints:
    """Points of two strips that cross at an angle, ``spacing_m`` apart in each."""
    random = np.random.default_rng((seed, 77))
    extent_m = land.ground.shape[0] * CELL_M
    points, flags = [], []
    for turn in random.uniform(0, np.pi, 2):
        xy = _strip(random, extent_m, spacing_m, turn)
        xyz, is_ground = _returns(land, random, xy)
        points.append(xyz)
        flags.append(is_ground)
    xyz, is_ground = np.concatenate(points), np.concatenate(flags)
    xyz[:, :2] += random.normal(0, _POSITION_M, (len(xyz), 2))
    xyz[:, 2] += random.normal(0, _HEIGHT_M, len(xyz))
    low, high = (random.random(len(xyz)) < share for share in (_LOW_SHARE, _HIGH_SHARE))
    xyz[low, 2] -= random.uniform(1.0, 12.0, int(low.sum()))
    xyz[high, 2] += random.uniform(20.0, 60.0, int(high.sum()))
    return FlightPoints(np.round(xyz, 2), is_ground & ~low & ~high)


def _strip(random: Generator, extent_m: float, spacing_m: float, turn: float) -> Floats:
    """Positions of pulses along swinging lines, the farther from the flight line the denser."""
    reach = 0.75 * extent_m
    lines = np.arange(-reach, reach, spacing_m * random.uniform(0.8, 1.4))
    swing = np.sin(np.linspace(-1.2, 1.2, int(2 * reach / spacing_m))) / np.sin(1.2)
    along, across = np.meshgrid(lines, reach * swing, indexing="ij")
    along = along + spacing_m * 0.5 * np.abs(swing)
    x = extent_m / 2 + across * np.cos(turn) - along * np.sin(turn)
    y = extent_m / 2 + across * np.sin(turn) + along * np.cos(turn)
    xy = np.column_stack([x.ravel(), y.ravel()])
    inside = np.all((xy > 0) & (xy < extent_m - CELL_M), axis=1)
    return xy[inside]


def _returns(land: Landscape, random: Generator, xy: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    column, row = (xy / CELL_M).astype(int).T
    keep = ~land.water[row, column] | (random.random(len(xy)) < _OVER_WATER)
    xy, row, column = xy[keep], row[keep], column[keep]
    ground, solid = land.ground[row, column], land.solid[row, column]
    top, base = land.crown_top[row, column], land.crown_base[row, column]
    on_solid = np.isfinite(solid)
    leaves = np.isfinite(top) & ~(solid > top)
    first = np.where(on_solid, solid, ground)
    beside = ~on_solid & (random.random(len(xy)) < _BESIDE_WALL)
    wall = land.solid[row, np.minimum(column + 2, land.solid.shape[1] - 1)]
    beside &= np.isfinite(wall) & (wall > ground + 2.0)
    first = np.where(beside, ground + random.random(len(xy)) * (wall - ground), first)
    inside = base + (top - base) * random.random(len(xy)) ** 0.5
    last = first.copy()
    through = leaves & (random.random(len(xy)) < _THROUGH_LEAVES)
    first = np.where(leaves, inside, first)
    last_is_ground = ~on_solid & ~beside & (~leaves | through)
    first_is_ground = last_is_ground & ~leaves
    second = np.flatnonzero(through)
    xyz = np.column_stack([xy, first])
    xyz = np.concatenate([xyz, np.column_stack([xy[second], last[second]])])
    return xyz, np.concatenate([first_is_ground, last_is_ground[second]])
