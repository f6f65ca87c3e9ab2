"""How high above the road the reference point of a trajectory was carried.

A trajectory may be that of the scanner, the inertial unit, an antenna or of the ground itself, so
the points below it are asked (specification, trap 25).
"""

from __future__ import annotations

import numpy as np

from processing.image.scan_lines.scanline_rows import read_rows, scan_rows
from processing.recording.drive import Drive
from processing.recording.passes import Pass

THESIS_HEIGHT_M = 2.6
"""Of the scanner above the road in Takahashi 2022, Table 6-1: taken where no point tells it."""

_ROWS = 40
_ASIDE_M = 1.5
_ABOVE_M = 0.5
"""Points that are higher above the way are no road, wherever the reference point is."""

_FEWEST = 5


def height_above_road(drive: Drive, vehicle_path: Pass) -> float:
    """How high a pass lies above the road, m.

    The median over rows spread along the pass of the median over the points of each that lie at
    most 1.5 m beside the vehicle's path.
    """
    if drive.revolutions is None:
        return THESIS_HEIGHT_M
    rows = scan_rows(drive.revolutions, vehicle_path, max(vehicle_path.length_m / _ROWS, 0.02))
    heights = []
    for row in range(len(rows)):
        points = read_rows(drive, vehicle_path, rows.part(row, row + 1), rows.half_width)
        _, across, above = points.arrays[2].T
        is_below = (np.abs(across) <= _ASIDE_M) & (above < _ABOVE_M) & ~points.arrays[5]
        if np.count_nonzero(is_below) >= _FEWEST:
            heights.append(-float(np.median(above[is_below])))
    return float(np.median(heights)) if heights else THESIS_HEIGHT_M
