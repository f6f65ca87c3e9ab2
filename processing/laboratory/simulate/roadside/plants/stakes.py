"""Stakes that hold young trees (支柱), in the shapes that landscape contractors use."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.plants.trunks import Stem
from processing.laboratory.simulate.roadside.rods import join_shapes, rod, rods
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape

_SUNK_M = 0.3
_FRAME_ROOM_M, _TRIPOD_ROOM_M = 0.6, 1.15


def stakes_of(
    random: Generator, stem: Stem, heading_rad: float, room_m: float
) -> tuple[TriangleShape, TriangleShape, int]:
    """Stakes about a stem, in the tree's frame.

    Parameters
    ----------
    room_m : float
        How far they may reach across the road's way: curbs and gutters lie beyond.

    Kinds after 公園緑地工事標準図 of the ministry: 二脚鳥居 and 四脚鳥居 (posts and bars beside the
    trunk), 八ツ掛 (three poles that lean on it), 一本支柱 (a single cane).

    Returns
    -------
    Shape, Shape
        Posts and bars; straps.
    int
        How many posts stand on the ground.
    """
    radius = float(random.uniform(0.025, 0.045))
    chance = random.random()
    turn = heading_rad + float(random.normal(0, 0.1))
    if chance < 0.4 or room_m < _FRAME_ROOM_M:
        return _gate(random, stem, turn, radius)
    if chance < 0.7 and room_m > _TRIPOD_ROOM_M:
        return _tripod(random, stem, turn, radius * 0.8)
    if chance < 0.85:
        return _frame(random, stem, turn, radius)
    return _cane(random, stem, turn)


def _frame_of(turn: float) -> tuple[Floats, Floats]:
    along = np.array([np.cos(turn), np.sin(turn), 0.0])
    return along, np.array([-along[1], along[0], 0.0])


def _strap(stem: Stem, height_m: float) -> TriangleShape:
    angles = np.linspace(0, 2 * np.pi, 13)
    wide = stem.radius_m(height_m) * 1.04 + 0.004
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(13)]) * wide
    return rods((stem.at(height_m) + circle)[None], 0.012, 5, is_closed=False)


def _post(foot: Floats, high_m: float, radius: float, tilt: Floats) -> TriangleShape:
    low = np.array([foot[0], foot[1], -_SUNK_M])
    return rod(low, np.array([foot[0] + tilt[0], foot[1] + tilt[1], high_m]), radius, 10)


def _gate(
    random: Generator, stem: Stem, turn: float, radius: float
) -> tuple[TriangleShape, TriangleShape, int]:
    along, aside = _frame_of(turn)
    high = float(random.uniform(0.65, 1.3))
    half = float(random.uniform(0.22, 0.42)) + stem.radius_m(high)
    away = stem.radius_m(high) + radius + 0.012
    middle = stem.at(high - 0.08)
    middle = np.array([middle[0], middle[1], 0.0]) + aside * away
    posts = [
        _post(middle + sign * along * half, high, radius, random.normal(0, 0.02, 3))
        for sign in (-1, 1)
    ]
    level = np.array([0.0, 0.0, high - 0.08 + float(random.normal(0, 0.01))])
    beam = rod(middle - along * (half + 0.1) + level, middle + along * (half + 0.1) + level, radius)
    return join_shapes([*posts, beam]), _strap(stem, high - 0.08), 2


def _frame(
    random: Generator, stem: Stem, turn: float, radius: float
) -> tuple[TriangleShape, TriangleShape, int]:
    along, aside = _frame_of(turn)
    high = float(random.uniform(0.7, 1.4))
    half = float(random.uniform(0.25, 0.4)) + stem.radius_m(high)
    middle = stem.at(high)
    middle = np.array([middle[0], middle[1], 0.0])
    parts = []
    for x in (-1, 1):
        for y in (-1, 1):
            corner = middle + half * (x * along + y * aside)
            parts.append(_post(corner, high, radius, random.normal(0, 0.015, 3)))
    level = np.array([0.0, 0.0, high - 0.07])
    for y in (-1, 1):
        edge = middle + level + y * half * aside
        parts.append(rod(edge - along * (half + 0.08), edge + along * (half + 0.08), radius))
    away = stem.radius_m(high) + radius * 0.8 + 0.01
    for y in (-1, 1):
        cross = middle + level + [0.0, 0.0, 0.05] + y * away * along
        parts.append(
            rod(cross - aside * (half + 0.06), cross + aside * (half + 0.06), radius * 0.8)
        )
    return join_shapes(parts), _strap(stem, high - 0.02), 4


def _tripod(
    random: Generator, stem: Stem, turn: float, radius: float
) -> tuple[TriangleShape, TriangleShape, int]:
    high = float(random.uniform(1.4, 2.0))
    reach = high * float(random.uniform(0.35, 0.55))
    centre = stem.at(high)
    legs = []
    for each in range(3):
        angle = turn + each * 2 * np.pi / 3 + float(random.normal(0, 0.15))
        direction = np.array([np.cos(angle), np.sin(angle), 0.0])
        touch = centre + direction * (stem.radius_m(high) + radius + 0.008)
        foot = np.array([centre[0], centre[1], 0.0]) + direction * reach
        down = (foot - touch) / np.linalg.norm(foot - touch)
        legs.append(
            rod(foot + down * 0.25, touch - down * float(random.uniform(0.1, 0.3)), radius, 8)
        )
    return join_shapes(legs), _strap(stem, high), 3


def _cane(random: Generator, stem: Stem, turn: float) -> tuple[TriangleShape, TriangleShape, int]:
    along, _ = _frame_of(turn)
    high = float(random.uniform(1.5, 2.4))
    radius = float(random.uniform(0.012, 0.025))
    foot, top = stem.at(0.0), stem.at(high)
    low_direction = along * (stem.radius_m(0.05) + radius + 0.02)
    top_direction = along * (stem.radius_m(high) + radius + 0.01)
    cane = rod(foot + low_direction - [0.0, 0.0, _SUNK_M], top + top_direction, radius, 8)
    return cane, _strap(stem, high - 0.2), 1


def guard_of(random: Generator, stem: Stem) -> TriangleShape:
    """A guard of upright bars and rings about a trunk (樹木保護柵), in the tree's frame."""
    high = float(random.uniform(0.9, 1.6))
    away = stem.radius_m(0.3) + float(random.uniform(0.12, 0.28))
    middle = stem.at(high / 2) * [1.0, 1.0, 0.0]
    turns = np.arange(int(random.integers(8, 15))) * 2 * np.pi
    turns = turns / turns.size
    feet = middle + away * np.column_stack([np.cos(turns), np.sin(turns), 0 * turns])
    up = np.array([0.0, 0.0, 1.0])
    bars = np.stack([feet - _SUNK_M * up, feet + high * up], axis=1)
    angles = np.linspace(0, 2 * np.pi, 25)
    circle = middle + away * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    rings = np.stack([circle + level * up for level in (0.15, high / 2, high)])
    return join_shapes([rods(bars, 0.008, 5), rods(rings, 0.01, 5, is_closed=False)])
