"""Landscapes seen from the air: kinds of terrain that the ISPRS filter test names as hard.

Sithole and Vosselman 2003 describe what each of its samples is hard for: steep slopes under
buildings and trees, gaps and low outliers, large roofs, terraces and quarry faces, embankments
with little on them, bridges. A village of small houses is easier, and is what most land is. Each
kind is drawn anew from a seed; no height, width or angle is one of a sample.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

Floats = NDArray[np.float64]
CELL_M = 0.25
"""Side of the cells that a landscape is drawn in: a quarter of the closest points from the air."""

_KERB_M = 0.5

BUILDING, VEHICLE, BRIDGE = 6, 64, 1
"""Classes of what stands on the ground; the contract has none for bridges."""


@dataclass
class Landscape:
    """Heights of the ground and of what stands on it, row = north, column = east, m.

    Attributes
    ----------
    ground : (rows, columns) float64
    solid : (rows, columns) float64
        Tops of roofs, decks and vehicles; NaN without.
    solid_code : (rows, columns) uint8
        What they belong to, by the classes' numbers.
    crown_top, crown_base : (rows, columns) float64
        Between these heights leaves give returns; NaN without.
    water : (rows, columns) bool
        Gives hardly any.
    """

    ground: Floats
    solid: Floats
    solid_code: NDArray[np.uint8]
    crown_top: Floats
    crown_base: Floats
    water: NDArray[np.bool_]

    @classmethod
    def bare(cls, ground: Floats) -> Landscape:
        """Ground with nothing on it."""
        free = np.full(ground.shape, np.nan)
        nothing = np.zeros(ground.shape, np.uint8)
        return cls(ground, free, nothing, free.copy(), free.copy(), nothing.astype(np.bool_))

    def add_solid(
        self, where: tuple[slice, slice] | NDArray[np.bool_], top: Floats | float, code: int
    ) -> None:
        """Something of a class stands there; the higher of two things is seen."""
        before = self.solid[where].copy()
        self.solid[where] = np.fmax(before, top)
        self.solid_code[where] = np.where(self.solid[where] == before, self.solid_code[where], code)


def landscape_of(kind: str, seed: int, extent_m: float) -> Landscape:
    """A square landscape of one of :data:`KINDS`.

    Parameters
    ----------
    extent_m : float
        Side of the square.
    """
    return KINDS[kind](np.random.default_rng((seed, sorted(KINDS).index(kind))), extent_m)


def _plan(extent_m: float) -> tuple[Floats, Floats]:
    centres = CELL_M * (np.arange(round(extent_m / CELL_M)) + 0.5)
    north, east = np.meshgrid(centres, centres, indexing="ij")
    return east, north


def _rolling(random: Generator, extent_m: float, height_m: float, wave_m: float) -> Floats:
    """Smooth relief: sines in ten directions, of waves from half to twice ``wave_m``."""
    east, north = _plan(extent_m)
    relief = np.zeros_like(east)
    for _ in range(10):
        turn, wave = random.uniform(0, np.pi), wave_m * 2 ** random.uniform(-1, 1)
        along = east * np.cos(turn) + north * np.sin(turn)
        relief += np.sin(2 * np.pi * along / wave + random.uniform(0, 6.3)) * wave / wave_m
    heights: Floats = relief * height_m / np.sqrt(10)
    return heights


def _across(random: Generator, extent_m: float, bend_m: float) -> Floats:
    """Distance from a bent line through the middle, m."""
    east, north = _plan(extent_m)
    turn = random.uniform(0, 2 * np.pi)
    off = (east - extent_m / 2) * np.cos(turn) + (north - extent_m / 2) * np.sin(turn)
    along = (north - extent_m / 2) * np.cos(turn) - (east - extent_m / 2) * np.sin(turn)
    bent: Floats = off + bend_m * np.sin(2 * np.pi * along / extent_m + random.uniform(0, 6.3))
    return bent


def _steps(off: Floats, random: Generator, *, run_m: float, face_m: float, slope: float) -> Floats:
    """Terraces: steps of up to ``face_m`` every ``run_m``, their faces as steep as ``slope``."""
    heights = np.zeros_like(off)
    for edge in np.arange(off.min(), off.max(), run_m):
        face = face_m * random.uniform(0.4, 1.0)
        place = edge + random.uniform(-0.25, 0.25) * run_m
        heights += np.clip((off - place) * slope, 0.0, face)
    return heights


def _add_building(
    land: Landscape, random: Generator, side_m: tuple[float, float], floors_m: tuple[float, float]
) -> None:
    """A house: its eaves are level, however the ground falls, and its roof is flat or pitched."""
    extent_m = land.ground.shape[0] * CELL_M
    east, north = _plan(extent_m)
    turn = random.uniform(0, np.pi)
    x, y = random.uniform(0, extent_m, 2)
    u = (east - x) * np.cos(turn) + (north - y) * np.sin(turn)
    v = (north - y) * np.cos(turn) - (east - x) * np.sin(turn)
    half = random.uniform(*side_m) / 2
    wide = half * random.uniform(0.35, 1.0)
    inside = (np.abs(u) < half) & (np.abs(v) < wide)
    if half > 15.0 and random.random() < 0.5:
        inside &= (np.abs(u) > 0.5 * half) | (np.abs(v) > 0.4 * wide)
    if not inside.any():
        return
    eaves = np.median(land.ground[inside]) + random.uniform(*floors_m)
    pitch = 0.0 if half > 12.0 else random.choice([0.0, 0.5, 0.8])
    roof = eaves + pitch * (wide - np.abs(v))
    land.add_solid(inside, roof[inside], BUILDING)
    # Roofs may meet the hill behind them, not sink into it.
    buried = inside & (land.solid < land.ground + 0.3)
    land.solid[buried] = np.nan


def _add_trees(land: Landscape, random: Generator, share: float, height_m: float) -> None:
    """Crowns over a share of the plan, in groups, and undergrowth beneath some."""
    extent_m = land.ground.shape[0] * CELL_M
    east, north = _plan(extent_m)
    wanted = share * east.size
    covered = 0
    while covered < wanted:
        x, y = random.uniform(0, extent_m, 2)
        for _ in range(int(random.integers(1, 12))):
            radius = random.uniform(1.0, 4.0)
            tall = max(1.0, height_m * random.uniform(0.15, 1.0))
            cx, cy = np.array([x, y]) + random.normal(0, 8.0, 2)
            rows = slice(max(0, int((cy - radius) / CELL_M)), max(0, int((cy + radius) / CELL_M)))
            columns = slice(
                max(0, int((cx - radius) / CELL_M)), max(0, int((cx + radius) / CELL_M))
            )
            off = np.hypot(east[rows, columns] - cx, north[rows, columns] - cy) / radius
            if off.size == 0:
                continue
            under = off < 1.0
            floor = land.ground[rows, columns]
            top = floor + tall * np.sqrt(np.maximum(1.0 - off**2, 0.0)) * 0.6 + 0.4 * tall
            base = floor + (0.1 if random.random() < 0.5 else 0.35) * tall
            here = land.crown_top[rows, columns]
            new = under & ~(here > top)
            land.crown_top[rows, columns] = np.where(new, top, here)
            land.crown_base[rows, columns] = np.where(new, base, land.crown_base[rows, columns])
            covered += int(under.sum())


def _add_vehicles(land: Landscape, random: Generator, count: int) -> None:
    extent_m = land.ground.shape[0] * CELL_M
    for _ in range(count):
        row, column = (random.uniform(0, extent_m - 6.0, 2) / CELL_M).astype(int)
        part = np.s_[row : row + round(1.8 / CELL_M), column : column + round(4.5 / CELL_M)]
        land.add_solid(part, land.ground[part] + 1.5, VEHICLE)


def _add_bridge(land: Landscape, random: Generator, level_m: float, wide_m: float) -> None:
    """A deck at one height where the ground below falls away from it."""
    off = _across(random, land.ground.shape[0] * CELL_M, 0.0)
    deck = (np.abs(off) < wide_m / 2) & (land.ground < level_m - _KERB_M)
    land.solid[deck], land.solid_code[deck] = level_m, BRIDGE


def _hillside(random: Generator, extent_m: float) -> Landscape:
    off = _across(random, extent_m, 20.0)
    slope = random.uniform(0.4, 0.75)
    ground = slope * off + _rolling(random, extent_m, 3.0, 60.0)
    ground += _steps(off, random, run_m=25.0, face_m=3.0, slope=3.0)
    land = Landscape.bare(ground)
    for _ in range(int(extent_m**2 / 700)):
        _add_building(land, random, (8.0, 24.0), (2.5, 9.0))
    _add_trees(land, random, 0.25, 14.0)
    return land


def _town(random: Generator, extent_m: float) -> Landscape:
    ground = _rolling(random, extent_m, 1.5, 120.0)
    off = _across(random, extent_m, 10.0)
    ground += np.clip((18.0 - np.abs(off)) * 0.6, 0.0, random.uniform(2.0, 5.0))
    land = Landscape.bare(ground)
    for _ in range(int(extent_m**2 / 1500)):
        _add_building(land, random, (10.0, 60.0), (3.0, 18.0))
    _add_bridge(land, random, float(ground.max()) - 0.3, random.uniform(8.0, 14.0))
    _add_trees(land, random, 0.1, 12.0)
    _add_vehicles(land, random, int(extent_m**2 / 600))
    return land


def _station(random: Generator, extent_m: float) -> Landscape:
    ground = _rolling(random, extent_m, 0.6, 150.0)
    land = Landscape.bare(ground)
    _add_building(land, random, (60.0, 120.0), (6.0, 15.0))
    for _ in range(int(extent_m**2 / 5000)):
        _add_building(land, random, (20.0, 90.0), (3.0, 6.0))
    _add_vehicles(land, random, int(extent_m**2 / 400))
    _add_trees(land, random, 0.05, 10.0)
    return land


def _river(random: Generator, extent_m: float) -> Landscape:
    off = _across(random, extent_m, 25.0)
    bank = random.uniform(8.0, 20.0)
    ground = np.clip((np.abs(off) - 20.0) * random.uniform(0.6, 1.1), 0.0, bank)
    ground += _rolling(random, extent_m, 1.0, 80.0) + 0.05 * np.maximum(np.abs(off) - 40.0, 0.0)
    land = Landscape.bare(ground)
    land.water[:] = np.abs(off) < 14.0
    _add_trees(land, random, 0.35, 18.0)
    for _ in range(int(extent_m**2 / 4000)):
        _add_building(land, random, (8.0, 20.0), (3.0, 8.0))
    land.solid[land.water] = np.nan
    return land


def _quarry(random: Generator, extent_m: float) -> Landscape:
    off = _across(random, extent_m, 30.0)
    ground = _rolling(random, extent_m, 2.0, 70.0)
    ground += _steps(off, random, run_m=30.0, face_m=10.0, slope=random.uniform(1.2, 3.0))
    land = Landscape.bare(ground)
    _add_trees(land, random, 0.12, 10.0)
    for _ in range(3):
        _add_building(land, random, (8.0, 20.0), (3.0, 8.0))
    return land


def _embankment(random: Generator, extent_m: float) -> Landscape:
    ground = _rolling(random, extent_m, 2.0, 150.0)
    for _ in range(2):
        off = _across(random, extent_m, 15.0)
        height = random.uniform(2.0, 8.0)
        ground += np.clip((random.uniform(10, 22) - np.abs(off)) * 0.66, 0.0, height)
    land = Landscape.bare(ground)
    _add_trees(land, random, 0.04, 8.0)
    _add_vehicles(land, random, 10)
    return land


def _bridge(random: Generator, extent_m: float) -> Landscape:
    ground = _rolling(random, extent_m, 1.0, 120.0)
    cut = _across(random, extent_m, 5.0)
    ground -= np.clip((22.0 - np.abs(cut)) * 0.6, 0.0, random.uniform(5.0, 8.0))
    land = Landscape.bare(ground)
    _add_bridge(land, random, float(np.median(ground)), random.uniform(8.0, 20.0))
    _add_trees(land, random, 0.15, 12.0)
    for _ in range(int(extent_m**2 / 3000)):
        _add_building(land, random, (8.0, 30.0), (3.0, 9.0))
    return land


def _village(random: Generator, extent_m: float) -> Landscape:
    land = Landscape.bare(_rolling(random, extent_m, 1.5, 120.0))
    for _ in range(int(extent_m**2 / 450)):
        _add_building(land, random, (7.0, 18.0), (2.2, 6.5))
    _add_trees(land, random, 0.15, 10.0)
    _add_vehicles(land, random, int(extent_m**2 / 900))
    return land


KINDS: Mapping[str, Callable[[Generator, float], Landscape]] = {
    "bridge": _bridge,
    "embankment": _embankment,
    "hillside": _hillside,
    "quarry": _quarry,
    "river": _river,
    "station": _station,
    "town": _town,
    "village": _village,
}
"""Name of a kind of terrain to what draws it."""
