"""Cells of full-waveform flights: shapes, brightness, numbers of returns and waveforms around."""

from __future__ import annotations

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

_AROUND = (1, 2, 3)
"""Sizes of cells whose 27 are averaged: 6, 12 and 24 points wide, across a wire, a tower or a lane,
a road with its shoulders."""

_WIDER = 4
"""Size that brightness of the ground is told against: 48 points wide, a road and what is beside."""


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
    bright, is_ground = returns[:, 0], points.is_ground.astype(np.float32)
    columns = [returns, np.column_stack([bright * bright, is_ground, bright * is_ground])]
    if measures is not None:
        columns += [measures, (measures[:, 0] * is_ground)[:, None]]
    values = np.ascontiguousarray(np.hstack(columns), np.float32)
    own = _means(cells.cell_of, values)
    parts = [own, *(cells.means_around(own, number, monitor) for number in _AROUND)]
    lit = [(4, 5)] if measures is None else [(4, 5), (4, own.shape[1] - 1)]
    wide = cells.means_around(own, _WIDER, monitor)
    contrast = [
        _of_ground(part, ground, light) - _of_ground(wide, ground, light)
        for ground, light in lit
        for part in parts
    ]
    tones = bright if measures is None else np.ascontiguousarray(measures[:, 0])
    is_told = points.is_ground & points.is_only
    strips = strip_columns(
        points.local[:, :2], tones, is_told, ranks, cell_m=cell_m, monitor=monitor
    )
    return replace(
        cells,
        rows=np.hstack(
            [cells.rows, *parts, np.column_stack(contrast), _means(cells.cell_of, strips)]
        ),
    )


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
