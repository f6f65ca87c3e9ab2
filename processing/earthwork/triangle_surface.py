"""TriangleSurface: given triangles (a design, a TIN), one height at each place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class TriangleSurface:
    """Triangles over a plan; they don't overlap seen from above.

    Attributes
    ----------
    xyz : (n, 3) float64
        Corners, m, project CRS (x easting, y northing).
    corners : (t, 3) int64
        Rows of ``xyz``, in either sense.
    name : str
        As its file names it; empty for one made here.
    """

    xyz: NDArray[np.float64]
    corners: NDArray[np.int64]
    name: str = ""
