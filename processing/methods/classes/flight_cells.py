"""Cells of full-waveform flights: shapes, brightness, numbers of returns and waveforms around."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.classes.aerial_cells import AerialPoints, aerial_cells
from processing.methods.classes.features import ClassCells
from processing.methods.classes.ground_strips import strip_columns
from processing.methods.classes.shape_kernels import add_rows_kernel

RETURN_COLUMNS = 3
"""Of each point: log2 of its intensity over the ground's, which return it is, and of how many."""

AROUND = (1, 2, 3, 4)
"""Sizes of cells whose 27 are averaged: 6, 12 and 24 points wide, across a wire, a tower or a lane,
a road with its shoulders. Brightness of the ground is told against the last, 48 points wide: a road
and what is beside."""


def flight_cells(
    points: AerialPoints,
    returns: NDArray[np.float32],
    measures: NDArray[np.float32] | None,
    ranks: Floats,
    *,
    cell_m: float,
    monitor: Monitor,
) -> ClassCells:
    """Cells of a cloud from the air with what its returns say.

    Parameters
    ----------
    returns : (n, RETURN_COLUMNS) float32
    measures : (n, RETURN_MEASURES) float32 or None
        As :mod:`processing.methods.waveforms.return_measures` has them; None without waveforms.
    ranks : (RANKS,) float64
        Brightness of the flight's ground, rising, in even steps of its order.
    cell_m : float
        How far apart points lie.
    """
    cells = aerial_cells(points, cell_m, monitor)
    own = means_in_cells(cells, points.is_ground, returns, measures)
    around = [own, *(cells.means_around(own, size, monitor) for size in AROUND)]
    bright = returns[:, 0]
    tones = bright if measures is None else np.ascontiguousarray(measures[:, 0])
    is_told = points.is_ground & points.is_only
    strips = strip_columns(
        points.local[:, :2], tones, is_told, ranks, cell_m=cell_m, monitor=monitor
    )
    told = columns_of_means(around, with_waveforms=measures is not None)
    return replace(cells, rows=np.hstack([cells.rows, told, _means(cells.cell_of, strips)]))


def means_in_cells(
    cells: ClassCells,
    is_ground: NDArray[np.bool_],
    returns: NDArray[np.float32],
    measures: NDArray[np.float32] | None,
) -> NDArray[np.float32]:
    """(c, m) means of what the points of each of the finest cells say, as `flight_cells` has them.

    The last columns are the measures of waveforms, where there are any, and the brightness that
    they tell of the ground.
    """
    bright, ground = returns[:, 0], is_ground.astype(np.float32)
    columns = [returns, np.column_stack([bright * bright, ground, bright * ground])]
    if measures is not None:
        columns += [measures, (measures[:, 0] * ground)[:, None]]
    return _means(cells.cell_of, np.hstack(columns))


def columns_of_means(
    around: Sequence[NDArray[np.float32]], *, with_waveforms: bool
) -> NDArray[np.float32]:
    """(c, 4 m + 4 or 8) what cells are told by their own returns and by those around.

    Parameters
    ----------
    around : sequence of (c, m) float32
        Means in the cells, then around them in each size of :data:`AROUND`.
    """
    *parts, wide = around
    lit = [(4, 5), (4, wide.shape[1] - 1)] if with_waveforms else [(4, 5)]
    contrast = [
        _of_ground(part, ground, light) - _of_ground(wide, ground, light)
        for ground, light in lit
        for part in parts
    ]
    return np.hstack([*parts, np.column_stack(contrast)])


def _means(cell_of: NDArray[np.int32], values: NDArray[np.float32]) -> NDArray[np.float32]:
    """(c, k) means of points' values in each of the finest cells."""
    sums = np.zeros((int(cell_of.max()) + 1, values.shape[1] + 1))
    add_rows_kernel(cell_of, np.ascontiguousarray(values), sums)
    return (sums[:, :-1] / np.maximum(sums[:, -1:], 1)).astype(np.float32)


def _of_ground(part: NDArray[np.float32], ground: int, light: int) -> NDArray[np.float32]:
    """Mean brightness of the ground's share of cells; 0 where there is none."""
    share = part[:, ground]
    bright = np.where(share > 0, part[:, light] / np.maximum(share, 1e-6), 0.0)
    return bright.astype(np.float32)
