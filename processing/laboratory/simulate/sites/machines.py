"""Construction machines: excavators, dump trucks, bulldozers, rollers.

Sizes are those of makers' catalogues between a mini excavator of 3 t and a machine of 30 t.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import TriangleShape, grid, tube
from processing.laboratory.simulate.sites.bodies import (
    SiteBody,
    SiteKind,
    SitePart,
    beam,
    block,
    rotate_part,
    slab,
)

_PAINT, _GLASS, _STEEL = Material.CAR_PAINT, Material.GLASS, Material.STEEL


def excavator(random: Generator) -> SiteBody:
    """On crawlers, its cab turned anywhere, its arm anywhere between reach and rest."""
    size = random.uniform(0.55, 1.15)  # 1: a machine of 20 t
    long, wide, high = 4.2 * size, 2.8 * size, 1.0 * size
    parts = [*_crawlers(long, wide, high * 0.85, 0.55 * size)]
    parts.append(block((-0.8 * size, -0.8 * size, 0.4), (0.8 * size, 0.8 * size, high), _STEEL))
    upper = [
        block(
            (-2.2 * size, -1.3 * size, high), (1.3 * size, 1.3 * size, high + 0.95 * size), _PAINT
        ),
        block(
            (-2.7 * size, -1.3 * size, high), (-2.2 * size, 1.3 * size, high + 1.1 * size), _PAINT
        ),
        *_cab((0.0, 0.3 * size, high), (1.5 * size, 1.0 * size, 1.75 * size)),
        *_arm(random, size, high),
    ]
    turn = random.uniform(-np.pi, np.pi)
    parts += [rotate_part(part, 2, turn, (0.0, 0.0, 0.0)) for part in upper]
    return SiteBody(SiteKind.EXCAVATOR, tuple(parts), (long / 2, wide / 2))


def _arm(random: Generator, size: float, high: float) -> list[SitePart]:
    """Boom, stick and bucket in the plane of the machine's middle."""
    foot = np.array([0.9 * size, -0.15 * size, high + 0.6 * size])
    rise = random.uniform(0.25, 1.0)
    elbow = foot + 5.4 * size * np.array([np.cos(rise), 0.0, np.sin(rise)])
    knee = foot + 2.9 * size * np.array([np.cos(rise + 0.3), 0.0, np.sin(rise + 0.3)])
    drop = random.uniform(-1.9, -0.9)
    tip = elbow + 2.8 * size * np.array([np.cos(drop), 0.0, np.sin(drop)])
    tip[2] = max(tip[2], 0.75 * size)
    bucket = np.array([[0.0, 0.15], [0.5, 0.0], [0.75, -0.45], [0.35, -0.75], [-0.2, -0.55]])
    parts: list[SitePart] = [
        (beam(foot, knee, 0.42 * size, 0.55 * size), _PAINT),
        (beam(knee, elbow, 0.4 * size, 0.45 * size), _PAINT),
        (beam(elbow, tip, 0.32 * size, 0.36 * size), _PAINT),
        (
            tube(
                np.array([foot + np.array([0.5, 0.3, -0.3]), knee + np.array([0, 0.3, 0.1])]),
                np.full(2, 0.06),
                6,
            ),
            _STEEL,
        ),
        (
            tube(np.array([knee, elbow]) + np.array([0, 0, 0.35 * size]), np.full(2, 0.06), 6),
            _STEEL,
        ),
    ]
    vertices, triangles = slab(bucket * size, random.uniform(0.6, 1.2) * size)
    parts.append(((vertices + tip, triangles), _STEEL))
    return parts


def dump_truck(random: Generator) -> SiteBody:
    """Ten tonnes on the road, or smaller; its body tipped now and then, with or without a load."""
    size = random.uniform(0.62, 1.05)
    long, wide = 7.7 * size, 2.49 * min(size * 1.05, 1.0)
    half = wide / 2
    parts = [
        block((-long / 2, -half * 0.5, 0.6 * size), (long / 2, half * 0.5, 0.95 * size), _STEEL),
        *_cab((long / 2 - 1.9 * size, -half, 0.75 * size), (1.85 * size, wide, 2.0 * size)),
    ]
    for along in (long / 2 - 1.2, -long / 2 + 1.0, -long / 2 + 2.3 * size):
        parts += [_wheel(along, side * (half - 0.17), 0.5 * size, 0.32) for side in (-1, 1)]
    low, tall = 1.0 * size, random.uniform(0.5, 0.95) * size
    back, front = -long / 2, long / 2 - 2.1 * size
    body = [
        block((back, -half, low), (front, half, low + 0.12), _PAINT),
        block((back, -half, low), (front, -half + 0.08, low + tall), _PAINT),
        block((back, half - 0.08, low), (front, half, low + tall), _PAINT),
        block((front - 0.1, -half, low), (front, half, low + tall + 0.4 * size), _PAINT),
        block((back, -half, low), (back + 0.07, half, low + tall), _PAINT),
    ]
    if random.random() < 0.5:
        body.append((_load(random, back, front, (half - 0.09, low + 0.1, tall)), Material.SOIL))
    elif random.random() < 0.3:
        tip = random.uniform(0.3, 0.85)
        body = [rotate_part(part, 1, -tip, (back + 0.3, 0.0, low)) for part in body]
    return SiteBody(SiteKind.DUMP_TRUCK, (*parts, *body), (long / 2 * 0.8, half))


def _load(
    random: Generator, back: float, front: float, inside: tuple[float, float, float]
) -> TriangleShape:
    """A heap of soil between the sides."""
    half, low, tall = inside
    x, y = np.meshgrid(np.linspace(back + 0.1, front - 0.1, 12), np.linspace(-half, half, 7))
    crown = np.cos((x - x.mean()) / np.ptp(x) * 3) * np.cos(y / half * 1.4)
    z = low + tall * (0.7 + 0.7 * crown) + random.normal(0, 0.05, x.shape)
    return grid(np.stack([x, y, z], axis=-1))


def bulldozer(random: Generator) -> SiteBody:
    """Crawlers, cab, blade before it, a ripper behind it at times."""
    size = random.uniform(0.7, 1.2)
    long, wide = 3.2 * size, 2.6 * size
    blade = np.array([[0.0, 0.0], [0.35, 0.05], [0.12, 0.5], [0.3, 1.1], [0.1, 1.1], [-0.08, 0.5]])
    angle, lift = random.uniform(-0.35, 0.35), random.uniform(0.0, 0.5)
    vertices, triangles = slab(blade * size, 3.1 * size)
    front: SitePart = (vertices + np.array([long / 2 + 0.5 * size, 0, lift]), triangles), _PAINT
    parts = [
        *_crawlers(long, wide, 0.95 * size, 0.56 * size),
        block((-0.7 * size, -0.7 * size, 0.5), (1.6 * size, 0.7 * size, 1.75 * size), _PAINT),
        *_cab((-1.2 * size, -0.7 * size, 1.0 * size), (1.5 * size, 1.4 * size, 1.9 * size)),
        rotate_part(front, 2, angle, (long / 2 + 0.5 * size, 0, 0)),
    ]
    for side in (-1, 1):
        start, end = (
            (0.0, side * 1.35 * size, 0.5),
            (long / 2 + 0.5 * size, side * size, 0.4 + lift),
        )
        parts.append((beam(start, end, 0.2, 0.25), _PAINT))
    if random.random() < 0.4:
        parts.append(block((-long / 2 - 0.9, -0.6, 0.4), (-long / 2 - 0.3, 0.6, 1.0), _STEEL))
    return SiteBody(SiteKind.BULLDOZER, tuple(parts), (long / 2, wide / 2))


def roller(random: Generator) -> SiteBody:
    """A drum before, a drum or tyres behind, a canopy."""
    size = random.uniform(0.5, 1.1)
    long, wide, radius = 3.4 * size, 1.9 * size, 0.75 * size
    drum = np.array([[long / 2, -wide / 2, radius], [long / 2, wide / 2, radius]])
    parts: list[SitePart] = [(tube(drum, np.full(2, radius), 20), _STEEL)]
    for side in (-1, 1):
        parts.append(
            block(
                (0.2, side * wide / 2 - 0.06, radius - 0.15),
                (long / 2, side * wide / 2 + 0.06, radius + 0.15),
                _PAINT,
            )
        )
        parts.append(_wheel(-long / 2 + 0.3, side * wide * 0.36, radius, 0.45 * size))
        for along in (-0.9, 0.1):
            foot = (along * size, side * wide * 0.35, 1.5 * size)
            parts.append((beam(foot, (*foot[:2], 2.7 * size), 0.06, 0.06), _STEEL))
    parts.append(
        block((-long / 2, -wide * 0.4, 0.6 * size), (0.4, wide * 0.4, 1.55 * size), _PAINT)
    )
    roof = (-1.2 * size, -wide * 0.42, 2.7 * size), (0.5 * size, wide * 0.42, 2.78 * size)
    parts.append(block(*roof, _PAINT))
    return SiteBody(SiteKind.ROLLER, tuple(parts), (long / 2, wide / 2))


MACHINES = (excavator, dump_truck, bulldozer, roller)


def _crawlers(long: float, wide: float, high: float, shoe: float) -> list[SitePart]:
    """Two chains with rounded ends."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, 6)
    radius = high / 2
    ends = np.column_stack([np.cos(angles), np.sin(angles)]) * radius
    middle = np.array([long / 2 - radius, 0.0])
    outline = np.concatenate([ends + middle, -ends - middle]) + np.array([0.0, radius])
    chains: list[SitePart] = []
    for side in (-1, 1):
        vertices, triangles = slab(outline, shoe)
        chains.append(((vertices + np.array([0, side * (wide - shoe) / 2, 0]), triangles), _STEEL))
    return chains


def _cab(low: tuple[float, float, float], size: tuple[float, float, float]) -> list[SitePart]:
    """A cab: painted below and above, glass between."""
    x, y, z = low
    dx, dy, dz = size
    sill, head = z + 0.48 * dz, z + 0.9 * dz
    return [
        block((x, y, z), (x + dx, y + dy, sill), _PAINT),
        block((x + 0.04, y + 0.04, sill), (x + dx - 0.04, y + dy - 0.04, head), _GLASS),
        block((x, y, head), (x + dx, y + dy, z + dz), _PAINT),
    ]


def _wheel(along: float, aside: float, radius: float, wide: float) -> SitePart:
    path = np.array([[along, aside - wide / 2, radius], [along, aside + wide / 2, radius]])
    return tube(path, np.full(2, radius), 14), Material.RUBBER
