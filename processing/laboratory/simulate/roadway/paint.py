"""Thin layers on the road: rectangles of paint that follow its surface, worn here and there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

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


class SheetPieces(NamedTuple):
    """What a sheet's triangles belong to.

    Attributes
    ----------
    instance : int
    ends_m : (n + 1,) float64
        Ends of its pieces, rising.
    is_across : bool
        Whether they are offsets, not chainages.
    """

    instance: int
    ends_m: Floats
    is_across: bool

    def piece_at(self, at: Floats) -> NDArray[np.int64]:
        """Numbers of the pieces at chainages or offsets."""
        found = np.searchsorted(self.ends_m, at, "right") - 1
        return np.clip(found, 0, len(self.ends_m) - 2).astype(np.int64)


def add_paint(
    section: StreetSection,
    built: SectionBuilder,
    rectangles: Sequence[Rectangle],
    worn: tuple[Generator, float],
    pieces: SheetPieces,
) -> None:
    """Add painted rectangles of one marking on the carriageway.

    Parameters
    ----------
    worn : (Generator, float)
        The share of small pieces that have come off, and what draws them.
    pieces : SheetPieces
        What their points are counted by.
    """
    random, wear = worn
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
            pieces=pieces,
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
    pieces: SheetPieces | None = None,
) -> None:
    """Add one rectangle that lies on the ground's lines.

    Parameters
    ----------
    is_kept : callable or None
        Tells which of a number of pieces are there: (n,) bool.
    pieces : SheetPieces or None
        What its points are counted by; of no single thing without.
    """
    first, last, right, left = where
    ground = section.ground
    nodes = ground.nodes[(ground.nodes > first) & (ground.nodes < last)]
    count = int(np.ceil((last - first) / _PIECE_M)) + 1
    along = np.unique(np.concatenate([np.linspace(first, last, count), nodes]))
    row = int(np.clip(np.searchsorted(ground.nodes, first), 0, ground.nodes.size - 1))
    lines = ground.offsets[row]
    inner = lines[(lines > right) & (lines < left)]
    if pieces is not None and pieces.is_across:
        cuts = pieces.ends_m
        inner = np.concatenate([inner, cuts[(cuts > right) & (cuts < left)]])
    across = np.unique(np.concatenate([[right, left], inner]))
    rows = section.position(along[:, None], across[None, :], above_m)
    vertices, triangles = grid(rows)
    piece = np.zeros(len(triangles), np.int64)
    if pieces is not None:
        grid_of = np.meshgrid(_middles(along), _middles(across), indexing="ij")
        piece = np.repeat(pieces.piece_at(grid_of[int(pieces.is_across)].ravel()), 2)
    if is_kept is not None:
        kept = np.repeat(is_kept(along.size - 1), 2 * (across.size - 1))
        triangles, piece = triangles[kept], piece[kept]
    instance = NO_THING if pieces is None else pieces.instance
    built.mesh.add((vertices, triangles), material, label, instance, piece=piece)


def _middles(ends: Floats) -> Floats:
    return np.asarray((ends[1:] + ends[:-1]) / 2)


def dashes(start: float, end: float, long_m: float, gap_m: float) -> Floats:
    """Beginnings of the dashes that touch a stretch; their row is one for the whole street."""
    cycle = long_m + gap_m
    first = int(np.floor((start - long_m) / cycle))
    last = int(np.ceil(end / cycle))
    return np.arange(first, last + 1).astype(np.float64) * cycle
