"""Layers of a cell's points by height: where its ground begins above what only echoes place lower.

A lowest point is the worst of many: the more points a cell holds, the surer one of them is an
echo from under the ground. How many of its pulses go wrong does not depend on the density.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cell_positions import Blocks
from processing.methods.ground.filters.cells import CellGrid, LevelsAboveFloor

_DENSE_POINTS = 50
"""Points of a cell from which its layers say more than its lowest point, by trial: a fifth of the
fullest layer is then several points, no single stray."""

_LAYER_M = 0.1
"""Thickness of the layers asked first, by trial: wider than ground scatters in a small cell."""

_FINE_LAYER_M = 0.02
"""Of the layers asked next, about the roughness of smooth ground, so that an echo a few
centimetres below it is not taken along."""

_LAYERS = 48
"""Layers counted above the lowest point, 4.8 m of those asked first: ``_REACH_M`` and the depth
from which echoes come, a metre or two."""

_REACH_M = 3.0
"""Height above a layer within which a fuller one is looked for: as high as a person reaches, since
more points above may be a roof or a crown. In layers of ``_LAYER_M``; of the fine ones as many."""

_SHARE = 0.2
"""Share of the fullest layer above from which a layer is ground, by trial: strays are fewer."""

_ROUNDING_M = 1e-4
"""Heights of layers are kept in single precision: the lowest point must not fall below its own."""

_MOST_COUNTED = np.iinfo(np.uint16).max


class _DenseCells(NamedTuple):
    """For each cell: its row among the dense ones or −1, and the height of its first layer, m."""

    rows: NDArray[np.int32]
    start: NDArray[np.float32]


def begin_of_ground(
    blocks: Blocks, grid: CellGrid, levels: LevelsAboveFloor
) -> NDArray[np.float32]:
    """Height under which no layer of a cell can be ground: (rows, columns), m; −inf where unknown.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m, afresh at every call.
    levels : LevelsAboveFloor
        Of the same cells, above no floor.

    Notes
    -----
    A scanner does not see through the ground: what lies under it comes from the few pulses that
    went astray, spread over a height of a metre, while those that met the ground lie in one thin
    layer. From below, the first layer counts that holds a fifth as many points as any layer above
    it that a person could reach. Layers of a decimetre are asked first, then thin ones in the
    first that counted. Cells with fewer than fifty points stay unknown.
    """
    floor = np.full(levels.lowest.shape, -np.inf, np.float32)
    dense = levels.near.astype(np.int32) + levels.above >= _DENSE_POINTS
    if not dense.any():
        return floor
    rows = np.full(dense.shape, -1, np.int32)
    rows[dense] = np.arange(np.count_nonzero(dense), dtype=np.int32)
    start = levels.lowest.copy()
    cells = _DenseCells(rows, start)
    for layer_m in (_LAYER_M, _FINE_LAYER_M):
        counts = np.zeros((int(rows.max()) + 1, _LAYERS), np.uint16)
        for xyz in blocks():
            _layers_kernel(
                np.ascontiguousarray(xyz), grid.origin, grid.size_m, cells, layer_m, counts
            )
        first = _first_layers(counts, round(_REACH_M / _LAYER_M))
        start[dense] += np.float32(layer_m) * first.astype(np.float32)
    floor[dense] = start[dense]
    return floor


def _first_layers(counts: NDArray[np.uint16], reach: int) -> NDArray[np.int64]:
    """The first layer of each cell that holds its share of any of the ``reach`` above it."""
    first = np.empty(len(counts), np.int64)
    _first_kernel(counts, reach, first)
    return first


@kernel
def _layers_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    cells: _DenseCells,
    layer_m: float,
    counts: NDArray[np.uint16],
) -> None:
    rows = cells.rows
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < rows.shape[1] and 0.0 <= y < rows.shape[0]:
            own = rows[int(y), int(x)]
            if own < 0:
                continue
            layer = (z - cells.start[int(y), int(x)] + _ROUNDING_M) / layer_m
            if 0.0 <= layer < counts.shape[1] and counts[own, int(layer)] < _MOST_COUNTED:
                counts[own, int(layer)] += 1


@kernel
def _first_kernel(counts: NDArray[np.uint16], reach: int, first: NDArray[np.int64]) -> None:
    layers = counts.shape[1]
    for cell in range(counts.shape[0]):
        first[cell] = 0
        for layer in range(layers):
            fullest = 0
            for above in range(layer, min(layer + reach, layers)):
                fullest = max(fullest, int(counts[cell, above]))
            if counts[cell, layer] > 0 and counts[cell, layer] >= _SHARE * fullest:
                first[cell] = layer
                break


def warm_up() -> None:
    """Compile the kernels of this file."""
    grid = CellGrid(np.zeros(3), 1.0, 1, 1)
    one = np.ones((1, 1), np.uint16)
    levels = LevelsAboveFloor(
        np.zeros((1, 1), np.float32), np.ones((1, 1), np.float32), one * _DENSE_POINTS, one
    )
    begin_of_ground(lambda: [np.array([[0.5, 0.5, 0.0]])], grid, levels)
