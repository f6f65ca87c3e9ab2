"""Which places of an open line are needed to draw it within a tolerance; arrays alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats


def needed_positions(xyz: Floats, tolerance_m: float) -> NDArray[np.int64]:
    """Indices of the places of an open line that stay, both ends among them.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; n >= 1.

    References
    ----------
    Douglas, Peucker 1973, Algorithms for the reduction of the number of points required to
    represent a digitized line or its caricature, https://doi.org/10.3138/FM57-6770-U75U-7727
    """
    is_kept = np.zeros(len(xyz), np.bool_)
    is_kept[[0, -1]] = True
    waiting = [(0, len(xyz) - 1)]
    while waiting:
        start, stop = waiting.pop()
        if stop - start < 2:
            continue
        distances = from_chord(xyz[start + 1 : stop], xyz[start], xyz[stop])
        worst = int(distances.argmax())
        if distances[worst] > tolerance_m:
            middle = start + 1 + worst
            is_kept[middle] = True
            waiting += [(start, middle), (middle, stop)]
    return np.flatnonzero(is_kept)


def from_chord(xyz: Floats, start: Floats, end: Floats) -> Floats:
    """(k,): distances of places from a straight piece in space."""
    step = end - start
    square = float(step @ step)
    away = xyz - start
    along = (away @ step / square).clip(0, 1) if square > 0 else np.zeros(len(xyz))
    distances: Floats = np.linalg.norm(away - along[:, None] * step, axis=1)
    return distances
