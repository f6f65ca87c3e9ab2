"""The points among which a line is followed, found again by their place in plan."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.image.neighbourhoods.points_around import rows_to_take
from processing.recording.columns.counted_classes import class_columns

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive


_CELL_M = 0.25
"""Cells of the plan by which points are found: half the radius of a section. It changes only the
time."""

_BESIDE_M = 1.5
"""Rows so far before the start and beyond the end are taken in."""

_DETOUR, _DETOUR_M = 1.3, 4.0
"""A line between two clicks may be so much longer than the straight one: as in `trace_search`."""

_AT_ONCE = 1_000_000
"""Points read at a time: 12 MB."""

_LOOKED_AROUND_M = (0.1, 0.5)
"""The measured point at a place is looked for within the first, then the second."""


class PointsBetween:
    """Points of the rows between two points, as far as a line between them may run.

    Parameters
    ----------
    start, end : int
        Points of the drive.

    Attributes
    ----------
    points : (n,) int64
        Sorted by cells in plan.
    xyz : (n, 3) float64
        m, about `origin`.
    origin : (3,) float64
        The start, m, project CRS.
    """

    def __init__(self, drive: Drive, start: int, end: int) -> None:
        positions = drive.xyz(np.array([start, end]))
        self.origin = positions[0]
        points, xyz = _gather_points(drive, start, end, positions)
        cells = np.floor(xyz[:, :2] / _CELL_M).astype(np.int64)
        self._lowest = cells.min(axis=0)
        cells -= self._lowest
        self._shape = cells.max(axis=0) + 1
        flat = cells[:, 0] * self._shape[1] + cells[:, 1]
        order = np.argsort(flat, kind="stable")
        self.points = points[order]
        self.xyz = np.ascontiguousarray(xyz[order])
        counts = np.bincount(flat, minlength=int(self._shape.prod()))
        self._starts = np.concatenate([[0], np.cumsum(counts)])

    def nearest(self, xyz: Floats) -> int:
        """The point of the drive nearest to a place about `origin`."""
        for radius in _LOOKED_AROUND_M:
            near = self.near(xyz, radius)
            if near.size:
                away = ((self.xyz[near] - xyz) ** 2).sum(axis=1)
                return int(self.points[near[away.argmin()]])
        return int(self.points[((self.xyz - xyz) ** 2).sum(axis=1).argmin()])

    def near(self, xyz: Floats, radius_m: float) -> Integers:
        """Places in `points` of those within a distance.

        Parameters
        ----------
        xyz : (3,) float64
            m, about `origin`.

        Returns
        -------
        (k,) int64
        """
        low = np.floor((xyz[:2] - radius_m) / _CELL_M).astype(np.int64) - self._lowest
        high = np.floor((xyz[:2] + radius_m) / _CELL_M).astype(np.int64) - self._lowest
        low, high = np.maximum(low, 0), np.minimum(high, self._shape - 1)
        if (low > high).any():
            return np.empty(0, np.int64)
        parts = []
        for column in range(low[0], high[0] + 1):
            first = column * self._shape[1]
            start, stop = self._starts[first + low[1]], self._starts[first + high[1] + 1]
            parts.append(np.arange(start, stop))
        candidates = np.concatenate(parts)
        squares = ((self.xyz[candidates] - xyz) ** 2).sum(axis=1)
        return np.asarray(candidates[squares <= radius_m**2])


def _gather_points(
    drive: Drive, start: int, end: int, positions: Floats
) -> tuple[Integers, Floats]:
    pulses = drive.columns["pulse"]
    revolutions = drive.revolutions
    period = (
        revolutions.pulses_per_revolution
        if revolutions is not None
        else float(drive.info.cells_per_row)
    )
    first, last = min(start, end), max(start, end)
    margins = [np.prod(rows_to_take(drive, point, _BESIDE_M)) * period for point in (first, last)]
    low = int(np.searchsorted(pulses, int(pulses[first]) - round(margins[0])))
    high = int(np.searchsorted(pulses, int(pulses[last]) + round(margins[1]) + 1))
    longest = _DETOUR * float(np.linalg.norm(positions[1] - positions[0])) + _DETOUR_M
    points, xyz, classes = [], [], class_columns(drive.columns)
    for begin in range(low, high, _AT_ONCE):
        part = drive.xyz(slice(begin, min(high, begin + _AT_ONCE)))
        ways = sum(np.linalg.norm(part - position, axis=1) for position in positions)
        kept = np.flatnonzero(ways <= longest)
        # Noise is no line, whatever one clicked on.
        near = kept + begin
        kept = kept[~classes.are_noise(near) | (near == start) | (near == end)]
        points.append(kept + begin)
        xyz.append(part[kept] - positions[0])
    return np.concatenate(points), np.concatenate(xyz)
