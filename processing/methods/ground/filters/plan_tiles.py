"""Tiles of a plan: a search for ground that memory can hold, however wide the recording is.

Each tile owns its cells and looks at a margin around them, as wide as the largest thing that may
stand on the ground and its surroundings, so that neighbours see the same things alike. The tiles
follow from the recording alone: no computer's memory and no reading order changes them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cell_positions import Blocks
from processing.methods.ground.filters.cells import CellGrid

MOST_CELLS = 2_000_000
"""In a tile with its margin: some 0.4 GiB while its ground is looked for."""

_MOST_PARTS = 4096
"""Parts along one side, marked where they hold points: 16 MiB of marks."""

_PART_M = 4.0
"""Width of a part where they need not be wider, by trial: narrower than a road, so that tiles
follow it, and many of the finest cells."""

_SMALLEST_M = 60.0
"""Side from which a tile is halved no more, by trial: its margin, as wide as a hall on every side,
is then most of what it looks at."""

_LINED_UP_CELLS = 32
"""Tiles begin at a multiple of this, so that five halvings of neighbours' cells fall together."""


@dataclass(frozen=True)
class PlanTile:
    """A rectangle of cells of the whole grid.

    Attributes
    ----------
    rows, columns : range
        Its own cells.
    grid : CellGrid
        The cells that it looks at, lined up with those of the whole grid.
    first_row, first_column : int
        Of ``grid`` in the whole grid.
    """

    rows: range
    columns: range
    grid: CellGrid
    first_row: int
    first_column: int


def plan_tiles(blocks: Blocks, grid: CellGrid, margin_m: float) -> tuple[PlanTile, ...]:
    """Tiles that own every cell that holds a point, each once.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m.
    grid : CellGrid
        Of the whole cloud. Where it is small enough it is the only tile.
    margin_m : float
        How far a tile looks beyond its own cells.
    """
    if grid.rows * grid.columns <= MOST_CELLS:
        return (PlanTile(range(grid.rows), range(grid.columns), grid, 0, 0),)
    margin = int(np.ceil(margin_m / grid.size_m))
    part = max(1, -(-max(grid.rows, grid.columns) // _MOST_PARTS), int(_PART_M / grid.size_m))
    occupied = np.zeros((-(-grid.rows // part), -(-grid.columns // part)), np.uint8)
    for xyz in blocks():
        _occupied_kernel(xyz, grid.origin, grid.size_m, part, occupied)
    most = max(int(np.sqrt(MOST_CELLS)) - 2 * margin - _LINED_UP_CELLS, margin)
    smallest = max(part, int(_SMALLEST_M / grid.size_m))
    sides = [max(part, most // part * part)]
    while sides[-1] // 2 >= smallest:
        sides.append(max(part, sides[-1] // 2 // part * part))
    plans = [_cut(grid, occupied, part, side, margin) for side in sides]
    return min(plans, key=_cells_of)


def _cells_of(tiles: Iterable[PlanTile]) -> int:
    return sum(tile.grid.rows * tile.grid.columns for tile in tiles)


def _cut(
    grid: CellGrid, occupied: NDArray[np.uint8], part: int, side: int, margin: int
) -> tuple[PlanTile, ...]:
    tiles = []
    for row in range(0, grid.rows, side):
        for column in range(0, grid.columns, side):
            rows = range(row, min(row + side, grid.rows))
            columns = range(column, min(column + side, grid.columns))
            held = _held(occupied, part, rows, columns)
            if held is None:
                continue
            rows, columns = held
            seen = _held(occupied, part, _wider(rows, margin), _wider(columns, margin))
            if seen is not None:
                tiles.append(_tile(grid, rows, columns, seen))
    return tuple(tiles)


def _wider(cells: range, margin: int) -> range:
    return range(max(0, cells.start - margin), cells.stop + margin)


def _held(
    occupied: NDArray[np.uint8], part: int, rows: range, columns: range
) -> tuple[range, range] | None:
    """The part of a rectangle that holds points, and a little more; None without any."""
    first_row, first_column = rows.start // part, columns.start // part
    inside = occupied[first_row : -(-rows.stop // part), first_column : -(-columns.stop // part)]
    held_rows = np.flatnonzero(inside.any(axis=1))
    held_columns = np.flatnonzero(inside.any(axis=0))
    if not held_rows.size:
        return None
    return (
        _inside(rows, first_row + held_rows, part),
        _inside(columns, first_column + held_columns, part),
    )


def _inside(cells: range, held: NDArray[np.int64], part: int) -> range:
    first, end = int(held[0]) * part, (int(held[-1]) + 1) * part
    return range(max(cells.start, first), min(cells.stop, end))


def _tile(grid: CellGrid, rows: range, columns: range, seen: tuple[range, range]) -> PlanTile:
    # Lined up, so that coarser grids of neighbours halve the same cells.
    first_row, first_column = (cells.start // _LINED_UP_CELLS * _LINED_UP_CELLS for cells in seen)
    end_row, end_column = min(seen[0].stop, grid.rows), min(seen[1].stop, grid.columns)
    origin = grid.origin + grid.size_m * np.array([first_column, first_row, 0.0])
    looked_at = CellGrid(origin, grid.size_m, end_row - first_row, end_column - first_column)
    return PlanTile(rows, columns, looked_at, first_row, first_column)


@kernel
def _occupied_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    part: int,
    occupied: NDArray[np.uint8],
) -> None:
    columns, rows = part * occupied.shape[1], part * occupied.shape[0]
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        if np.isfinite(xyz[point, 2]) and 0.0 <= x < columns and 0.0 <= y < rows:
            occupied[int(y) // part, int(x) // part] = 1


def warm_up() -> None:
    """Compile the kernels of this file."""
    _occupied_kernel(np.zeros((1, 3)), np.zeros(3), 1.0, 1, np.zeros((1, 1), np.uint8))
