"""Which of very many marks are painted: a line of ten thousand vertices is dragged as easily."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FEW = 500
"""So many marks are all painted, wherever they lie."""

_CELL_PX = 4.0
_MARGIN_PX = 32.0


def marks_to_paint(pixels: NDArray[np.float64], width: float, height: float) -> NDArray[np.int64]:
    """Marks that can be seen; of many that lie on one another, one for each few pixels.

    Parameters
    ----------
    pixels : (n, 2) float64
        Widget pixels; NaN where a mark has no place.
    width, height : float
        Of the widget, pixels.

    Returns
    -------
    (m,) int64
        Indices of marks, rising.
    """
    size = np.array([width, height])
    is_inside = ((pixels >= -_MARGIN_PX) & (pixels <= size + _MARGIN_PX)).all(axis=1)
    inside = np.flatnonzero(is_inside)
    if inside.size <= FEW:
        return inside
    cells = np.floor(pixels[inside] / _CELL_PX).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return inside[np.sort(first)]
