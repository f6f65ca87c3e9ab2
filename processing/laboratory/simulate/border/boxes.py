"""Boxes and shelters on walks: switch boxes, letter boxes, planters, benches, bus stops.

Things (label 1): ``switch_box``, ``letter_box``, ``planter``, ``bench``, ``shelter``. They stand at
a walk's edge, so that people pass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.parts import BorderPart, block, merge_parts
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    FreePositions,
    free_from_m,
)
from processing.laboratory.simulate.street.plan import LEFT, SIDES
from processing.laboratory.simulate.street.styles import URBAN

OTHER = 1

_BELOW_M = 0.15
_LEFT_FREE_M = 1.0  # of a walk, for people to pass
_EDGE_GAP_M = 0.16


@dataclass(frozen=True)
class StreetBox:
    """A body about the middle of its foot: its kind, length along the walk, depth, parts."""

    kind: str
    long_m: float
    deep_m: float
    parts: tuple[BorderPart, ...]


def switch_box(random: Generator) -> StreetBox:
    """A transformer's or switch's box of buried lines: about 1.1 × 0.45 × 1.45 m."""
    long, deep = float(random.uniform(0.7, 1.3)), float(random.uniform(0.4, 0.5))
    high = float(random.uniform(1.0, 1.5))
    base = block((-long / 2, long / 2), (-deep / 2, deep / 2), (-_BELOW_M, 0.08))
    body = block(
        (-long / 2 + 0.02, long / 2 - 0.02), (-deep / 2 + 0.02, deep / 2 - 0.02), (0, high)
    )
    parts = ((base, Material.CONCRETE), (body, Material.PAINTED_METAL))
    return StreetBox("switch_box", long, deep, parts)


def letter_box(random: Generator) -> StreetBox:
    """A letter box of the post: about 0.5 × 0.45 × 1.3 m on a foot."""
    long, deep = float(random.uniform(0.4, 0.6)), float(random.uniform(0.38, 0.48))
    foot = block((-0.12, 0.12), (-0.12, 0.12), (-_BELOW_M, 0.5))
    body = block(
        (-long / 2, long / 2), (-deep / 2, deep / 2), (0.45, float(random.uniform(1.2, 1.4)))
    )
    parts = ((foot, Material.PAINTED_METAL), (body, Material.PAINTED_METAL))
    return StreetBox("letter_box", long, deep, parts)


def planter(random: Generator) -> StreetBox:
    """A tub of concrete with earth in it."""
    long, deep = float(random.uniform(0.5, 1.4)), float(random.uniform(0.35, 0.5))
    high = float(random.uniform(0.3, 0.6))
    body = block((-long / 2, long / 2), (-deep / 2, deep / 2), (-_BELOW_M, high))
    earth = block(
        (-long / 2 + 0.05, long / 2 - 0.05),
        (-deep / 2 + 0.05, deep / 2 - 0.05),
        (high, high + 0.04),
    )
    return StreetBox("planter", long, deep, ((body, Material.CONCRETE), (earth, Material.GRASS)))


def bench(random: Generator) -> StreetBox:
    """A bench with or without a back."""
    long = float(random.uniform(1.2, 1.9))
    seat = block((-long / 2, long / 2), (-0.2, 0.2), (0.38, 0.44))
    legs = [
        block((x - 0.04, x + 0.04), (-0.18, 0.18), (-_BELOW_M, 0.38)) for x in (-long / 3, long / 3)
    ]
    parts: list[BorderPart] = [(seat, Material.WOOD), (merge_parts(legs), Material.STEEL)]
    if random.random() < 0.5:
        parts.append((block((-long / 2, long / 2), (0.17, 0.2), (0.55, 0.85)), Material.WOOD))
    return StreetBox("bench", long, 0.4, tuple(parts))


def shelter(random: Generator) -> StreetBox:
    """A roof over a bus stop on two to four posts, with a clear back and a bench."""
    long, deep = float(random.uniform(3.0, 7.0)), float(random.uniform(1.1, 1.6))
    high = float(random.uniform(2.4, 2.8))
    count = int(random.integers(2, 5))
    legs = [
        block((x - 0.05, x + 0.05), (deep / 2 - 0.15, deep / 2 - 0.05), (-_BELOW_M, high))
        for x in np.linspace(-long / 2 + 0.3, long / 2 - 0.3, count)
    ]
    roof = block((-long / 2, long / 2), (-deep / 2, deep / 2), (high, high + 0.12))
    back = block((-long / 2 + 0.3, long / 2 - 0.3), (deep / 2 - 0.11, deep / 2 - 0.09), (0.4, 2.0))
    seat = block((-long / 4, long / 4), (deep / 2 - 0.55, deep / 2 - 0.2), (0.4, 0.45))
    parts: list[BorderPart] = [
        (merge_parts([*legs, roof]), Material.PAINTED_METAL),
        (seat, Material.WOOD),
    ]
    if random.random() < 0.7:
        parts.append((back, Material.GLASS))
    return StreetBox("shelter", long, deep, tuple(parts))


_PIECES = ((switch_box, 0.35), (letter_box, 0.1), (planter, 0.3), (bench, 0.15), (shelter, 0.1))


def add_boxes(positions: FreePositions, built: SectionBuilder) -> None:
    """Add boxes and shelters on the walks of towns."""
    section = positions.section
    for side in SIDES:
        walk = section.plan.side(side).band("walk")
        random = section.chance("boxes", side)
        if section.plan.style is not URBAN or side in section.plan.junctions or walk is None:
            continue
        wide = walk.outer_m - walk.inner_m
        for _ in range(int(random.poisson(section.plan.length_m / 22.0))):
            make = _PIECES[int(random.choice(len(_PIECES), p=[one[1] for one in _PIECES]))][0]
            piece = make(random)
            at = float(random.uniform(section.plan.start_m, section.plan.end_m))
            if wide - piece.deep_m - _EDGE_GAP_M < _LEFT_FREE_M:
                continue
            near = max(free_from_m(section.plan.side(side)), walk.inner_m)
            away = near + _EDGE_GAP_M + piece.deep_m / 2
            if piece.kind == "shelter" or random.random() < 0.25:
                away = walk.outer_m - piece.deep_m / 2 - 0.05
            _add_piece(positions, built, piece, FreePosition(at, side * away))


def _add_piece(
    positions: FreePositions, built: SectionBuilder, piece: StreetBox, spot: FreePosition
) -> None:
    half = piece.long_m / 2
    ends = np.linspace(spot.chainage_m - half, spot.chainage_m + half, max(3, int(half * 4)))
    if not all(
        positions.is_free(FreePosition(float(at), spot.offset_m), piece.deep_m / 2) for at in ends
    ):
        return
    positions.block(
        (spot.chainage_m - half, spot.chainage_m + half),
        (spot.offset_m - piece.deep_m / 2, spot.offset_m + piece.deep_m / 2),
    )
    heading = positions.section.heading(spot.chainage_m) + (0.0 if spot.side == LEFT else np.pi)
    instance = built.thing(piece.kind)
    for shape, material in piece.parts:
        built.mesh.add(
            place_shape(shape, positions.where(spot).tolist(), heading), material, OTHER, instance
        )
