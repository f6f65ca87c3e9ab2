"""A landscape recorded from the air: first and last returns of crossing strips, with truth."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.airborne.landscapes import (
    BUILDING,
    CELL_M,
    Floats,
    Landscape,
)

_POSITION_M, _HEIGHT_M = 0.2, 0.04
"""Standard deviations of a return in plan and in height, as of scanners of about the year 2000."""

_THROUGH_LEAVES = 0.4
"""Share of the pulses into a crown whose last return comes from the ground."""

_BESIDE_WALL = 0.3
"""Share of the pulses beside a roof's edge that meet the wall."""

_OVER_WATER = 0.02
_LOW_SHARE, _HIGH_SHARE = 3e-4, 2e-4
"""Shares of returns from below the ground, by several reflections, and from birds."""


_LOW_PLANT_M = 2.0
"""Plants up to this height are no trees."""

GROUND, LOW_PLANT, CROWN, LOW_NOISE, HIGH_NOISE = 2, 4, 5, 7, 18


class FlightPoints(NamedTuple):
    """Returns of pulses.

    ``xyz`` (n, 3) m; ``is_ground`` (n,) bool; ``codes`` (n,) uint8, classes; ``number`` and
    ``returns`` (n,) uint8: which of its pulse's returns each is, and how many those are.
    """

    xyz: Floats
    is_ground: NDArray[np.bool_]
    codes: NDArray[np.uint8]
    number: NDArray[np.uint8]
    returns: NDArray[np.uint8]


def fly_over(
    land: Landscape,
    seed: int,
    spacing_m: float,
    shaken_m: tuple[float, float] = (_POSITION_M, _HEIGHT_M),
) -> FlightPoints:
    """Points of two strips that cross at an angle, ``spacing_m`` apart in each.

    Parameters
    ----------
    shaken_m : (float, float)
        Standard deviations in plan and in height.
    """
    random = np.random.default_rng((seed, 77))
    extent_m = land.ground.shape[0] * CELL_M
    strips = []
    for turn in random.uniform(0, np.pi, 2):
        xy = _strip(random, extent_m, spacing_m, turn)
        strips.append(_returns(land, random, xy))
    xyz, is_ground, codes, number, returns = (
        np.concatenate(one) for one in zip(*strips, strict=True)
    )
    xyz[:, :2] += random.normal(0, shaken_m[0], (len(xyz), 2))
    xyz[:, 2] += random.normal(0, shaken_m[1], len(xyz))
    low, high = (random.random(len(xyz)) < share for share in (_LOW_SHARE, _HIGH_SHARE))
    xyz[low, 2] -= random.uniform(1.0, 12.0, int(low.sum()))
    xyz[high, 2] += random.uniform(20.0, 60.0, int(high.sum()))
    codes[low], codes[high] = LOW_NOISE, HIGH_NOISE
    return FlightPoints(np.round(xyz, 2), is_ground & ~low & ~high, codes, number, returns)


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


def _returns(land: Landscape, random: Generator, xy: Floats) -> FlightPoints:
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
    is_ground = np.concatenate([first_is_ground, last_is_ground[second]])
    plant = np.where(top - ground < _LOW_PLANT_M, LOW_PLANT, CROWN)
    codes = np.where(leaves, plant, np.where(on_solid, land.solid_code[row, column], BUILDING))
    codes = np.concatenate([codes, codes[second]]).astype(np.uint8)
    codes[is_ground] = GROUND
    # The last return of a pulse through leaves over a roof is the roof's.
    codes[len(xy) :][on_solid[second]] = land.solid_code[row, column][second][on_solid[second]]
    number = np.concatenate([np.ones(len(xy)), np.full(second.size, 2)]).astype(np.uint8)
    returns = np.concatenate([1 + through, np.full(second.size, 2)]).astype(np.uint8)
    return FlightPoints(xyz, is_ground, codes, number, returns)
