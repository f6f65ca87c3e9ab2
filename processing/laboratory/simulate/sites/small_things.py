"""People, batter boards, survey poles and bushes: small, many, and close to the ground."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import tube
from processing.laboratory.simulate.sites.bodies import (
    SiteBody,
    SiteKind,
    SitePart,
    beam,
    block,
    rotate_part,
)


def worker(random: Generator) -> SiteBody:
    """A person with helmet and vest: standing, stooping or stretching out an arm."""
    tall = random.normal(1.69, 0.08)
    hip, shoulder = 0.5 * tall, 0.82 * tall
    stride = random.uniform(0.0, 0.3)
    parts: list[SitePart] = []
    for side in (-1, 1):
        leg = np.array([[side * stride, side * 0.11, 0.0], [0.0, side * 0.1, hip]])
        parts.append((tube(leg, np.array([0.07, 0.09]), 8), Material.CLOTH))
    upper: list[SitePart] = [
        (
            tube(
                np.array([[0, 0, hip - 0.05], [0, 0, 0.68 * tall], [0.0, 0, shoulder]]),
                np.array([0.17, 0.18, 0.13]),
                10,
            ),
            Material.CLOTH,
        ),
        (
            tube(np.array([[0, 0, shoulder], [0, 0, tall - 0.02]]), np.array([0.08, 0.09]), 8),
            Material.CLOTH,
        ),
        (
            tube(
                np.array([[0, 0, tall - 0.12], [0, 0, tall - 0.03], [0, 0, tall + 0.03]]),
                np.array([0.135, 0.13, 0.05]),
                10,
            ),
            Material.PLASTIC,
        ),
    ]
    for side in (-1, 1):
        reach = random.uniform(-0.3, 1.7)
        start = np.array([0.0, side * 0.2, shoulder - 0.05])
        end = start + 0.58 * np.array([np.sin(reach), side * 0.1, -np.cos(reach)])
        upper.append((tube(np.array([start, end]), np.array([0.06, 0.045]), 6), Material.CLOTH))
    stoop = random.uniform(0.6, 1.3) if random.random() < 0.25 else random.uniform(0, 0.12)
    parts += [rotate_part(one, 1, stoop, (0.0, 0.0, hip)) for one in upper]
    return SiteBody(SiteKind.WORKER, tuple(parts))


def batter_board(random: Generator) -> SiteBody:
    """A slope's gauge (丁張): two or three stakes, a level board and one at the slope's grade."""
    long, high = random.uniform(0.8, 2.6), random.uniform(0.6, 1.3)
    grade = 1 / random.choice([0.5, 1.0, 1.2, 1.5, 1.8, 2.0])
    parts: list[SitePart] = []
    for along in (0.0, long):
        lean = random.normal(0, 0.03, 2)
        top = (along + lean[0], lean[1], high + random.uniform(0, 0.15))
        parts.append((beam((along, 0.0, -0.3), top, 0.045, 0.045), Material.WOOD))
    level = (0.0, 0.03, high - 0.1), (long, 0.03, high - 0.1)
    parts.append((beam(*level, 0.012, 0.09), Material.WOOD))
    run = min(long, (high - 0.15) / grade)
    slant = (-0.15, -0.03, high + 0.15 * grade), (run, -0.03, high - run * grade)
    parts.append((beam(*slant, 0.012, 0.09), Material.WOOD))
    return SiteBody(SiteKind.BATTER_BOARD, tuple(parts))


def survey_pole(random: Generator) -> SiteBody:
    """A pole with a prism, a staff, or a stake with a ribbon that marks a point."""
    which = random.integers(0, 3)
    if which == 0:
        high, lean = random.uniform(1.3, 2.2), random.normal(0, 0.02)
        legs: list[SitePart] = [
            (tube(np.array([[0, 0, 0], [lean, 0, high]]), np.full(2, 0.016), 6), Material.STEEL)
        ]
        legs.append(
            block((lean - 0.05, -0.05, high), (lean + 0.05, 0.05, high + 0.1), Material.GLASS)
        )
        for turn in (0.3, 2.4, 4.5):
            foot = (0.55 * np.cos(turn), 0.55 * np.sin(turn), -0.02)
            legs.append(
                (
                    tube(np.array([foot, (lean * 0.6, 0, 0.62 * high)]), np.full(2, 0.01), 5),
                    Material.STEEL,
                )
            )
        return SiteBody(SiteKind.SURVEY_POLE, tuple(legs))
    if which == 1:
        staff = block(
            (-0.01, -0.04, 0.0), (0.02, 0.04, random.uniform(3, 5)), Material.PAINTED_METAL
        )
        return SiteBody(
            SiteKind.SURVEY_POLE, (rotate_part(staff, 1, random.normal(0, 0.03), (0, 0, 0)),)
        )
    high = random.uniform(0.15, 1.0)
    stake = beam((0, 0, -0.2), (random.normal(0, 0.03), random.normal(0, 0.03), high), 0.05, 0.05)
    return SiteBody(SiteKind.SURVEY_POLE, ((stake, Material.WOOD),))


def bush(random: Generator) -> SiteBody:
    """A shrub or a tuft of reeds: leaves that beams pass between, and a few stems."""
    high, wide = random.uniform(0.3, 2.2), random.uniform(0.3, 1.4)
    count = int(np.clip(420 * wide * wide * high, 60, 1500))
    around = random.uniform(0, 2 * np.pi, count)
    out = wide * np.sqrt(random.uniform(0, 1, count)) * (1 + 0.25 * np.sin(3 * around + high))
    level = random.beta(1.6, 1.3, count) * high * np.sqrt(np.clip(1.15 - out / wide / 1.3, 0.05, 1))
    centre = np.column_stack([out * np.cos(around), out * np.sin(around), level + 0.03])
    is_reed = random.random() < 0.35
    long = random.uniform(0.25, 0.7) if is_reed else random.uniform(0.06, 0.14)
    direction = random.normal(size=(count, 3))
    if is_reed:
        direction = direction * 0.25 + [0, 0, 1]
    direction *= (long * random.uniform(0.5, 1.2, count) / np.linalg.norm(direction, axis=1))[
        :, None
    ]
    side = np.cross(direction, random.normal(size=(count, 3)))
    broad = (0.012 if is_reed else 0.45 * long) / np.linalg.norm(side, axis=1)
    side *= broad[:, None]
    corners = np.stack([centre - side, centre + side, centre + direction], axis=1)
    leaves = corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)
    parts: list[SitePart] = [(leaves, Material.LEAVES)]
    if not is_reed:
        for _ in range(int(random.integers(2, 6))):
            turn, lean = random.uniform(0, 6.3), random.uniform(0, 0.5) * wide
            top = (lean * np.cos(turn), lean * np.sin(turn), 0.7 * high)
            stem = tube(np.array([(0.0, 0.0, -0.05), top]), np.array([0.02, 0.008]), 5)
            parts.append((stem, Material.BARK))
    return SiteBody(SiteKind.BRUSH, tuple(parts))
