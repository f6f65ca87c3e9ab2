"""The ground that the tool “ground” found, where a section cuts it: measured or filled in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.stored_surface import StoredSurface
from processing.section.cut import Cut

if TYPE_CHECKING:  # named in annotations only
    from collections.abc import Iterable

Floats = NDArray[np.float64]

_STEPS_PER_CELL = 2
"""Heights asked along a cell's side: a line through them follows heights between the centres of
cells to a few per cent of a cell's rise."""

_MOST_POSITIONS = 4000
"""Heights asked in a section: more than a screen has pixels across."""


@dataclass(frozen=True, eq=False)
class SurfaceLine:
    """A stretch of the ground in the plane of a section.

    Attributes
    ----------
    positions : (n, 2) float64
        Offset and height, m, by rising offset; two at least.
    is_filled : bool
        Whether nothing was measured there: the height follows from what lies around.
    epoch : int
        Number of the survey whose ground it is, among those that are shown.
    """

    positions: Floats
    is_filled: bool
    epoch: int = 0


def surface_lines(surface: StoredSurface, cut: Cut) -> tuple[SurfaceLine, ...]:
    """Where a surface lies in a section, from left to right.

    Parameters
    ----------
    surface : StoredSurface
    cut : Cut
        Its plane counts, not its thickness.

    Returns
    -------
    tuple of SurfaceLine
        Neighbours of which one is measured and one filled share their end.

    Raises
    ------
    BadFile
        The stored surface is damaged.
    """
    half_m = cut.half_length_m
    count = int(np.ceil(2 * half_m / surface.grid.size_m)) * _STEPS_PER_CELL
    offsets = np.linspace(-half_m, half_m, min(max(count, 2), _MOST_POSITIONS))
    nothing = np.zeros_like(offsets)
    xy = cut.to_space(np.column_stack([offsets, nothing, nothing]))[:, :2]
    heights, is_filled = surface.heights_at(xy), surface.is_filled_at(xy)
    positions = np.column_stack([offsets, heights])
    is_there = np.isfinite(heights)
    # A piece lies between two positions; it is measured where both are.
    between = is_there[1:] & is_there[:-1]
    state = np.where(between, np.where(is_filled[1:] | is_filled[:-1], 2, 1), 0)
    ends = np.flatnonzero(np.diff(state)) + 1
    starts = np.concatenate([[0], ends])
    stops = np.concatenate([ends, [state.size]])
    return tuple(
        SurfaceLine(positions[start : stop + 1], bool(state[start] == 2))
        for start, stop in zip(starts.tolist(), stops.tolist(), strict=True)
        if state[start]
    )


def remove_doubles(lines: Iterable[tuple[SurfaceLine, ...]]) -> tuple[SurfaceLine, ...]:
    """The lines of several drives, once where drives keep the same surface."""
    kept: list[tuple[SurfaceLine, ...]] = []
    for one in lines:
        if not any(_are_same(one, other) for other in kept):
            kept.append(one)
    return tuple(line for one in kept for line in one)


def _are_same(one: tuple[SurfaceLine, ...], other: tuple[SurfaceLine, ...]) -> bool:
    return len(one) == len(other) and all(
        mine.is_filled == theirs.is_filled and np.array_equal(mine.positions, theirs.positions)
        for mine, theirs in zip(one, other, strict=True)
    )
