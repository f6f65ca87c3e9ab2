"""Thin layers on the road: rectangles of paint that follow its surface, worn here and there."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder
from processing.laboratory.simulate.street.profile import ROAD
from processing.laboratory.simulate.street.section import StreetSection

PAINT_M = 0.002
"""Thickness of hot paint (熔融式, 1.5 to 2 mm, JIS K 5665 class 3)."""

_PIECE_M = 0.4

Rectangle = tuple[float, float, float, float]
"""From and to which chainage, from and to which offset."""


def add_paint(
    section: StreetSection,
    built: SectionBuilder,
    rectangles: Sequence[Rectangle],
    random: Generator,
    wear: float,
) -> None:
    """Add painted rectangles on the carriageway.

    Parameters
    ----------
    wear : float
        The share of small pieces that have come off.
    """
    start, end = section.plan.start_m, section.plan.end_m
    for low, high, right, left in rectangles:
        first, last = max(low, start), min(high, end)
        if last - first < 0.02 or left - right < 0.02:
            continue
        add_sheet(
            section,
            built,
            (first, last, right, left),
            is_kept=lambda count: random.random(count) >= wear,
        )


def add_sheet(
    section: StreetSection,
    built: SectionBuilder,
    where: Rectangle,
    *,
    material: Material = Material.PAINT,
    label: int = ROAD,
    above_m: float = PAINT_M,
    is_kept: Callable[[int], NDArray[np.bool_]] | None = None,
) -> None:
    """Add one rectangle that lies on the ground's lines.

    Parameters
    ----------
    is_kept : callable or None
        Tells which of a number of pieces are there: (n,) bool.
    """
    first, last, right, left = where
    ground = section.ground
    nodes = ground.nodes[(ground.nodes > first) & (ground.nodes < last)]
    count = int(np.ceil((last - first) / _PIECE_M)) + 1
    along = np.unique(np.concatenate([np.linspace(first, last, count), nodes]))
    row = int(np.clip(np.searchsorted(ground.nodes, first), 0, ground.nodes.size - 1))
    lines = ground.offsets[row]
    inner = lines[(lines > right) & (lines < left)]
    across = np.unique(np.concatenate([[right, left], inner]))
    rows = section.position(along[:, None], across[None, :], above_m)
    vertices, triangles = grid(rows)
    if is_kept is not None:
        kept = np.repeat(is_kept(along.size - 1), 2 * (across.size - 1))
        triangles = triangles[kept]
    built.mesh.add((vertices, triangles), material, label, NO_THING)


def dashes(start: float, end: float, long_m: float, gap_m: float) -> Floats:
    """Beginnings of the dashes that touch a stretch; their row is one for the whole street."""
    cycle = long_m + gap_m
    first = int(np.floor((start - long_m) / cycle))
    last = int(np.ceil(end / cycle))
    return np.arange(first, last + 1).astype(np.float64) * cycle
