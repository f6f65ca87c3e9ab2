"""Fences, cones, scaffolds, nets and huts: what parts a site from the world and holds things up."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import TriangleShape, grid, plate, tube
from processing.laboratory.simulate.sites.bodies import (
    SiteBody,
    SiteKind,
    SitePart,
    beam,
    block,
    rotate_part,
    shift_parts,
)

_PIPE_RADIUS_M = 0.0243  # 単管パイプ 48.6 mm (JIS G 3444)
_BAY_M = 1.8


def fence_panel(random: Generator, long_m: float) -> SiteBody:
    """One panel of a fence: steel plates, or a mesh one sees through, leaning a little."""
    lean = random.normal(0, 0.02)
    if random.random() < 0.5:
        high = random.choice([2.0, 3.0])  # 万能鋼板
        corners = np.array([[0.0, 0, -0.1], [long_m, 0, -0.1], [long_m, 0, high], [0, 0, high]])
        corners[2:, 1] += lean * high
        plates = (corners, np.array([[0, 1, 2], [0, 2, 3]]))
        posts = [
            (
                tube(np.array([[along, 0.1, -0.2], [along, 0.1, high]]), np.full(2, 0.03), 6),
                Material.STEEL,
            )
            for along in (0.0, long_m)
        ]
        return SiteBody(SiteKind.FENCE, ((plates, Material.PAINTED_METAL), *posts))
    high = random.choice([0.8, 1.2, 1.8])  # ガードフェンス
    parts: list[SitePart] = []
    bars = np.arange(0.0, long_m + 0.01, 0.15)
    parts += [
        (beam((along, 0.0, 0.05), (along, lean * high, high), 0.012, 0.012), Material.PAINTED_METAL)
        for along in bars
    ]
    for level in (0.1, high):
        foot, top = (0.0, lean * level, level), (long_m, lean * level, level)
        parts.append((beam(foot, top, 0.03, 0.03), Material.PAINTED_METAL))
    for along in (0.1, long_m - 0.1):
        parts.append(block((along - 0.05, -0.25, 0.0), (along + 0.05, 0.25, 0.06), Material.RUBBER))
    return SiteBody(SiteKind.FENCE, tuple(parts))


def cone(random: Generator) -> SiteBody:
    """A traffic cone of 70 cm; some have fallen."""
    path = np.array([[0, 0, 0.03], [0, 0, 0.35], [0, 0, 0.7]])
    shape = tube(path, np.array([0.15, 0.09, 0.025]), 10)
    parts: tuple[SitePart, ...] = (
        (shape, Material.PLASTIC),
        block((-0.19, -0.19, 0.0), (0.19, 0.19, 0.03), Material.RUBBER),
    )
    if random.random() < 0.12:
        parts = shift_parts([rotate_part(one, 1, 1.38, (0, 0, 0)) for one in parts], (0, 0, 0.16))
    return SiteBody(SiteKind.CONE, parts)


def scaffold(random: Generator) -> SiteBody:
    """A frame of pipes in bays with decks, levels 1.7 m apart (枠組足場)."""
    bays, levels = int(random.integers(2, 6)), int(random.integers(1, 4))
    deep = random.choice([0.61, 0.9, 1.2])
    parts: list[SitePart] = []
    high = 1.7 * levels + 1.0
    for number in range(bays + 1):
        for side in (0.0, deep):
            along = number * _BAY_M
            path = np.array([[along, side, -0.15], [along, side, high]])
            parts.append((tube(path, np.full(2, _PIPE_RADIUS_M), 6), Material.STEEL))
    for level in range(1, levels + 1):
        z = 1.7 * level
        parts.append(block((0, 0.05, z - 0.04), (bays * _BAY_M, deep - 0.05, z), Material.STEEL))
        for rail in (0.5, 0.95):
            for side in (0.0, deep):
                path = np.array([[0.0, side, z + rail], [bays * _BAY_M, side, z + rail]])
                parts.append((tube(path, np.full(2, _PIPE_RADIUS_M), 6), Material.STEEL))
    for number in range(0, bays, 2):
        start, end = (number * _BAY_M, 0.0, 0.2), ((number + 1) * _BAY_M, 0.0, 1.7)
        parts.append((beam(start, end, 0.03, 0.03), Material.STEEL))
    return SiteBody(SiteKind.SCAFFOLD, tuple(parts))


def net(random: Generator) -> SiteBody:
    """A net hung between posts; sagging, with folds that beams pass through."""
    long, high = random.uniform(3.0, 12.0), random.uniform(1.2, 3.0)
    along, up = np.meshgrid(np.linspace(0, long, 25), np.linspace(0, 1, 7))
    sag = 0.12 * np.abs(np.sin(along / long * np.pi * 3)) * up
    fold = 0.08 * np.sin(along * random.uniform(1.5, 4)) * (1.2 - up)
    sheet = grid(np.stack([along, fold, 0.05 + up * high - sag], axis=-1))
    parts: list[SitePart] = [(sheet, Material.NET)]
    for post in np.linspace(0, long, 4):
        path = np.array([[post, 0.03, -0.3], [post, 0.03, high + 0.15]])
        parts.append((tube(path, np.full(2, _PIPE_RADIUS_M), 6), Material.STEEL))
    return SiteBody(SiteKind.NET, tuple(parts))


def hut(random: Generator) -> SiteBody:
    """A prefabricated office or store; on blocks, with a window and a door."""
    long, wide = random.choice([3.6, 5.4, 7.2]), random.choice([2.3, 3.6])
    high = random.uniform(2.4, 2.8)
    parts: list[SitePart] = [
        block((-long / 2, -wide / 2, 0.15), (long / 2, wide / 2, high), Material.PAINTED_METAL),
        (_roof(long, wide, high), Material.ROOF),
        block((-0.9, -wide / 2 - 0.03, 1.0), (0.9, -wide / 2, 1.9), Material.GLASS),
        block(
            (long / 2 - 1.3, -wide / 2 - 0.04, 0.2),
            (long / 2 - 0.4, -wide / 2, 2.1),
            Material.PAINTED_METAL,
        ),
    ]
    for x in (-long / 2, long / 2):
        gable = np.array([[x, -wide / 2, high], [x, wide / 2, high], [x, 0.0, high + 0.25]])
        parts.append((plate(gable), Material.PAINTED_METAL))
    for x in (-long / 2, long / 2 - 0.4):
        parts += [
            block((x, y, -0.25), (x + 0.4, y + 0.2, 0.15), Material.CONCRETE)
            for y in (-wide / 2, wide / 2 - 0.2)
        ]
    return SiteBody(SiteKind.HUT, tuple(parts), (0.0, 0.0))


def _roof(long: float, wide: float, high: float) -> TriangleShape:
    x = np.array([-long / 2 - 0.15, long / 2 + 0.15])
    y = np.array([-wide / 2 - 0.2, 0.0, wide / 2 + 0.2])
    columns, rows = np.meshgrid(x, y)
    heights = high + np.array([0.0, 0.25, 0.0])[:, None] * np.ones(2)
    return grid(np.stack([columns, rows, heights], axis=-1))
