"""What a volume is limited to and drawn along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray


@dataclass(frozen=True)
class VolumeScope:
    """What a volume is limited to and drawn along.

    Attributes
    ----------
    boundary : shapely.Polygon or shapely.MultiPolygon or None
        m, project CRS; None counts all ground that both sides have.
    line : (k, 2) float64 or None
        What sections stand on; None takes the longer middle line of the area.
    break_lines : tuple of (k, 3) float64
        Edges of the triangles of both sides.
    """

    boundary: shapely.Geometry | None = None
    line: NDArray[np.float64] | None = None
    break_lines: tuple[NDArray[np.float64], ...] = ()


EVERYWHERE = VolumeScope()
"""All ground that both sides have."""
