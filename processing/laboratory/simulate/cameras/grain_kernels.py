"""Noise in space that is smooth from cell to cell: stains of walls, blotches of roads, clouds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.laboratory.simulate.scene.mesh import Floats

Singles = NDArray[np.float32]


def grain(positions: Floats, cell_m: float) -> Singles:
    """Noise at places.

    Parameters
    ----------
    positions : (n, 3) float64
    cell_m : float
        Over which it changes.

    Returns
    -------
    (n,) float32
        −1 to 1, the same at the same place.
    """
    out = np.empty(positions.shape[0], np.float32)
    _grain_kernel(np.ascontiguousarray(positions, np.float64), 1.0 / cell_m, out)
    return out


@kernel
def _grain_kernel(positions: Floats, per_m: float, out: Singles) -> None:
    """Values of a lattice, between them by smooth weights (Perlin 1985, value noise)."""
    for row in range(positions.shape[0]):
        x, y, z = positions[row, 0] * per_m, positions[row, 1] * per_m, positions[row, 2] * per_m
        i, j, k = np.floor(x), np.floor(y), np.floor(z)
        u, v, w = x - i, y - j, z - k
        u, v, w = u * u * (3 - 2 * u), v * v * (3 - 2 * v), w * w * (3 - 2 * w)
        total = 0.0
        for corner in range(8):
            a, b, c = corner & 1, (corner >> 1) & 1, corner >> 2
            mixed = (int(i) + a) * 73856093 ^ (int(j) + b) * 19349663 ^ (int(k) + c) * 83492791
            mixed = (mixed ^ (mixed >> 13)) * 1274126177
            value = ((mixed ^ (mixed >> 16)) & 65535) / 32767.5 - 1.0
            share = (u if a else 1 - u) * (v if b else 1 - v) * (w if c else 1 - w)
            total += share * value
        out[row] = total


def warm_up() -> None:
    """Compile the kernel."""
    grain(np.zeros((1, 3)), 1.0)
