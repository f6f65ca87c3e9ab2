"""What a map of change says at a position, and along a cut through it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.maps.change_grid import ChangeGrid

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ChangeReading:
    """Both grounds at a position.

    Attributes
    ----------
    before_m, after_m : float
        Heights, m, as in the project.
    is_measured : bool
        Both were measured there.
    """

    before_m: float
    after_m: float
    is_measured: bool

    @property
    def change_m(self) -> float:
        """By how much the later ground is higher."""
        return self.after_m - self.before_m


def reading_at(change: ChangeGrid, easting: float, northing: float) -> ChangeReading | None:
    """What the cell that holds a position says; None outside the boundary and without both grounds.

    Parameters
    ----------
    easting, northing : float
        m, project CRS.
    """
    grid = change.grid
    column = math.floor((easting - grid.origin[0]) / grid.size_m)
    row = math.floor((northing - grid.origin[1]) / grid.size_m)
    if not (0 <= row < grid.rows and 0 <= column < grid.columns):
        return None
    if not change.inside[row, column] > 0:
        return None
    base = float(grid.origin[2])
    before, after = float(change.before[row, column]), float(change.after[row, column])
    if math.isnan(before) or math.isnan(after):
        return None
    return ChangeReading(before + base, after + base, bool(change.is_measured[row, column]))


@dataclass(frozen=True, eq=False)
class ChangeLine:
    """Both grounds along a line, cell by cell.

    Attributes
    ----------
    offsets : (n,) float64
        Along the line, m, rising.
    before, after : (n,) float64
        Heights, m, as in the project; NaN where there is none, and outside the boundary.
    is_measured : (n,) bool
    """

    offsets: Floats
    before: Floats
    after: Floats
    is_measured: NDArray[np.bool_]


def change_along(change: ChangeGrid, offsets: Floats, xy: Floats) -> ChangeLine:
    """Both grounds at positions along a line, between the middles of cells on a straight slope.

    Parameters
    ----------
    offsets : (n,) float64
        What each position is called, rising.
    xy : (n, 2) float64
        The positions, m, project CRS.
    """
    grid = change.grid
    at = (xy - grid.origin[:2]) / grid.size_m
    cells = np.floor(at).astype(np.int64)
    is_in = np.all((cells >= 0) & (cells < [grid.columns, grid.rows]), axis=1)
    columns, rows = cells[is_in].T
    is_there = is_in.copy()
    is_there[is_in] = change.inside[rows, columns] > 0
    is_measured = np.zeros(len(xy), np.bool_)
    is_measured[is_in] = change.is_measured[rows, columns]

    def heights(ground: NDArray[np.float32]) -> Floats:
        found = np.full(len(xy), np.nan)
        found[is_there] = _sloped(ground, at[is_there] - 0.5) + float(grid.origin[2])
        return found

    return ChangeLine(
        offsets, heights(change.before), heights(change.after), is_measured & is_there
    )


def _sloped(ground: NDArray[np.float32], at: Floats) -> Floats:
    """Heights between the middles of four cells; the own cell's where one of them has none."""
    rows, columns = ground.shape
    own_column, own_row = np.floor(at + 0.5).astype(np.int64).T
    low = np.floor(at).astype(np.int64)
    share = at - low
    total = np.zeros(len(at))
    for up in (0, 1):
        for right in (0, 1):
            row = np.clip(low[:, 1] + up, 0, rows - 1)
            column = np.clip(low[:, 0] + right, 0, columns - 1)
            weight = np.abs(1 - right - share[:, 0]) * np.abs(1 - up - share[:, 1])
            total += weight * ground[row, column]
    own = ground[own_row, own_column].astype(np.float64)
    sloped: Floats = np.where(np.isnan(total), own, total)
    return sloped
