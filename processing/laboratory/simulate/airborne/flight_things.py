"""What beams from the air meet besides surfaces: crowns with gaps, and rods of any thickness.

A crown is a body of leaves in two sizes of cells: clumps, as the shoots of a branch are, and
leaves or twigs within them. Whether a cell holds leaves follows from its place and the crown
alone, so that beams of another line meet the same ones. A rod is a trunk, a branch, a member of a
lattice or a stretch of a conductor; it takes as much of a beam as it covers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.airborne.landscapes import CELL_M, Floats, Landscape
from processing.laboratory.simulate.airborne.power_lines import POLE, TOWER, WIRE, LineStyle

LOW_PLANT, CROWN = 4, 5
LOW_PLANT_M = 2.0
"""Plants up to this height are no trees."""

ROD_COLUMNS = 9
"""``from`` (3), ``to`` (3), radius m, class, reflectance."""

CROWN_COLUMNS = 10
"""``middle`` (2), base m, top m, radius m, form (0 round, 1 pointed), share of clumps that hold
leaves, share of their cells that do, class, reflectance."""

_LEAVES = (0.35, 0.6)
"""Reflectance of leaves in the near infrared."""

_BARK = (0.15, 0.35)
_STEEL = (0.2, 0.5)
_CONDUCTOR = (0.15, 0.45)
_CONDUCTOR_RADIUS_M = (0.006, 0.02)
"""Of conductors from a village's insulated line to those of high tension."""

_MEMBER_M = (0.03, 0.09)
"""Half the width of a lattice's angle sections."""

_PIECE_M = 4.0
"""Longest stretch of a conductor that is straight: 5 mm of sag between its ends."""


class Things(NamedTuple):
    """(n, :data:`ROD_COLUMNS`) and (m, :data:`CROWN_COLUMNS`) float64, frame of the landscape."""

    rods: Floats
    crowns: Floats

    @classmethod
    def joined(cls, parts: list[Things]) -> Things:
        """All of them."""
        rods = [one.rods.reshape(-1, ROD_COLUMNS) for one in parts]
        crowns = [one.crowns.reshape(-1, CROWN_COLUMNS) for one in parts]
        return cls(np.concatenate(rods), np.concatenate(crowns))


def _things(rods: list[Floats], crowns: list[tuple[float, ...]]) -> Things:
    return Things(
        np.concatenate(rods) if rods else np.empty((0, ROD_COLUMNS)),
        np.array(crowns, np.float64).reshape(-1, CROWN_COLUMNS),
    )


def _rods(ends: Floats, radius: Floats | float, code: int, reflectance: float) -> Floats:
    rods = np.empty((len(ends), ROD_COLUMNS))
    rods[:, :6] = ends.reshape(-1, 6)
    rods[:, 6], rods[:, 7], rods[:, 8] = radius, code, reflectance
    return rods


def height_at(ground: Floats, xy: Floats) -> Floats:
    """Height of a raster's nearest cell, m."""
    last = np.array(ground.shape)[::-1] - 1
    column, row = np.clip((xy / CELL_M).astype(int), 0, last).T
    heights: Floats = ground[row, column]
    return heights


def plants(land: Landscape, random: Generator, free: NDArray[np.bool_], share: float) -> Things:
    """Trees in groups and alone over a share of the plan, and low plants beneath and beside.

    Parameters
    ----------
    free : (rows, columns) bool
        Where a stem may stand.
    share : float
        Of the plan that crowns cover.
    """
    extent_m = land.ground.shape[0] * CELL_M
    rods: list[Floats] = []
    crowns: list[tuple[float, ...]] = []
    tallest, is_winter = random.uniform(8.0, 26.0), random.random() < _WINTER
    covered = 0.0
    while covered < share * extent_m**2:
        group = random.uniform(0, extent_m, 2)
        pointed = bool(random.random() < 0.35)
        for _ in range(int(random.integers(1, 14))):
            xy = group + random.normal(0, 7.0, 2)
            if not _is_free(free, xy):
                continue
            foot = float(height_at(land.ground, xy[None])[0])
            tall = max(2.5, tallest * random.uniform(0.3, 1.0))
            rod, crown = _tree(random, xy, foot, (tall, pointed), is_winter=is_winter)
            rods.append(rod)
            crowns.append(crown)
            covered += float(np.pi * crown[4] ** 2)
    for _ in range(int(extent_m**2 / random.uniform(60.0, 300.0))):
        xy = random.uniform(0, extent_m, 2)
        if _is_free(free, xy):
            crowns.append(_low_plant(random, xy, float(height_at(land.ground, xy[None])[0])))
    return _things(rods, crowns)


_WINTER = 0.15
"""Share of landscapes whose broad-leaved trees bear hardly a leaf: twigs alone give returns."""


def _is_free(free: NDArray[np.bool_], xy: Floats) -> bool:
    column, row = (xy / CELL_M).astype(int)
    rows, columns = free.shape
    return bool(0 <= row < rows and 0 <= column < columns and free[row, column])


def _tree(
    random: Generator, xy: Floats, foot: float, form: tuple[float, bool], *, is_winter: bool
) -> tuple[Floats, tuple[float, ...]]:
    """A tree's stem and branches, and its crown."""
    tall, pointed = form
    radius = max(0.8, tall * random.uniform(0.12, 0.18 if pointed else 0.32))
    base = tall * (random.uniform(0.05, 0.25) if pointed else random.uniform(0.15, 0.45))
    stem = tall * random.uniform(0.007, 0.014)
    top = foot + tall
    lean = random.normal(0, 0.02 * tall, 2)
    levels = np.linspace(0.0, 0.9, 4)
    nodes = np.column_stack([xy + levels[:, None] * lean, foot + levels * tall])
    stems = np.concatenate([nodes[:-1], nodes[1:]], axis=1)
    thick = stem * (1.0 - levels[:-1])
    count = int(random.integers(8, 24))
    at = random.uniform(base, 0.92 * tall, count)
    turn, reach = random.uniform(0, 2 * np.pi, count), radius * random.uniform(0.5, 0.95, count)
    if pointed:
        reach *= 1.0 - (at - base) / (tall - base)
    starts = np.column_stack([xy + (at / tall)[:, None] * lean, foot + at])
    rise = reach * random.uniform(-0.1, 0.2 if pointed else 0.9, count)
    rise = np.minimum(rise, 0.95 * tall - at)
    ends = starts + np.column_stack([reach * np.cos(turn), reach * np.sin(turn), rise])
    branches = np.concatenate([starts, ends], axis=1)
    width = np.concatenate([thick, random.uniform(0.01, 0.25 * stem + 0.012, count)])
    bark = random.uniform(*_BARK)
    code = CROWN if tall >= LOW_PLANT_M else LOW_PLANT
    rods = _rods(np.concatenate([stems, branches]), width, code, bark)
    bare = is_winter and not pointed
    clumps = random.uniform(0.35, 0.75)
    leaves = random.uniform(0.015, 0.05) if bare else random.uniform(0.05, 0.3)
    colour = bark if bare else random.uniform(*_LEAVES)
    middle = xy + 0.6 * lean
    crown = (*middle, foot + base, top, radius, float(pointed), clumps, leaves, code, colour)
    return rods, tuple(float(one) for one in crown)


def _low_plant(random: Generator, xy: Floats, foot: float) -> tuple[float, ...]:
    """A shrub, a bush or tall weeds: near the ground, with gaps."""
    tall, radius = random.uniform(0.35, LOW_PLANT_M - 0.1), random.uniform(0.4, 1.8)
    clumps, leaves = random.uniform(0.6, 1.0), random.uniform(0.1, 0.5)
    colour = random.uniform(*_LEAVES)
    low = foot + 0.1 * tall
    crown = (*xy, low, foot + tall, radius, 0.0, clumps, leaves, LOW_PLANT, colour)
    return tuple(float(one) for one in crown)


def power_line_rods(
    ground: Floats, random: Generator, style: LineStyle, through: Floats
) -> tuple[Things, Floats]:
    """A line of towers or poles with its conductors; where it runs.

    Parameters
    ----------
    through : (2,) float64
        Foot of one carrier.

    Returns
    -------
    Things, (k, 2) float64
        The feet of its carriers.
    """
    extent_m = ground.shape[0] * CELL_M
    turn = random.uniform(0, np.pi)
    ahead = np.array([np.cos(turn), np.sin(turn)])
    aside = np.array([-ahead[1], ahead[0]])
    span, tall = random.uniform(*style.span_m), random.uniform(*style.height_m)
    half = int(np.ceil(1.5 * extent_m / span))
    feet = through + span * np.arange(-half, half + 1)[:, None] * ahead
    floors = height_at(ground, feet)
    arm, foot_m = random.uniform(*style.arm_m), random.uniform(*style.foot_m)
    levels = int(random.integers(*style.conductors, endpoint=True))
    steel, metal = random.uniform(*_STEEL), random.uniform(*_CONDUCTOR)
    heights = tall * (1.0 - random.uniform(0.08, 0.14) * np.arange(levels, dtype=np.float64))
    rods: list[Floats] = []
    for foot, floor in zip(feet, floors, strict=True):
        if np.all((foot > -arm) & (foot < extent_m + arm)):
            ends = _carrier(random, style, (tall, foot_m), (arm, heights))
            placed = ends[..., :1] * aside + ends[..., 1:2] * ahead + foot
            ends = np.concatenate([placed, ends[..., 2:] + floor], axis=-1)
            thick = random.uniform(*_MEMBER_M) if style.code == TOWER else foot_m / 2
            rods.append(_rods(ends, thick, style.code, steel))
    sag, radius = span * random.uniform(0.01, 0.03), random.uniform(*_CONDUCTOR_RADIUS_M)
    sides = (-arm, arm) if style.code == TOWER else (-arm, 0.0, arm)
    for side in sides:
        for level in heights:
            wire = _conductor(feet + side * aside, floors + level, sag)
            rods.append(_rods(wire, radius, WIRE, metal))
    if style.code == TOWER and random.random() < 0.7:
        rods.append(_rods(_conductor(feet, floors + 1.08 * tall, 0.7 * sag), radius, WIRE, metal))
    return _things([_within(np.concatenate(rods), extent_m)], []), feet


def _within(rods: Floats, extent_m: float) -> Floats:
    ends = rods[:, :6].reshape(-1, 2, 3)[:, :, :2]
    inside: Floats = rods[np.all((ends > 0) & (ends < extent_m), axis=(1, 2))]
    return inside


def _conductor(feet: Floats, tops: Floats, sag: float) -> Floats:
    """(n, 2, 3) straight pieces of a conductor that hangs from place to place."""
    span = float(np.hypot(*(feet[1] - feet[0])))
    part = np.linspace(0.0, 1.0, int(np.ceil(span / _PIECE_M)) + 1)
    pieces = []
    for here, there, low, high in zip(feet, feet[1:], tops, tops[1:], strict=False):
        hang = low + part * (high - low) - 4.0 * sag * part * (1.0 - part)
        nodes = np.column_stack([here + part[:, None] * (there - here), hang])
        pieces.append(np.stack([nodes[:-1], nodes[1:]], axis=1))
    return np.concatenate(pieces)


def _carrier(
    random: Generator, style: LineStyle, size: tuple[float, float], arms: tuple[float, Floats]
) -> Floats:
    """(n, 2, 3) rods of a tower or pole about its foot: across, along, up."""
    (tall, foot), (arm, levels) = size, arms
    if style.code == POLE:
        beams = [((-arm, 0.0, level), (arm, 0.0, level)) for level in levels]
        return np.array([((0.0, 0.0, 0.0), (0.0, 0.0, tall)), *beams])
    panel = random.uniform(0.9, 1.4)
    floors = [0.0]
    while floors[-1] < 1.06 * tall:
        # Panels are about as high as the body is wide there.
        wide = foot * max(0.12, 1.0 - 0.95 * floors[-1] / tall)
        floors.append(floors[-1] + panel * max(wide, 0.5))
    up = np.array(floors)
    half = foot / 2 * np.maximum(0.12, 1.0 - 0.95 * up / tall)
    corners = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], float)
    nodes = np.concatenate(
        [half[:, None, None] * corners, np.broadcast_to(up[:, None, None], (up.size, 4, 1))], axis=2
    )
    after = np.roll(nodes, -1, axis=1)
    legs = np.stack([nodes[:-1], nodes[1:]], axis=2).reshape(-1, 2, 3)
    cross = np.stack([nodes[:-1], after[1:]], axis=2).reshape(-1, 2, 3)
    other = np.stack([after[:-1], nodes[1:]], axis=2).reshape(-1, 2, 3)
    rings = np.stack([nodes[1:], after[1:]], axis=2).reshape(-1, 2, 3)
    tips = []
    for level in levels:
        inner = foot / 2 * max(0.12, 1.0 - 0.95 * level / tall)
        for side in (-1.0, 1.0):
            for end in (-inner, inner):
                tips.append(((side * inner, end, level), (side * arm, 0.0, level)))
                tips.append(((side * inner, end, level + 1.0), (side * arm, 0.0, level)))
    return np.concatenate([legs, cross, other, rings, np.array(tips)])
