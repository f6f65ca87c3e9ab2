"""Material lying about: pipes, blocks, sheet piles, formwork, sandbags."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import TriangleShape, place_shape, tube
from processing.laboratory.simulate.sites.bodies import (
    SiteBody,
    SiteKind,
    SitePart,
    beam,
    block,
    rotate_part,
)


def pipes(random: Generator) -> SiteBody:
    """Concrete or plastic pipes, in layers on two timbers (JIS A 5372, JIS K 6741)."""
    radius, long = random.uniform(0.06, 0.42), random.uniform(2.0, 4.5)
    wide = int(random.integers(2, 7))
    material = Material.CONCRETE if radius > 0.18 else Material.PLASTIC
    parts: list[SitePart] = [
        block((along, -radius, 0.0), (along + 0.12, (2 * wide + 1) * radius, 0.1), Material.WOOD)
        for along in (-long * 0.32, long * 0.28)
    ]
    for layer in range(int(random.integers(1, min(wide, 4) + 1))):
        for number in range(wide - layer):
            shift = random.uniform(-0.15, 0.15)
            y = radius * (2 * number + layer)
            z = 0.1 + radius * (1 + 1.74 * layer)
            ends = np.array([[-long / 2 + shift, y, z], [long / 2 + shift, y, z]])
            is_solid = radius < 0.1
            parts.append((tube(ends, np.full(2, radius), 10, is_closed=is_solid), material))
    return SiteBody(SiteKind.MATERIAL, tuple(parts), (long / 2, wide * radius))


def blocks(random: Generator) -> SiteBody:
    """Concrete blocks of a revetment or of a wall, stacked askew."""
    size = np.array([random.uniform(0.4, 1.6), random.uniform(0.3, 1.0), random.uniform(0.2, 0.9)])
    parts: list[SitePart] = []
    for layer in range(int(random.integers(1, 4))):
        for row in range(int(random.integers(1, 5))):
            low = np.array([0.0, row * (size[1] + 0.06), layer * size[2]])
            low[:2] += random.normal(0, 0.03, 2)
            part = block(low, low + size, Material.CONCRETE)
            parts.append(rotate_part(part, 2, random.normal(0, 0.03), low))
    return SiteBody(SiteKind.MATERIAL, tuple(parts), (size[0] / 2, size[1]))


def sheet_piles(random: Generator) -> SiteBody:
    """Steel sheet piles (鋼矢板 of 400 mm), a few nested on timbers."""
    long, high = random.uniform(5.0, 10.0), 0.13
    profile = np.array([[-0.2, 0.0], [-0.1, high], [0.1, high], [0.2, 0.0]])
    parts: list[SitePart] = [
        block((along, -0.3, 0.0), (along + 0.15, 0.3, 0.12), Material.WOOD)
        for along in (-long * 0.3, long * 0.25)
    ]
    for number in range(int(random.integers(2, 9))):
        base = 0.14 + number * 0.035
        shift = random.uniform(-0.3, 0.3)
        for one, other in pairwise(profile):
            corners = np.array(
                [
                    [-long / 2 + shift, one[0], base + one[1]],
                    [long / 2 + shift, one[0], base + one[1]],
                    [long / 2 + shift, other[0], base + other[1]],
                    [-long / 2 + shift, other[0], base + other[1]],
                ]
            )
            parts.append(((corners, np.array([[0, 1, 2], [0, 2, 3]])), Material.STEEL))
    return SiteBody(SiteKind.MATERIAL, tuple(parts), (long / 2, 0.3))


def formwork(random: Generator) -> SiteBody:
    """Plywood forms for a small wall, propped from behind; or sheets in a pile."""
    if random.random() < 0.4:
        count = int(random.integers(3, 25))
        low = (-0.9, -0.45, 0.0)
        pile = [block(low, (0.9, 0.45, 0.1), Material.WOOD)]
        for number in range(count):
            shift = random.normal(0, 0.015, 2)
            sheet = (
                (-0.9 + shift[0], -0.45 + shift[1], 0.1 + number * 0.02),
                (0.9 + shift[0], 0.45 + shift[1], 0.115 + number * 0.02),
            )
            pile.append(block(*sheet, Material.WOOD))
        return SiteBody(SiteKind.MATERIAL, tuple(pile), (0.9, 0.45))
    long, high, thick = random.uniform(2, 6), random.uniform(0.6, 2.2), random.uniform(0.2, 0.5)
    parts: list[SitePart] = [
        block((-long / 2, side - 0.02, -0.1), (long / 2, side + 0.02, high), Material.WOOD)
        for side in (0.0, thick)
    ]
    for along in np.arange(-long / 2 + 0.3, long / 2, 0.9):
        foot, top = (along, -high * 0.6, 0.0), (along, -0.05, high * 0.85)
        parts.append((beam(foot, top, 0.05, 0.08), Material.WOOD))
        parts.append(
            (
                tube(np.array([[along, 0, 0.0], [along, 0, high + 0.1]]), np.full(2, 0.024), 6),
                Material.STEEL,
            )
        )
    return SiteBody(SiteKind.MATERIAL, tuple(parts))


def sandbags(random: Generator) -> SiteBody:
    """Large black bags of a cubic metre (大型土のう) in a row, bulging."""
    parts: list[SitePart] = []
    for number in range(int(random.integers(2, 9))):
        high = random.uniform(0.85, 1.08)
        at = (number * 1.12 + random.normal(0, 0.05), random.normal(0, 0.1), 0.0)
        parts.append((place_shape(_bag(random, high), at, random.uniform(0, 6)), Material.CLOTH))
    return SiteBody(SiteKind.MATERIAL, tuple(parts))


def _bag(random: Generator, high: float) -> TriangleShape:
    rise = np.array([-0.1, 0.15, 0.5, 0.85, 1.0]) * high
    lean = random.normal(0, 0.05, 2)
    path = np.column_stack([lean[0] * rise, lean[1] * rise, rise])
    return tube(path, np.array([0.5, 0.54, 0.56, 0.5, 0.3]) * random.uniform(0.93, 1.05), 12)


STORES = (pipes, blocks, sheet_piles, formwork, sandbags)
