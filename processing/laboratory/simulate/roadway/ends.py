"""Faces that close the step where a section's sides differ from those of the next one."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder
from processing.laboratory.simulate.street.layout import Outline
from processing.laboratory.simulate.street.profile import CURB, GRASS, OTHER
from processing.laboratory.simulate.street.section import StreetSection

_LEAST_STEP_M = 1e-4
_SAME_POSITION_M = 1e-7


def add_ends(section: StreetSection, built: SectionBuilder) -> None:
    """Add the faces at the end of a section."""
    for side, part in section.layout.sides.items():
        if part.end is not None:
            _add_face(section, side, part.end, built)


def _add_face(
    section: StreetSection, side: int, pair: tuple[Outline, Outline], built: SectionBuilder
) -> None:
    own, other = (_risen(one) for one in pair)
    away = np.unique(np.concatenate([own, other]))
    levels = [
        np.interp(away, positions, one.above)
        for positions, one in zip((own, other), pair, strict=True)
    ]
    steps = np.abs(levels[0] - levels[1])
    open_at = np.flatnonzero(np.maximum(steps[1:], steps[:-1]) > _LEAST_STEP_M)
    if open_at.size == 0:
        return
    end = section.plan.end_m
    base = section.layout.terrain.height(end, side * away)
    lines = [section.alignment.at(end, side * away, base + one) for one in levels]
    count = away.size
    low, high = open_at, open_at + 1
    triangles = np.concatenate(
        [
            np.column_stack([low, high, count + low]),
            np.column_stack([high, count + high, count + low]),
        ]
    )
    materials, labels = _looks(pair, (own, other), (away[low] + away[high]) / 2, levels, low)
    vertices = np.concatenate(lines)
    for label in np.unique(labels):
        there = np.tile(labels == label, 2)
        material = np.tile(materials, 2)[there]
        built.mesh.add((vertices, triangles[there]), material, int(label), NO_THING)


def _risen(one: Outline) -> Floats:
    """Distances that rise strictly, so that a vertical face has two."""
    return one.away + _SAME_POSITION_M * np.arange(one.away.size)


def _looks(
    pair: tuple[Outline, Outline],
    positions: tuple[Floats, Floats],
    middles: Floats,
    levels: list[Floats],
    rows: np.ndarray[tuple[int], np.dtype[np.int64]],
) -> tuple[np.ndarray[tuple[int], np.dtype[np.uint8]], np.ndarray[tuple[int], np.dtype[np.uint8]]]:
    """Material and label of each piece: those of the surface that stands higher."""
    kinds, names = [], []
    for one, away in zip(pair, positions, strict=True):
        strip = np.clip(np.searchsorted(away, middles) - 1, 0, len(one.strips) - 1)
        kinds.append(np.array([int(each.material) for each in one.strips], np.uint8)[strip])
        names.append(np.array([each.label for each in one.strips], np.uint8)[strip])
    is_own = levels[0][rows] + levels[0][rows + 1] >= levels[1][rows] + levels[1][rows + 1]
    labels = np.where(is_own, names[0], names[1])
    materials = np.where(is_own, kinds[0], kinds[1])
    is_land = ~np.isin(labels, (CURB, GRASS))
    labels[is_land] = OTHER
    materials[is_land] = int(Material.OLD_CONCRETE)
    return materials.astype(np.uint8), labels.astype(np.uint8)
