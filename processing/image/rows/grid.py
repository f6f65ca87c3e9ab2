"""PixelGrid: the pixels of a chunk of rows, the form in which kernels meet the image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class PixelGrid:
    """Rows and columns of consecutive points.

    The points of a row are consecutive and ordered by column; points that share a pixel (several
    returns of one pulse, several points of a cell) are consecutive too, the shown one
    first.

    Attributes
    ----------
    row_starts : (rows + 1,) int64
        Row r holds the points ``row_starts[r] … row_starts[r + 1] − 1`` of the block.
    columns : (n,) int32
        The pixel column of every point; not decreasing inside a row.
    segments : (rows,) int32
        Stretches between stops; rows of different segments are not neighbours.
    width : int
        Number of columns.
    is_regular : bool
        Whether points follow each other as a scanner measured them; False seen from above.
    """

    row_starts: NDArray[np.int64]
    columns: NDArray[np.int32]
    segments: NDArray[np.int32]
    width: int
    is_regular: bool = True
