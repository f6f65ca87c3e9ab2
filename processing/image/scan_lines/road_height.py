"""How high above the road the reference point of a trajectory was carried.

A trajectory may be that of the scanner, the inertial unit, an antenna or of the ground itself, so
the points below it are asked.
"""

from __future__ import annotations

import numpy as np

from processing.image.scan_lines.scanline_rows import scan_rows
from processing.recording.columns.counted_classes import class_columns
from processing.recording.columns.damaged_pulses import damaged_pulses
from processing.recording.drive import Drive
from processing.recording.passes import Pass

USUAL_HEIGHT_M = 2.6
"""Of the scanner above the road in Takahashi 2022, Table 6-1: taken where no point shows it."""

_ROWS = 40
"""Rows over a pass that are asked; their median counts."""

_ASIDE_M = 1.5
"""What lies so near to the path is road: under the vehicle and half a lane beside it."""

_ABOVE_M = 0.5
"""Points that are higher above the path are no road, wherever the reference point is."""

_LEAST_ADVANCE_M = 0.02
"""Rows of a waiting vehicle are left out: as `ScanlineSettings.least_advance_m`."""

_FEWEST = 5
"""Points of a row below the vehicle, for a median. By trial; no measurement is recorded."""


def height_above_road(drive: Drive, vehicle_path: Pass) -> float:
    """How high a pass lies above the road, m.

    The median over rows spread along the pass of the median over the points of each that lie at
    most 1.5 m beside the vehicle's path.
    """
    if drive.revolutions is None:
        return USUAL_HEIGHT_M
    rows = scan_rows(
        drive.revolutions, vehicle_path, max(vehicle_path.length_m / _ROWS, _LEAST_ADVANCE_M)
    )
    asked = vehicle_path.beside(_ASIDE_M, -np.inf, _ABOVE_M)
    classes, pulses, times = (
        class_columns(drive.columns),
        drive.columns["pulse"],
        drive.columns["time"],
    )
    heights = []
    for bounds in rows.ends:
        start, stop = (int(end) for end in np.searchsorted(pulses, bounds))
        if start > stop:
            raise damaged_pulses(drive.folder)
        # Mapped: checksums are of blocks a hundred times as long as a row, and whoever asks how
        # high a pass lies reads all rows later.
        local = drive.coordinates.about(slice(start, stop), vehicle_path.origin)
        _, across, above = vehicle_path.stations_of_local(local, times[start:stop], asked).T
        is_below = (np.abs(across) <= _ASIDE_M) & (above < _ABOVE_M)
        is_below &= ~classes.noise_between(start, stop)
        if np.count_nonzero(is_below) >= _FEWEST:
            heights.append(-float(np.median(above[is_below])))
    return float(np.median(heights)) if heights else USUAL_HEIGHT_M
